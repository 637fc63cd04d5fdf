//! Polynomials of all vertices in one time interval of a recording, and their evaluation.
//!
//! Vertices are stored in blocks. The numbers of a block are stored in the order in which an
//! evaluation reads them: first the positions at both ends of the interval, then one coefficient
//! after another. Small coefficients are stored in single precision, because their rounding error
//! is small compared with the tolerance and the evaluation of large meshes is limited by memory
//! bandwidth. The sum is compiled for several SIMD widths; one of them is chosen at run time.

use super::nodes::{MAX_NODES, basis};
use crate::geometry::DVec2;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Number of vertices in a block (heuristic: their coordinates fill two 512-bit vectors).
pub(super) const BLOCK: usize = 8;

/// Row of a block: one point (a position or a polynomial coefficient) for each of its vertices,
/// stored as x₀, y₀, x₁, y₁ and so on.
pub(super) type BlockRow = [f64; 2 * BLOCK];
/// Row of a block in single precision.
type NarrowBlockRow = [f32; 2 * BLOCK];

/// Number of blocks that one thread evaluates at a time (heuristic: with fewer blocks, distributing
/// the work would take longer than the work).
const BLOCKS_PER_TASK: usize = 1 << 11;

/// Returns the number of blocks that `vertices` vertices need; the last one may be partly filled.
pub(super) fn block_count(vertices: usize) -> usize {
    vertices.div_ceil(BLOCK)
}

/// Polynomials of all vertices in one time interval.
#[derive(Clone, Debug)]
pub(super) struct RecordingInterval {
    /// The t at which the interval begins.
    pub from: f64,
    /// The t at which the interval ends.
    pub to: f64,
    arch: Arch,
    /// Number of polynomial coefficients of a vertex in double precision, and number of its
    /// coefficients in single precision; the same for all vertices.
    counts: [usize; 2],
    /// For each block: the rows of positions at both ends of the interval, then the rows of
    /// polynomial coefficients in double precision.
    full: Vec<BlockRow>,
    /// For each block: the rows of polynomial coefficients in single precision.
    narrow: Vec<NarrowBlockRow>,
}

impl RecordingInterval {
    /// Builds an interval from the positions at its ends and from all polynomial coefficients,
    /// block by block. The first `full_count` coefficients of each vertex stay in double precision;
    /// the others are rounded to single precision.
    pub(super) fn new(
        [from, to]: [f64; 2],
        ends: [&[BlockRow]; 2],
        coefficients: &[BlockRow],
        full_count: usize,
    ) -> Self {
        let blocks = ends[0].len();
        let n = coefficients.len().checked_div(blocks).unwrap_or(0);
        let narrow = n - full_count;
        let mut interval = Self {
            from,
            to,
            arch: Arch::new(),
            counts: [full_count, narrow],
            full: Vec::with_capacity(blocks * (2 + full_count)),
            narrow: Vec::with_capacity(blocks * narrow),
        };
        for block in 0..blocks {
            interval.full.extend([ends[0][block], ends[1][block]]);
            let (large, small) = coefficients[block * n..][..n].split_at(full_count);
            interval.full.extend_from_slice(large);
            interval
                .narrow
                .extend(small.iter().map(|row| row.map(|c| c as f32)));
        }
        interval
    }

    /// Returns the number of coefficients of each vertex's polynomial.
    pub(super) fn coefficient_count(&self) -> usize {
        self.counts[0] + self.counts[1]
    }

    /// Returns the positions of one vertex at both ends of the interval. `vertex` is its index
    /// among the vertices of all blocks.
    pub(super) fn ends(&self, vertex: usize) -> [DVec2; 2] {
        let first = vertex / BLOCK * (2 + self.counts[0]);
        [0, 1].map(|end| point(&self.full[first + end], vertex))
    }

    /// Returns coefficient `k` of the polynomial of one vertex. `vertex` is its index among the
    /// vertices of all blocks.
    pub(super) fn coefficient(&self, vertex: usize, k: usize) -> DVec2 {
        let ([full, narrow], block) = (self.counts, vertex / BLOCK);
        if k < full {
            // Two rows of end positions precede the coefficients.
            return point(&self.full[block * (2 + full) + 2 + k], vertex);
        }
        let row = &self.narrow[block * narrow + k - full];
        point(&row.map(f64::from), vertex)
    }

    /// Returns row `k` of a block in double precision. Rows 0 and 1 are the positions at both ends
    /// of the interval, the other rows are the polynomial coefficients.
    #[cfg(feature = "bevy")]
    pub(super) fn row(&self, block: usize, k: usize) -> BlockRow {
        let [full, narrow] = self.counts;
        match k.checked_sub(2 + full) {
            None => self.full[block * (2 + full) + k],
            Some(k) => self.narrow[block * narrow + k].map(f64::from),
        }
    }

    /// Returns s, the fraction of the interval that has passed at `t`, from 0 to 1.
    pub(super) fn fraction(&self, t: f64) -> f64 {
        (t - self.from) / (self.to - self.from)
    }

    /// Returns the size of the end positions and polynomial coefficients in bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.full[..]) + size_of_val(&self.narrow[..])
    }

    /// Fills `places` with positions at `t`: those of the first vertex of the block with the index
    /// `first` and of the vertices after it.
    pub(super) fn place(&self, t: f64, first: usize, places: &mut [DVec2]) {
        let s = self.fraction(t);
        let evaluate_task = |k: usize, places: &mut [DVec2]| {
            self.arch.dispatch(IntervalSum {
                interval: self,
                first: first + k * BLOCKS_PER_TASK,
                s,
                places,
            });
        };
        if places.len() <= BLOCKS_PER_TASK * BLOCK {
            return evaluate_task(0, places);
        }
        let tasks = places.par_chunks_mut(BLOCKS_PER_TASK * BLOCK).enumerate();
        tasks.for_each(|(k, places)| evaluate_task(k, places));
    }
}

/// Evaluation of the positions in consecutive blocks at `s`, the fraction of the interval that has
/// passed. The code is compiled for several SIMD widths.
struct IntervalSum<'a> {
    interval: &'a RecordingInterval,
    first: usize,
    s: f64,
    places: &'a mut [DVec2],
}

impl WithSimd for IntervalSum<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            interval,
            first,
            s,
            places,
        } = self;
        let [full, narrow] = interval.counts;
        let weights: [f64; MAX_NODES] = basis(full + narrow, s);
        let (large, small) = weights[..full + narrow].split_at(full);
        for (k, places) in places.chunks_mut(BLOCK).enumerate() {
            let block = first + k;
            let rows = &interval.full[block * (2 + full)..][..2 + full];
            let mut sum = [0.0; 2 * BLOCK];
            for (weight, row) in large.iter().zip(&rows[2..]) {
                add(&mut sum, *weight, row);
            }
            let narrow_rows = &interval.narrow[block * narrow..][..narrow];
            for (weight, row) in small.iter().zip(narrow_rows) {
                add(&mut sum, *weight, &row.map(f64::from));
            }
            // At both ends of the interval all basis functions are 0. `sum` is then exactly 0, so
            // the result is exactly the end position.
            let straight = |i: usize| rows[0][i] * (1.0 - s) + rows[1][i] * s;
            for (i, place) in places.iter_mut().enumerate() {
                let [x, y] = [2 * i, 2 * i + 1].map(|i| straight(i) + sum[i]);
                *place = DVec2::new(x, y);
            }
        }
    }
}

/// Returns the point that the row of a block contains for one of its vertices. `vertex` is the
/// vertex's index among all blocks, so the remainder modulo [`BLOCK`] is its place in the row.
fn point(row: &BlockRow, vertex: usize) -> DVec2 {
    let first_number = 2 * (vertex % BLOCK);
    DVec2::new(row[first_number], row[first_number + 1])
}

/// Adds a row, multiplied by `weight`, to a sum.
#[inline(always)]
fn add(sum: &mut BlockRow, weight: f64, row: &BlockRow) {
    for (sum, c) in sum.iter_mut().zip(row) {
        *sum += weight * c;
    }
}
