//! The [`Truss`] type (nodes joined by bars) and its JSON file format.
//!
//! The file is one JSON object. Nodes and bars are numbered from 0. Unknown keys are errors.
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
//! `nodes` (x and y, y up) and `bars` are required. `colours`, `areas` (cross sections) and
//! `bar_materials` (indices into `materials`) have one entry per bar or are absent. Supports
//! (whether the displacements along x and y are fixed), loads, areas and materials are validated
//! and stored, but no computation uses them yet.
//!
//! A [`Truss`] guarantees that coordinates are in range, that every bar joins two nodes at
//! different positions, that no bar occurs twice and that every node belongs to a bar.

mod parts;

pub use parts::{TrussInputError, TrussLoad, TrussMaterial, TrussParts, TrussSupport};

use super::json_error::JsonError;
use crate::geometry::{Bounds, DVec2, Similarity};

/// Validated truss: nodes joined by bars.
#[derive(Clone, Debug, PartialEq)]
pub struct Truss(TrussParts);

impl Truss {
    /// Creates a truss from nodes and bars only.
    ///
    /// # Errors
    /// Returns a [`TrussInputError`] that names the first invalid node or bar.
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

    /// Creates a truss from all its data, including supports, loads, areas and materials.
    ///
    /// # Errors
    /// Returns a [`TrussInputError`] that names the first invalid entry.
    pub fn from_parts(parts: TrussParts) -> Result<Self, TrussInputError> {
        parts.check()?;
        Ok(Self(parts))
    }

    /// Parses a truss from the text of its file.
    ///
    /// # Errors
    /// Returns a [`TrussInputError`] that names the line of a syntax error or the first invalid
    /// entry.
    pub fn from_json(text: &str) -> Result<Self, TrussInputError> {
        Self::from_parts(serde_json::from_str(text).map_err(JsonError::from)?)
    }

    /// Returns the node positions, y up.
    #[must_use]
    pub fn nodes(&self) -> &[DVec2] {
        &self.0.nodes
    }

    /// Returns the two node indices of each bar.
    #[must_use]
    pub fn bars(&self) -> &[[u32; 2]] {
        &self.0.bars
    }

    /// Returns all data of the truss.
    #[must_use]
    pub fn parts(&self) -> &TrussParts {
        &self.0
    }

    /// Returns the two end points of each bar.
    pub fn segments(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        self.0
            .bars
            .iter()
            .map(|bar| bar.map(|node| self.0.nodes[node as usize]))
    }

    /// Returns the bounding box of the nodes; it is flat if they lie on a horizontal or
    /// vertical line.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.0.nodes.iter().copied())
            .unwrap_or_else(|| unreachable!("a truss has a bar and so nodes"))
    }

    /// Returns the truss with its nodes in another order: `order` lists the index of each node.
    /// `None` if it does not list each node once.
    #[must_use]
    pub fn with_nodes_in_order(&self, order: &[u32]) -> Option<Self> {
        let mut new_index = vec![None; self.0.nodes.len()];
        for (index, &node) in order.iter().enumerate() {
            let slot = new_index.get_mut(node as usize)?;
            if slot.replace(index as u32).is_some() {
                return None;
            }
        }
        let renumbered = |node: &mut u32| -> Option<()> {
            *node = new_index[*node as usize]?;
            Some(())
        };
        let mut parts = self.0.clone();
        parts.nodes = order
            .iter()
            .map(|&node| self.0.nodes[node as usize])
            .collect();
        parts.bars.iter_mut().flatten().try_for_each(renumbered)?;
        let supports = parts.supports.iter_mut().map(|support| &mut support.node);
        let loads = parts.loads.iter_mut().map(|load| &mut load.node);
        supports.chain(loads).try_for_each(renumbered)?;
        Some(Self(parts))
    }

    /// Returns the truss transformed by a similarity. Forces are rotated and mirrored but keep
    /// their magnitude; supports still refer to the x and y axes of the plane.
    #[must_use]
    pub fn transformed(&self, by: &Similarity) -> Self {
        // Forces are vectors that keep their magnitude: they are neither translated nor scaled.
        let rotation = Similarity {
            scale: 1.0,
            offset: DVec2::ZERO,
            ..*by
        };
        let mut parts = self.0.clone();
        for node in &mut parts.nodes {
            *node = by.apply(*node);
        }
        for load in &mut parts.loads {
            load.force = rotation.apply(load.force);
        }
        Self(parts)
    }
}

#[cfg(test)]
mod tests;
