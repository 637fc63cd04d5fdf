//! Triangle meshes in the plane, their connectivity and their subdivision.
//!
//! A [`TriangleMesh`] guarantees positions in range and faces whose indices
//! exist and differ. It does not promise orientation: that is a matter of
//! two embeddings and is checked where they meet, in
//! [`crate::compatible::CompatibleMesh`].

mod components;
mod connectivity;
mod edges;
mod natural_neighbours;
mod subdivide;
pub mod triangulation;

pub use components::components;
pub use connectivity::{Connectivity, ConnectivityError};
pub(crate) use edges::{sides, undirected};
pub use natural_neighbours::{NaturalNeighbours, SitesError};
pub use subdivide::{MAX_ROUNDS, MAX_VERTICES, Subdivision, TooManyVertices};

use crate::geometry::{Bounds, DVec2, DesignSizeError, RANGE_MESSAGE, Similarity, is_in_range};

/// Triangles over points in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    positions: Vec<DVec2>,
    faces: Vec<[u32; 3]>,
    connectivity: Connectivity,
}

/// Why points and faces do not make a [`TriangleMesh`]. Indices start at 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no face at all.
    #[error("the mesh has no faces; give at least one triangle")]
    NoFaces,
    /// A coordinate is no number, or beyond [`MAX_COORDINATE`].
    ///
    /// [`MAX_COORDINATE`]: crate::geometry::MAX_COORDINATE
    #[error("vertex {} {RANGE_MESSAGE}", .0 + 1)]
    Place(usize),
    /// All vertices lie on one another, or as good as.
    #[error(transparent)]
    Size(#[from] DesignSizeError),
    /// A face names a vertex that does not exist.
    #[error("face {} names vertex {}, but there are only {vertices}; correct the face", face + 1, u64::from(*vertex) + 1)]
    OutOfRange {
        /// The face.
        face: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A face names a vertex twice.
    #[error("face {} names one vertex twice; remove the face or correct it", .0 + 1)]
    Repeated(usize),
    /// Faces do not meet edge to edge.
    #[error(transparent)]
    Connectivity(#[from] ConnectivityError),
}

impl TriangleMesh {
    /// Takes positions and faces; every face lists its vertices in either
    /// orientation, the same for neighbouring faces.
    ///
    /// # Errors
    /// [`MeshError`] names the first vertex or face that cannot be used.
    ///
    /// ```
    /// use morphospace::{geometry::DVec2, mesh::TriangleMesh};
    /// let mesh = TriangleMesh::new(vec![DVec2::ZERO, DVec2::X, DVec2::Y], vec![[0, 1, 2]])?;
    /// assert_eq!(mesh.boundary_loops(), vec![vec![0, 1, 2]]);
    /// # Ok::<(), morphospace::mesh::MeshError>(())
    /// ```
    pub fn new(positions: Vec<DVec2>, faces: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if faces.is_empty() {
            return Err(MeshError::NoFaces);
        }
        if let Some(bad) = positions.iter().position(|&p| !is_in_range(p)) {
            return Err(MeshError::Place(bad));
        }
        check_faces(&faces, positions.len())?;
        // A face has vertices, and so there is a box around them.
        Bounds::of(positions.iter().copied())
            .map_or(Ok(0.0), |all| DesignSizeError::check(&all))?;
        let connectivity = Connectivity::new(&faces)?;
        Ok(Self {
            positions,
            faces,
            connectivity,
        })
    }

    /// One point for each vertex.
    #[must_use]
    pub fn positions(&self) -> &[DVec2] {
        &self.positions
    }

    /// Vertex indices, three a face.
    #[must_use]
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Which faces meet at which edges.
    #[must_use]
    pub fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    /// The closed boundary walks, as vertex indices, with the faces on the
    /// left of counter-clockwise ones.
    #[must_use]
    pub fn boundary_loops(&self) -> Vec<Vec<u32>> {
        self.connectivity.boundary_loops(&self.faces)
    }

    /// The smallest box around all vertices.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.positions.iter().copied())
            .unwrap_or_else(|| unreachable!("a mesh has a face and so a vertex"))
    }

    /// The mesh laid down by a similarity. A mirror reverses every face, so
    /// that orientations stay.
    #[must_use]
    pub fn transformed(&self, by: &Similarity) -> Self {
        let mut mesh = self.clone();
        for p in &mut mesh.positions {
            *p = by.apply(*p);
        }
        if by.mirror {
            for face in &mut mesh.faces {
                face.swap(1, 2);
            }
            mesh.connectivity = Connectivity::new(&mesh.faces)
                .unwrap_or_else(|_| unreachable!("mirrored faces meet as before"));
        }
        mesh
    }
}

/// Indices in range and different within each face.
pub(crate) fn check_faces(faces: &[[u32; 3]], vertices: usize) -> Result<(), MeshError> {
    // Both are asked of each face in turn, so that the first bad one is told.
    for (face, &[a, b, c]) in faces.iter().enumerate() {
        if let Some(&vertex) = [a, b, c].iter().find(|&&v| v as usize >= vertices) {
            return Err(MeshError::OutOfRange {
                face,
                vertex,
                vertices,
            });
        }
        if a == b || b == c || c == a {
            return Err(MeshError::Repeated(face));
        }
    }
    Ok(())
}
