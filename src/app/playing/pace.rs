//! How often the window draws: all the time while something moves, and hardly ever while nothing
//! does, so that a talk does not drain the battery and a fan stays quiet.

use std::time::Duration;

use bevy::prelude::{DetectChanges, Res, ResMut};
use bevy::winit::{UpdateMode, WinitSettings};

use crate::app::asking::choices::Preferences;
use crate::app::capturing::films::Recorder;
use crate::app::capturing::pictures::Captures;
use crate::app::looking::measuring::Measured;
use crate::app::looking::twin::Twin;
use crate::app::opening::dialogs::Dialog;
use crate::app::opening::thumbnails::Thumbnails;
use crate::app::playing::playback::Playback;
use crate::app::session::state::Session;

/// While nothing moves, the window looks this often for what no event tells of: soon enough not to
/// be noticed, and rarely enough for the processor to rest.
const IDLE: Duration = Duration::from_millis(100);

/// Chooses the pace of the next frame. Keys and the pointer wake the window at any pace.
pub fn keep(
    (session, playback, preferences): (Res<Session>, Res<Playback>, Res<Preferences>),
    (captures, recorder): (Res<Captures>, Res<Recorder>),
    (thumbnails, dialog): (Res<Thumbnails>, Res<Dialog>),
    (measured, twin): (Res<Measured>, Res<Twin>),
    mut settings: ResMut<WinitSettings>,
) {
    // Work beside the window sends no event when it is done: it is asked each frame.
    let is_busy = playback.is_playing()
        // What came of a change is drawn in the next frame, which no event asks for.
        || session.is_changed()
        || session.work().is_some()
        || captures.is_busy()
        || recorder.work().is_some()
        || thumbnails.is_busy()
        || dialog.is_open()
        || measured.is_busy()
        || twin.is_busy()
        || preferences.times;
    let mode = if is_busy {
        UpdateMode::Continuous
    } else {
        UpdateMode::reactive_low_power(IDLE)
    };
    if settings.focused_mode != mode {
        settings.focused_mode = mode;
        // The same behind another window: a film goes on while notes are read.
        settings.unfocused_mode = mode;
    }
}
