//! Midpoint subdivision: each triangle into four, the shape unchanged.
//!
//! Only indices are decided here; the caller takes the midpoints in as many
//! embeddings as it has, so that compatible meshes stay compatible.

use super::edges::{sides, undirected};
use std::collections::HashMap;

/// The most vertices that a subdivision may reach: about 4 GB of factor.
pub const MAX_VERTICES: usize = 4_000_000;

/// Most rounds: a single triangle has 2 million vertices after 11, and 8 after
/// one more.
pub const MAX_ROUNDS: u32 = 11;

/// Faces after subdivision, and where the new vertices lie.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subdivision {
    /// Four faces for each old one.
    pub faces: Vec<[u32; 3]>,
    /// For each new vertex, numbered on from the old ones, the two whose
    /// midpoint it is; they may be new ones of an earlier round.
    pub midpoints: Vec<[u32; 2]>,
}

/// A subdivision would have too many vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{rounds} subdivisions need more than {MAX_VERTICES} vertices; choose fewer")]
pub struct TooManyVertices {
    /// The rounds that were asked for.
    pub rounds: u32,
}

impl Subdivision {
    /// Splits every face `rounds` times; 0 rounds change nothing.
    ///
    /// # Errors
    /// [`TooManyVertices`] beyond [`MAX_VERTICES`].
    ///
    /// ```
    /// use morphospace::mesh::Subdivision;
    /// let fine = Subdivision::new(&[[0, 1, 2]], 3, 1)?;
    /// assert_eq!((fine.faces.len(), fine.midpoints.len()), (4, 3));
    /// # Ok::<(), morphospace::mesh::TooManyVertices>(())
    /// ```
    pub fn new(faces: &[[u32; 3]], vertices: usize, rounds: u32) -> Result<Self, TooManyVertices> {
        let (mut most, mut count) = (vertices, faces.len());
        // All rounds first: what ends as too many need not be begun.
        for _ in 0..rounds.min(32) {
            most += count * 3 / 2;
            count *= 4;
            if most > MAX_VERTICES {
                return Err(TooManyVertices { rounds });
            }
        }
        let mut fine = Self {
            faces: faces.to_vec(),
            midpoints: Vec::new(),
        };
        for _ in 0..rounds {
            let so_far = vertices + fine.midpoints.len();
            // Before the memory is taken: each face adds three midpoints that
            // at most two faces share.
            if so_far + fine.faces.len() * 3 / 2 > MAX_VERTICES {
                return Err(TooManyVertices { rounds });
            }
            fine.split(so_far as u32);
        }
        Ok(fine)
    }

    fn split(&mut self, first_new: u32) {
        let mut between: HashMap<[u32; 2], u32> = HashMap::with_capacity(self.faces.len() * 2);
        let midpoints = &mut self.midpoints;
        let mut next_vertex = first_new;
        let mut midpoint = |edge: [u32; 2]| {
            *between.entry(undirected(edge)).or_insert_with(|| {
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
                // All four run as the old one does.
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
}
