//! A film on the graphics card, and whether it is there.

use bevy::prelude::*;
use bevy::render::render_resource::Buffer;
use bevy::tasks::Task;

use crate::recording::Recording;

use super::recorded_material::RecordedSum;

/// Where the film of a transition is.
#[derive(Component, Debug)]
pub(super) enum UploadState {
    /// On its way.
    Under(Task<Option<UploadedIntervals>>),
    There(UploadedIntervals),
    /// The card has no room for it.
    Refused,
}

/// A film on the graphics card.
#[derive(Debug)]
pub(super) struct UploadedIntervals {
    pub(super) film: Recording,
    /// As many as the film has.
    pub(super) reels: Vec<UploadedInterval>,
}

/// The polynomials between two times.
#[derive(Debug)]
pub(super) struct UploadedInterval {
    /// Row after row, as `played.wgsl` reads them.
    pub(super) rows: Buffer,
    /// In a row.
    pub(super) vertices: usize,
    pub(super) coefficients: usize,
}

impl UploadState {
    /// What shows `t`, and how it is summed; none where the film does not.
    pub(super) fn at(&self, t: f64) -> Option<(&Buffer, RecordedSum)> {
        let Self::There(UploadedIntervals { film, reels }) = self else {
            return None;
        };
        let (k, weights) = film.weights(t)?;
        let reel = reels.get(k)?;
        let sum = RecordedSum::new(&weights, reel.vertices, reel.coefficients);
        Some((&reel.rows, sum))
    }

    /// Whether it shows `t`.
    pub(super) fn shows(&self, t: f64) -> bool {
        matches!(self, Self::There(_)) && (0.0..=1.0).contains(&t)
    }
}
