//! Small pictures of the film at every tenth of t, or so, and at each design, for the timeline.
//!
//! Drawn beside the window whenever another film, or one that looks otherwise, is on the stage, and
//! after it has been measured: the verdict is waited for, the pictures are not.

use std::sync::Arc;

use bevy::prelude::{DetectChangesMut, Res, ResMut, Resource};
use image::RgbaImage;

use crate::app::analysis::film_measures::StageMeasures;
use crate::app::jobs::job::BackgroundJob;
use crate::app::session::state::Session;
use crate::export::{
    Drawing, PixelSize, PixelSizeError, PlaneView, even_times, framing, rasterise,
};
use crate::geometry::DVec2;
use crate::transition::{Sequence, Transition, TransitionStyle};

/// How many pictures there are of a film of two designs: at both ends and at every tenth between
/// them.
const OF_A_PAIR: usize = 11;

/// How many there are of so many legs: about as many, one at each design among them.
#[must_use]
pub fn pictures(legs: usize) -> usize {
    legs * ((OF_A_PAIR - 1) / legs.max(1)).max(1) + 1
}

/// Width and height of each in pixels: twice what is shown at scale factor 1.
pub const PICTURE_PX: (u32, u32) = (144, 80);

/// The pictures of the film on the stage.
#[derive(Resource, Debug, Default)]
pub struct Filmstrip {
    of: Option<(Sequence, TransitionStyle)>,
    job: Option<BackgroundJob<RgbaImage, PixelSizeError>>,
    pictures: Option<Arc<RgbaImage>>,
}

impl Filmstrip {
    /// All pictures side by side, straight alpha on a transparent ground; those of the same
    /// designs' film before until the new ones are there.
    #[must_use]
    pub fn pictures(&self) -> Option<&Arc<RgbaImage>> {
        self.pictures.as_ref()
    }

    /// They are being drawn.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// The pictures there are show other designs.
    fn shows_others(&self, wanted: Option<&(Sequence, TransitionStyle)>) -> bool {
        let (Some((old, _)), Some((new, _)), Some(_)) = (&self.of, wanted, &self.pictures) else {
            return false;
        };
        !names(old).eq(names(new))
    }

    fn is_of(&self, wanted: Option<&(Sequence, TransitionStyle)>) -> bool {
        match (&self.of, wanted) {
            (Some((old, before)), Some((new, style))) => old.is(new) && before == style,
            (None, None) => true,
            _ => false,
        }
    }
}

/// What the designs of a film are called, leg by leg: by that they are told from others, as
/// another fit makes others of the same.
fn names(sequence: &Sequence) -> impl Iterator<Item = &str> {
    let designs = sequence.legs().iter().flat_map(Transition::designs);
    designs.map(|design| design.name.as_str())
}

/// Keeps the pictures of what is on the stage.
pub fn follow(
    session: Res<Session>,
    measured: Res<StageMeasures>,
    mut filmstrip: ResMut<Filmstrip>,
) {
    // Marked as changed by hand: it is looked at in each frame, and seldom new.
    let strip = filmstrip.bypass_change_detection();
    if let Some(Ok(pictures)) = BackgroundJob::take(&mut strip.job) {
        strip.pictures = Some(Arc::new(pictures));
        filmstrip.set_changed();
        return;
    }
    let wanted = session.sequence().map(|all| (all, session.style()));
    if strip.shows_others(wanted.as_ref()) {
        strip.pictures = None;
        filmstrip.set_changed();
        return;
    }
    if strip.is_of(wanted.as_ref()) || session.work().is_some() || measured.is_busy() {
        return;
    }
    strip.of = wanted;
    if strip.of.is_none() {
        strip.pictures = None;
    }
    // A job on the film before goes with it.
    strip.job = strip.of.clone().map(|(sequence, style)| {
        BackgroundJob::start("the filmstrip", move |_| {
            let times = even_times(0.0, sequence.end(), pictures(sequence.legs().len()));
            draw_strip(&sequence, &style, &times, PICTURE_PX)
        })
    });
}

/// Pictures of a film side by side, at each of some t, each of so many pixels; straight alpha on a
/// transparent ground.
///
/// # Errors
/// The row is larger than a picture can be.
pub fn draw_strip(
    sequence: &Sequence,
    style: &TransitionStyle,
    times: &[f64],
    (width, height): (u32, u32),
) -> Result<RgbaImage, PixelSizeError> {
    let size = PixelSize::new(width.saturating_mul(times.len() as u32), height)?;
    // One frame around all of them, so that what grows is seen to grow.
    let bounds = framing(sequence, times);
    let cell = DVec2::new(f64::from(width), f64::from(height));
    let mut drawing = Drawing::new(size, None);
    let mut frame = sequence.frame(0.0);
    for (index, t) in times.iter().enumerate() {
        frame.seek(*t);
        let corner = DVec2::new(index as f64 * cell.x, 0.0);
        let view = PlaneView::fit_cell(bounds, size, corner, cell);
        drawing.push_frame(frame.now(), &frame.style(style), &view);
    }
    Ok(rasterise(&drawing))
}
