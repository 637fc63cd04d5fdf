//! The time of a whole frame, beside those of its stages.

use bevy::prelude::{Real, Res, ResMut, Resource, Time};

use crate::stage::StageTimes;

/// From one frame to the next.
#[derive(Resource, Clone, Debug, Default)]
pub struct FrameIntervals(pub StageTimes);

/// Notes how long the last frame took.
pub fn record(time: Res<Time<Real>>, mut whole: ResMut<FrameIntervals>) {
    whole.0.record(time.delta());
}
