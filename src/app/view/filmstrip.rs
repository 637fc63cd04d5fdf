//! Filmstrip of the timeline: thumbnails of the film at regular t, including every design.
//!
//! The thumbnails are drawn in the background whenever the film or its colours change, but only
//! after the automatic check of the film: users wait for the check, not for thumbnails.

use std::sync::Arc;

use bevy::prelude::{DetectChangesMut, Res, ResMut, Resource, UVec2};
use image::RgbaImage;

use crate::app::analysis::film_measures::StageMeasures;
use crate::app::jobs::job::BackgroundJob;
use crate::app::session::state::Session;
use crate::export::{
    Drawing, PixelSize, PixelSizeError, PlaneView, even_times, framing, rasterise,
};
use crate::geometry::DVec2;
use crate::transition::{Sequence, Transition, TransitionStyle};

/// Number of thumbnails for a film of two designs: one at each design, and one at each tenth of t
/// between them (heuristic).
const THUMBNAILS_OF_PAIR: usize = 11;

/// Number of thumbnails for a film with this many segments: about as many as for one segment, but
/// at least one at each design.
#[must_use]
pub fn thumbnail_count(segments: usize) -> usize {
    segments * ((THUMBNAILS_OF_PAIR - 1) / segments.max(1)).max(1) + 1
}

/// Width and height of a thumbnail in pixels: twice its size on screen at scale factor 1.
pub const THUMBNAIL_PX: UVec2 = UVec2::new(144, 80);

/// Thumbnails of the film on the stage.
#[derive(Resource, Debug, Default)]
pub struct Filmstrip {
    of: Option<(Sequence, TransitionStyle)>,
    job: Option<BackgroundJob<RgbaImage, PixelSizeError>>,
    pictures: Option<Arc<RgbaImage>>,
}

impl Filmstrip {
    /// All thumbnails side by side, with straight alpha on a transparent background. Those of the
    /// previous film of the same designs are shown until the new ones are ready.
    #[must_use]
    pub fn pictures(&self) -> Option<&Arc<RgbaImage>> {
        self.pictures.as_ref()
    }

    /// Whether thumbnails are being drawn.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Whether the current thumbnails show other designs than those of the requested film.
    fn shows_other_designs(&self, requested: Option<&(Sequence, TransitionStyle)>) -> bool {
        let (Some((old, _)), Some((new, _)), Some(_)) = (&self.of, requested, &self.pictures)
        else {
            return false;
        };
        !names(old).eq(names(new))
    }

    /// Whether the thumbnails, or the job drawing them, show the requested film and colours.
    fn shows(&self, requested: Option<&(Sequence, TransitionStyle)>) -> bool {
        match (&self.of, requested) {
            (Some((old, before)), Some((new, style))) => old.is_same(new) && before == style,
            (None, None) => true,
            _ => false,
        }
    }
}

/// Names of the designs of a film, segment by segment. They identify the designs, because another
/// placement creates new design objects.
fn names(sequence: &Sequence) -> impl Iterator<Item = &str> {
    let designs = sequence.segments().iter().flat_map(Transition::designs);
    designs.map(|design| design.name.as_str())
}

/// Draws the thumbnails again in the background when the film or its colours have changed.
pub fn follow(
    session: Res<Session>,
    measures: Res<StageMeasures>,
    mut filmstrip: ResMut<Filmstrip>,
) {
    // Change detection is set by hand: this system runs each frame but seldom changes anything.
    let strip = filmstrip.bypass_change_detection();
    if let Some(Ok(pictures)) = BackgroundJob::take_result(&mut strip.job) {
        strip.pictures = Some(Arc::new(pictures));
        filmstrip.set_changed();
        return;
    }
    let requested = session.sequence().map(|all| (all, session.style()));
    if strip.shows_other_designs(requested.as_ref()) {
        strip.pictures = None;
        filmstrip.set_changed();
        return;
    }
    if strip.shows(requested.as_ref()) || session.work().is_some() || measures.is_busy() {
        return;
    }
    strip.of = requested;
    if strip.of.is_none() {
        strip.pictures = None;
    }
    // Replacing the job cancels the one for the previous film.
    strip.job = strip.of.clone().map(|(sequence, style)| {
        BackgroundJob::start("the filmstrip", move |_| {
            let times = even_times(
                0.0,
                sequence.end(),
                thumbnail_count(sequence.segments().len()),
            );
            draw_strip(&sequence, &style, &times, THUMBNAIL_PX)
        })
    });
}

/// Draws a film at the given values of t, side by side, each in a cell of `cell_px` pixels. The
/// image has straight alpha on a transparent background.
///
/// # Errors
/// The row of cells is larger than an image may be.
pub fn draw_strip(
    sequence: &Sequence,
    style: &TransitionStyle,
    times: &[f64],
    cell_px: UVec2,
) -> Result<RgbaImage, PixelSizeError> {
    let size = PixelSize::new(cell_px.x.saturating_mul(times.len() as u32), cell_px.y)?;
    // All cells show the same section of the plane, so that growth is visible.
    let bounds = framing(sequence, times);
    let cell = cell_px.as_dvec2();
    let mut drawing = Drawing::new(size, None);
    let mut frame = sequence.frame(0.0);
    for (index, t) in times.iter().enumerate() {
        frame.seek(*t);
        let corner = DVec2::new(index as f64 * cell.x, 0.0);
        let view = PlaneView::fit_cell(bounds, size, corner, cell);
        drawing.push_frame(frame.frame(), &frame.style(style), &view);
    }
    Ok(rasterise(&drawing))
}
