//! Durations of the stages of a frame.
//!
//! Guaranteed: recording neither allocates nor blocks. Not guaranteed: GPU time. `draw` is the time
//! the CPU takes to write vertices and uniforms.

use std::time::Duration;

use bevy::prelude::*;

/// Number of frames that a median covers (heuristic).
pub const HISTORY_LEN: usize = 120;

/// The last [`HISTORY_LEN`] durations of one stage of the frame.
///
/// ```
/// use std::time::Duration;
/// use morphospace::stage::DurationHistory;
///
/// let mut durations = DurationHistory::default();
/// assert_eq!(durations.median(), None);
/// for ms in [9, 1, 2] {
///     durations.record(Duration::from_millis(ms));
/// }
/// assert_eq!(durations.median(), Some(Duration::from_millis(2)));
/// ```
#[derive(Clone, Debug, Reflect)]
#[reflect(Clone, Debug, Default)]
pub struct DurationHistory {
    ring: [Duration; HISTORY_LEN],
    recorded: usize,
}

impl Default for DurationHistory {
    fn default() -> Self {
        Self {
            ring: [Duration::ZERO; HISTORY_LEN],
            recorded: 0,
        }
    }
}

impl DurationHistory {
    /// Records a duration, replacing the oldest.
    pub fn record(&mut self, duration: Duration) {
        self.ring[self.recorded % HISTORY_LEN] = duration;
        self.recorded += 1;
    }

    /// Returns the median of the recorded durations (the lower one of an even count); `None` before
    /// the first.
    pub fn median(&self) -> Option<Duration> {
        // A copy of 2 kB on the stack, to avoid an allocation.
        let mut sorted = self.ring;
        let recorded = &mut sorted[..self.recorded.min(HISTORY_LEN)];
        recorded.sort_unstable();
        recorded.get(recorded.len().checked_sub(1)? / 2).copied()
    }
}

/// Durations of the stage's work in recent frames. Frames without work are not recorded.
#[derive(Resource, Clone, Debug, Default, Reflect)]
#[reflect(Resource, Clone, Debug, Default)]
pub struct FrameTimes {
    /// Placing all vertices: right-hand sides, back substitution and placement.
    pub solve: DurationHistory,
    /// Writing render meshes and uniforms.
    pub draw: DurationHistory,
    /// Whether the graphics card evaluated the last drawn frame from a recording, without solving
    /// or writing vertices.
    pub is_gpu_played: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_forgets_old_durations() {
        let mut durations = DurationHistory::default();
        for _ in 0..HISTORY_LEN {
            durations.record(Duration::from_secs(9));
        }
        for _ in 0..HISTORY_LEN {
            durations.record(Duration::from_millis(3));
        }
        assert_eq!(durations.median(), Some(Duration::from_millis(3)));
    }

    #[test]
    fn the_median_of_an_even_count_is_the_lower_one() {
        let mut durations = DurationHistory::default();
        for ms in [4, 1, 3, 2] {
            durations.record(Duration::from_millis(ms));
        }
        assert_eq!(durations.median(), Some(Duration::from_millis(2)));
    }
}
