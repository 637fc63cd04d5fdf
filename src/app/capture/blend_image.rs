//! Saves or copies the blend under the map's marker, while the map is shown in place of the stage.
//! The export code draws the blend on the CPU, without the renderer of the window.

use bevy::prelude::{MessageReader, NonSendMut, Res, ResMut};

use crate::app::capture::clipboard::SystemClipboard;
use crate::app::capture::export_folder::ExportFolder;
use crate::app::capture::image::{ImageCaptures, size_px};
use crate::app::capture::image_inputs::StageImageInputs;
use crate::app::input::gesture::TextSelected;
use crate::app::input::intent::Intent;
use crate::app::notices::{NoticeTopic, Notices};
use crate::export::{PixelSize, to_svg};

/// Handles the intents to save or copy an image while the map is shown.
pub fn capture_blend(
    mut intents: MessageReader<Intent>,
    inputs: StageImageInputs,
    text_selected: Res<TextSelected>,
    folder: ExportFolder,
    mut captures: ResMut<ImageCaptures>,
    mut notices: ResMut<Notices>,
    mut clipboard: NonSendMut<SystemClipboard>,
) {
    for intent in intents.read() {
        let Some(pictures) = inputs.map.pictures().filter(|_| inputs.map.is_shown) else {
            continue;
        };
        let is_requested = match intent {
            Intent::Screenshot { with_panels } => !with_panels,
            Intent::CopyImage => !text_selected.0,
            Intent::CopySvg => true,
            _ => false,
        };
        if !is_requested {
            continue;
        }
        let image_px = size_px(
            &inputs.view,
            inputs.window.scale_factor(),
            inputs.preferences.capture_scale,
        );
        let size = match PixelSize::new(image_px.x, image_px.y) {
            Ok(size) => size,
            Err(error) => {
                notices.problem(NoticeTopic::Picture, error.to_string());
                continue;
            }
        };
        let style = inputs.session.style();
        let background = (!inputs.preferences.capture_transparent).then_some(style.ground);
        match intent {
            Intent::CopySvg => {
                let drawing = pictures.drawing(size, &style, background);
                clipboard.copy_text(to_svg(&drawing), &mut notices);
            }
            Intent::CopyImage => {
                let image = pictures.image(size, &style, background);
                clipboard.copy_image(&image, &mut notices);
            }
            _ => {
                let name = format!("{}-blend", inputs.session.file_stem());
                let image = pictures.image(size, &style, background);
                captures.write(folder.path(), &name, image.into());
            }
        }
    }
}
