//! Coordinates scaled by a power of two, such that the coordinates of features are of the order of
//! 1.
//!
//! Scaling by a power of two is exact, and products of several coordinates neither overflow nor
//! underflow.

use super::line::{LineEnds, LineFeature};
use crate::geometry::{Bounds, DVec2};

/// Transformation to scaled coordinates, in which the features surround the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaledPlane {
    /// Length of one scaled unit in plane units, a power of two.
    pub(super) unit: f64,
    /// Reciprocal of `unit`.
    pub(super) per_unit: f64,
    /// Point that becomes the origin, already multiplied by `per_unit`.
    pub(super) centre: DVec2,
}

impl Default for ScaledPlane {
    fn default() -> Self {
        Self {
            unit: 1.0,
            per_unit: 1.0,
            centre: DVec2::ZERO,
        }
    }
}

impl ScaledPlane {
    /// Chooses scale and origin from the bounding box of all features.
    pub(super) fn around(features: impl Iterator<Item = LineFeature> + Clone) -> Self {
        let points = features.flat_map(|feature| feature.all_ends());
        let extent = points.clone().map(|p| p.abs().max_element());
        let unit = power_of_two_at(extent.fold(0.0, f64::max));
        let per_unit = unit.recip();
        let bounds = Bounds::of(points.map(|p| p * per_unit));
        Self {
            unit,
            per_unit,
            centre: bounds.map_or(DVec2::ZERO, |bounds| bounds.centre()),
        }
    }

    /// Transforms a feature to scaled coordinates.
    pub(super) fn feature(&self, feature: &LineFeature) -> LineFeature {
        let segment = |segment: LineEnds| segment.map(|p| p * self.per_unit - self.centre);
        LineFeature {
            in_frame: segment(feature.in_frame),
            in_designs: feature.in_designs.map(segment),
            nominal: feature.nominal.map(|length| length * self.per_unit),
        }
    }
}

/// Returns the largest power of two that does not exceed `magnitude`, or 1 if that is 0.
///
/// The exponent is clamped so that the result and its reciprocal are normal numbers.
fn power_of_two_at(magnitude: f64) -> f64 {
    if magnitude == 0.0 {
        return 1.0;
    }
    // The magnitude is positive, so the shift leaves only the exponent bits.
    let exponent = magnitude.to_bits() >> 52;
    f64::from_bits(exponent.clamp(2, 2044) << 52)
}
