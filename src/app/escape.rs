//! Esc and full screen: intents whose effect depends on everything that is open.

use crate::app::analysis::film_measures::StageMeasures;
use crate::app::analysis::method_search::MethodSearch;
use crate::app::analysis::suggestions::Suggestions;
use crate::app::capture::film_exporter::FilmExporter;
use crate::app::compare::comparison::Comparison;
use crate::app::editing::editor::MatchEditor;
use crate::app::files::drop::DroppedDesign;
use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::map::map_view::MapView;
use crate::app::persistence::autosave::Autosave;
use crate::app::presentation::presenter::{Presentation, fullscreen_mode};
use crate::app::session::state::Session;
use crate::app::unsaved_question::UnsavedQuestion;
use bevy::prelude::*;
use bevy::window::{PrimaryWindow, WindowMode};

/// Switches between full screen and window.
pub fn window_mode(
    mut intents: MessageReader<Intent>,
    mut window: Single<&mut Window, With<PrimaryWindow>>,
) {
    for intent in intents.read() {
        if *intent == Intent::ToggleFullscreen {
            window.mode = match window.mode {
                WindowMode::Windowed => fullscreen_mode(),
                _ => WindowMode::Windowed,
            };
        }
    }
}

/// Questions and modes that handle Esc before anything else.
type EscapeBlockers<'w> = (
    Res<'w, UnsavedQuestion>,
    Res<'w, DroppedDesign>,
    Res<'w, Autosave>,
    Res<'w, Presentation>,
);

/// Background work that Esc cancels.
type CancellableWork<'w> = (
    ResMut<'w, MethodSearch>,
    ResMut<'w, StageMeasures>,
    ResMut<'w, Suggestions>,
);

/// Handles Esc: each press closes or cancels one thing, in the order of the branches below. The
/// last resort is cancelling an export.
pub fn back(
    mut intents: MessageReader<Intent>,
    mut preferences: ResMut<Preferences>,
    mut window: Query<&mut Window, With<PrimaryWindow>>,
    (mut editor, mut comparison, mut map): (
        ResMut<MatchEditor>,
        ResMut<Comparison>,
        ResMut<MapView>,
    ),
    (question, drop, autosave, presentation): EscapeBlockers,
    (mut session, exporter): (ResMut<Session>, Res<FilmExporter>),
    (mut search, mut measures, mut suggestions): CancellableWork,
) {
    let is_asked = question.text().is_some() || drop.asks() || autosave.lost().is_some();
    if is_asked || presentation.is_on() {
        intents.clear(); // Esc answers the question or ends the talk, and nothing else.
        return;
    }
    let backs = intents
        .read()
        .filter(|intent| **intent == Intent::Back)
        .count();
    for _ in 0..backs {
        if preferences.help {
            preferences.help = false;
        } else if preferences.panels && session.told_work().is_some() {
            session.cancel();
        } else if preferences.panels && search.told().is_some() {
            search.stop();
        } else if preferences.panels && measures.told().is_some() {
            measures.stop();
        } else if preferences.panels && !editor.is_open && suggestions.is_trying() {
            suggestions.stop();
        } else if editor.bypass_change_detection().back() {
            editor.set_changed();
        } else if preferences.film_options {
            preferences.film_options = false;
        } else if map.is_shown {
            map.is_shown = false;
        } else if std::mem::take(&mut comparison.is_shown) {
            // The comparison has been closed by the condition.
        } else if !preferences.panels {
            preferences.panels = true;
        } else if let Ok(mut window) = window.single_mut()
            && window.mode != WindowMode::Windowed
        {
            window.mode = WindowMode::Windowed;
        } else if preferences.times {
            preferences.times = false;
        } else {
            exporter.cancel();
        }
    }
}
