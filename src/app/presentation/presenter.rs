//! Talks: the transition in full screen, from stop to stop.
//!
//! During a talk the panels are hidden and only the keys of a talk work, so that nothing else can
//! appear before an audience. If the film has one segment, the talk starts at the first stop,
//! otherwise at the start of the film.

use std::time::{Duration, Instant};

use bevy::prelude::{
    Commands, DetectChangesMut, MessageReader, MessageWriter, Query, Real, Res, ResMut, Resource,
    Time, With,
};
use bevy::window::{
    CursorMoved, CursorOptions, MonitorSelection, PrimaryWindow, Window, WindowMode,
};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::playback::player::{Playback, first_stop};
use crate::app::session::state::Session;
use crate::app::tool_views::ToolViews;
use crate::export::Captions;

/// Seconds after which the pointer is hidden if it does not move (heuristic).
const POINTER_SECS: f32 = 1.0;

/// The talk in progress, if any.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Presentation {
    talk: Option<ActiveTalk>,
}

/// A talk in progress.
#[derive(Clone, Debug, PartialEq)]
struct ActiveTalk {
    /// Whether the talk is all that the program was started for; the window closes when it ends.
    is_all: bool,
    /// Whether t has been moved to the place where the talk starts; false until a film is built.
    has_begun: bool,
    is_black: bool,
    /// The user's choice whether captions are shown. `None` if the user has not chosen; captions
    /// are then shown if a stop has a name.
    captions: Option<bool>,
    began: Instant,
    /// Seconds since the pointer last moved.
    idle_secs: f32,
    /// Preferences and window mode to restore after the talk.
    before: (Preferences, Option<WindowMode>),
}

impl Presentation {
    /// Whether a talk is in progress.
    #[must_use]
    pub fn is_active(&self) -> bool {
        self.talk.is_some()
    }

    /// Whether the screen is black.
    #[must_use]
    pub fn is_black(&self) -> bool {
        self.talk.as_ref().is_some_and(|talk| talk.is_black)
    }

    /// Captions below the drawing; `None` if none are shown.
    #[must_use]
    pub fn captions(&self, session: &Session) -> Option<Captions> {
        let talk = self.talk.as_ref()?;
        let stops = session.stops();
        let is_named = stops.iter().any(|stop| !stop.name.is_empty());
        let names = session.names_along_path();
        let are_visible = talk.captions.unwrap_or(is_named) && !names.is_empty();
        let names = names.iter().map(String::as_str);
        are_visible.then(|| Captions::new(stops, names, session.style().ground))
    }

    /// Duration of the talk so far.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        let talk = self.talk.as_ref();
        talk.map_or(Duration::ZERO, |talk| talk.began.elapsed())
    }

    /// Returns whether the talk will change without input: it waits for the film, or the pointer
    /// will soon be hidden.
    #[must_use]
    pub fn has_pending_change(&self) -> bool {
        let talk = self.talk.as_ref();
        talk.is_some_and(|talk| !talk.has_begun || talk.idle_secs < POINTER_SECS)
    }

    /// Starts a talk; the preferences and the window mode in `before` are restored when the talk
    /// ends.
    fn begin(&mut self, is_all: bool, before: (Preferences, Option<WindowMode>)) {
        self.talk = Some(ActiveTalk {
            is_all,
            has_begun: false,
            is_black: false,
            captions: None,
            began: Instant::now(),
            idle_secs: 0.0,
            before,
        });
    }
}

/// Starts and ends talks, and applies the intents of a talk.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut presentation: ResMut<Presentation>,
    mut preferences: ResMut<Preferences>,
    mut views: ToolViews,
    session: Res<Session>,
    mut windows: Query<(&mut Window, &mut CursorOptions), With<PrimaryWindow>>,
    mut commands: Commands,
) {
    for intent in intents.read() {
        match (intent, &mut presentation.talk) {
            (Intent::Present { is_all }, None) => {
                let window = windows.single_mut().ok();
                let mode = window
                    .map(|(mut window, _)| std::mem::replace(&mut window.mode, fullscreen_mode()));
                // A window opened for the talk may already be full screen, so its mode is not
                // stored. If the talk cannot begin, the window stays open in windowed mode.
                let mode = mode.map(|mode| if *is_all { WindowMode::Windowed } else { mode });
                presentation.begin(*is_all, (*preferences, mode));
                // Closes everything but the drawing.
                (preferences.panels, preferences.help) = (false, false);
                preferences.film_options = false;
                commands.write_message(Intent::FitView);
                views.editor.is_open = false;
                views.comparison.is_shown = false;
                views.map.hide();
            }
            (Intent::Escape | Intent::Present { .. } | Intent::Close, Some(talk)) => {
                if talk.is_all && *intent != Intent::Close {
                    commands.write_message(Intent::Close);
                }
                // The panels are restored even if the window is to close, because the user may
                // cancel the question that closing raises. The window then stays open.
                *preferences = talk.before.0;
                if let (Ok((mut window, _)), Some(mode)) = (windows.single_mut(), talk.before.1) {
                    window.mode = mode;
                }
                if let Ok((_, mut cursor)) = windows.single_mut() {
                    cursor.visible = true;
                }
                presentation.talk = None;
            }
            (Intent::ToggleBlackScreen, Some(talk)) => talk.is_black = !talk.is_black,
            // The captions may be visible by the user's choice or by default; in either case they
            // are toggled.
            (Intent::ToggleCaptions, Some(_)) => {
                let are_shown = presentation.captions(&session).is_some();
                if let Some(talk) = &mut presentation.talk {
                    talk.captions = Some(!are_shown);
                }
            }
            _ => {}
        }
    }
}

/// Borderless full screen: the exclusive mode may change the screen's resolution, which takes
/// seconds.
pub fn fullscreen_mode() -> WindowMode {
    WindowMode::BorderlessFullscreen(MonitorSelection::Current)
}

/// Moves t to the place where the talk starts, as soon as there is a film; ends the talk if no film
/// can be built.
pub fn begin(
    mut presentation: ResMut<Presentation>,
    session: Res<Session>,
    mut playback: ResMut<Playback>,
    mut intents: MessageWriter<Intent>,
) {
    let has_not_begun = |talk: &&mut ActiveTalk| !talk.has_begun;
    let waiting = presentation
        .bypass_change_detection()
        .talk
        .as_mut()
        .filter(has_not_begun);
    let Some(talk) = waiting else {
        return;
    };
    if session.transition().is_some() {
        let (timing, stops) = (session.timing(), session.stops());
        playback.rewind(timing);
        // With several segments, the stops lie at the designs in between; the talk starts at the
        // first design.
        if session.segment_count() == 1 {
            playback.seek(first_stop(timing, stops), timing, stops);
        }
        talk.has_begun = true;
    } else if session.work().is_none() {
        // There is nothing to show. The window stays open and shows the reason.
        talk.is_all = false;
        intents.write(Intent::Escape);
    }
}

/// Hides the pointer during a talk once it has not moved for some time.
pub fn hide_pointer(
    mut moved: MessageReader<CursorMoved>,
    time: Res<Time<Real>>,
    mut presentation: ResMut<Presentation>,
    mut cursors: Query<&mut CursorOptions, With<PrimaryWindow>>,
) {
    let is_moved = moved.read().count() > 0;
    // Counting the time at rest is no visible change and must not trigger a redraw.
    let Some(talk) = &mut presentation.bypass_change_detection().talk else {
        return;
    };
    if is_moved {
        talk.idle_secs = 0.0;
    } else {
        talk.idle_secs += time.delta_secs();
    }
    if let Ok(mut cursor) = cursors.single_mut() {
        let is_visible = talk.idle_secs < POINTER_SECS;
        if cursor.visible != is_visible {
            cursor.visible = is_visible;
        }
    }
}
