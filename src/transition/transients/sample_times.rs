//! Times at which a film is looked at where it matters what meets what.
//!
//! Evenly, and closer together near both ends: there what is born lies next to what it
//! comes from, and what dies beside what it goes to. By even steps alone 43 of 60 pairs of
//! icons were proved not to cross, instead of 46. More can be put where a film turned out
//! to need them.

/// Even steps of the film, and how many of them at each end are divided in how many.
const EVEN: u32 = 64;
const DIVIDED: u32 = 2;
const PARTS: u32 = 4;

/// The first and the last of those, each divided in as many once more. What comes or goes
/// at once takes so long, and is looked at while it does.
pub(in crate::transition) const FINE_STEP: f64 = 1.0 / (EVEN * PARTS) as f64;

/// Times that are added are multiples of this, which a film run backwards has as well.
const GRAIN: f64 = 1.0 / 65_536.0;

/// Times from 0 to 1, both included, each later than the one before.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::transition) struct SampleTimes(Vec<f64>);

impl Default for SampleTimes {
    fn default() -> Self {
        let even = (0..=EVEN).map(|k| f64::from(k) / f64::from(EVEN));
        let last = (0..PARTS).map(|k| f64::from(k) * FINE_STEP / f64::from(PARTS));
        let near = (0..DIVIDED * PARTS)
            .map(|k| f64::from(k) * FINE_STEP)
            .chain(last);
        let mut times: Vec<f64> = even.chain(near.flat_map(|t| [t, 1.0 - t])).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        Self(times)
    }
}

impl SampleTimes {
    pub(in crate::transition) fn times(&self) -> &[f64] {
        &self.0
    }

    /// The number of the last step, at t = 1.
    pub(in crate::transition) fn last(&self) -> usize {
        self.0.len() - 1
    }

    /// The last step that is not after a time in [0, 1].
    pub(in crate::transition) fn before(&self, t: f64) -> usize {
        self.0.partition_point(|&time| time <= t).max(1) - 1
    }

    /// How much of the film is nearer to a step than to the others.
    pub(in crate::transition) fn long(&self, step: usize) -> f64 {
        let [before, after] = [step.saturating_sub(1), (step + 1).min(self.last())];
        (self.0[after] - self.0[before]) / 2.0
    }

    /// Adds a step at a time within the film, and halfway to those about it.
    pub(in crate::transition) fn look_at(&mut self, t: f64) {
        let before = self.before(t).min(self.last() - 1);
        let about = [self.0[before], self.0[before + 1]];
        let added = about.map(|end| end.midpoint(t)).into_iter().chain([t]);
        self.0.extend(added.map(|t| (t / GRAIN).round() * GRAIN));
        self.0.sort_by(f64::total_cmp);
        self.0.dedup();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_run_from_end_to_end_and_back_alike() {
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
        // What lives change at.
        assert!(
            (0..=8)
                .map(|k| f64::from(k) / 8.0)
                .all(|t| times[steps.before(t)] == t)
        );
    }

    #[test]
    fn more_are_added_alike_from_either_end() {
        let [mut forwards, mut backwards] = [SampleTimes::default(), SampleTimes::default()];
        for t in [0.3, 0.0, 1.0, 0.999_999_999] {
            forwards.look_at(t);
            // As a film run backwards is told, to rounding.
            backwards.look_at(1.0 - t + 1e-12);
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
