//! One layer of a lattice: displacements by a uniform cubic B-spline, whose
//! control points are zero but near the features.
//!
//! Lee, Wolberg, Shin, "Scattered data interpolation with multilevel
//! B-splines" (1997), §3.1: each feature asks its 16 control points for the
//! least displacements that meet it, and a control point takes the mean of
//! what it is asked for, weighted by how much it matters there.
//!
//! Control points are kept in blocks of 8 × 8, of which only those are made
//! that a feature touches: fine layers stay small. Where a layer has no
//! control points it is zero, and it is twice continuously differentiable.

use crate::geometry::{Bounds, DVec2};

/// Control points along a block's side: 2 to this power.
const SHIFT: usize = 3;
const SIDE: usize = 1 << SHIFT;

/// How a feature counts in a fit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    /// Where it is.
    pub(super) at: DVec2,
    /// How far it should go.
    pub(super) by: DVec2,
    /// How much it counts beside others.
    pub(super) weight: f64,
}

/// Displacements of the plane.
#[derive(Clone, Debug, Default)]
pub(super) struct Layer {
    spacing: f64,
    /// Where the first control point's own cell begins.
    origin: DVec2,
    /// Blocks from left to right, and all of them.
    columns: usize,
    /// The number of each block, from 1; 0 where there is none.
    directory: Vec<u32>,
    /// Which entries of the directory are not 0.
    made: Vec<usize>,
    blocks: Vec<Block>,
}

#[derive(Clone, Debug)]
struct Block {
    /// Sums of what was asked for, then the displacements.
    controls: [[DVec2; SIDE]; SIDE],
    weights: [[f64; SIDE]; SIDE],
}

impl Block {
    const EMPTY: Self = Self {
        controls: [[DVec2::ZERO; SIDE]; SIDE],
        weights: [[0.0; SIDE]; SIDE],
    };
}

/// The first of the four control points along each axis, and the values of
/// their basis functions.
struct Stencil {
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

impl Layer {
    /// Makes the layer one of `spacing` over `domain`, with nothing moved.
    fn reset(&mut self, domain: &Bounds, spacing: f64) {
        for entry in self.made.drain(..) {
            self.directory[entry] = 0;
        }
        self.blocks.clear();
        let cells = (domain.size() / spacing).ceil();
        let [columns, rows] = cells.to_array().map(|c| (c as usize + 4).div_ceil(SIDE));
        self.spacing = spacing;
        self.origin = domain.min;
        self.columns = columns;
        self.directory.resize(columns * rows, 0);
    }

    fn rows(&self) -> usize {
        self.directory.len() / self.columns.max(1)
    }

    /// `None` where all four columns or rows of control points are outside.
    #[inline(always)]
    fn stencil(&self, p: DVec2) -> Option<Stencil> {
        let at = (p - self.origin) / self.spacing;
        let low = at.floor();
        let inside = low.x >= 0.0
            && low.y >= 0.0
            && low.x + 4.0 <= (self.columns * SIDE) as f64
            && low.y + 4.0 <= (self.rows() * SIDE) as f64;
        inside.then(|| {
            let s = at - low;
            Stencil {
                first: [low.x as usize, low.y as usize],
                basis: [basis(s.x), basis(s.y)],
            }
        })
    }

    /// Fits the layer to what features ask for, each coordinate of a control
    /// point within ±`most`. Returns the largest coordinate of any.
    pub(super) fn fit(
        &mut self,
        domain: &Bounds,
        spacing: f64,
        pulls: impl Iterator<Item = Pull>,
        most: f64,
    ) -> f64 {
        self.reset(domain, spacing);
        for pull in pulls {
            self.ask(&pull);
        }
        let mut largest = 0.0_f64;
        for block in &mut self.blocks {
            let rows = block.controls.iter_mut().zip(&block.weights);
            for (control, &weight) in rows.flat_map(|(c, w)| c.iter_mut().zip(w)) {
                if weight > 0.0 {
                    *control = (*control / weight).clamp(DVec2::splat(-most), DVec2::splat(most));
                    largest = largest.max(control.abs().max_element());
                }
            }
        }
        largest
    }

    /// Adds one feature to the sums: w² φ and w² with φ = w z / Σ w² (eqs. 3
    /// to 5).
    fn ask(&mut self, pull: &Pull) {
        let Some(Stencil { first, basis }) = self.stencil(pull.at) else {
            return;
        };
        let square = |b: &[f64; 4]| b.iter().map(|b| b * b).sum::<f64>();
        let total = square(&basis[0]) * square(&basis[1]);
        for (j, by) in basis[1].iter().enumerate() {
            for (i, bx) in basis[0].iter().enumerate() {
                let (column, row) = (first[0] + i, first[1] + j);
                let w = bx * by;
                let weight = pull.weight * w * w;
                let block = self.block(column >> SHIFT, row >> SHIFT);
                block.controls[row % SIDE][column % SIDE] += pull.by * (weight * w / total);
                block.weights[row % SIDE][column % SIDE] += weight;
            }
        }
    }

    fn block(&mut self, column: usize, row: usize) -> &mut Block {
        let entry = row * self.columns + column;
        if self.directory[entry] == 0 {
            self.blocks.push(Block::EMPTY);
            self.made.push(entry);
            self.directory[entry] = self.blocks.len() as u32;
        }
        &mut self.blocks[self.directory[entry] as usize - 1]
    }

    /// By how much a place is displaced.
    #[inline]
    pub(super) fn at(&self, p: DVec2) -> DVec2 {
        let Some(Stencil { first, basis }) = self.stencil(p) else {
            return DVec2::ZERO;
        };
        self.sum(first, &basis[0], &basis[1])
    }

    /// Σ control point · basis, by columns and rows.
    #[inline(always)]
    fn sum(&self, [i0, j0]: [usize; 2], bx: &[f64; 4], by: &[f64; 4]) -> DVec2 {
        let number =
            |i: usize, j: usize| self.directory[(j >> SHIFT) * self.columns + (i >> SHIFT)];
        let corners = [(0, 0), (3, 0), (0, 3), (3, 3)].map(|(i, j)| number(i0 + i, j0 + j));
        if corners == [0; 4] {
            return DVec2::ZERO;
        }
        let block = |corner: usize| {
            let number = (corners[corner] as usize).checked_sub(1)?;
            Some(&self.blocks[number].controls)
        };
        // So many of the four columns are in the left blocks.
        let (i, split) = (i0 % SIDE, (SIDE - i0 % SIDE).min(4));
        let (left, right) = bx.split_at(split);
        let dot = |controls: &[DVec2], basis: &[f64]| -> DVec2 {
            controls.iter().zip(basis).map(|(&c, &b)| c * b).sum()
        };
        let mut sum = DVec2::ZERO;
        for (j, &by) in (j0..).zip(by) {
            let half = if j >> SHIFT == j0 >> SHIFT { 0 } else { 2 };
            if let Some(controls) = block(half) {
                sum += dot(&controls[j % SIDE][i..], left) * by;
            }
            if let (false, Some(controls)) = (right.is_empty(), block(half + 1)) {
                sum += dot(&controls[j % SIDE], right) * by;
            }
        }
        sum
    }

    /// The derivatives of the displacement by x and by y.
    #[cfg(test)]
    pub(super) fn gradient(&self, p: DVec2) -> [DVec2; 2] {
        let Some(Stencil { first, basis }) = self.stencil(p) else {
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
            self.sum(first, &slope(s.x), &basis[1]),
            self.sum(first, &basis[0], &slope(s.y)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOMAIN: Bounds = Bounds {
        min: DVec2::new(-1.0, -2.0),
        max: DVec2::new(7.0, 9.0),
    };

    fn one(at: DVec2, by: DVec2) -> Pull {
        Pull {
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
        let mut layer = Layer::default();
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
        let mut layer = Layer::default();
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
