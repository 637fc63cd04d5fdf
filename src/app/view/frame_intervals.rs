//! Measures the time from one frame of the window to the next, which the display of frame times
//! shows.

use bevy::prelude::{Real, Res, ResMut, Resource, Time};

use crate::stage::DurationHistory;

/// Durations from one frame of the window to the next.
#[derive(Resource, Clone, Debug, Default)]
pub struct FrameIntervals(pub DurationHistory);

/// Records the time between the last two frames.
pub fn record(time: Res<Time<Real>>, mut intervals: ResMut<FrameIntervals>) {
    intervals.0.record(time.delta());
}
