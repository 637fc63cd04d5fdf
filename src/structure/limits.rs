//! Limits of the concept check.

use serde::{Deserialize, Serialize};

/// Limits beyond which a structure is reported. Strengths are those of the materials.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct StructureLimits {
    /// Span divided by the largest allowed deflection; 250 by default (EN 1990, A1.4.3).
    pub span_to_deflection: f64,
    /// Buckling factor from which second-order effects can be neglected; 10 by default
    /// (EN 1993-1-1, 5.2.1).
    pub buckling_factor: f64,
    /// Least allowed buckling factor; 3 by default (EN 1993-1-1, 5.2.2).
    pub least_buckling_factor: f64,
    /// Largest slenderness L/i of a compressed bar; 200 by default (AISC 360, E2).
    pub compressed_slenderness: f64,
    /// Largest slenderness L/i of a bar in tension; 300 by default (AISC 360, D1).
    pub tension_slenderness: f64,
    /// Least angle between two bars at a node in degrees; 15 by default, below which a joint can
    /// hardly be built.
    pub least_angle_deg: f64,
    /// Least natural frequency as a fraction of that of the limper design; a half by default.
    pub least_frequency_share: f64,
}

impl Default for StructureLimits {
    fn default() -> Self {
        Self {
            span_to_deflection: 250.0,
            buckling_factor: 10.0,
            least_buckling_factor: 3.0,
            compressed_slenderness: 200.0,
            tension_slenderness: 300.0,
            least_angle_deg: 15.0,
            least_frequency_share: 0.5,
        }
    }
}
