//! A film that leaves as motion and not as pixels: animated SVG, a page that plays
//! it, and Lottie.
//!
//! A [`VectorAnimation`] is a film of drawings as a [`FilmSpec`](crate::film::Film) is one of a
//! warp: what the camera draws, as polynomials in t. It is made of pieces; within
//! one there are the same shapes, and each point has a Chebyshev series. From one to
//! the next shapes may come and go. All three formats are written from it, so that
//! none can disagree: the page plays the series themselves, the others have keys.
//!
//! Guaranteed: at no moment that was looked at is a point farther than
//! [`VectorAnimation::TOLERANCE_PX`] from where the camera draws it, in the motion and in what
//! is written from it. Not guaranteed: blends of distance fields have contours whose
//! points have no way from one moment to the next; of them the motion has the film's
//! frames, each until the next. Pictures have no outlines and are refused.
//!
//! - `shape`: a shape taken apart into what stays and what moves
//! - `series`: Chebyshev series; `piece`: shapes between two times
//! - `record`: from drawings to pieces; `thin`: without the points that no one would
//!   miss; `recorded`: both
//! - `course`: which t is shown when; `keys`: the fewest keys between which straight
//!   lines do; `tracks`: shapes over time, with them
//! - `smil`, `lottie`, `page`: the three formats; `plain`: gradients as those know them

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
    /// An SVG document that moves by itself.
    #[must_use]
    pub fn svg(&self) -> String {
        smil::animated_svg(self)
    }

    /// A page that plays it, and needs nothing else.
    #[must_use]
    pub fn page(&self, title: &str) -> String {
        page::html_page(self, title)
    }

    /// A Lottie animation as JSON.
    #[must_use]
    pub fn lottie(&self, title: &str) -> String {
        lottie::lottie_json(self, title).to_string()
    }
}

/// Writes the film as motion, in a format that is that.
///
/// # Errors
/// As [`VectorAnimation::record`], and where the file cannot be written.
pub(super) fn write_motion(
    camera: &Camera,
    film: &FilmSpec,
    (kind, path): (FilmKind, &Path),
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
