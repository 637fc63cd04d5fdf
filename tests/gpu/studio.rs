//! A renderer without a window.

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

/// What is looked at, and how.
pub struct Scene {
    pub name: &'static str,
    pub transition: Transition,
    pub style: TransitionStyle,
    pub show: StageVisibility,
    pub ground: Option<Rgb>,
    pub size: [u32; 2],
    pub view: Bounds,
    /// How many pixels may be more than one pixel off the contour.
    pub astray: usize,
}

impl Scene {
    pub fn new(name: &'static str, transition: Transition) -> Self {
        let style = TransitionStyle::default();
        let bounds = transition.bounds();
        Self {
            view: bounds.padded(0.05 * bounds.diameter()),
            name,
            transition,
            ground: Some(style.ground),
            style,
            show: StageVisibility::default(),
            size: [640, 480],
            astray: 0,
        }
    }
}

/// A Bevy program that renders, but not into a window.
pub struct Studio {
    app: App,
    /// What stays on the stage.
    staged: Option<Entity>,
    pictures: Option<PathBuf>,
    taken: u64,
}

impl Studio {
    /// `None` where there is no graphics adapter at all; of one that can do no more
    /// than the limits say.
    pub fn open(limits: Option<WgpuLimits>) -> Option<Self> {
        // Or pictures would lack what is not compiled yet.
        Self::opened(limits, true)
    }

    /// One that compiles beside its frames, as a window does.
    pub fn as_a_window() -> Option<Self> {
        Self::opened(None, false)
    }

    fn opened(limits: Option<WgpuLimits>, waits: bool) -> Option<Self> {
        let renderer = catch_unwind(|| {
            let settings = WgpuSettings {
                constrained_limits: limits,
                ..default()
            };
            let backends = settings.backends.unwrap_or(Backends::all());
            bevy::tasks::block_on(initialize_renderer(backends, None, &settings))
        });
        let mut app = app(renderer.ok()?, waits);
        while app.plugins_state() == PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        app.update();
        let pictures = std::env::var_os("MORPHOSPACE_PICTURES").map(PathBuf::from);
        Some(Self {
            app,
            staged: None,
            pictures,
            taken: 0,
        })
    }

    /// The scene at `t` from the stage's renderer.
    pub fn picture(&mut self, scene: &Scene, t: f64) -> Result<RgbaImage, String> {
        assert!(self.staged.is_none(), "something else is on the stage");
        self.put(scene, t);
        let picture = self.take(scene);
        self.clear();
        picture
    }

    /// Puts a scene on the stage, where it stays.
    pub fn put(&mut self, scene: &Scene, t: f64) {
        let world = self.app.world_mut();
        let entity = world.spawn((
            StageTransition(scene.transition.clone()),
            Blend { t },
            StageStyle {
                style: scene.style,
                show: scene.show,
            },
        ));
        self.staged = Some(entity.id());
    }

    /// What is on the stage.
    pub fn take(&mut self, scene: &Scene) -> Result<RgbaImage, String> {
        let world = self.app.world_mut();
        world
            .resource_mut::<StageView>()
            .fit(scene.view, UVec2::from(scene.size).as_vec2());
        self.taken += 1;
        world.write_message(CaptureStage {
            id: self.taken,
            size_px: UVec2::from(scene.size),
            ground: scene.ground,
            view: scene.view,
        });
        let answer = self.answer();
        assert_eq!(answer.id, self.taken);
        answer.result
    }

    fn staged(&mut self) -> EntityWorldMut<'_> {
        let staged = self.staged.expect("nothing is on the stage");
        self.app.world_mut().entity_mut(staged)
    }

    /// Moves what is on the stage.
    pub fn move_to(&mut self, t: f64) {
        self.staged().get_mut::<Blend>().expect("a blend").t = t;
        self.frame();
    }

    /// Changes what of it is shown.
    pub fn show(&mut self, change: impl FnOnce(&mut StageVisibility)) {
        let mut staged = self.staged();
        change(&mut staged.get_mut::<StageStyle>().expect("a style").show);
    }

    /// Another transition takes its place.
    pub fn replace(&mut self, by: &Transition) {
        self.staged().insert(StageTransition(by.clone()));
        self.frame();
    }

    /// What a window would show of the scene in so many frames after the first, in which
    /// something happens: as it is drawn, without waiting for anything.
    pub fn watch(
        &mut self,
        scene: &Scene,
        happens: impl FnOnce(&mut Self),
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
        // The camera is new, and what it draws is compiled for it.
        let start = Instant::now();
        for frame in 0.. {
            self.frame();
            if frame > 4 && self.app.world().resource::<PipelinesReady>().is_ready() {
                break;
            }
            assert!(
                start.elapsed() < Duration::from_secs(60),
                "it is never ready"
            );
        }
        let mut happens = Some(happens);
        let mut frame = 0;
        while self.app.world().resource::<Watched>().0.len() <= frames {
            assert!(frame < 60 + frames, "the card does not answer");
            if frame <= frames {
                let shot = Screenshot::image(image.clone());
                let note = move |shot: On<ScreenshotCaptured>, mut watched: ResMut<Watched>| {
                    watched.0.insert(frame, shot.image.clone());
                };
                self.app.world_mut().spawn(shot).observe(note);
            }
            match happens.take() {
                Some(happens) => happens(self),
                None => self.frame(),
            }
            frame += 1;
        }
        let world = self.app.world_mut();
        world.despawn(camera);
        let watched = std::mem::take(&mut world.resource_mut::<Watched>().0);
        let pictures = watched.into_values().map(|image| {
            let data = image.data.expect("pixels");
            RgbaImage::from_raw(width, height, data).expect("a picture")
        });
        pictures.collect()
    }

    /// Moves it about until the graphics card plays it.
    pub fn wait_until_played(&mut self) {
        let start = Instant::now();
        for k in 0.. {
            self.move_to(0.5 + 0.25 * f64::from(k % 2));
            if self.is_played() {
                return;
            }
            assert!(
                start.elapsed() < Duration::from_secs(60),
                "it is never played"
            );
        }
    }

    /// Whether the graphics card summed what moved last.
    pub fn is_played(&self) -> bool {
        self.times().is_played
    }

    /// One frame, to its end: without a window nothing else holds frames back, and those
    /// that a card has not drawn yet pile up in front of the one that is waited for.
    fn frame(&mut self) {
        self.app.update();
        let device = self.app.world().resource::<RenderDevice>();
        device.poll(PollType::wait_indefinitely()).expect("a card");
    }

    /// What the last frames took of the processor.
    pub fn times(&self) -> &FrameTimes {
        self.app.world().resource::<FrameTimes>()
    }

    /// Counts from here on.
    #[allow(dead_code, reason = "benches/stage.rs does")]
    pub fn forget_times(&mut self) {
        *self.app.world_mut().resource_mut::<FrameTimes>() = FrameTimes::default();
    }

    /// The graphics card and its driver, by their names.
    pub fn adapter(&self) -> String {
        let info = self.app.world().resource::<RenderAdapterInfo>();
        format!("{}, {} {}", info.name, info.driver, info.driver_info)
    }

    /// Reads where the vertices are.
    pub fn read<T>(&mut self, of: impl FnOnce(&[DVec2]) -> T) -> T {
        let staged = self.staged();
        let morph = staged.get::<Morph>().expect("a morph");
        of(&morph.frame().placement().in_frame)
    }

    /// How many meshes were written since this was asked last.
    pub fn count_written(&mut self) -> usize {
        let mut written = self.app.world_mut().resource_mut::<Written>();
        std::mem::take(&mut written.0)
    }

    /// Hides what is on the stage.
    pub fn put_away(&mut self) -> Entity {
        self.staged().insert(Visibility::Hidden);
        self.staged.take().expect("something")
    }

    /// Shows it again.
    pub fn put_back(&mut self, entity: Entity) {
        self.staged = Some(entity);
        self.staged().insert(Visibility::Inherited);
    }

    /// Takes it from the stage.
    pub fn clear(&mut self) {
        if let Some(entity) = self.staged.take() {
            self.app.world_mut().despawn(entity);
        }
    }

    fn answer(&mut self) -> StageCaptured {
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(120) {
            self.frame();
            let world = self.app.world_mut();
            let mut answers = world.resource_mut::<Messages<StageCaptured>>();
            if let Some(answer) = answers.drain().next() {
                return answer;
            }
        }
        panic!("the capture was never answered");
    }

    /// Writes a picture where somebody wants to look at it.
    pub fn keep(&self, name: &str, t: f64, picture: &RgbaImage) {
        if let Some(folder) = &self.pictures {
            let path = folder.join(format!("{name}-{t}-{}.png", self.taken));
            picture.save(path).expect("a writable folder");
        }
    }
}

fn app(renderer: RenderResources, waits: bool) -> App {
    let mut app = App::new();
    let plugins = DefaultPlugins
        .set(WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            render_creation: RenderCreation::Manual(renderer),
            synchronous_pipeline_compilation: waits,
            ..default()
        })
        .set(LogPlugin {
            filter: "error".into(),
            ..default()
        })
        .disable::<WinitPlugin>()
        .disable::<PipelinedRenderingPlugin>();
    app.add_plugins((plugins, MorphPlugin))
        .init_resource::<Written>()
        .init_resource::<Watched>()
        .add_systems(Last, count_written);
    app
}

/// What was seen, by the number of the frame.
#[derive(Resource, Default)]
struct Watched(BTreeMap<usize, Image>);

/// How many meshes were written.
#[derive(Resource, Default)]
struct Written(usize);

fn count_written(mut events: MessageReader<AssetEvent<Mesh>>, mut written: ResMut<Written>) {
    let is_written = |event: &&AssetEvent<Mesh>| matches!(event, AssetEvent::Modified { .. });
    written.0 += events.read().filter(is_written).count();
}
