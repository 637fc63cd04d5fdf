//! Errors of the common triangulation of two trusses.

use crate::geometry::Side;
use crate::work::budget::WorkloadTooLarge;
use crate::work::progress::Cancelled;

/// Maximum number of nodes of a panel (resource limit: the dynamic program then takes about a
/// second, for 160 million triangles).
pub(super) const MAX_PANEL_NODES: usize = 1000;

/// Reason why two trusses have no common triangulation. Nodes and bars count from 0, as in the
/// file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrussError {
    /// The trusses have different numbers of nodes.
    #[error("the source truss has {} nodes and the target {}; both need the same nodes in the same order", .0[0], .0[1])]
    NodeCounts([usize; 2]),
    /// A bar exists in only one of the trusses.
    #[error("the bar between nodes {} and {} is only in the {only_in}; both trusses need the same bars", nodes[0], nodes[1])]
    BarsDiffer {
        /// Nodes of the bar.
        nodes: [u32; 2],
        /// Design that has the bar.
        only_in: Side,
    },
    /// All panels have opposite orientation in the two designs.
    #[error(
        "the target truss is a mirror image of the source; mirror one of them (placement, mirror = true)"
    )]
    Mirrored,
    /// A panel has opposite orientation in the two designs; its nodes.
    #[error("the panel of nodes {} is turned over between source and target; move its nodes in one design", list_first(.0, SHOWN))]
    Flipped(Vec<u32>),
    /// No triangulation of a panel is valid in both designs; its nodes.
    #[error("the panel of nodes {} has no triangles that are valid in both designs; add a bar or a node inside it", list_first(.0, SHOWN))]
    NoTriangulation(Vec<u32>),
    /// A panel has too many nodes to triangulate; its nodes.
    #[error("the panel of nodes {} has {} nodes, more than {MAX_PANEL_NODES}; divide it by bars", list_first(.0, SHOWN), .0.len())]
    TooLarge(Vec<u32>),
    /// Too many bars cross.
    #[error(transparent)]
    TooMuch(#[from] WorkloadTooLarge),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Maximum number of nodes listed in a message (resource limit: a few show where a panel is, and it
/// can have hundreds).
const SHOWN: usize = 8;

/// Formats the first numbers of a list, as in "0, 4, 5 and 9 more".
pub(in crate::compatible) fn list_first<T: ToString>(numbers: &[T], shown: usize) -> String {
    let names: Vec<String> = numbers.iter().take(shown).map(T::to_string).collect();
    match numbers.len().saturating_sub(shown) {
        0 => names.join(", "),
        more => format!("{} and {more} more", names.join(", ")),
    }
}
