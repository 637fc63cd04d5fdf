//! Compatible triangulation of one connected piece with corresponding
//! boundary vertices in two designs: a simple polygon, maybe with holes, maybe
//! cut open along slits.
//!
//! First the foldover-free transfer of either polygon's refined triangulation
//! to the other ([`transfer`]): good angles, no guarantee. Where it fails in
//! both directions, the guaranteed base ([`overlay`] of discs, [`bridges`] for
//! holes), thinned out. Then quality in both designs at once ([`quality`]).
//! What is triangulated may [`slide`]: the outlines' vertices then find places
//! by which the two triangulations are more alike. Many designs at once: [`triangulate_many`].
//!
//! Guaranteed: every face is positive in both designs by exact predicates;
//! the polygons' vertices come first, in order and unmoved, and their edges
//! are edges of the mesh; the same input gives the same mesh, and the designs
//! exchanged give the mesh with its embeddings exchanged, bit by bit. Not guaranteed:
//! any angle or any distortion, which the match between the two decides.
//! Polygons thinner than the last digits of their coordinates may leave no
//! room for the vertices that a common triangulation needs: an error, never a
//! wrong mesh.

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
