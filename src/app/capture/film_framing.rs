//! How the film that would be written lies over the stage, while its options are open.

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::input::preferences::{FilmExportOptions, Preferences};
use crate::app::session::state::Session;
use crate::export::{FilmSpec, FilmSpecError, PixelSizeError, PlaneView, framing};
use crate::geometry::Bounds;
use crate::transition::{Sequence, Timing, TimingError, TransitionStop};

/// The film that would be written; none while nobody asks.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct FilmFraming(pub Option<FilmFrameInfo>);

/// The frame of a film, and how long it is.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmFrameInfo {
    /// What its pictures show.
    pub view: PlaneView,
    /// How many there are.
    pub frames: usize,
    /// How long it runs, in seconds.
    pub secs: f64,
}

impl FilmFrameInfo {
    /// The part of the plane that is seen.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let corners = [glam::DVec2::ZERO, self.view.size().as_dvec2()];
        let [a, b] = corners.map(|px| self.view.to_plane(px));
        Bounds {
            min: a.min(b),
            max: a.max(b),
        }
    }
}

/// Why there is no film.
#[derive(Debug, thiserror::Error)]
pub enum FilmFramingError {
    /// It would begin where it ends.
    #[error(transparent)]
    Timing(#[from] TimingError),
    /// The timing makes none.
    #[error(transparent)]
    Film(#[from] FilmSpecError),
    /// It would have no size.
    #[error(transparent)]
    Size(#[from] PixelSizeError),
}

/// The film of a timing, and what its pictures show: as it is written, and as it is said before.
///
/// # Errors
/// [`FilmFramingError`] where the timing or the size make no film.
pub fn frame_film(
    sequence: &Sequence,
    (timing, stops): (&Timing, &[TransitionStop]),
    look: &FilmExportOptions,
) -> Result<(FilmSpec, PlaneView), FilmFramingError> {
    let timing = look.timing(timing, stops);
    timing.check(stops)?;
    let film = FilmSpec::of_timing(&timing, stops, f64::from(look.fps))?;
    let bounds = framing(sequence, film.times());
    let view = look.layout.view(bounds)?;
    Ok((film, view))
}

/// Keeps up with what would be written.
pub fn follow(
    session: Res<Session>,
    preferences: Res<Preferences>,
    mut frame: ResMut<FilmFraming>,
) {
    if !session.is_changed() && !preferences.is_changed() {
        return;
    }
    let sequence = preferences
        .film_options
        .then(|| session.sequence())
        .flatten();
    let framed = sequence.and_then(|sequence| {
        let timing = (session.timing(), session.stops());
        let (film, view) = frame_film(&sequence, timing, &preferences.film).ok()?;
        let frames = film.times().len();
        Some(FilmFrameInfo {
            view,
            frames,
            secs: frames as f64 / f64::from(preferences.film.fps),
        })
    });
    frame.set_if_neq(FilmFraming(framed));
}
