//! The polynomials of all vertices between two times.
//!
//! Vertices lie in blocks, in the order in which a frame reads them: where they are
//! at both ends, then coefficient by coefficient. A coefficient that is small is
//! kept in half as many bits, since it is rounded by less than what was left out:
//! a frame of a large mesh is bound by memory. The sum is compiled for several widths of
//! vectors, and one is chosen at run time.

use super::nodes::{MAX_NODES, basis};
use crate::geometry::DVec2;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Vertices of a block.
pub(super) const BLOCK: usize = 8;

/// x and y of the vertices of a block.
pub(super) type BlockRow = [f64; 2 * BLOCK];
type NarrowBlockRow = [f32; 2 * BLOCK];

/// Blocks that one thread sums at a time. Fewer cost more to hand out than to sum.
const SHARE: usize = 1 << 11;

/// How many blocks so many vertices fill.
pub(super) fn block_count(vertices: usize) -> usize {
    vertices.div_ceil(BLOCK)
}

/// All vertices between two times.
#[derive(Clone, Debug)]
pub(super) struct RecordingInterval {
    pub from: f64,
    pub to: f64,
    arch: Arch,
    /// How many coefficients are kept in full, and how many are not.
    counts: [usize; 2],
    /// For each block both ends, then the coefficients.
    full: Vec<BlockRow>,
    /// For each block the other coefficients.
    narrow: Vec<NarrowBlockRow>,
}

impl RecordingInterval {
    /// Of blocks that begin and end there, with their coefficients block by block:
    /// the first so many are kept in full.
    pub(super) fn new(
        [from, to]: [f64; 2],
        ends: [&[BlockRow]; 2],
        coefficients: &[BlockRow],
        kept_in_full: usize,
    ) -> Self {
        let blocks = ends[0].len();
        let n = coefficients.len().checked_div(blocks).unwrap_or(0);
        let narrow = n - kept_in_full;
        let mut reel = Self {
            from,
            to,
            arch: Arch::new(),
            counts: [kept_in_full, narrow],
            full: Vec::with_capacity(blocks * (2 + kept_in_full)),
            narrow: Vec::with_capacity(blocks * narrow),
        };
        for block in 0..blocks {
            reel.full.extend([ends[0][block], ends[1][block]]);
            let (large, small) = coefficients[block * n..][..n].split_at(kept_in_full);
            reel.full.extend_from_slice(large);
            reel.narrow
                .extend(small.iter().map(|row| row.map(|c| c as f32)));
        }
        reel
    }

    /// How many coefficients a vertex has.
    pub(super) fn coefficient_count(&self) -> usize {
        self.counts[0] + self.counts[1]
    }

    /// Where a vertex is at both ends, by its number in the blocks.
    pub(super) fn ends(&self, vertex: usize) -> [DVec2; 2] {
        let first = vertex / BLOCK * (2 + self.counts[0]);
        [0, 1].map(|end| point(&self.full[first + end], vertex))
    }

    /// A coefficient of a vertex.
    pub(super) fn coefficient(&self, vertex: usize, k: usize) -> DVec2 {
        let ([full, narrow], block) = (self.counts, vertex / BLOCK);
        if k < full {
            return point(&self.full[block * (2 + full) + 2 + k], vertex);
        }
        let row = &self.narrow[block * narrow + k - full];
        point(&row.map(f64::from), vertex)
    }

    /// The vertices of a block: where they are at both ends, then their coefficients.
    #[cfg(feature = "bevy")]
    pub(super) fn row(&self, block: usize, k: usize) -> BlockRow {
        let [full, narrow] = self.counts;
        match k.checked_sub(2 + full) {
            None => self.full[block * (2 + full) + k],
            Some(k) => self.narrow[block * narrow + k].map(f64::from),
        }
    }

    /// How far into it `t` is, from 0 to 1.
    pub(super) fn share(&self, t: f64) -> f64 {
        (t - self.from) / (self.to - self.from)
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.full[..]) + size_of_val(&self.narrow[..])
    }

    /// Moves the vertices from a block on to where they are at `t`.
    pub(super) fn place(&self, t: f64, first: usize, places: &mut [DVec2]) {
        let s = self.share(t);
        let share = |k: usize, places: &mut [DVec2]| {
            self.arch.dispatch(IntervalSum {
                reel: self,
                first: first + k * SHARE,
                s,
                places,
            });
        };
        if places.len() <= SHARE * BLOCK {
            return share(0, places);
        }
        let shares = places.par_chunks_mut(SHARE * BLOCK).enumerate();
        shares.for_each(|(k, places)| share(k, places));
    }
}

/// The sum of some vertices, to be compiled for several widths of vectors.
struct IntervalSum<'a> {
    reel: &'a RecordingInterval,
    first: usize,
    s: f64,
    places: &'a mut [DVec2],
}

impl WithSimd for IntervalSum<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            reel,
            first,
            s,
            places,
        } = self;
        let [full, narrow] = reel.counts;
        let weights: [f64; MAX_NODES] = basis(full + narrow, s);
        let (large, small) = weights[..full + narrow].split_at(full);
        for (k, places) in places.chunks_mut(BLOCK).enumerate() {
            let block = first + k;
            let rows = &reel.full[block * (2 + full)..][..2 + full];
            let mut sum = [0.0; 2 * BLOCK];
            for (weight, row) in large.iter().zip(&rows[2..]) {
                add(&mut sum, *weight, row);
            }
            let rest = &reel.narrow[block * narrow..][..narrow];
            for (weight, row) in small.iter().zip(rest) {
                add(&mut sum, *weight, &row.map(f64::from));
            }
            // What is exactly 0 at an end is added last, so that the end is met to
            // the last bit.
            let straight = |i: usize| rows[0][i] * (1.0 - s) + rows[1][i] * s;
            for (i, place) in places.iter_mut().enumerate() {
                let [x, y] = [2 * i, 2 * i + 1].map(|i| straight(i) + sum[i]);
                *place = DVec2::new(x, y);
            }
        }
    }
}

/// What a row says of a vertex of its block.
fn point(row: &BlockRow, vertex: usize) -> DVec2 {
    let at = 2 * (vertex % BLOCK);
    DVec2::new(row[at], row[at + 1])
}

#[inline(always)]
fn add(sum: &mut BlockRow, weight: f64, row: &BlockRow) {
    for (sum, c) in sum.iter_mut().zip(row) {
        *sum += weight * c;
    }
}
