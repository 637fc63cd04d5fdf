//! Preview of the selected file in the file dialog, drawn in the background.

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

/// Width and height of the preview in pixels: twice its size on screen at scale factor 1.
pub const PREVIEW_PX: (u32, u32) = (352, 352);

/// Maximum number of designs in the preview of a project (heuristic: more would be too small).
const MAX_DESIGNS: usize = 4;

/// Margin around each design, as a fraction of its diameter (heuristic).
const MARGIN: f64 = 0.05;

/// The file being previewed, and its preview once it is ready.
#[derive(Resource, Debug, Default)]
pub struct FilePreview {
    path: Option<PathBuf>,
    job: Option<BackgroundJob<RgbaImage, FilePreviewError>>,
    picture: Option<Result<Arc<RgbaImage>, String>>,
}

/// Reason why a file has no preview.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct FilePreviewError(String);

impl FilePreview {
    /// Preview of a file, with straight alpha on a transparent background, or the reason why it has
    /// none; `None` until the preview is ready.
    #[must_use]
    pub fn of(&self, path: &Path) -> Option<Result<&Arc<RgbaImage>, &str>> {
        let is_it = self.path.as_deref() == Some(path);
        let picture = self.picture.as_ref().filter(|_| is_it)?;
        Some(picture.as_ref().map_err(String::as_str))
    }

    /// Whether this file is the one being previewed, even if its preview is not ready yet.
    #[must_use]
    pub fn is_for(&self, path: &Path) -> bool {
        self.path.as_deref() == Some(path)
    }
}

/// Draws the preview in the background, and discards it when the dialog closes.
pub fn follow(
    mut intents: MessageReader<Intent>,
    dialog: Res<FileDialogRequest>,
    mut preview: ResMut<FilePreview>,
) {
    let requested = intents.read().filter_map(|intent| match intent {
        Intent::PreviewFile(path) => Some(path),
        _ => None,
    });
    // This system runs in every screen update; only a new preview counts as a change.
    let now = preview.bypass_change_detection();
    if let Some(path) = requested.last()
        && now.path.as_ref() != Some(path)
    {
        let file = path.clone();
        *now = FilePreview {
            path: Some(path.clone()),
            job: Some(BackgroundJob::start("the preview", move |_| {
                draw_preview(&file)
            })),
            picture: None,
        };
    }
    if let Some(answer) = BackgroundJob::take_result(&mut now.job) {
        now.picture = Some(answer.map(Arc::new).map_err(|error| error.to_string()));
        preview.set_changed();
    } else if dialog.purpose().is_none() && now.path.is_some() {
        *now = FilePreview::default();
    }
}

/// Draws the preview of a project or design file.
fn draw_preview(path: &Path) -> Result<RgbaImage, FilePreviewError> {
    let preview_error = |error: &dyn std::error::Error| FilePreviewError(error.to_string());
    let designs = if Project::has_document_extension(path) {
        let loaded = LoadedProject::open(path).map_err(|error| preview_error(&error))?;
        loaded.designs.into_iter().take(MAX_DESIGNS).collect()
    } else {
        let options = ImportOptions::default();
        vec![Arc::new(
            import_file(path, &options).map_err(|error| preview_error(&error))?,
        )]
    };
    if let [design] = designs.as_slice()
        && let Some(picture) = &design.picture
    {
        return Ok(scale_to_preview(picture.pixels()));
    }
    side_by_side(&designs).map_err(|error| preview_error(&error))
}

/// Scales an image down to fit into the preview; smaller images keep their size.
fn scale_to_preview(pixels: &RgbaImage) -> RgbaImage {
    let (width, height) = pixels.dimensions();
    let ratio = |px: u32, max_px: u32| f64::from(max_px) / f64::from(px.max(1));
    let scale = ratio(width, PREVIEW_PX.0)
        .min(ratio(height, PREVIEW_PX.1))
        .min(1.0);
    let side = |px: u32| ((f64::from(px) * scale) as u32).max(1);
    image::imageops::thumbnail(pixels, side(width), side(height))
}

/// Draws designs next to each other, in an image of the size of the preview.
fn side_by_side(designs: &[Arc<Design>]) -> Result<RgbaImage, crate::export::PixelSizeError> {
    let size = PixelSize::new(PREVIEW_PX.0, PREVIEW_PX.1)?;
    let cell = DVec2::new(
        f64::from(PREVIEW_PX.0) / designs.len().max(1) as f64,
        f64::from(PREVIEW_PX.1),
    );
    let style = TransitionStyle::default();
    let mut drawing = Drawing::new(size, None);
    for (index, design) in designs.iter().enumerate() {
        let bounds = design.extent.padded(MARGIN * design.extent.diameter());
        let corner = DVec2::new(index as f64 * cell.x, 0.0);
        let view = PlaneView::fit_cell(bounds, size, corner, cell);
        // The first design has the source's colour, the last one the target's.
        let t = index as f64 / (designs.len().max(2) - 1) as f64;
        drawing.push_figure(&VectorFigure::of(design, t), t, &style, &view);
    }
    Ok(rasterise(&drawing))
}
