//! Vector animation: the drawings of a camera over a film, recorded as polynomials in t.

use crate::colour::Rgb;
use crate::work::progress::Progress;

use super::super::camera::Camera;
use super::super::drawing::Drawing;
use super::super::error::ExportError;
use super::super::film_spec::FilmSpec;
use super::super::size::PixelSize;
use super::piece::AnimationPiece;
use super::shape::PosedShape;
use super::timeline::FilmTimeline;
use super::{record, simplify};

/// Drawings of a camera over a film, recorded as polynomials in t.
///
/// ```
/// use morphospace::export::{Camera, FilmSpec, VectorAnimation};
/// use morphospace::work::progress::Silent;
/// use morphospace::{Design, Transition};
///
/// let kite = Design::from_rings("kite", [[[2.0, 0.0], [4.0, 3.0], [2.0, 4.0], [0.0, 3.0]]])?;
/// let box_ = Design::from_rings("box", [[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]]])?;
/// let camera = Camera::around(Transition::between(kite, box_)?, 480);
/// let film = FilmSpec::evenly(0.0, 1.0, 25, 25.0)?;
/// let motion = VectorAnimation::record(&camera, &film, &Silent)?;
/// assert!(motion.lottie("kite").starts_with('{'));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct VectorAnimation {
    pub(super) size: PixelSize,
    pub(super) ground: Option<Rgb>,
    /// Animation pieces (intervals of t with a constant set of shapes) by ascending t. Each is
    /// shown until the next one begins.
    pub(super) pieces: Vec<AnimationPiece>,
    pub(super) timeline: FilmTimeline,
    pub(super) stops: Vec<(f64, String)>,
}

impl VectorAnimation {
    /// Maximum distance of a point from where the camera draws it, in pixels (tolerance: invisible
    /// in motion).
    pub const TOLERANCE_PX: f64 = 0.2;

    /// Records the drawings of a camera over the times of a film.
    ///
    /// # Errors
    /// [`ExportError::NoOutlines`] if the content is raster images, or [`ExportError::Cancelled`].
    pub fn record(
        camera: &Camera,
        film: &FilmSpec,
        progress: &dyn Progress,
    ) -> Result<Self, ExportError> {
        let mut pieces = record::record(camera, film, progress)?;
        simplify::simplify(&mut pieces, simplify::STATIC_TOLERANCE_PX);
        Ok(Self {
            size: camera.view.size(),
            ground: camera.ground,
            pieces,
            timeline: FilmTimeline::of(film),
            stops: film.stops().to_vec(),
        })
    }

    /// Returns the recorded drawing at `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> Drawing {
        let mut drawing = Drawing::new(self.size, self.ground);
        let posed = self.pieces[self.piece_at(t)].at(t);
        drawing.items = posed.iter().map(PosedShape::to_item).collect();
        drawing
    }

    /// Returns the index of the animation piece that is shown at `t`.
    pub(super) fn piece_at(&self, t: f64) -> usize {
        let after = self.pieces.partition_point(|piece| piece.from <= t);
        after.saturating_sub(1)
    }

    /// Returns the first and the last t of the animation.
    pub(super) fn time_range(&self) -> [f64; 2] {
        let first = self.pieces.first().map_or(0.0, |piece| piece.from);
        [first, self.pieces.last().map_or(first, |piece| piece.to)]
    }
}
