//! A talk: nothing but the drawing, from stop to stop, on the whole screen.
//!
//! While one is given the panels are hidden and only the keys of a talk mean anything, so that
//! nothing else can come before an audience. It begins at the first stop.

use std::time::{Duration, Instant};

use bevy::prelude::{
    Commands, DetectChangesMut, MessageReader, MessageWriter, Query, Real, Res, ResMut, Resource,
    Time, With,
};
use bevy::window::{
    CursorMoved, CursorOptions, MonitorSelection, PrimaryWindow, Window, WindowMode,
};

use crate::app::compare::comparison::Comparison;
use crate::app::editing::editor::MatchEditor;
use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::map::map_view::MapView;
use crate::app::playback::player::{Playback, first_stop};
use crate::app::session::state::Session;
use crate::export::Captions;

/// How long a pointer that rests is still seen.
const POINTER_SECS: f32 = 1.0;

/// The talk that is being given, if any.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Presentation {
    talk: Option<ActiveTalk>,
}

#[derive(Clone, Debug, PartialEq)]
struct ActiveTalk {
    /// The window was opened for it and closes with it.
    is_all: bool,
    /// It has come to its first stop, which takes a film.
    has_begun: bool,
    is_black: bool,
    /// As it was asked for; else they are shown where stops are named.
    captions: Option<bool>,
    began: Instant,
    /// How long the pointer has rested.
    rest_secs: f32,
    /// How the window was before.
    before: (Preferences, Option<WindowMode>),
}

impl Presentation {
    /// A talk is being given.
    #[must_use]
    pub fn is_on(&self) -> bool {
        self.talk.is_some()
    }

    /// The screen is black, so that the speaker is looked at.
    #[must_use]
    pub fn is_black(&self) -> bool {
        self.talk.as_ref().is_some_and(|talk| talk.is_black)
    }

    /// What stands below the drawing; none where nothing is to.
    #[must_use]
    pub fn captions(&self, session: &Session) -> Option<Captions> {
        let talk = self.talk.as_ref()?;
        let stops = session.stops();
        let is_named = stops.iter().any(|stop| !stop.name.is_empty());
        let names = session.names_on_the_way();
        let are_wanted = talk.captions.unwrap_or(is_named) && !names.is_empty();
        let names = names.iter().map(String::as_str);
        are_wanted.then(|| Captions::new(stops, names, session.style().ground))
    }

    /// How long it has run.
    #[must_use]
    pub fn lasts(&self) -> Duration {
        let talk = self.talk.as_ref();
        talk.map_or(Duration::ZERO, |talk| talk.began.elapsed())
    }

    /// The pointer is still seen, and will not be for ever.
    #[must_use]
    pub fn waits(&self) -> bool {
        let talk = self.talk.as_ref();
        talk.is_some_and(|talk| !talk.has_begun || talk.rest_secs < POINTER_SECS)
    }

    fn begin(&mut self, is_all: bool, before: (Preferences, Option<WindowMode>)) {
        self.talk = Some(ActiveTalk {
            is_all,
            has_begun: false,
            is_black: false,
            captions: None,
            began: Instant::now(),
            rest_secs: 0.0,
            before,
        });
    }
}

/// Begins and ends talks, and acts on what is asked for in one.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut presenting: ResMut<Presentation>,
    mut preferences: ResMut<Preferences>,
    (mut editor, mut twin, mut map): (ResMut<MatchEditor>, ResMut<Comparison>, ResMut<MapView>),
    session: Res<Session>,
    mut windows: Query<(&mut Window, &mut CursorOptions), With<PrimaryWindow>>,
    mut commands: Commands,
) {
    for intent in intents.read() {
        match (intent, &mut presenting.talk) {
            (Intent::Present { is_all }, None) => {
                let window = windows.single_mut().ok();
                let mode = window
                    .map(|(mut window, _)| std::mem::replace(&mut window.mode, fullscreen_mode()));
                // It may have been opened on the whole screen for this.
                let mode = mode.map(|mode| if *is_all { WindowMode::Windowed } else { mode });
                presenting.begin(*is_all, (*preferences, mode));
                (preferences.panels, preferences.help) = (false, false);
                preferences.film_options = false;
                commands.write_message(Intent::FitView);
                editor.is_open = false;
                (twin.is_shown, map.is_shown) = (false, false);
            }
            (Intent::Back | Intent::Present { .. } | Intent::Close, Some(talk)) => {
                if talk.is_all {
                    commands.write_message(Intent::Close);
                } else {
                    // What closing may ask is seen again.
                    *preferences = talk.before.0;
                    if let (Ok((mut window, _)), Some(mode)) = (windows.single_mut(), talk.before.1)
                    {
                        window.mode = mode;
                    }
                }
                if let Ok((_, mut cursor)) = windows.single_mut() {
                    cursor.visible = true;
                }
                presenting.talk = None;
            }
            (Intent::Black, Some(talk)) => talk.is_black = !talk.is_black,
            (Intent::ToggleCaptions, Some(_)) => {
                let are_shown = presenting.captions(&session).is_some();
                if let Some(talk) = &mut presenting.talk {
                    talk.captions = Some(!are_shown);
                }
            }
            _ => {}
        }
    }
}

/// Borderless: the other kind may change the screen's resolution, which takes seconds.
pub fn fullscreen_mode() -> WindowMode {
    WindowMode::BorderlessFullscreen(MonitorSelection::Current)
}

/// Goes to the first stop as soon as there is a film; ends where there will be none.
pub fn begin(
    mut presenting: ResMut<Presentation>,
    session: Res<Session>,
    mut playback: ResMut<Playback>,
    mut intents: MessageWriter<Intent>,
) {
    let waits = |talk: &&mut ActiveTalk| !talk.has_begun;
    let waiting = presenting
        .bypass_change_detection()
        .talk
        .as_mut()
        .filter(waits);
    let Some(talk) = waiting else {
        return;
    };
    if session.transition().is_some() {
        let (timing, stops) = (session.timing(), session.stops());
        playback.begin(timing);
        // Of many designs stops lie at those within: the first one is where it begins.
        if session.leg_count() == 1 {
            playback.seek(first_stop(timing, stops), timing, stops);
        }
        talk.has_begun = true;
    } else if session.work().is_none() {
        // There is nothing to show, and what there is to tell is told in the window.
        talk.is_all = false;
        intents.write(Intent::Back);
    }
}

/// Hides the pointer once it has rested.
pub fn hide_pointer(
    mut moved: MessageReader<CursorMoved>,
    time: Res<Time<Real>>,
    mut presenting: ResMut<Presentation>,
    mut cursors: Query<&mut CursorOptions, With<PrimaryWindow>>,
) {
    let is_moved = moved.read().count() > 0;
    // Nobody asks how long it has rested.
    let Some(talk) = &mut presenting.bypass_change_detection().talk else {
        return;
    };
    if is_moved {
        talk.rest_secs = 0.0;
    } else {
        talk.rest_secs += time.delta_secs();
    }
    if let Ok(mut cursor) = cursors.single_mut() {
        let is_seen = talk.rest_secs < POINTER_SECS;
        if cursor.visible != is_seen {
            cursor.visible = is_seen;
        }
    }
}
