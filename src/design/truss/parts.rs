//! The data of a truss as stored in its JSON file.

use super::loads::{TrussLoad, TrussLoadCase, TrussSpring, TrussSupport, is_zero};
use super::members::{TrussMaterial, TrussSection};
use super::units::TrussUnits;
use crate::colour::Rgb;
use crate::geometry::DVec2;
use serde::{Deserialize, Serialize};

/// Unvalidated data of a truss, as stored in its file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussParts {
    /// Units of all numbers; `None` for [`TrussUnits::DEFAULT`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<TrussUnits>,
    /// Node positions, y up.
    pub nodes: Vec<DVec2>,
    /// The two nodes of each bar, as indices into `nodes`.
    pub bars: Vec<[u32; 2]>,
    /// Supports, each with its node.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub supports: Vec<TrussSupport>,
    /// Springs between nodes and the ground.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub springs: Vec<TrussSpring>,
    /// Loads at nodes that belong to no named load case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<TrussLoad>,
    /// Named load cases.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub load_cases: Vec<TrussLoadCase>,
    /// Cross-sectional area of each bar, not negative; empty if the sections give the areas.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub areas: Vec<f64>,
    /// Cross sections to which `bar_sections` refers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sections: Vec<TrussSection>,
    /// Cross section of each bar, as an index into `sections`; empty if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bar_sections: Vec<u32>,
    /// Materials to which `bar_materials` refers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<TrussMaterial>,
    /// Material of each bar, as an index into `materials`; empty if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bar_materials: Vec<u32>,
    /// Fixity of all joints, from 0 (pinned) to 1 (rigid).
    #[serde(default, skip_serializing_if = "is_zero")]
    pub fixity: f64,
    /// Fixity of the joints at the two ends of each bar; empty if `fixity` holds for all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bar_fixity: Vec<[f64; 2]>,
    /// Colour of each bar; empty if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub colours: Vec<Rgb>,
}

impl TrussParts {
    /// Returns the fixity of the joints at the two ends of a bar.
    #[must_use]
    pub fn fixity_of(&self, bar: usize) -> [f64; 2] {
        let own = self.bar_fixity.get(bar).copied();
        own.unwrap_or([self.fixity; 2])
    }

    /// Returns the cross section of a bar; `None` if it has none.
    #[must_use]
    pub fn section_of(&self, bar: usize) -> Option<&TrussSection> {
        let index = *self.bar_sections.get(bar)?;
        self.sections.get(index as usize)
    }

    /// Returns the material of a bar; `None` if it has none.
    #[must_use]
    pub fn material_of(&self, bar: usize) -> Option<&TrussMaterial> {
        let index = *self.bar_materials.get(bar)?;
        self.materials.get(index as usize)
    }

    /// Returns the area of a bar; `None` if neither the bar nor its section has one.
    #[must_use]
    pub fn area_of(&self, bar: usize) -> Option<f64> {
        let own = self.areas.get(bar).copied();
        own.or_else(|| self.section_of(bar)?.area)
    }
}
