//! A film that leaves as motion and not as pixels: animated SVG, a page that plays
//! it, and Lottie.
//!
//! A [`Motion`] is a film of drawings as a [`Film`](crate::film::Film) is one of a
//! warp: what the camera draws, as polynomials in t. It is made of pieces; within
//! one there are the same shapes, and each point has a Chebyshev series. From one to
//! the next shapes may come and go. All three formats are written from it, so that
//! none can disagree: the page plays the series themselves, the others have keys.
//!
//! Guaranteed: at no moment that was looked at is a point farther than
//! [`Motion::TOLERANCE_PX`] from where the camera draws it, in the motion and in what
//! is written from it. Not guaranteed: blends of distance fields have contours whose
//! points have no way from one moment to the next; of them the motion has the film's
//! frames, each until the next. Pictures have no outlines and are refused.
//!
//! - `shape`: a shape taken apart into what stays and what moves
//! - `series`: Chebyshev series; `record`: from drawings to pieces; `thin`: without the
//!   points that no one would miss
//! - `course`: which t is shown when; `keys`: the fewest keys between which straight
//!   lines do; `tracks`: shapes over time, with them
//! - `smil`, `lottie`, `page`: the three formats; `plain`: gradients as those know them

mod course;
mod keys;
mod lottie;
mod page;
mod plain;
mod record;
mod series;
mod shape;
mod smil;
mod thin;
mod tracks;

#[cfg(test)]
mod tests;

use std::path::Path;

use crate::colour::Rgb;
use crate::progress::Progress;

use super::camera::Camera;
use super::drawing::Drawing;
use super::error::ExportError;
use super::film::Film;
use super::size::PixelSize;
use super::still::write_atomically;
use super::target::FilmKind;
use course::Course;
use shape::Posed;

/// What a camera draws, as polynomials in t.
///
/// ```
/// use morphospace::export::{Camera, Film, Motion};
/// use morphospace::progress::Silent;
/// use morphospace::{Design, Transition};
///
/// let kite = Design::of_rings("kite", [[[2.0, 0.0], [4.0, 3.0], [2.0, 4.0], [0.0, 3.0]]])?;
/// let box_ = Design::of_rings("box", [[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]]])?;
/// let camera = Camera::around(Transition::between(kite, box_)?, 480);
/// let film = Film::evenly(0.0, 1.0, 25, 25.0)?;
/// let motion = Motion::record(&camera, &film, &Silent)?;
/// assert!(motion.lottie("kite").starts_with('{'));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Motion {
    size: PixelSize,
    ground: Option<Rgb>,
    /// By ascending t, each up to where the next begins.
    pieces: Vec<Piece>,
    course: Course,
    stops: Vec<(f64, String)>,
}

/// The shapes between two times, which may be one.
#[derive(Clone, Debug)]
struct Piece {
    from: f64,
    to: f64,
    /// The lowest first.
    shapes: Vec<Moving>,
    /// Whether it goes on with the shapes of the piece before.
    goes_on: bool,
}

/// A shape within a piece.
#[derive(Clone, Debug)]
struct Moving {
    /// As it is at the beginning.
    first: Posed,
    /// The series of its points, term by term.
    terms: Vec<Vec<crate::geometry::DVec2>>,
    /// Its looks at even times from the beginning to the end, at least one.
    looks: Vec<Vec<f64>>,
}

impl Motion {
    /// How far a point may be from where the camera draws it, in pixels.
    pub const TOLERANCE_PX: f64 = 0.2;

    /// Records what a camera draws over a film's times.
    ///
    /// # Errors
    /// [`ExportError::NoOutlines`] where pictures are what is seen, and
    /// [`ExportError::Cancelled`].
    pub fn record(
        camera: &Camera,
        film: &Film,
        progress: &dyn Progress,
    ) -> Result<Self, ExportError> {
        let mut pieces = record::record(camera, film, progress)?;
        thin::thin(&mut pieces);
        Ok(Self {
            size: camera.view.size(),
            ground: camera.ground,
            pieces,
            course: Course::of(film),
            stops: film.stops().to_vec(),
        })
    }

    /// The drawing at `t`, as the motion has it.
    #[must_use]
    pub fn at(&self, t: f64) -> Drawing {
        let mut drawing = Drawing::new(self.size, self.ground);
        let posed = self.pieces[self.piece_at(t)].at(t);
        drawing.items = posed.iter().map(Posed::item).collect();
        drawing
    }

    /// An SVG document that moves by itself.
    #[must_use]
    pub fn svg(&self) -> String {
        smil::written(self)
    }

    /// A page that plays it, and needs nothing else.
    #[must_use]
    pub fn page(&self, title: &str) -> String {
        page::written(self, title)
    }

    /// A Lottie animation as JSON.
    #[must_use]
    pub fn lottie(&self, title: &str) -> String {
        lottie::written(self, title).to_string()
    }

    fn piece_at(&self, t: f64) -> usize {
        let after = self.pieces.partition_point(|piece| piece.from <= t);
        after.saturating_sub(1)
    }

    /// The first and the last t.
    fn ends(&self) -> [f64; 2] {
        let first = self.pieces.first().map_or(0.0, |piece| piece.from);
        [first, self.pieces.last().map_or(first, |piece| piece.to)]
    }
}

impl Piece {
    /// The shapes at `t`; outside the piece as at its nearer end.
    fn at(&self, t: f64) -> Vec<Posed> {
        let length = self.to - self.from;
        let s = if length > 0.0 {
            ((t - self.from) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        self.shapes.iter().map(|shape| shape.at(s)).collect()
    }
}

impl Moving {
    /// At `s` in [0, 1] of its piece.
    fn at(&self, s: f64) -> Posed {
        Posed {
            form: self.first.form.clone(),
            points: series::sum(&self.terms, s),
            look: self.look_at(s),
        }
    }

    fn look_at(&self, s: f64) -> Vec<f64> {
        let last = self.looks.len() - 1;
        let at = s * last as f64;
        let k = (at as usize).min(last.saturating_sub(1));
        let (a, b) = (&self.looks[k], &self.looks[(k + 1).min(last)]);
        let share = at - k as f64;
        let mix = |(a, b): (&f64, &f64)| a * (1.0 - share) + b * share;
        a.iter().zip(b).map(mix).collect()
    }
}

/// Writes the film as motion, in a format that is that.
///
/// # Errors
/// As [`Motion::record`], and where the file cannot be written.
pub(super) fn write_motion(
    camera: &Camera,
    film: &Film,
    (kind, path): (FilmKind, &Path),
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    let motion = Motion::record(camera, film, progress)?;
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
