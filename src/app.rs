//! The application window: playback, panels, keys and export, on top of the core library and the
//! stage plugin.
//!
//! Keys, panels and dialogs write [`Intent`] messages; the systems of the folders below act on
//! them; `ui` draws the resulting state and computes nothing. [`LogicPlugin`] holds every system
//! that needs neither a window nor a graphics card, and is what the tests run.
//!
//! | folder | contents |
//! |---|---|
//! | `input`, `key_input` | intents and the keys that trigger them, mouse gestures, preferences |
//! | `jobs`, `notices` | background threads; messages shown to the user |
//! | `session` | the open project: files, undo history, building its transition |
//! | `files`, `unsaved_question` | open, edit, save and close; file dialog; invitation; gallery |
//! | `playback`, `presentation` | t and how it moves; talks and the speaker's window |
//! | `view`, `stage_area`, `stage_sync` | pan and zoom, filmstrip; what the stage shows |
//! | `escape` | what Esc closes or cancels, full screen |
//! | `redraw_pace` | how often the window redraws |
//! | `screen_fit` | size of the window on small screens |
//! | `map` | the map of all designs, its thumbnails and contours |
//! | `analysis` | measures of the film, method search, suggestions |
//! | `compare` | a second method next to the stage |
//! | `editing` | the match editor |
//! | `capture`, `output_files` | images and films written to files or the clipboard |
//! | `persistence` | autosave, recent files, presets, gallery cache |
//! | `ui` | everything drawn around the stage, with egui |

mod analysis;
mod capture;
mod compare;
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
mod output_files;
mod persistence;
mod playback;
mod presentation;
mod redraw_pace;
mod screen_fit;
mod session;
mod stage_area;
mod stage_sync;
mod ui;
mod unsaved_question;
mod view;
mod window;

pub use analysis::film_measures::{FilmMeasures, StageMeasures};
pub use analysis::method_search::MethodSearch;
pub use analysis::stage_recording::StageRecording;
pub use analysis::suggestions::{SuggestedChange, Suggestion, Suggestions};
pub use capture::film_exporter::FilmExporter;
pub use compare::comparison::{Comparison, OnComparison};
pub use editing::editor::{CutEnd, EditorGrab, EditorHandle, MatchEditor};
pub use editing::panes::{EditorPanes, PaneView};
pub use editing::sheet::{MatchSheet, PieceFate};
pub use files::file_dialog::{DialogPurpose, FileDialogRequest};
pub use files::invitation::{Invitation, START_PROJECT};
pub use files::project_actions::GalleryEntries;
pub use input::editor_action::{EditorAction, EditorPane, EditorPointer, EditorTool};
pub use input::gesture::KeyboardFocus;
pub use input::intent::{Intent, RecoveryAnswer, UnsavedAnswer};
pub use input::key_map::{KeyBinding, KeyMap, KeyModifiers, KeyTableRow, KeyTrigger};
pub use input::preferences::{
    ComparisonMethod, FilmExportOptions, FilmFileFormat, ImageScale, Preferences, ThemeChoice,
};
pub use jobs::job::JobError;
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
pub use stage_area::{AutoFit, StageArea};
pub use stage_sync::OnStage;
pub use unsaved_question::{UnsavedKind, UnsavedQuestion};
pub use window::{AppOptions, WindowPlugins, run};
