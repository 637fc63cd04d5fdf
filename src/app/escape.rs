//! Handles the intents of Esc and of full screen. Each Esc closes or cancels one thing that is open
//! or running, in a fixed order.

use crate::app::analysis::film_measures::StageMeasures;
use crate::app::analysis::method_search::MethodSearch;
use crate::app::analysis::suggestions::Suggestions;
use crate::app::capture::film_exporter::FilmExporter;
use crate::app::files::invitation::Invitation;
use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::open_questions::OpenQuestions;
use crate::app::presentation::presenter::{Presentation, fullscreen_mode};
use crate::app::session::state::Session;
use crate::app::tool_views::ToolViews;
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::window::{PrimaryWindow, WindowMode};

/// Switches the main window between full screen and windowed mode.
pub fn toggle_fullscreen(
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

/// Open questions and the talk, which handle Esc before anything else.
#[derive(SystemParam)]
pub struct EscapeBlockers<'w> {
    /// Questions to the user; while one is open, Esc answers it.
    questions: OpenQuestions<'w>,
    /// The talk; while one is in progress, Esc ends it.
    presentation: Res<'w, Presentation>,
}

impl EscapeBlockers<'_> {
    /// Whether a question or a talk handles Esc.
    fn any(&self) -> bool {
        self.questions.any() || self.presentation.is_active()
    }
}

/// Background work that Esc cancels.
#[derive(SystemParam)]
pub struct CancellableWork<'w> {
    /// Opening and building projects.
    session: ResMut<'w, Session>,
    /// The search for the best method.
    search: ResMut<'w, MethodSearch>,
    /// The measurement of the film.
    measures: ResMut<'w, StageMeasures>,
    /// The search for suggestions.
    suggestions: ResMut<'w, Suggestions>,
    /// The film export.
    exporter: Res<'w, FilmExporter>,
}

/// Handles Esc: each press closes or cancels one thing, in the order of the branches below. With
/// nothing else open, it cancels a running export.
pub fn handle_escape(
    mut intents: MessageReader<Intent>,
    mut preferences: ResMut<Preferences>,
    mut window: Query<&mut Window, With<PrimaryWindow>>,
    blockers: EscapeBlockers,
    mut views: ToolViews,
    mut invitation: ResMut<Invitation>,
    mut work: CancellableWork,
) {
    if blockers.any() {
        intents.clear(); // Esc answers the question or ends the talk, and nothing else.
        return;
    }
    let escape_count = intents
        .read()
        .filter(|intent| **intent == Intent::Escape)
        .count();
    for _ in 0..escape_count {
        if preferences.help {
            preferences.help = false;
        } else if views.map.bypass_change_detection().end_path_tools() {
            views.map.set_changed();
        } else if preferences.panels && !views.is_any_open() && invitation.is_shown() {
            invitation.close();
        } else if preferences.panels && work.session.visible_work().is_some() {
            work.session.cancel();
        } else if preferences.panels && work.search.visible_progress().is_some() {
            work.search.stop();
        } else if preferences.panels && work.measures.visible_progress().is_some() {
            work.measures.stop();
        } else if preferences.panels && !views.editor.is_open && work.suggestions.is_trying() {
            work.suggestions.stop();
        } else if views.editor.bypass_change_detection().handle_escape() {
            views.editor.set_changed();
        } else if preferences.film_options {
            preferences.film_options = false;
        } else if views.map.is_shown {
            views.map.hide();
        } else if views.comparison.is_shown {
            views.comparison.is_shown = false;
        } else if !preferences.panels {
            preferences.panels = true;
        } else if let Ok(mut window) = window.single_mut()
            && window.mode != WindowMode::Windowed
        {
            window.mode = WindowMode::Windowed;
        } else if preferences.times {
            preferences.times = false;
        } else {
            work.exporter.cancel();
        }
    }
}
