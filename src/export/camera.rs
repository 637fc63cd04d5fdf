//! Takes pictures of a transition: one at a time, or a film over all cores.
//!
//! Guarantees: frames come out in order; at most [`BATCH_BYTES`] of raster
//! pictures are in memory at once (or one frame, where that is larger); a cancel
//! is noticed before each frame.

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

/// Memory for frames that are drawn ahead of being written, in bytes: 32 of
/// 1920 × 1080.
pub const BATCH_BYTES: u64 = 256 << 20;

/// The most frames at which [`framing`] looks: both ends, and what is between
/// them halved five times.
const FRAMING_SAMPLES: usize = 33;

/// The stage of drawing a film's frames, as [`Progress`] is told.
pub(super) const DRAWING_STAGE: &str = "drawing frames";

/// A transition or several in sequence, how they look, and from where they are seen.
#[derive(Clone, Debug)]
pub struct Camera {
    /// What is shown.
    pub sequence: Sequence,
    /// In which colours.
    pub style: TransitionStyle,
    /// Which part of the plane, at which size.
    pub view: PlaneView,
    /// On which ground; `None` is transparent.
    pub ground: Option<Rgb>,
    /// What stands below.
    pub captions: Option<Captions>,
}

impl Camera {
    /// A camera that sees every frame from the first design to the last whole, with the
    /// longer side of its pictures given in pixels, in the usual colours and on a
    /// transparent ground.
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

    /// The frame at `t` as an SVG document.
    pub fn svg(&self, t: f64) -> String {
        to_svg(&self.shoot(t))
    }

    /// The frame at `t` as pixels with straight alpha.
    pub fn pixels(&self, t: f64) -> RgbaImage {
        rasterise(&self.shoot(t))
    }

    /// The drawing of one frame.
    pub fn shoot(&self, t: f64) -> Drawing {
        self.drawn(&self.sequence.frame(t))
    }

    /// The drawing of a frame of what is shown.
    pub(super) fn drawn(&self, frame: &SequenceFrame) -> Drawing {
        let style = frame.style(&self.style);
        let mut drawing = Drawing::of_frame(frame.now(), &style, &self.view, self.ground);
        if let Some(captions) = &self.captions {
            captions.push(&mut drawing, frame.t());
        }
        drawing
    }

    /// Draws each run's frame once, makes something of it on any thread, and
    /// hands the results over in order on this one. `stage` is what
    /// `progress` is told.
    ///
    /// # Errors
    /// [`ExportError::Cancelled`], or what `make` and `take` return.
    pub fn shoot_runs<T: Send>(
        &self,
        runs: &[FrameRun],
        stage: &'static str,
        progress: &dyn Progress,
        make: impl Fn(Drawing) -> Result<T, ExportError> + Sync,
        mut take: impl FnMut(FrameRun, T) -> Result<(), ExportError>,
    ) -> Result<(), ExportError> {
        let mut done = 0;
        // Cores finish frames in any order, files want them in theirs: a batch
        // is drawn on all, then handed over.
        for batch in runs.chunks(batch_len(self.view.size())) {
            checkpoint(progress, stage, done as f64 / runs.len() as f64)?;
            let shoot = |frame: &mut SequenceFrame, run: &FrameRun| {
                if progress.is_cancelled() {
                    return Err(Cancelled.into());
                }
                frame.seek(run.t);
                make(self.drawn(frame))
            };
            // A frame owns the memory that it is evaluated in: one for each
            // thread.
            let frames = || self.sequence.frame(batch[0].t);
            let made = batch.par_iter().map_init(frames, shoot);
            let made: Vec<T> = made.collect::<Result<_, ExportError>>()?;
            for (run, made) in batch.iter().zip(made) {
                take(*run, made)?;
            }
            done += batch.len();
        }
        checkpoint(progress, stage, 1.0)?;
        Ok(())
    }
}

/// Room around the shapes, as a fraction of their longer side.
const MARGIN: f64 = 0.04;

/// The part of the plane that holds the bounds of what is shown and every one
/// of some frames spread evenly over `times`, so that a shape that swings wide
/// on its way is not cut off; with a little room around.
pub fn framing(shown: impl Into<Sequence>, times: &[f64]) -> Bounds {
    let sequence = shown.into();
    let step = times.len().div_ceil(FRAMING_SAMPLES).max(1);
    // The last one stays in, which the steps may jump over.
    let sampled = times.iter().step_by(step).chain(times.last());
    let mut frame = sequence.frame(times.first().copied().unwrap_or_default());
    let mut all = sequence.bounds();
    for &t in sampled {
        frame.seek(t);
        let figure = frame.now().figure();
        let reach = 0.5 * figure.bar_width;
        let on_rings = Bounds::of(figure.rings.iter().flatten().copied());
        let on_bars = Bounds::of(figure.bars.iter().flatten().copied());
        let on_bars = on_bars.map(|bounds| bounds.padded(reach));
        for bounds in [on_rings, on_bars].into_iter().flatten() {
            // Far outside [0, 1] a film overflows, and such a frame would leave
            // no room for any other.
            if bounds.min.is_finite() && bounds.max.is_finite() {
                all = all.union(&bounds);
            }
        }
    }
    all.padded(MARGIN * all.size().max_element())
}

fn batch_len(size: PixelSize) -> usize {
    let in_memory = (BATCH_BYTES / (size.pixels() * 4)).max(1);
    // A few frames for each core even out those that take longer; more would
    // only make a cancel and the progress wait.
    (in_memory as usize).min(4 * rayon::current_num_threads())
}
