//! Silhouettes that can be read from the pictures of the current segment, as small images between
//! which the user chooses. They are traced and drawn in the background.

use std::sync::Arc;

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};
use image::RgbaImage;

use crate::app::jobs::job::{BackgroundJob, JobTracker};
use crate::app::session::state::Session;
use crate::design::{
    Design, DesignForm, ImportOptions, Picture, PictureReading, SilhouetteError,
    silhouette_candidates,
};
use crate::export::{Drawing, PixelSize, PlaneView, rasterise};
use crate::geometry::Bounds;
use crate::project::DesignEntry;
use crate::transition::{TransitionStyle, VectorFigure};

/// Side of the small image of a silhouette, in pixels: twice its size on screen at scale factor 1.
const SIDE_PX: u32 = 128;

/// A silhouette that can be read from a picture, and its small image.
#[derive(Clone, Debug)]
pub struct ReadingChoice {
    /// Property of the pixels that separates figure and background.
    pub reading: PictureReading,
    /// The silhouette, with straight alpha on a transparent background.
    pub image: Arc<RgbaImage>,
}

/// A picture and the options of its import except for the reading, which together determine its
/// silhouettes.
#[derive(Clone, Debug)]
struct PictureKey {
    design: Arc<Design>,
    options: ImportOptions,
}

impl PictureKey {
    /// Key of a design; `None` if it is no picture or is read by its colours.
    fn of(design: &Arc<Design>, entry: &DesignEntry) -> Option<Self> {
        let is_silhouette = !entry.import.colours && design.picture.is_some();
        is_silhouette.then(|| Self {
            design: Arc::clone(design),
            options: ImportOptions {
                reading: PictureReading::Auto,
                ..entry.import
            },
        })
    }

    fn is_same(&self, other: &Self) -> bool {
        let pixels = |key: &Self| key.design.picture.as_ref().map(Picture::pixels).cloned();
        self.options == other.options
            && (Arc::ptr_eq(&self.design, &other.design) || pixels(self) == pixels(other))
    }
}

/// The choices for one picture.
#[derive(Debug)]
struct ChoicesOfPicture {
    key: PictureKey,
    job: Option<BackgroundJob<Vec<ReadingChoice>, SilhouetteError>>,
    choices: Vec<ReadingChoice>,
}

/// The choices for the pictures of the current segment.
#[derive(Resource, Debug, Default)]
pub struct PictureReadings(Vec<ChoicesOfPicture>);

impl PictureReadings {
    /// Silhouettes between which the user can choose for this design, the automatic one first;
    /// empty if there is no choice.
    #[must_use]
    pub fn choices(&self, design: &Arc<Design>) -> &[ReadingChoice] {
        let of_design = |of: &&ChoicesOfPicture| Arc::ptr_eq(&of.key.design, design);
        let choices = self.0.iter().find(of_design).map(|of| &of.choices[..]);
        choices
            .filter(|choices| choices.len() > 1)
            .unwrap_or_default()
    }

    /// Whether silhouettes are being traced.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.0.iter().any(|of| of.job.is_some())
    }
}

/// Starts tracing the pictures of a new segment, and collects the results.
pub fn follow(session: Res<Session>, mut readings: ResMut<PictureReadings>) {
    // This system runs in every screen update; only new results count as a change.
    let now = readings.bypass_change_detection();
    if session.is_changed() {
        now.adopt(&session);
    }
    let mut is_new = false;
    for of in &mut now.0 {
        if let Some(result) = BackgroundJob::take_result(&mut of.job) {
            of.choices = result.unwrap_or_default();
            is_new = true;
        }
    }
    if is_new {
        readings.set_changed();
    }
}

impl PictureReadings {
    /// Switches to the pictures of the current segment.
    fn adopt(&mut self, session: &Session) {
        let Some(project) = session.project() else {
            self.0.clear();
            return;
        };
        let designs = session.designs().into_iter().zip(&project.designs);
        let keys = designs.filter_map(|(design, entry)| PictureKey::of(design, entry));
        let mut before = std::mem::take(&mut self.0);
        for key in keys {
            let known = before.iter().position(|of| of.key.is_same(&key));
            let of = match known.map(|index| before.swap_remove(index)) {
                Some(known) => ChoicesOfPicture { key, ..known },
                None => ChoicesOfPicture::start(key),
            };
            self.0.push(of);
        }
    }
}

impl ChoicesOfPicture {
    fn start(key: PictureKey) -> Self {
        let traced = key.clone();
        let trace = move |_: &JobTracker| draw_choices(&traced);
        Self {
            job: Some(BackgroundJob::start("the silhouettes", trace)),
            choices: Vec::new(),
            key,
        }
    }
}

/// Traces and draws the silhouettes of a picture.
fn draw_choices(key: &PictureKey) -> Result<Vec<ReadingChoice>, SilhouetteError> {
    let Some(picture) = &key.design.picture else {
        return Ok(Vec::new());
    };
    let candidates = silhouette_candidates(picture.pixels(), &key.options)?;
    let drawn = candidates.into_iter().filter_map(|candidate| {
        let silhouette = Design {
            form: DesignForm::Outline(candidate.regions),
            paint_layers: Vec::new(),
            ..Design::clone(&key.design)
        };
        Some(ReadingChoice {
            reading: candidate.reading,
            image: Arc::new(draw(&silhouette)?),
        })
    });
    Ok(drawn.collect())
}

/// Draws a silhouette; `None` if the image would have no pixels.
fn draw(silhouette: &Design) -> Option<RgbaImage> {
    let size = PixelSize::new(SIDE_PX, SIDE_PX).ok()?;
    let figure = VectorFigure::of(silhouette, 0.0);
    let points = figure.rings.iter().flatten().copied();
    let view = PlaneView::fit(Bounds::of(points)?, size);
    let mut drawing = Drawing::new(size, None);
    drawing.push_figure(&figure, 0.0, &TransitionStyle::default(), &view);
    Some(rasterise(&drawing))
}
