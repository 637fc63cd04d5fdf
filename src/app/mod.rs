//! The window: playback, panels, keys, capture.
//!
//! Built on the stage's plugin like any other Bevy program. Keys and panels write
//! [`Intent`]s; the systems here act on them; panels draw what there is. [`LogicPlugin`]
//! is everything that needs neither a window nor a graphics card, and is what the tests run.

mod capture;
mod choices;
mod closing;
mod dialogs;
mod editor;
mod files;
mod history;
mod intent;
mod job;
mod keymap;
mod loading;
mod measuring;
mod notices;
mod opening;
mod pace;
mod playback;
mod preferences;
mod record;
mod saving;
mod session;
mod staging;
mod thumbnails;
mod times;
mod twin;
mod ui;
mod view;

use std::path::PathBuf;

use bevy::app::{HierarchyPropagatePlugin, PropagateSet};
use bevy::camera::CameraOutputMode;
use bevy::camera::visibility::{RenderLayers, VisibilitySystems};
use bevy::prelude::*;
use bevy::render::render_resource::BlendState;
use bevy::window::{ExitCondition, WindowResolution};
use bevy_egui::{EguiGlobalSettings, PrimaryEguiContext};

pub use choices::{CaptureScale, RecordFormat, ThemeChoice};
pub use closing::Question;
pub use editor::{CutEnd, Editor, EditorAct, Fate, Grab, Handle, Sheet, Tool, Touch};
pub use files::CaptureFolder;
pub use intent::{Answer, Intent};
pub use keymap::{Binding, Held, KeyMap, Trigger, Typing};
pub use measuring::{Measured, Measures};
pub use notices::{Kind, Notice, Notices};
pub use opening::Gallery;
pub use playback::Playback;
pub use preferences::Preferences;
pub use session::Session;
pub use staging::OnStage;
pub use twin::{OnTwin, Twin, TwinMethod};
pub use view::{KeepsFit, StageArea};

use crate::stage::{MorphPlugin, MorphSystems, StageCamera};

/// What the command line hands to the window.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AppOptions {
    /// A project, or one or two designs; the gallery's first project where there is none.
    pub files: Vec<PathBuf>,
    /// The folder for pictures and films, instead of the user's pictures.
    pub captures: Option<PathBuf>,
}

/// Opens the window and returns when it was closed.
pub fn run(options: AppOptions) -> AppExit {
    let AppOptions { files, captures } = options;
    App::new()
        .add_plugins(DefaultPlugins.set(window()))
        .add_plugins((MorphPlugin, LogicPlugin, WindowPlugins))
        .insert_resource(CaptureFolder::choose(captures))
        .add_systems(
            Startup,
            move |mut intents: MessageWriter<Intent>, gallery: Res<Gallery>| {
                intents.write(first(&files, &gallery));
            },
        )
        .run()
}

fn first(files: &[PathBuf], gallery: &Gallery) -> Intent {
    let bundled = match files {
        [] => gallery.0.first().map(|entry| entry.name.clone()),
        [one] => one
            .to_str()
            .and_then(|name| name.strip_prefix("gallery:"))
            .map(str::to_owned),
        _ => None,
    };
    bundled.map_or_else(|| Intent::Open(files.to_vec()), Intent::OpenGallery)
}

fn window() -> WindowPlugin {
    WindowPlugin {
        primary_window: Some(Window {
            title: "Morphospace".to_owned(),
            name: Some("morphospace".to_owned()),
            resolution: WindowResolution::new(1280, 720),
            resize_constraints: WindowResizeConstraints {
                min_width: 960.0,
                min_height: 540.0,
                ..default()
            },
            ..default()
        }),
        exit_condition: ExitCondition::OnPrimaryClosed,
        close_when_requested: false,
        ..default()
    }
}

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
                    history::note_gesture,
                    keymap::read_keys,
                    dialogs::read_drops,
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
        .init_resource::<ClearColor>()
        .init_resource::<ButtonInput<MouseButton>>()
        .init_resource::<history::Gesture>()
        .init_resource::<Gallery>()
        .init_resource::<Session>()
        .init_resource::<Playback>()
        .init_resource::<Preferences>()
        .init_resource::<KeyMap>()
        .init_resource::<Typing>()
        .init_resource::<Editor>()
        .init_resource::<Sheet>()
        .init_resource::<Measured>()
        .init_resource::<Twin>()
        .init_resource::<Notices>()
        .init_resource::<Question>()
        .init_resource::<dialogs::Drop>()
        .init_resource::<record::Recorder>()
        .init_resource::<StageArea>()
        .init_resource::<KeepsFit>()
        .init_resource::<times::WholeFrame>()
        .insert_resource(CaptureFolder::choose(None));
}

/// The systems that act on intents. The order among them is that of their answers: what is opened
/// is taken in before it is played.
fn act() -> impl IntoScheduleConfigs<bevy::ecs::system::ScheduleSystem, ()> {
    (
        closing::read_close_requests,
        view::back,
        preferences::apply,
        (closing::answer, closing::close, dialogs::decide).chain(),
        (
            opening::open,
            opening::edit,
            editor::apply,
            measuring::apply,
            opening::save,
            opening::poll,
            editor::refresh,
        )
            .chain(),
        (measuring::follow, twin::apply, twin::follow).chain(),
        (playback::apply, playback::advance).chain(),
        (record::apply, record::report).chain(),
        view::apply,
        notices::apply,
    )
        .chain()
}

/// What the window adds: cameras, panels, dialogs, pictures.
#[derive(Debug)]
struct WindowPlugins;

impl Plugin for WindowPlugins {
    fn build(&self, app: &mut App) {
        app.add_plugins(ui::UiPlugin)
            .init_resource::<capture::Captures>()
            .init_resource::<dialogs::Dialog>()
            .init_resource::<thumbnails::Thumbnails>()
            .add_systems(Startup, spawn_cameras)
            .add_systems(Last, pace::keep)
            .add_systems(
                Update,
                (
                    (dialogs::open, dialogs::finish).chain(),
                    view::window_mode,
                    (view::fit, view::place_camera).chain(),
                    thumbnails::advance,
                )
                    .after(MorphSystems::Playback)
                    .before(MorphSystems::Build),
            )
            .add_systems(
                Update,
                capture::ask
                    .after(MorphSystems::Draw)
                    .before(MorphSystems::Capture),
            )
            .add_systems(
                PostUpdate,
                view::place_twin.before(TransformSystems::Propagate),
            )
            .add_plugins(HierarchyPropagatePlugin::<RenderLayers>::new(PostUpdate))
            .configure_sets(
                PostUpdate,
                PropagateSet::<RenderLayers>::default().before(VisibilitySystems::CheckVisibility),
            )
            .add_systems(
                Update,
                (capture::receive, capture::report).after(MorphSystems::Capture),
            );
    }
}

/// One camera for the stage, in its part of the window, one for the second method beside it, and
/// one above them for the panels.
fn spawn_cameras(mut commands: Commands, mut egui: ResMut<EguiGlobalSettings>) {
    egui.auto_create_primary_context = false;
    commands.spawn(StageCamera);
    commands.spawn((
        view::TwinCamera,
        Camera2d,
        Msaa::Sample4,
        staging::TWIN_LAYER,
        Camera {
            order: 1,
            // The first camera has cleared the whole window.
            clear_color: ClearColorConfig::None,
            is_active: false,
            ..default()
        },
    ));
    commands.spawn((
        PrimaryEguiContext,
        Camera2d,
        // As the stage's: the cameras of one window share its depth texture.
        Msaa::Sample4,
        RenderLayers::none(),
        Camera {
            order: 2,
            output_mode: CameraOutputMode::Write {
                blend_state: Some(BlendState::ALPHA_BLENDING),
                clear_color: ClearColorConfig::None,
            },
            clear_color: ClearColorConfig::Custom(Color::NONE),
            ..default()
        },
    ));
}
