//! Times frames of warps by scattered points and by lattices. For each frame, two mappings from the
//! common frame, into the source and into the target, are evaluated on a raster of 512 × 512 points
//! or on a grid of 64 × 64 cells.
//!
//! `cargo bench --no-default-features --bench scattered`. For comparison,
//! `benches/scattered_scipy.py` solves and evaluates the mappings of the raster frames with
//! `scipy.interpolate.RBFInterpolator`, for the same point pairs.

use criterion::{BenchmarkId, Criterion, Throughput};
use morphospace::correspondence::PointPair;
use morphospace::geometry::{Bounds, DVec2};
use morphospace::warp::{
    Lattice, LatticeOptions, PlaneGrid, PlaneWarp, RadialBasis, ScatteredOptions, ScatteredWarp,
};
use std::error::Error;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Region of the plane that the warps cover: the unit square.
const SQUARE: Bounds = Bounds {
    min: DVec2::ZERO,
    max: DVec2::ONE,
};

fn main() -> Result<()> {
    let mut criterion = Criterion::default().configure_from_args();
    rasters(&mut criterion)?;
    frames(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}

/// Returns `count` points spread evenly over the unit square by the additive recurrence with the
/// plastic number. `shift` is the number of steps of the recurrence by which all points are moved.
fn spread(count: u32, shift: f64) -> Vec<DVec2> {
    let step = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2);
    let point = |k| ((f64::from(k) + shift) * step).fract();
    (1..=count).map(point).collect()
}

/// Target of the source point `p`: a smooth function of `p`.
fn target_of(p: &DVec2) -> DVec2 {
    DVec2::new((3.0 * p.x).sin() + p.y * p.y, p.x * (2.0 * p.y).cos())
}

/// Options with the given radial basis and a width suited to the unit square.
fn with_basis(basis: RadialBasis) -> ScatteredOptions {
    ScatteredOptions {
        basis,
        width: 0.25 / std::f64::consts::SQRT_2, // in diagonals: a quarter of the side
        ..ScatteredOptions::default()
    }
}

/// Times frames at t = ½ on a raster of 512 × 512 points. For each frame, the mappings from the
/// common frame into the source and into the target are solved and evaluated at all points.
fn rasters(criterion: &mut Criterion) -> Result<()> {
    let raster: Vec<DVec2> = (0..512 * 512)
        .map(|k| DVec2::new(f64::from(k % 512), f64::from(k / 512)) / 511.0)
        .collect();
    let (mut source, mut target) = (raster.clone(), raster.clone());
    let mut group = criterion.benchmark_group("raster");
    group.sample_size(10);
    group.throughput(Throughput::Elements(512 * 512));
    for basis in [
        RadialBasis::ThinPlate,
        RadialBasis::Gaussian,
        RadialBasis::Multiquadric,
    ] {
        for count in [50, 200, 500] {
            let centres = spread(count, 0.0).into_iter();
            let pairs: Vec<_> = centres
                .map(|source| PointPair {
                    source,
                    target: target_of(&source),
                })
                .collect();
            let mut warp = ScatteredWarp::new(&SQUARE, &pairs, &[], with_basis(basis))?;
            for threads in [1, 2] {
                let pool = rayon::ThreadPoolBuilder::new()
                    .num_threads(threads)
                    .build()?;
                let id = BenchmarkId::new(format!("{basis:?}, {threads} thread"), count);
                group.bench_function(id, |b| {
                    b.iter(|| {
                        pool.install(|| {
                            warp.look_up(0.5, &raster, &mut source, &mut target);
                        });
                    });
                });
            }
        }
    }
    group.finish();
    Ok(())
}

/// Point pairs whose targets differ from their sources by at most 0.1 in x and in y.
fn pairs(count: u32) -> Vec<PointPair> {
    let ends = spread(count, 0.0).into_iter().zip(spread(count, 0.3));
    let pair = |(source, shift): (DVec2, DVec2)| PointPair {
        source,
        target: source + 0.2 * (shift - 0.5),
    };
    ends.map(pair).collect()
}

/// Times frames on a grid for several numbers of point pairs.
fn frames(criterion: &mut Criterion) -> Result<()> {
    let mut group = criterion.benchmark_group("frame");
    group.sample_size(10);
    for count in [10, 50, 200, 500] {
        for basis in [
            RadialBasis::ThinPlate,
            RadialBasis::Gaussian,
            RadialBasis::Multiquadric,
        ] {
            let warp = ScatteredWarp::new(&SQUARE, &pairs(count), &[], with_basis(basis))?;
            group.bench_function(BenchmarkId::new(format!("{basis:?}"), count), |b| {
                b.iter(frame(&warp));
            });
        }
        for fold_free in [true, false] {
            let options = LatticeOptions {
                fold_free,
                ..LatticeOptions::default()
            };
            let name = if fold_free { "composed" } else { "summed" };
            let warp = Lattice::new(&SQUARE, &pairs(count), &[], options)?;
            group.bench_function(BenchmarkId::new(format!("lattice, {name}"), count), |b| {
                b.iter(frame(&warp));
            });
        }
    }
    group.finish();
    Ok(())
}

/// Returns a function that computes a frame of `warp` on a grid of 64 × 64 cells, at a different t
/// in each call.
fn frame<W: PlaneWarp>(warp: &W) -> impl FnMut() {
    let places = PlaneGrid::covering(&SQUARE, 64).places().to_vec();
    let (mut source, mut target) = (places.clone(), places.clone());
    let mut warp = warp.clone();
    let mut step = 0;
    move || {
        step = (step + 37) % 100;
        let t = f64::from(step) / 100.0;
        warp.look_up(t, &places, &mut source, &mut target);
    }
}
