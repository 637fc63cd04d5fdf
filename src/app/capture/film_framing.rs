//! Frame of the film to be exported: the rectangular section of the plane that the film shows. It
//! is outlined on the stage while the export settings are shown.

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::input::preferences::{FilmExportOptions, Preferences};
use crate::app::session::state::Session;
use crate::export::{FilmSpec, FilmSpecError, PixelSizeError, PlaneView, framing};
use crate::geometry::Bounds;
use crate::transition::{Sequence, Timing, TimingError, TransitionStop};

/// Frame of the film; `None` while the export settings are hidden or there is no film to export.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct FilmFraming(pub Option<FilmFrameInfo>);

/// View of the plane, number of images and duration of a film.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmFrameInfo {
    /// Mapping from the plane to the pixels of the film.
    pub view: PlaneView,
    /// Number of frames of the film.
    pub frames: usize,
    /// Duration of the film in seconds.
    pub secs: f64,
}

impl FilmFrameInfo {
    /// Section of the plane that the film shows.
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

/// Reason why the export settings give no film.
#[derive(Debug, thiserror::Error)]
pub enum FilmFramingError {
    /// The timing is invalid, for example because the film has no duration.
    #[error(transparent)]
    Timing(#[from] TimingError),
    /// The frame rate or the number of frames is out of range, or the first or last t is not
    /// finite.
    #[error(transparent)]
    Film(#[from] FilmSpecError),
    /// The film's width or height in pixels is out of range.
    #[error(transparent)]
    Size(#[from] PixelSizeError),
}

/// Returns the film that the settings give, and the view of the plane that the film shows. The
/// export and the outline of the film's frame on the stage both use this function.
///
/// # Errors
/// [`FilmFramingError`] if the timing or the size gives no film.
pub fn frame_film(
    sequence: &Sequence,
    timing: &Timing,
    stops: &[TransitionStop],
    options: &FilmExportOptions,
) -> Result<(FilmSpec, PlaneView), FilmFramingError> {
    let timing = options.timing(timing, stops);
    timing.check(stops)?;
    let film = FilmSpec::of_timing(&timing, stops, f64::from(options.fps))?;
    let bounds = framing(sequence, film.times());
    let view = options.layout.view(bounds)?;
    Ok((film, view))
}

/// Updates the film's frame when the project or the export settings change.
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
        let (timing, stops) = (session.timing(), session.stops());
        let (film, view) = frame_film(&sequence, timing, stops, &preferences.film).ok()?;
        let frames = film.times().len();
        Some(FilmFrameInfo {
            view,
            frames,
            secs: frames as f64 / f64::from(preferences.film.fps),
        })
    });
    frame.set_if_neq(FilmFraming(framed));
}
