//! Copies the stage to the clipboard, as an image or as SVG.

use arboard::{Clipboard, Error, ImageData};
use bevy::prelude::{MessageReader, NonSendMut, ResMut};
use image::RgbaImage;

use crate::app::capture::image_inputs::StageImageInputs;
use crate::app::input::intent::Intent;
use crate::app::notices::{NoticeTopic, Notices};
use crate::export::{Camera, PixelSize, PlaneView};

/// The system's clipboard, opened at the first copy. It then stays open, because on some systems
/// the copied content would be lost if it were closed.
#[derive(Default)]
pub struct SystemClipboard(Option<Clipboard>);

impl SystemClipboard {
    /// Applies `put` to the clipboard, opening it if needed.
    fn with_clipboard(
        &mut self,
        put: impl FnOnce(&mut Clipboard) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if self.0.is_none() {
            self.0 = Some(Clipboard::new()?);
        }
        self.0.as_mut().map_or(Ok(()), put)
    }

    /// Copies an image and reports the result as a notice.
    pub fn copy_image(&mut self, image: &RgbaImage, notices: &mut Notices) {
        let data = ImageData {
            width: image.width() as usize,
            height: image.height() as usize,
            bytes: image.as_raw().into(),
        };
        report(
            self.with_clipboard(|clipboard| clipboard.set_image(data)),
            "Image copied",
            notices,
        );
    }

    /// Copies an SVG document as text and reports the result as a notice.
    pub fn copy_text(&mut self, text: String, notices: &mut Notices) {
        report(
            self.with_clipboard(|clipboard| clipboard.set_text(text)),
            "SVG copied",
            notices,
        );
    }
}

/// Shows a notice that names the copied content (`done`) or the error.
fn report(result: Result<(), Error>, done: &str, notices: &mut Notices) {
    match result {
        Ok(()) => {
            notices.resolve(NoticeTopic::Picture);
            notices.confirm(format!("{done} to the clipboard"));
        }
        Err(error) => notices.problem(NoticeTopic::Picture, format!("Could not copy: {error}")),
    }
}

/// Copies the stage to the clipboard as an SVG document, unless the map is shown.
pub fn copy_svg(
    mut intents: MessageReader<Intent>,
    mut clipboard: NonSendMut<SystemClipboard>,
    mut notices: ResMut<Notices>,
    inputs: StageImageInputs,
) {
    let is_requested = |intent: &Intent| *intent == Intent::CopySvg && !inputs.map.is_shown;
    if intents.read().filter(|intent| is_requested(intent)).count() == 0 {
        return;
    }
    let Some(sequence) = inputs.session.sequence() else {
        return;
    };
    let style = inputs.session.style();
    let scale = f64::from(inputs.window.scale_factor());
    let px = (inputs.view.viewport_px.as_dvec2() * scale).round();
    let Ok(size) = PixelSize::new(px.x as u32, px.y as u32) else {
        return;
    };
    let camera = Camera {
        sequence,
        style,
        view: PlaneView::fit(inputs.view.visible(), size),
        ground: (!inputs.preferences.capture_transparent).then_some(style.ground),
        captions: None,
    };
    clipboard.copy_text(camera.svg(inputs.playback.t()), &mut notices);
}
