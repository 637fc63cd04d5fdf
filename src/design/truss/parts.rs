//! What a truss consists of, as it stands in a file, and the checks of it.

use crate::colour::Rgb;
use crate::design::json_error::JsonError;
use crate::geometry::{Bounds, DVec2, DesignSizeError, RANGE_MESSAGE, is_in_range};
use serde::Deserialize;
use std::collections::HashMap;

/// What a truss consists of, unchecked, as it stands in a file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussParts {
    /// Places of the nodes, y up.
    pub nodes: Vec<DVec2>,
    /// The two nodes of each bar, from 0.
    pub bars: Vec<[u32; 2]>,
    /// Nodes that are held.
    #[serde(default)]
    pub supports: Vec<TrussSupport>,
    /// Forces at nodes.
    #[serde(default)]
    pub loads: Vec<TrussLoad>,
    /// Section area of each bar, or empty.
    #[serde(default)]
    pub areas: Vec<f64>,
    /// Colour of each bar, or empty.
    #[serde(default)]
    pub colours: Vec<Rgb>,
    /// Materials that bars may be of.
    #[serde(default)]
    pub materials: Vec<TrussMaterial>,
    /// Index of each bar's material, or empty.
    #[serde(default)]
    pub bar_materials: Vec<u32>,
}

/// A node that is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussSupport {
    /// The node, from 0.
    pub node: u32,
    /// Whether it is held along x and along y of the design as drawn.
    pub fixed: [bool; 2],
}

/// A force at a node.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussLoad {
    /// The node, from 0.
    pub node: u32,
    /// The force along x and y.
    pub force: DVec2,
}

/// A material that bars may be of.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussMaterial {
    /// What it is called.
    pub name: String,
    /// Young's modulus, positive.
    #[serde(default)]
    pub youngs_modulus: Option<f64>,
    /// Mass per volume, positive.
    #[serde(default)]
    pub density: Option<f64>,
}

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
    /// A coordinate is no number, or beyond [`MAX_COORDINATE`].
    ///
    /// [`MAX_COORDINATE`]: crate::geometry::MAX_COORDINATE
    #[error("node {0} {RANGE_MESSAGE}")]
    Place(usize),
    /// All nodes lie on one another, or as good as.
    #[error(transparent)]
    Size(#[from] DesignSizeError),
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

/// The first index whose item fails `good`, as an error.
fn numbers<T>(
    what: &'static str,
    rule: &'static str,
    items: &[T],
    good: impl Fn(&T) -> bool,
) -> Result<(), TrussInputError> {
    match items.iter().position(|item| !good(item)) {
        Some(index) => Err(TrussInputError::Number { what, index, rule }),
        None => Ok(()),
    }
}

/// Whether all that is named is there: so many of a kind.
fn in_range(
    what: &'static str,
    mut named: impl Iterator<Item = (usize, u32)>,
    (kind, count): (&'static str, usize),
) -> Result<(), TrussInputError> {
    match named.find(|&(_, named)| named as usize >= count) {
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
    /// Everything that a truss guarantees.
    pub(super) fn check(&self) -> Result<(), TrussInputError> {
        if self.bars.is_empty() {
            let nodes = self.nodes.len();
            return Err(TrussInputError::NoBars { nodes });
        }
        // In this order: bars index nodes, which the checks before have seen to.
        self.check_numbers()?;
        self.check_indices()?;
        self.check_bars()?;
        self.check_held()?;
        let all = Bounds::of(self.nodes.iter().copied());
        Ok(all
            .map_or(Ok(0.0), |all| DesignSizeError::check(&all))
            .map(drop)?)
    }

    fn check_numbers(&self) -> Result<(), TrussInputError> {
        const FINITE: &str = "give finite numbers";
        const POSITIVE: &str = "give finite numbers above zero";
        let positive = |&x: &f64| x.is_finite() && x > 0.0;
        if let Some(node) = self.nodes.iter().position(|&p| !is_in_range(p)) {
            return Err(TrussInputError::Place(node));
        }
        numbers("load", FINITE, &self.loads, |l| l.force.is_finite())?;
        numbers("area", POSITIVE, &self.areas, positive)?;
        numbers("material", POSITIVE, &self.materials, |m| {
            [m.youngs_modulus, m.density].iter().flatten().all(positive)
        })
    }

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
        let nodes = ("node", self.nodes.len());
        let ends = self.bars.iter().enumerate();
        in_range("bar", ends.flat_map(|(i, bar)| bar.map(|n| (i, n))), nodes)?;
        let supports = self.supports.iter().map(|s| s.node);
        in_range("support", supports.enumerate(), nodes)?;
        let loads = self.loads.iter().map(|l| l.node);
        in_range("load", loads.enumerate(), nodes)?;
        let of_bars = self.bar_materials.iter().copied().enumerate();
        let materials = ("material", self.materials.len());
        in_range("the material of bar", of_bars, materials)
    }

    fn check_bars(&self) -> Result<(), TrussInputError> {
        let mut seen = HashMap::new();
        for (bar, &[a, b]) in self.bars.iter().enumerate() {
            // By place and not by number: two nodes at one place give no direction either.
            if self.nodes[a as usize] == self.nodes[b as usize] {
                let nodes = [a, b];
                return Err(TrussInputError::NoLength { bar, nodes });
            }
            // A bar has no direction.
            if let Some(first) = seen.insert([a.min(b), a.max(b)], bar) {
                let second = bar;
                return Err(TrussInputError::Duplicate { first, second });
            }
        }
        Ok(())
    }

    fn check_held(&self) -> Result<(), TrussInputError> {
        let mut held = vec![false; self.nodes.len()];
        for &node in self.bars.iter().flatten() {
            held[node as usize] = true;
        }
        match held.iter().position(|&held| !held) {
            Some(node) => Err(TrussInputError::Loose(node)),
            None => Ok(()),
        }
    }
}
