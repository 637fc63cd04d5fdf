//! Σ w and Σ w D over lines, for many places at a time.
//!
//! The width of the vectors is chosen at run time; results differ between
//! widths in the last digits at most.
//!
//! Guaranteed: a weight is a positive finite number, and so are all numbers
//! on the way to it, if places are no farther than [`FARTHEST`] and a is from
//! [`LEAST_A`] to [`LARGEST_A`].

use super::falloff::{Falloff, GROUP, Group, Inverse, Power, Square};
use super::line::{Affine, Line};
use crate::geometry::DVec2;
use pulp::{Arch, Simd, WithSimd};

/// How many places there are in a block.
pub(super) const BLOCK: usize = 128;

/// How many groups of vectors are taken through the lines together: a block,
/// if vectors have four numbers.
const CELLS: usize = BLOCK / GROUP / 4;

/// The farthest place, scaled.
pub(super) const FARTHEST: f64 = 1e36;

/// The least a, scaled: below what coordinates can tell.
pub(super) const LEAST_A: f64 = 1e-30;

/// The largest a, scaled: to all features it makes no difference any more.
pub(super) const LARGEST_A: f64 = 1e30;

/// A number of each place of a block.
pub(super) type Row = [f64; BLOCK];

/// The sums of a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sums<const N: usize> {
    /// Σ w.
    pub(super) weight: Row,
    /// Σ w D for each design, x and y.
    pub(super) moved: [[Row; 2]; N],
}

impl<const N: usize> Sums<N> {
    /// Those of no lines.
    pub(super) const ZERO: Self = Self {
        weight: [0.0; BLOCK],
        moved: [[[0.0; BLOCK]; 2]; N],
    };
}

/// Lines to be summed over.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lines<'a, const N: usize> {
    pub(super) lines: &'a [Line<N>],
    /// The paper's a, scaled.
    pub(super) a: f64,
    /// The paper's b.
    pub(super) b: f64,
}

/// Places of a block. What stands behind the first `count` is not computed, or
/// in vain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places<'a> {
    pub(super) x: &'a Row,
    pub(super) y: &'a Row,
    pub(super) count: usize,
    /// Scaled is what they are times this, less the centre.
    pub(super) per_unit: f64,
    pub(super) centre: DVec2,
}

/// Adds the lines' part to the sums.
pub(super) fn add<const N: usize>(
    arch: Arch,
    lines: Lines<'_, N>,
    places: Places<'_>,
    sums: &mut Sums<N>,
) {
    let b = lines.b;
    let job = (lines, places, sums);
    if b == 2.0 {
        arch.dispatch(Pass(Square, job));
    } else if b == 1.0 {
        arch.dispatch(Pass(Inverse, job));
    } else {
        arch.dispatch(Pass(Power(b), job));
    }
}

/// `unit` Σ w D / Σ w, and 0 where there are no lines.
pub(super) fn means<const N: usize>(arch: Arch, sums: &Sums<N>, unit: f64) -> [[Row; 2]; N] {
    let mut means = sums.moved;
    arch.dispatch(Means(&sums.weight, &mut means, unit));
    means
}

/// The division, to be compiled for several widths of vectors.
struct Means<'a, const N: usize>(&'a Row, &'a mut [[Row; 2]; N], f64);

impl<const N: usize> WithSimd for Means<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(weights, means, unit) = self;
        for (lane, &weight) in weights.iter().enumerate() {
            // No weight is below, but that of no lines.
            let factor = 1.0 / if weight > 1e-300 { weight } else { 1e-300 };
            for rows in means.iter_mut() {
                for row in rows {
                    row[lane] = row[lane] * factor * unit;
                }
            }
        }
    }
}

/// The work, to be compiled for several widths of vectors.
struct Pass<'a, F, const N: usize>(F, (Lines<'a, N>, Places<'a>, &'a mut Sums<N>));

impl<F: Falloff, const N: usize> WithSimd for Pass<'_, F, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(falloff, (lines, places, sums)) = self;
        let used = places.count.div_ceil(GROUP * S::F64_LANES);
        let mut cells = [Cell::new(simd); CELLS];
        for start in (0..used).step_by(CELLS) {
            let cells = &mut cells[..CELLS.min(used - start)];
            for (k, cell) in cells.iter_mut().enumerate() {
                cell.load(simd, start + k, &places, sums);
            }
            sum(simd, falloff, lines, cells);
            for (k, cell) in cells.iter().enumerate() {
                cell.store(start + k, sums);
            }
        }
    }
}

/// Sums over all lines.
///
/// A line's weights wait long for its roots: so these are begun one line
/// ahead, for all cells, and no processor needs to look far.
#[inline(always)]
fn sum<S: Simd, const N: usize>(
    simd: S,
    falloff: impl Falloff,
    lines: Lines<'_, N>,
    cells: &mut [Cell<S, N>],
) {
    let Lines { lines, a, .. } = lines;
    let [Some(first), Some(last)] = [lines.first(), lines.last()] else {
        return;
    };
    for cell in &mut *cells {
        cell.q = cell.reach(simd, a, first);
    }
    for [line, next] in lines.array_windows() {
        for cell in &mut *cells {
            let ahead = cell.reach(simd, a, next);
            cell.add(simd, falloff, line);
            cell.q = ahead;
        }
    }
    for cell in cells {
        cell.add(simd, falloff, last);
    }
}

/// A group of places, and what is known of them. Aligned, because vectors
/// that lie across lines of the cache are slow.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Cell<S: Simd, const N: usize> {
    x: Group<S>,
    y: Group<S>,
    /// a + dist, of the line that comes next.
    q: Group<S>,
    weight: Group<S>,
    moved: [[Group<S>; 2]; N],
}

impl<S: Simd, const N: usize> Cell<S, N> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let zero = [simd.splat_f64s(0.0); GROUP];
        Self {
            x: zero,
            y: zero,
            q: zero,
            weight: zero,
            moved: [[zero; 2]; N],
        }
    }

    #[inline(always)]
    fn load(&mut self, simd: S, at: usize, places: &Places<'_>, sums: &Sums<N>) {
        let Places {
            per_unit, centre, ..
        } = *places;
        self.x = scaled(simd, groups::<S>(places.x)[at], per_unit, centre.x);
        self.y = scaled(simd, groups::<S>(places.y)[at], per_unit, centre.y);
        self.weight = groups::<S>(&sums.weight)[at];
        for (moved, rows) in self.moved.iter_mut().zip(&sums.moved) {
            for (moved, row) in moved.iter_mut().zip(rows) {
                *moved = groups::<S>(row)[at];
            }
        }
    }

    #[inline(always)]
    fn store(&self, at: usize, sums: &mut Sums<N>) {
        groups_mut::<S>(&mut sums.weight)[at] = self.weight;
        for (moved, rows) in self.moved.iter().zip(&mut sums.moved) {
            for (moved, row) in moved.iter().zip(rows) {
                groups_mut::<S>(row)[at] = *moved;
            }
        }
    }

    /// a + dist.
    #[inline(always)]
    fn reach(&self, simd: S, a: f64, line: &Line<N>) -> Group<S> {
        let all = |value| simd.splat_f64s(value);
        let (half, a, zero) = (all(line.half), all(a), all(0.0));
        let mut q = self.q;
        for (q, (&x, &y)) in q.iter_mut().zip(self.x.iter().zip(&self.y)) {
            let along = affine(simd, line.along, x, y);
            let across = affine(simd, line.across, x, y);
            let beyond = simd.sub_f64s(simd.abs_f64s(along), half);
            let beyond = simd.max_f64s(beyond, zero);
            let squared = simd.mul_f64s(across, across);
            let squared = simd.mul_add_e_f64s(beyond, beyond, squared);
            *q = simd.add_f64s(a, simd.sqrt_f64s(squared));
        }
        q
    }

    /// Adds w and w D of a line, whose q is known.
    #[inline(always)]
    fn add(&mut self, simd: S, falloff: impl Falloff, line: &Line<N>) {
        let w = falloff.weights(simd, simd.splat_f64s(line.strength), self.q);
        for (sum, &w) in self.weight.iter_mut().zip(&w) {
            *sum = simd.add_f64s(*sum, w);
        }
        for (moved, carry) in self.moved.iter_mut().zip(&line.carries) {
            for (sums, &carry) in moved.iter_mut().zip(carry) {
                let places = self.x.iter().zip(&self.y);
                for ((sum, &w), (&x, &y)) in sums.iter_mut().zip(&w).zip(places) {
                    *sum = simd.mul_add_e_f64s(w, affine(simd, carry, x, y), *sum);
                }
            }
        }
    }
}

/// Coordinates as the lines know them, none farther than [`FARTHEST`].
#[inline(always)]
fn scaled<S: Simd>(simd: S, mut group: Group<S>, per_unit: f64, centre: f64) -> Group<S> {
    let [per_unit, centre, farthest] = [
        simd.splat_f64s(per_unit),
        simd.splat_f64s(centre),
        simd.splat_f64s(FARTHEST),
    ];
    for value in &mut group {
        *value = simd.sub_f64s(simd.mul_f64s(*value, per_unit), centre);
        // In this order what is no number becomes one, lest its neighbours suffer.
        *value = simd.max_f64s(*value, simd.neg_f64s(farthest));
        *value = simd.min_f64s(*value, farthest);
    }
    group
}

/// The numbers of a row in groups of vectors.
#[inline(always)]
fn groups<S: Simd>(row: &Row) -> &[Group<S>] {
    S::as_simd_f64s(row).0.as_chunks().0
}

/// The same to write to.
#[inline(always)]
fn groups_mut<S: Simd>(row: &mut Row) -> &mut [Group<S>] {
    S::as_mut_simd_f64s(row).0.as_chunks_mut().0
}

/// c + a x + b y.
#[inline(always)]
fn affine<S: Simd>(simd: S, [c, a, b]: Affine, x: S::f64s, y: S::f64s) -> S::f64s {
    let [c, a, b] = [simd.splat_f64s(c), simd.splat_f64s(a), simd.splat_f64s(b)];
    simd.mul_add_e_f64s(x, a, simd.mul_add_e_f64s(y, b, c))
}
