//! Speaker window of a talk: elapsed time, notes and the next stop.
//!
//! If there is a second screen, the audience's window moves to it when a talk starts, and the
//! speaker window opens on the first screen. With one screen, the speaker window opens only on
//! request.

use std::sync::Arc;

use bevy::camera::RenderTarget;
use bevy::camera::visibility::RenderLayers;
use bevy::prelude::*;
use bevy::window::{
    Monitor, MonitorSelection, OnMonitor, PrimaryWindow, WindowCloseRequested, WindowMode,
    WindowPosition, WindowRef, WindowResolution,
};
use image::RgbaImage;

use crate::app::input::intent::Intent;
use crate::app::jobs::job::BackgroundJob;
use crate::app::playback::player::Playback;
use crate::app::presentation::presenter::Presentation;
use crate::app::session::state::Session;
use crate::colour::Rgb;
use crate::export::{Camera as FilmCamera, PixelSize, PixelSizeError, PlaneView};
use crate::transition::{Sequence, TransitionStyle};

/// Width and height of the image of the next stop, in pixels (heuristic).
const PICTURE_PX: (u32, u32) = (640, 360);

/// Camera of the speaker window.
#[derive(Component, Debug)]
pub struct SpeakerCamera;

/// The speaker window and its content.
#[derive(Resource, Debug, Default)]
pub struct SpeakerWindow {
    /// Entities of the window and of its camera; `None` while the window is closed.
    window: Option<(Entity, Entity)>,
    /// The film and the value of t that the image shows.
    shown: Option<(Sequence, f64)>,
    picture: Option<Arc<RgbaImage>>,
    job: Option<BackgroundJob<RgbaImage, PixelSizeError>>,
}

impl SpeakerWindow {
    /// Whether the window is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.window.is_some()
    }

    /// Whether `window` is the speaker window.
    #[must_use]
    pub fn owns_window(&self, window: Entity) -> bool {
        self.window.is_some_and(|(own, _)| own == window)
    }

    /// Image of the film at the next stop; `None` until it is drawn, and after the last stop.
    #[must_use]
    pub fn picture(&self) -> Option<Arc<RgbaImage>> {
        self.picture.clone()
    }
}

/// Opens and closes the speaker window.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut closing: MessageReader<WindowCloseRequested>,
    mut speaker: ResMut<SpeakerWindow>,
    presentation: Res<Presentation>,
    monitors: Query<Entity, With<Monitor>>,
    mut audience: Query<(&mut Window, Option<&OnMonitor>), With<PrimaryWindow>>,
    mut commands: Commands,
) {
    // `second` is the screen for the audience's window during a talk: any screen except the one on
    // which this window is now. Some systems do not report the screen of a window; then the speaker
    // window does not open by itself.
    let audience_screen = audience.single().ok().and_then(|(_, on)| Some(on?.0));
    let second = audience_screen.and_then(|first| monitors.iter().find(|screen| *screen != first));
    for intent in intents.read() {
        match intent {
            Intent::Present { .. } if presentation.is_active() && speaker.window.is_none() => {
                if let (Some(screen), Ok((mut window, _))) = (second, audience.single_mut()) {
                    let screen = MonitorSelection::Entity(screen);
                    window.mode = WindowMode::BorderlessFullscreen(screen);
                    speaker.window = Some(open(&mut commands, audience_screen));
                }
            }
            Intent::ToggleSpeaker if presentation.is_active() && speaker.window.is_none() => {
                speaker.window = Some(open(&mut commands, audience_screen));
            }
            Intent::ToggleSpeaker => close(&mut speaker, &mut commands),
            _ => {}
        }
    }
    let is_own = |request: &WindowCloseRequested| {
        speaker
            .window
            .is_some_and(|(window, _)| window == request.window)
    };
    let is_closed = closing.read().filter(|request| is_own(request)).count() > 0;
    if speaker.window.is_some() && (is_closed || !presentation.is_active()) {
        close(&mut speaker, &mut commands);
    }
}

/// Opens the speaker window on `screen`, or on the primary screen if it is `None`; returns the
/// window and its camera.
fn open(commands: &mut Commands, screen: Option<Entity>) -> (Entity, Entity) {
    let screen = screen.map_or(MonitorSelection::Primary, MonitorSelection::Entity);
    let window = Window {
        title: "Morphospace – Speaker".to_owned(),
        name: Some("morphospace".to_owned()),
        resolution: WindowResolution::new(960, 540),
        position: WindowPosition::Centered(screen),
        ..default()
    };
    let window = commands.spawn(window).id();
    let camera = commands.spawn((
        Camera2d,
        RenderTarget::Window(WindowRef::Entity(window)),
        // Draws only egui's panels, nothing of the stage.
        RenderLayers::none(),
        SpeakerCamera,
    ));
    (window, camera.id())
}

/// Closes the speaker window, if it is open, and drops the image of the next stop.
fn close(speaker: &mut SpeakerWindow, commands: &mut Commands) {
    if let Some((window, camera)) = speaker.window.take() {
        commands.entity(camera).despawn();
        commands.entity(window).despawn();
    }
    *speaker = SpeakerWindow::default();
}

/// While the speaker window is open, draws the film at the next stop in the background whenever the
/// film or that stop changes.
pub fn follow(mut speaker: ResMut<SpeakerWindow>, session: Res<Session>, playback: Res<Playback>) {
    if !speaker.is_open() {
        return;
    }
    // No system reacts to changes of this resource, so it is not marked as changed.
    let speaker = speaker.bypass_change_detection();
    if let Some(picture) = BackgroundJob::take_result(&mut speaker.job) {
        speaker.picture = picture.ok().map(Arc::new);
    }
    let next = playback.next_stop(session.timing(), session.stops());
    let next_shown = session.sequence().zip(next);
    let is_same = match (&next_shown, &speaker.shown) {
        (Some((new, t)), Some((old, shown))) => t == shown && new.is_same(old),
        (next_shown, shown) => next_shown.is_none() && shown.is_none(),
    };
    if is_same {
        return;
    }
    speaker.shown.clone_from(&next_shown);
    speaker.picture = None;
    let style = session.style();
    speaker.job = next_shown.map(|(sequence, t)| {
        BackgroundJob::start("the next stop", move |_| draw_next_stop(sequence, style, t))
    });
}

/// Draws an image of the film at `t`, the t of the next stop.
fn draw_next_stop(
    sequence: Sequence,
    style: TransitionStyle,
    t: f64,
) -> Result<RgbaImage, PixelSizeError> {
    let bounds = sequence.bounds();
    let padded = bounds.padded(0.04 * bounds.diameter());
    let view = PlaneView::fit(padded, PixelSize::new(PICTURE_PX.0, PICTURE_PX.1)?);
    let ground: Option<Rgb> = Some(style.ground);
    let camera = FilmCamera {
        sequence,
        style,
        view,
        ground,
        captions: None,
    };
    Ok(camera.pixels(t))
}
