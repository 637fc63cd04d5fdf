//! Why two trusses have no common triangulation.

use crate::geometry::Side;
use crate::work::budget::WorkloadTooLarge;
use crate::work::progress::Cancelled;

/// Most nodes of one panel; the program takes about a second then, over 160
/// million triangles.
pub(super) const MAX_PANEL_NODES: usize = 1000;

/// Why two trusses have no common triangulation. Nodes and bars count from 0,
/// as in the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrussError {
    /// Different numbers of nodes.
    #[error("the source truss has {} nodes and the target {}; both need the same nodes in the same order", .0[0], .0[1])]
    NodeCounts([usize; 2]),
    /// A bar of one design that is not in the other.
    #[error("the bar between nodes {} and {} is only in the {only_in}; both trusses need the same bars", nodes[0], nodes[1])]
    BarsDiffer {
        /// Its nodes.
        nodes: [u32; 2],
        /// The design that has it.
        only_in: Side,
    },
    /// Every panel is turned over.
    #[error(
        "the target truss is a mirror image of the source; mirror one of them (placement, mirror = true)"
    )]
    Mirrored,
    /// A panel is turned over.
    #[error("the panel of nodes {} is turned over between source and target; move its nodes in one design", list_first(.0, SHOWN))]
    Flipped(Vec<u32>),
    /// No diagonals are valid in both designs.
    #[error("the panel of nodes {} has no triangles that are valid in both designs; add a bar or a node inside it", list_first(.0, SHOWN))]
    NoTriangulation(Vec<u32>),
    /// A panel of very many nodes.
    #[error("the panel of nodes {} has {} nodes, more than {MAX_PANEL_NODES}; divide it by bars", list_first(.0, SHOWN), .0.len())]
    TooLarge(Vec<u32>),
    /// Bars cross very often.
    #[error(transparent)]
    TooMuch(#[from] WorkloadTooLarge),
    /// Nobody wants the result.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Most nodes that a message names: a panel can have hundreds, and a few show
/// where it is.
const SHOWN: usize = 8;

/// "0, 4, 5 and 9 more".
pub(in crate::compatible) fn list_first<T: ToString>(numbers: &[T], shown: usize) -> String {
    let names: Vec<String> = numbers.iter().take(shown).map(T::to_string).collect();
    match numbers.len().saturating_sub(shown) {
        0 => names.join(", "),
        more => format!("{} and {more} more", names.join(", ")),
    }
}
