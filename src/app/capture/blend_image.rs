//! Saves or copies the blend under the map's marker, while the map is shown in place of the stage.
//! Drawn by the export code on the CPU, so no rendered frame is needed.

use bevy::prelude::{MessageReader, NonSendMut, Res, ResMut, Single, With};
use bevy::window::{PrimaryWindow, Window};

use crate::app::capture::clipboard::SystemClipboard;
use crate::app::capture::image::{ImageCaptures, size_px};
use crate::app::input::gesture::TextSelected;
use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::map::map_view::MapView;
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::CaptureFolder;
use crate::app::session::state::Session;
use crate::export::{PixelSize, rasterise, to_svg};
use crate::stage::StageView;

/// Everything that determines the image and its resolution.
type BlendImageInputs<'w> = (
    Res<'w, MapView>,
    Res<'w, Session>,
    Res<'w, Preferences>,
    Res<'w, StageView>,
);

/// Takes over image intents while the map is shown.
pub fn take(
    mut intents: MessageReader<Intent>,
    (map, session, preferences, view): BlendImageInputs,
    window: Single<&Window, With<PrimaryWindow>>,
    (marked, folder): (Res<TextSelected>, Res<CaptureFolder>),
    (mut captures, mut notices): (ResMut<ImageCaptures>, ResMut<Notices>),
    mut clipboard: NonSendMut<SystemClipboard>,
) {
    for intent in intents.read() {
        let Some(made) = map.made().filter(|_| map.is_shown) else {
            continue;
        };
        let is_asked = match intent {
            Intent::Screenshot { with_panels } => !with_panels,
            Intent::CopyPicture => !marked.0,
            Intent::CopyShapes => true,
            _ => false,
        };
        if !is_asked {
            continue;
        }
        let wanted = size_px(&view, window.scale_factor(), preferences.capture_scale);
        let size = match PixelSize::new(wanted.x, wanted.y) {
            Ok(size) => size,
            Err(error) => {
                notices.problem(NoticeTopic::Picture, error.to_string());
                continue;
            }
        };
        let style = session.style();
        let ground = (!preferences.capture_transparent).then_some(style.ground);
        let drawing = made.drawing(size, &style, ground);
        match intent {
            Intent::CopyShapes => clipboard.text(to_svg(&drawing), &mut notices),
            Intent::CopyPicture => clipboard.picture(&rasterise(&drawing), &mut notices),
            _ => {
                let name = format!("{}-blend", session.file_stem());
                captures.write(&folder, &name, rasterise(&drawing).into());
            }
        }
    }
}
