//! A film in single precision, laid out for who sums it elsewhere: a graphics card.
//!
//! A vertex is at `near end + share · way to the other end + Σ weight · coefficient`,
//! all relative to an origin in the midst of them. Which end is the near one depends on
//! t alone, so that both ends are met exactly, and what rests does not tremble.
//!
//! Guaranteed: at both ends of a reel a vertex is where single precision has it. Not
//! guaranteed: more than that in between; coefficients that it does not show are left
//! out.

use super::interval::{BLOCK, RecordingInterval, block_count};
use super::nodes::{MAX_NODES, basis};
use super::{Recording, RecordingData};
use crate::geometry::DVec2;

/// Half a unit in the last place of a number near one.
const HALF_A_BIT: f64 = f32::EPSILON as f64 / 2.0;

/// A reel in single precision.
#[derive(Clone, Debug)]
pub(crate) struct SinglePrecisionInterval {
    /// In a row: as many as there are, or a few more.
    pub vertices: usize,
    pub coefficients: usize,
    /// Row after row: where vertices are at both ends, then their coefficients.
    pub numbers: Vec<[f32; 2]>,
}

/// How the numbers of a reel are summed at a t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct IntervalWeights {
    /// How far it is from the first end, and from the other: together 1.
    pub shares: [f32; 2],
    /// Of each coefficient.
    pub coefficients: [f32; MAX_NODES],
}

impl Recording {
    /// The reels in single precision, one after the other; none where vertices stay
    /// where they are in the frame. So many vertices has a placement of the warp.
    pub(crate) fn singles(
        &self,
        vertices: usize,
        origin: DVec2,
    ) -> impl Iterator<Item = SinglePrecisionInterval> + use<> {
        let film = self.clone();
        let count = if film.0.moving.in_frame {
            film.0.reels.len()
        } else {
            0
        };
        (0..count).map(move |reel| film.0.single(reel, vertices, origin))
    }

    /// Which reel shows `t`, and how it is summed there; none outside [0, 1].
    pub(crate) fn weights(&self, t: f64) -> Option<(usize, IntervalWeights)> {
        let is_within = (0.0..=1.0).contains(&t);
        is_within.then(|| {
            let k = self.0.reel_at(t);
            (k, weights(&self.0.reels[k], t))
        })
    }
}

impl RecordingData {
    fn single(&self, reel: usize, vertices: usize, origin: DVec2) -> SinglePrecisionInterval {
        let reel = &self.reels[reel];
        let coefficients = shown(reel, vertices, origin);
        let blocks = block_count(vertices);
        let vertices = blocks * BLOCK;
        let mut numbers = Vec::with_capacity(vertices * (2 + coefficients));
        for k in 0..2 + coefficients {
            // Where vertices are is told from the origin, and how they deviate is not.
            let from = if k < 2 { origin } else { DVec2::ZERO };
            numbers.extend((0..blocks).flat_map(|block| {
                let row = reel.row(block, k);
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

fn weights(reel: &RecordingInterval, t: f64) -> IntervalWeights {
    let s = reel.share(t);
    IntervalWeights {
        shares: [s as f32, (1.0 - s) as f32],
        coefficients: basis(reel.coefficient_count(), s).map(|weight| weight as f32),
    }
}

/// How many coefficients are more together than what single precision rounds.
fn shown(reel: &RecordingInterval, vertices: usize, origin: DVec2) -> usize {
    let longest = |k: usize, from: DVec2| {
        let rows = (0..block_count(vertices)).flat_map(|block| reel.row(block, k));
        let numbers = rows
            .take(2 * vertices)
            .zip([from.x, from.y].into_iter().cycle());
        numbers
            .map(|(x, from)| (x - from).abs())
            .fold(0.0, f64::max)
    };
    let rounded = HALF_A_BIT * longest(0, origin).max(longest(1, origin));
    let mut left_out = 0.0;
    let mut kept = reel.coefficient_count();
    while kept > 0 {
        left_out += longest(1 + kept, DVec2::ZERO);
        if left_out > rounded {
            break;
        }
        kept -= 1;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::RecordingOptions;
    use crate::warp::{Placement, Placer, Warp};
    use crate::work::progress::Silent;
    use std::sync::Arc;

    /// Two strips of points: one turns, by far more after a break; the other rests.
    #[derive(Debug)]
    struct TurningStrips(DVec2);

    const BREAK: f64 = 0.3;
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

        fn breaks(&self) -> Vec<f64> {
            vec![BREAK]
        }
    }

    fn film(middle: DVec2) -> Recording {
        let film = Recording::record(
            Arc::new(TurningStrips(middle)),
            &RecordingOptions::default(),
            &Silent,
        );
        film.expect("a film")
    }

    /// As the graphics card sums them.
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
    fn the_sum_is_the_film_to_single_precision_however_far_from_zero() {
        for middle in [DVec2::ZERO, DVec2::new(1e5, -3e4)] {
            let (film, vertices) = (film(middle), 2 * POINTS);
            let singles: Vec<SinglePrecisionInterval> = film.singles(vertices, middle).collect();
            assert!(singles.len() == film.reel_count() && singles.len() > 1);
            // In single precision there is less to be seen than the film knows.
            let known = film
                .0
                .reels
                .iter()
                .map(RecordingInterval::coefficient_count);
            let fewer = singles
                .iter()
                .zip(known)
                .filter(|(s, n)| s.coefficients < *n);
            assert!(fewer.count() > 0);
            let mut placer = film.placer();
            for k in 0..=100 {
                let t = f64::from(k) / 100.0;
                placer.place(t);
                let (reel, weights) = film.weights(t).expect("within");
                let places = placer.placement().in_frame.iter().enumerate();
                for (vertex, wanted) in places {
                    let found = DVec2::from(place(&singles[reel], &weights, vertex).map(f64::from));
                    let off = found.distance(*wanted - middle);
                    assert!(off < 1e-6, "{off} at {t}");
                }
            }
        }
    }

    #[test]
    fn ends_are_met_and_what_rests_does_not_tremble() {
        let (film, vertices) = (film(DVec2::ZERO), 2 * POINTS);
        let singles: Vec<SinglePrecisionInterval> = film.singles(vertices, DVec2::ZERO).collect();
        let single = |p: &DVec2| p.as_vec2().to_array();
        let all = |t: f64| -> Vec<[f32; 2]> {
            let (reel, weights) = film.weights(t).expect("within");
            let places = (0..vertices).map(|vertex| place(&singles[reel], &weights, vertex));
            places.collect()
        };
        for t in [0.0, BREAK, 1.0] {
            let wanted: Vec<[f32; 2]> = TurningStrips(DVec2::ZERO)
                .at(t)
                .iter()
                .map(single)
                .collect();
            assert_eq!(all(t), wanted, "{t}");
        }
        for k in 0..1000 {
            let t = f64::from(k) / 999.0;
            assert_eq!(all(t)[POINTS..], all(0.0)[POINTS..], "{t}");
        }
    }

    #[test]
    fn there_is_none_outside() {
        let film = film(DVec2::ZERO);
        for t in [-0.1, 1.1, f64::NAN] {
            assert_eq!(film.weights(t), None);
        }
    }
}
