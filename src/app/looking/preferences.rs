//! Choices that belong to the person at the screen and not to the project.

use bevy::prelude::{MessageReader, ResMut, Resource};

use crate::app::asking::choices::{CaptureScale, RecordFormat, ThemeChoice};
use crate::app::asking::intent::Intent;
use crate::stage::Show;

/// What the person at the screen chose; not part of any project.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Preferences {
    /// The colours of the panels.
    pub theme: ThemeChoice,
    /// What the stage draws.
    pub show: Show,
    /// Panels are shown.
    pub panels: bool,
    /// The list of keys is shown.
    pub help: bool,
    /// The times of a frame are shown.
    pub times: bool,
    /// The measures against t are shown.
    pub plots: bool,
    /// Size of screenshots.
    pub capture_scale: CaptureScale,
    /// Screenshots and films have a transparent ground.
    pub capture_transparent: bool,
    /// Kind of file of a recording.
    pub record_format: RecordFormat,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            theme: ThemeChoice::default(),
            show: Show::default(),
            panels: true,
            help: false,
            times: false,
            plots: false,
            capture_scale: CaptureScale::default(),
            capture_transparent: false,
            record_format: RecordFormat::default(),
        }
    }
}

/// Acts on the intents that concern [`Preferences`].
pub fn apply(mut intents: MessageReader<Intent>, mut preferences: ResMut<Preferences>) {
    for intent in intents.read() {
        match intent {
            Intent::Show(show) => preferences.show = *show,
            Intent::ToggleGrid => preferences.show.grid = !preferences.show.grid,
            Intent::Theme(theme) => preferences.theme = *theme,
            Intent::TogglePanels => preferences.panels = !preferences.panels,
            Intent::ToggleHelp => preferences.help = !preferences.help,
            Intent::TogglePlots => preferences.plots = !preferences.plots,
            Intent::ToggleTimes => preferences.times = !preferences.times,
            Intent::CaptureScale(scale) => preferences.capture_scale = *scale,
            Intent::CaptureTransparent(on) => preferences.capture_transparent = *on,
            Intent::RecordFormat(format) => preferences.record_format = *format,
            _ => {}
        }
    }
}
