//! Copies the stage to the clipboard, as an image or as SVG.

use arboard::{Clipboard, Error, ImageData};
use bevy::prelude::{MessageReader, NonSendMut, Res, ResMut, Single, With};
use bevy::window::{PrimaryWindow, Window};
use image::RgbaImage;

use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::map::map_view::MapView;
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::playback::player::Playback;
use crate::app::session::state::Session;
use crate::export::{Camera, PixelSize, PlaneView};
use crate::stage::StageView;

/// The system's clipboard, opened at the first copy. It must stay open: on some systems the content
/// is lost with the program that copied it.
#[derive(Default)]
pub struct SystemClipboard(Option<Clipboard>);

impl SystemClipboard {
    /// Applies `put` to the clipboard, opening it if needed.
    fn with(&mut self, put: impl FnOnce(&mut Clipboard) -> Result<(), Error>) -> Result<(), Error> {
        if self.0.is_none() {
            self.0 = Some(Clipboard::new()?);
        }
        self.0.as_mut().map_or(Ok(()), put)
    }

    /// Copies an image and reports it.
    pub fn picture(&mut self, image: &RgbaImage, notices: &mut Notices) {
        let picture = ImageData {
            width: image.width() as usize,
            height: image.height() as usize,
            bytes: image.as_raw().into(),
        };
        report(
            self.with(|clipboard| clipboard.set_image(picture)),
            "Image copied",
            notices,
        );
    }

    /// Copies an SVG document as text and reports it.
    pub fn text(&mut self, text: String, notices: &mut Notices) {
        report(
            self.with(|clipboard| clipboard.set_text(text)),
            "SVG copied",
            notices,
        );
    }
}

/// Reports whether copying succeeded.
fn report(result: Result<(), Error>, done: &str, notices: &mut Notices) {
    match result {
        Ok(()) => {
            notices.well(NoticeTopic::Picture);
            notices.done(format!("{done} to the clipboard"));
        }
        Err(error) => notices.problem(NoticeTopic::Picture, format!("Could not copy: {error}")),
    }
}

/// Copies the stage as an SVG document.
pub fn copy_shapes(
    mut intents: MessageReader<Intent>,
    mut clipboard: NonSendMut<SystemClipboard>,
    mut notices: ResMut<Notices>,
    (session, playback, preferences): (Res<Session>, Res<Playback>, Res<Preferences>),
    map: Res<MapView>,
    (view, window): (Res<StageView>, Single<&Window, With<PrimaryWindow>>),
) {
    let is_asked = |intent: &Intent| *intent == Intent::CopyShapes && !map.is_shown;
    if intents.read().filter(|intent| is_asked(intent)).count() == 0 {
        return;
    }
    let Some(sequence) = session.sequence() else {
        return;
    };
    let style = session.style();
    let px = (view.viewport_px.as_dvec2() * f64::from(window.scale_factor())).round();
    let Ok(size) = PixelSize::new(px.x as u32, px.y as u32) else {
        return;
    };
    let camera = Camera {
        sequence,
        style,
        view: PlaneView::fit(view.visible(), size),
        ground: (!preferences.capture_transparent).then_some(style.ground),
        captions: None,
    };
    clipboard.text(camera.svg(playback.t()), &mut notices);
}
