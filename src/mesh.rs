//! Triangle meshes in the plane: connectivity, components, subdivision, triangulation and
//! natural-neighbour coordinates.
//!
//! A [`TriangleMesh`] guarantees that positions are in range, that the vertex indices of each face
//! exist and differ, and that faces meet edge to edge. It does not guarantee that faces are
//! positively oriented: that is a property of a pair of embeddings, which
//! [`crate::compatible::CompatibleMesh`] checks.

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

/// Reason why points and faces do not form a [`TriangleMesh`]. Indices start at 0 in fields and at
/// 1 in messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The list of faces is empty.
    #[error("the mesh has no faces; give at least one triangle")]
    NoFaces,
    /// A coordinate of the vertex with this index is not finite, or its absolute value exceeds
    /// [`MAX_COORDINATE`].
    ///
    /// [`MAX_COORDINATE`]: crate::geometry::MAX_COORDINATE
    #[error("vertex {} {RANGE_MESSAGE}", .0 + 1)]
    Place(usize),
    /// The mesh is too small, or too far from the origin for its size.
    #[error(transparent)]
    Size(#[from] DesignSizeError),
    /// A face names a vertex that does not exist.
    #[error("face {} names vertex {}, but the mesh has only {vertices} vertices; correct the face", face + 1, u64::from(*vertex) + 1)]
    OutOfRange {
        /// Index of the face.
        face: usize,
        /// Vertex index that the face names.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// The face with this index names a vertex twice.
    #[error("face {} names one vertex twice; remove or correct the face", .0 + 1)]
    Repeated(usize),
    /// Faces do not meet edge to edge.
    #[error(transparent)]
    Connectivity(#[from] ConnectivityError),
}

impl TriangleMesh {
    /// Creates a mesh. Faces may list their vertices in either orientation, as long as neighbouring
    /// faces agree.
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
        // There is a face, so there is a vertex, and the vertices have a bounding box.
        Bounds::of(positions.iter().copied())
            .map_or(Ok(0.0), |all| DesignSizeError::check(&all))?;
        let connectivity = Connectivity::new(&faces)?;
        Ok(Self {
            positions,
            faces,
            connectivity,
        })
    }

    /// Returns the position of each vertex.
    #[must_use]
    pub fn positions(&self) -> &[DVec2] {
        &self.positions
    }

    /// Returns the vertex indices of each face.
    #[must_use]
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Returns the connectivity: which faces meet at which edges.
    #[must_use]
    pub fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    /// Returns the closed boundary loops as vertex indices. If the faces are counter-clockwise, the
    /// mesh lies to the left of each loop.
    #[must_use]
    pub fn boundary_loops(&self) -> Vec<Vec<u32>> {
        self.connectivity.boundary_loops(&self.faces)
    }

    /// Returns the bounding box of all vertices.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.positions.iter().copied())
            .unwrap_or_else(|| unreachable!("a mesh has a face and so a vertex"))
    }

    /// Returns the mesh transformed by a similarity. A mirror also reverses the vertices of every
    /// face, which preserves orientations.
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

/// Checks that the vertex indices of each face are less than `vertices` and differ from each other.
///
/// # Errors
/// [`MeshError`] for the first face that is invalid.
pub(crate) fn check_faces(faces: &[[u32; 3]], vertices: usize) -> Result<(), MeshError> {
    // Both checks run face by face, so that the first invalid face is reported.
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
