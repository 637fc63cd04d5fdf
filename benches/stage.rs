//! Times the drawing of transitions of 25,000 to a million vertices by the GPU, without a window.
//!
//! The cases are the gallery's rotor at three different levels of subdivision, and a sheet that
//! bends into a half ring. `cargo bench --bench stage`; names after `--` select cases. Images have
//! 1280 × 720 pixels; they are rendered and read back from the GPU.
//!
//! - `first image`: time from the designs to the first rendered image
//! - `recorded`: time to record the transition, so that the GPU can play it
//! - `solve`, `draw`: median CPU times of a frame, as F3 shows them
//! - `image`: median time of a frame, including its image
//!
//! `solve`, `draw` and `image` are printed twice: for frames solved on the CPU, and for frames
//! played on the GPU from the recording.

#[path = "../tests/gpu/offscreen.rs"]
#[expect(dead_code, reason = "most functions are used by the tests")]
mod offscreen;

use morphospace::design::Design;
use morphospace::geometry::DVec2;
use morphospace::mesh::{MeshError, TriangleMesh};
use morphospace::project::gallery;
use morphospace::recording::RecordingOptions;
use morphospace::transition::{Transition, TransitionSpec};
use morphospace::work::progress::Silent;
use offscreen::{OffscreenRenderer, RenderedScene};
use std::error::Error;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Number of frames whose median time is printed.
const FRAMES: u32 = 40;

#[expect(clippy::print_stdout, reason = "a benchmark prints its results")]
fn main() -> ExitCode {
    let Some(mut renderer) = OffscreenRenderer::open(None) else {
        println!("No graphics adapter was found: nothing to measure.");
        return ExitCode::SUCCESS;
    };
    println!("{}", renderer.adapter());
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let is_wanted = |name: &str| {
        let mut names = wanted
            .iter()
            .filter(|word| !word.starts_with('-'))
            .peekable();
        names.peek().is_none() || names.any(|word| word == name)
    };
    for (name, make_spec) in CASES.iter().filter(|(name, _)| is_wanted(name)) {
        match measure(&mut renderer, *make_spec) {
            Ok(row) => println!("{name}: {row}"),
            Err(error) => {
                println!("{name}: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

/// Function that creates the specification of a case's transition.
type MakeSpec = fn() -> Result<TransitionSpec, Box<dyn Error>>;

/// Name of each case, and the function that creates the specification of its transition.
const CASES: [(&str, MakeSpec); 4] = [
    ("rotor3", || rotor(3)),
    ("rotor4", || rotor(4)),
    ("rotor5", || rotor(5)),
    ("sheet", sheet),
];

/// The gallery's rotor, with each face split into four `subdivisions` times.
fn rotor(subdivisions: u32) -> Result<TransitionSpec, Box<dyn Error>> {
    let mut spec = gallery::load("rotor")?.spec()?;
    spec.options.arap.subdivisions = subdivisions;
    Ok(spec)
}

/// A square sheet of a million vertices that bends by three radians.
fn sheet() -> Result<TransitionSpec, Box<dyn Error>> {
    const SIDE: u32 = 1000;
    let step = 1.0 / f64::from(SIDE - 1);
    let flat: Vec<DVec2> = (0..SIDE * SIDE)
        .map(|i| DVec2::new(f64::from(i % SIDE), f64::from(i / SIDE)) * step)
        .collect();
    let bent = |p: &DVec2| DVec2::from_angle(3.0 * p.x) * (1.5 - p.y);
    let faces: Vec<[u32; 3]> = (0..(SIDE - 1) * (SIDE - 1))
        .flat_map(|i| {
            let v = i / (SIDE - 1) * SIDE + i % (SIDE - 1);
            [[v, v + 1, v + SIDE + 1], [v, v + SIDE + 1, v + SIDE]]
        })
        .collect();
    let target = flat.iter().map(bent).collect();
    let [source, target] = [flat, target].map(|positions| {
        let mesh = TriangleMesh::new(positions, faces.clone())?;
        Ok::<_, MeshError>(Arc::new(Design::new("sheet", mesh)))
    });
    Ok(TransitionSpec::new(source?, target?))
}

/// Times one case; returns its times as text.
fn measure(
    renderer: &mut OffscreenRenderer,
    make_spec: MakeSpec,
) -> Result<String, Box<dyn Error>> {
    let mut spec = make_spec()?;
    spec.patient = true;
    let start = Instant::now();
    let transition = Transition::build(&spec, &Silent)?;
    let mut scene = RenderedScene::new("bench", transition.clone());
    scene.size = [1280, 720];
    renderer.place(&scene, 0.0);
    renderer.capture(&scene)?;
    let first = start.elapsed();
    let solved = time_frames(renderer, &scene)?;
    let start = Instant::now();
    transition.record(&RecordingOptions::default(), &Silent)?;
    let recorded = start.elapsed();
    renderer.wait_for_gpu_playback();
    let played = time_frames(renderer, &scene)?;
    let vertices = renderer.read_vertices(<[_]>::len);
    renderer.clear();
    Ok(format!(
        "{vertices} vertices: first image {:.2} s, recorded {:.2} s; solved: {solved}; \
         played: {played}",
        first.as_secs_f64(),
        recorded.as_secs_f64(),
    ))
}

/// Times [`FRAMES`] frames of the scene on the stage; returns the median times as text.
fn time_frames(
    renderer: &mut OffscreenRenderer,
    scene: &RenderedScene,
) -> Result<String, Box<dyn Error>> {
    renderer.reset_frame_times();
    let mut image_times = Vec::new();
    for k in 0..FRAMES {
        let start = Instant::now();
        renderer.seek(f64::from(k) / f64::from(FRAMES));
        renderer.capture(scene)?;
        image_times.push(start.elapsed());
    }
    image_times.sort_unstable();
    let ms = |time: Duration| 1e3 * time.as_secs_f64();
    let times = renderer.frame_times();
    let [solve, draw] = [&times.solve, &times.draw].map(|times| times.median().map_or(0.0, ms));
    let image = ms(image_times[image_times.len() / 2]);
    Ok(format!(
        "solve {solve:.3} ms, draw {draw:.3} ms, image {image:.1} ms"
    ))
}
