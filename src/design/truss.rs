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
//!   "colours": ["#c0392b", "#c0392b", "#2c3e50"],
//!   "materials": [{ "name": "steel", "youngs_modulus": 2.1e11, "density": 7850 }],
//!   "bar_materials": [0, 0, 0]
//! }
//! ```
//!
//! `nodes` (x, y, y up) and `bars` are needed. Bars are seen in their `colours` (one
//! for each bar, or none). Supports (whether x and y are
//! held), loads, section areas (one for each bar, or none), materials and
//! `bar_materials` (an index for each bar, or none) are checked and kept for
//! analyses to come; nothing here computes with them.
//!
//! Guaranteed: coordinates are in range, bars join two different nodes at
//! different places, no bar is given twice, every node is held by a bar.

mod parts;

pub use parts::{TrussInputError, TrussLoad, TrussMaterial, TrussParts, TrussSupport};

use super::json_error::JsonError;
use crate::geometry::{Bounds, DVec2, Similarity};

/// Nodes and bars, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Truss(TrussParts);

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
        parts.check()?;
        Ok(Self(parts))
    }

    /// A truss from the text of its file.
    ///
    /// # Errors
    /// [`TrussInputError`] names the line, or the first thing that cannot be used.
    pub fn from_json(text: &str) -> Result<Self, TrussInputError> {
        Self::from_parts(serde_json::from_str(text).map_err(JsonError::from)?)
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
        // A force is no place: it does not move along, and is not scaled.
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

#[cfg(test)]
mod tests;
