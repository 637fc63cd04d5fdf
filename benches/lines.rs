//! A whole frame of two pictures of 1024 by 1024 through 40 pairs of lines,
//! as the program makes it: the warp on its grid, and the pixels.
//!
//! `cargo bench --no-default-features --bench lines`. Where the variable
//! `LINES_NUMPY` names a Python that has NumPy, `benches/lines_numpy.py` makes
//! the same frame before, and its times, those of the program in the same
//! minute, and how far the two are apart are printed. NumPy looks the lines up
//! at every pixel; the program does so at the corners of its grid and is
//! linear between them.

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

const SIDE: usize = 1024;
const COUNT: u32 = 40;

/// The frame, its pixels in the plane.
const PIXELS: PictureRaster = PictureRaster {
    size: [SIDE as u32; 2],
    corner: DVec2::new(0.0, SIDE as f64),
    pixel: 1.0,
};

fn main() -> Result<()> {
    let transition = transition()?;
    if let Some(python) = std::env::var_os("LINES_NUMPY") {
        compare(&python, &transition)?;
    }
    let mut criterion = Criterion::default().configure_from_args();
    whole(&mut criterion, &transition)?;
    warp(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}

fn line(middle: DVec2, angle: f64, length: f64) -> [DVec2; 2] {
    let half = DVec2::from_angle(angle) * (0.5 * length);
    [middle - half, middle + half]
}

fn pair(i: u32) -> LinePair {
    let i = f64::from(i);
    let middle = DVec2::new(0.5 + i * 0.7548776662, 0.5 + i * 0.5698402910).fract() * SIDE as f64;
    let angle = 2.4 * i;
    let length = 60.0 + 240.0 * (i * 0.6180339887).fract();
    let moved = middle + 40.0 * DVec2::new((1.7 * i).cos(), (1.3 * i).sin());
    let stretched = length * (1.0 + 0.3 * (2.1 * i).cos());
    LinePair {
        source: line(middle, angle, length),
        target: line(moved, angle + 0.5 * i.sin(), stretched),
    }
}

/// An opaque picture of slow waves.
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
    spec.cell = TransitionMethod::new(WarpKind::Lines, ContentKind::Colours)?;
    spec.options.matching.lines = (0..COUNT).map(pair).collect();
    Ok(Transition::build(&spec, &Silent)?)
}

/// Of a frame of pictures there is one.
fn picture(frame: &mut Frame) -> Option<RgbaImage> {
    frame.seek(0.5);
    frame.picture(&PIXELS)
}

/// Times NumPy, then the program, and holds what they make against each other.
#[expect(clippy::print_stdout, reason = "it is what the variable asks for")]
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
    let seen = picture(&mut frame).ok_or("a frame without colours")?;
    let (planes, colours) = expected.split_at(4 * SIDE * SIDE);
    let differences = apart(frame.placement(), planes);
    let (most, mean) = most_and_mean(&differences);
    println!("the maps are at most {most:.2} px apart, {mean:.4} px in the mean");
    let levels = seen.as_raw().chunks_exact(4).zip(colours.as_chunks().0);
    let off = |(a, b): (&[u8], &[f64; 3])| [0, 1, 2].map(|k| (f64::from(a[k]) - b[k]).abs());
    let (most, mean) = most_and_mean(&levels.flat_map(off).collect::<Vec<_>>());
    println!("the pictures are at most {most} levels of 255 apart, {mean:.4} in the mean");
    Ok(())
}

fn most_and_mean(values: &[f64]) -> (f64, f64) {
    let most = values.iter().copied().fold(0.0, f64::max);
    (most, values.iter().sum::<f64>() / values.len() as f64)
}

/// How far each pixel's places in both designs are from those expected: four
/// planes, x and y in the source and in the target.
fn apart(placement: &Placement, expected: &[f64]) -> Vec<f64> {
    let mut apart = vec![f64::INFINITY; 2 * SIDE * SIDE];
    for face in placement.faces.iter() {
        let of = |points: &[DVec2]| face.map(|v| points[v as usize]);
        let [a, b, c] = of(&placement.in_frame);
        let det = (b - a).perp_dot(c - a);
        let (low, high) = (a.min(b).min(c).floor(), a.max(b).max(c).ceil());
        let pixels = |low: f64, high: f64| low.max(0.0) as usize..(high as usize).min(SIDE);
        for up in pixels(low.y, high.y) {
            for column in pixels(low.x, high.x) {
                let p = DVec2::new(column as f64, up as f64) + 0.5 - a;
                let [u, v] = [p.perp_dot(c - a), (b - a).perp_dot(p)].map(|area| area / det);
                if u < -1e-9 || v < -1e-9 || u + v > 1.0 + 1e-9 {
                    continue;
                }
                let pixel = (SIDE - 1 - up) * SIDE + column;
                let designs = [of(&placement.in_source), of(&placement.in_target)];
                for (k, [a, b, c]) in designs.into_iter().enumerate() {
                    let plane = |axis: usize| expected[(2 * k + axis) * SIDE * SIDE + pixel];
                    let place = a + u * (b - a) + v * (c - a);
                    apart[2 * pixel + k] = place.distance(DVec2::new(plane(0), plane(1)));
                }
            }
        }
    }
    apart
}

fn whole(criterion: &mut Criterion, transition: &Transition) -> Result<()> {
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

/// The warp alone, on a grid of some 33 000 places.
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
