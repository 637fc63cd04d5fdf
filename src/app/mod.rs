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

mod asking;
mod capturing;
mod editing;
mod keeping;
mod logic;
mod looking;
mod opening;
mod playing;
mod session;
mod starting;
mod telling;
mod ui;
mod window;

pub use asking::acts::{EditorAct, Tool, Touch};
pub use asking::choices::{
    CaptureScale, FilmLook, Preferences, RecordFormat, ThemeChoice, TwinMethod,
};
pub use asking::hand::Typing;
pub use asking::intent::{Answer, Intent, Rescue};
pub use asking::keymap::{Binding, Held, KeyMap, Row, Trigger};
pub use capturing::files::CaptureFolder;
pub use capturing::films::Recorder;
pub use editing::editor::{CutEnd, Editor, Grab, Handle};
pub use editing::panes::{Pane, PaneView, Panes};
pub use editing::sheet::{Fate, Sheet};
pub use keeping::autosave::Autosave;
pub use logic::LogicPlugin;
pub use looking::choosing::Choosing;
pub use looking::helping::{Alternative, Helping, Offer};
pub use looking::map::{MapProblem, MapView};
pub use looking::measuring::{Measured, Measures};
pub use looking::recording::Recording;
pub use looking::twin::{OnTwin, Twin};
pub use looking::view::{KeepsFit, StageArea};
pub use opening::apply::Gallery;
pub use opening::closing::{Lost, Question};
pub use opening::dialogs::{Dialog, Purpose};
pub use playing::pace::{Pace, Repaint};
pub use playing::playback::Playback;
pub use playing::presenting::Presenting;
pub use playing::staging::OnStage;
pub use session::loading::Problem;
pub use session::saving::SaveError;
pub use session::state::{Session, Unavailable};
pub use starting::NoWindow;
pub use telling::job::JobError;
pub use telling::notices::{About, Kind, Notice, Notices};
pub use window::{AppOptions, WindowPlugins, run};
