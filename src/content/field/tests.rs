//! Tests of field blends: the paper's formula, exact shapes at t = 0 and t = 1, thresholds,
//! topology, clipping and refused input.

use super::*;
use crate::geometry::{Bounds, FillRule, Regions, signed_area};
use crate::work::progress::Silent;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn circle(centre: DVec2, radius: f64) -> Vec<DVec2> {
    (0..360)
        .map(|i| centre + radius * DVec2::from_angle(f64::from(i) * TAU / 360.0))
        .collect()
}

fn regions(rings: &[Vec<DVec2>]) -> Regions {
    Regions::from_rings(rings, FillRule::EvenOdd).expect("an area")
}

/// Area of the filled shape at `t`, holes subtracted.
fn drawn_area(pair: &FieldPair, t: f64) -> f64 {
    pair.contour(t).iter().map(|ring| signed_area(ring)).sum()
}

fn grid(cells: u32) -> Grid {
    let bounds = Bounds {
        min: DVec2::splat(-10.0),
        max: DVec2::splat(10.0),
    };
    Grid::covering(&bounds, cells, 0.0).expect("a grid")
}

fn pair(source: &Regions, target: &Regions, cells: u32, blend: FieldBlend) -> FieldPair {
    let field = |r| DistanceField::from_regions(r, grid(cells), &Silent).expect("a field");
    FieldPair::new(field(source), field(target), blend).expect("a pair")
}

fn log(epsilon: f64) -> FieldBlend {
    FieldBlend {
        epsilon,
        ..FieldBlend::default()
    }
}

/// Parameters of a blend on the linear scale.
const REAL: FieldBlend = FieldBlend {
    space: BlendSpace::Real,
    epsilon: 1.0,
    threshold: 0.0,
};

proptest! {
    #[test]
    fn at_epsilon_1_the_blend_is_the_formula_of_the_paper(
        x in -3000.0..3000.0_f64,
        y in -3000.0..3000.0_f64,
        t in 0.0..1.0_f64,
    ) {
        let paper = |x: f64| x.signum() * (x.abs() + 1.0).ln();
        let blend = log(1.0);
        prop_assert!((blend.curve(x) - paper(x)).abs() < 1e-12);
        let expected = (1.0 - t) * paper(x) + t * paper(y);
        prop_assert!((blend.value(x, y, t) - expected).abs() < 1e-12);
    }

    #[test]
    fn the_curve_is_odd_monotone_and_keeps_the_sign(
        x in -1e4..1e4_f64,
        step in 1e-6..10.0_f64,
        exponent in -12.0..12.0_f64,
    ) {
        let blend = log(10.0_f64.powf(exponent));
        prop_assert_eq!(blend.curve(-x), -blend.curve(x));
        prop_assert!(blend.curve(x + step) >= blend.curve(x));
        prop_assert!(blend.curve(x) * x >= 0.0);
    }
}

#[test]
fn the_curve_is_continuous_at_the_boundary_where_the_paper_jumps() {
    for epsilon in [1e-3, 0.1, 1.0, 30.0] {
        let blend = log(epsilon);
        assert_eq!(blend.curve(0.0), 0.0);
        assert!(blend.curve(1e-9 * epsilon).abs() < 1e-8);
    }
    let paper = |x: f64, epsilon: f64| x.signum() * (x.abs() + epsilon).ln();
    assert!(paper(1e-9, 0.1) < -2.0, "inside, and negative");
}

#[test]
fn the_smallest_epsilon_is_still_finite_and_monotone() {
    let blend = log(f64::from_bits(1));
    let values = [1e-300, 1e-3, 0.5, 1.0, 2.0, 1e4].map(|x| blend.curve(x));
    assert!(values.iter().all(|v| v.is_finite()));
    assert!(values.windows(2).all(|w| w[0] < w[1]), "{values:?}");
}

#[test]
fn the_ends_are_the_designs() {
    let ring = regions(&[circle(DVec2::ZERO, 7.0), circle(DVec2::X, 3.0)]);
    let disc = regions(&[circle(DVec2::new(2.0, -1.0), 5.0)]);
    for blend in [log(1.0), log(0.05), REAL] {
        let pair = pair(&ring, &disc, 128, blend);
        for (t, design, rings) in [(0.0, &ring, 2), (1.0, &disc, 1)] {
            let contour = pair.contour(t);
            assert_eq!(contour.len(), rings);
            assert!((drawn_area(&pair, t) / design.area() - 1.0).abs() < 2e-3);
            let cell = pair.grid().cell;
            for &p in contour.iter().flatten() {
                let edges = design.rings().flat_map(|r| r.edges());
                let to_edge = |(a, b): (DVec2, DVec2)| {
                    let s = (p - a).dot(b - a) / (b - a).length_squared();
                    p.distance(a.lerp(b, s.clamp(0.0, 1.0)))
                };
                let d = edges.map(to_edge).fold(f64::INFINITY, f64::min);
                assert!(d < 0.05 * cell, "{p} is {d} from the outline");
            }
        }
    }
}

#[test]
fn at_the_ends_the_other_design_does_not_matter() {
    let a = regions(&[circle(DVec2::ZERO, 7.0)]);
    let b = regions(&[circle(DVec2::ONE, 4.0)]);
    let c = regions(&[circle(-DVec2::ONE, 2.0), circle(DVec2::splat(5.0), 1.0)]);
    for blend in [log(0.3), REAL] {
        let (ab, ac) = (pair(&a, &b, 64, blend), pair(&a, &c, 64, blend));
        assert_eq!(ab.contour(0.0), ac.contour(0.0));
        assert_ne!(ab.contour(0.5), ac.contour(0.5));
    }
}

#[test]
fn swapping_the_designs_reverses_time() {
    let a = regions(&[circle(DVec2::new(-2.0, 1.0), 4.0)]);
    let b = regions(&[circle(DVec2::new(3.0, 0.0), 6.0)]);
    let (there, back) = (pair(&a, &b, 64, log(1.0)), pair(&b, &a, 64, log(1.0)));
    for t in [0.0, 0.25, 0.5, 1.0] {
        assert_eq!(there.contour(t), back.contour(1.0 - t));
    }
}

#[test]
fn equal_source_and_target_stand_still() {
    let a = regions(&[circle(DVec2::ZERO, 6.0), circle(DVec2::Y, 2.0)]);
    let still = pair(&a, &a, 64, log(0.5));
    let area = drawn_area(&still, 0.0);
    for t in [0.1, 0.5, 0.9, 1.0, 1.7] {
        assert!((drawn_area(&still, t) / area - 1.0).abs() < 1e-12);
    }
}

#[test]
fn between_concentric_discs_the_area_follows_the_radius() {
    let (small, large) = (3.0, 8.0);
    let disc = |radius| regions(&[circle(DVec2::ZERO, radius)]);
    let real = pair(&disc(small), &disc(large), 200, REAL);
    let logarithmic = pair(&disc(small), &disc(large), 200, log(1.0));
    let mut last = 0.0;
    for i in 0..=10 {
        let t = f64::from(i) / 10.0;
        let radius = small + t * (large - small);
        let exact = PI * radius * radius;
        assert!((drawn_area(&real, t) / exact - 1.0).abs() < 2e-3, "t = {t}");
        let area = drawn_area(&logarithmic, t);
        assert!(area > last, "t = {t}");
        last = area;
    }
}

#[test]
fn the_threshold_moves_the_boundary_by_cells() {
    let disc = regions(&[circle(DVec2::ZERO, 6.0)]);
    for threshold in [-4.0, 2.5] {
        for blend in [log(0.7), REAL] {
            let pair = pair(&disc, &disc, 200, FieldBlend { threshold, ..blend });
            let radius = 6.0 - threshold * pair.grid().cell;
            let exact = PI * radius * radius;
            assert!((drawn_area(&pair, 0.3) / exact - 1.0).abs() < 2e-3);
        }
    }
}

#[test]
fn holes_run_clockwise_and_topology_may_change() {
    let two = regions(&[
        circle(DVec2::new(-5.0, 0.0), 3.0),
        circle(DVec2::new(5.0, 0.0), 3.0),
    ]);
    let ring = regions(&[circle(DVec2::ZERO, 8.0), circle(DVec2::ZERO, 4.0)]);
    let pair = pair(&two, &ring, 128, log(1.0));
    let turns = |t: f64| -> Vec<bool> {
        let mut turns: Vec<bool> = pair
            .contour(t)
            .iter()
            .map(|r| signed_area(r) > 0.0)
            .collect();
        turns.sort_unstable();
        turns
    };
    assert_eq!(turns(0.0), [true, true]);
    assert_eq!(turns(1.0), [false, true]);
}

#[test]
fn points_are_inside_exactly_where_the_contour_encloses_them() {
    let a = regions(&[circle(DVec2::new(-2.0, 1.0), 4.0)]);
    let b = regions(&[circle(DVec2::ZERO, 8.0), circle(DVec2::ZERO, 4.0)]);
    let pair = pair(&a, &b, 96, log(0.4));
    for t in [0.2, 0.5, 0.8] {
        let drawn = regions(&pair.contour(t));
        let mut inside = 0;
        for i in 0..60 {
            for j in 0..60 {
                let p = DVec2::new(f64::from(i), f64::from(j)) / 3.0 - DVec2::splat(9.9);
                // A contour is straight within a cell of the grid. Where the blend is within 0.02
                // of the contour's level, a point may therefore lie on the other side of the
                // contour.
                if (pair.value(p, t) - pair.blend().level()).abs() > 0.02 {
                    assert_eq!(pair.is_inside(p, t), drawn.contains(p), "{p} at {t}");
                    inside += i32::from(drawn.contains(p));
                }
            }
        }
        assert!(inside > 100, "only {inside} points were inside");
    }
}

#[test]
fn a_design_beyond_its_grid_is_clipped() {
    let vast = regions(&[circle(DVec2::ZERO, 40.0)]);
    let pair = pair(&vast, &vast, 32, log(1.0));
    let contour = pair.contour(0.5);
    assert_eq!(contour.len(), 1);
    assert!((drawn_area(&pair, 0.5) - 400.0).abs() < 1e-9);
    assert!(!pair.is_inside(DVec2::new(0.0, 10.5), 0.5));
}

#[test]
fn invalid_blends_and_pairs_are_refused() {
    let disc = regions(&[circle(DVec2::ZERO, 6.0)]);
    let legal = pair(&disc, &disc, 16, REAL);
    for epsilon in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            legal.with_blend(log(epsilon)),
            Err(FieldBlendError::Epsilon(_))
        ));
    }
    for threshold in [f64::NAN, f64::NEG_INFINITY] {
        assert!(matches!(
            legal.with_blend(FieldBlend { threshold, ..REAL }),
            Err(FieldBlendError::Threshold(_))
        ));
    }
    let other = pair(&disc, &disc, 17, REAL);
    let mixed = FieldPair::new(legal.source.clone(), other.target.clone(), REAL);
    assert!(matches!(mixed, Err(FieldBlendError::Grids { .. })));
}

#[test]
fn a_blend_is_serialised_by_name_and_refuses_unknown_fields() {
    let written = serde_json::to_string(&REAL).expect("text");
    assert_eq!(written, r#"{"space":"real","epsilon":1.0,"threshold":0.0}"#);
    let read: FieldBlend = serde_json::from_str(r#"{"epsilon":0.5}"#).expect("a blend");
    assert_eq!(read, log(0.5));
    assert!(serde_json::from_str::<FieldBlend>(r#"{"eps":0.5}"#).is_err());
}
