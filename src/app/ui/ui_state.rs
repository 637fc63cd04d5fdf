//! Read-only access of the user interface to the application's resources, and the list of intents
//! that it sends back.

use bevy::ecs::system::SystemParam;
use bevy::prelude::Res;

use crate::app::analysis::film_measures::StageMeasures;
use crate::app::analysis::method_search::MethodSearch;
use crate::app::analysis::stage_recording::StageRecording;
use crate::app::analysis::suggestions::Suggestions;
use crate::app::capture::estimate::ExportEstimate;
use crate::app::capture::film_exporter::FilmExporter;
use crate::app::capture::film_framing::FilmFraming;
use crate::app::compare::comparison::Comparison;
use crate::app::editing::editor::MatchEditor;
use crate::app::editing::sheet::MatchSheet;
use crate::app::files::drop::{DropSupport, DroppedDesign};
use crate::app::files::file_dialog::FileDialogRequest;
use crate::app::files::file_preview::FilePreview;
use crate::app::files::gallery_thumbnails::GalleryThumbnails;
use crate::app::files::invitation::Invitation;
use crate::app::files::picture_readings::PictureReadings;
use crate::app::files::project_actions::GalleryEntries;
use crate::app::files::text_fonts::TextFonts;
use crate::app::input::intent::Intent;
use crate::app::input::key_map::KeyMap;
use crate::app::input::preferences::Preferences;
use crate::app::map::map_view::MapView;
use crate::app::notices::Notices;
use crate::app::output_files::CaptureFolder;
use crate::app::persistence::autosave::Autosave;
use crate::app::persistence::film_presets::StoredPresets;
use crate::app::persistence::recent_files::StoredRecentFiles;
use crate::app::playback::player::Playback;
use crate::app::presentation::presenter::Presentation;
use crate::app::session::save_conflict::ConflictQuestion;
use crate::app::session::state::Session;
use crate::app::unsaved_question::UnsavedQuestion;
use crate::app::view::filmstrip::Filmstrip;
use crate::app::view::frame_intervals::FrameIntervals;
use crate::app::view::onion_skins::OnionSkins;
use crate::stage::{FrameTimes, StageView};

/// Resources of the application that the user interface reads.
#[derive(SystemParam)]
pub struct UiState<'w> {
    pub session: Res<'w, Session>,
    pub editor: Res<'w, MatchEditor>,
    pub sheet: Res<'w, MatchSheet>,
    pub method_search: Res<'w, MethodSearch>,
    pub suggestions: Res<'w, Suggestions>,
    pub filmstrip: Res<'w, Filmstrip>,
    pub measures: Res<'w, StageMeasures>,
    pub recording: Res<'w, StageRecording>,
    pub onion: Res<'w, OnionSkins>,
    pub comparison: Res<'w, Comparison>,
    pub map: Res<'w, MapView>,
    pub view: Res<'w, StageView>,
    pub gallery: Res<'w, GalleryEntries>,
    pub invitation: Res<'w, Invitation>,
    pub playback: Res<'w, Playback>,
    pub presentation: Res<'w, Presentation>,
    pub preferences: Res<'w, Preferences>,
    pub notices: Res<'w, Notices>,
    pub thumbnails: Res<'w, GalleryThumbnails>,
    pub exporter: Res<'w, FilmExporter>,
    pub film_framing: Res<'w, FilmFraming>,
    pub estimate: Res<'w, ExportEstimate>,
    pub autosave: Res<'w, Autosave>,
    pub presets: Res<'w, StoredPresets>,
    pub recent: Res<'w, StoredRecentFiles>,
    pub question: Res<'w, UnsavedQuestion>,
    pub conflict: Res<'w, ConflictQuestion>,
    pub dialog: Res<'w, FileDialogRequest>,
    pub dropped_design: Res<'w, DroppedDesign>,
    pub preview: Res<'w, FilePreview>,
    pub fonts: Res<'w, TextFonts>,
    pub readings: Res<'w, PictureReadings>,
    pub drop_support: Res<'w, DropSupport>,
    pub capture_folder: Res<'w, CaptureFolder>,
    pub keys: Res<'w, KeyMap>,
    pub frame_times: Res<'w, FrameTimes>,
    pub frame_intervals: Res<'w, FrameIntervals>,
}

/// List to which the user interface adds the intents that the user triggers in a frame.
pub type Intents = Vec<Intent>;
