//! One displacement layer: a uniform cubic B-spline fitted to the features.
//!
//! Lee, Wolberg, Shin, "Scattered data interpolation with multilevel B-splines" (1997), §3.1: each
//! feature requests displacements of the 16 control points around it. Of all displacements that
//! move the feature as required, it requests the smallest. A control point takes the mean of all
//! requests, weighted by its influence on each feature.
//!
//! The layer is twice continuously differentiable and zero away from the features.

use super::control_grid::ControlGrid;
use crate::geometry::{Bounds, DVec2};

/// A feature with its requested displacement.
#[derive(Clone, Copy, Debug)]
pub(super) struct FeaturePull {
    /// Position of the feature.
    pub(super) at: DVec2,
    /// Displacement that the feature requests.
    pub(super) by: DVec2,
    /// Weight of the feature relative to other features.
    pub(super) weight: f64,
}

/// Displacement field on one lattice.
#[derive(Clone, Debug, Default)]
pub(super) struct SplineLayer {
    /// Distance between neighbouring control points, in plane units.
    spacing: f64,
    /// Lower left corner of the lattice's first cell, on which control points 0 to 3 of each axis
    /// act.
    origin: DVec2,
    controls: ControlGrid,
}

/// The 4 × 4 control points that affect a point.
struct SplineStencil {
    /// Lowest column and lowest row of the 16 control points.
    first: [usize; 2],
    /// Values of the four basis functions along x and y.
    basis: [[f64; 4]; 2],
}

/// Returns the values of the four cubic B-splines that are nonzero in a cell, at the fraction `s`
/// in [0, 1) of that cell.
#[inline(always)]
fn basis(s: f64) -> [f64; 4] {
    let r = 1.0 - s;
    let (s2, r2) = (s * s, r * r);
    [
        r * r2 / 6.0,
        (4.0 - 6.0 * s2 + 3.0 * s * s2) / 6.0,
        (4.0 - 6.0 * r2 + 3.0 * r * r2) / 6.0,
        s * s2 / 6.0,
    ]
}

impl SplineLayer {
    /// Resets the layer to zero displacements with `spacing` over `domain`.
    fn reset(&mut self, domain: &Bounds, spacing: f64) {
        let cells = (domain.size() / spacing).ceil();
        self.controls
            // A stencil needs three control points beyond its cell, and a point on the upper
            // boundary lies in one more cell.
            .reset(cells.to_array().map(|c| c as usize + 4));
        self.spacing = spacing;
        self.origin = domain.min;
    }

    /// Returns the stencil of a point, or `None` if a control point of the stencil is outside the
    /// lattice.
    #[inline(always)]
    fn stencil(&self, p: DVec2) -> Option<SplineStencil> {
        let at = (p - self.origin) / self.spacing;
        let low = at.floor();
        let [columns, rows] = self.controls.size();
        let inside = low.x >= 0.0
            && low.y >= 0.0
            && low.x + 4.0 <= columns as f64
            && low.y + 4.0 <= rows as f64;
        inside.then(|| {
            let s = at - low;
            SplineStencil {
                first: [low.x as usize, low.y as usize],
                basis: [basis(s.x), basis(s.y)],
            }
        })
    }

    /// Fits the layer to the requested displacements.
    ///
    /// Each coordinate of a control point's displacement is clamped to ±`bound`.
    pub(super) fn fit(
        &mut self,
        domain: &Bounds,
        spacing: f64,
        pulls: impl Iterator<Item = FeaturePull>,
        bound: f64,
    ) {
        self.reset(domain, spacing);
        for pull in pulls {
            self.add(&pull);
        }
        self.controls.divide(bound);
    }

    /// Adds the displacements that one feature requests of the surrounding control points to the
    /// sums at these control points.
    ///
    /// A control point with the basis value w is requested to move by φ = w z / Σ w², where z is
    /// the feature's displacement. The sums grow by w² φ and w², times the feature's weight (Lee,
    /// Wolberg, Shin 1997, eqs. 3 to 5).
    fn add(&mut self, pull: &FeaturePull) {
        let Some(SplineStencil { first, basis }) = self.stencil(pull.at) else {
            return;
        };
        let square = |b: &[f64; 4]| b.iter().map(|b| b * b).sum::<f64>();
        let total = square(&basis[0]) * square(&basis[1]);
        for (j, by) in basis[1].iter().enumerate() {
            for (i, bx) in basis[0].iter().enumerate() {
                let w = bx * by;
                let weight = pull.weight * w * w;
                let weighted = pull.by * (weight * w / total);
                self.controls
                    .add([first[0] + i, first[1] + j], weighted, weight);
            }
        }
    }

    /// Returns the displacement of a point, zero outside the lattice.
    #[inline]
    pub(super) fn displacement(&self, p: DVec2) -> DVec2 {
        let Some(SplineStencil { first, basis }) = self.stencil(p) else {
            return DVec2::ZERO;
        };
        self.controls.sum(first, &basis[0], &basis[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl SplineLayer {
        /// Returns the derivatives of the displacement with respect to x and y.
        pub(in crate::warp::lattice) fn gradient(&self, p: DVec2) -> [DVec2; 2] {
            let Some(SplineStencil { first, basis }) = self.stencil(p) else {
                return [DVec2::ZERO; 2];
            };
            let at = (p - self.origin) / self.spacing;
            let s = at - at.floor();
            let slope = |s: f64| {
                let r = 1.0 - s;
                let slopes = [
                    -0.5 * r * r,
                    1.5 * s * s - 2.0 * s,
                    2.0 * r - 1.5 * r * r,
                    0.5 * s * s,
                ];
                slopes.map(|d| d / self.spacing)
            };
            [
                self.controls.sum(first, &slope(s.x), &basis[1]),
                self.controls.sum(first, &basis[0], &slope(s.y)),
            ]
        }
    }

    const DOMAIN: Bounds = Bounds {
        min: DVec2::new(-1.0, -2.0),
        max: DVec2::new(7.0, 9.0),
    };

    fn unit_pull(at: DVec2, by: DVec2) -> FeaturePull {
        FeaturePull {
            at,
            by,
            weight: 1.0,
        }
    }

    #[test]
    fn splines_are_a_partition_of_unity() {
        for k in 0..100 {
            let sum: f64 = basis(f64::from(k) / 100.0).iter().sum();
            assert!((sum - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_single_feature_is_interpolated_at_any_position() {
        let mut layer = SplineLayer::default();
        for spacing in [3.0, 0.7, 0.1] {
            for k in 0..50 {
                let at = DVec2::new(0.13, 0.17) * f64::from(k) - DVec2::ONE;
                let by = DVec2::new(0.4, -0.3);
                layer.fit(
                    &DOMAIN,
                    spacing,
                    std::iter::once(unit_pull(at, by)),
                    f64::INFINITY,
                );
                assert!(layer.displacement(at).distance(by) < 1e-14);
                assert_eq!(layer.displacement(at + 4.0 * spacing), DVec2::ZERO);
            }
        }
    }

    #[test]
    fn the_gradient_equals_the_difference_quotient() {
        let mut layer = SplineLayer::default();
        let pulls = [(1.0, 2.0), (1.3, 2.5), (4.0, 0.0)].map(|(x, y)| {
            let at = DVec2::new(x, y);
            unit_pull(at, at.perp())
        });
        layer.fit(&DOMAIN, 0.5, pulls.into_iter(), f64::INFINITY);
        for k in 0..200 {
            let p = DVec2::new(0.021 * f64::from(k), 0.017 * f64::from(k));
            for (axis, slope) in [DVec2::X, DVec2::Y].into_iter().zip(layer.gradient(p)) {
                let step = 1e-5 * axis;
                let expected = (layer.displacement(p + step) - layer.displacement(p - step)) / 2e-5;
                assert!(slope.distance(expected) < 1e-7, "{p}: {slope} {expected}");
            }
        }
    }
}
