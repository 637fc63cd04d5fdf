//! Errors of truss files.

use crate::design::json_error::JsonError;
use crate::geometry::{DesignSizeError, RANGE_MESSAGE};

/// Error of validating a truss. Nodes and bars are counted from 0, as in the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrussInputError {
    /// The text is not JSON or does not have the required structure.
    #[error(transparent)]
    Json(#[from] JsonError),
    /// The truss has no bars.
    #[error("the truss has {nodes} nodes and no bars; add bars as pairs of node numbers")]
    NoBars {
        /// Number of nodes.
        nodes: usize,
    },
    /// A coordinate is not finite, or its absolute value exceeds [`MAX_COORDINATE`]. Holds the
    /// index of the node.
    ///
    /// [`MAX_COORDINATE`]: crate::geometry::MAX_COORDINATE
    #[error("node {0} {RANGE_MESSAGE}")]
    CoordinateRange(usize),
    /// The truss is too small, or too far from the origin for its size.
    #[error(transparent)]
    Size(#[from] DesignSizeError),
    /// A number is not finite, or not positive although it must be.
    #[error("{what} {index} has an invalid number; {rule}")]
    Number {
        /// Kind of the entry, such as "load".
        what: &'static str,
        /// Index of the entry in its list.
        index: usize,
        /// Advice for the user: which numbers are allowed.
        rule: &'static str,
    },
    /// A bar, support or load refers to a node or material that does not exist.
    #[error(
        "{what} {index} refers to {kind} {named}, but there are {count}, counted from 0; correct the number"
    )]
    OutOfRange {
        /// Kind of the referring entry, such as "load".
        what: &'static str,
        /// Index of the referring entry in its list.
        index: usize,
        /// Kind of the missing entry: "node", "bar", "section" or "material".
        kind: &'static str,
        /// Index of the missing entry.
        named: u32,
        /// Number of entries of the missing kind that exist.
        count: usize,
    },
    /// A support has both fixed displacements and rollers, or rollers without a direction. Holds the
    /// index of the support.
    #[error(
        "support {0} needs either \"fixed\" displacements or \"rolls_along\" with a direction; remove one of them"
    )]
    Rollers(usize),
    /// A section gives its stiffness in several ways, or it is an I section that does not give it.
    #[error(
        "section {0} needs exactly one of \"shape\", \"radius_of_gyration\" and \"second_moment\"; an I section needs one of the last two as well"
    )]
    SectionStiffness(usize),
    /// A bar has no length: both ends are the same node, or two nodes at the same position.
    #[error("bar {bar} joins nodes {} and {} at the same position; move a node or remove the bar", nodes[0], nodes[1])]
    NoLength {
        /// Index of the bar.
        bar: usize,
        /// Indices of the nodes of the bar.
        nodes: [u32; 2],
    },
    /// Two bars join the same nodes.
    #[error("bars {first} and {second} join the same nodes; remove one of them")]
    Duplicate {
        /// Index of the earlier bar.
        first: usize,
        /// Index of the later bar.
        second: usize,
    },
    /// A node belongs to no bar. Holds the index of the node.
    #[error("node {0} belongs to no bar; add a bar to it or remove it")]
    UnusedNode(usize),
    /// A list has entries, but not exactly one per bar.
    #[error("\"{list}\" has {found} entries for {bars} bars; use one per bar or remove the list")]
    PerBar {
        /// Key of the list.
        list: &'static str,
        /// Number of entries in the list.
        found: usize,
        /// Number of bars.
        bars: usize,
    },
}
