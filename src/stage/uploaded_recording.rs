//! Recordings that are being uploaded to the graphics card or have been uploaded, and lookup of the
//! uploaded interval at a given t.

use bevy::prelude::*;
use bevy::render::render_resource::Buffer;
use bevy::tasks::Task;

use crate::recording::Recording;

use super::recorded_material::RecordedSum;

/// Whether the upload of a transition's recording is running, has finished, or was refused.
#[derive(Component, Debug)]
pub(super) enum UploadState {
    /// The upload is running.
    Uploading(Task<Option<UploadedIntervals>>),
    /// The upload has finished; the graphics card can evaluate the recording.
    Ready(UploadedIntervals),
    /// The recording does not fit into the memory of the graphics card.
    Refused,
}

/// A recording whose intervals are on the graphics card.
#[derive(Debug)]
pub(super) struct UploadedIntervals {
    /// The recording. At each t it provides the weights with which the shader sums the rows of an
    /// interval.
    pub(super) recording: Recording,
    /// All intervals of the recording, in its order.
    pub(super) intervals: Vec<UploadedInterval>,
}

/// One interval of a recording on the graphics card: the polynomials of all vertices.
#[derive(Debug)]
pub(super) struct UploadedInterval {
    /// Buffer with the rows that `played.wgsl` reads: the positions at the beginning and at the end
    /// of the interval, then the polynomial coefficients.
    pub(super) rows: Buffer,
    /// Number of entries in a row: the number of vertices, rounded up to whole blocks of the
    /// recording.
    pub(super) vertices: usize,
    /// Number of rows of polynomial coefficients.
    pub(super) coefficients: usize,
}

impl UploadState {
    /// Returns the buffer of the interval that contains `t`, and the weights of its rows at `t`;
    /// `None` if the recording is not uploaded or `t` is outside [0, 1].
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

    /// Returns whether the recording is uploaded and `t` is in [0, 1].
    pub(super) fn covers(&self, t: f64) -> bool {
        matches!(self, Self::Ready(_)) && (0.0..=1.0).contains(&t)
    }
}
