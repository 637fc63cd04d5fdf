//! Times distance transforms of masks, exact distance fields of polygons, and the extraction of the
//! contour of a field blend.
//!
//! `cargo bench --no-default-features --bench field`. For comparison, `benches/field_edt.py` times
//! `edt.sdf` (PyPI package edt) on the same masks.

use criterion::{BenchmarkId, Criterion, Throughput};
use morphospace::content::{FieldBlend, FieldPair};
use morphospace::field::{DistanceField, Grid, Mask, Metric, distance_transform};
use morphospace::geometry::{DVec2, FillRule, Regions};
use morphospace::work::progress::Silent;
use std::error::Error;
use std::f64::consts::TAU;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let mut criterion = Criterion::default().configure_from_args();
    signed_transform(&mut criterion)?;
    polygon_field(&mut criterion)?;
    contour(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}

/// Mask of a gear with 24 teeth and a central hole; `side` is the side of the mask in cells.
fn gear(side: u32) -> Result<Mask> {
    let half = f64::from(side / 2);
    let is_inside = |x: u32, y: u32| {
        let p = DVec2::new(f64::from(x), f64::from(y)) - half;
        let radius = p.length() / half;
        let tooth = (24.0 * p.y.atan2(p.x)).sin() >= 0.0;
        radius > 0.3 && radius < if tooth { 0.76 } else { 0.6 }
    };
    mask(side, is_inside)
}

/// Mask of random cells, half of them inside, so that runs of equal cells are many and short;
/// `side` is the side of the mask in cells.
fn noise(side: u32) -> Result<Mask> {
    mask(side, |x, y| {
        let hash = (x + side * y).wrapping_mul(2_654_435_761);
        (hash ^ (hash >> 15)).wrapping_mul(2_246_822_519) >> 31 == 1
    })
}

fn mask(side: u32, is_inside: impl Fn(u32, u32) -> bool + Copy) -> Result<Mask> {
    let bits = (0..side).flat_map(|y| (0..side).map(move |x| is_inside(x, y)));
    Ok(Mask::new(side, side, bits.collect())?)
}

fn signed_transform(criterion: &mut Criterion) -> Result<()> {
    let mut group = criterion.benchmark_group("signed_transform");
    group.sample_size(20);
    for side in [512, 1024, 2048] {
        group.throughput(Throughput::Elements(u64::from(side) * u64::from(side)));
        for (name, mask) in [("gear", gear(side)?), ("noise", noise(side)?)] {
            for threads in [1, 2] {
                let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
                let pool = builder.build()?;
                let id = BenchmarkId::new(format!("{name}/{threads} thread"), side);
                group.bench_function(id, |b| {
                    b.iter(|| {
                        pool.install(|| distance_transform(&mask, Metric::Euclidean, &Silent))
                    });
                });
            }
        }
    }
    for metric in [
        Metric::CityBlock,
        Metric::Chessboard,
        Metric::QuasiEuclidean,
    ] {
        let mask = gear(1024)?;
        let id = BenchmarkId::new(format!("gear/{metric:?}"), 1024);
        group.bench_function(id, |b| {
            b.iter(|| distance_transform(&mask, metric, &Silent));
        });
    }
    group.finish();
    Ok(())
}

/// A disc with a wavy outline. `edges` is the number of edges of the outline, `waves` the number of
/// waves around it.
fn wavy(edges: u32, waves: f64) -> Result<Regions> {
    let angles = (0..edges).map(|i| f64::from(i) * TAU / f64::from(edges));
    let ring = angles.map(|a| DVec2::from_angle(a) * (8.0 + 2.0 * (waves * a).sin()));
    Ok(Regions::from_rings(&[ring.collect()], FillRule::NonZero)?)
}

fn polygon_field(criterion: &mut Criterion) -> Result<()> {
    let mut group = criterion.benchmark_group("polygon_field");
    group.sample_size(20);
    for (edges, waves) in [(200, 3.0), (2000, 0.0), (2000, 15.0), (20_000, 15.0)] {
        let regions = wavy(edges, waves)?;
        let grid = Grid::covering(&regions.bounds(), 512, 0.1)?;
        let id = BenchmarkId::new(format!("{edges} edges, {waves} waves"), 512);
        group.bench_function(id, |b| {
            b.iter(|| DistanceField::from_regions(&regions, grid, &Silent));
        });
    }
    group.finish();
    Ok(())
}

fn contour(criterion: &mut Criterion) -> Result<()> {
    let (source, target) = (wavy(2000, 5.0)?, wavy(2000, 14.0)?);
    let grid = Grid::covering(&source.bounds().union(&target.bounds()), 512, 0.1)?;
    let field = |regions| DistanceField::from_regions(regions, grid, &Silent);
    let pair = FieldPair::new(field(&source)?, field(&target)?, FieldBlend::default())?;
    criterion.bench_function("contour/512", |b| b.iter(|| pair.contour(0.4)));
    Ok(())
}
