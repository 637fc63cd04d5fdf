//! From placements of a warp to reels.
//!
//! Between two times the warp is placed at one node after the other, until what is
//! found at a pair of new nodes is what the polynomial through those before says
//! there. Where it would take too many, both halves are recorded apart; the warp
//! itself tells at which times something sets out or arrives.

use super::channels::MovingChannels;
use super::interval::{BLOCK, BlockRow, RecordingInterval, block_count};
use super::nodes::{MAX_NODES, coefficients_from_values, nodes, weights};
use super::options::RecordingOptions;
use crate::geometry::Bounds;
use crate::warp::{Placer, Warp};
use crate::work::progress::{Cancelled, Progress, checkpoint, still_wanted};
use rayon::prelude::*;

/// Nodes after which it is foreseen whether the interval will do.
const FORESEEN: usize = 9;

/// What does not settle within an interval so short is not halved any more: it jumps.
const SHORTEST: f64 = 1.0 / 1024.0;

/// Times that are nearer to each other are one.
const SAME: f64 = 1e-12;

/// Where between two breaks it is looked at what moves: nothing is there by accident
/// what it is at the ends.
const WITHIN: f64 = 0.381_966;

/// What of the tolerance the rounding of small coefficients may take, and what those
/// that are left out may.
const ROUNDED: f64 = 0.1;
const LEFT_OUT: f64 = 0.1;

/// Why there is no film.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// It would take more memory than it may.
    #[error("the film would take {bytes} bytes, and may take {most}")]
    TooLarge {
        /// What was needed when it was given up.
        bytes: usize,
        /// What it may take.
        most: usize,
    },
    /// Near a t the warp jumps, or is solved too inexactly.
    #[error("the motion does not settle near t = {t:.3}; frames are solved instead")]
    Unsettled {
        /// Where.
        t: f64,
    },
    /// Nobody wants it any more.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A film as it was recorded.
pub(super) struct RecordedIntervals {
    pub moving: MovingChannels,
    pub reels: Vec<RecordingInterval>,
    /// As a share of the diameter.
    pub error: f64,
    pub solves: usize,
}

/// Where what moves is, in blocks; channel after channel.
type PositionBlocks = Vec<BlockRow>;

pub(super) fn record(
    warp: &dyn Warp,
    options: &RecordingOptions,
    progress: &dyn Progress,
) -> Result<RecordedIntervals, RecordingError> {
    checkpoint(progress, "recording", 0.0)?;
    let mut breaks = warp.breaks();
    breaks.retain(|t| (SAME..=1.0 - SAME).contains(t));
    breaks.push(1.0);
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|b, a| *b - *a < SAME);
    let mut recorder = WarpRecorder::new(warp, &breaks, options, progress);
    let mut from = (0.0, recorder.at(0.0));
    for t in breaks {
        let to = (t, recorder.at(t));
        recorder.span(from, to.clone())?;
        from = to;
    }
    Ok(RecordedIntervals {
        moving: recorder.moving,
        error: recorder.error / recorder.diameter,
        solves: recorder.solves,
        reels: recorder.reels,
    })
}

struct WarpRecorder<'a> {
    /// Two, since nodes come in pairs.
    placers: [Placer; 2],
    moving: MovingChannels,
    options: &'a RecordingOptions,
    progress: &'a dyn Progress,
    diameter: f64,
    reels: Vec<RecordingInterval>,
    /// In units of the plane.
    error: f64,
    solves: usize,
}

impl<'a> WarpRecorder<'a> {
    fn new(
        warp: &dyn Warp,
        breaks: &[f64],
        options: &'a RecordingOptions,
        progress: &'a dyn Progress,
    ) -> Self {
        let mut placer = warp.placer();
        let mut at = |t: f64| {
            placer.place(t);
            placer.placement().clone()
        };
        let ends = [0.0, 1.0].map(&mut at);
        let mut moving = MovingChannels::default().with_changes(&ends[0], &ends[1]);
        let mut from = 0.0;
        for to in breaks {
            moving = moving.with_changes(&ends[0], &at(from + WITHIN * (to - from)));
            from = *to;
        }
        let ends = moving.channels().flat_map(|channel| {
            let ends = ends.iter();
            ends.flat_map(move |placement| channel.of(placement).iter().copied())
        });
        // Of what does not move any size will do.
        let diameter = Bounds::of(ends).map_or(1.0, |bounds| bounds.diameter());
        Self {
            placers: [placer, warp.placer()],
            moving,
            options,
            progress,
            diameter: if diameter > 0.0 { diameter } else { 1.0 },
            reels: Vec::new(),
            error: 0.0,
            solves: breaks.len(),
        }
    }

    fn tolerance(&self) -> f64 {
        self.options.tolerance * self.diameter
    }

    fn at(&mut self, t: f64) -> PositionBlocks {
        // The ends of a film are the designs, which nothing is solved for.
        self.solves += usize::from(t > 0.0 && t < 1.0);
        places(&mut self.placers[0], self.moving, t)
    }

    /// At a pair of times, at once.
    fn at_both(&mut self, t: [f64; 2]) -> [PositionBlocks; 2] {
        self.solves += 2;
        let moving = self.moving;
        let [a, b] = &mut self.placers;
        let (a, b) = rayon::join(|| places(a, moving, t[0]), || places(b, moving, t[1]));
        [a, b]
    }

    /// Records what is between two times.
    fn span(
        &mut self,
        from: (f64, PositionBlocks),
        to: (f64, PositionBlocks),
    ) -> Result<(), RecordingError> {
        let time = |s: f64| from.0 + s * (to.0 - from.0);
        let ends = [&from.1, &to.1];
        let middle = self.at(time(0.5));
        let mut seen = vec![deviation(middle.clone(), ends, 0.5)];
        let mut before = f64::INFINITY;
        while seen.len() + 2 <= MAX_NODES {
            let share = seen.len() as f64 / MAX_NODES as f64;
            checkpoint(self.progress, "recording", time(share))?;
            self.allow(ends[0].len() * (4 + seen.len()) * size_of::<BlockRow>())?;
            let pair = [nodes()[seen.len()], nodes()[seen.len() + 1]];
            let found = self.at_both(pair.map(time));
            let known = seen.len();
            let mut off: f64 = 0.0;
            for (s, places) in pair.into_iter().zip(found) {
                let found = deviation(places, ends, s);
                // By those before the pair: both are fresh.
                off = off.max(residual(&seen[..known], &found, s));
                seen.push(found);
            }
            if off <= self.tolerance() {
                self.keep([from.0, to.0], ends, &seen, off)?;
                return Ok(());
            }
            if seen.len() >= FORESEEN && !will_do(seen.len(), off, before, self.tolerance()) {
                break;
            }
            before = off;
        }
        drop(seen);
        let at_middle = time(0.5);
        if to.0 - from.0 <= SHORTEST {
            return Err(RecordingError::Unsettled { t: at_middle });
        }
        self.span(from, (at_middle, middle.clone()))?;
        self.span((at_middle, middle), to)
    }

    /// Whether so many bytes more than the reels so far are allowed.
    fn allow(&self, more: usize) -> Result<(), RecordingError> {
        let bytes = more
            + self
                .reels
                .iter()
                .map(RecordingInterval::bytes)
                .sum::<usize>();
        let most = self.options.most_bytes;
        if bytes > most {
            return Err(RecordingError::TooLarge { bytes, most });
        }
        Ok(())
    }

    /// Keeps the polynomial through what was seen.
    fn keep(
        &mut self,
        times: [f64; 2],
        ends: [&PositionBlocks; 2],
        seen: &[PositionBlocks],
        off: f64,
    ) -> Result<(), RecordingError> {
        still_wanted(self.progress)?;
        let coefficients = coefficients(seen);
        let n = seen.len();
        let largest = largest(&coefficients, n);
        // From the last one on, as long as all that is left out is little enough.
        let mut left_out = 0.0;
        let mut kept = n;
        while kept > 0 && left_out + largest[kept - 1] <= LEFT_OUT * self.tolerance() {
            kept -= 1;
            left_out += largest[kept];
        }
        let half_a_bit = f64::from(f32::EPSILON) / 2.0;
        let (mut rounded, mut in_full) = (0.0, kept);
        while in_full > 0
            && rounded + half_a_bit * largest[in_full - 1] <= ROUNDED * self.tolerance()
        {
            in_full -= 1;
            rounded += half_a_bit * largest[in_full];
        }
        let blocks = ends[0].len();
        let row = size_of::<BlockRow>();
        self.allow(blocks * (row * (2 + in_full) + row / 2 * (kept - in_full)))?;
        let coefficients: Vec<BlockRow> = coefficients
            .chunks(n)
            .flat_map(|of_block| &of_block[..kept])
            .copied()
            .collect();
        let reel = RecordingInterval::new(times, ends.map(Vec::as_slice), &coefficients, in_full);
        self.reels.push(reel);
        self.error = self.error.max(off + left_out + rounded);
        Ok(())
    }
}

/// Whether an interval of which so many nodes are known settles before it has as many
/// as it may, if what is off goes on shrinking at least as it did.
fn will_do(known: usize, off: f64, before: f64, tolerance: f64) -> bool {
    let shrinks = off / before;
    if shrinks >= 1.0 {
        return false;
    }
    let pairs = (tolerance / off).ln() / shrinks.ln();
    // It shrinks the faster the longer it goes on.
    known as f64 + pairs <= MAX_NODES as f64
}

/// Where what moves is at a time.
fn places(placer: &mut Placer, moving: MovingChannels, t: f64) -> PositionBlocks {
    placer.place(t);
    let placement = placer.placement();
    let mut places = Vec::new();
    for channel in moving.channels() {
        let points = channel.of(placement);
        places.reserve_exact(block_count(points.len()));
        for block in points.chunks(BLOCK) {
            let mut row = [0.0; 2 * BLOCK];
            for (xy, point) in row.chunks_mut(2).zip(block) {
                xy.copy_from_slice(&point.to_array());
            }
            places.push(row);
        }
    }
    places
}

/// How far places are from the straight line between the ends.
fn deviation(
    mut places: PositionBlocks,
    [begin, end]: [&PositionBlocks; 2],
    s: f64,
) -> PositionBlocks {
    let ends = begin.par_iter().zip(end);
    places.par_iter_mut().zip(ends).for_each(|(row, (b, e))| {
        for (x, (b, e)) in row.iter_mut().zip(b.iter().zip(e)) {
            *x -= b * (1.0 - s) + e * s;
        }
    });
    places
}

/// How far the polynomial through what was seen is from what was found at `s`.
fn residual(seen: &[PositionBlocks], found: &PositionBlocks, s: f64) -> f64 {
    let weights = weights(seen.len(), s);
    let off = |block: usize| {
        let mut off = found[block];
        for (weight, seen) in weights.iter().zip(seen) {
            for (x, y) in off.iter_mut().zip(&seen[block]) {
                *x -= weight * y;
            }
        }
        farthest(&off)
    };
    (0..found.len())
        .into_par_iter()
        .map(off)
        .reduce(|| 0.0, f64::max)
}

/// The length of the longest vector of a row; without a bound where it is no number.
fn farthest(row: &BlockRow) -> f64 {
    let most = row.chunks(2).map(|xy| xy[0] * xy[0] + xy[1] * xy[1]);
    let finite = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    most.map(finite).fold(0.0, f64::max).sqrt()
}

/// The coefficients of the polynomials through what was seen, block by block.
fn coefficients(seen: &[PositionBlocks]) -> Vec<BlockRow> {
    let n = seen.len();
    let rows = coefficients_from_values(n);
    let blocks = seen[0].len();
    let mut coefficients = vec![[0.0; 2 * BLOCK]; n * blocks];
    let of_blocks = coefficients.par_chunks_mut(n).enumerate();
    of_blocks.for_each(|(block, of_block)| {
        for (sum, row) in of_block.iter_mut().zip(&rows) {
            for (weight, seen) in row.iter().zip(seen) {
                for (sum, x) in sum.iter_mut().zip(&seen[block]) {
                    *sum += weight * x;
                }
            }
        }
    });
    coefficients
}

/// For each coefficient the longest vector of any vertex.
fn largest(coefficients: &[BlockRow], n: usize) -> Vec<f64> {
    let none = || vec![0.0_f64; n];
    let of_blocks = coefficients.par_chunks(n.max(1));
    of_blocks
        .fold(none, |mut largest, of_block| {
            for (most, row) in largest.iter_mut().zip(of_block) {
                *most = most.max(farthest(row));
            }
            largest
        })
        .reduce(none, |a, b| {
            a.iter().zip(&b).map(|(a, b)| a.max(*b)).collect()
        })
}
