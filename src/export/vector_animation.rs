//! Exports a film as vector animation instead of pixels: animated SVG, an HTML page with a player,
//! and Lottie.
//!
//! A [`VectorAnimation`] records the drawings of a camera as polynomials in t, just as a
//! [`Recording`](crate::recording::Recording) does for a warp. It consists of animation pieces
//! (intervals of t). Within a piece the set of shapes is constant, and each point follows a
//! Chebyshev series. From one piece to the next, shapes may appear or disappear. All three formats
//! are written from the same pieces: the HTML page evaluates the series, and the others use
//! keyframes.
//!
//! Guarantees: at every tested moment each point is within [`VectorAnimation::TOLERANCE_PX`] of
//! where the camera draws it, in the recording and in the files written from it. Limits: contours
//! of distance field blends have no point correspondence over time, so they are stored as
//! individual frames without interpolation. Raster images have no outlines and are refused.
//!
//! - `shape`: splits a shape into its constant and its moving data
//! - `chebyshev`: Chebyshev series of points; `piece`: shapes between two times
//! - `record`: turns drawings into pieces; `simplify`: removes superfluous polygon points;
//!   `animation`: the recorded and simplified pieces of a whole film
//! - `timeline`: timeline of the film; `keyframes`: fewest keyframes for linear interpolation;
//!   `tracks`: shapes over time with their keyframes
//! - `smil`, `lottie`, `page`: writers of the three formats; `two_point_gradient`: gradients in the
//!   simpler form that these formats support

mod animation;
mod chebyshev;
mod keyframes;
mod lottie;
mod page;
mod piece;
mod record;
mod shape;
mod simplify;
mod smil;
mod timeline;
mod tracks;
mod two_point_gradient;

#[cfg(test)]
mod tests;

use std::path::Path;

use crate::work::progress::Progress;

use super::camera::Camera;
use super::error::ExportError;
use super::film_spec::FilmSpec;
use super::still::write_atomically;
use super::target::FilmKind;

pub use animation::VectorAnimation;

impl VectorAnimation {
    /// Returns an animated SVG document.
    #[must_use]
    pub fn svg(&self) -> String {
        smil::animated_svg(self)
    }

    /// Returns a self-contained HTML page with a player.
    #[must_use]
    pub fn page(&self, title: &str) -> String {
        page::html_page(self, title)
    }

    /// Returns a Lottie animation as JSON.
    #[must_use]
    pub fn lottie(&self, title: &str) -> String {
        lottie::lottie_json(self, title)
    }
}

/// Writes the film to an animated SVG, HTML or Lottie file. Its title is that of the film, or else
/// the file name without extension.
///
/// # Errors
/// Same as for [`VectorAnimation::record`], and [`ExportError`] if the file cannot be written.
pub(super) fn write_motion(
    camera: &Camera,
    film: &FilmSpec,
    kind: FilmKind,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    let motion = VectorAnimation::record(camera, film, progress)?;
    let stem = || {
        path.file_stem()
            .map(|stem| stem.to_string_lossy().into_owned())
    };
    let title = film.title().map(str::to_owned).or_else(stem);
    let title = title.unwrap_or_default();
    let text = match kind {
        FilmKind::Html => motion.page(&title),
        FilmKind::Lottie => motion.lottie(&title),
        _ => motion.svg(),
    };
    write_atomically(path, text.as_bytes())
}
