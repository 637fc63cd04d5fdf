//! State of a recording's upload to the graphics card.

use bevy::prelude::*;
use bevy::render::render_resource::Buffer;
use bevy::tasks::Task;

use crate::recording::Recording;

use super::recorded_material::RecordedSum;

/// Upload state of a transition's recording.
#[derive(Component, Debug)]
pub(super) enum UploadState {
    /// The upload is running.
    Uploading(Task<Option<UploadedIntervals>>),
    /// The recording is on the graphics card.
    Ready(UploadedIntervals),
    /// The graphics card has no room for it.
    Refused,
}

/// A recording on the graphics card.
#[derive(Debug)]
pub(super) struct UploadedIntervals {
    /// The recording, which provides the weights at each t.
    pub(super) recording: Recording,
    /// Uploaded intervals, one per interval of the recording.
    pub(super) intervals: Vec<UploadedInterval>,
}

/// One interval of a recording: polynomials between two times.
#[derive(Debug)]
pub(super) struct UploadedInterval {
    /// Rows as `played.wgsl` reads them.
    pub(super) rows: Buffer,
    /// Number of vertices per row.
    pub(super) vertices: usize,
    /// Number of coefficient rows.
    pub(super) coefficients: usize,
}

impl UploadState {
    /// Returns the buffer that covers `t`, and the weights of its rows; `None` if the recording is
    /// not uploaded or does not cover `t`.
    pub(super) fn at(&self, t: f64) -> Option<(&Buffer, RecordedSum)> {
        let Self::Ready(UploadedIntervals {
            recording,
            intervals,
        }) = self
        else {
            return None;
        };
        let (k, weights) = recording.weights(t)?;
        let interval = intervals.get(k)?;
        let sum = RecordedSum::new(&weights, interval.vertices, interval.coefficients);
        Some((&interval.rows, sum))
    }

    /// Whether the uploaded recording covers `t`.
    pub(super) fn covers(&self, t: f64) -> bool {
        matches!(self, Self::Ready(_)) && (0.0..=1.0).contains(&t)
    }
}
