//! System that applies the intents which change the user's preferences.

use bevy::prelude::{MessageReader, ResMut};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;

/// Applies the intents that change [`Preferences`].
pub fn apply(mut intents: MessageReader<Intent>, mut preferences: ResMut<Preferences>) {
    for intent in intents.read() {
        match intent {
            Intent::SetPreferences(chosen) => *preferences = *chosen,
            Intent::ToggleGrid => preferences.show.grid = !preferences.show.grid,
            Intent::ToggleOnion => preferences.onion = !preferences.onion,
            Intent::TogglePanels => preferences.panels = !preferences.panels,
            Intent::ToggleHelp => preferences.help = !preferences.help,
            Intent::TogglePlots => preferences.plots = !preferences.plots,
            Intent::ToggleFrameTimes => preferences.times = !preferences.times,
            _ => {}
        }
    }
}
