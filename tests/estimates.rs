//! Compares the estimated file size of exports with the size of the exported files, for six films in
//! each format. Videos need ffmpeg; if it is missing, the test says so.

use std::io::Write;
use std::path::Path;

use morphospace::export::{
    Camera, ExportTarget, FilmCost, FilmKind, FilmSpec, PixelSize, PlaneView, framing, write_film,
};
use morphospace::project::LoadedProject;
use morphospace::settings::Choice;
use morphospace::work::progress::Silent;

/// Films: source and target in `tests`.
const FILMS: [[&str; 2]; 6] = [
    ["motion/drawings/ring.svg", "motion/drawings/window.svg"],
    ["motion/drawings/sun.svg", "motion/drawings/lamp.svg"],
    ["drawings/fish.svg", "drawings/bird.svg"],
    ["drawings/sunset.svg", "drawings/badge.svg"],
    ["drawings/flower.svg", "drawings/chip.svg"],
    ["drawings/mountain.svg", "drawings/poster.svg"],
];

/// Length of the longer side of the films, in pixels.
const SIDE_PX: u32 = 400;

/// Maximum deviation of an estimate from the size of the file, as a fraction of the latter.
const MAX_DEVIATION: f64 = 0.2;

/// Prints a line to stderr directly, so that the test runner does not capture it.
fn print_uncaptured(line: &str) {
    writeln!(std::io::stderr(), "{line}").expect("standard error");
}

/// Returns the camera and the film of a pair of drawings.
fn film(pair: [&str; 2]) -> (Camera, FilmSpec) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let [source, target] = pair.map(|name| folder.join(name));
    let loaded = LoadedProject::open_pair(&source, &target).expect("drawings");
    let transition = loaded.segments()[0].build(&Silent).expect("a transition");
    let project = &loaded.project;
    let film = FilmSpec::of_timing(&project.timing, &project.stops, 25.0).expect("a film");
    let bounds = framing(&transition, film.times());
    let size = PixelSize::of_shape(bounds, SIDE_PX).to_even();
    let camera = Camera {
        sequence: transition.into(),
        style: project.style,
        view: PlaneView::fit(bounds, size),
        ground: Some(project.style.ground),
        captions: None,
    };
    (camera, film)
}

/// Returns the size of the exported file or files, in bytes.
fn exported_bytes(camera: &Camera, film: &FilmSpec, kind: Option<FilmKind>, folder: &Path) -> f64 {
    let path = match kind {
        Some(kind) => folder.join(format!("film.{}", kind.name().key)),
        None => folder.join("frames"),
    };
    let target = ExportTarget::of_path(&path).expect("a target");
    let written = write_film(camera, film, &target.preferring_film(), &Silent).expect("written");
    let bytes = |file: &std::path::PathBuf| file.metadata().expect("a file").len() as f64;
    written.iter().map(bytes).sum()
}

#[test]
fn estimated_file_sizes_are_within_a_fifth() {
    let has_ffmpeg = morphospace::export::has_ffmpeg();
    if !has_ffmpeg {
        print_uncaptured("NOT TESTED: estimates of videos, because ffmpeg is not on the path");
    }
    let kinds = FilmKind::ALL.into_iter().map(Some).chain([None]);
    let kinds: Vec<_> = kinds
        .filter(|kind| has_ffmpeg || !kind.is_some_and(FilmKind::is_video))
        .collect();
    let mut failed = Vec::new();
    for pair in FILMS {
        let (camera, film) = film(pair);
        for &kind in &kinds {
            let folder = tempfile::tempdir().expect("a folder");
            let exported = exported_bytes(&camera, &film, kind, folder.path());
            let estimated = FilmCost::estimate(&camera, &film, kind, folder.path(), &Silent);
            let estimated = estimated.expect("an estimate").bytes;
            let name = kind.map_or("PNG", |kind| kind.name().title);
            let deviation = estimated / exported - 1.0;
            let line = format!(
                "{} to {} as {name}: {:.0} kB estimated, {:.0} kB written, {:+.1} %",
                pair[0],
                pair[1],
                estimated / 1e3,
                exported / 1e3,
                100.0 * deviation
            );
            print_uncaptured(&line);
            if deviation.abs() > MAX_DEVIATION {
                failed.push(line);
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
