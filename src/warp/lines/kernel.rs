//! Σ w D / Σ w over lines, for many places at a time.
//!
//! The width of the vectors is chosen at run time; results differ between
//! widths in the last digits at most.
//!
//! Guaranteed: a weight is a positive finite number, and so are all numbers
//! on the way to it, if places are no farther than [`FARTHEST`] and a is from
//! [`LEAST_A`] to [`LARGEST_A`].

use super::line::{AffineFunction, FieldLine};
use super::scaled_plane::ScaledPlane;
use crate::geometry::DVec2;
use crate::warp::elementary::{exp, ln};
use pulp::{Arch, Simd, WithSimd, bytemuck};

/// How many vectors share a division. Four would share it as well, but more
/// of their numbers than there are registers for.
const GROUP: usize = 2;

/// Vectors that are handled together.
type VectorGroup<S> = [<S as Simd>::f64s; GROUP];

/// How many places there are in a block.
const BLOCK: usize = 128;

/// How many groups of vectors are taken through the lines together: a block,
/// if vectors have four numbers.
const CELLS: usize = BLOCK / GROUP / 4;

/// The farthest place, scaled.
const FARTHEST: f64 = 1e36;

/// The least a, scaled: below what coordinates can tell.
pub(super) const LEAST_A: f64 = 1e-30;

/// The largest a, scaled: to all features it makes no difference any more.
pub(super) const LARGEST_A: f64 = 1e30;

/// The least Σ w that is one: that of no lines is 0, and no other is below.
const LEAST_WEIGHT: f64 = 1e-300;

/// A number of each place of a block.
type PlaceLanes = [f64; BLOCK];

/// How weight falls with q = a + dist: strength / q^b. Places come in pairs of
/// vectors: one division does for both weights, as 1/q = (the other q) /
/// (product of both).
trait WeightFalloff: Copy {
    /// `strength` / q^b.
    fn weights<S: Simd>(self, simd: S, strength: S::f64s, q: VectorGroup<S>) -> VectorGroup<S>;
}

/// b = 1.
#[derive(Clone, Copy)]
struct InverseFalloff;

/// b = 2.
#[derive(Clone, Copy)]
struct InverseSquareFalloff;

/// Any b.
#[derive(Clone, Copy)]
struct InversePowerFalloff(f64);

impl WeightFalloff for InverseFalloff {
    #[inline(always)]
    fn weights<S: Simd>(
        self,
        simd: S,
        strength: S::f64s,
        [p, q]: VectorGroup<S>,
    ) -> VectorGroup<S> {
        let both = simd.div_f64s(strength, simd.mul_f64s(p, q));
        [simd.mul_f64s(both, q), simd.mul_f64s(both, p)]
    }
}

impl WeightFalloff for InverseSquareFalloff {
    #[inline(always)]
    fn weights<S: Simd>(
        self,
        simd: S,
        strength: S::f64s,
        [p, q]: VectorGroup<S>,
    ) -> VectorGroup<S> {
        let squares = [simd.mul_f64s(p, p), simd.mul_f64s(q, q)];
        InverseFalloff.weights(simd, strength, squares)
    }
}

impl WeightFalloff for InversePowerFalloff {
    #[inline(always)]
    fn weights<S: Simd>(self, simd: S, strength: S::f64s, mut q: VectorGroup<S>) -> VectorGroup<S> {
        for value in bytemuck::cast_slice_mut::<_, f64>(&mut q) {
            *value = exp(-self.0 * ln(*value));
        }
        [simd.mul_f64s(strength, q[0]), simd.mul_f64s(strength, q[1])]
    }
}

/// Lines to be summed over.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaledLines<'a> {
    pub(super) lines: &'a [FieldLine],
    /// What they are scaled by.
    pub(super) plane: ScaledPlane,
    /// The paper's a, scaled.
    pub(super) a: f64,
    /// The paper's b.
    pub(super) b: f64,
}

/// Where each place is looked up in both designs: moved by Σ w D / Σ w, and
/// not at all where there are no lines.
pub(super) fn look_up(
    arch: Arch,
    lines: ScaledLines<'_>,
    places: &[DVec2],
    designs: [&mut [DVec2]; 2],
) {
    let b = lines.b;
    let job = (lines, places, designs);
    if b == 2.0 {
        arch.dispatch(LinePass(InverseSquareFalloff, job));
    } else if b == 1.0 {
        arch.dispatch(LinePass(InverseFalloff, job));
    } else {
        arch.dispatch(LinePass(InversePowerFalloff(b), job));
    }
}

/// The work, to be compiled for several widths of vectors.
struct LinePass<'a, F>(F, (ScaledLines<'a>, &'a [DVec2], [&'a mut [DVec2]; 2]));

impl<F: WeightFalloff> WithSimd for LinePass<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(falloff, (lines, places, [source, target])) = self;
        let mut cells = [LaneCell::new(simd); CELLS];
        let designs = source.chunks_mut(BLOCK).zip(target.chunks_mut(BLOCK));
        for (places, designs) in places.chunks(BLOCK).zip(designs) {
            let mut block = PlaceBlock::of(places);
            // The last block may be short; what is behind it is not computed.
            let used = places.len().div_ceil(GROUP * S::F64_LANES);
            for start in (0..used).step_by(CELLS) {
                let cells = &mut cells[..CELLS.min(used - start)];
                for (k, cell) in cells.iter_mut().enumerate() {
                    *cell = block.cell(simd, start + k, &lines.plane);
                }
                sum(simd, falloff, lines, cells);
                for (k, cell) in cells.iter().enumerate() {
                    block.take(simd, start + k, cell, lines.plane.unit);
                }
            }
            block.write(places, designs.into());
        }
    }
}

/// A block of places, and how far each is moved in both designs.
struct PlaceBlock {
    /// x and y. Behind the last place stands that place again, and what is
    /// computed there is computed in vain.
    places: [PlaceLanes; 2],
    moved: [[PlaceLanes; 2]; 2],
}

impl PlaceBlock {
    #[inline(always)]
    fn of(places: &[DVec2]) -> Self {
        // `chunks` yields no empty block.
        let last = places.len() - 1;
        let mut block = Self {
            places: [[0.0; BLOCK]; 2],
            moved: [[[0.0; BLOCK]; 2]; 2],
        };
        let [x, y] = &mut block.places;
        for (lane, (x, y)) in x.iter_mut().zip(y).enumerate() {
            [*x, *y] = places[lane.min(last)].to_array();
        }
        block
    }

    /// The places of a group, with no line added.
    #[inline(always)]
    fn cell<S: Simd>(&self, simd: S, at: usize, plane: &ScaledPlane) -> LaneCell<S> {
        let [x, y] = self.places.each_ref().map(|row| groups::<S>(row)[at]);
        LaneCell {
            x: scaled(simd, x, plane.per_unit, plane.centre.x),
            y: scaled(simd, y, plane.per_unit, plane.centre.y),
            ..LaneCell::new(simd)
        }
    }

    /// `unit` Σ w D / Σ w of a group.
    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, at: usize, cell: &LaneCell<S>, unit: f64) {
        // Without lines Σ w and the sums are 0, and 0 / 10⁻³⁰⁰ is no movement.
        let [one, unit, least] = [1.0, unit, LEAST_WEIGHT].map(|x| simd.splat_f64s(x));
        let mut factors = cell.weight;
        for factor in &mut factors {
            *factor = simd.div_f64s(one, simd.max_f64s(*factor, least));
        }
        let rows = self.moved.as_flattened_mut().iter_mut();
        for (row, sums) in rows.zip(cell.moved.as_flattened()) {
            let out = groups_mut::<S>(row)[at].iter_mut();
            for (out, (&sum, &factor)) in out.zip(sums.iter().zip(&factors)) {
                *out = simd.mul_f64s(simd.mul_f64s(sum, factor), unit);
            }
        }
    }

    #[inline(always)]
    fn write(&self, places: &[DVec2], designs: [&mut [DVec2]; 2]) {
        for (design, [dx, dy]) in designs.into_iter().zip(&self.moved) {
            for (lane, (out, &place)) in design.iter_mut().zip(places).enumerate() {
                *out = place + DVec2::new(dx[lane], dy[lane]);
            }
        }
    }
}

/// Sums over all lines.
///
/// A line's weights wait long for its roots: so these are begun one line
/// ahead, for all cells, and no processor needs to look far.
#[inline(always)]
fn sum<S: Simd>(
    simd: S,
    falloff: impl WeightFalloff,
    lines: ScaledLines<'_>,
    cells: &mut [LaneCell<S>],
) {
    let ScaledLines { lines, a, .. } = lines;
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
struct LaneCell<S: Simd> {
    x: VectorGroup<S>,
    y: VectorGroup<S>,
    /// a + dist, of the line that comes next.
    q: VectorGroup<S>,
    weight: VectorGroup<S>,
    moved: [[VectorGroup<S>; 2]; 2],
}

impl<S: Simd> LaneCell<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let zero = [simd.splat_f64s(0.0); GROUP];
        Self {
            x: zero,
            y: zero,
            q: zero,
            weight: zero,
            moved: [[zero; 2]; 2],
        }
    }

    /// a + dist.
    #[inline(always)]
    fn reach(&self, simd: S, a: f64, line: &FieldLine) -> VectorGroup<S> {
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
    fn add(&mut self, simd: S, falloff: impl WeightFalloff, line: &FieldLine) {
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
fn scaled<S: Simd>(
    simd: S,
    mut group: VectorGroup<S>,
    per_unit: f64,
    centre: f64,
) -> VectorGroup<S> {
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
fn groups<S: Simd>(row: &PlaceLanes) -> &[VectorGroup<S>] {
    S::as_simd_f64s(row).0.as_chunks().0
}

/// The same to write to.
#[inline(always)]
fn groups_mut<S: Simd>(row: &mut PlaceLanes) -> &mut [VectorGroup<S>] {
    S::as_mut_simd_f64s(row).0.as_chunks_mut().0
}

/// c + a x + b y.
#[inline(always)]
fn affine<S: Simd>(simd: S, [c, a, b]: AffineFunction, x: S::f64s, y: S::f64s) -> S::f64s {
    let [c, a, b] = [simd.splat_f64s(c), simd.splat_f64s(a), simd.splat_f64s(b)];
    simd.mul_add_e_f64s(x, a, simd.mul_add_e_f64s(y, b, c))
}
