//! The plane scaled by one power of two, so that the largest coordinate of any
//! feature is about 1. That changes no digit, and leaves exponents to spare
//! for products of many.

use super::line::{LineEnds, LineFeature};
use crate::geometry::{Bounds, DVec2};

/// The plane with features about its origin, none much beyond 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaledPlane {
    /// Units of the plane in one of the scaled plane, and its reciprocal.
    pub(super) unit: f64,
    pub(super) per_unit: f64,
    /// What lies at the origin, in scaled coordinates.
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
    pub(super) fn around(features: impl Iterator<Item = LineFeature> + Clone) -> Self {
        let points = features.flat_map(|feature| feature.points());
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

    pub(super) fn feature(&self, feature: &LineFeature) -> LineFeature {
        let segment = |segment: LineEnds| segment.map(|p| p * self.per_unit - self.centre);
        LineFeature {
            in_frame: segment(feature.in_frame),
            in_designs: feature.in_designs.map(segment),
            nominal: feature.nominal.map(|length| length * self.per_unit),
        }
    }
}

/// The power of two at or below a magnitude; both it and its reciprocal are
/// normal. 1 for 0.
fn power_of_two_at(magnitude: f64) -> f64 {
    if magnitude == 0.0 {
        return 1.0;
    }
    // The sign is 0: only the exponent is left, and a power of two has no more.
    let exponent = magnitude.to_bits() >> 52;
    f64::from_bits(exponent.clamp(2, 2044) << 52)
}
