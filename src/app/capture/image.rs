//! Saves images of the stage and of the whole window to files, and copies those of the stage to the
//! clipboard.
//!
//! The graphics card renders an image; a background job encodes and writes it, and a notice reports
//! the result. Existing files are never overwritten.

use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use image::{DynamicImage, ImageError, ImageFormat};

use crate::app::capture::clipboard::SystemClipboard;
use crate::app::capture::export_folder::ExportFolder;
use crate::app::capture::image_inputs::StageImageInputs;
use crate::app::input::gesture::TextSelected;
use crate::app::input::intent::Intent;
use crate::app::input::preferences::ImageScale;
use crate::app::jobs::job::BackgroundJob;
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::{CreateFileError, create_new, keep_if_written};
use crate::stage::{CaptureStage, StageCaptured, StageView};

/// Longer side of a 4K image, in pixels.
const FOUR_K_PX: f32 = 3840.0;

/// Images being rendered or written.
#[derive(Resource, Debug, Default)]
pub struct ImageCaptures {
    next_id: u64,
    awaited: HashMap<u64, ImageDestination>,
    writing: Vec<BackgroundJob<PathBuf, SaveImageError>>,
}

/// Destination of a rendered image of the stage.
#[derive(Debug)]
enum ImageDestination {
    /// A new file with this name.
    File(String),
    /// The clipboard.
    Clipboard,
}

/// Reason why an image was not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveImageError {
    /// The file could not be created.
    #[error(transparent)]
    File(#[from] CreateFileError),
    /// The image could not be encoded or written.
    #[error("cannot write {}: {error}", path.display())]
    Write {
        /// Path of the file.
        path: PathBuf,
        /// Reason why the image could not be encoded or written.
        error: ImageError,
    },
}

/// Requests images of the stage or of the window from the renderer when the user asks for them.
pub fn request_images(
    mut intents: MessageReader<Intent>,
    mut captures: ResMut<ImageCaptures>,
    mut requests: MessageWriter<CaptureStage>,
    mut commands: Commands,
    inputs: StageImageInputs,
    text_selected: Res<TextSelected>,
) {
    for intent in intents.read() {
        // The file is named now, because the image arrives some screen updates later, when t may
        // have changed.
        let name = format!("{}-t{:.3}", inputs.session.file_stem(), inputs.playback.t());
        let destination = match intent {
            Intent::Screenshot { with_panels: true } => {
                commands
                    .spawn(Screenshot::primary_window())
                    .observe(window_captured(name));
                continue;
            }
            // While the map is shown, `blend_image` handles this intent.
            _ if inputs.map.is_shown => continue,
            Intent::Screenshot { with_panels: false } => ImageDestination::File(name),
            Intent::CopyImage if !text_selected.0 => ImageDestination::Clipboard,
            _ => continue,
        };
        let Some(project) = inputs.session.project() else {
            continue;
        };
        captures.next_id += 1;
        let id = captures.next_id;
        captures.awaited.insert(id, destination);
        requests.write(CaptureStage {
            id,
            size_px: size_px(
                &inputs.view,
                inputs.window.scale_factor(),
                inputs.preferences.capture_scale,
            ),
            ground: (!inputs.preferences.capture_transparent).then_some(project.style.ground),
            view: inputs.view.visible(),
        });
    }
}

/// Width and height, in pixels, of an image of the visible stage.
pub fn size_px(view: &StageView, scale_factor: f32, scale: ImageScale) -> UVec2 {
    let on_screen = view.viewport_px * scale_factor;
    let factor = match scale {
        ImageScale::One => 1.0,
        ImageScale::Two => 2.0,
        ImageScale::FourK => FOUR_K_PX / on_screen.max_element().max(1.0),
    };
    (on_screen * factor).round().as_uvec2().max(UVec2::ONE)
}

/// Returns an observer that saves the captured image of the window under this name.
fn window_captured(
    name: String,
) -> impl FnMut(On<ScreenshotCaptured>, ResMut<ImageCaptures>, ResMut<Notices>, ExportFolder) {
    move |captured, mut captures, mut notices, folder| match captured
        .image
        .clone()
        .try_into_dynamic()
    {
        // The alpha channel of a window has no meaning in an image file.
        Ok(image) => captures.write(folder.path(), &name, image.to_rgb8().into()),
        Err(error) => notices.problem(
            NoticeTopic::Picture,
            format!("Could not capture the window: {error}"),
        ),
    }
}

impl ImageCaptures {
    /// Whether an image is still being rendered. Until then, the window must keep redrawing.
    pub fn is_rendering(&self) -> bool {
        !self.awaited.is_empty()
    }

    /// Whether an image is being written.
    pub fn is_writing(&self) -> bool {
        !self.writing.is_empty()
    }

    /// Writes an image with this name to the folder, in the background.
    pub fn write(&mut self, folder: PathBuf, name: &str, image: DynamicImage) {
        let name = name.to_owned();
        self.writing
            .push(BackgroundJob::start("the image", move |_| {
                save(&folder, &name, &image)
            }));
    }
}

/// Encodes an image as PNG and writes it to a new file.
fn save(folder: &Path, name: &str, image: &DynamicImage) -> Result<PathBuf, SaveImageError> {
    // Encoded before the file is created, so that the file is incomplete only for a moment.
    let mut encoded = std::io::Cursor::new(Vec::new());
    let encoding = image.write_to(&mut encoded, ImageFormat::Png);
    let (mut file, path) = create_new(folder, name, "png")?;
    let written = encoding.and_then(|()| Ok(file.write_all(encoded.get_ref())?));
    let written = written.map_err(|error| {
        let path = path.clone();
        SaveImageError::Write { path, error }
    });
    keep_if_written(path, written)
}

/// Receives rendered images of the stage and passes each to its file or to the clipboard.
pub fn receive(
    mut answers: MessageReader<StageCaptured>,
    mut captures: ResMut<ImageCaptures>,
    mut notices: ResMut<Notices>,
    mut clipboard: NonSendMut<SystemClipboard>,
    folder: ExportFolder,
) {
    for answer in answers.read() {
        let Some(destination) = captures.awaited.remove(&answer.id) else {
            continue;
        };
        match (&answer.result, destination) {
            (Ok(image), ImageDestination::File(name)) => {
                captures.write(folder.path(), &name, image.clone().into())
            }
            (Ok(image), ImageDestination::Clipboard) => clipboard.copy_image(image, &mut notices),
            (Err(error), _) => notices.problem(NoticeTopic::Picture, error.clone()),
        }
    }
}

/// Reports images that were saved and errors in saving.
pub fn report(mut captures: ResMut<ImageCaptures>, mut notices: ResMut<Notices>) {
    captures.bypass_change_detection().writing.retain(|job| {
        match job.poll() {
            None => return true,
            Some(Ok(path)) => {
                notices.resolve(NoticeTopic::Picture);
                notices.file_written(path);
            }
            Some(Err(error)) => notices.problem(NoticeTopic::Picture, error.to_string()),
        }
        false
    });
}
