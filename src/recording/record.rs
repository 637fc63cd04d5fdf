//! Recording of a warp: converts its placements at a few times to intervals of polynomials.
//!
//! Within an interval the warp is evaluated at one pair of nodes after another, until the new
//! values agree with the polynomial through the earlier ones. An interval that would need too many
//! nodes is halved. The warp reports the times at which a part starts or stops
//! ([`Warp::break_times`]); no interval extends across such a time.

use super::channels::MovingChannels;
use super::interval::{BLOCK, BlockRow, RecordingInterval, block_count};
use super::nodes::{MAX_NODES, coefficients_from_values, nodes, weights};
use super::options::RecordingOptions;
use crate::geometry::Bounds;
use crate::warp::{Placer, Warp};
use crate::work::progress::{Cancelled, Progress, check_cancelled, checkpoint};
use rayon::prelude::*;

/// Minimum number of nodes for a prediction of how many nodes an interval will need. An interval
/// that would need too many is halved early (heuristic).
const FORECAST_NODES: usize = 9;

/// An interval of at most this length in t is not halved. If it needs too many nodes, the warp is
/// reported as not smooth (tolerance: a thousandth of the transition).
const SHORTEST_INTERVAL: f64 = 1.0 / 1024.0;

/// Break times that differ by less than this are merged (tolerance: the rounding of times that
/// should be equal).
const SAME_TIME: f64 = 1e-12;

/// To detect the channels (position lists) that a warp moves, its placement at t = 0 is compared
/// with its placement at one time between every two break times. This number is the position of
/// that time between the break times, as a fraction of their distance (heuristic: at the golden
/// section, even a motion that returns to its start is hardly ever exactly there).
const PROBE_FRACTION: f64 = 0.381_966;

/// Fraction of the tolerance that may be used up by the rounding of small polynomial coefficients
/// to single precision (heuristic).
const ROUNDING_SHARE: f64 = 0.1;
/// Fraction of the tolerance that may be used up by omitted polynomial coefficients (heuristic).
const OMISSION_SHARE: f64 = 0.1;

/// Reason why a warp could not be recorded.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The recording would exceed its memory limit.
    #[error("the recording would take {bytes} bytes; the limit is {limit}")]
    TooLarge {
        /// Size of the recording in bytes when it was stopped.
        bytes: usize,
        /// Limit in bytes, from the options.
        limit: usize,
    },
    /// The warp jumps near `t`, or its placements are too inexact there.
    #[error("the motion is not smooth near t = {t:.3}; each frame is solved instead")]
    NotSmooth {
        /// The t near which the warp is not smooth.
        t: f64,
    },
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Result of recording a warp.
pub(super) struct RecordedIntervals {
    pub channels: MovingChannels,
    pub intervals: Vec<RecordingInterval>,
    /// Largest measured distance between a vertex in the recording and the same vertex in the warp,
    /// as a fraction of the diameter of the bounding box of all moving vertices at t = 0 and t = 1.
    pub error: f64,
    /// Number of times that the warp was evaluated.
    pub evaluation_count: usize,
}

/// Positions at one t in all channels (position lists) that move, in blocks of vertices, channel
/// after channel.
type PositionBlocks = Vec<BlockRow>;

/// Records a warp over [0, 1].
///
/// # Errors
/// Same as [`Recording::record`](super::Recording::record).
pub(super) fn record(
    warp: &dyn Warp,
    options: &RecordingOptions,
    progress: &dyn Progress,
) -> Result<RecordedIntervals, RecordingError> {
    checkpoint(progress, "recording", 0.0)?;
    let mut breaks = warp.break_times();
    breaks.retain(|t| (SAME_TIME..=1.0 - SAME_TIME).contains(t));
    breaks.push(1.0);
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|b, a| *b - *a < SAME_TIME);
    let mut recorder = WarpRecorder::new(warp, &breaks, options, progress);
    let mut from = (0.0, recorder.at(0.0));
    for t in breaks {
        let to = (t, recorder.at(t));
        recorder.record_interval(from, to.clone())?;
        from = to;
    }
    Ok(RecordedIntervals {
        channels: recorder.moving,
        error: recorder.error / recorder.diameter,
        evaluation_count: recorder.evaluation_count,
        intervals: recorder.intervals,
    })
}

/// Recording in progress, with the intervals recorded so far.
struct WarpRecorder<'a> {
    /// Two placers, so that a pair of nodes is evaluated in parallel.
    placers: [Placer; 2],
    moving: MovingChannels,
    options: &'a RecordingOptions,
    progress: &'a dyn Progress,
    /// Diameter of the bounding box of all moving vertices at t = 0 and t = 1, in units of the
    /// plane; the tolerance is a fraction of it.
    diameter: f64,
    intervals: Vec<RecordingInterval>,
    /// Largest distance so far between a vertex in the recording and the same vertex in the warp,
    /// in units of the plane.
    error: f64,
    evaluation_count: usize,
}

impl<'a> WarpRecorder<'a> {
    /// Prepares a recording: detects which channels (position lists of a placement) the warp moves,
    /// and measures the diameter of the bounding box of all moving vertices at t = 0 and t = 1.
    /// `breaks` contains the break times of the warp in ascending order, followed by 1.
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
            moving = moving.with_changes(&ends[0], &at(from + PROBE_FRACTION * (to - from)));
            from = *to;
        }
        let ends = moving.channels().flat_map(|channel| {
            let ends = ends.iter();
            ends.flat_map(move |placement| channel.of(placement).iter().copied())
        });
        // If nothing moves, any diameter is suitable.
        let diameter = Bounds::of(ends).map_or(1.0, |bounds| bounds.diameter());
        Self {
            placers: [placer, warp.placer()],
            moving,
            options,
            progress,
            diameter: if diameter > 0.0 { diameter } else { 1.0 },
            intervals: Vec::new(),
            error: 0.0,
            evaluation_count: breaks.len(),
        }
    }

    /// Returns the tolerance in units of the plane.
    fn tolerance(&self) -> f64 {
        self.options.tolerance * self.diameter
    }

    /// Returns the positions at `t` in all channels (position lists) that move.
    fn at(&mut self, t: f64) -> PositionBlocks {
        // At t = 0 and t = 1 the warp returns the designs themselves; nothing is computed there.
        self.evaluation_count += usize::from(t > 0.0 && t < 1.0);
        places(&mut self.placers[0], self.moving, t)
    }

    /// Returns the positions at two times in all channels (position lists) that move. The two times
    /// are evaluated in parallel.
    fn at_pair(&mut self, t: [f64; 2]) -> [PositionBlocks; 2] {
        self.evaluation_count += 2;
        let moving = self.moving;
        let [a, b] = &mut self.placers;
        let (a, b) = rayon::join(|| places(a, moving, t[0]), || places(b, moving, t[1]));
        [a, b]
    }

    /// Records the interval between two times. Each time is given with the positions of all
    /// vertices at that time. An interval that would need too many nodes is halved.
    ///
    /// # Errors
    /// [`RecordingError`] if the warp is not smooth, if the recording exceeds the memory limit, or
    /// if the work is cancelled.
    fn record_interval(
        &mut self,
        from: (f64, PositionBlocks),
        to: (f64, PositionBlocks),
    ) -> Result<(), RecordingError> {
        let time = |s: f64| from.0 + s * (to.0 - from.0);
        let ends = [&from.1, &to.1];
        let middle_positions = self.at(time(0.5));
        let mut samples = vec![deviation(middle_positions.clone(), ends, 0.5)];
        let mut previous_off = f64::INFINITY;
        while samples.len() + 2 <= MAX_NODES {
            let fraction = samples.len() as f64 / MAX_NODES as f64;
            checkpoint(self.progress, "recording", time(fraction))?;
            self.allow(ends[0].len() * (4 + samples.len()) * size_of::<BlockRow>())?;
            let pair = [nodes()[samples.len()], nodes()[samples.len() + 1]];
            let pair_positions = self.at_pair(pair.map(time));
            let node_count = samples.len();
            let mut off: f64 = 0.0;
            for (s, positions) in pair.into_iter().zip(pair_positions) {
                let sample = deviation(positions, ends, s);
                // Both nodes of the pair test the polynomial through the nodes before the pair.
                off = off.max(residual(&samples[..node_count], &sample, s));
                samples.push(sample);
            }
            if off <= self.tolerance() {
                self.store([from.0, to.0], ends, &samples, off)?;
                return Ok(());
            }
            if samples.len() >= FORECAST_NODES
                && !will_converge(samples.len(), off, previous_off, self.tolerance())
            {
                break;
            }
            previous_off = off;
        }
        drop(samples);
        let at_middle = time(0.5);
        if to.0 - from.0 <= SHORTEST_INTERVAL {
            return Err(RecordingError::NotSmooth { t: at_middle });
        }
        self.record_interval(from, (at_middle, middle_positions.clone()))?;
        self.record_interval((at_middle, middle_positions), to)
    }

    /// Checks that `extra` bytes and the intervals recorded so far together fit into the memory
    /// limit.
    ///
    /// # Errors
    /// [`RecordingError::TooLarge`] if they do not.
    fn allow(&self, extra: usize) -> Result<(), RecordingError> {
        let bytes = extra
            + self
                .intervals
                .iter()
                .map(RecordingInterval::bytes)
                .sum::<usize>();
        let limit = self.options.max_bytes;
        if bytes > limit {
            return Err(RecordingError::TooLarge { bytes, limit });
        }
        Ok(())
    }

    /// Stores as an interval the polynomials through `samples`, the deviations from the straight
    /// line at the first nodes. Trailing coefficients of the polynomials that are small enough are
    /// omitted. Of the coefficients that remain, the small ones at the end are stored in single
    /// precision, the others in double precision. `off` is the measured error of the polynomials.
    ///
    /// # Errors
    /// [`RecordingError`] if the interval exceeds the memory limit or the work is cancelled.
    fn store(
        &mut self,
        times: [f64; 2],
        ends: [&PositionBlocks; 2],
        samples: &[PositionBlocks],
        off: f64,
    ) -> Result<(), RecordingError> {
        check_cancelled(self.progress)?;
        let coefficients = coefficients(samples);
        let n = samples.len();
        let largest = max_lengths(&coefficients, n);
        // Trailing coefficients are omitted as long as the sum of their largest lengths is within
        // the fraction `OMISSION_SHARE` of the tolerance.
        let mut omitted = 0.0;
        let mut stored = n;
        while stored > 0 && omitted + largest[stored - 1] <= OMISSION_SHARE * self.tolerance() {
            stored -= 1;
            omitted += largest[stored];
        }
        let half_a_bit = f64::from(f32::EPSILON) / 2.0;
        let (mut rounding, mut full) = (0.0, stored);
        while full > 0
            && rounding + half_a_bit * largest[full - 1] <= ROUNDING_SHARE * self.tolerance()
        {
            full -= 1;
            rounding += half_a_bit * largest[full];
        }
        let blocks = ends[0].len();
        let row = size_of::<BlockRow>();
        self.allow(blocks * (row * (2 + full) + row / 2 * (stored - full)))?;
        let coefficients: Vec<BlockRow> = coefficients
            .chunks(n)
            .flat_map(|of_block| &of_block[..stored])
            .copied()
            .collect();
        let interval = RecordingInterval::new(times, ends.map(Vec::as_slice), &coefficients, full);
        self.intervals.push(interval);
        self.error = self.error.max(off + omitted + rounding);
        Ok(())
    }
}

/// Returns whether an interval with `node_count` nodes is expected to converge within the maximum
/// number of nodes. `off` and `previous_off` are the distances between warp and polynomial at the
/// last two pairs of nodes. The estimate assumes that the distance keeps shrinking by the same
/// factor.
fn will_converge(node_count: usize, off: f64, previous_off: f64, tolerance: f64) -> bool {
    let shrink_factor = off / previous_off;
    if shrink_factor >= 1.0 {
        return false;
    }
    let pairs_needed = (tolerance / off).ln() / shrink_factor.ln();
    // Convergence usually accelerates, so fewer pairs than `pairs_needed` suffice. The estimate
    // therefore adds one node for each pair, although a pair has two nodes.
    node_count as f64 + pairs_needed <= MAX_NODES as f64
}

/// Evaluates a warp at `t`. Packs the positions in all moving channels (position lists) into blocks
/// of [`BLOCK`] vertices.
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

/// Returns the deviation of the positions `places` at `s` from the straight line between the
/// positions at both ends of the interval. `s` is the fraction of the interval that has passed.
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

/// Returns the largest distance between the deviation `measured` at `s` and the polynomial at `s`.
/// The polynomial passes through `samples`, the deviations at the first nodes.
fn residual(samples: &[PositionBlocks], measured: &PositionBlocks, s: f64) -> f64 {
    let weights = weights(samples.len(), s);
    let off = |block: usize| {
        let mut off = measured[block];
        for (weight, sample) in weights.iter().zip(samples) {
            for (x, y) in off.iter_mut().zip(&sample[block]) {
                *x -= weight * y;
            }
        }
        max_length(&off)
    };
    (0..measured.len())
        .into_par_iter()
        .map(off)
        .reduce(|| 0.0, f64::max)
}

/// Returns the length of the longest vector in a row; infinity if a vector contains NaN.
fn max_length(row: &BlockRow) -> f64 {
    let squares = row.chunks(2).map(|xy| xy[0] * xy[0] + xy[1] * xy[1]);
    let finite = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    squares.map(finite).fold(0.0, f64::max).sqrt()
}

/// Returns the coefficients of the polynomials through `samples`, the deviations at the first
/// nodes. They are ordered block by block; each block has one row for each coefficient.
fn coefficients(samples: &[PositionBlocks]) -> Vec<BlockRow> {
    let n = samples.len();
    let rows = coefficients_from_values(n);
    let blocks = samples[0].len();
    let mut coefficients = vec![[0.0; 2 * BLOCK]; n * blocks];
    let of_blocks = coefficients.par_chunks_mut(n).enumerate();
    of_blocks.for_each(|(block, of_block)| {
        for (sum, row) in of_block.iter_mut().zip(&rows) {
            for (weight, sample) in row.iter().zip(samples) {
                for (sum, x) in sum.iter_mut().zip(&sample[block]) {
                    *sum += weight * x;
                }
            }
        }
    });
    coefficients
}

/// Returns, for each of the `n` polynomial coefficients, the length of its longest vector over all
/// vertices.
fn max_lengths(coefficients: &[BlockRow], n: usize) -> Vec<f64> {
    let none = || vec![0.0_f64; n];
    let of_blocks = coefficients.par_chunks(n.max(1));
    of_blocks
        .fold(none, |mut largest, of_block| {
            for (longest, row) in largest.iter_mut().zip(of_block) {
                *longest = longest.max(max_length(row));
            }
            largest
        })
        .reduce(none, |a, b| {
            a.iter().zip(&b).map(|(a, b)| a.max(*b)).collect()
        })
}
