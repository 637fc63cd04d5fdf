//! The polynomials of all vertices in one time interval, and their evaluation.
//!
//! Vertices are stored in blocks, in the order in which a frame reads them: the positions at both
//! ends, then coefficient by coefficient. Small coefficients are stored in single precision, since
//! their rounding is smaller than the omitted terms: frames of large meshes are limited by memory
//! bandwidth. The sum is compiled for several SIMD widths, one of which is chosen at run time.

use super::nodes::{MAX_NODES, basis};
use crate::geometry::DVec2;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Number of vertices in a block: two 512-bit vectors of coordinates (heuristic).
pub(super) const BLOCK: usize = 8;

/// x and y of the vertices of a block, alternating.
pub(super) type BlockRow = [f64; 2 * BLOCK];
/// The same in single precision.
type NarrowBlockRow = [f32; 2 * BLOCK];

/// Number of blocks that one thread evaluates at a time (heuristic; distributing fewer costs more
/// than evaluating them).
const BLOCKS_PER_TASK: usize = 1 << 11;

/// Returns the number of blocks that `vertices` vertices fill.
pub(super) fn block_count(vertices: usize) -> usize {
    vertices.div_ceil(BLOCK)
}

/// The polynomials of all vertices in one time interval.
#[derive(Clone, Debug)]
pub(super) struct RecordingInterval {
    /// t at the beginning.
    pub from: f64,
    /// t at the end.
    pub to: f64,
    arch: Arch,
    /// Number of coefficients in double and in single precision.
    counts: [usize; 2],
    /// For each block the positions at both ends, then the double-precision coefficients.
    full: Vec<BlockRow>,
    /// For each block the single-precision coefficients.
    narrow: Vec<NarrowBlockRow>,
}

impl RecordingInterval {
    /// Builds an interval from the positions at both ends and the coefficients block by block, the
    /// first `full_count` of which stay in double precision.
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

    /// Returns the number of coefficients of each vertex.
    pub(super) fn coefficient_count(&self) -> usize {
        self.counts[0] + self.counts[1]
    }

    /// Returns the positions of a vertex at both ends, by its index in the blocks.
    pub(super) fn ends(&self, vertex: usize) -> [DVec2; 2] {
        let first = vertex / BLOCK * (2 + self.counts[0]);
        [0, 1].map(|end| point(&self.full[first + end], vertex))
    }

    /// Returns coefficient `k` of a vertex, by its index in the blocks.
    pub(super) fn coefficient(&self, vertex: usize, k: usize) -> DVec2 {
        let ([full, narrow], block) = (self.counts, vertex / BLOCK);
        if k < full {
            // Two rows of end positions come before the coefficients.
            return point(&self.full[block * (2 + full) + 2 + k], vertex);
        }
        let row = &self.narrow[block * narrow + k - full];
        point(&row.map(f64::from), vertex)
    }

    /// Returns row `k` of a block: rows 0 and 1 are the positions at both ends, the others the
    /// coefficients.
    #[cfg(feature = "bevy")]
    pub(super) fn row(&self, block: usize, k: usize) -> BlockRow {
        let [full, narrow] = self.counts;
        match k.checked_sub(2 + full) {
            None => self.full[block * (2 + full) + k],
            Some(k) => self.narrow[block * narrow + k].map(f64::from),
        }
    }

    /// Returns the fraction of the interval that has passed at `t`, from 0 to 1.
    pub(super) fn share(&self, t: f64) -> f64 {
        (t - self.from) / (self.to - self.from)
    }

    /// Returns the size of the coefficients and end positions in bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.full[..]) + size_of_val(&self.narrow[..])
    }

    /// Writes the positions at `t` of the vertices from block `first` on.
    pub(super) fn place(&self, t: f64, first: usize, places: &mut [DVec2]) {
        let s = self.share(t);
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

/// The evaluation of some vertices, compiled for several SIMD widths.
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
            // The sum is exactly 0 at both ends; added last, it leaves the end positions exact.
            let straight = |i: usize| rows[0][i] * (1.0 - s) + rows[1][i] * s;
            for (i, place) in places.iter_mut().enumerate() {
                let [x, y] = [2 * i, 2 * i + 1].map(|i| straight(i) + sum[i]);
                *place = DVec2::new(x, y);
            }
        }
    }
}

/// Returns the entry of a row that belongs to a vertex of its block.
fn point(row: &BlockRow, vertex: usize) -> DVec2 {
    let first_number = 2 * (vertex % BLOCK);
    DVec2::new(row[first_number], row[first_number + 1])
}

/// Adds a weighted row to a sum.
#[inline(always)]
fn add(sum: &mut BlockRow, weight: f64, row: &BlockRow) {
    for (sum, c) in sum.iter_mut().zip(row) {
        *sum += weight * c;
    }
}
