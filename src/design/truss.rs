//! The [`Truss`] type (nodes joined by bars) and its JSON file format.
//!
//! The file is one JSON object; `docs/reference/formats.md` describes it. `parts` holds its data,
//! with `units`, `members` (materials and sections) and `loads` (supports and loads); `check`
//! validates them, `json` writes the file.
//!
//! A [`Truss`] guarantees that coordinates are in range, that every bar joins two nodes at
//! different positions, that no bar occurs twice, that every node belongs to a bar, and that all
//! numbers are finite and within their ranges.

mod check;
mod error;
mod json;
mod loads;
mod members;
mod parts;
mod units;

pub use error::TrussInputError;
pub use loads::{TrussLineLoad, TrussLoad, TrussLoadCase, TrussSpring, TrussSupport};
pub use members::{MaterialGrade, SectionShape, TrussMaterial, TrussSection};
pub use parts::TrussParts;
pub(crate) use units::GRAVITY;
pub use units::{TrussForceUnit, TrussLengthUnit, TrussStressUnit, TrussUnits};

use super::json_error::JsonError;
use crate::geometry::{Bounds, DVec2, Similarity};

/// Validated truss: nodes joined by bars.
#[derive(Clone, Debug, PartialEq)]
pub struct Truss {
    /// Data in the coordinates of the file.
    parts: Box<TrussParts>,
    /// Positions of the nodes after the placement.
    nodes: Vec<DVec2>,
    /// Similarity from the coordinates of the file to those of the nodes.
    placement: Similarity,
}

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
        Ok(Self {
            nodes: parts.nodes.clone(),
            parts: Box::new(parts),
            placement: Similarity::IDENTITY,
        })
    }

    /// Parses a truss from the text of its file.
    ///
    /// # Errors
    /// Returns a [`TrussInputError`] that names the line of a syntax error or the first invalid
    /// entry.
    pub fn from_json(text: &str) -> Result<Self, TrussInputError> {
        Self::from_parts(serde_json::from_str(text).map_err(JsonError::from)?)
    }

    /// Returns the text of the file of the truss, in the coordinates before it was placed.
    ///
    /// ```
    /// use morphospace::design::Truss;
    /// let text = r#"{"nodes": [[0, 0], [1, 0]], "bars": [[0, 1]], "areas": [0.1]}"#;
    /// let truss = Truss::from_json(text)?;
    /// assert_eq!(Truss::from_json(&truss.to_json())?, truss);
    /// # Ok::<(), morphospace::design::TrussInputError>(())
    /// ```
    #[must_use]
    pub fn to_json(&self) -> String {
        json::text(&self.parts)
    }

    /// Returns the node positions, y up, after the placement.
    #[must_use]
    pub fn nodes(&self) -> &[DVec2] {
        &self.nodes
    }

    /// Returns the similarity that has been applied to the coordinates of the file.
    #[must_use]
    pub fn placement(&self) -> Similarity {
        self.placement
    }

    /// Returns the units of the file, or the default ones if it names none.
    #[must_use]
    pub fn units(&self) -> TrussUnits {
        self.parts.units.unwrap_or(TrussUnits::DEFAULT)
    }

    /// Returns whether the truss has supports or loads, so that it can be analysed as a structure.
    #[must_use]
    pub fn is_structure(&self) -> bool {
        let parts = &self.parts;
        !(parts.supports.is_empty() && parts.loads.is_empty() && parts.load_cases.is_empty())
    }

    /// Returns whether the file names no units although it has numbers that need them: supports do
    /// not, but loads, areas, sections and materials do.
    pub(super) fn lacks_units(&self) -> bool {
        let parts = &self.parts;
        let has_numbers = !(parts.loads.is_empty()
            && parts.load_cases.is_empty()
            && parts.areas.is_empty()
            && parts.sections.is_empty()
            && parts.materials.is_empty());
        parts.units.is_none() && has_numbers
    }

    /// Returns the two node indices of each bar.
    #[must_use]
    pub fn bars(&self) -> &[[u32; 2]] {
        &self.parts.bars
    }

    /// Returns all data of the truss, in the coordinates of the file. The placement changes only
    /// [`Self::nodes`].
    #[must_use]
    pub fn parts(&self) -> &TrussParts {
        &self.parts
    }

    /// Returns the two end points of each bar.
    pub fn segments(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        let ends = |bar: &[u32; 2]| bar.map(|node| self.nodes[node as usize]);
        self.parts.bars.iter().map(ends)
    }

    /// Returns the bounding box of the nodes; it is flat if they lie on a horizontal or
    /// vertical line.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.nodes.iter().copied())
            .unwrap_or_else(|| unreachable!("a truss has a bar and so nodes"))
    }

    /// Returns the truss with its nodes in another order: `order` lists the index of each node.
    /// `None` if it does not list each node once.
    #[must_use]
    pub fn with_nodes_in_order(&self, order: &[u32]) -> Option<Self> {
        let mut new_index = vec![None; self.nodes.len()];
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
        let in_order = |nodes: &[DVec2]| order.iter().map(|&node| nodes[node as usize]).collect();
        let mut parts = self.parts.clone();
        parts.nodes = in_order(&self.parts.nodes);
        parts.bars.iter_mut().flatten().try_for_each(renumbered)?;
        let supports = parts.supports.iter_mut().map(|support| &mut support.node);
        let springs = parts.springs.iter_mut().map(|spring| &mut spring.node);
        let of_cases = parts.load_cases.iter_mut().flat_map(|case| &mut case.loads);
        let loads = parts.loads.iter_mut().chain(of_cases);
        let loads = loads.map(|load| &mut load.node);
        supports
            .chain(springs)
            .chain(loads)
            .try_for_each(renumbered)?;
        Some(Self {
            parts,
            nodes: in_order(&self.nodes),
            placement: self.placement,
        })
    }

    /// Returns the truss placed by a similarity. Loads and supports are those of the file: the
    /// similarity turns and mirrors them together with the truss, but forces keep their magnitude.
    #[must_use]
    pub fn transformed(&self, by: &Similarity) -> Self {
        Self {
            parts: self.parts.clone(),
            nodes: self.nodes.iter().map(|&node| by.apply(node)).collect(),
            placement: by.after(&self.placement),
        }
    }
}

#[cfg(test)]
mod tests;
