//! How often the window draws: all the time while something moves, now and then while work goes
//! on, and not at all while nothing does, so that a talk does not drain the battery and a fan
//! stays quiet.
//!
//! Keys, the pointer and whatever else the system tells wake the window at any pace.

use std::time::Duration;

use bevy::ecs::system::{NonSendMarker, SystemParam};
use bevy::prelude::{
    DetectChanges, Entity, Local, MessageReader, Messages, Query, Real, Res, ResMut, Resource,
    Time, With,
};
use bevy::render::view::screenshot::Screenshot;
use bevy::window::{PrimaryWindow, RequestRedraw, WindowEvent, WindowOccluded};
use bevy::winit::{UpdateMode, WINIT_WINDOWS, WinitSettings};

use crate::app::analysis::film_measures::StageMeasures;
use crate::app::analysis::method_search::MethodSearch;
use crate::app::analysis::stage_recording::StageRecording;
use crate::app::analysis::suggestions::Suggestions;
use crate::app::capture::estimate::ExportEstimate;
use crate::app::capture::film_exporter::FilmExporter;
use crate::app::capture::image::ImageCaptures;
use crate::app::capture::saved_blends::SavedBlendsExport;
use crate::app::compare::comparison::Comparison;
use crate::app::files::file_dialog::FileDialogRequest;
use crate::app::files::gallery_thumbnails::GalleryThumbnails;
use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::map::map_view::MapView;
use crate::app::notices::Notices;
use crate::app::persistence::autosave::Autosave;
use crate::app::playback::player::Playback;
use crate::app::presentation::presenter::Presentation;
use crate::app::presentation::speaker_window::SpeakerWindow;
use crate::app::session::state::Session;
use crate::app::view::filmstrip::Filmstrip;
use crate::stage::PipelinesReady;

/// How long is waited, while work goes on, until it is shown how far it is; answers wake the
/// window. The longer ones are for where a frame takes long, as where the processor draws, to leave
/// it to the work. Steps, since each change of the mode draws a frame.
const LOOKS: [Duration; 4] = [
    Duration::from_millis(50),
    Duration::from_millis(100),
    Duration::from_millis(200),
    Duration::from_millis(400),
];

/// A clock of seconds is drawn this often: never more than half a second behind.
const TICK: Duration = Duration::from_millis(500);

/// At rest nothing is waited for. Not for ever: winit then keeps the time that it was to wake at
/// before, which has passed, and wakes all the time.
const REST: Duration = Duration::from_secs(3600);

/// Frames until all that came of an event is on the screen: panels are drawn after the systems
/// have run, what they ask for is acted on a frame later and seen in the frame after that, and the
/// renderer is a frame behind, and tells a frame later what it lacked.
const SETTLING: u8 = 6;

/// As many of them as are drawn one after the other while a transition is built: what is asked for,
/// and its answer. On two cores that also draw, two icons were first seen after 1.1 to 1.6 s with
/// all of them.
const SETTLING_AT_WORK: u8 = 2;

/// How soon the panels want to be drawn again of their own accord; without end where nothing of
/// them moves.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct PanelRepaint(pub Duration);

impl Default for PanelRepaint {
    fn default() -> Self {
        Self(Duration::MAX)
    }
}

/// What there is to draw for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RedrawPace {
    /// Something moves, or what has just happened is not on the screen yet.
    pub moves: bool,
    /// Something goes on that is seen to go on: work; or ends without telling: the time that a
    /// message stays.
    pub waits: bool,
    /// A clock is shown.
    pub ticks: bool,
    /// Nobody can see it.
    pub is_hidden: bool,
    /// What a frame takes.
    pub frame: Duration,
}

impl RedrawPace {
    /// When the next frame is drawn.
    #[must_use]
    pub fn mode(self) -> UpdateMode {
        match self {
            Self {
                is_hidden: true, ..
            } => UpdateMode::reactive_low_power(REST),
            Self { moves: true, .. } => UpdateMode::Continuous,
            Self { waits: true, .. } => UpdateMode::reactive_low_power(self.look()),
            Self { ticks: true, .. } => UpdateMode::reactive_low_power(TICK),
            _ => UpdateMode::reactive_low_power(REST),
        }
    }

    /// How soon work is looked at again: at least half of the time is left to it.
    fn look(self) -> Duration {
        let [.., most] = LOOKS;
        let enough = |look: &Duration| *look >= self.frame * 2;
        LOOKS.into_iter().find(enough).unwrap_or(most)
    }
}

/// All that the pace hangs on.
#[derive(SystemParam)]
pub struct RedrawInputs<'w, 's> {
    session: Res<'w, Session>,
    playback: Res<'w, Playback>,
    presenting: Res<'w, Presentation>,
    speaker: Res<'w, SpeakerWindow>,
    preferences: Res<'w, Preferences>,
    captures: Res<'w, ImageCaptures>,
    cataloguing: Res<'w, SavedBlendsExport>,
    shots: Query<'w, 's, (), With<Screenshot>>,
    recorder: Res<'w, FilmExporter>,
    estimate: Res<'w, ExportEstimate>,
    autosave: Res<'w, Autosave>,
    thumbnails: Res<'w, GalleryThumbnails>,
    choosing: Res<'w, MethodSearch>,
    measured: Res<'w, StageMeasures>,
    helping: Res<'w, Suggestions>,
    filmstrip: Res<'w, Filmstrip>,
    recording: Res<'w, StageRecording>,
    twin: Res<'w, Comparison>,
    map: Res<'w, MapView>,
    notices: Res<'w, Notices>,
    dialog: Res<'w, FileDialogRequest>,
    repaint: Res<'w, PanelRepaint>,
    pipelines: Option<Res<'w, PipelinesReady>>,
}

impl RedrawInputs<'_, '_> {
    fn moves(&self) -> bool {
        self.playback.is_playing()
            || (self.preferences.panels && self.preferences.times)
            || self.captures.is_awaited()
            || !self.shots.is_empty()
            || self.pipelines.as_ref().is_some_and(|p| !p.is_ready())
    }

    /// Panels slide, fade or find their size.
    fn slides(&self) -> bool {
        self.repaint.0.is_zero()
    }

    fn waits(&self) -> bool {
        // A cursor that blinks, a tip that is about to be shown.
        self.repaint.0 < REST
            || self.presenting.waits()
            || self.session.work().is_some()
            || self.recorder.work().is_some()
            || self.estimate.is_busy()
            || self.autosave.is_behind()
            || self.captures.is_writing()
            || self.cataloguing.is_busy()
            || self.thumbnails.is_busy()
            || self.choosing.told().is_some()
            || self.measured.is_busy()
            || self.helping.is_busy()
            || self.filmstrip.is_busy()
            || self.recording.is_busy()
            || self.twin.is_busy()
            || self.map.is_busy()
            || self.dialog.asks().is_some()
            // While the panels are hidden they wait themselves.
            || (self.preferences.panels && self.notices.is_passing())
    }

    /// Work has an answer: what comes of it is drawn in the frames to come.
    fn is_new(&self) -> bool {
        self.session.is_changed()
            || self.choosing.is_changed()
            || self.estimate.is_changed()
            || self.measured.is_changed()
            || self.helping.is_changed()
            || self.filmstrip.is_changed()
            || self.recording.is_changed()
            || self.twin.is_changed()
            || self.map.is_changed()
            || self.notices.is_changed()
    }
}

/// Chooses the pace of the next frame.
pub fn set_redraw_pace(
    going: RedrawInputs,
    (mut events, mut intents): (MessageReader<WindowEvent>, MessageReader<Intent>),
    (mut occlusions, redraws): (
        MessageReader<WindowOccluded>,
        Option<ResMut<Messages<RequestRedraw>>>,
    ),
    window: Query<Entity, With<PrimaryWindow>>,
    (mut settling, mut is_covered, mut frame): (Local<u8>, Local<bool>, Local<Duration>),
    (time, mut settings): (Res<Time<Real>>, ResMut<WinitSettings>),
    _main_thread: NonSendMarker,
) {
    let is_stirred = events.read().count() + intents.read().count() > 0 || going.is_new();
    let works = going.session.work().is_some();
    *settling = match (is_stirred, works) {
        (true, true) => SETTLING_AT_WORK,
        (true, false) => SETTLING,
        (false, _) => settling.saturating_sub(1),
    };
    // Nothing was waited for since the frame before.
    if settings.focused_mode == UpdateMode::Continuous {
        *frame = time.delta();
    }
    // A transition that is awaited is worth more than panels that slide: they jump.
    let jumps = works && *frame * 2 > LOOKS[0];
    if jumps && let Some(mut redraws) = redraws {
        redraws.clear();
    }
    let of_stage = |occlusion: &&WindowOccluded| !going.speaker.is_its(occlusion.window);
    if let Some(last) = occlusions.read().filter(of_stage).last() {
        *is_covered = last.occluded;
    }
    // What the speaker sees goes on, and what is not kept yet is kept.
    let is_needed = going.speaker.is_open() || going.autosave.is_behind();
    let pace = RedrawPace {
        moves: *settling > 0 || going.moves() || (going.slides() && !jumps),
        waits: going.waits(),
        ticks: going.speaker.is_open(),
        is_hidden: !is_needed && (*is_covered || window.iter().any(is_minimised)),
        frame: *frame,
    };
    let mode = pace.mode();
    // The same beside another window: a film goes on while notes are read. Looked at first:
    // nobody else is to think that they have changed.
    if (settings.focused_mode, settings.unfocused_mode) != (mode, mode) {
        (settings.focused_mode, settings.unfocused_mode) = (mode, mode);
    }
}

fn is_minimised(window: Entity) -> bool {
    WINIT_WINDOWS.with_borrow(|windows| {
        let window = windows.get_window(window);
        // None where the system does not tell.
        window.and_then(|w| w.is_minimized()).unwrap_or(false)
    })
}
