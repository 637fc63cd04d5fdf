//! Vectorised evaluation of the mean displacement Σ w D / Σ w at many points, where the sums run
//! over all lines, D is the displacement that a line gives to a point, and w is the line's weight.
//!
//! The vector width is chosen at run time; results for different widths agree up to the last
//! digits.
//!
//! Guaranteed: weights are positive and all intermediate results finite if the constant a of Beier
//! and Neely is between [`MIN_A`] and [`MAX_A`]; coordinates beyond ±[`MAX_SCALED_COORDINATE`] are
//! clamped.

use super::line::{AffineFunction, FieldLine};
use super::scaled_plane::ScaledPlane;
use crate::geometry::DVec2;
use crate::warp::elementary::{exp, ln};
use pulp::{Arch, Simd, WithSimd, bytemuck};

/// Number of SIMD vectors that share one division (resource limit: four vectors would exceed the
/// registers).
const GROUP: usize = 2;

/// SIMD vectors that are processed together and share a division.
type VectorGroup<S> = [<S as Simd>::f64s; GROUP];

/// Number of points in a block (resource limit: the data of a block fit into the first-level
/// cache).
const BLOCK: usize = 128;

/// Number of groups of points whose sums are computed in one pass over the lines (derived: these
/// groups make up one block if a vector holds four numbers).
const CELLS: usize = BLOCK / GROUP / 4;

/// Largest absolute value of a scaled point coordinate; larger values are clamped (derived: at this
/// distance the weight 1 / distᵇ is still a normal number for the largest exponent b, which is 8).
const MAX_SCALED_COORDINATE: f64 = 1e36;

/// Lower bound of Beier and Neely's constant a, in scaled units (tolerance: far below the
/// resolution of the coordinates).
pub(super) const MIN_A: f64 = 1e-30;

/// Upper bound of Beier and Neely's constant a, in scaled units (tolerance: already so large that
/// the distance of a point from a line is negligible in a + distance).
pub(super) const MAX_A: f64 = 1e30;

/// Lower bound of the divisor Σ w, which is zero if there are no lines (derived: smaller than the
/// sum with at least one line).
const MIN_WEIGHT: f64 = 1e-300;

/// One number per point of a block.
type PlaceLanes = [f64; BLOCK];

/// Decrease of a line's weight with the distance of a point from the line: strength / qᵇ, where
/// q = a + distance, and a and b are the constants of Beier and Neely.
///
/// Two vectors of points are processed together, and one division gives both weights:
/// 1/q₁ = q₂ / (q₁ q₂) and 1/q₂ = q₁ / (q₁ q₂).
trait WeightFalloff: Copy {
    /// Returns `strength` / qᵇ for each number q in the two SIMD vectors.
    fn weights<S: Simd>(self, simd: S, strength: S::f64s, q: VectorGroup<S>) -> VectorGroup<S>;
}

/// Weight falloff with b = 1: strength / (a + distance).
#[derive(Clone, Copy)]
struct InverseFalloff;

/// Weight falloff with b = 2: strength / (a + distance)².
#[derive(Clone, Copy)]
struct InverseSquareFalloff;

/// Weight falloff with any b: strength / (a + distance)ᵇ. Holds b.
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

/// All lines at one t, with the constants of their weights.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaledLines<'a> {
    pub(super) lines: &'a [FieldLine],
    /// Transformation from plane coordinates to the scaled coordinates of `lines`.
    pub(super) plane: ScaledPlane,
    /// Constant a of Beier and Neely, in scaled units.
    pub(super) a: f64,
    /// Exponent b of Beier and Neely.
    pub(super) b: f64,
}

/// For each design, writes each point displaced by the weighted mean of the displacements that the
/// lines give to it.
///
/// Without lines the points stay where they are.
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

/// Computation of the displaced points in both designs for a list of points, compiled once for each
/// vector width.
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
            // The last block may be short; groups beyond its end are skipped.
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

/// A block of points and their displacements in both designs.
struct PlaceBlock {
    /// x and y coordinates. A short block is padded with its last point; the results of the
    /// padding are not used.
    places: [PlaceLanes; 2],
    /// For each design and axis: the displacement that leads from each point, which is a position
    /// in the frame, to the point of the design that is drawn at this position.
    mapped: [[PlaceLanes; 2]; 2],
}

impl PlaceBlock {
    #[inline(always)]
    fn of(places: &[DVec2]) -> Self {
        // `chunks` yields no empty block.
        let last = places.len() - 1;
        let mut block = Self {
            places: [[0.0; BLOCK]; 2],
            mapped: [[[0.0; BLOCK]; 2]; 2],
        };
        let [x, y] = &mut block.places;
        for (lane, (x, y)) in x.iter_mut().zip(y).enumerate() {
            [*x, *y] = places[lane.min(last)].to_array();
        }
        block
    }

    /// Returns the group of points with index `at`: their scaled coordinates, and the sums over the
    /// lines, which are still zero.
    #[inline(always)]
    fn cell<S: Simd>(&self, simd: S, at: usize, plane: &ScaledPlane) -> LaneCell<S> {
        let [x, y] = self.places.each_ref().map(|row| groups::<S>(row)[at]);
        LaneCell {
            x: scale_group(simd, x, plane.per_unit, plane.centre.x),
            y: scale_group(simd, y, plane.per_unit, plane.centre.y),
            ..LaneCell::new(simd)
        }
    }

    /// Divides the sums of the group with index `at` by the sum of the weights. Stores the
    /// resulting mean displacements, multiplied by `unit` to convert them to plane units.
    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, at: usize, cell: &LaneCell<S>, unit: f64) {
        // Without lines all sums are 0, and 0 / 10⁻³⁰⁰ gives zero displacement.
        let [one, unit, min_weight] = [1.0, unit, MIN_WEIGHT].map(|x| simd.splat_f64s(x));
        let mut factors = cell.weight;
        for factor in &mut factors {
            *factor = simd.div_f64s(one, simd.max_f64s(*factor, min_weight));
        }
        let rows = self.mapped.as_flattened_mut().iter_mut();
        for (row, sums) in rows.zip(cell.mapped.as_flattened()) {
            let out = groups_mut::<S>(row)[at].iter_mut();
            for (out, (&sum, &factor)) in out.zip(sums.iter().zip(&factors)) {
                *out = simd.mul_f64s(simd.mul_f64s(sum, factor), unit);
            }
        }
    }

    /// Writes the design points, which are `places` displaced by `mapped`, to the slice of each
    /// design.
    #[inline(always)]
    fn write(&self, places: &[DVec2], designs: [&mut [DVec2]; 2]) {
        for (design, [dx, dy]) in designs.into_iter().zip(&self.mapped) {
            for (lane, (out, &place)) in design.iter_mut().zip(places).enumerate() {
                *out = place + DVec2::new(dx[lane], dy[lane]);
            }
        }
    }
}

/// Adds the weight of each line, and its displacements times this weight, to the sums of each group
/// of points.
///
/// Square roots have a long latency. The distances to the next line are therefore computed before
/// the current line is added, so that the processor can overlap the two.
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

/// A group of points with its running sums.
///
/// Aligned to cache lines, because vectors that straddle two of them are slow.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct LaneCell<S: Simd> {
    x: VectorGroup<S>,
    y: VectorGroup<S>,
    /// For each point: q = a + its distance from the line that is added next.
    q: VectorGroup<S>,
    /// For each point: the sum of the weights of the lines added so far.
    weight: VectorGroup<S>,
    /// For each design and axis, the sum over the lines added so far of weight times displacement,
    /// where the displacement leads from a frame point to the design point that the line assigns to
    /// it.
    mapped: [[VectorGroup<S>; 2]; 2],
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
            mapped: [[zero; 2]; 2],
        }
    }

    /// Returns, for each point, q = a + its distance from `line`.
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

    /// Adds the weight of a line, and its displacement times this weight, to the sums. `self.q`
    /// must already hold the result of `reach` for the line.
    #[inline(always)]
    fn add(&mut self, simd: S, falloff: impl WeightFalloff, line: &FieldLine) {
        let w = falloff.weights(simd, simd.splat_f64s(line.strength), self.q);
        for (sum, &w) in self.weight.iter_mut().zip(&w) {
            *sum = simd.add_f64s(*sum, w);
        }
        for (mapped, carry) in self.mapped.iter_mut().zip(&line.carries) {
            for (sums, &carry) in mapped.iter_mut().zip(carry) {
                let places = self.x.iter().zip(&self.y);
                for ((sum, &w), (&x, &y)) in sums.iter_mut().zip(&w).zip(places) {
                    *sum = simd.mul_add_e_f64s(w, affine(simd, carry, x, y), *sum);
                }
            }
        }
    }
}

/// Converts coordinates to scaled units and clamps them to ±[`MAX_SCALED_COORDINATE`].
#[inline(always)]
fn scale_group<S: Simd>(
    simd: S,
    mut group: VectorGroup<S>,
    per_unit: f64,
    centre: f64,
) -> VectorGroup<S> {
    let [per_unit, centre, farthest] = [
        simd.splat_f64s(per_unit),
        simd.splat_f64s(centre),
        simd.splat_f64s(MAX_SCALED_COORDINATE),
    ];
    for value in &mut group {
        *value = simd.sub_f64s(simd.mul_f64s(*value, per_unit), centre);
        // In this order `max` and `min` turn NaN into a number, so that a NaN point does not affect
        // the sums of other points.
        *value = simd.max_f64s(*value, simd.neg_f64s(farthest));
        *value = simd.min_f64s(*value, farthest);
    }
    group
}

/// Views one number per point as groups of SIMD vectors.
#[inline(always)]
fn groups<S: Simd>(row: &PlaceLanes) -> &[VectorGroup<S>] {
    S::as_simd_f64s(row).0.as_chunks().0
}

/// Views one number per point as groups of SIMD vectors, mutably.
#[inline(always)]
fn groups_mut<S: Simd>(row: &mut PlaceLanes) -> &mut [VectorGroup<S>] {
    S::as_mut_simd_f64s(row).0.as_chunks_mut().0
}

/// Evaluates an affine function c + a x + b y at a vector of points (x, y).
#[inline(always)]
fn affine<S: Simd>(simd: S, [c, a, b]: AffineFunction, x: S::f64s, y: S::f64s) -> S::f64s {
    let [c, a, b] = [simd.splat_f64s(c), simd.splat_f64s(a), simd.splat_f64s(b)];
    simd.mul_add_e_f64s(x, a, simd.mul_add_e_f64s(y, b, c))
}
