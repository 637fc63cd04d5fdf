//! The stage at 25 thousand to a million vertices, without a window: the gallery's rotor,
//! subdivided further and further, and a sheet that is bent into a half ring.
//!
//! `cargo bench --bench stage`, of those alone that are named after `--`. A picture is
//! 1280 × 720, drawn and read back.
//!
//! - `first picture`: from the designs to what is seen of them
//! - `recorded`: after which the graphics card plays
//! - `solve`, `draw`: what the processor does in a frame, as F3 tells it: solved in each
//!   frame, and played
//! - `picture`: a whole frame

#[path = "../tests/gpu/studio.rs"]
#[expect(dead_code, reason = "most of it is for the tests")]
mod studio;

use morphospace::design::Design;
use morphospace::geometry::DVec2;
use morphospace::mesh::{MeshError, TriangleMesh};
use morphospace::project::gallery;
use morphospace::recording::RecordingOptions;
use morphospace::transition::{Transition, TransitionSpec};
use morphospace::work::progress::Silent;
use std::error::Error;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};
use studio::{Scene, Studio};

/// Frames of which the median is told.
const FRAMES: u32 = 40;

#[expect(clippy::print_stdout, reason = "a bench tells on stdout")]
fn main() -> ExitCode {
    let Some(mut studio) = Studio::open(None) else {
        println!("There is no graphics adapter: nothing to measure.");
        return ExitCode::SUCCESS;
    };
    println!("{}", studio.adapter());
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let is_wanted = |name: &str| {
        let mut names = wanted
            .iter()
            .filter(|word| !word.starts_with('-'))
            .peekable();
        names.peek().is_none() || names.any(|word| word == name)
    };
    for (name, made) in CASES.iter().filter(|(name, _)| is_wanted(name)) {
        match measured(&mut studio, *made) {
            Ok(row) => println!("{name}: {row}"),
            Err(error) => {
                println!("{name}: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

type Made = fn() -> Result<TransitionSpec, Box<dyn Error>>;

const CASES: [(&str, Made); 4] = [
    ("rotor3", || rotor(3)),
    ("rotor4", || rotor(4)),
    ("rotor5", || rotor(5)),
    ("sheet", sheet),
];

fn rotor(subdivisions: u32) -> Result<TransitionSpec, Box<dyn Error>> {
    let mut spec = gallery::load("rotor")?.spec()?;
    spec.options.arap.subdivisions = subdivisions;
    Ok(spec)
}

/// A square of a million vertices, and the same bent by three radians.
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

fn measured(studio: &mut Studio, made: Made) -> Result<String, Box<dyn Error>> {
    let mut spec = made()?;
    spec.patient = true;
    let begun = Instant::now();
    let transition = Transition::build(&spec, &Silent)?;
    let mut scene = Scene::new("bench", transition.clone());
    scene.size = [1280, 720];
    studio.put(&scene, 0.0);
    studio.take(&scene)?;
    let first = begun.elapsed();
    let solved = frames(studio, &scene)?;
    let begun = Instant::now();
    transition.record(&RecordingOptions::default(), &Silent)?;
    let recorded = begun.elapsed();
    studio.wait_until_played();
    let played = frames(studio, &scene)?;
    let vertices = studio.read(<[_]>::len);
    studio.clear();
    Ok(format!(
        "{vertices} vertices: first picture {:.2} s, recorded {:.2} s; solved: {solved}; \
         played: {played}",
        first.as_secs_f64(),
        recorded.as_secs_f64(),
    ))
}

/// The medians of what frames take.
fn frames(studio: &mut Studio, scene: &Scene) -> Result<String, Box<dyn Error>> {
    studio.forget_times();
    let mut pictures = Vec::new();
    for k in 0..FRAMES {
        let begun = Instant::now();
        studio.move_to(f64::from(k) / f64::from(FRAMES));
        studio.take(scene)?;
        pictures.push(begun.elapsed());
    }
    pictures.sort_unstable();
    let ms = |time: Duration| 1e3 * time.as_secs_f64();
    let times = studio.times();
    let [solve, draw] = [&times.solve, &times.draw].map(|times| times.median().map_or(0.0, ms));
    let picture = ms(pictures[pictures.len() / 2]);
    Ok(format!(
        "solve {solve:.3} ms, draw {draw:.3} ms, picture {picture:.1} ms"
    ))
}
