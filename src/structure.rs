//! Statics of trusses and frames, and of everything between them.
//!
//! A [`StructuralBlend`] holds the members, supports and loads of several designs with the same
//! bars. A [`StructureSolver`] analyses it with any weights and any places of its nodes: internal
//! forces, displacements, reactions, mass, first natural frequency, and whether it is a mechanism.
//!
//! All quantities are in SI units (m, N, kg, Pa), and vectors are in the axes of the common frame
//! of the designs. The analysis is linear and of first order: it is a concept check, not a design
//! check by a building code.
//!
//! - `model`: structure of one design in SI units; `blend`: structures of several designs
//! - `element`: stiffness and internal forces of a member
//! - `restraints`: supports of several designs; `node_axes`: fixed displacements
//! - `solver`: statics and the first mode, with the system of equations in `pattern`
//! - `buckling`: the load factor at which a structure buckles
//! - `stability_proof`: proof that a recorded structure stands at every t
//! - `sizing`: least areas of members; `truss_between`: a truss between designs, for a file
//! - `tables`: all numbers at one t
//! - `words`: numbers and lists of nodes in sentences
//! - `sample`: results at one t; `shape_faults`, `findings`, `limits`: the concept check
//! - `film`: analysis of a whole transition; `quantity`: its measures for graphs; `error`: errors and notes

mod blend;
mod buckling;
mod element;
mod error;
mod film;
mod findings;
mod limits;
mod model;
mod node_axes;
mod pattern;
mod quantity;
mod restraints;
mod sample;
mod shape_faults;
mod sizing;
mod solver;
mod stability_proof;
mod tables;
mod truss_between;
mod words;

#[cfg(test)]
mod tests;

pub use blend::{LoadSelection, StructuralBlend};
pub use element::{MemberForces, MemberProperties};
pub use error::{StructureError, StructureNote};
pub use film::{FilmStructure, Soundness, TransitionStructure, has_structure};
pub use findings::{StructureFault, StructureFinding};
pub use limits::StructureLimits;
pub use quantity::StructureQuantity;
pub use sample::{BarValue, StructureSample};
pub use sizing::{SizedMembers, SizingOptions};
pub use solver::{NodeDisplacement, StructuralState, StructureSolver};
pub use stability_proof::StabilityProof;
pub use tables::{BarResults, NodeResults, StructureTables};
pub use words::NodeList;
