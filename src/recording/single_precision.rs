//! Time intervals of a recording in single precision, laid out for evaluation on a graphics card.
//!
//! The position of a vertex is `near end + share · (other end − near end) + Σ weight ·
//! coefficient`, relative to a common origin. The sum Σ runs over the coefficients of the vertex's
//! polynomial; their weights depend on t. The near end is the end of the interval to which t is
//! closer, and `share` is the fraction of the interval between the near end and t. Both ends are
//! therefore exact, and vertices that do not move do not jitter.
//!
//! Guaranteed: at both ends of an interval, positions are exact to single precision. Not
//! guaranteed: any better precision in between; coefficients that have no effect in single
//! precision are omitted.

use super::interval::{BLOCK, RecordingInterval, block_count};
use super::nodes::{MAX_NODES, basis};
use super::{Recording, RecordingData};
use crate::geometry::DVec2;

/// Relative rounding error of a single-precision number: half a unit in the last place of 1.
const RELATIVE_ROUNDING: f64 = f32::EPSILON as f64 / 2.0;

/// One time interval of a recording in single precision.
#[derive(Clone, Debug)]
pub(crate) struct SinglePrecisionInterval {
    /// Number of entries in a row: the number of vertices, rounded up to whole blocks.
    pub vertices: usize,
    /// Number of polynomial coefficients of each vertex; each is a row of `numbers`.
    pub coefficients: usize,
    /// x and y of each vertex, row after row: first the positions at both ends of the interval,
    /// then the polynomial coefficients.
    pub numbers: Vec<[f32; 2]>,
}

/// Weights of the rows of an interval at one t. A row contains one vector for each vertex; the
/// position of a vertex at t is the sum of its vectors, each multiplied by the weight of its row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct IntervalWeights {
    /// Fractions of the interval before t and after t; their sum is 1. The first one is the weight
    /// of the position at the end of the interval, the second one that of the position at its
    /// beginning.
    pub shares: [f32; 2],
    /// Weight of each row of polynomial coefficients.
    pub coefficients: [f32; MAX_NODES],
}

impl Recording {
    /// Returns the time intervals in single precision, in order; an empty iterator if no vertex
    /// moves in the frame. `vertices` is the number of vertices in a placement of the warp.
    /// Positions are stored relative to `origin`.
    pub(crate) fn single_precision_intervals(
        &self,
        vertices: usize,
        origin: DVec2,
    ) -> impl Iterator<Item = SinglePrecisionInterval> + use<> {
        let recording = self.clone();
        let count = if recording.0.channels.in_frame {
            recording.0.intervals.len()
        } else {
            0
        };
        (0..count).map(move |interval| recording.0.convert_interval(interval, vertices, origin))
    }

    /// Returns the index of the time interval that contains `t`, and the weights with which the
    /// rows of this interval are summed at `t`; `None` outside [0, 1].
    pub(crate) fn weights(&self, t: f64) -> Option<(usize, IntervalWeights)> {
        let is_within = (0.0..=1.0).contains(&t);
        is_within.then(|| {
            let k = self.0.interval_at(t);
            (k, weights(&self.0.intervals[k], t))
        })
    }
}

impl RecordingData {
    /// Converts the time interval with the index `interval` to single precision, with positions
    /// relative to `origin`.
    fn convert_interval(
        &self,
        interval: usize,
        vertices: usize,
        origin: DVec2,
    ) -> SinglePrecisionInterval {
        let interval = &self.intervals[interval];
        let coefficients = visible_coefficients(interval, vertices, origin);
        let blocks = block_count(vertices);
        let vertices = blocks * BLOCK;
        let mut numbers = Vec::with_capacity(vertices * (2 + coefficients));
        for k in 0..2 + coefficients {
            // Positions are relative to the origin. Polynomial coefficients describe deviations,
            // which the origin does not affect.
            let from = if k < 2 { origin } else { DVec2::ZERO };
            numbers.extend((0..blocks).flat_map(|block| {
                let row = interval.row(block, k);
                let vertex = |at: usize| DVec2::new(row[2 * at], row[2 * at + 1]) - from;
                std::array::from_fn::<_, BLOCK, _>(|at| vertex(at).as_vec2().to_array())
            }));
        }
        SinglePrecisionInterval {
            vertices,
            coefficients,
            numbers,
        }
    }
}

/// Returns the weights of the rows of an interval at `t`.
fn weights(interval: &RecordingInterval, t: f64) -> IntervalWeights {
    let s = interval.fraction(t);
    IntervalWeights {
        shares: [s as f32, (1.0 - s) as f32],
        coefficients: basis(interval.coefficient_count(), s).map(|weight| weight as f32),
    }
}

/// Returns the number of polynomial coefficients to keep. The omitted ones together change a
/// position by no more than the rounding of positions to single precision.
fn visible_coefficients(interval: &RecordingInterval, vertices: usize, origin: DVec2) -> usize {
    let longest = |k: usize, from: DVec2| {
        let rows = (0..block_count(vertices)).flat_map(|block| interval.row(block, k));
        let numbers = rows
            .take(2 * vertices)
            .zip([from.x, from.y].into_iter().cycle());
        numbers
            .map(|(x, from)| (x - from).abs())
            .fold(0.0, f64::max)
    };
    let rounding = RELATIVE_ROUNDING * longest(0, origin).max(longest(1, origin));
    let mut omitted = 0.0;
    let mut count = interval.coefficient_count();
    while count > 0 {
        omitted += longest(1 + count, DVec2::ZERO);
        if omitted > rounding {
            break;
        }
        count -= 1;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::RecordingOptions;
    use crate::warp::{Placement, Placer, Warp};
    use crate::work::progress::Silent;
    use std::sync::Arc;

    /// Two strips of points. The first one turns, much faster after t = [`BREAK`]; the second does
    /// not move.
    #[derive(Debug)]
    struct TurningStrips(DVec2);

    /// The t at which the turning strip accelerates.
    const BREAK: f64 = 0.3;
    /// Number of points in a strip.
    const POINTS: usize = 11;

    impl TurningStrips {
        fn at(&self, t: f64) -> Vec<DVec2> {
            let angle = 0.2 * t + 4.0 * (t - BREAK).max(0.0);
            let strip = |turn: DVec2, y: f64| {
                let along = (0..POINTS).map(move |k| DVec2::new(k as f64 / 7.0, y));
                along.map(move |p| self.0 + turn.rotate(p))
            };
            let turning = strip(DVec2::from_angle(angle), 0.3);
            turning.chain(strip(DVec2::X, -1.1)).collect()
        }
    }

    impl Warp for TurningStrips {
        fn placer(&self) -> Placer {
            let [source, target] = [0.0, 1.0].map(|t| self.at(t));
            let placement = Placement::of_source(Arc::from([]), &source, &target);
            let warp = Self(self.0);
            Placer::new(placement, move |t, placement| {
                placement.in_frame = warp.at(t)
            })
        }

        fn break_times(&self) -> Vec<f64> {
            vec![BREAK]
        }
    }

    fn recorded_strips(middle: DVec2) -> Recording {
        let recording = Recording::record(
            Arc::new(TurningStrips(middle)),
            &RecordingOptions::default(),
            &Silent,
        );
        recording.expect("a recording")
    }

    /// Evaluates the position of a vertex in the same way as the graphics card.
    fn place(
        single: &SinglePrecisionInterval,
        weights: &IntervalWeights,
        vertex: usize,
    ) -> [f32; 2] {
        let row = |k: usize| single.numbers[k * single.vertices + vertex];
        let [s, rest] = weights.shares;
        std::array::from_fn(|xy| {
            let [from, to] = [row(0)[xy], row(1)[xy]];
            let straight = if s < rest {
                from + s * (to - from)
            } else {
                to - rest * (to - from)
            };
            let terms = (0..single.coefficients).map(|k| weights.coefficients[k] * row(2 + k)[xy]);
            straight + terms.sum::<f32>()
        })
    }

    #[test]
    fn the_sum_matches_the_recording_to_single_precision_far_from_zero() {
        for middle in [DVec2::ZERO, DVec2::new(1e5, -3e4)] {
            let (recording, vertices) = (recorded_strips(middle), 2 * POINTS);
            let singles: Vec<SinglePrecisionInterval> = recording
                .single_precision_intervals(vertices, middle)
                .collect();
            assert!(singles.len() == recording.interval_count() && singles.len() > 1);
            // Some polynomial coefficients are too small for single precision and are omitted.
            let known = recording
                .0
                .intervals
                .iter()
                .map(RecordingInterval::coefficient_count);
            let fewer = singles
                .iter()
                .zip(known)
                .filter(|(s, n)| s.coefficients < *n);
            assert!(fewer.count() > 0);
            let mut placer = recording.placer();
            for k in 0..=100 {
                let t = f64::from(k) / 100.0;
                placer.place(t);
                let (interval, weights) = recording.weights(t).expect("within");
                let places = placer.placement().in_frame.iter().enumerate();
                for (vertex, expected) in places {
                    let found =
                        DVec2::from(place(&singles[interval], &weights, vertex).map(f64::from));
                    let off = found.distance(*expected - middle);
                    assert!(off < 1e-6, "{off} at {t}");
                }
            }
        }
    }

    #[test]
    fn ends_are_exact_and_resting_points_do_not_jitter() {
        let (recording, vertices) = (recorded_strips(DVec2::ZERO), 2 * POINTS);
        let singles: Vec<SinglePrecisionInterval> = recording
            .single_precision_intervals(vertices, DVec2::ZERO)
            .collect();
        let single = |p: &DVec2| p.as_vec2().to_array();
        let all = |t: f64| -> Vec<[f32; 2]> {
            let (interval, weights) = recording.weights(t).expect("within");
            let places = (0..vertices).map(|vertex| place(&singles[interval], &weights, vertex));
            places.collect()
        };
        for t in [0.0, BREAK, 1.0] {
            let expected: Vec<[f32; 2]> = TurningStrips(DVec2::ZERO)
                .at(t)
                .iter()
                .map(single)
                .collect();
            assert_eq!(all(t), expected, "{t}");
        }
        for k in 0..1000 {
            let t = f64::from(k) / 999.0;
            assert_eq!(all(t)[POINTS..], all(0.0)[POINTS..], "{t}");
        }
    }

    #[test]
    fn weights_exist_only_within_the_interval() {
        let recording = recorded_strips(DVec2::ZERO);
        for t in [-0.1, 1.1, f64::NAN] {
            assert_eq!(recording.weights(t), None);
        }
    }
}
