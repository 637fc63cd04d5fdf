//! Measured durations of the work in recent frames: solving and drawing.
//!
//! Guaranteed: recording a duration neither allocates nor blocks. Only CPU time is measured, not
//! the time of the GPU.

use std::time::Duration;

use bevy::prelude::*;

/// Number of durations in a [`DurationHistory`], over which its median is taken (heuristic).
pub const HISTORY_LEN: usize = 120;

/// The last [`HISTORY_LEN`] durations of one kind of work.
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
    /// Records a duration; it replaces the oldest one if the history is full.
    pub fn record(&mut self, duration: Duration) {
        self.ring[self.recorded % HISTORY_LEN] = duration;
        self.recorded += 1;
    }

    /// Returns the median of the recorded durations: the lower of the two middle durations if their
    /// number is even, and `None` if none is recorded.
    pub fn median(&self) -> Option<Duration> {
        // A copy of 2 kB on the stack avoids an allocation.
        let mut sorted = self.ring;
        let recorded = &mut sorted[..self.recorded.min(HISTORY_LEN)];
        recorded.sort_unstable();
        recorded.get(recorded.len().checked_sub(1)? / 2).copied()
    }
}

/// CPU times of solving and drawing in recent frames. Frames without this work are not recorded.
#[derive(Resource, Clone, Debug, Default, Reflect)]
#[reflect(Resource, Clone, Debug, Default)]
pub struct FrameTimes {
    /// CPU time per frame to compute all vertices: the right-hand sides of the linear system of the
    /// warp, its solution, and the placement.
    pub solve: DurationHistory,
    /// CPU time per frame to write render meshes and uniforms.
    pub draw: DurationHistory,
    /// Whether the graphics card evaluated the last drawn frame from a recording, so that the CPU
    /// neither solved it nor wrote vertices.
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
