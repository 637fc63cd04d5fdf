//! What the panels show, and what the user does to it.

use bevy::ecs::system::SystemParam;
use bevy::prelude::Res;

use crate::app::asking::choices::Preferences;
use crate::app::asking::intent::Intent;
use crate::app::asking::keymap::KeyMap;
use crate::app::capturing::estimate::Estimate;
use crate::app::capturing::films::Recorder;
use crate::app::capturing::framing::FilmFrame;
use crate::app::editing::editor::Editor;
use crate::app::editing::sheet::Sheet;
use crate::app::keeping::autosave::Autosave;
use crate::app::keeping::presets::KeptPresets;
use crate::app::keeping::recent::KeptRecent;
use crate::app::looking::choosing::Choosing;
use crate::app::looking::filmstrip::Filmstrip;
use crate::app::looking::helping::Helping;
use crate::app::looking::map::MapView;
use crate::app::looking::measuring::Measured;
use crate::app::looking::onion::Onion;
use crate::app::looking::recording::Recording;
use crate::app::looking::times::WholeFrame;
use crate::app::looking::twin::Twin;
use crate::app::opening::apply::Gallery;
use crate::app::opening::closing::Question;
use crate::app::opening::dialogs::Dialog;
use crate::app::opening::drops::Drop;
use crate::app::opening::preview::Preview;
use crate::app::opening::thumbnails::Thumbnails;
use crate::app::playing::playback::Playback;
use crate::app::playing::presenting::Presenting;
use crate::app::session::state::Session;
use crate::app::telling::notices::Notices;
use crate::stage::{FrameTimes, StageView};

/// Everything that the panels show.
#[derive(SystemParam)]
pub struct Scene<'w> {
    pub session: Res<'w, Session>,
    pub editor: Res<'w, Editor>,
    pub sheet: Res<'w, Sheet>,
    pub choosing: Res<'w, Choosing>,
    pub helping: Res<'w, Helping>,
    pub filmstrip: Res<'w, Filmstrip>,
    pub measured: Res<'w, Measured>,
    pub recording: Res<'w, Recording>,
    pub onion: Res<'w, Onion>,
    pub twin: Res<'w, Twin>,
    pub map: Res<'w, MapView>,
    pub view: Res<'w, StageView>,
    pub gallery: Res<'w, Gallery>,
    pub playback: Res<'w, Playback>,
    pub presenting: Res<'w, Presenting>,
    pub preferences: Res<'w, Preferences>,
    pub notices: Res<'w, Notices>,
    pub thumbnails: Res<'w, Thumbnails>,
    pub recorder: Res<'w, Recorder>,
    pub film: Res<'w, FilmFrame>,
    pub estimate: Res<'w, Estimate>,
    pub autosave: Res<'w, Autosave>,
    pub presets: Res<'w, KeptPresets>,
    pub recent: Res<'w, KeptRecent>,
    pub question: Res<'w, Question>,
    pub dialog: Res<'w, Dialog>,
    pub drop: Res<'w, Drop>,
    pub preview: Res<'w, Preview>,
    pub keys: Res<'w, KeyMap>,
    pub times: Res<'w, FrameTimes>,
    pub whole: Res<'w, WholeFrame>,
}

/// What the user does this frame.
pub type Intents = Vec<Intent>;
