//! Renders frames of a transition as drawings, one at a time or a whole film on all cores.
//!
//! Guarantees: frames are delivered in order; at most [`BATCH_BYTES`] of raster frames are in
//! memory at once (or one frame, if a single frame is larger); a cancellation is noticed before
//! each frame.

use image::RgbaImage;
use rayon::prelude::*;

use crate::colour::Rgb;
use crate::geometry::Bounds;
use crate::transition::{Sequence, SequenceFrame, TransitionStyle};
use crate::work::progress::{Cancelled, Progress, checkpoint};

use super::captions::Captions;
use super::drawing::Drawing;
use super::error::ExportError;
use super::film_spec::{FrameRun, even_times};
use super::raster::rasterise;
use super::size::PixelSize;
use super::svg::to_svg;
use super::view::PlaneView;

/// Maximum memory for raster frames that are drawn but not yet written, in bytes (resource limit:
/// holds 32 frames of 1920 × 1080).
pub const BATCH_BYTES: u64 = 256 << 20;

/// Maximum number of evenly spaced frames that [`framing`] samples, not counting the last frame
/// (heuristic).
const FRAMING_SAMPLES: usize = 33;

/// Name of the progress stage in which frames are drawn.
pub(super) const DRAWING_STAGE: &str = "drawing frames";

/// A transition (or several in sequence) together with its style and the part of the plane to show.
#[derive(Clone, Debug)]
pub struct Camera {
    /// The transitions to show.
    pub sequence: Sequence,
    /// Fill colours of shapes that have no paint, and whether the joints of trusses are drawn.
    pub style: TransitionStyle,
    /// Part of the plane to show, and image size.
    pub view: PlaneView,
    /// Background colour; `None` is transparent.
    pub ground: Option<Rgb>,
    /// Captions below the frames; `None` for no captions.
    pub captions: Option<Captions>,
}

impl Camera {
    /// Creates a camera that shows every frame from the first design to the last without cropping,
    /// with default colours on a transparent background. The longer side of the image has the given
    /// number of pixels.
    pub fn around(shown: impl Into<Sequence>, longer_side_px: u32) -> Self {
        let sequence = shown.into();
        let times = even_times(0.0, sequence.end(), FRAMING_SAMPLES);
        let bounds = framing(&sequence, &times);
        Self {
            view: PlaneView::fit(bounds, PixelSize::of_shape(bounds, longer_side_px)),
            sequence,
            style: TransitionStyle::default(),
            ground: None,
            captions: None,
        }
    }

    /// Returns the frame at `t` as an SVG document.
    pub fn svg(&self, t: f64) -> String {
        to_svg(&self.draw(t))
    }

    /// Returns the frame at `t` as pixels with straight alpha.
    pub fn pixels(&self, t: f64) -> RgbaImage {
        rasterise(&self.draw(t))
    }

    /// Returns the frame at `t` as a drawing.
    pub fn draw(&self, t: f64) -> Drawing {
        self.draw_frame(&self.sequence.frame(t))
    }

    /// Returns the drawing of an evaluated frame of this sequence.
    pub(super) fn draw_frame(&self, frame: &SequenceFrame) -> Drawing {
        let style = frame.style(&self.style);
        let mut drawing = Drawing::of_frame(frame.frame(), &style, &self.view, self.ground);
        if let Some(captions) = &self.captions {
            captions.push(&mut drawing, frame.t());
        }
        drawing
    }

    /// Draws each run (consecutive frames that show the same t) once. `make` processes the drawings
    /// on any thread; `take` receives the results in order on the calling thread. `stage` is the
    /// progress stage to report.
    ///
    /// # Errors
    /// [`ExportError::Cancelled`], or the first error of `make` or `take`.
    pub fn draw_runs<T: Send>(
        &self,
        runs: &[FrameRun],
        stage: &'static str,
        progress: &dyn Progress,
        make: impl Fn(Drawing) -> Result<T, ExportError> + Sync,
        mut take: impl FnMut(FrameRun, T) -> Result<(), ExportError>,
    ) -> Result<(), ExportError> {
        let mut done = 0;
        // Threads finish frames in any order but files need them in sequence, so each batch is
        // drawn in parallel and then delivered in order.
        for batch in runs.chunks(batch_len(self.view.size())) {
            checkpoint(progress, stage, done as f64 / runs.len() as f64)?;
            let shoot = |frame: &mut SequenceFrame, run: &FrameRun| {
                if progress.is_cancelled() {
                    return Err(Cancelled.into());
                }
                frame.seek(run.t);
                make(self.draw_frame(frame))
            };
            // A frame owns its working memory, so each thread gets a separate frame.
            let frame_of_thread = || self.sequence.frame(batch[0].t);
            let results: Vec<T> = batch
                .par_iter()
                .map_init(frame_of_thread, shoot)
                .collect::<Result<_, ExportError>>()?;
            for (run, result) in batch.iter().zip(results) {
                take(*run, result)?;
            }
            done += batch.len();
        }
        checkpoint(progress, stage, 1.0)?;
        Ok(())
    }
}

/// Margin around the shapes, as a fraction of their longer side (heuristic).
const MARGIN: f64 = 0.04;

/// Returns the part of the plane that contains the bounds of all designs and of frames sampled
/// evenly over `times`, plus a small margin. The frames are included because shapes may swing far
/// out between the designs.
pub fn framing(shown: impl Into<Sequence>, times: &[f64]) -> Bounds {
    let sequence = shown.into();
    let step = times.len().div_ceil(FRAMING_SAMPLES).max(1);
    // The last time is always included, since the stride may skip it.
    let sampled = times.iter().step_by(step).chain(times.last());
    let mut frame = sequence.frame(times.first().copied().unwrap_or_default());
    let mut framed = sequence.bounds();
    for &t in sampled {
        frame.seek(t);
        let figure = frame.frame().figure();
        let half_width = 0.5 * figure.bar_width;
        let ring_bounds = Bounds::of(figure.rings.iter().flatten().copied());
        let axis_bounds = Bounds::of(figure.bars.iter().flatten().copied());
        let bar_bounds = axis_bounds.map(|bounds| bounds.padded(half_width));
        for bounds in [ring_bounds, bar_bounds].into_iter().flatten() {
            // At t far outside [0, 1], coordinates overflow. Such a frame must not affect the
            // framing of the others.
            if bounds.min.is_finite() && bounds.max.is_finite() {
                framed = framed.union(&bounds);
            }
        }
    }
    framed.padded(MARGIN * framed.size().max_element())
}

/// Returns the number of frames that are drawn in parallel before the first of them is delivered.
fn batch_len(size: PixelSize) -> usize {
    let in_memory = (BATCH_BYTES / (size.pixels() * 4)).max(1);
    // Four frames per thread keep all threads busy although some frames are slow. More frames would
    // delay cancellation and progress reports.
    (in_memory as usize).min(4 * rayon::current_num_threads())
}
