//! Measures the time from one frame to the next, shown next to the times of the stages within a
//! frame.

use bevy::prelude::{Real, Res, ResMut, Resource, Time};

use crate::stage::DurationHistory;

/// Durations from one frame to the next.
#[derive(Resource, Clone, Debug, Default)]
pub struct FrameIntervals(pub DurationHistory);

/// Records the duration of the last frame.
pub fn record(time: Res<Time<Real>>, mut intervals: ResMut<FrameIntervals>) {
    intervals.0.record(time.delta());
}
