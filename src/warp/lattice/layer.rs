//! One layer of a lattice: displacements by a uniform cubic B-spline, whose
//! control points are zero but near the features.
//!
//! Lee, Wolberg, Shin, "Scattered data interpolation with multilevel
//! B-splines" (1997), §3.1: each feature asks its 16 control points for the
//! least displacements that meet it, and a control point takes the mean of
//! what it is asked for, weighted by how much it matters there.
//!
//! Where a layer has no control points it is zero, and it is twice
//! continuously differentiable.

use super::control_grid::ControlGrid;
use crate::geometry::{Bounds, DVec2};

/// How a feature counts in a fit.
#[derive(Clone, Copy, Debug)]
pub(super) struct FeaturePull {
    /// Where it is.
    pub(super) at: DVec2,
    /// How far it should go.
    pub(super) by: DVec2,
    /// How much it counts beside others.
    pub(super) weight: f64,
}

/// Displacements of the plane.
#[derive(Clone, Debug, Default)]
pub(super) struct SplineLayer {
    spacing: f64,
    /// Where the first control point's own cell begins.
    origin: DVec2,
    controls: ControlGrid,
}

/// The first of the four control points along each axis, and the values of
/// their basis functions.
struct SplineStencil {
    first: [usize; 2],
    basis: [[f64; 4]; 2],
}

/// The four cubic B-splines that do not vanish at `s` in [0, 1).
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
    /// Makes the layer one of `spacing` over `domain`, with nothing moved.
    fn reset(&mut self, domain: &Bounds, spacing: f64) {
        let cells = (domain.size() / spacing).ceil();
        self.controls
            // A cell has its own control point and three more; a place on the far
            // side is in one cell more.
            .reset(cells.to_array().map(|c| c as usize + 4));
        self.spacing = spacing;
        self.origin = domain.min;
    }

    /// `None` where all four columns or rows of control points are outside.
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

    /// Fits the layer to what features ask for, each coordinate of a control
    /// point within ±`most`.
    pub(super) fn fit(
        &mut self,
        domain: &Bounds,
        spacing: f64,
        pulls: impl Iterator<Item = FeaturePull>,
        most: f64,
    ) {
        self.reset(domain, spacing);
        for pull in pulls {
            self.ask(&pull);
        }
        self.controls.divide(most);
    }

    /// Adds one feature to the sums: w² φ and w² with φ = w z / Σ w² (eqs. 3
    /// to 5).
    fn ask(&mut self, pull: &FeaturePull) {
        let Some(SplineStencil { first, basis }) = self.stencil(pull.at) else {
            return;
        };
        let square = |b: &[f64; 4]| b.iter().map(|b| b * b).sum::<f64>();
        let total = square(&basis[0]) * square(&basis[1]);
        for (j, by) in basis[1].iter().enumerate() {
            for (i, bx) in basis[0].iter().enumerate() {
                let w = bx * by;
                let weight = pull.weight * w * w;
                let asked = pull.by * (weight * w / total);
                self.controls
                    .ask([first[0] + i, first[1] + j], asked, weight);
            }
        }
    }

    /// By how much a place is displaced.
    #[inline]
    pub(super) fn at(&self, p: DVec2) -> DVec2 {
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
        /// The derivatives of the displacement by x and by y.
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

    fn one(at: DVec2, by: DVec2) -> FeaturePull {
        FeaturePull {
            at,
            by,
            weight: 1.0,
        }
    }

    #[test]
    fn splines_are_a_partition_of_one() {
        for k in 0..100 {
            let sum: f64 = basis(f64::from(k) / 100.0).iter().sum();
            assert!((sum - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_feature_alone_is_met_wherever_it_is() {
        let mut layer = SplineLayer::default();
        for spacing in [3.0, 0.7, 0.1] {
            for k in 0..50 {
                let at = DVec2::new(0.13, 0.17) * f64::from(k) - DVec2::ONE;
                let by = DVec2::new(0.4, -0.3);
                layer.fit(
                    &DOMAIN,
                    spacing,
                    std::iter::once(one(at, by)),
                    f64::INFINITY,
                );
                assert!(layer.at(at).distance(by) < 1e-14);
                assert_eq!(layer.at(at + 4.0 * spacing), DVec2::ZERO);
            }
        }
    }

    #[test]
    fn the_gradient_is_that_of_the_displacement() {
        let mut layer = SplineLayer::default();
        let pulls = [(1.0, 2.0), (1.3, 2.5), (4.0, 0.0)].map(|(x, y)| {
            let at = DVec2::new(x, y);
            one(at, at.perp())
        });
        layer.fit(&DOMAIN, 0.5, pulls.into_iter(), f64::INFINITY);
        for k in 0..200 {
            let p = DVec2::new(0.021 * f64::from(k), 0.017 * f64::from(k));
            for (axis, slope) in [DVec2::X, DVec2::Y].into_iter().zip(layer.gradient(p)) {
                let step = 1e-5 * axis;
                let wanted = (layer.at(p + step) - layer.at(p - step)) / 2e-5;
                assert!(slope.distance(wanted) < 1e-7, "{p}: {slope} {wanted}");
            }
        }
    }
}
