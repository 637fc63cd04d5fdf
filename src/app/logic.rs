//! The order of all that happens in a frame, but for what needs a window or a graphics card.

use bevy::prelude::*;

use crate::app::asking::choices::Preferences;
use crate::app::asking::hand::{self, Typing};
use crate::app::asking::intent::Intent;
use crate::app::asking::keymap::{self, KeyMap};
use crate::app::capturing::files::{CaptureFolder, Workshop};
use crate::app::capturing::films;
use crate::app::capturing::{estimate, framing, kept};
use crate::app::editing::editor::Editor;
use crate::app::editing::sheet::Sheet;
use crate::app::editing::{apply, refresh};
use crate::app::keeping::autosave::{self, Autosave};
use crate::app::keeping::{presets, recent};
use crate::app::looking::choosing::{self, Choosing};
use crate::app::looking::helping::{self, Helping};
use crate::app::looking::map::MapView;
use crate::app::looking::measuring::{self, Measured};
use crate::app::looking::recording::{self, Recording};
use crate::app::looking::times;
use crate::app::looking::twin::{self, Twin};
use crate::app::looking::view::{self, KeepsFit, StageArea};
use crate::app::looking::{blending, onion, preferences, walking};
use crate::app::opening::apply::{self as opening, Gallery};
use crate::app::opening::closing::{self, Question};
use crate::app::opening::{dialogs, drops, preview, watching};
use crate::app::playing::playback::{self, Playback};
use crate::app::playing::presenting::{self, Presenting};
use crate::app::playing::staging;
use crate::app::session::state::Session;
use crate::app::telling::notices::{self, Notices};
use crate::stage::MorphSystems;

/// Everything that needs neither a window nor a graphics card.
#[derive(Clone, Copy, Debug, Default)]
pub struct LogicPlugin;

impl Plugin for LogicPlugin {
    fn build(&self, app: &mut App) {
        use MorphSystems::{Build, Input, Playback as Play};
        init(app);
        app.configure_sets(Update, (Input, Play, Build).chain())
            .add_systems(
                Update,
                (
                    times::record,
                    hand::note_gesture,
                    keymap::read_keys,
                    drops::read_drops,
                )
                    .in_set(Input),
            )
            .add_systems(Update, act().in_set(Play))
            .add_systems(
                Update,
                (
                    staging::stage_transition,
                    staging::stage_twin,
                    staging::stage_t,
                    staging::stage_style,
                )
                    .chain()
                    .after(Play)
                    .before(Build),
            );
    }
}

fn init(app: &mut App) {
    app.add_message::<Intent>()
        .add_message::<bevy::window::FileDragAndDrop>()
        .add_message::<bevy::window::WindowCloseRequested>()
        .add_message::<bevy::window::CursorMoved>()
        .init_resource::<ClearColor>()
        .init_resource::<ButtonInput<MouseButton>>()
        .init_resource::<hand::Gesture>()
        .init_resource::<Gallery>()
        .init_resource::<Session>()
        .init_resource::<Playback>()
        .init_resource::<Presenting>()
        .init_resource::<Preferences>()
        .init_resource::<KeyMap>()
        .init_resource::<Typing>()
        .init_resource::<hand::Marked>()
        .init_resource::<Editor>()
        .init_resource::<Sheet>()
        .init_resource::<Measured>()
        .init_resource::<Choosing>()
        .init_resource::<onion::Onion>()
        .init_resource::<Helping>()
        .init_resource::<Recording>()
        .init_resource::<Twin>()
        .init_resource::<MapView>()
        .init_resource::<kept::Cataloguing>()
        .init_resource::<Notices>()
        .init_resource::<Question>()
        .init_resource::<Autosave>()
        .init_resource::<presets::KeptPresets>()
        .init_resource::<recent::KeptRecent>()
        .init_resource::<drops::Drop>()
        .init_resource::<watching::Watch>()
        .init_resource::<dialogs::Dialog>()
        .init_resource::<preview::Preview>()
        .init_resource::<films::Recorder>()
        .init_resource::<framing::FilmFrame>()
        .init_resource::<Workshop>()
        .init_resource::<estimate::Estimate>()
        .init_resource::<StageArea>()
        .init_resource::<KeepsFit>()
        .init_resource::<times::WholeFrame>()
        .insert_resource(CaptureFolder::choose(None));
}

/// The systems that act on intents. The order among them is that of their answers: what is opened
/// is taken in before it is played.
fn act() -> impl IntoScheduleConfigs<bevy::ecs::system::ScheduleSystem, ()> {
    (
        // Before all that reads intents, so that closing takes no frame longer than a key.
        closing::read_close_requests,
        // Before what opens or shows anything: Esc leaves what was there when it was pressed.
        (view::back, presenting::apply).chain(),
        (preferences::apply, presets::apply).chain(),
        // Questions before what they hold back.
        // The lowest question first: each looks whether another lies above it.
        (
            drops::decide,
            autosave::rescue,
            closing::answer,
            closing::close,
        )
            .chain(),
        (dialogs::choose, dialogs::open, preview::follow).chain(),
        (
            opening::open,
            opening::edit,
            apply::apply,
            measuring::apply,
            choosing::apply,
            helping::apply,
            opening::save,
            opening::poll,
            refresh::refresh,
        )
            .chain(),
        (
            recording::follow,
            measuring::follow,
            helping::follow,
            twin::apply,
            twin::follow,
            (walking::apply, blending::follow, kept::export).chain(),
        )
            .chain(),
        // Moved on before it is told where to go: else the time of a rest would be played at once.
        (playback::advance, presenting::begin, playback::apply).chain(),
        (staging::follow_leg, presenting::hide_pointer).chain(),
        (
            films::apply,
            films::report,
            framing::follow,
            estimate::follow,
        )
            .chain(),
        view::apply,
        watching::follow,
        onion::follow,
        // After all that changes the project or takes it for saved.
        (autosave::follow, recent::follow).chain(),
        notices::apply,
    )
        .chain()
}
