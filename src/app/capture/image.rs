//! Pictures of the stage and of the whole window.
//!
//! A picture is drawn by the graphics card, encoded and written on a thread of its own; that it
//! was written, or why not, is said on screen. Nothing is ever overwritten.

use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::window::PrimaryWindow;
use image::{DynamicImage, ImageError, ImageFormat};

use crate::app::capture::clipboard::SystemClipboard;
use crate::app::input::gesture::TextSelected;
use crate::app::input::intent::Intent;
use crate::app::input::preferences::{ImageScale, Preferences};
use crate::app::jobs::job::BackgroundJob;
use crate::app::map::map_view::MapView;
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::{CaptureFolder, CreateFileError, create_new, keep_if_written};
use crate::app::playback::player::Playback;
use crate::app::session::state::Session;
use crate::stage::{CaptureStage, StageCaptured, StageView};

/// The longer side of a 4K picture in pixels.
const FOUR_K_PX: f32 = 3840.0;

/// Pictures that are being taken or written.
#[derive(Resource, Debug, Default)]
pub struct ImageCaptures {
    next_id: u64,
    awaited: HashMap<u64, ImageDestination>,
    writing: Vec<BackgroundJob<PathBuf, SaveImageError>>,
}

/// Where a picture of the stage goes.
#[derive(Debug)]
enum ImageDestination {
    /// To a file of this name.
    File(String),
    /// To the clipboard.
    Board,
}

/// Why a picture was not written.
#[derive(Debug, thiserror::Error)]
pub enum SaveImageError {
    /// No file could be made for it.
    #[error(transparent)]
    File(#[from] CreateFileError),
    /// It could not be encoded or written.
    #[error("{} was not written: {error}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        error: ImageError,
    },
}

/// Asks the stage, or the window, for a picture.
pub fn ask(
    mut intents: MessageReader<Intent>,
    mut captures: ResMut<ImageCaptures>,
    mut requests: MessageWriter<CaptureStage>,
    mut commands: Commands,
    (session, playback, preferences): (Res<Session>, Res<Playback>, Res<Preferences>),
    (marked, map): (Res<TextSelected>, Res<MapView>),
    (view, window): (Res<StageView>, Single<&Window, With<PrimaryWindow>>),
) {
    for intent in intents.read() {
        // Named now: the picture comes some frames later, when t has moved on.
        let name = format!("{}-t{:.3}", session.file_stem(), playback.t());
        let wish = match intent {
            Intent::Screenshot { with_panels: true } => {
                commands
                    .spawn(Screenshot::primary_window())
                    .observe(window_captured(name));
                continue;
            }
            // Of the blend there: see `blends`.
            _ if map.is_shown => continue,
            Intent::Screenshot { with_panels: false } => ImageDestination::File(name),
            Intent::CopyPicture if !marked.0 => ImageDestination::Board,
            _ => continue,
        };
        let Some(project) = session.project() else {
            continue;
        };
        captures.next_id += 1;
        let id = captures.next_id;
        captures.awaited.insert(id, wish);
        requests.write(CaptureStage {
            id,
            size_px: size_px(&view, window.scale_factor(), preferences.capture_scale),
            ground: (!preferences.capture_transparent).then_some(project.style.ground),
            view: view.visible(),
        });
    }
}

/// How many pixels a picture of what is seen has.
pub fn size_px(view: &StageView, scale_factor: f32, scale: ImageScale) -> UVec2 {
    let on_screen = view.viewport_px * scale_factor;
    let factor = match scale {
        ImageScale::One => 1.0,
        ImageScale::Two => 2.0,
        ImageScale::FourK => FOUR_K_PX / on_screen.max_element().max(1.0),
    };
    (on_screen * factor).round().as_uvec2().max(UVec2::ONE)
}

fn window_captured(
    name: String,
) -> impl FnMut(On<ScreenshotCaptured>, ResMut<ImageCaptures>, ResMut<Notices>, Res<CaptureFolder>)
{
    move |captured, mut captures, mut notices, folder| match captured
        .image
        .clone()
        .try_into_dynamic()
    {
        // The alpha of a window says nothing about what is seen in it.
        Ok(image) => captures.write(&folder, &name, image.to_rgb8().into()),
        Err(error) => notices.problem(
            NoticeTopic::Picture,
            format!("The picture of the window was not taken: {error}"),
        ),
    }
}

impl ImageCaptures {
    /// A picture of the stage is awaited, which takes frames.
    pub fn is_awaited(&self) -> bool {
        !self.awaited.is_empty()
    }

    /// A picture is being written.
    pub fn is_writing(&self) -> bool {
        !self.writing.is_empty()
    }

    /// Writes a picture of this name into the folder, beside the window.
    pub fn write(&mut self, folder: &CaptureFolder, name: &str, image: DynamicImage) {
        let (folder, name) = (folder.0.clone(), name.to_owned());
        self.writing
            .push(BackgroundJob::start("a picture", move |_| {
                save(&folder, &name, &image)
            }));
    }
}

fn save(folder: &Path, name: &str, image: &DynamicImage) -> Result<PathBuf, SaveImageError> {
    // Encoded first: from its first moment to its last, the file is there for a moment only.
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

/// Takes pictures from the stage.
pub fn receive(
    mut answers: MessageReader<StageCaptured>,
    mut captures: ResMut<ImageCaptures>,
    mut notices: ResMut<Notices>,
    mut board: NonSendMut<SystemClipboard>,
    folder: Res<CaptureFolder>,
) {
    for answer in answers.read() {
        let Some(wish) = captures.awaited.remove(&answer.id) else {
            continue;
        };
        match (&answer.result, wish) {
            (Ok(image), ImageDestination::File(name)) => {
                captures.write(&folder, &name, image.clone().into())
            }
            (Ok(image), ImageDestination::Board) => board.picture(image, &mut notices),
            (Err(error), _) => notices.problem(NoticeTopic::Picture, error.clone()),
        }
    }
}

/// Says what was written.
pub fn report(mut captures: ResMut<ImageCaptures>, mut notices: ResMut<Notices>) {
    captures.bypass_change_detection().writing.retain(|job| {
        match job.poll() {
            None => return true,
            Some(Ok(path)) => {
                notices.well(NoticeTopic::Picture);
                notices.wrote(path);
            }
            Some(Err(error)) => notices.problem(NoticeTopic::Picture, error.to_string()),
        }
        false
    });
}
