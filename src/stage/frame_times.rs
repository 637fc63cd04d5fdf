//! How long a frame takes, by stage.
//!
//! Guarantees: recording neither allocates nor blocks. Does not guarantee to
//! see the GPU: `draw` is the processor's share, writing vertices and uniforms.

use std::time::Duration;

use bevy::prelude::*;

/// How many frames a median looks back.
pub const REMEMBERED: usize = 120;

/// The last [`REMEMBERED`] durations of one stage of the frame.
///
/// ```
/// use std::time::Duration;
/// use morphospace::stage::Durations;
///
/// let mut durations = Durations::default();
/// assert_eq!(durations.median(), None);
/// for ms in [9, 1, 2] {
///     durations.record(Duration::from_millis(ms));
/// }
/// assert_eq!(durations.median(), Some(Duration::from_millis(2)));
/// ```
#[derive(Clone, Debug, Reflect)]
#[reflect(Clone, Debug, Default)]
pub struct StageTimes {
    ring: [Duration; REMEMBERED],
    recorded: usize,
}

impl Default for StageTimes {
    fn default() -> Self {
        Self {
            ring: [Duration::ZERO; REMEMBERED],
            recorded: 0,
        }
    }
}

impl StageTimes {
    /// Remembers one more duration and forgets the oldest.
    pub fn record(&mut self, duration: Duration) {
        self.ring[self.recorded % REMEMBERED] = duration;
        self.recorded += 1;
    }

    /// The median of the remembered durations (the lower one of an even
    /// count), `None` before the first.
    pub fn median(&self) -> Option<Duration> {
        // A copy of 2 kB on the stack, so that nothing is allocated.
        let mut sorted = self.ring;
        let known = &mut sorted[..self.recorded.min(REMEMBERED)];
        known.sort_unstable();
        known.get(known.len().checked_sub(1)? / 2).copied()
    }
}

/// How long the stage's work took in the last frames that had any.
#[derive(Resource, Clone, Debug, Default, Reflect)]
#[reflect(Resource, Clone, Debug, Default)]
pub struct FrameTimes {
    /// Placing all vertices: right-hand sides, back-substitution, placement.
    pub solve: StageTimes,
    /// Writing render meshes and uniforms.
    pub draw: StageTimes,
    /// What was drawn last the graphics card sums: it is neither solved nor written.
    pub is_played: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_forgets_what_is_long_past() {
        let mut durations = StageTimes::default();
        for _ in 0..REMEMBERED {
            durations.record(Duration::from_secs(9));
        }
        for _ in 0..REMEMBERED {
            durations.record(Duration::from_millis(3));
        }
        assert_eq!(durations.median(), Some(Duration::from_millis(3)));
    }

    #[test]
    fn the_median_of_an_even_count_is_the_lower_one() {
        let mut durations = StageTimes::default();
        for ms in [4, 1, 3, 2] {
            durations.record(Duration::from_millis(ms));
        }
        assert_eq!(durations.median(), Some(Duration::from_millis(2)));
    }
}
