//! The warp by line features: a raster of 1024 by 1024, and a frame's grid.
//!
//! `cargo bench --no-default-features --bench lines`. The lines are those of
//! `benches/lines_numpy.py`, which computes the same in plain NumPy; where
//! the variable `LINES_NUMPY` names the file it wrote, the greatest difference
//! to it is printed.

use criterion::{BenchmarkId, Criterion, Throughput};
use morphospace::correspondence::LinePair;
use morphospace::geometry::{Bounds, DVec2};
use morphospace::warp::{LineMap, LineOptions, Lines, PlaneGrid, PlaneWarp, Raster, Segment};
use std::error::Error;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

const SIDE: usize = 1024;
const COUNT: u32 = 40;

fn main() -> Result<()> {
    if let Some(file) = std::env::var_os("LINES_NUMPY") {
        compare(&std::fs::read(file)?)?;
    }
    let mut criterion = Criterion::default().configure_from_args();
    raster(&mut criterion)?;
    frame(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}

fn segment(middle: DVec2, angle: f64, length: f64) -> Segment {
    let half = DVec2::from_angle(angle) * (0.5 * length);
    [middle - half, middle + half]
}

/// Line i in the frame and in the design.
fn pair(i: u32) -> [Segment; 2] {
    let i = f64::from(i);
    let middle = DVec2::new(0.5 + i * 0.7548776662, 0.5 + i * 0.5698402910).fract() * SIDE as f64;
    let angle = 2.4 * i;
    let length = 60.0 + 240.0 * (i * 0.6180339887).fract();
    let moved = middle + 40.0 * DVec2::new((1.7 * i).cos(), (1.3 * i).sin());
    let turned = angle + 0.5 * i.sin();
    let stretched = length * (1.0 + 0.3 * (2.1 * i).cos());
    [
        segment(middle, angle, length),
        segment(moved, turned, stretched),
    ]
}

fn pairs() -> Vec<[Segment; 2]> {
    (0..COUNT).map(pair).collect()
}

const PIXELS: Raster = Raster {
    origin: DVec2::splat(0.5),
    step: DVec2::ONE,
    columns: SIDE,
};

#[expect(clippy::print_stdout, reason = "it is what the variable asks for")]
fn compare(bytes: &[u8]) -> Result<()> {
    let expected: Vec<f64> = bytes
        .as_chunks()
        .0
        .iter()
        .map(|b| f64::from_le_bytes(*b))
        .collect();
    let mut found = vec![0.0; 2 * SIDE * SIDE];
    if expected.len() != found.len() {
        return Err("the file does not hold two planes of 1024 by 1024 doubles".into());
    }
    let (x, y) = found.split_at_mut(SIDE * SIDE);
    LineMap::new(&pairs(), 1.0, 2.0, 0.5)?.map_raster(&PIXELS, x, y);
    let differences = found.iter().zip(&expected).map(|(a, b)| (a - b).abs());
    println!(
        "greatest difference to NumPy: {:e} px",
        differences.fold(0.0, f64::max)
    );
    Ok(())
}

fn raster(criterion: &mut Criterion) -> Result<()> {
    let mut group = criterion.benchmark_group("raster");
    group.sample_size(20);
    group.throughput(Throughput::Elements((SIDE * SIDE) as u64));
    let [mut x, mut y] = [vec![0.0; SIDE * SIDE], vec![0.0; SIDE * SIDE]];
    for b in [2.0, 1.0, 1.5] {
        let map = LineMap::new(&pairs(), 1.0, b, 0.5)?;
        for threads in [1, 2] {
            let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = builder.build()?;
            let id = BenchmarkId::new(format!("b = {b}/{threads} threads"), SIDE);
            group.bench_function(id, |bench| {
                bench.iter(|| pool.install(|| map.map_raster(&PIXELS, &mut x, &mut y)));
            });
        }
    }
    group.finish();
    Ok(())
}

/// A frame of a film: a grid of some 33 000 places, both designs.
fn frame(criterion: &mut Criterion) -> Result<()> {
    let bounds = Bounds {
        min: DVec2::ZERO,
        max: DVec2::splat(SIDE as f64),
    };
    let grid = PlaneGrid::covering(&bounds, 181);
    let line = |[source, target]: [Segment; 2]| LinePair { source, target };
    let lines: Vec<LinePair> = pairs().into_iter().map(line).collect();
    for falloff in [2.0, 1.5] {
        let options = LineOptions {
            falloff,
            ..LineOptions::default()
        };
        let warp = Lines::new(&bounds, &lines, &[], &options)?;
        let mut maps = warp.maps();
        let mut designs = [grid.places().to_vec(), grid.places().to_vec()];
        let name = format!("frame/{} places, b = {falloff}", grid.places().len());
        criterion.bench_function(&name, |bench| {
            let [source, target] = &mut designs;
            bench.iter(|| warp.look_up(0.4, &mut maps, grid.places(), source, target));
        });
    }
    Ok(())
}
