//! The window: playback, panels, keys, capture.
//!
//! Built on the stage's plugin like any other Bevy program. Keys and panels write
//! [`Intent`]s; the systems of the folders act on them; panels draw what there is.
//! [`LogicPlugin`] is everything that needs neither a window nor a graphics card, and is what
//! the tests run.
//!
//! | folder | holds |
//! |---|---|
//! | `asking` | intents, what there is to choose from, and the keys |
//! | `telling` | work beside the window, and notices |
//! | `session` | the open project: its files, its history, the work on its transition |
//! | `opening` | opening, changing, saving, closing; dialogs; the gallery |
//! | `playing` | t, how it moves, and what it moves on the stage |
//! | `editing` | the match editor |
//! | `keeping` | what is kept for the next start |
//! | `looking` | the view, what is shown, a second method, measures |
//! | `capturing` | pictures and films |
//! | `ui` | what is drawn around the stage, with egui |

mod analysis;
mod capture;
mod compare;
mod editing;
mod files;
mod input;
mod jobs;
pub mod key_map;
mod logic;
mod map;
mod no_window;
pub mod notices;
pub mod output_files;
mod persistence;
mod playback;
mod presentation;
pub mod redraw_pace;
mod session;
pub mod stage_sync;
mod ui;
pub mod unsaved_question;
mod view;
mod window;

pub use analysis::film_measures::{FilmMeasures, StageMeasures};
pub use analysis::method_search::MethodSearch;
pub use analysis::stage_recording::StageRecording;
pub use analysis::suggestions::{SuggestedChange, Suggestion, Suggestions};
pub use capture::film_exporter::FilmExporter;
pub use compare::comparison::{Comparison, OnComparison};
pub use editing::editor::{CutEnd, EditorGrab, EditorHandle, MatchEditor};
pub use editing::panes::{EditorPane, EditorPanes, PaneView};
pub use editing::sheet::{MatchSheet, PieceFate};
pub use files::file_dialog::{DialogPurpose, FileDialogRequest};
pub use files::project_actions::GalleryEntries;
pub use input::editor_action::{EditorAction, EditorPointer, EditorTool};
pub use input::gesture::KeyboardFocus;
pub use input::intent::{Intent, RecoveryAnswer, UnsavedAnswer};
pub use input::preferences::{
    ComparisonMethod, FilmExportOptions, FilmFileFormat, ImageScale, Preferences, ThemeChoice,
};
pub use jobs::job::JobError;
pub use key_map::{KeyBinding, KeyMap, KeyModifiers, KeyTableRow, KeyTrigger};
pub use logic::LogicPlugin;
pub use map::map_view::{MapBuildError, MapView};
pub use no_window::NoWindowError;
pub use notices::{Notice, NoticeKind, NoticeTopic, Notices};
pub use output_files::CaptureFolder;
pub use persistence::autosave::Autosave;
pub use playback::player::Playback;
pub use presentation::presenter::Presentation;
pub use redraw_pace::{PanelRepaint, RedrawPace};
pub use session::load::TransitionProblem;
pub use session::save::SaveError;
pub use session::state::{MethodUnavailable, Session};
pub use stage_sync::OnStage;
pub use unsaved_question::{UnsavedKind, UnsavedQuestion};
pub use view::stage_area::{AutoFit, StageArea};
pub use window::{AppOptions, WindowPlugins, run};
