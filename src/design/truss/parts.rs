//! The data of a truss as stored in its JSON file, and its validation.

use crate::colour::Rgb;
use crate::design::json_error::JsonError;
use crate::geometry::{Bounds, DVec2, DesignSizeError, RANGE_MESSAGE, is_in_range};
use serde::Deserialize;
use std::collections::HashMap;

/// Unvalidated data of a truss, as stored in its file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussParts {
    /// Node positions, y up.
    pub nodes: Vec<DVec2>,
    /// The two nodes of each bar, as indices into `nodes`.
    pub bars: Vec<[u32; 2]>,
    /// Supports, each with its node.
    #[serde(default)]
    pub supports: Vec<TrussSupport>,
    /// Loads, each with its node.
    #[serde(default)]
    pub loads: Vec<TrussLoad>,
    /// Cross-sectional area of each bar, positive, in any unit; empty if not given.
    #[serde(default)]
    pub areas: Vec<f64>,
    /// Colour of each bar; empty if not given.
    #[serde(default)]
    pub colours: Vec<Rgb>,
    /// Materials to which `bar_materials` refers.
    #[serde(default)]
    pub materials: Vec<TrussMaterial>,
    /// Material of each bar, as an index into `materials`; empty if not given.
    #[serde(default)]
    pub bar_materials: Vec<u32>,
}

/// Support of a node, which can fix its displacement along x and along y.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussSupport {
    /// Node index, counted from 0.
    pub node: u32,
    /// Whether the displacement of the node is fixed along the x axis and along the y axis of the
    /// plane.
    pub fixed: [bool; 2],
}

/// Force at a node.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussLoad {
    /// Node index, counted from 0.
    pub node: u32,
    /// Force vector, y up, in any unit.
    pub force: DVec2,
}

/// Material of bars.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussMaterial {
    /// Display name.
    pub name: String,
    /// Young's modulus, positive, in any unit; `None` if not given.
    #[serde(default)]
    pub youngs_modulus: Option<f64>,
    /// Mass per volume, positive, in any unit; `None` if not given.
    #[serde(default)]
    pub density: Option<f64>,
}

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
        /// Kind of the missing entry: "node" or "material".
        kind: &'static str,
        /// Index of the missing entry.
        named: u32,
        /// Number of entries of the missing kind that exist.
        count: usize,
    },
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

/// Returns an error for the first item that is not valid. `what` names the kind of the items,
/// `rule` advises the user.
fn check_items<T>(
    what: &'static str,
    rule: &'static str,
    items: &[T],
    is_valid: impl Fn(&T) -> bool,
) -> Result<(), TrussInputError> {
    match items.iter().position(|item| !is_valid(item)) {
        Some(index) => Err(TrussInputError::Number { what, index, rule }),
        None => Ok(()),
    }
}

/// Checks references, given as pairs (index of the referring entry, index it refers to). Returns an
/// error for the first one that is not below `count`, the number of entries of the kind `kind`.
fn check_references(
    what: &'static str,
    mut references: impl Iterator<Item = (usize, u32)>,
    kind: &'static str,
    count: usize,
) -> Result<(), TrussInputError> {
    match references.find(|&(_, named)| named as usize >= count) {
        Some((index, named)) => Err(TrussInputError::OutOfRange {
            what,
            index,
            kind,
            named,
            count,
        }),
        None => Ok(()),
    }
}

impl TrussParts {
    /// Checks all guarantees of [`Truss`](super::Truss).
    pub(super) fn check(&self) -> Result<(), TrussInputError> {
        if self.bars.is_empty() {
            let nodes = self.nodes.len();
            return Err(TrussInputError::NoBars { nodes });
        }
        // The order matters: later checks use indices that earlier checks have validated.
        self.check_numbers()?;
        self.check_indices()?;
        self.check_bars()?;
        self.check_nodes_are_used()?;
        let all = Bounds::of(self.nodes.iter().copied());
        Ok(all
            .map_or(Ok(0.0), |all| DesignSizeError::check(&all))
            .map(drop)?)
    }

    /// Checks that all numbers are finite and within their ranges.
    fn check_numbers(&self) -> Result<(), TrussInputError> {
        const FINITE: &str = "use finite numbers";
        const POSITIVE: &str = "use finite numbers above zero";
        let is_positive = |&x: &f64| x.is_finite() && x > 0.0;
        if let Some(node) = self.nodes.iter().position(|&p| !is_in_range(p)) {
            return Err(TrussInputError::CoordinateRange(node));
        }
        check_items("load", FINITE, &self.loads, |l| l.force.is_finite())?;
        check_items("area", POSITIVE, &self.areas, is_positive)?;
        check_items("material", POSITIVE, &self.materials, |m| {
            [m.youngs_modulus, m.density]
                .iter()
                .flatten()
                .all(is_positive)
        })
    }

    /// Checks list lengths and that all indices refer to existing entries.
    fn check_indices(&self) -> Result<(), TrussInputError> {
        let bars = self.bars.len();
        for (list, found) in [
            ("areas", self.areas.len()),
            ("colours", self.colours.len()),
            ("bar_materials", self.bar_materials.len()),
        ] {
            if found != 0 && found != bars {
                return Err(TrussInputError::PerBar { list, found, bars });
            }
        }
        let nodes = self.nodes.len();
        let bars = self.bars.iter().enumerate();
        let ends = bars.flat_map(|(i, bar)| bar.map(|n| (i, n)));
        check_references("bar", ends, "node", nodes)?;
        let supports = self.supports.iter().map(|s| s.node);
        check_references("support", supports.enumerate(), "node", nodes)?;
        let loads = self.loads.iter().map(|l| l.node);
        check_references("load", loads.enumerate(), "node", nodes)?;
        let of_bars = self.bar_materials.iter().copied().enumerate();
        let materials = self.materials.len();
        check_references("the material of bar", of_bars, "material", materials)
    }

    /// Checks that bars have a length and are unique.
    fn check_bars(&self) -> Result<(), TrussInputError> {
        let mut seen = HashMap::new();
        for (bar, &[a, b]) in self.bars.iter().enumerate() {
            // Compares positions, not indices: a bar between two nodes at one position has no
            // direction either.
            if self.nodes[a as usize] == self.nodes[b as usize] {
                let nodes = [a, b];
                return Err(TrussInputError::NoLength { bar, nodes });
            }
            // Bars have no direction: [a, b] and [b, a] are the same bar.
            if let Some(first) = seen.insert([a.min(b), a.max(b)], bar) {
                let second = bar;
                return Err(TrussInputError::Duplicate { first, second });
            }
        }
        Ok(())
    }

    /// Checks that every node belongs to a bar.
    fn check_nodes_are_used(&self) -> Result<(), TrussInputError> {
        let mut is_used = vec![false; self.nodes.len()];
        for &node in self.bars.iter().flatten() {
            is_used[node as usize] = true;
        }
        match is_used.iter().position(|&used| !used) {
            Some(node) => Err(TrussInputError::UnusedNode(node)),
            None => Ok(()),
        }
    }
}
