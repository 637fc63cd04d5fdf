//! A renderer without a window, and a runner that counts what it cannot run.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use bevy::app::PluginsState;
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::renderer::initialize_renderer;
use bevy::render::settings::{Backends, RenderCreation, RenderResources, WgpuSettings};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use image::RgbaImage;
use morphospace::colour::Rgb;
use morphospace::export::{Drawing, PixelSize, View, rasterise};
use morphospace::geometry::Bounds;
use morphospace::stage::{
    Blend, CaptureStage, MorphPlugin, Show, StageCaptured, StageStyle, StageTransition, StageView,
};
use morphospace::transition::{Style, Transition};

use crate::Test;

/// What is looked at, and how.
pub struct Scene {
    pub name: &'static str,
    pub transition: Transition,
    pub style: Style,
    pub show: Show,
    pub ground: Option<Rgb>,
    pub size: [u32; 2],
    pub view: Bounds,
    /// How many pixels may be more than one pixel off the contour.
    pub astray: usize,
}

impl Scene {
    pub fn new(name: &'static str, transition: Transition) -> Self {
        let style = Style::default();
        let bounds = transition.bounds();
        Self {
            view: bounds.padded(0.05 * bounds.diameter()),
            name,
            transition,
            ground: Some(style.ground),
            style,
            show: Show::default(),
            size: [640, 480],
            astray: 0,
        }
    }
}

/// A Bevy program that renders, but not into a window.
pub struct Studio {
    app: App,
    pictures: Option<PathBuf>,
    taken: u64,
}

impl Studio {
    /// `None` where there is no graphics adapter at all.
    fn open() -> Option<Self> {
        let renderer = catch_unwind(|| {
            let settings = WgpuSettings::default();
            let backends = settings.backends.unwrap_or(Backends::all());
            bevy::tasks::block_on(initialize_renderer(backends, None, &settings))
        });
        let mut app = app(renderer.ok()?);
        while app.plugins_state() == PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        app.update();
        let pictures = std::env::var_os("MORPHOSPACE_PICTURES").map(PathBuf::from);
        Some(Self {
            app,
            pictures,
            taken: 0,
        })
    }

    /// The scene at `t` from the stage's renderer.
    pub fn picture(&mut self, scene: &Scene, t: f64) -> Result<RgbaImage, String> {
        let world = self.app.world_mut();
        world
            .resource_mut::<StageView>()
            .fit(scene.view, UVec2::from(scene.size).as_vec2());
        let entity = world.spawn((
            StageTransition(scene.transition.clone()),
            Blend { t },
            StageStyle {
                style: scene.style,
                show: scene.show,
            },
        ));
        let entity = entity.id();
        self.taken += 1;
        world.write_message(CaptureStage {
            id: self.taken,
            size_px: UVec2::from(scene.size),
            ground: scene.ground,
            view: scene.view,
        });
        let answer = self.answer();
        self.app.world_mut().despawn(entity);
        assert_eq!(answer.id, self.taken);
        answer.result
    }

    fn answer(&mut self) -> StageCaptured {
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(120) {
            self.app.update();
            let world = self.app.world_mut();
            let mut answers = world.resource_mut::<Messages<StageCaptured>>();
            if let Some(answer) = answers.drain().next() {
                return answer;
            }
        }
        panic!("the capture was never answered");
    }

    /// The scene at `t` from both, held against each other: GPU, CPU.
    pub fn compare(&mut self, scene: &Scene, t: f64) -> (RgbaImage, RgbaImage) {
        let gpu = self.picture(scene, t).expect("a picture");
        let size = PixelSize::new(scene.size[0], scene.size[1]).expect("a size");
        let view = View::fit(scene.view, size);
        let frame = scene.transition.frame(t);
        let cpu = rasterise(&Drawing::of_frame(
            &frame,
            &scene.style,
            &view,
            scene.ground,
        ));
        self.keep(&format!("{}-gpu", scene.name), t, &gpu);
        self.keep(&format!("{}-cpu", scene.name), t, &cpu);
        let name = format!("{} at {t}", scene.name);
        crate::check(&name, scene, t, &gpu, &cpu);
        (gpu, cpu)
    }

    /// Writes a picture where somebody wants to look at it.
    pub fn keep(&self, name: &str, t: f64, picture: &RgbaImage) {
        if let Some(folder) = &self.pictures {
            let path = folder.join(format!("{name}-{t}-{}.png", self.taken));
            picture.save(path).expect("a writable folder");
        }
    }
}

fn app(renderer: RenderResources) -> App {
    let mut app = App::new();
    let plugins = DefaultPlugins
        .set(WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            render_creation: RenderCreation::Manual(renderer),
            synchronous_pipeline_compilation: true,
            ..default()
        })
        .set(LogPlugin {
            filter: "error".into(),
            ..default()
        })
        .disable::<WinitPlugin>()
        .disable::<PipelinedRenderingPlugin>();
    app.add_plugins((plugins, MorphPlugin));
    app
}

/// Runs the tests whose name contains the first argument, in the manner of
/// Rust's own runner.
#[expect(clippy::print_stdout, reason = "a test runner reports on stdout")]
pub fn run(tests: &[Test]) -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let filter = arguments.iter().find(|a| !a.starts_with('-'));
    let chosen = |name: &str| filter.is_none_or(|f| name.contains(f.as_str()));
    let chosen: Vec<&Test> = tests.iter().filter(|(name, _)| chosen(name)).collect();
    if arguments.iter().any(|a| a == "--list") {
        chosen.iter().for_each(|(name, _)| println!("{name}: test"));
        return ExitCode::SUCCESS;
    }
    println!("\nrunning {} tests", chosen.len());
    let Some(mut studio) = Studio::open() else {
        return run_nothing(&chosen);
    };
    let mut failed = 0;
    for (name, test) in &chosen {
        let result = catch_unwind(AssertUnwindSafe(|| test(&mut studio)));
        let word = if result.is_ok() { "ok" } else { "FAILED" };
        failed += usize::from(result.is_err());
        println!("test {name} ... {word}");
    }
    summary(chosen.len() - failed, failed, 0)
}

#[expect(clippy::print_stdout, reason = "a test runner reports on stdout")]
fn run_nothing(chosen: &[&Test]) -> ExitCode {
    for (name, _) in chosen {
        println!("test {name} ... ignored, there is no graphics adapter");
    }
    let required = std::env::var_os("MORPHOSPACE_REQUIRE_GPU").is_some_and(|v| v == "1");
    if required {
        println!("\nMORPHOSPACE_REQUIRE_GPU is set, but there is no graphics adapter");
        return summary(0, chosen.len(), 0);
    }
    summary(0, 0, chosen.len())
}

#[expect(clippy::print_stdout, reason = "a test runner reports on stdout")]
fn summary(passed: usize, failed: usize, ignored: usize) -> ExitCode {
    let word = if failed == 0 { "ok" } else { "FAILED" };
    println!(
        "\ntest result: {word}. {passed} passed; {failed} failed; {ignored} ignored; \
         0 measured; 0 filtered out\n"
    );
    if failed == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
