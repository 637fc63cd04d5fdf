//! The application window: playback, panels, keys and export, on top of the core library and the
//! stage plugin.
//!
//! Keys, panels and dialogs write `Intent` messages; the systems of the folders below act on
//! them; `ui` draws the resulting state and computes nothing. `LogicPlugin` holds every system
//! that needs neither a window nor a graphics card, and is what the tests run.
//!
//! | folder | contents |
//! |---|---|
//! | `input`, `key_input` | intents and the keys that trigger them, mouse gestures, preferences |
//! | `jobs`, `notices` | background threads; messages shown to the user |
//! | `session` | the open project: files, undo history, building its transition |
//! | `files`, `unsaved_question` | open, edit, save and close; file dialog; invitation; gallery |
//! | `playback`, `presentation` | the blend parameter t and its change over time; talks and the
//! speaker window |
//! | `view`, `stage_area`, `stage_sync` | pan and zoom, filmstrip; what the stage shows |
//! | `escape`, `open_questions`, `tool_views` | what Esc closes or cancels, full screen |
//! | `redraw_pace` | how often the window redraws |
//! | `screen_fit`, `window_system` | size of the window on small screens; choice of X11 or Wayland |
//! | `map` | the map on which the designs are placed, its thumbnails and contours |
//! | `analysis` | measures of the film, search for the best method, suggested changes |
//! | `compare` | a second method shown next to the stage, at the same t |
//! | `editing` | the match editor |
//! | `capture`, `output_files` | images and films written to files or the clipboard |
//! | `persistence` | autosave, recent files, presets, gallery cache |
//! | `ui` | everything drawn around the stage, with egui |

mod analysis;
mod capture;
mod compare;
mod conflict_question;
mod editing;
mod escape;
mod files;
mod input;
mod jobs;
mod key_input;
mod logic;
mod map;
mod no_window;
mod notices;
mod open_questions;
mod output_files;
mod persistence;
mod playback;
mod presentation;
mod redraw_pace;
mod screen_fit;
mod session;
mod stage_area;
mod stage_sync;
mod tool_views;
mod ui;
mod unsaved_question;
mod view;
mod window;
mod window_system;

pub use no_window::NoWindowError;
pub use window::{AppOptions, run};

/// Systems, resources and intents of the window, for the tests that drive it.
#[cfg(feature = "testing")]
pub mod testing {
    pub use super::analysis::film_measures::{FilmMeasures, StageMeasures};
    pub use super::analysis::method_search::MethodSearch;
    pub use super::analysis::stage_recording::StageRecording;
    pub use super::analysis::suggestions::{SuggestedChange, Suggestion, Suggestions};
    pub use super::capture::film_exporter::FilmExporter;
    pub use super::compare::comparison::{Comparison, OnComparison};
    pub use super::editing::editor::{CutEnd, EditorGrab, EditorHandle, MatchEditor};
    pub use super::editing::panes::{EditorPanes, PaneView};
    pub use super::editing::sheet::{MatchSheet, PieceFate};
    pub use super::files::drop::DroppedDesign;
    pub use super::files::file_dialog::{DialogPurpose, FileDialogRequest};
    pub use super::files::invitation::{Invitation, START_PROJECT};
    pub use super::files::picture_readings::PictureReadings;
    pub use super::files::project_actions::GalleryEntries;
    pub use super::input::editor_action::{EditorAction, EditorPane, EditorPointer, EditorTool};
    pub use super::input::gesture::KeyboardFocus;
    pub use super::input::intent::{
        ConflictAnswer, ExportKind, Intent, RecoveryAnswer, UnsavedAnswer,
    };
    pub use super::input::key_map::{KeyBinding, KeyMap, KeyModifiers, KeyTableRow, KeyTrigger};
    pub use super::input::preferences::{
        ComparisonMethod, FilmExportOptions, FilmFileFormat, ImageScale, Preferences, ThemeChoice,
    };
    pub use super::jobs::job::JobError;
    pub use super::logic::LogicPlugin;
    pub use super::map::map_view::{MapBuildError, MapView};
    pub use super::notices::{Notice, NoticeKind, NoticeTopic, Notices};
    pub use super::output_files::CaptureFolder;
    pub use super::persistence::autosave::Autosave;
    pub use super::persistence::recent_files::StoredRecentFiles;
    pub use super::playback::player::Playback;
    pub use super::presentation::presenter::Presentation;
    pub use super::redraw_pace::{PanelRepaint, RedrawPace};
    pub use super::session::save::SaveError;
    pub use super::session::save_conflict::ConflictQuestion;
    pub use super::session::state::{MethodUnavailable, Session};
    pub use super::session::transition_problem::TransitionProblem;
    pub use super::stage_area::{AutoFit, StageArea};
    pub use super::stage_sync::OnStage;
    pub use super::unsaved_question::{UnsavedKind, UnsavedQuestion};
    pub use super::window::WindowPlugins;
}
