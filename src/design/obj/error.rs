//! Why an OBJ file is no plane mesh.

use crate::mesh::MeshError;

/// Why an OBJ file is no plane mesh. Lines, vertices and faces count from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// A `v` line without two or three numbers.
    #[error("line {line}: vertex {vertex} needs the numbers x y z; correct the line")]
    Vertex {
        /// The line.
        line: usize,
        /// The vertex.
        vertex: usize,
    },
    /// NaN, infinity, or a number too large to hold.
    #[error("line {line}: vertex {vertex} is not a finite point; correct its coordinates")]
    NotFinite {
        /// The line.
        line: usize,
        /// The vertex.
        vertex: usize,
    },
    /// The vertices do not lie in one plane of constant z.
    #[error(
        "line {line}: vertex {vertex} has z = {z}, but vertex 1 has z = {first}; lay the mesh flat, only x and y are used"
    )]
    NotFlat {
        /// The line.
        line: usize,
        /// The vertex.
        vertex: usize,
        /// Its z.
        z: f64,
        /// The z of the first vertex.
        first: f64,
    },
    /// A face with a word that is no vertex.
    #[error(
        "line {line}: face {face} has \"{word}\" where a vertex number should be; correct the line"
    )]
    Face {
        /// The line.
        line: usize,
        /// The face.
        face: usize,
        /// The word, cut short.
        word: String,
    },
    /// A face of one or two vertices.
    #[error("line {line}: face {face} has fewer than three vertices; remove it or complete it")]
    TooFewCorners {
        /// The line.
        line: usize,
        /// The face.
        face: usize,
    },
    /// A face that names a vertex that is not there.
    #[error(
        "line {line}: face {face} names vertex {named}, but there are {vertices}; correct the face"
    )]
    OutOfRange {
        /// The line.
        line: usize,
        /// The face.
        face: usize,
        /// The number as it stands in the file.
        named: i64,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A face that passes a vertex twice.
    #[error("line {line}: face {face} names vertex {vertex} twice; correct the face")]
    Repeated {
        /// The line.
        line: usize,
        /// The face.
        face: usize,
        /// The vertex.
        vertex: usize,
    },
    /// A vertex that nothing holds.
    #[error("vertex {0} belongs to no face; remove it, or add the face that is missing")]
    Unused(usize),
    /// No vertices or no faces.
    #[error("the mesh has {vertices} vertices and {faces} faces; give at least one triangle")]
    NoMesh {
        /// How many vertices.
        vertices: usize,
        /// How many faces.
        faces: usize,
    },
    /// More vertices than can be numbered.
    #[error("the mesh has more than {} vertices; give a coarser one", u32::MAX)]
    TooMany,
    /// Faces that do not fit together.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}
