//! Bevy plugin that registers every system needing neither a window nor a graphics card, and fixes
//! the order in which these systems run.

use bevy::prelude::*;

use crate::app::analysis::film_measures;
use crate::app::analysis::film_measures::StageMeasures;
use crate::app::analysis::method_search;
use crate::app::analysis::method_search::MethodSearch;
use crate::app::analysis::stage_recording;
use crate::app::analysis::stage_recording::StageRecording;
use crate::app::analysis::suggestions;
use crate::app::analysis::suggestions::Suggestions;
use crate::app::capture::film_exporter;
use crate::app::capture::{estimate, film_framing, saved_blends};
use crate::app::compare::comparison;
use crate::app::compare::comparison::Comparison;
use crate::app::conflict_question;
use crate::app::editing::editor::MatchEditor;
use crate::app::editing::sheet::MatchSheet;
use crate::app::editing::{actions, refresh};
use crate::app::escape;
use crate::app::files::invitation::Invitation;
use crate::app::files::project_actions as opening;
use crate::app::files::project_actions::{GalleryEntries, PlayWhenOpened};
use crate::app::files::{
    drop, file_dialog, file_preview, file_watcher, invitation, picture_readings, text_fonts,
};
use crate::app::input::gesture;
use crate::app::input::gesture::KeyboardFocus;
use crate::app::input::intent::Intent;
use crate::app::input::key_map::KeyMap;
use crate::app::input::preferences::Preferences;
use crate::app::key_input;
use crate::app::map::map_view::MapView;
use crate::app::map::{map_actions, update};
use crate::app::notices;
use crate::app::notices::Notices;
use crate::app::output_files::{CaptureFolder, ScratchFolder};
use crate::app::persistence::autosave;
use crate::app::persistence::autosave::Autosave;
use crate::app::persistence::{film_presets, recent_files};
use crate::app::playback::player;
use crate::app::playback::player::Playback;
use crate::app::presentation::presenter;
use crate::app::presentation::presenter::Presentation;
use crate::app::session::save_conflict::ConflictQuestion;
use crate::app::session::state::Session;
use crate::app::stage_area::{AutoFit, StageArea};
use crate::app::stage_sync;
use crate::app::tool_views;
use crate::app::unsaved_question;
use crate::app::unsaved_question::UnsavedQuestion;
use crate::app::view::frame_intervals;
use crate::app::view::stage_camera;
use crate::app::view::{onion_skins, preference_actions};
use crate::stage::MorphSystems;

/// Plugin with all window-independent resources and systems; the tests run exactly this.
#[derive(Clone, Copy, Debug, Default)]
pub struct LogicPlugin;

impl Plugin for LogicPlugin {
    fn build(&self, app: &mut App) {
        use MorphSystems::{Build, Input, Playback as Play};
        init_resources(app);
        app.configure_sets(Update, (Input, Play, Build).chain())
            .add_systems(
                Update,
                (
                    frame_intervals::record,
                    gesture::track_gesture,
                    key_input::read_keys,
                    drop::read_drops,
                )
                    .in_set(Input),
            )
            .add_systems(Update, intent_systems().in_set(Play))
            .add_systems(
                Update,
                (
                    stage_sync::stage_transition,
                    stage_sync::stage_comparison,
                    stage_sync::stage_t,
                    stage_sync::stage_style,
                )
                    .chain()
                    .after(Play)
                    .before(Build),
            );
    }
}

fn init_resources(app: &mut App) {
    app.add_message::<Intent>()
        .add_message::<bevy::window::FileDragAndDrop>()
        .add_message::<bevy::window::WindowCloseRequested>()
        .add_message::<bevy::window::CursorMoved>()
        .init_resource::<ClearColor>()
        .init_resource::<ButtonInput<MouseButton>>()
        .init_resource::<gesture::Gesture>()
        .init_resource::<GalleryEntries>()
        .init_resource::<Session>()
        .init_resource::<Playback>()
        .init_resource::<Presentation>()
        .init_resource::<Preferences>()
        .init_resource::<KeyMap>()
        .init_resource::<KeyboardFocus>()
        .init_resource::<gesture::TextSelected>()
        .init_resource::<MatchEditor>()
        .init_resource::<MatchSheet>()
        .init_resource::<StageMeasures>()
        .init_resource::<MethodSearch>()
        .init_resource::<onion_skins::OnionSkins>()
        .init_resource::<Suggestions>()
        .init_resource::<StageRecording>()
        .init_resource::<Comparison>()
        .init_resource::<MapView>()
        .init_resource::<saved_blends::SavedBlendsExport>()
        .init_resource::<Notices>()
        .init_resource::<UnsavedQuestion>()
        .init_resource::<ConflictQuestion>()
        .init_resource::<Autosave>()
        .init_resource::<film_presets::StoredPresets>()
        .init_resource::<recent_files::StoredRecentFiles>()
        .init_resource::<drop::DroppedDesign>()
        .init_resource::<Invitation>()
        .init_resource::<PlayWhenOpened>()
        .init_resource::<file_watcher::FileWatcher>()
        .init_resource::<file_dialog::FileDialogRequest>()
        .init_resource::<file_preview::FilePreview>()
        .init_resource::<text_fonts::TextFonts>()
        .init_resource::<picture_readings::PictureReadings>()
        .init_resource::<drop::DropSupport>()
        .init_resource::<film_exporter::FilmExporter>()
        .init_resource::<film_framing::FilmFraming>()
        .init_resource::<ScratchFolder>()
        .init_resource::<estimate::ExportEstimate>()
        .init_resource::<StageArea>()
        .init_resource::<AutoFit>()
        .init_resource::<frame_intervals::FrameIntervals>()
        .init_resource::<CaptureFolder>();
}

/// Systems that act on intents. Each runs after the systems whose results it needs; for example, a
/// project is opened before it is played.
fn intent_systems() -> impl IntoScheduleConfigs<bevy::ecs::system::ScheduleSystem, ()> {
    (
        // Before all readers of intents, so that a request to close the window takes effect in the
        // same screen update, as a key press does.
        unsaved_question::read_close_requests,
        // Before anything is opened or shown, so that Esc acts on what was open when it was
        // pressed.
        (escape::handle_escape, presenter::apply).chain(),
        (preference_actions::apply, film_presets::apply).chain(),
        // Questions are handled before the actions that wait for their answers. The bottom question
        // comes first, because each checks whether another question is still open above it.
        (
            drop::close_drop_question,
            autosave::answer_recovery,
            unsaved_question::answer,
            unsaved_question::close,
            conflict_question::answer,
        )
            .chain(),
        (
            file_dialog::apply_choice,
            file_dialog::open,
            file_preview::follow,
            text_fonts::follow,
        )
            .chain(),
        (project_systems(), analysis_systems()).chain(),
        // Advance t before intents start or change its motion. Otherwise a film that starts now
        // would at once advance by the time since the last screen update.
        (player::advance, presenter::begin, player::apply).chain(),
        (stage_sync::select_segment, presenter::hide_pointer).chain(),
        (
            film_exporter::apply,
            film_exporter::report,
            film_framing::follow,
            estimate::follow,
        )
            .chain(),
        stage_camera::apply,
        file_watcher::follow,
        onion_skins::follow,
        // These systems run after every system that changes the project or marks it as saved.
        (
            autosave::follow,
            recent_files::follow,
            recent_files::follow_exports,
        )
            .chain(),
        notices::apply,
    )
        .chain()
}

/// Systems that open, change and save the project.
fn project_systems() -> impl IntoScheduleConfigs<bevy::ecs::system::ScheduleSystem, ()> {
    (
        (opening::open, invitation::apply).chain(),
        opening::edit,
        actions::apply,
        film_measures::apply,
        method_search::apply,
        suggestions::apply,
        opening::save,
        opening::poll,
        picture_readings::follow,
        tool_views::close_without_project,
        refresh::refresh,
    )
        .chain()
}

/// Systems that react to the transition on the stage: recording, measures, suggestions, comparison
/// and map.
fn analysis_systems() -> impl IntoScheduleConfigs<bevy::ecs::system::ScheduleSystem, ()> {
    (
        stage_recording::follow,
        film_measures::follow,
        suggestions::follow,
        comparison::apply,
        comparison::follow,
        (map_actions::apply, update::follow, saved_blends::export).chain(),
    )
        .chain()
}
