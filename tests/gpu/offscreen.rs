//! Renders transitions on the GPU without a window, for tests and benchmarks.

use std::collections::BTreeMap;
use std::panic::catch_unwind;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use bevy::app::PluginsState;
use bevy::camera::RenderTarget;
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{PollType, TextureFormat, WgpuLimits};
use bevy::render::renderer::{RenderAdapterInfo, RenderDevice, initialize_renderer};
use bevy::render::settings::{Backends, RenderCreation, RenderResources, WgpuSettings};
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use image::RgbaImage;
use morphospace::colour::Rgb;
use morphospace::geometry::{Bounds, DVec2};
use morphospace::stage::{
    Blend, CaptureStage, FrameTimes, Morph, MorphPlugin, PipelinesReady, StageCamera,
    StageCaptured, StageStyle, StageTransition, StageView, StageVisibility,
};
use morphospace::transition::{Transition, TransitionStyle};

/// A transition with its style, the size of the image to render, and the region of the plane that
/// the image shows.
pub struct RenderedScene {
    pub name: &'static str,
    pub transition: Transition,
    pub style: TransitionStyle,
    pub visibility: StageVisibility,
    pub ground: Option<Rgb>,
    /// Width and height of the image in pixels.
    pub size: [u32; 2],
    pub view: Bounds,
    /// Maximum number of misplaced pixels: pixels that one image shows inside the contour and the
    /// other outside, and that are more than one pixel away from the contour.
    pub max_misplaced_pixels: usize,
}

impl RenderedScene {
    pub fn new(name: &'static str, transition: Transition) -> Self {
        let style = TransitionStyle::default();
        let bounds = transition.bounds();
        Self {
            view: bounds.padded(0.05 * bounds.diameter()),
            name,
            transition,
            ground: Some(style.ground),
            style,
            visibility: StageVisibility::default(),
            size: [640, 480],
            max_misplaced_pixels: 0,
        }
    }
}

/// A Bevy app that renders without a window.
pub struct OffscreenRenderer {
    app: App,
    /// Entity of the scene on the stage; `None` if the stage is empty.
    staged: Option<Entity>,
    /// Folder to which tests save images, from `MORPHOSPACE_PICTURES`.
    image_folder: Option<PathBuf>,
    /// Number of images captured so far.
    capture_count: u64,
}

impl OffscreenRenderer {
    /// Opens a graphics adapter, restricted to the given limits; `None` if the machine has no
    /// adapter.
    pub fn open(limits: Option<WgpuLimits>) -> Option<Self> {
        // Shaders are compiled before the first frame, so that no element of the scene is missing.
        Self::open_with(limits, true)
    }

    /// Opens a graphics adapter, and compiles shaders while frames are drawn, as the window does.
    pub fn open_like_a_window() -> Option<Self> {
        Self::open_with(None, false)
    }

    fn open_with(limits: Option<WgpuLimits>, is_synchronous: bool) -> Option<Self> {
        let renderer = catch_unwind(|| {
            let settings = WgpuSettings {
                constrained_limits: limits,
                ..default()
            };
            let backends = settings.backends.unwrap_or(Backends::all());
            bevy::tasks::block_on(initialize_renderer(backends, None, &settings))
        });
        let mut app = build_app(renderer.ok()?, is_synchronous);
        while app.plugins_state() == PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        app.update();
        let image_folder = std::env::var_os("MORPHOSPACE_PICTURES").map(PathBuf::from);
        Some(Self {
            app,
            staged: None,
            image_folder,
            capture_count: 0,
        })
    }

    /// Renders one image of a scene at `t`; the stage must be empty, and is empty afterwards.
    pub fn render(&mut self, scene: &RenderedScene, t: f64) -> Result<RgbaImage, String> {
        assert!(self.staged.is_none(), "something else is on the stage");
        self.place(scene, t);
        let image = self.capture(scene);
        self.clear();
        image
    }

    /// Puts a scene on the stage, with `t` as its blend parameter; [`Self::clear`] removes it.
    pub fn place(&mut self, scene: &RenderedScene, t: f64) {
        let world = self.app.world_mut();
        let entity = world.spawn((
            StageTransition(scene.transition.clone()),
            Blend { t },
            StageStyle {
                style: scene.style,
                visibility: scene.visibility,
            },
        ));
        self.staged = Some(entity.id());
    }

    /// Captures an image of the stage with the size and the view of `scene`.
    pub fn capture(&mut self, scene: &RenderedScene) -> Result<RgbaImage, String> {
        let world = self.app.world_mut();
        world
            .resource_mut::<StageView>()
            .fit(scene.view, UVec2::from(scene.size).as_vec2());
        self.capture_count += 1;
        world.write_message(CaptureStage {
            id: self.capture_count,
            size_px: UVec2::from(scene.size),
            ground: scene.ground,
            view: scene.view,
        });
        let answer = self.wait_for_capture();
        assert_eq!(answer.id, self.capture_count);
        answer.result
    }

    fn staged(&mut self) -> EntityWorldMut<'_> {
        let staged = self.staged.expect("nothing is on the stage");
        self.app.world_mut().entity_mut(staged)
    }

    /// Changes t of the scene on the stage, and draws a frame.
    pub fn seek(&mut self, t: f64) {
        self.staged().get_mut::<Blend>().expect("a blend").t = t;
        self.frame();
    }

    /// Changes which elements of the scene on the stage, such as its wireframe, are visible.
    pub fn change_visibility(&mut self, change: impl FnOnce(&mut StageVisibility)) {
        let mut staged = self.staged();
        change(&mut staged.get_mut::<StageStyle>().expect("a style").visibility);
    }

    /// Replaces the transition of the scene on the stage, and draws a frame.
    pub fn replace(&mut self, transition: &Transition) {
        self.staged().insert(StageTransition(transition.clone()));
        self.frame();
    }

    /// Captures consecutive frames as a window would show them, without waiting for shaders or
    /// recordings: the frame that `action` draws, and `frames` frames after it.
    pub fn capture_frames(
        &mut self,
        scene: &RenderedScene,
        action: impl FnOnce(&mut Self),
        frames: usize,
    ) -> Vec<RgbaImage> {
        let [width, height] = scene.size;
        let world = self.app.world_mut();
        world
            .resource_mut::<StageView>()
            .fit(scene.view, UVec2::from(scene.size).as_vec2());
        let format = TextureFormat::Rgba8UnormSrgb;
        let image = Image::new_target_texture(width, height, format, None);
        let image = world.resource_mut::<Assets<Image>>().add(image);
        let target = RenderTarget::Image(image.clone().into());
        let camera = world.spawn((StageCamera, target)).id();
        // Wait until the shaders for the new camera are compiled.
        let start = Instant::now();
        for frame in 0.. {
            self.frame();
            if frame > 4 && self.app.world().resource::<PipelinesReady>().is_ready() {
                break;
            }
            assert!(
                start.elapsed() < Duration::from_secs(60),
                "the shaders are not compiled in time"
            );
        }
        let mut action = Some(action);
        let mut frame = 0;
        while self.app.world().resource::<CapturedFrames>().0.len() <= frames {
            assert!(frame < 60 + frames, "the screenshots are not delivered");
            if frame <= frames {
                let shot = Screenshot::image(image.clone());
                let store =
                    move |shot: On<ScreenshotCaptured>, mut captured: ResMut<CapturedFrames>| {
                        captured.0.insert(frame, shot.image.clone());
                    };
                self.app.world_mut().spawn(shot).observe(store);
            }
            match action.take() {
                Some(action) => action(self),
                None => self.frame(),
            }
            frame += 1;
        }
        let world = self.app.world_mut();
        world.despawn(camera);
        let captured = std::mem::take(&mut world.resource_mut::<CapturedFrames>().0);
        let images = captured.into_values().map(|image| {
            let data = image.data.expect("pixels");
            RgbaImage::from_raw(width, height, data).expect("an image")
        });
        images.collect()
    }

    /// Draws frames with alternating t until the GPU plays the recording.
    pub fn wait_for_gpu_playback(&mut self) {
        let start = Instant::now();
        for k in 0.. {
            self.seek(0.5 + 0.25 * f64::from(k % 2));
            if self.is_gpu_played() {
                return;
            }
            assert!(
                start.elapsed() < Duration::from_secs(60),
                "the GPU does not play the recording in time"
            );
        }
    }

    /// Whether the GPU evaluated the recording for the last frame.
    pub fn is_gpu_played(&self) -> bool {
        self.frame_times().is_gpu_played
    }

    /// Draws one frame and waits until the GPU has finished it. Without a window nothing limits the
    /// frame rate, so unfinished frames would pile up.
    fn frame(&mut self) {
        self.app.update();
        let device = self.app.world().resource::<RenderDevice>();
        device.poll(PollType::wait_indefinitely()).expect("a GPU");
    }

    /// CPU times of the most recent frames.
    pub fn frame_times(&self) -> &FrameTimes {
        self.app.world().resource::<FrameTimes>()
    }

    /// Discards all frame times measured so far.
    #[allow(dead_code, reason = "used by benches/stage.rs")]
    pub fn reset_frame_times(&mut self) {
        *self.app.world_mut().resource_mut::<FrameTimes>() = FrameTimes::default();
    }

    /// Names of the graphics adapter and its driver.
    pub fn adapter(&self) -> String {
        let info = self.app.world().resource::<RenderAdapterInfo>();
        format!("{}, {} {}", info.name, info.driver, info.driver_info)
    }

    /// Calls a function with the current vertex positions of the scene on the stage.
    pub fn read_vertices<T>(&mut self, function: impl FnOnce(&[DVec2]) -> T) -> T {
        let staged = self.staged();
        let morph = staged.get::<Morph>().expect("a morph");
        function(&morph.frame().placement().in_frame)
    }

    /// Returns the number of times that mesh assets were modified since the last call.
    pub fn take_written_count(&mut self) -> usize {
        let mut written = self.app.world_mut().resource_mut::<WrittenMeshes>();
        std::mem::take(&mut written.0)
    }

    /// Hides the scene on the stage and returns its entity, so that another scene can be rendered.
    pub fn hide(&mut self) -> Entity {
        self.staged().insert(Visibility::Hidden);
        self.staged.take().expect("a scene on the stage")
    }

    /// Puts a scene hidden by [`Self::hide`] on the stage again.
    pub fn unhide(&mut self, entity: Entity) {
        self.staged = Some(entity);
        self.staged().insert(Visibility::Inherited);
    }

    /// Removes the scene from the stage.
    pub fn clear(&mut self) {
        if let Some(entity) = self.staged.take() {
            self.app.world_mut().despawn(entity);
        }
    }

    /// Draws frames until the requested image of the stage is delivered.
    fn wait_for_capture(&mut self) -> StageCaptured {
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(120) {
            self.frame();
            let world = self.app.world_mut();
            let mut answers = world.resource_mut::<Messages<StageCaptured>>();
            if let Some(answer) = answers.drain().next() {
                return answer;
            }
        }
        panic!("the capture was not delivered in time");
    }

    /// Saves an image to the folder in `MORPHOSPACE_PICTURES`, if it is set.
    pub fn save_image(&self, name: &str, t: f64, image: &RgbaImage) {
        if let Some(folder) = &self.image_folder {
            let path = folder.join(format!("{name}-{t}-{}.png", self.capture_count));
            image.save(path).expect("a writable folder");
        }
    }
}

/// Builds the Bevy app. If `is_synchronous`, drawing waits until the shaders are compiled.
fn build_app(renderer: RenderResources, is_synchronous: bool) -> App {
    let mut app = App::new();
    let plugins = DefaultPlugins
        .set(WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            render_creation: RenderCreation::Manual(renderer),
            synchronous_pipeline_compilation: is_synchronous,
            ..default()
        })
        .set(LogPlugin {
            filter: "error".into(),
            ..default()
        })
        .disable::<WinitPlugin>()
        .disable::<PipelinedRenderingPlugin>();
    app.add_plugins((plugins, MorphPlugin))
        .init_resource::<WrittenMeshes>()
        .init_resource::<CapturedFrames>()
        .add_systems(Last, count_written);
    app
}

/// Captured images by frame number.
#[derive(Resource, Default)]
struct CapturedFrames(BTreeMap<usize, Image>);

/// Number of times that mesh assets were modified since the number was last taken.
#[derive(Resource, Default)]
struct WrittenMeshes(usize);

fn count_written(mut events: MessageReader<AssetEvent<Mesh>>, mut written: ResMut<WrittenMeshes>) {
    let is_written = |event: &&AssetEvent<Mesh>| matches!(event, AssetEvent::Modified { .. });
    written.0 += events.read().filter(is_written).count();
}
