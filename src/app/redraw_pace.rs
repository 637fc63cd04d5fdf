//! Chooses how often the window redraws: continuously while something moves, at intervals while
//! work is in progress, and otherwise not at all. This saves battery, for example during a talk.
//!
//! Input and other system events always wake the window.

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
use crate::app::files::picture_readings::PictureReadings;
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

/// Intervals, shortest first, at which the progress of background work may be redrawn. If drawing
/// is slow, as with software rendering, a longer interval leaves time for the work. The choices are
/// few, because each change of the update mode costs a redraw (heuristic).
const PROGRESS_INTERVALS: [Duration; 4] = [
    Duration::from_millis(50),
    Duration::from_millis(100),
    Duration::from_millis(200),
    Duration::from_millis(400),
];

/// Redraw interval while the speaker window shows its clock, which then lags by half a second at
/// most.
const CLOCK_INTERVAL: Duration = Duration::from_millis(500);

/// Redraw interval while nothing changes. It is finite, so that winit always gets a new wake-up
/// time. Without one, winit keeps the previous time, which has passed, and wakes continuously.
const REST_INTERVAL: Duration = Duration::from_secs(3600);

/// Number of screen updates after an event until all its effects are on screen. Panels are drawn
/// after the other systems; their intents are applied one update later and visible in the next. The
/// renderer lags another update, and reports uncompiled render pipelines one update later still.
const SETTLING_FRAMES: u8 = 6;

/// Number of screen updates after an event while a transition is being built: fewer, to leave time
/// for the build (heuristic).
const SETTLING_FRAMES_AT_WORK: u8 = 2;

/// Time after which the panels must be redrawn even without input; `Duration::MAX` if nothing in
/// them moves.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct PanelRepaint(pub Duration);

impl Default for PanelRepaint {
    fn default() -> Self {
        Self(Duration::MAX)
    }
}

/// Conditions that decide how often the window redraws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RedrawPace {
    /// Whether something moves, or the effects of an event are not all on screen yet.
    pub is_moving: bool,
    /// Whether background work is in progress, or something will change by itself, such as a notice
    /// that disappears.
    pub is_waiting: bool,
    /// Whether the speaker window shows its clock.
    pub has_clock: bool,
    /// Whether the window is minimised or covered, and nothing else requires it to be redrawn.
    pub is_hidden: bool,
    /// Time that the last screen update took, without waiting.
    pub frame: Duration,
}

impl RedrawPace {
    /// Update mode of the window until the next screen update.
    #[must_use]
    pub fn update_mode(self) -> UpdateMode {
        match self {
            Self {
                is_hidden: true, ..
            } => UpdateMode::reactive_low_power(REST_INTERVAL),
            Self {
                is_moving: true, ..
            } => UpdateMode::Continuous,
            Self {
                is_waiting: true, ..
            } => UpdateMode::reactive_low_power(self.progress_interval()),
            Self {
                has_clock: true, ..
            } => UpdateMode::reactive_low_power(CLOCK_INTERVAL),
            _ => UpdateMode::reactive_low_power(REST_INTERVAL),
        }
    }

    /// Interval for redrawing progress: at least twice the time per screen update, so that at least
    /// half the time is left for the background work.
    fn progress_interval(self) -> Duration {
        let [.., longest] = PROGRESS_INTERVALS;
        let is_long_enough = |interval: &Duration| *interval >= self.frame * 2;
        PROGRESS_INTERVALS
            .into_iter()
            .find(is_long_enough)
            .unwrap_or(longest)
    }
}

/// Resources and entities that the redraw rate depends on.
#[derive(SystemParam)]
pub struct RedrawInputs<'w, 's> {
    session: Res<'w, Session>,
    playback: Res<'w, Playback>,
    presentation: Res<'w, Presentation>,
    speaker: Res<'w, SpeakerWindow>,
    preferences: Res<'w, Preferences>,
    captures: Res<'w, ImageCaptures>,
    saved_blends: Res<'w, SavedBlendsExport>,
    shots: Query<'w, 's, (), With<Screenshot>>,
    exporter: Res<'w, FilmExporter>,
    estimate: Res<'w, ExportEstimate>,
    autosave: Res<'w, Autosave>,
    thumbnails: Res<'w, GalleryThumbnails>,
    method_search: Res<'w, MethodSearch>,
    measures: Res<'w, StageMeasures>,
    suggestions: Res<'w, Suggestions>,
    filmstrip: Res<'w, Filmstrip>,
    recording: Res<'w, StageRecording>,
    comparison: Res<'w, Comparison>,
    map: Res<'w, MapView>,
    notices: Res<'w, Notices>,
    dialog: Res<'w, FileDialogRequest>,
    readings: Res<'w, PictureReadings>,
    repaint: Res<'w, PanelRepaint>,
    pipelines: Option<Res<'w, PipelinesReady>>,
}

impl RedrawInputs<'_, '_> {
    /// Whether something on the stage moves, or a rendered image is awaited.
    fn is_stage_moving(&self) -> bool {
        self.playback.is_playing()
            || (self.preferences.panels && self.preferences.times)
            || self.captures.is_rendering()
            || !self.shots.is_empty()
            || self.pipelines.as_ref().is_some_and(|p| !p.is_ready())
    }

    /// Whether panels slide, fade or change size.
    fn are_panels_animating(&self) -> bool {
        self.repaint.0.is_zero()
    }

    /// Whether something will change by itself, such as the progress of work.
    fn is_work_pending(&self) -> bool {
        // The panels have a repaint due, for example for a blinking cursor or a tooltip.
        self.repaint.0 < REST_INTERVAL
            || self.presentation.has_pending_change()
            || self.session.work().is_some()
            || self.exporter.work().is_some()
            || self.estimate.is_busy()
            || self.autosave.is_behind()
            || self.captures.is_writing()
            || self.saved_blends.is_busy()
            || self.thumbnails.is_busy()
            || self.method_search.visible_progress().is_some()
            || self.measures.is_busy()
            || self.suggestions.is_busy()
            || self.filmstrip.is_busy()
            || self.recording.is_busy()
            || self.comparison.is_busy()
            || self.map.is_busy()
            || self.dialog.purpose().is_some()
            || self.readings.is_busy()
            // Notices do not age while the panels are hidden.
            || (self.preferences.panels && self.notices.has_expiring())
    }

    /// Whether background work has delivered a result that must be drawn.
    fn has_new_results(&self) -> bool {
        self.session.is_changed()
            || self.method_search.is_changed()
            || self.estimate.is_changed()
            || self.measures.is_changed()
            || self.suggestions.is_changed()
            || self.filmstrip.is_changed()
            || self.recording.is_changed()
            || self.comparison.is_changed()
            || self.map.is_changed()
            || self.notices.is_changed()
            || self.readings.is_changed()
    }
}

/// Messages that affect the redraw rate.
#[derive(SystemParam)]
pub struct RedrawMessages<'w, 's> {
    /// Input and other events of all windows.
    events: MessageReader<'w, 's, WindowEvent>,
    /// The user's intents.
    intents: MessageReader<'w, 's, Intent>,
    /// Reports that a window was covered or uncovered.
    occlusions: MessageReader<'w, 's, WindowOccluded>,
    /// Requests to redraw at once; `None` without a window backend.
    requests: Option<ResMut<'w, Messages<RequestRedraw>>>,
}

/// Data that [`set_redraw_pace`] needs from earlier screen updates.
#[derive(SystemParam)]
pub struct RedrawState<'s> {
    /// Number of screen updates still to draw until the effects of the last event are on screen.
    settling: Local<'s, u8>,
    /// Whether the main window is covered by other windows.
    is_covered: Local<'s, bool>,
    /// Duration of the last screen update that was not preceded by waiting.
    frame: Local<'s, Duration>,
}

/// Sets the update mode that applies until the next screen update.
pub fn set_redraw_pace(
    inputs: RedrawInputs,
    mut messages: RedrawMessages,
    window: Query<Entity, With<PrimaryWindow>>,
    mut state: RedrawState,
    time: Res<Time<Real>>,
    mut settings: ResMut<WinitSettings>,
    _main_thread: NonSendMarker,
) {
    let messages_read = messages.events.read().count() + messages.intents.read().count();
    let has_news = messages_read > 0 || inputs.has_new_results();
    let is_building = inputs.session.work().is_some();
    *state.settling = match (has_news, is_building) {
        (true, true) => SETTLING_FRAMES_AT_WORK,
        (true, false) => SETTLING_FRAMES,
        (false, _) => state.settling.saturating_sub(1),
    };
    // In continuous mode the time between two screen updates includes no waiting.
    if settings.focused_mode == UpdateMode::Continuous {
        *state.frame = time.delta();
    }
    // While a transition is being built and screen updates are slow, panels jump to their end
    // position instead of sliding, which leaves more time for the build.
    let skips_sliding = is_building && *state.frame * 2 > PROGRESS_INTERVALS[0];
    if skips_sliding && let Some(requests) = &mut messages.requests {
        requests.clear();
    }
    // The speaker window may be covered without any effect on the stage.
    let is_stage_window =
        |occlusion: &&WindowOccluded| !inputs.speaker.owns_window(occlusion.window);
    if let Some(last) = messages.occlusions.read().filter(is_stage_window).last() {
        *state.is_covered = last.occluded;
    }
    // A hidden window must still be updated while the speaker window is open or an autosave is
    // pending.
    let is_needed = inputs.speaker.is_open() || inputs.autosave.is_behind();
    let pace = RedrawPace {
        is_moving: *state.settling > 0
            || inputs.is_stage_moving()
            || (inputs.are_panels_animating() && !skips_sliding),
        is_waiting: inputs.is_work_pending(),
        has_clock: inputs.speaker.is_open(),
        is_hidden: !is_needed && (*state.is_covered || window.iter().any(is_minimised)),
        frame: *state.frame,
    };
    let mode = pace.update_mode();
    // The mode is the same with and without focus, so that the film continues while another window
    // is used. The modes are compared first, because writing them reports a change.
    if (settings.focused_mode, settings.unfocused_mode) != (mode, mode) {
        (settings.focused_mode, settings.unfocused_mode) = (mode, mode);
    }
}

/// Whether the window is minimised.
fn is_minimised(window: Entity) -> bool {
    WINIT_WINDOWS.with_borrow(|windows| {
        let window = windows.get_window(window);
        // `None` on systems that do not report whether a window is minimised.
        window.and_then(|w| w.is_minimized()).unwrap_or(false)
    })
}
