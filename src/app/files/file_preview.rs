//! What a file holds, in a small picture, before it is opened.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource};
use image::RgbaImage;

use crate::app::files::file_dialog::FileDialogRequest;
use crate::app::input::intent::Intent;
use crate::app::jobs::job::BackgroundJob;
use crate::design::{Design, ImportOptions, import_file};
use crate::export::{Drawing, PixelSize, PlaneView, rasterise};
use crate::geometry::DVec2;
use crate::project::{LoadedProject, Project};
use crate::transition::{TransitionStyle, VectorFigure};

/// Width and height in pixels: twice what is shown at scale factor 1.
pub const PREVIEW_PX: (u32, u32) = (352, 352);

/// So many designs of a project are shown: more are too small.
const MOST: usize = 4;

/// Room around each design, a share of the picture.
const ROOM: f64 = 0.05;

/// The file that is looked at.
#[derive(Resource, Debug, Default)]
pub struct FilePreview {
    path: Option<PathBuf>,
    job: Option<BackgroundJob<RgbaImage, FilePreviewError>>,
    picture: Option<Result<Arc<RgbaImage>, String>>,
}

/// Why there is nothing to see.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct FilePreviewError(String);

impl FilePreview {
    /// What a file holds, straight alpha on a transparent ground, or why it cannot be shown; none
    /// while it is not known.
    #[must_use]
    pub fn of(&self, path: &Path) -> Option<Result<&Arc<RgbaImage>, &str>> {
        let is_it = self.path.as_deref() == Some(path);
        let picture = self.picture.as_ref().filter(|_| is_it)?;
        Some(picture.as_ref().map_err(String::as_str))
    }

    /// It is of this file.
    #[must_use]
    pub fn is_for(&self, path: &Path) -> bool {
        self.path.as_deref() == Some(path)
    }
}

/// Draws what is looked at, beside the window, and forgets it with the dialog.
pub fn follow(
    mut intents: MessageReader<Intent>,
    dialog: Res<FileDialogRequest>,
    mut preview: ResMut<FilePreview>,
) {
    let wanted = intents.read().filter_map(|intent| match intent {
        Intent::LookAt(path) => Some(path),
        _ => None,
    });
    // In each frame, and seldom anything new.
    let now = preview.bypass_change_detection();
    if let Some(path) = wanted.last()
        && now.path.as_ref() != Some(path)
    {
        let file = path.clone();
        *now = FilePreview {
            path: Some(path.clone()),
            job: Some(BackgroundJob::start("a preview", move |_| drawn(&file))),
            picture: None,
        };
    }
    if let Some(answer) = BackgroundJob::take(&mut now.job) {
        now.picture = Some(answer.map(Arc::new).map_err(|error| error.to_string()));
        preview.set_changed();
    } else if dialog.asks().is_none() && now.path.is_some() {
        *now = FilePreview::default();
    }
}

fn drawn(path: &Path) -> Result<RgbaImage, FilePreviewError> {
    let why = |error: &dyn std::error::Error| FilePreviewError(error.to_string());
    let designs = if Project::is_named(path) {
        let loaded = LoadedProject::open(path).map_err(|error| why(&error))?;
        loaded.designs.into_iter().take(MOST).collect()
    } else {
        let options = ImportOptions::default();
        vec![Arc::new(
            import_file(path, &options).map_err(|error| why(&error))?,
        )]
    };
    if let [design] = designs.as_slice()
        && let Some(picture) = &design.picture
    {
        return Ok(small(picture.pixels()));
    }
    side_by_side(&designs).map_err(|error| why(&error))
}

fn small(pixels: &RgbaImage) -> RgbaImage {
    let (width, height) = pixels.dimensions();
    let share = |px: u32, most: u32| f64::from(most) / f64::from(px.max(1));
    let scale = share(width, PREVIEW_PX.0)
        .min(share(height, PREVIEW_PX.1))
        .min(1.0);
    let side = |px: u32| ((f64::from(px) * scale) as u32).max(1);
    image::imageops::thumbnail(pixels, side(width), side(height))
}

fn side_by_side(designs: &[Arc<Design>]) -> Result<RgbaImage, crate::export::PixelSizeError> {
    let size = PixelSize::new(PREVIEW_PX.0, PREVIEW_PX.1)?;
    let cell = DVec2::new(
        f64::from(PREVIEW_PX.0) / designs.len().max(1) as f64,
        f64::from(PREVIEW_PX.1),
    );
    let style = TransitionStyle::default();
    let mut drawing = Drawing::new(size, None);
    for (index, design) in designs.iter().enumerate() {
        let bounds = design.extent.padded(ROOM * design.extent.diameter());
        let corner = DVec2::new(index as f64 * cell.x, 0.0);
        let view = PlaneView::fit_cell(bounds, size, corner, cell);
        // In the colour that it has as source, or as target.
        let t = index as f64 / (designs.len().max(2) - 1) as f64;
        drawing.push_figure(&VectorFigure::of(design, t), t, &style, &view);
    }
    Ok(rasterise(&drawing))
}
