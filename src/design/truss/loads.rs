//! Supports and loads of a truss.

use crate::geometry::DVec2;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Support of a node.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussSupport {
    /// Node index, counted from 0.
    pub node: u32,
    /// Whether the displacement along x, the displacement along y and the rotation are fixed. The
    /// rotation may be left out of the file.
    #[serde(
        default,
        deserialize_with = "two_or_three",
        serialize_with = "without_free_rotation"
    )]
    pub fixed: [bool; 3],
    /// Direction in which the node moves on rollers; it is held perpendicular to this direction.
    /// Excludes fixed displacements.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rolls_along: Option<DVec2>,
}

/// Reads `fixed` with two entries or with three.
fn two_or_three<'de, D: Deserializer<'de>>(from: D) -> Result<[bool; 3], D::Error> {
    match Vec::<bool>::deserialize(from)?.as_slice() {
        &[x, y] => Ok([x, y, false]),
        &[x, y, rotation] => Ok([x, y, rotation]),
        other => Err(serde::de::Error::custom(format!(
            "\"fixed\" has {} entries; give 2 (x, y) or 3 (x, y, rotation)",
            other.len()
        ))),
    }
}

/// Writes `fixed` with two entries if the rotation is free.
fn without_free_rotation<S: Serializer>(fixed: &[bool; 3], to: S) -> Result<S::Ok, S::Error> {
    let entries = if fixed[2] { 3 } else { 2 };
    fixed[..entries].serialize(to)
}

/// Spring between a node and the ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussSpring {
    /// Node index, counted from 0.
    pub node: u32,
    /// Direction of the spring; `None` for a spring that resists rotation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<DVec2>,
    /// Stiffness, not negative: force per length, or moment per radian.
    pub stiffness: f64,
}

/// Force and moment at a node.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussLoad {
    /// Node index, counted from 0.
    pub node: u32,
    /// Force vector, y up.
    #[serde(default)]
    pub force: DVec2,
    /// Moment, counter-clockwise. It needs a bar with a rigid joint at the node.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub moment: f64,
}

/// Uniform load on a bar or along a chain of bars, such as a deck.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussLineLoad {
    /// Indices of the bars, counted from 0.
    pub bars: Vec<u32>,
    /// Force vector per unit of length, y up.
    pub force: DVec2,
    /// Whether lengths are measured horizontally, as for snow, and not along the bars.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub in_plan: bool,
}

/// Loads that act together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussLoadCase {
    /// Display name. Load cases with the same name in two designs are the same load case.
    pub name: String,
    /// Factor by which the loads are multiplied when all load cases act together.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub factor: f64,
    /// Loads at nodes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<TrussLoad>,
    /// Loads on bars.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub line_loads: Vec<TrussLineLoad>,
    /// Whether the weight of the bars acts, in the direction −y.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub self_weight: bool,
}

fn one() -> f64 {
    1.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_one(x: &f64) -> bool {
    *x == 1.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
pub(super) fn is_zero(x: &f64) -> bool {
    *x == 0.0
}
