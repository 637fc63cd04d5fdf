//! Times the matching of two outlines, and the construction of two polygons with corresponding
//! vertices from the match.
//!
//! `cargo bench --no-default-features --bench matching`

use criterion::{BenchmarkId, Criterion};
use morphospace::correspondence::{BoundaryCurve, MatchOptions, match_curves};
use morphospace::geometry::{DVec2, Ring};
use std::error::Error;
use std::f64::consts::TAU;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let mut criterion = Criterion::default().configure_from_args();
    matching(&mut criterion)?;
    polygons(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}

/// An outline of `count` points with `lobes` lobes and without rotational symmetry.
fn lobes(count: u32, lobes: f64) -> Result<BoundaryCurve> {
    let point = |k: u32| {
        let a = TAU * f64::from(k) / f64::from(count);
        let radius = 2.0 + (lobes * a).sin().powi(3) + 0.3 * a.cos();
        radius * DVec2::from_angle(a)
    };
    Ok(BoundaryCurve::closed(&Ring::new(
        (0..count).map(point).collect(),
    )?)?)
}

/// Times matching for several numbers of outline points, and of samples taken along each outline.
fn matching(criterion: &mut Criterion) -> Result<()> {
    let mut group = criterion.benchmark_group("match_curves");
    group.sample_size(20);
    for (points, samples) in [(120, 120), (120, 160), (120, 200), (1200, 160), (120, 400)] {
        let (source, target) = (lobes(points, 5.0)?, lobes(points, 4.0)?);
        let options = MatchOptions {
            samples,
            ..MatchOptions::default()
        };
        let name = format!("{points}_points");
        group.bench_function(BenchmarkId::new(name, samples), |bencher| {
            bencher.iter(|| match_curves(&source, &target, &[], &options));
        });
    }
    group.finish();
    Ok(())
}

fn polygons(criterion: &mut Criterion) -> Result<()> {
    let (source, target) = (lobes(120, 5.0)?, lobes(120, 4.0)?);
    let matched = match_curves(&source, &target, &[], &MatchOptions::default())?;
    criterion.bench_function("polygons", |bencher| {
        bencher.iter(|| matched.polygons(&source, &target, f64::INFINITY));
    });
    Ok(())
}
