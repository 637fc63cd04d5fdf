//! The window itself: its size, its cameras, and what it adds to the logic.

use std::path::PathBuf;

use bevy::app::{HierarchyPropagatePlugin, PropagateSet, TerminalCtrlCHandlerPlugin};
use bevy::camera::visibility::{RenderLayers, VisibilitySystems};
use bevy::camera::{CameraOutputMode, CompositingSpace};
use bevy::prelude::*;
use bevy::render::render_resource::BlendState;
use bevy::window::{ExitCondition, WindowMode, WindowResolution};
use bevy::winit::{EventLoopProxyWrapper, WinitUserEvent};
use bevy_egui::{EguiGlobalSettings, PrimaryEguiContext};

use crate::app::asking::intent::Intent;
use crate::app::capturing::files::CaptureFolder;
use crate::app::capturing::{blends, copying, pictures};
use crate::app::keeping::autosave::{self, Autosave};
use crate::app::keeping::presets::KeptPresets;
use crate::app::keeping::recent::{KeptRecent, Recent};
use crate::app::keeping::strips::KeptStrips;
use crate::app::logic::LogicPlugin;
use crate::app::looking::recording::Recording;
use crate::app::looking::{filmstrip, view};
use crate::app::opening::apply::Gallery;
use crate::app::opening::thumbnails;
use crate::app::opening::watching::Watch;
use crate::app::playing::presenting::whole_screen;
use crate::app::playing::{pace, speaker, staging};
use crate::app::starting::{NoWindow, opened};
use crate::app::telling::job;
use crate::app::telling::spare::share_arenas;
use crate::app::ui::draw::UiPlugin;
use crate::export::Presets;
use crate::stage::{MorphPlugin, MorphSystems, StageCamera};

/// What the command line hands to the window.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AppOptions {
    /// A project, or one or two designs; the gallery's first project where there is none.
    pub files: Vec<PathBuf>,
    /// The folder for pictures and films, instead of the user's pictures.
    pub captures: Option<PathBuf>,
    /// What a film may take, in MiB, instead of what it may usually.
    pub film_memory: Option<usize>,
    /// A talk begins at once, and the window closes with it.
    pub presents: bool,
}

/// Opens the window and returns when it was closed.
///
/// # Errors
/// [`NoWindow`] where there is none to open.
pub fn run(options: AppOptions) -> Result<AppExit, NoWindow> {
    opened(|| program(options).run())
}

fn program(options: AppOptions) -> App {
    let AppOptions {
        files,
        captures,
        film_memory,
        presents,
    } = options;
    share_arenas();
    let autosave = autosave();
    let mut app = App::new();
    // Whose handler wakes nobody; ours does.
    let plugins = DefaultPlugins
        .set(window(presents))
        .disable::<TerminalCtrlCHandlerPlugin>();
    app.add_plugins(plugins)
        .add_plugins((MorphPlugin, LogicPlugin, WindowPlugins))
        .insert_resource(CaptureFolder::choose(captures))
        .insert_resource(Recording::within(film_memory))
        .insert_resource(autosave.workshop())
        .insert_resource(autosave)
        .insert_resource(KeptPresets::of_file(Presets::usual_path()))
        .insert_resource(KeptRecent::of_file(Recent::usual_path()))
        .insert_resource(KeptStrips::usual())
        .add_systems(
            Startup,
            move |mut intents: MessageWriter<Intent>, gallery: Res<Gallery>| {
                intents.write(first(&files, &gallery));
                if presents {
                    intents.write(Intent::Present { is_all: true });
                }
            },
        )
        .add_systems(Startup, (watch, be_woken))
        .add_systems(Update, TerminalCtrlCHandlerPlugin::exit_on_flag);
    end_when_told();
    app
}

/// Ctrl-C in the terminal, and the system's wish that the program ends, are heard at rest too, where
/// no frame would come to look at them.
fn end_when_told() {
    let listens = ctrlc::set_handler(|| {
        TerminalCtrlCHandlerPlugin::gracefully_exit();
        job::wake();
    });
    if let Err(error) = listens {
        warn!("the window cannot be ended from the terminal: {error}");
    }
}

/// A file that has changed wakes the window, which may be at rest.
fn watch(watch: Res<Watch>, events: Res<EventLoopProxyWrapper>) {
    let events = events.clone();
    watch.start(move || {
        // The window is gone, and the thread with it.
        events.send_event(WinitUserEvent::WakeUp).ok();
    });
}

/// Work that has something to tell wakes it too.
fn be_woken(events: Res<EventLoopProxyWrapper>) {
    let events = events.clone();
    job::wake_by(move || {
        // The window is gone, and the work is nobody's.
        events.send_event(WinitUserEvent::WakeUp).ok();
    });
}

/// Where there is no place for it, the program runs without.
fn autosave() -> Autosave {
    let Some(folder) = autosave::folder() else {
        return Autosave::default();
    };
    Autosave::enter(&folder).unwrap_or_else(|error| {
        warn!("changes are not kept in {}: {error}", folder.display());
        Autosave::default()
    })
}

fn first(files: &[PathBuf], gallery: &Gallery) -> Intent {
    let bundled = match files {
        [] => gallery.0.first().map(|entry| entry.name.clone()),
        [one] => one
            .to_str()
            // Also what the command line calls a bundled project in all its subcommands.
            .and_then(|name| name.strip_prefix("gallery:"))
            .map(str::to_owned),
        _ => None,
    };
    bundled.map_or_else(|| Intent::Open(files.to_vec()), Intent::OpenGallery)
}

fn window(presents: bool) -> WindowPlugin {
    WindowPlugin {
        primary_window: Some(Window {
            title: "Morphospace".to_owned(),
            name: Some("morphospace".to_owned()),
            // From its first frame on.
            mode: if presents {
                whole_screen()
            } else {
                WindowMode::Windowed
            },
            resolution: WindowResolution::new(1280, 720),
            resize_constraints: WindowResizeConstraints {
                // The list of keys, which is the largest, fits into it.
                min_width: 960.0,
                min_height: 540.0,
                ..default()
            },
            ..default()
        }),
        exit_condition: ExitCondition::OnPrimaryClosed,
        // Closing is an intent, which asks first where something would be lost.
        close_when_requested: false,
        ..default()
    }
}

/// What the window adds to [`LogicPlugin`]: cameras, panels, dialogs, pictures. Wants Bevy's own
/// plugins; without a renderer it draws to nowhere.
#[derive(Clone, Copy, Debug, Default)]
pub struct WindowPlugins;

impl Plugin for WindowPlugins {
    fn build(&self, app: &mut App) {
        app.add_plugins(UiPlugin)
            .init_resource::<pictures::Captures>()
            .init_non_send::<copying::Board>()
            .init_resource::<KeptStrips>()
            .init_resource::<thumbnails::Thumbnails>()
            .init_resource::<filmstrip::Filmstrip>()
            .init_resource::<speaker::Speaker>()
            .add_systems(Startup, spawn_cameras)
            // Last: what this frame has begun decides how soon the next one comes.
            .add_systems(Last, pace::keep)
            .add_systems(
                Update,
                (
                    view::window_mode,
                    (view::fit, view::place_camera).chain(),
                    (speaker::apply, speaker::follow).chain(),
                    (thumbnails::advance, filmstrip::follow),
                )
                    .after(MorphSystems::Playback)
                    .before(MorphSystems::Build),
            )
            .add_systems(
                Update,
                (pictures::ask, copying::copy_shapes, blends::take)
                    .after(MorphSystems::Draw)
                    .before(MorphSystems::Capture),
            )
            .add_systems(
                PostUpdate,
                // After the first camera has been placed, and before transforms are passed on: else
                // the second would lag a frame.
                view::place_twin.before(TransformSystems::Propagate),
            )
            .add_plugins(HierarchyPropagatePlugin::<RenderLayers>::new(PostUpdate))
            .configure_sets(
                PostUpdate,
                PropagateSet::<RenderLayers>::default().before(VisibilitySystems::CheckVisibility),
            )
            .add_systems(
                Update,
                (pictures::receive, pictures::report).after(MorphSystems::Capture),
            );
    }
}

/// One camera for the stage, in its part of the window, one for the second method beside it, and
/// one above them for the panels.
fn spawn_cameras(mut commands: Commands, mut egui: ResMut<EguiGlobalSettings>) {
    // It would be given to the stage's camera, whose part of the window is not the whole.
    egui.auto_create_primary_context = false;
    commands.spawn(StageCamera);
    commands.spawn((
        view::TwinCamera,
        Camera2d,
        Msaa::Sample4,
        CompositingSpace::Srgb,
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
                // What egui draws is multiplied by its alpha already.
                blend_state: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                clear_color: ClearColorConfig::None,
            },
            clear_color: ClearColorConfig::Custom(Color::NONE),
            ..default()
        },
    ));
}
