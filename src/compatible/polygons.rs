//! Compatible triangulation of one piece (a matched connected part) with corresponding boundary
//! points in two designs. The piece is a simple polygon, which may have holes or be cut open along
//! slits. The steps:
//!
//! 1. A refined triangulation of either polygon is transferred to the other without folds
//!    ([`transfer`]). This gives good angles but may fail.
//! 2. If the transfers in both directions fail, a base mesh is built, which always exists in exact
//!    arithmetic ([`overlay`] for discs, [`bridges`] for pieces with holes). Unneeded vertices are
//!    then removed from it.
//! 3. The angles are improved in both designs at once ([`quality`]).
//!
//! Afterwards, boundary points may [`slide`] along the outlines to places where the two
//! triangulations are more alike. [`triangulate_many`] triangulates a piece in many designs at
//! once.
//!
//! Guaranteed: every face is positive in both designs, by exact predicates; the ring points are the
//! first vertices, in order and unmoved; ring edges are mesh edges; the same input gives the same
//! mesh; exchanging the designs exchanges the embeddings, bit by bit. Not guaranteed: any bound on
//! angles or distortion, which depend on the match. A polygon thinner than floating-point precision
//! may have no room for the vertices of a common triangulation. Then the result is an error, never
//! a wrong mesh.

mod advancing_front;
mod boundary_rings;
mod bridges;
mod chords;
mod coarsen;
mod edge_grid;
mod error;
mod face_cost;
mod frame_pins;
mod many_designs;
mod mesh_energy;
mod options;
mod overlay;
mod pair_mesh;
mod quality;
mod relax;
mod ring_contacts;
mod slide;
mod springs;
#[cfg(test)]
mod tests;
mod transfer;
mod two_designs;
mod untangle;

pub use error::{PieceEdge, PieceMeshError};
pub use frame_pins::FramePinsError;
pub(super) use many_designs::triangulate_many;
pub use options::PolygonOptions;
pub(crate) use slide::slide_outlines;
