//! Midpoint subdivision: each triangle becomes four, and the shape of the mesh does not change.
//!
//! Only indices are computed here. The caller evaluates the midpoints in each of its embeddings, so
//! that compatible meshes stay compatible.

use super::edges::{sides, undirected};
use std::collections::HashMap;

/// Maximum number of vertices after subdivision (resource limit: the factored linear system of a
/// warp with so many vertices takes about 4 GB).
pub const MAX_VERTICES: usize = 4_000_000;

/// Maximum number of rounds of subdivision (derived: a single triangle has 2 million vertices after
/// 11 rounds, which is allowed, and 8 million after 12).
pub const MAX_ROUNDS: u32 = 11;

/// Faces after subdivision, and the origin of the new vertices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subdivision {
    /// Faces after all rounds; each round turns a face into four.
    pub faces: Vec<[u32; 3]>,
    /// For each new vertex, the two vertices whose midpoint it is. These two may themselves be new
    /// vertices of an earlier round. New vertices are numbered after the old ones.
    pub midpoints: Vec<[u32; 2]>,
}

/// Error: a subdivision would exceed [`MAX_VERTICES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{rounds} subdivisions need more than {MAX_VERTICES} vertices; choose fewer")]
pub struct TooManyVertices {
    /// Number of rounds requested.
    pub rounds: u32,
}

impl Subdivision {
    /// Splits every face into four, `rounds` times; 0 rounds change nothing.
    ///
    /// # Errors
    /// [`TooManyVertices`] if the result would have more than [`MAX_VERTICES`] vertices.
    ///
    /// ```
    /// use morphospace::mesh::Subdivision;
    /// let fine = Subdivision::new(&[[0, 1, 2]], 3, 1)?;
    /// assert_eq!((fine.faces.len(), fine.midpoints.len()), (4, 3));
    /// # Ok::<(), morphospace::mesh::TooManyVertices>(())
    /// ```
    pub fn new(faces: &[[u32; 3]], vertices: usize, rounds: u32) -> Result<Self, TooManyVertices> {
        let (mut vertex_bound, mut face_count) = (vertices, faces.len());
        // Estimate the size after all rounds first, so that an excessive subdivision is not begun.
        for _ in 0..rounds.min(32) {
            vertex_bound += face_count * 3 / 2;
            face_count *= 4;
            if vertex_bound > MAX_VERTICES {
                return Err(TooManyVertices { rounds });
            }
        }
        let mut fine = Self {
            faces: faces.to_vec(),
            midpoints: Vec::new(),
        };
        for _ in 0..rounds {
            let so_far = vertices + fine.midpoints.len();
            // Check before allocating: each face adds three midpoints, and at most two faces share
            // a midpoint.
            if so_far + fine.faces.len() * 3 / 2 > MAX_VERTICES {
                return Err(TooManyVertices { rounds });
            }
            fine.split(so_far as u32);
        }
        Ok(fine)
    }

    /// Splits every face into four, once. `first_new` is the index of the first new vertex.
    fn split(&mut self, first_new: u32) {
        let mut midpoint_of_edge: HashMap<[u32; 2], u32> =
            HashMap::with_capacity(self.faces.len() * 2);
        let midpoints = &mut self.midpoints;
        let mut next_vertex = first_new;
        let mut midpoint = |edge: [u32; 2]| {
            *midpoint_of_edge.entry(undirected(edge)).or_insert_with(|| {
                midpoints.push(edge);
                next_vertex += 1;
                next_vertex - 1
            })
        };
        self.faces = self
            .faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let [ab, bc, ca] = sides([a, b, c]).map(&mut midpoint);
                // All four new faces have the orientation of the old one.
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
}
