//! The total turning and the area of a growing shape as functions of its size.

use crate::geometry::{DVec2, signed_area, total_turning};
use std::f64::consts::TAU;

/// Number of equal steps from size 0 to the full size of a growing shape, for which its turning and
/// area are tabulated (resource limit).
pub(in crate::transition) const SIZE_STEPS: usize = 16;

/// Turning and area of a growing shape at equally spaced sizes, from size 0 to the full size.
///
/// The turning of an outline is the sum of its absolute exterior angles, in radians. The table
/// holds the turning of all outlines minus 2π for each, so it is 0 for convex outlines.
#[derive(Clone)]
pub(in crate::transition) struct GrowthProfile([[f64; 2]; SIZE_STEPS + 1]);

impl GrowthProfile {
    /// The profile of a shape without extent.
    pub(in crate::transition) const NONE: Self = Self([[0.0; 2]; SIZE_STEPS + 1]);

    /// Returns the profile of a shape that grows by scaling; `diameter` is that of the whole
    /// design.
    pub(in crate::transition) fn of_scaling(rings: &[Vec<DVec2>], diameter: f64) -> Self {
        let area: f64 = rings.iter().map(|ring| signed_area(ring)).sum();
        Self::by(rings.len(), |size| {
            [total_turning(rings, diameter / size), area * size * size]
        })
    }

    /// Returns the profile of a shape whose outlines at each size step are given by `at`;
    /// `diameter` is that of the whole design.
    pub(in crate::transition) fn of_steps<'a>(
        at: impl Fn(usize) -> &'a [Vec<DVec2>],
        diameter: f64,
    ) -> Self {
        Self::by(at(SIZE_STEPS).len(), |size| {
            let rings = at((size * SIZE_STEPS as f64) as usize);
            let area = rings.iter().map(|ring| signed_area(ring)).sum();
            [total_turning(rings, diameter), area]
        })
    }

    /// Tabulates turning and area. `at` returns both for a size, given as a fraction of the full
    /// size; its turning includes the full turn of each outline.
    fn by(outline_count: usize, at: impl Fn(f64) -> [f64; 2]) -> Self {
        let mut all = [[0.0; 2]; SIZE_STEPS + 1];
        for (k, entry) in all.iter_mut().enumerate().skip(1) {
            let [turning, area] = at(k as f64 / SIZE_STEPS as f64);
            *entry = [turning - TAU * outline_count as f64, area];
        }
        Self(all)
    }

    /// Returns turning and area at a fraction of the full size, interpolated linearly.
    pub(in crate::transition) fn at_size(&self, size: f64) -> [f64; 2] {
        let at = size * SIZE_STEPS as f64;
        let below = (at as usize).min(SIZE_STEPS - 1);
        let [a, b] = [self.0[below], self.0[below + 1]];
        [0, 1].map(|k| a[k] + (b[k] - a[k]) * (at - below as f64))
    }
}
