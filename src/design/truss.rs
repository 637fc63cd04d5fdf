//! Trusses: nodes joined by bars, and their file format.
//!
//! The file is one JSON object. Nodes and bars are numbered from 0; unknown
//! keys are errors.
//!
//! ```json
//! {
//!   "nodes": [[0, 0], [1, 0], [0, 1]],
//!   "bars": [[0, 1], [1, 2], [2, 0]],
//!   "supports": [{ "node": 0, "fixed": [true, true] }],
//!   "loads": [{ "node": 2, "force": [0, -1] }],
//!   "areas": [0.01, 0.01, 0.02],
//!   "materials": [{ "name": "steel", "youngs_modulus": 2.1e11, "density": 7850 }],
//!   "bar_materials": [0, 0, 0]
//! }
//! ```
//!
//! `nodes` (x, y, y up) and `bars` are needed. Supports (whether x and y are
//! held), loads, section areas (one for each bar, or none), materials and
//! `bar_materials` (an index for each bar, or none) are checked and kept for
//! analyses to come; nothing here computes with them.
//!
//! Guaranteed: coordinates are finite, bars join two different nodes at
//! different places, no bar is given twice, every node is held by a bar.

use crate::geometry::{Bounds, DVec2, Similarity};
use serde::Deserialize;
use std::collections::HashMap;

/// Nodes and bars, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Truss(TrussParts);

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
    pub supports: Vec<Support>,
    /// Forces at nodes.
    #[serde(default)]
    pub loads: Vec<Load>,
    /// Section area of each bar, or empty.
    #[serde(default)]
    pub areas: Vec<f64>,
    /// Materials that bars may be of.
    #[serde(default)]
    pub materials: Vec<Material>,
    /// Index of each bar's material, or empty.
    #[serde(default)]
    pub bar_materials: Vec<u32>,
}

/// A node that is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// The node, from 0.
    pub node: u32,
    /// Whether it is held along x and along y of the design as drawn.
    pub fixed: [bool; 2],
}

/// A force at a node.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// The node, from 0.
    pub node: u32,
    /// The force along x and y.
    pub force: DVec2,
}

/// A material that bars may be of.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
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
pub enum TrussInputError {
    /// Not JSON, or not of this form.
    #[error("line {line}, column {column}: {message}; correct the file")]
    Json {
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What was found.
        message: String,
    },
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

impl Truss {
    /// A truss of nodes and bars alone.
    ///
    /// # Errors
    /// [`TrussInputError`] names the first node or bar that cannot be used.
    ///
    /// ```
    /// use morphospace::{design::Truss, geometry::DVec2};
    /// let truss = Truss::new(vec![DVec2::ZERO, DVec2::X], vec![[0, 1]])?;
    /// assert_eq!(truss.bars(), [[0, 1]]);
    /// # Ok::<(), morphospace::design::TrussInputError>(())
    /// ```
    pub fn new(nodes: Vec<DVec2>, bars: Vec<[u32; 2]>) -> Result<Self, TrussInputError> {
        Self::from_parts(TrussParts {
            nodes,
            bars,
            ..TrussParts::default()
        })
    }

    /// A truss with all that is known of it.
    ///
    /// # Errors
    /// [`TrussInputError`] names the first thing that cannot be used.
    pub fn from_parts(parts: TrussParts) -> Result<Self, TrussInputError> {
        if parts.bars.is_empty() {
            let nodes = parts.nodes.len();
            return Err(TrussInputError::NoBars { nodes });
        }
        parts.check_numbers()?;
        parts.check_indices()?;
        parts.check_bars()?;
        parts.check_held()?;
        Ok(Self(parts))
    }

    /// A truss from the text of its file.
    ///
    /// # Errors
    /// [`TrussInputError`] names the line, or the first thing that cannot be used.
    pub fn from_json(text: &str) -> Result<Self, TrussInputError> {
        let parts = serde_json::from_str(text).map_err(|e| {
            let message = e.to_string();
            let place = message.rfind(" at line").unwrap_or(message.len());
            TrussInputError::Json {
                line: e.line(),
                column: e.column(),
                message: message[..place].to_owned(),
            }
        })?;
        Self::from_parts(parts)
    }

    /// Places of the nodes, y up.
    #[must_use]
    pub fn nodes(&self) -> &[DVec2] {
        &self.0.nodes
    }

    /// The two nodes of each bar.
    #[must_use]
    pub fn bars(&self) -> &[[u32; 2]] {
        &self.0.bars
    }

    /// Everything that is known of the truss.
    #[must_use]
    pub fn parts(&self) -> &TrussParts {
        &self.0
    }

    /// The two ends of each bar.
    pub fn segments(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        self.0
            .bars
            .iter()
            .map(|bar| bar.map(|node| self.0.nodes[node as usize]))
    }

    /// The smallest box around all nodes; flat when they lie on one line.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.0.nodes.iter().copied())
            .unwrap_or_else(|| unreachable!("a truss has a bar and so nodes"))
    }

    /// The truss laid down by a similarity. Forces turn with it and keep
    /// their size; supports keep holding along x and y.
    #[must_use]
    pub fn transformed(&self, by: &Similarity) -> Self {
        let turn = Similarity {
            scale: 1.0,
            offset: DVec2::ZERO,
            ..*by
        };
        let mut parts = self.0.clone();
        for node in &mut parts.nodes {
            *node = by.apply(*node);
        }
        for load in &mut parts.loads {
            load.force = turn.apply(load.force);
        }
        Self(parts)
    }
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

impl TrussParts {
    fn check_numbers(&self) -> Result<(), TrussInputError> {
        const FINITE: &str = "give finite coordinates";
        const POSITIVE: &str = "give finite numbers above zero";
        let positive = |&x: &f64| x.is_finite() && x > 0.0;
        numbers("node", FINITE, &self.nodes, |p| p.is_finite())?;
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
            ("bar_materials", self.bar_materials.len()),
        ] {
            if found != 0 && found != bars {
                return Err(TrussInputError::PerBar { list, found, bars });
            }
        }
        let ends = self.bars.iter().enumerate();
        self.in_range("bar", ends.flat_map(|(i, bar)| bar.map(|n| (i, n))))?;
        self.in_range("support", self.supports.iter().map(|s| s.node).enumerate())?;
        self.in_range("load", self.loads.iter().map(|l| l.node).enumerate())?;
        let count = self.materials.len();
        let bad = self.bar_materials.iter().position(|&m| m as usize >= count);
        match bad {
            Some(index) => Err(TrussInputError::OutOfRange {
                what: "the material of bar",
                index,
                kind: "material",
                named: self.bar_materials[index],
                count,
            }),
            None => Ok(()),
        }
    }

    fn in_range(
        &self,
        what: &'static str,
        named: impl Iterator<Item = (usize, u32)>,
    ) -> Result<(), TrussInputError> {
        let count = self.nodes.len();
        let mut bad = named.filter(|&(_, node)| node as usize >= count);
        match bad.next() {
            Some((index, named)) => Err(TrussInputError::OutOfRange {
                what,
                index,
                kind: "node",
                named,
                count,
            }),
            None => Ok(()),
        }
    }

    fn check_bars(&self) -> Result<(), TrussInputError> {
        let mut seen = HashMap::new();
        for (bar, &[a, b]) in self.bars.iter().enumerate() {
            if self.nodes[a as usize] == self.nodes[b as usize] {
                let nodes = [a, b];
                return Err(TrussInputError::NoLength { bar, nodes });
            }
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

#[cfg(test)]
mod tests {
    use super::*;

    const FULL: &str = r#"{
        "nodes": [[0, 0], [1, 0], [0, 1]],
        "bars": [[0, 1], [1, 2], [2, 0]],
        "supports": [{ "node": 0, "fixed": [true, true] }],
        "loads": [{ "node": 2, "force": [0, -1] }],
        "areas": [0.01, 0.01, 0.02],
        "materials": [{ "name": "steel", "youngs_modulus": 2.1e11, "density": 7850 }],
        "bar_materials": [0, 0, 0]
    }"#;

    fn error(from: &str, to: &str) -> String {
        assert!(FULL.contains(from), "{from}");
        let text = FULL.replace(from, to);
        Truss::from_json(&text).expect_err(to).to_string()
    }

    #[test]
    fn a_full_file_is_read_and_turned() {
        let truss = Truss::from_json(FULL).expect("valid");
        assert_eq!(truss.bars().len(), 3);
        assert_eq!(truss.parts().materials[0].density, Some(7850.0));
        let turned = truss.transformed(&Similarity {
            rotation: std::f64::consts::FRAC_PI_2,
            scale: 3.0,
            offset: DVec2::ONE,
            ..Similarity::IDENTITY
        });
        assert!((turned.nodes()[1] - DVec2::new(1.0, 4.0)).length() < 1e-12);
        assert!((turned.parts().loads[0].force - DVec2::X).length() < 1e-12);
    }

    #[test]
    fn each_fault_is_named() {
        assert!(error("[2, 0]]", "[2, 9]]").starts_with("bar 2 names node 9, but there are 3"));
        assert!(error("[2, 0]]", "[2, 2]]").starts_with("bar 2 joins nodes 2 and 2"));
        assert!(error("[2, 0]]", "[1, 0]]").starts_with("bars 0 and 2 join"));
        assert!(error("[0, 1]],", "[0, 1], [5, 5]],").starts_with("node 3 is held by no bar"));
        assert!(error("\"node\": 0", "\"node\": 3").starts_with("support 0 names node 3"));
        assert!(error("\"node\": 2", "\"node\": 7").starts_with("load 0 names node 7"));
        assert!(error("0.02]", "-0.02]").starts_with("area 2"));
        assert!(error(", 0.02]", "]").contains("2 entries for 3 bars"));
        assert!(error("[0, 0, 0]", "[0, 1, 0]").starts_with("the material of bar 1 names"));
        assert!(error("7850", "0").starts_with("material 0"));
        assert!(error("\"areas\"", "\"area\"").starts_with("line 6, column"));
        assert!(error("[[0, 0],", "[[0, 1e999],").starts_with("line 2, column"));
        assert!(error("[[0, 0],", "[[0, NaN],").starts_with("line 2, column"));
        assert!(error("[[0, 1], [1, 2], [2, 0]]", "[]").contains("no bars"));
    }

    #[test]
    fn nodes_at_one_place_give_a_bar_no_length() {
        let error = Truss::new(vec![DVec2::ONE; 2], vec![[0, 1]]).expect_err("no length");
        assert_eq!(
            error,
            TrussInputError::NoLength {
                bar: 0,
                nodes: [0, 1]
            }
        );
    }
}
