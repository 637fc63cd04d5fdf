//! A film on the graphics card, and whether it is there.

use bevy::prelude::*;
use bevy::render::render_resource::Buffer;
use bevy::tasks::Task;

use crate::film::Film;

use super::played::Sum;

/// Where the film of a transition is.
#[derive(Component, Debug)]
pub(super) enum Sent {
    /// On its way.
    Under(Task<Option<Reels>>),
    There(Reels),
    /// The card has no room for it.
    Refused,
}

/// A film on the graphics card.
#[derive(Debug)]
pub(super) struct Reels {
    pub(super) film: Film,
    /// As many as the film has.
    pub(super) reels: Vec<Reel>,
}

/// The polynomials between two times.
#[derive(Debug)]
pub(super) struct Reel {
    /// Row after row, as `played.wgsl` reads them.
    pub(super) rows: Buffer,
    /// In a row.
    pub(super) vertices: usize,
    pub(super) coefficients: usize,
}

impl Sent {
    /// What shows `t`, and how it is summed; none where the film does not.
    pub(super) fn at(&self, t: f64) -> Option<(&Buffer, Sum)> {
        let Self::There(Reels { film, reels }) = self else {
            return None;
        };
        let (k, weights) = film.weights(t)?;
        let reel = reels.get(k)?;
        let sum = Sum::new(&weights, reel.vertices, reel.coefficients);
        Some((&reel.rows, sum))
    }

    /// Whether it shows `t`.
    pub(super) fn shows(&self, t: f64) -> bool {
        matches!(self, Self::There(_)) && (0.0..=1.0).contains(&t)
    }
}
