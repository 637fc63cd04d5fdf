//! Errors of the common triangulation of two trusses.

use crate::geometry::Side;
use crate::work::budget::WorkloadTooLarge;
use crate::work::progress::Cancelled;

/// Maximum number of nodes of a panel (resource limit: at this size the dynamic program examines
/// 160 million triangles, in about a second).
pub(in crate::compatible) const MAX_PANEL_NODES: usize = 1000;

/// Reason why two trusses have no common triangulation. Indices of nodes and bars start at 0 in
/// fields and in messages, as in truss files.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrussError {
    /// The trusses have different numbers of nodes. The field contains the numbers of source and
    /// target.
    #[error("the source truss has {} nodes and the target {}; both need the same nodes in the same order", .0[0], .0[1])]
    NodeCounts([usize; 2]),
    /// A bar exists in only one of the trusses.
    #[error("the bar between nodes {} and {} is only in the {only_in}; both trusses need the same bars", nodes[0], nodes[1])]
    BarsDiffer {
        /// Nodes of the bar.
        nodes: [u32; 2],
        /// The only design that has the bar.
        only_in: Side,
    },
    /// All panels have opposite orientation in the two designs: one truss is a mirror image of the
    /// other.
    #[error(
        "the target truss is a mirror image of the source; mirror one of them (placement, mirror = true)"
    )]
    Mirrored,
    /// The panel with these nodes has opposite orientation in the two designs.
    #[error("the panel of nodes {} is turned over between source and target; move its nodes in one design", list_first(.0, SHOWN))]
    Flipped(Vec<u32>),
    /// No triangulation of the panel with these nodes is valid in both designs.
    #[error("the panel of nodes {} has no triangles that are valid in both designs; add a bar or a node inside it", list_first(.0, SHOWN))]
    NoTriangulation(Vec<u32>),
    /// The panel with these nodes has more than `MAX_PANEL_NODES` nodes.
    #[error("the panel of nodes {} has {} nodes, more than {MAX_PANEL_NODES}; divide it by bars", list_first(.0, SHOWN), .0.len())]
    TooLarge(Vec<u32>),
    /// Too many bars cross without a common node.
    #[error(transparent)]
    TooMuch(#[from] WorkloadTooLarge),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Maximum number of nodes listed in a message (heuristic: a few nodes show where a panel is; a
/// panel can have hundreds).
const SHOWN: usize = 8;

/// Formats the first `shown` numbers of a list, as in "0, 4, 5 and 9 more".
pub(in crate::compatible) fn list_first<T: ToString>(numbers: &[T], shown: usize) -> String {
    let names: Vec<String> = numbers.iter().take(shown).map(T::to_string).collect();
    match numbers.len().saturating_sub(shown) {
        0 => names.join(", "),
        more => format!("{} and {more} more", names.join(", ")),
    }
}
