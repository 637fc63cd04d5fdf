//! How much what grows turns and encloses while it does.

use crate::geometry::{DVec2, signed_area, total_turning};
use std::f64::consts::TAU;

/// Sizes at which what grows is looked at.
pub(in crate::transition) const SIZE_STEPS: usize = 16;

/// Turning in radians, beyond that of as many points as there are outlines, and area of
/// what grows, from no size to its own in even steps.
#[derive(Clone)]
pub(in crate::transition) struct GrowthProfile([[f64; 2]; SIZE_STEPS + 1]);

impl GrowthProfile {
    /// Of nothing.
    pub(in crate::transition) const NONE: Self = Self([[0.0; 2]; SIZE_STEPS + 1]);

    /// Of what grows in size; `diameter` is that of the whole.
    pub(in crate::transition) fn scaled(rings: &[Vec<DVec2>], diameter: f64) -> Self {
        let area: f64 = rings.iter().map(|ring| signed_area(ring)).sum();
        Self::by(rings.len(), |size| {
            [total_turning(rings, diameter / size), area * size * size]
        })
    }

    /// Of what is this at each step; `diameter` is that of the whole.
    pub(in crate::transition) fn of<'a>(
        at: impl Fn(usize) -> &'a [Vec<DVec2>],
        diameter: f64,
    ) -> Self {
        Self::by(at(SIZE_STEPS).len(), |size| {
            let rings = at((size * SIZE_STEPS as f64) as usize);
            let area = rings.iter().map(|ring| signed_area(ring)).sum();
            [total_turning(rings, diameter), area]
        })
    }

    fn by(outlines: usize, at: impl Fn(f64) -> [f64; 2]) -> Self {
        let mut all = [[0.0; 2]; SIZE_STEPS + 1];
        for (k, found) in all.iter_mut().enumerate().skip(1) {
            let [turning, area] = at(k as f64 / SIZE_STEPS as f64);
            *found = [turning - TAU * outlines as f64, area];
        }
        Self(all)
    }

    /// At a share of its own size.
    pub(in crate::transition) fn at(&self, size: f64) -> [f64; 2] {
        let at = size * SIZE_STEPS as f64;
        let below = (at as usize).min(SIZE_STEPS - 1);
        let [a, b] = [self.0[below], self.0[below + 1]];
        [0, 1].map(|k| a[k] + (b[k] - a[k]) * (at - below as f64))
    }
}
