//! Compatible triangulations: one list of faces with an embedding (a position for every vertex) in
//! each design.
//!
//! [`CompatibleMesh`] has two embeddings, source and target. A [`CompatibleFamily`] has one
//! embedding for each of two or more designs. Guaranteed: every face is positively oriented
//! (counter-clockwise) in all embeddings, by exact predicates. The affine map of a face from one
//! embedding to another therefore has a positive determinant. Not guaranteed: that faces do not
//! overlap; the mesh of a spiral may lie over itself.

mod assembly;
mod border;
mod family;
mod frame_outlines;
mod mesh;
mod outlines;
mod polygon_faces;
mod polygons;
mod truss;
mod validation;

pub use family::{CompatibleFamily, FamilyError};
pub use mesh::CompatibleMesh;
pub use outlines::OutlineMeshError;
pub(crate) use outlines::{merged_meshes, mesh_of_piece};
pub(crate) use polygons::slide_outlines;
pub use polygons::{FramePinsError, PieceEdge, PieceMeshError, PolygonOptions};
pub use validation::{BarElement, CompatibleError};

pub use frame_outlines::FrameOutlinesError;
pub use truss::TrussError;
pub(crate) use truss::{check_same_bars, conflicts_in, corresponding_nodes};
