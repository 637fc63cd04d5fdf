//! Times compatible triangulation of easy and hard pairs of outlines, and the growth of the time
//! with the number of points.
//!
//! `cargo bench --no-default-features --bench triangulation`

use criterion::{BenchmarkId, Criterion};
use morphospace::compatible::{CompatibleMesh, PolygonOptions};
use morphospace::geometry::DVec2;
use morphospace::work::progress::Silent;
use std::f64::consts::TAU;

/// Boundary loops of the source and of the target; each design is a list of loops.
type RingPair = [Vec<Vec<DVec2>>; 2];

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    gallery(&mut criterion);
    growth(&mut criterion);
    criterion.final_summary();
}

fn polar(radius: f64, angle: f64) -> DVec2 {
    radius * DVec2::from_angle(angle)
}

/// An outline of `count` points with `lobes` lobes and without rotational symmetry.
fn lobes(count: usize, lobes: f64) -> Vec<DVec2> {
    let point = |k: usize| {
        let a = TAU * k as f64 / count as f64;
        polar(2.0 + (lobes * a).sin().powi(3) + 0.3 * a.cos(), a)
    };
    (0..count).map(point).collect()
}

/// Outline of a band that is wound into a spiral.
fn spiral(count: usize, turns: f64) -> Vec<DVec2> {
    let steps = count / 2 - 1;
    let at = |k: usize, out: f64| {
        let fraction = k as f64 / steps as f64;
        polar(0.2 + turns * fraction + out, TAU * turns * fraction)
    };
    let outer = (0..=steps).map(|k| at(k, 0.6));
    outer.chain((0..=steps).rev().map(|k| at(k, 0.0))).collect()
}

/// Outline of a straight band.
fn strip(count: usize) -> Vec<DVec2> {
    let steps = count / 2 - 1;
    let at = |k: usize, y: f64| DVec2::new(30.0 * k as f64 / steps as f64, y);
    let low = (0..=steps).map(|k| at(k, 0.0));
    low.chain((0..=steps).rev().map(|k| at(k, 1.0))).collect()
}

/// Outline of a comb with a tooth for every four points.
fn comb(count: usize) -> Vec<DVec2> {
    let teeth = count / 4;
    let mut points = vec![DVec2::ZERO, DVec2::new(teeth as f64, 0.0)];
    for tooth in (0..teeth).rev() {
        let x = tooth as f64;
        let tips = [(0.9, 3.0), (0.5, 3.0), (0.1, 3.0), (0.0, 0.1)];
        points.extend(tips.map(|(dx, y)| DVec2::new(x + dx, y)));
    }
    points
}

/// An annulus: an outer circle, and a hole whose points are rotated by `turn` radians.
fn annulus(count: usize, turn: f64) -> Vec<Vec<DVec2>> {
    let ring = |radius: f64, turn: f64, n: usize, direction: f64| -> Vec<DVec2> {
        (0..n)
            .map(|k| polar(radius, turn + direction * TAU * k as f64 / n as f64))
            .collect()
    };
    vec![
        ring(2.0, 0.0, 2 * count / 3, 1.0),
        ring(1.0, turn, count / 3, -1.0),
    ]
}

/// Pairs of designs with about `count` points each, and their names.
fn pairs(count: usize) -> Vec<(&'static str, RingPair)> {
    let comb = comb(count);
    let mut shifted = lobes(count, 5.0);
    shifted.rotate_left(count / 3);
    let round = lobes(comb.len(), 5.0);
    vec![
        ("poses", [vec![lobes(count, 5.0)], vec![lobes(count, 4.0)]]),
        ("shifted", [vec![lobes(count, 5.0)], vec![shifted]]),
        ("uncoiled", [vec![spiral(count, 3.0)], vec![strip(count)]]),
        ("comb", [vec![comb], vec![round]]),
        ("annulus", [annulus(count, 0.0), annulus(count, 1.0)]),
    ]
}

/// Times all pairs, or only the pair with the name `only`, for each number of points in `counts`.
fn bench(criterion: &mut Criterion, group: &str, counts: &[usize], only: Option<&str>) {
    let mut group = criterion.benchmark_group(group);
    group.sample_size(10);
    for &count in counts {
        for (name, [source, target]) in pairs(count) {
            if only.is_none_or(|only| only == name) {
                let options = PolygonOptions::default();
                group.bench_function(BenchmarkId::new(name, count), |bencher| {
                    bencher
                        .iter(|| CompatibleMesh::from_piece(&source, &target, &options, &Silent));
                });
            }
        }
    }
    group.finish();
}

fn gallery(criterion: &mut Criterion) {
    bench(criterion, "gallery", &[120, 1200], None);
}

/// Times one pair of outlines with growing numbers of points.
fn growth(criterion: &mut Criterion) {
    bench(
        criterion,
        "growth",
        &[120, 240, 480, 1200, 2400],
        Some("poses"),
    );
}
