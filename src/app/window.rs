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

use crate::app::analysis::stage_recording::StageRecording;
use crate::app::capture::{blend_image, clipboard, image};
use crate::app::files::file_watcher::FileWatcher;
use crate::app::files::gallery_thumbnails;
use crate::app::files::project_actions::GalleryEntries;
use crate::app::input::intent::Intent;
use crate::app::jobs::allocator::share_arenas;
use crate::app::jobs::job;
use crate::app::logic::LogicPlugin;
use crate::app::no_window::{NoWindowError, catch_no_window};
use crate::app::output_files::CaptureFolder;
use crate::app::persistence::autosave;
use crate::app::persistence::autosave::Autosave;
use crate::app::persistence::film_presets::StoredPresets;
use crate::app::persistence::gallery_strips::GalleryStripCache;
use crate::app::persistence::recent_files::{RecentFiles, StoredRecentFiles};
use crate::app::presentation::presenter::fullscreen_mode;
use crate::app::presentation::speaker_window;
use crate::app::ui::draw::UiPlugin;
use crate::app::view::{filmstrip, stage_area};
use crate::app::{redraw_pace, stage_sync};
use crate::export::FilmPresets;
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
/// [`NoWindowError`] where there is none to open.
pub fn run(options: AppOptions) -> Result<AppExit, NoWindowError> {
    catch_no_window(|| program(options).run())
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
        .insert_resource(StageRecording::within(film_memory))
        .insert_resource(autosave.workshop())
        .insert_resource(autosave)
        .insert_resource(StoredPresets::of_file(FilmPresets::usual_path()))
        .insert_resource(StoredRecentFiles::of_file(RecentFiles::usual_path()))
        .insert_resource(GalleryStripCache::usual())
        .add_systems(
            Startup,
            move |mut intents: MessageWriter<Intent>, gallery: Res<GalleryEntries>| {
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
fn watch(watch: Res<FileWatcher>, events: Res<EventLoopProxyWrapper>) {
    let events = events.clone();
    watch.start(move || {
        // The window is gone, and the thread with it.
        events.send_event(WinitUserEvent::WakeUp).ok();
    });
}

/// Work that has something to tell wakes it too.
fn be_woken(events: Res<EventLoopProxyWrapper>) {
    let events = events.clone();
    job::set_waker(move || {
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

fn first(files: &[PathBuf], gallery: &GalleryEntries) -> Intent {
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
                fullscreen_mode()
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
            .init_resource::<image::ImageCaptures>()
            .init_non_send::<clipboard::SystemClipboard>()
            .init_resource::<GalleryStripCache>()
            .init_resource::<gallery_thumbnails::GalleryThumbnails>()
            .init_resource::<filmstrip::Filmstrip>()
            .init_resource::<speaker_window::SpeakerWindow>()
            .add_systems(Startup, spawn_cameras)
            // Last: what this frame has begun decides how soon the next one comes.
            .add_systems(Last, redraw_pace::set_redraw_pace)
            .add_systems(
                Update,
                (
                    stage_area::window_mode,
                    (stage_area::fit, stage_area::place_camera).chain(),
                    (speaker_window::apply, speaker_window::follow).chain(),
                    (gallery_thumbnails::advance, filmstrip::follow),
                )
                    .after(MorphSystems::Playback)
                    .before(MorphSystems::Build),
            )
            .add_systems(
                Update,
                (image::ask, clipboard::copy_shapes, blend_image::take)
                    .after(MorphSystems::Draw)
                    .before(MorphSystems::Capture),
            )
            .add_systems(
                PostUpdate,
                // After the first camera has been placed, and before transforms are passed on: else
                // the second would lag a frame.
                stage_area::place_twin.before(TransformSystems::Propagate),
            )
            .add_plugins(HierarchyPropagatePlugin::<RenderLayers>::new(PostUpdate))
            .configure_sets(
                PostUpdate,
                PropagateSet::<RenderLayers>::default().before(VisibilitySystems::CheckVisibility),
            )
            .add_systems(
                Update,
                (image::receive, image::report).after(MorphSystems::Capture),
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
        stage_area::ComparisonCamera,
        Camera2d,
        Msaa::Sample4,
        CompositingSpace::Srgb,
        stage_sync::TWIN_LAYER,
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
