//! Times a frame that blends two pictures of 1024 × 1024 pixels, warped by 40 pairs of lines. The
//! whole frame (warp and pixels) and the warp alone are timed.
//!
//! `cargo bench --no-default-features --bench lines`. If the environment variable `LINES_NUMPY`
//! names a Python interpreter with NumPy, `benches/lines_numpy.py` first computes the same frame.
//! The times of NumPy and of the program and the differences between their results are then
//! printed. NumPy evaluates the line warp at every pixel; the program evaluates it at the vertices
//! of its grid and interpolates linearly between them.

use criterion::Criterion;
use image::{DynamicImage, ImageFormat, Rgba, RgbaImage};
use morphospace::content::{ContentKind, PictureRaster};
use morphospace::correspondence::LinePair;
use morphospace::design::{Design, ImportOptions, import};
use morphospace::geometry::{Bounds, DVec2};
use morphospace::transition::{Frame, Transition, TransitionMethod, TransitionSpec};
use morphospace::warp::{LineOptions, LineWarp, Placement, PlaneGrid, PlaneWarp, WarpKind};
use morphospace::work::progress::Silent;
use std::error::Error;
use std::io::Cursor;
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Side of the pictures in pixels.
const SIDE: usize = 1024;

/// Number of pairs of lines that define the warp.
const COUNT: u32 = 40;

/// Raster on which the frame is rendered: one pixel per unit of the plane.
const PIXELS: PictureRaster = PictureRaster {
    size: [SIDE as u32; 2],
    corner: DVec2::new(0.0, SIDE as f64),
    pixel_size: 1.0,
};

fn main() -> Result<()> {
    let transition = transition()?;
    if let Some(python) = std::env::var_os("LINES_NUMPY") {
        compare(&python, &transition)?;
    }
    let mut criterion = Criterion::default().configure_from_args();
    whole_frame(&mut criterion, &transition)?;
    warp(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}

/// Ends of a line with the given midpoint, angle (in radians) and length.
fn line(midpoint: DVec2, angle: f64, length: f64) -> [DVec2; 2] {
    let half = DVec2::from_angle(angle) * (0.5 * length);
    [midpoint - half, midpoint + half]
}

/// Returns the `i`-th pair of lines; `benches/lines_numpy.py` uses the same pairs.
fn pair(i: u32) -> LinePair {
    let i = f64::from(i);
    let midpoint = DVec2::new(0.5 + i * 0.7548776662, 0.5 + i * 0.5698402910).fract() * SIDE as f64;
    let angle = 2.4 * i;
    let length = 60.0 + 240.0 * (i * 0.6180339887).fract();
    let moved = midpoint + 40.0 * DVec2::new((1.7 * i).cos(), (1.3 * i).sin());
    let stretched = length * (1.0 + 0.3 * (2.1 * i).cos());
    LinePair {
        source: line(midpoint, angle, length),
        target: line(moved, angle + 0.5 * i.sin(), stretched),
    }
}

/// An opaque picture of triangle waves; `shift` moves the waves.
fn design(shift: u32) -> Result<Arc<Design>> {
    let wave = |x: u32, k: u32| ((x * (k + 1) + shift * 57) % 511).abs_diff(255) as u8;
    let pixel = |x, y| Rgba([wave(x, 0), wave(y, 1), wave(x + y, 2), 255]);
    let picture = RgbaImage::from_fn(SIDE as u32, SIDE as u32, pixel);
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::from(picture).write_to(&mut bytes, ImageFormat::Png)?;
    let options = ImportOptions::default();
    Ok(Arc::new(import("waves", bytes.get_ref(), &options)?))
}

fn transition() -> Result<Transition> {
    let mut spec = TransitionSpec::new(design(0)?, design(1)?);
    spec.method = TransitionMethod::new(WarpKind::Lines, ContentKind::Colours)?;
    spec.options.matching.lines = (0..COUNT).map(pair).collect();
    Ok(Transition::build(&spec, &Silent)?)
}

/// Renders the blended picture at t = ½; `None` if the transition has no pictures.
fn picture(frame: &mut Frame) -> Option<RgbaImage> {
    frame.seek(0.5);
    frame.picture(&PIXELS)
}

/// Times NumPy and the program, and prints the times and the differences between their results.
#[expect(clippy::print_stdout, reason = "a benchmark prints its results")]
fn compare(python: &std::ffi::OsStr, transition: &Transition) -> Result<()> {
    let out = std::env::temp_dir().join(format!("lines_numpy_{}.bin", std::process::id()));
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/lines_numpy.py");
    let status = Command::new(python).arg(script).arg(&out).status()?;
    let bytes = std::fs::read(&out)?;
    std::fs::remove_file(&out)?;
    let expected: Vec<f64> = (bytes.as_chunks().0.iter())
        .map(|b| f64::from_le_bytes(*b))
        .collect();
    if !status.success() || expected.len() != 7 * SIDE * SIDE {
        return Err("NumPy made no frame".into());
    }
    for threads in [1, std::thread::available_parallelism()?.get()] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let mut frame = transition.frame(0.0);
        let mut times = pool.build()?.install(|| {
            let time = |_| {
                let start = Instant::now();
                picture(&mut frame)?;
                Some(1e3 * start.elapsed().as_secs_f64())
            };
            (0..41).map(time).collect::<Option<Vec<f64>>>()
        });
        let times = times.as_mut().ok_or("a frame without colours")?;
        times.sort_by(f64::total_cmp);
        let (best, median) = (times[0], times[20]);
        println!("program, {threads} threads: best {best:.1} ms, median {median:.1} ms");
    }
    let mut frame = transition.frame(0.0);
    let rendered = picture(&mut frame).ok_or("a frame without colours")?;
    let (planes, colours) = expected.split_at(4 * SIDE * SIDE);
    let distances = map_distances(frame.placement(), planes);
    let (max, mean) = max_and_mean(&distances);
    println!("the maps are at most {max:.2} px apart, {mean:.4} px on average");
    let levels = rendered.as_raw().chunks_exact(4).zip(colours.as_chunks().0);
    let differences =
        |(a, b): (&[u8], &[f64; 3])| [0, 1, 2].map(|k| (f64::from(a[k]) - b[k]).abs());
    let (max, mean) = max_and_mean(&levels.flat_map(differences).collect::<Vec<_>>());
    println!("the pictures are at most {max} levels of 255 apart, {mean:.4} on average");
    Ok(())
}

fn max_and_mean(values: &[f64]) -> (f64, f64) {
    let max = values.iter().copied().fold(0.0, f64::max);
    (max, values.iter().sum::<f64>() / values.len() as f64)
}

/// For each pixel: the distance between its position according to `placement` and the expected
/// position, first in the source, then in the target.
///
/// `expected` consists of four blocks with a value per pixel: x and y in the source, x and y in the
/// target.
fn map_distances(placement: &Placement, expected: &[f64]) -> Vec<f64> {
    let mut distances = vec![f64::INFINITY; 2 * SIDE * SIDE];
    for face in placement.faces.iter() {
        let corners = |points: &[DVec2]| face.map(|v| points[v as usize]);
        let [a, b, c] = corners(&placement.in_frame);
        let det = (b - a).perp_dot(c - a);
        let (low, high) = (a.min(b).min(c).floor(), a.max(b).max(c).ceil());
        let pixels = |low: f64, high: f64| low.max(0.0) as usize..(high as usize).min(SIDE);
        for row in pixels(low.y, high.y) {
            for column in pixels(low.x, high.x) {
                let p = DVec2::new(column as f64, row as f64) + 0.5 - a;
                let [u, v] = [p.perp_dot(c - a), (b - a).perp_dot(p)].map(|area| area / det);
                if u < -1e-9 || v < -1e-9 || u + v > 1.0 + 1e-9 {
                    continue;
                }
                let pixel = (SIDE - 1 - row) * SIDE + column;
                let designs = [corners(&placement.in_source), corners(&placement.in_target)];
                for (k, [a, b, c]) in designs.into_iter().enumerate() {
                    let plane = |axis: usize| expected[(2 * k + axis) * SIDE * SIDE + pixel];
                    let position = a + u * (b - a) + v * (c - a);
                    distances[2 * pixel + k] = position.distance(DVec2::new(plane(0), plane(1)));
                }
            }
        }
    }
    distances
}

/// Times whole frames (warp and pixels) on one and on two threads.
fn whole_frame(criterion: &mut Criterion, transition: &Transition) -> Result<()> {
    for threads in [1, 2] {
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = builder.build()?;
        let mut frame = transition.frame(0.0);
        let name = format!("whole/{SIDE} x {SIDE}, {threads} threads");
        criterion.bench_function(&name, |bench| {
            bench.iter(|| pool.install(|| picture(&mut frame)));
        });
    }
    Ok(())
}

/// Times the warp alone, on a grid of about 33,000 points.
fn warp(criterion: &mut Criterion) -> Result<()> {
    let bounds = Bounds {
        min: DVec2::ZERO,
        max: DVec2::splat(SIDE as f64),
    };
    let grid = PlaneGrid::covering(&bounds, 181);
    let lines: Vec<LinePair> = (0..COUNT).map(pair).collect();
    for falloff in [2.0, 1.5] {
        let options = LineOptions {
            falloff,
            ..LineOptions::default()
        };
        let mut warp = LineWarp::new(&bounds, &lines, &[], &options)?;
        let mut designs = [grid.places().to_vec(), grid.places().to_vec()];
        let name = format!("frame/{} places, b = {falloff}", grid.places().len());
        criterion.bench_function(&name, |bench| {
            let [source, target] = &mut designs;
            bench.iter(|| warp.look_up(0.4, grid.places(), source, target));
        });
    }
    Ok(())
}
