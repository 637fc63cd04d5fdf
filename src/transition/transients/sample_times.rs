//! The times at which the motion is sampled to detect collisions.
//!
//! The times divide [0, 1] into equal steps. The steps near t = 0 and t = 1 are subdivided, because
//! parts that appear or disappear there are still close to other parts. More times can be added
//! where a motion turns out to need them.

/// Number of equal steps before subdivision (resource limit).
const EVEN_STEPS: u32 = 64;
/// Number of equal steps after t = 0, and also before t = 1, that are subdivided (heuristic).
const SUBDIVIDED_STEPS: u32 = 2;
/// Number of equal intervals into which each of the steps near t = 0 and t = 1 is subdivided
/// (heuristic).
const SUBDIVISION: u32 = 4;

/// Length, in units of t, of the intervals into which the steps near t = 0 and t = 1 are
/// subdivided. The first and the last of these intervals are subdivided once more. A part that
/// collides in all longer time windows appears or disappears within this length of t.
pub(in crate::transition) const FINE_STEP: f64 = 1.0 / (EVEN_STEPS * SUBDIVISION) as f64;

/// Added times are rounded to multiples of this, so that the reversed motion has the same times
/// (tolerance: far shorter than a step).
const GRAIN: f64 = 1.0 / 65_536.0;

/// Strictly increasing times from 0 to 1, both included.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::transition) struct SampleTimes(Vec<f64>);

impl Default for SampleTimes {
    fn default() -> Self {
        let even = (0..=EVEN_STEPS).map(|k| f64::from(k) / f64::from(EVEN_STEPS));
        let last = (0..SUBDIVISION).map(|k| f64::from(k) * FINE_STEP / f64::from(SUBDIVISION));
        let near = (0..SUBDIVIDED_STEPS * SUBDIVISION)
            .map(|k| f64::from(k) * FINE_STEP)
            .chain(last);
        let mut times: Vec<f64> = even.chain(near.flat_map(|t| [t, 1.0 - t])).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        Self(times)
    }
}

impl SampleTimes {
    /// Returns the times.
    pub(in crate::transition) fn times(&self) -> &[f64] {
        &self.0
    }

    /// Returns the index of the last time, t = 1.
    pub(in crate::transition) fn last(&self) -> usize {
        self.0.len() - 1
    }

    /// Returns the index of the last time not after `t`, for `t` in [0, 1].
    pub(in crate::transition) fn before(&self, t: f64) -> usize {
        self.0.partition_point(|&time| time <= t).max(1) - 1
    }

    /// Returns the length of the interval of t in which the sample time with index `step` is the
    /// nearest one.
    pub(in crate::transition) fn weight(&self, step: usize) -> f64 {
        let [before, after] = [step.saturating_sub(1), (step + 1).min(self.last())];
        (self.0[after] - self.0[before]) / 2.0
    }

    /// Adds a time, and the midpoints between it and its neighbours.
    pub(in crate::transition) fn refine_at(&mut self, t: f64) {
        let before = self.before(t).min(self.last() - 1);
        let neighbours = [self.0[before], self.0[before + 1]];
        let added = neighbours.map(|end| end.midpoint(t)).into_iter().chain([t]);
        self.0.extend(added.map(|t| (t / GRAIN).round() * GRAIN));
        self.0.sort_by(f64::total_cmp);
        self.0.dedup();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_run_from_0_to_1_and_are_symmetric() {
        let steps = SampleTimes::default();
        let times = steps.times();
        assert_eq!([times[0], times[steps.last()]], [0.0, 1.0]);
        for (step, pair) in times.windows(2).enumerate() {
            let long = pair[1] - pair[0];
            let all = [64, 256, 1024].map(|parts| 1.0 / f64::from(parts));
            assert!(all.contains(&long), "{step}: {long}");
            assert_eq!(pair[0], 1.0 - times[steps.last() - step]);
            assert_eq!(steps.before(pair[0] + 1e-6), step);
        }
        // Time windows begin and end at multiples of 1/8, so these must be sample times.
        assert!(
            (0..=8)
                .map(|k| f64::from(k) / 8.0)
                .all(|t| times[steps.before(t)] == t)
        );
    }

    #[test]
    fn added_times_are_symmetric() {
        let [mut forwards, mut backwards] = [SampleTimes::default(), SampleTimes::default()];
        for t in [0.3, 0.0, 1.0, 0.999_999_999] {
            forwards.refine_at(t);
            // The reversed motion reports this time, up to rounding.
            backwards.refine_at(1.0 - t + 1e-12);
        }
        let mirrored: Vec<f64> = backwards.times().iter().map(|t| 1.0 - t).rev().collect();
        assert_eq!(forwards.times(), mirrored);
        assert!(forwards.times().windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(
            [forwards.times()[0], forwards.times()[forwards.last()]],
            [0.0, 1.0]
        );
        assert!((forwards.times()[forwards.before(0.3 + GRAIN)] - 0.3).abs() < GRAIN);
    }
}
