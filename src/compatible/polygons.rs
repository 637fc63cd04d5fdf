//! Compatible triangulation of one connected piece with corresponding boundary points in two
//! designs: a simple polygon, which may have holes or be cut open along slits.
//!
//! 1. The refined triangulation of either polygon is transferred to the other without folds
//!    ([`transfer`]): good angles, no guarantee.
//! 2. If both directions fail, the guaranteed base is built ([`overlay`] of discs, [`bridges`] for
//!    holes) and thinned out.
//! 3. Quality is improved in both designs at once ([`quality`]).
//!
//! Then boundary points may [`slide`] along the outlines to places where the two triangulations are
//! more alike. [`triangulate_many`] handles many designs at once.
//!
//! Guaranteed: every face is positive in both designs by exact predicates; the ring points come
//! first, in order and unmoved, and ring edges are mesh edges; the same input gives the same mesh,
//! and exchanging the designs exchanges the embeddings, bit by bit. Not guaranteed: any angle or
//! distortion, which depend on the match. A polygon thinner than floating-point precision may have
//! no room for the vertices of a common triangulation; that is an error, never a wrong mesh.

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
