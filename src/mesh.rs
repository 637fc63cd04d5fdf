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
mod polygon_faces;
mod subdivide;
pub mod triangulation;

pub use components::components;
pub use connectivity::{Connectivity, ConnectivityError};
pub(crate) use edges::{sides, undirected};
pub use natural_neighbours::{NaturalNeighbours, SitesError};
pub use polygon_faces::PolygonFaces;
pub use subdivide::{MAX_ROUNDS, MAX_VERTICES, Subdivision, TooManyVertices};

use crate::geometry::{Bounds, DVec2, DesignSizeError, RANGE_MESSAGE, Similarity, is_in_range};
use std::sync::Arc;

/// Triangles over points in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    positions: Vec<DVec2>,
    faces: Vec<[u32; 3]>,
    connectivity: Connectivity,
    /// Faces as listed, if any of them has more than three vertices.
    polygons: Option<Arc<PolygonFaces>>,
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
    /// The face with this index touches or crosses itself, or has fewer than three vertices.
    #[error("face {} touches or crosses itself, or encloses no area; correct or remove it", .0 + 1)]
    NotSimple(usize),
    /// Faces do not meet edge to edge.
    #[error(transparent)]
    Connectivity(#[from] ConnectivityError),
}

impl MeshError {
    /// Returns the error with other indices of faces: `listed` maps the index of a triangle to that
    /// of the face to which it belongs.
    pub(crate) fn with_faces(self, listed: &dyn Fn(usize) -> usize) -> Self {
        match self {
            Self::Connectivity(ConnectivityError::Opposed(faces)) => {
                Self::Connectivity(ConnectivityError::Opposed(faces.map(listed)))
            }
            Self::OutOfRange {
                face,
                vertex,
                vertices,
            } => Self::OutOfRange {
                face: listed(face),
                vertex,
                vertices,
            },
            Self::Repeated(face) => Self::Repeated(listed(face)),
            other => other,
        }
    }
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
            polygons: None,
        })
    }

    /// Creates a mesh from faces with three or more vertices, which are divided into triangles (see
    /// the module `polygon_faces`). Errors count the faces as given.
    ///
    /// # Errors
    /// [`MeshError`] names the first vertex or face that cannot be used.
    ///
    /// ```
    /// use morphospace::{geometry::DVec2, mesh::{PolygonFaces, TriangleMesh}};
    /// let mut faces = PolygonFaces::default();
    /// faces.push([0, 1, 2, 3]);
    /// let corners = vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    /// let mesh = TriangleMesh::from_polygons(corners, faces)?;
    /// assert_eq!(mesh.faces(), [[0, 1, 2], [0, 2, 3]]);
    /// # Ok::<(), morphospace::mesh::MeshError>(())
    /// ```
    pub fn from_polygons(positions: Vec<DVec2>, polygons: PolygonFaces) -> Result<Self, MeshError> {
        let vertices = positions.len();
        for face in 0..polygons.len() {
            let mut corners = polygons.polygon(face).iter();
            if let Some(&vertex) = corners.find(|&&v| v as usize >= vertices) {
                return Err(MeshError::OutOfRange {
                    face,
                    vertex,
                    vertices,
                });
            }
        }
        if let Some(bad) = positions.iter().position(|&p| !is_in_range(p)) {
            return Err(MeshError::Place(bad));
        }
        let faces = polygons.triangles(&positions);
        let faces = faces.map_err(MeshError::NotSimple)?;
        let mesh = Self::new(positions, faces);
        if polygons.are_triangles() {
            return mesh;
        }
        let mesh = mesh.map_err(|error| error.with_faces(&|face| polygons.polygon_of(face)))?;
        Ok(Self {
            polygons: Some(Arc::new(polygons)),
            ..mesh
        })
    }

    /// Returns the faces as they were given: polygons, or else the triangles.
    #[must_use]
    pub fn listed_faces(&self) -> Arc<PolygonFaces> {
        self.polygons.clone().unwrap_or_else(|| {
            let mut triangles = PolygonFaces::default();
            self.faces.iter().for_each(|&face| triangles.push(face));
            Arc::new(triangles)
        })
    }

    /// Returns the index, among the faces as they were given, of the face to which a triangle
    /// belongs.
    #[must_use]
    pub fn listed_face(&self, triangle: usize) -> usize {
        let polygons = self.polygons.as_ref();
        polygons.map_or(triangle, |polygons| polygons.polygon_of(triangle))
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
