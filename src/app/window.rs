//! Creates the application window and its cameras, and adds the systems that need a window to
//! [`LogicPlugin`].

use std::path::{Path, PathBuf};

use bevy::app::{HierarchyPropagatePlugin, PropagateSet, TerminalCtrlCHandlerPlugin};
use bevy::camera::visibility::{RenderLayers, VisibilitySystems};
use bevy::camera::{CameraOutputMode, CompositingSpace};
use bevy::prelude::*;
use bevy::render::render_resource::BlendState;
use bevy::window::{ExitCondition, PrimaryWindow, WindowMode, WindowResizeConstraints};
use bevy::winit::{EventLoopProxyWrapper, WinitUserEvent};
use bevy_egui::{EguiGlobalSettings, PrimaryEguiContext};

use crate::app::analysis::stage_recording::StageRecording;
use crate::app::capture::{blend_image, clipboard, image};
use crate::app::escape;
use crate::app::files::drop::DropSupport;
use crate::app::files::file_watcher::FileWatcher;
use crate::app::files::gallery_thumbnails;
use crate::app::input::intent::Intent;
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
use crate::app::screen_fit::MIN_SIZE;
use crate::app::session::state::Session;
use crate::app::stage_area::INITIAL_SIZE;
use crate::app::ui::draw::UiPlugin;
use crate::app::view::{filmstrip, stage_camera};
use crate::app::{redraw_pace, screen_fit, stage_sync, window_system};
use crate::export::FilmPresets;
use crate::stage::{MorphPlugin, MorphSystems, StageCamera};

/// Options of the window, as given on the command line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AppOptions {
    /// One project, or designs to open together; empty shows the invitation and plays a gallery
    /// project.
    pub files: Vec<PathBuf>,
    /// Folder for exported images and films until the user chooses another one; `None` is the
    /// folder of the project.
    pub captures: Option<PathBuf>,
    /// Maximum memory for the recording of a transition, in MiB; `None` is the default limit.
    pub film_memory: Option<usize>,
    /// Whether a talk starts at once; the window then closes when the talk ends.
    pub starts_talk: bool,
}

/// Opens the window and returns after it has been closed.
///
/// # Errors
/// [`NoWindowError`] if there is no display or no graphics driver.
pub fn run(options: AppOptions) -> Result<AppExit, NoWindowError> {
    window_system::prefer_x11();
    catch_no_window(|| program(options).run())
}

/// Assembles the application without running it.
fn program(options: AppOptions) -> App {
    let AppOptions {
        files,
        captures,
        film_memory,
        starts_talk,
    } = options;
    let autosave = Autosave::start_in(&autosave::folders());
    let recent = StoredRecentFiles::of_file(RecentFiles::default_path());
    let last_export = recent.export_folder().map(Path::to_owned);
    let mut app = App::new();
    // Bevy's own Ctrl-C handler does not wake an idle event loop; `handle_termination` does.
    let plugins = DefaultPlugins
        .set(window(starts_talk))
        .disable::<TerminalCtrlCHandlerPlugin>();
    app.add_plugins(plugins)
        .add_plugins((MorphPlugin, LogicPlugin, WindowPlugins))
        .insert_resource(DropSupport(!window_system::is_wayland()))
        .insert_resource(CaptureFolder::new(captures, last_export))
        .insert_resource(StageRecording::with_memory_limit(film_memory))
        .insert_resource(autosave.scratch_folder())
        .insert_resource(autosave)
        .insert_resource(StoredPresets::of_file(FilmPresets::default_path()))
        .insert_resource(recent)
        .insert_resource(GalleryStripCache::in_user_cache())
        .add_systems(Startup, move |mut intents: MessageWriter<Intent>| {
            intents.write(first_intent(&files));
            if starts_talk {
                intents.write(Intent::Present { is_all: true });
            }
        })
        // In `First`, because the panels are laid out with the window's final size.
        .add_systems(First, screen_fit::fit_to_screen)
        .add_systems(Startup, (watch, let_jobs_wake_window))
        .add_systems(Update, TerminalCtrlCHandlerPlugin::exit_on_flag);
    handle_termination();
    app
}

/// Handles Ctrl-C and the system's request to quit. Wakes the window, because an idle window runs
/// no systems and so would not notice the request.
fn handle_termination() {
    let handler_result = ctrlc::set_handler(|| {
        TerminalCtrlCHandlerPlugin::gracefully_exit();
        job::wake();
    });
    if let Err(error) = handler_result {
        warn!("Ctrl-C in the terminal does not close the window: {error}");
    }
}

/// Watches the files of the open designs; a change wakes the idle window.
fn watch(watch: Res<FileWatcher>, events: Res<EventLoopProxyWrapper>) {
    let events = events.clone();
    watch.start(move || {
        // Sending fails only after the window has closed, when nothing needs waking.
        events.send_event(WinitUserEvent::WakeUp).ok();
    });
}

/// Lets background jobs wake the idle window.
fn let_jobs_wake_window(events: Res<EventLoopProxyWrapper>) {
    let events = events.clone();
    job::set_waker(move || {
        // Sending fails only after the window has closed, when nothing needs waking.
        events.send_event(WinitUserEvent::WakeUp).ok();
    });
}

/// Returns the intent with which the window starts: to open the files of the command line, or,
/// without any, to show the invitation.
fn first_intent(files: &[PathBuf]) -> Intent {
    let bundled = match files {
        [] => return Intent::Welcome,
        [one] => one
            .to_str()
            // `gallery:NAME` opens a bundled project, as in all subcommands of the command line.
            .and_then(|name| name.strip_prefix("gallery:"))
            .map(str::to_owned),
        _ => None,
    };
    bundled.map_or_else(|| Intent::Open(files.to_vec()), Intent::OpenGallery)
}

/// Keeps the title of the main window up to date: the title of the project, and a mark while it has
/// unsaved changes.
fn set_title(session: Res<Session>, mut window: Single<&mut Window, With<PrimaryWindow>>) {
    if !session.is_changed() {
        return;
    }
    let mark = if session.is_dirty() { "• " } else { "" };
    let title = match session.title() {
        title if title.is_empty() => APP_NAME.to_owned(),
        title => format!("{mark}{title} – {APP_NAME}"),
    };
    // Compared first, because each write is sent to the window system.
    if window.title != title {
        window.title = title;
    }
}

/// Name of the application in window titles.
const APP_NAME: &str = "Morphospace";

/// Properties of the main window; it starts in full screen if a talk starts at once.
fn window(starts_talk: bool) -> WindowPlugin {
    WindowPlugin {
        primary_window: Some(Window {
            title: APP_NAME.to_owned(),
            name: Some("morphospace".to_owned()),
            // Set here and not by a system, so that the window opens in full screen.
            mode: if starts_talk {
                fullscreen_mode()
            } else {
                WindowMode::Windowed
            },
            // The initial and the minimum size are in logical pixels; `fit_to_screen` makes them
            // smaller on a small screen.
            resolution: INITIAL_SIZE.into(),
            resize_constraints: WindowResizeConstraints {
                min_width: MIN_SIZE.x,
                min_height: MIN_SIZE.y,
                ..default()
            },
            ..default()
        }),
        exit_condition: ExitCondition::OnPrimaryClosed,
        // Closing goes through `Intent::Close`, which asks first if work would be lost.
        close_when_requested: false,
        ..default()
    }
}

/// Systems and resources that need a window: cameras, panels, dialogs, image capture.
///
/// Requires Bevy's default plugins. Without a renderer it runs but draws nothing.
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
            // In `Last`, because work started in this screen update decides how soon the next one
            // follows.
            .add_systems(Last, redraw_pace::set_redraw_pace)
            .add_systems(
                Update,
                (
                    (escape::toggle_fullscreen, set_title),
                    (stage_camera::fit, stage_camera::place_camera).chain(),
                    (speaker_window::apply, speaker_window::follow).chain(),
                    (gallery_thumbnails::advance, filmstrip::follow),
                )
                    .after(MorphSystems::Playback)
                    .before(MorphSystems::Build),
            )
            .add_systems(
                Update,
                (
                    image::request_images,
                    clipboard::copy_svg,
                    blend_image::capture_blend,
                )
                    .after(MorphSystems::Draw)
                    .before(MorphSystems::Capture),
            )
            .add_systems(
                PostUpdate,
                // After the stage's camera has been placed and before transforms propagate;
                // otherwise the comparison would lag one screen update behind.
                stage_camera::place_comparison_camera.before(TransformSystems::Propagate),
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

/// Spawns three cameras: for the stage, for the comparison to its right, and for the panels above
/// both.
fn spawn_cameras(mut commands: Commands, mut egui: ResMut<EguiGlobalSettings>) {
    // Otherwise egui would attach to the stage's camera, which covers only part of the window.
    egui.auto_create_primary_context = false;
    commands.spawn(StageCamera);
    commands.spawn((
        stage_camera::ComparisonCamera,
        Camera2d,
        Msaa::Sample4,
        CompositingSpace::Srgb,
        stage_sync::COMPARISON_LAYER,
        Camera {
            order: 1,
            // The stage's camera has already cleared the whole window.
            clear_color: ClearColorConfig::None,
            is_active: false,
            ..default()
        },
    ));
    commands.spawn((
        PrimaryEguiContext,
        Camera2d,
        // Same sample count as the stage's camera: cameras of one window share its depth texture.
        Msaa::Sample4,
        RenderLayers::none(),
        Camera {
            order: 2,
            output_mode: CameraOutputMode::Write {
                // egui draws with premultiplied alpha.
                blend_state: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                clear_color: ClearColorConfig::None,
            },
            clear_color: ClearColorConfig::Custom(Color::NONE),
            ..default()
        },
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_intent_opens_the_files_or_shows_how_to_begin() {
        assert_eq!(first_intent(&[]), Intent::Welcome);
        let bundled = first_intent(&["gallery:letters".into()]);
        assert_eq!(bundled, Intent::OpenGallery("letters".to_owned()));
        let files: Vec<PathBuf> = vec!["a.svg".into(), "b.svg".into()];
        assert_eq!(first_intent(&files), Intent::Open(files));
    }
}
