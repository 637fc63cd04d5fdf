//! Why parts do not make a truss.

use crate::design::json::JsonError;

/// Why parts do not make a truss. Nodes and bars count from 0, as in the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrussInputError {
    /// Not JSON, or not of this form.
    #[error(transparent)]
    Json(#[from] JsonError),
    /// There is no bar.
    #[error("the truss has {nodes} nodes and no bars; give bars as pairs of node numbers")]
    NoBars {
        /// How many nodes there are.
        nodes: usize,
    },
    /// A number is NaN or infinite, or not positive where it must be.
    #[error("{what} {index} has a number that cannot be used; {rule}")]
    Number {
        /// What has it.
        what: &'static str,
        /// Its index.
        index: usize,
        /// What is allowed.
        rule: &'static str,
    },
    /// Something names what does not exist.
    #[error(
        "{what} {index} names {kind} {named}, but there are {count}, counted from 0; correct the number"
    )]
    OutOfRange {
        /// What names it.
        what: &'static str,
        /// Its index.
        index: usize,
        /// What kind of thing is named.
        kind: &'static str,
        /// The number.
        named: u32,
        /// How many of that kind there are.
        count: usize,
    },
    /// A bar from a node to itself or to another one at the same place.
    #[error("bar {bar} joins nodes {} and {} at one and the same place; move a node or remove the bar", nodes[0], nodes[1])]
    NoLength {
        /// The bar.
        bar: usize,
        /// Its nodes.
        nodes: [u32; 2],
    },
    /// Two bars between the same nodes.
    #[error("bars {first} and {second} join the same nodes; remove one of them")]
    Duplicate {
        /// The earlier one.
        first: usize,
        /// The later one.
        second: usize,
    },
    /// A node that no bar reaches.
    #[error("node {0} is held by no bar; add a bar to it, or remove it")]
    Loose(usize),
    /// A list that must have one entry for each bar, or none.
    #[error(
        "\"{list}\" has {found} entries for {bars} bars; give one for each bar, or leave it out"
    )]
    PerBar {
        /// The key.
        list: &'static str,
        /// Its length.
        found: usize,
        /// How many bars there are.
        bars: usize,
    },
}
