//! Tests of boundary matching: exact identities, pins, symmetric, featureless and degenerate
//! curves, invalid input, and polygons with shared vertices.

use super::*;
use crate::geometry::{DVec2, Ring, Similarity};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Spacing of the samples with default options, as a fraction of the curve's length.
const SAMPLE: f64 = 1.0 / 160.0;

fn ring(points: Vec<DVec2>) -> Ring {
    Ring::new(points).expect("a ring")
}

fn matched(source: &Ring, target: &Ring) -> BoundaryMatch {
    match_rings(source, target, &[], &MatchOptions::default()).expect("a match")
}

fn match_rings(
    source: &Ring,
    target: &Ring,
    pins: &[Pin],
    options: &MatchOptions,
) -> Result<BoundaryMatch, MatchError> {
    let [source, target] = [
        BoundaryCurve::closed(source)?,
        BoundaryCurve::closed(target)?,
    ];
    match_curves(&source, &target, pins, options)
}

/// Returns the target place that the match assigns to the source's `place`.
fn across(found: &BoundaryMatch, place: f64) -> f64 {
    let knots = found.knots();
    let n = knots.len();
    // The last knot at or before the place, cyclically.
    let k = (knots.partition_point(|knot| knot[0] <= place) + n - 1) % n;
    let (from, to) = (knots[k], knots[(k + 1) % n]);
    // If there is only one knot, the gap is a whole round.
    let gap = |side: usize| match (to[side] - from[side]).rem_euclid(1.0) {
        0.0 => 1.0,
        gap => gap,
    };
    let along = (place - from[0]).rem_euclid(1.0) / gap(0);
    (from[1] + along * gap(1)).rem_euclid(1.0)
}

/// Returns the outline of a shoe, which has corners and bends but no symmetry.
fn shoe() -> Ring {
    let points = [
        (0.0, 0.0),
        (6.0, 0.0),
        (8.0, 0.4),
        (9.0, 1.2),
        (8.8, 2.2),
        (7.5, 2.8),
        (5.0, 3.4),
        (4.0, 4.4),
        (3.8, 8.0),
        (0.4, 8.4),
        (0.7, 4.0),
    ];
    ring(points.map(DVec2::from).to_vec())
}

/// Returns a smooth closed curve without symmetry.
fn blob(count: u32, phase: f64) -> Ring {
    let point = |k: u32| {
        let a = TAU * (f64::from(k) + phase) / f64::from(count);
        let radius = 3.0 + (a + 0.3).cos() + 0.6 * (2.0 * a).sin() + 0.4 * (5.0 * a - 1.0).cos();
        radius * DVec2::from_angle(a)
    };
    ring((0..count).map(point).collect())
}

/// Returns a star, whose radii alternate between 1 and `inner`.
fn star(tips: u32, inner: f64) -> Ring {
    let point = |k: u32| {
        let radius = if k.is_multiple_of(2) { 1.0 } else { inner };
        radius * DVec2::from_angle(PI * f64::from(k) / f64::from(tips))
    };
    ring((0..2 * tips).map(point).collect())
}

/// Returns a gear, whose radii alternate in pairs between 1 and 0.8.
fn gear(teeth: u32) -> Ring {
    let point = |k: u32| {
        let radius = if k % 4 < 2 { 1.0 } else { 0.8 };
        radius * DVec2::from_angle(TAU * f64::from(k) / f64::from(4 * teeth))
    };
    ring((0..4 * teeth).map(point).collect())
}

/// Returns a band of constant width, wound up by a number of turns.
fn spiral(turns: f64, count: u32) -> Ring {
    let along = |k: u32, width: f64| {
        let a = TAU * turns * f64::from(k) / f64::from(count);
        (1.0 + a / TAU + width) * DVec2::from_angle(a)
    };
    let outwards = (0..=count).map(|k| along(k, 0.4));
    ring(
        outwards
            .chain((0..=count).rev().map(|k| along(k, 0.0)))
            .collect(),
    )
}

fn turned(ring: &Ring, similarity: &Similarity) -> Ring {
    self::ring(ring.points().iter().map(|&p| similarity.apply(p)).collect())
}

fn started_at(ring: &Ring, first: usize) -> Ring {
    let mut points = ring.points().to_vec();
    points.rotate_left(first);
    self::ring(points)
}

fn resampled(ring: &Ring, count: u32) -> Ring {
    let curve = BoundaryCurve::closed(ring).expect("a size");
    let place = |k: u32| curve.point_at((f64::from(k) + 0.37) / f64::from(count));
    self::ring((0..count).map(place).collect())
}

/// Returns the largest distance between the target point matched with a source point and the point
/// to which `expected` maps that source point, as a fraction of the target's perimeter.
fn error(source: &Ring, target: &Ring, expected: impl Fn(DVec2) -> DVec2) -> f64 {
    let found = matched(source, target);
    let (a, b) = (
        BoundaryCurve::closed(source).expect("a size"),
        BoundaryCurve::closed(target).expect("a size"),
    );
    let at = |k: u32| {
        let place = f64::from(k) / 500.0;
        b.point_at(across(&found, place))
            .distance(expected(a.point_at(place)))
    };
    (0..500).map(at).fold(0.0, f64::max) / target.perimeter()
}

/// Asserts that a match is strictly monotone in both directions and goes around once.
fn assert_sound(found: &BoundaryMatch) {
    let knots = found.knots();
    assert!(knots.windows(2).all(|w| w[0][0] < w[1][0]));
    let falls = (0..knots.len()).filter(|&k| knots[(k + 1) % knots.len()][1] <= knots[k][1]);
    assert_eq!(falls.count(), 1, "once around: {knots:?}");
    assert!(
        knots
            .iter()
            .flatten()
            .all(|place| (0.0..1.0).contains(place))
    );
}

#[test]
fn a_shape_matches_itself_under_any_similarity() {
    for shape in [shoe(), blob(140, 0.0), star(5, 0.4), spiral(2.0, 60)] {
        for (rotation, scale, mirror) in [
            (0.0, 1.0, false),
            (1.0, 7.0, false),
            (PI, 0.1, true),
            (-2.4, 3.0, true),
        ] {
            let by = Similarity {
                offset: DVec2::new(5.0, -80.0),
                scale,
                rotation,
                mirror,
            };
            // Mirror both shapes, so that their orientations agree. The target is also rotated,
            // scaled and moved.
            let flip = Similarity {
                mirror,
                ..Similarity::IDENTITY
            };
            let source = turned(&shape, &flip);
            let target = turned(&shape, &by);
            let expected = |p: DVec2| by.apply(flip.apply(p));
            if shape.points().len() == 10 {
                continue; // the symmetric star is tested separately
            }
            assert!(
                error(&source, &target, expected) < 1e-6,
                "turned by {rotation}"
            );
        }
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn other_starting_points_and_resampling_match_within_a_sample() {
    for shape in [shoe(), blob(140, 0.0), spiral(1.5, 60)] {
        let n = shape.points().len();
        for first in [1, n / 3, n - 1] {
            assert!(error(&shape, &started_at(&shape, first), |p| p) < 1e-6);
        }
        for count in [101, 188, 1200] {
            let other = resampled(&shape, count);
            assert!(error(&shape, &other, |p| p) < SAMPLE, "{count} points");
            assert!(error(&other, &shape, |p| p) < SAMPLE, "{count} points");
        }
    }
    assert!(error(&blob(140, 0.0), &blob(311, 0.5), |p| p) < SAMPLE);
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn resampled_drawings_match_within_a_sample() {
    const DRAWINGS: [&str; 6] = [
        "gecko-resting",
        "gecko-running",
        "jug",
        "teapot",
        "letter-s",
        "moustache",
    ];
    for name in DRAWINGS {
        let file = format!("{}/assets/gallery/{name}.svg", env!("CARGO_MANIFEST_DIR"));
        let options = crate::design::ImportOptions::default();
        let drawing = crate::design::import_file(file.as_ref(), &options).expect("a drawing");
        let outline = drawing.outline(0.0).expect("an outline");
        let shape = &outline.iter().next().expect("a part").outer;
        for count in [97, 150, 240] {
            let by = Similarity {
                rotation: 0.01 * f64::from(count),
                scale: 0.3,
                ..Similarity::IDENTITY
            };
            let other = turned(&resampled(shape, count), &by);
            let off = error(shape, &other, |p| by.apply(p))
                .max(error(&other, shape, |p| by.inverse().apply(p)));
            assert!(
                off < SAMPLE,
                "{name}, {count} points: {:.2} samples",
                off / SAMPLE
            );
        }
    }
}

#[test]
fn pins_are_satisfied_on_nearly_congruent_shapes() {
    let shape = blob(140, 0.0);
    let other = resampled(&shape, 97);
    let pin = Pin {
        source: 0.25,
        target: BoundaryCurve::closed(&other).expect("a size").nearest(
            BoundaryCurve::closed(&shape)
                .expect("a size")
                .point_at(0.26),
        ),
    };
    let found = match_rings(&shape, &other, &[pin], &MatchOptions::default()).expect("a match");
    assert!(found.knots().contains(&pin.to_array()));
    assert_sound(&found);
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn symmetric_shapes_rotate_as_little_as_possible() {
    for (shape, period) in [
        (gear(12), TAU / 12.0),
        (star(5, 0.4), TAU / 5.0),
        (gear(4), TAU / 4.0),
    ] {
        for part in [0.0, 0.3, 0.45, -0.4, 1.2, 3.0] {
            let by = Similarity {
                rotation: part * period,
                ..Similarity::IDENTITY
            };
            let target = started_at(&turned(&shape, &by), 5);
            let least = (part - part.round()) * period;
            let found = matched(&shape, &target);
            assert!(
                (found.rotation() - least).abs() < 1e-6,
                "{} for {least}",
                found.rotation()
            );
            let turn = DVec2::from_angle(least);
            assert!(error(&shape, &target, |p| turn.rotate(p)) < 1e-6);
        }
    }
}

#[test]
fn keep_up_prevents_rotation() {
    let up = MatchOptions {
        keep_up: true,
        ..MatchOptions::default()
    };
    let bar = |w: f64, h: f64| {
        ring(
            [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)]
                .map(DVec2::from)
                .to_vec(),
        )
    };
    let (lying, standing) = (bar(3.0, 1.0), bar(1.0, 3.0));
    assert!(matched(&lying, &standing).rotation().abs() > 1.5);
    let upright = match_rings(&lying, &standing, &[], &up).expect("a match");
    assert!(upright.rotation().abs() < 0.1, "{}", upright.rotation());
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn the_reverse_match_is_the_bitwise_inverse() {
    let shapes = [
        shoe(),
        blob(140, 0.0),
        star(7, 0.5),
        gear(12),
        spiral(2.0, 40),
        star(2, 1.0),
    ];
    for a in &shapes {
        for b in &shapes {
            let forward = matched(a, b);
            assert_sound(&forward);
            let backward = matched(b, a);
            assert_eq!(backward, forward.inverse());
            assert_eq!(forward, backward.inverse());
            for k in 0..50 {
                let place = f64::from(k) / 50.0;
                let round = across(&backward, across(&forward, place));
                let gap = (round - place).rem_euclid(1.0);
                assert!(gap.min(1.0 - gap) < 1e-9);
            }
        }
    }
}

#[test]
fn pins_are_satisfied_exactly() {
    let pins = [(0.1, 0.5), (0.13, 0.9), (0.7, 0.2)].map(|(source, target)| Pin { source, target });
    let (a, b) = (shoe(), blob(140, 0.0));
    let options = MatchOptions::default();
    let found = match_rings(&a, &b, &pins, &options).expect("a match");
    assert_sound(&found);
    for pin in pins {
        assert!(found.knots().contains(&[pin.source, pin.target]));
    }
    assert_eq!(found.pins, pins.map(Pin::to_array));
    let inverse = match_rings(&b, &a, &pins.map(Pin::swapped), &options);
    assert_eq!(inverse, Ok(found.inverse()));
    let (a, b) = (
        BoundaryCurve::closed(&a).expect("a size"),
        BoundaryCurve::closed(&b).expect("a size"),
    );
    let shared = found.polygons(&a, &b, f64::INFINITY);
    assert!(
        pins.iter()
            .all(|pin| shared.places.contains(&[pin.source, pin.target]))
    );
}

#[test]
fn contradictory_pins_are_named() {
    let pin = |(source, target)| Pin { source, target };
    let error = |pins: &[(f64, f64)]| {
        let pins: Vec<_> = pins.iter().copied().map(pin).collect();
        match_rings(&shoe(), &blob(99, 0.0), &pins, &MatchOptions::default())
    };
    let crossing = error(&[(0.1, 0.1), (0.3, 0.3), (0.5, 0.8), (0.7, 0.6), (0.9, 0.9)]);
    assert_eq!(crossing, Err(MatchError::Pins(PinError::Crossing(2, 3))));
    let shared = error(&[(0.5, 0.2), (0.1, 0.1), (0.5, 0.3)]);
    assert_eq!(shared, Err(MatchError::Pins(PinError::SamePoint(0, 2))));
    let not_finite = error(&[(0.5, 0.2), (f64::NAN, 0.1)]);
    assert_eq!(not_finite, Err(MatchError::Pins(PinError::NotFinite(1))));
    assert!(error(&[(0.1, 0.9), (0.4, 0.2), (0.6, 0.5), (0.6, 0.5)]).is_ok());
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn shapes_without_features_match_too() {
    let circle = |n: u32| {
        ring(
            (0..n)
                .map(|k| DVec2::from_angle(TAU * f64::from(k) / f64::from(n)))
                .collect(),
        )
    };
    let sliver = ring(vec![DVec2::ZERO, DVec2::X, DVec2::new(0.5, 1e-13)]);
    let flat = ring(vec![DVec2::ZERO, DVec2::X, DVec2::new(0.5, 0.0)]);
    let huge = turned(
        &shoe(),
        &Similarity {
            scale: 1e150,
            ..Similarity::IDENTITY
        },
    );
    let tiny = turned(
        &shoe(),
        &Similarity {
            scale: 1e-150,
            ..Similarity::IDENTITY
        },
    );
    let shapes = [
        circle(3),
        circle(7),
        circle(500),
        sliver,
        flat,
        huge,
        tiny,
        spiral(4.0, 300),
        star(1000, 0.7),
        star(1000, 0.999),
    ];
    for a in &shapes {
        for b in &shapes {
            let found = matched(a, b);
            assert_sound(&found);
            assert!(found.cost().is_finite() && found.rotation().is_finite());
        }
    }
    assert!(matched(&circle(300), &circle(300)).rotation().abs() < 1e-9);
}

#[test]
fn unmatchable_curves_and_invalid_options_are_errors() {
    let options = MatchOptions::default();
    let reversed = shoe().reversed();
    assert_eq!(
        match_rings(&shoe(), &reversed, &[], &options),
        Err(MatchError::Orientation)
    );
    let too_few = MatchOptions {
        samples: 3,
        ..options.clone()
    };
    assert_eq!(
        match_rings(&shoe(), &shoe(), &[], &too_few),
        Err(MatchError::Samples(3))
    );
    let not_a_number = MatchOptions {
        stretch: f64::NAN,
        ..options.clone()
    };
    assert!(matches!(
        match_rings(&shoe(), &shoe(), &[], &not_a_number),
        Err(MatchError::Stretch(_))
    ));
    let huge = ring(
        [(-1e308, 0.0), (1e308, 0.0), (0.0, 1e308)]
            .map(DVec2::from)
            .to_vec(),
    );
    assert_eq!(
        match_rings(&huge, &huge, &[], &options),
        Err(MatchError::Curve(CurveLengthError))
    );
}

/// Matches two rings and asserts that their shared polygons contain all vertices and stay on the
/// curves.
fn assert_shared(a: &Ring, b: &Ring, spacing: f64) -> SharedPolygons {
    let curves = [a, b].map(|r| BoundaryCurve::closed(r).expect("a size"));
    let shared = matched(a, b).polygons(&curves[0], &curves[1], spacing);
    for (own, polygon) in [(a, &shared.source), (b, &shared.target)] {
        assert_eq!(polygon.len(), shared.places.len());
        let n = polygon.len();
        assert!((0..n).all(|k| polygon[k] != polygon[(k + 1) % n]));
        let kept = own.points().iter().filter(|p| polygon.contains(p)).count();
        assert_eq!(kept, own.points().len());
        let drift = ring(polygon.clone()).perimeter() / own.perimeter() - 1.0;
        assert!(drift.abs() < 1e-9, "the polygon leaves its curve: {drift}");
    }
    shared
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn shared_polygons_contain_all_vertices_of_both() {
    let shapes = [
        shoe(),
        blob(140, 0.0),
        star(5, 0.4),
        gear(12),
        spiral(2.0, 40),
    ];
    for a in &shapes {
        for b in &shapes {
            let shared = assert_shared(a, b, f64::INFINITY);
            assert!(shared.places.len() <= a.points().len() + b.points().len());
        }
        let same = assert_shared(a, a, f64::INFINITY);
        assert_eq!(same.source.len(), a.points().len());
        assert_eq!(same.source, same.target);
    }
}

#[test]
fn spacing_limits_the_gaps() {
    let shared = assert_shared(&shoe(), &star(5, 0.4), 0.01);
    let n = shared.places.len();
    for k in 0..n {
        let gap = |s: usize| (shared.places[(k + 1) % n][s] - shared.places[k][s]).rem_euclid(1.0);
        assert!(0.5 * (gap(0) + gap(1)) < 0.0101);
    }
}

/// Generates star-shaped, jagged polygons: random radii at even angles.
fn jagged() -> impl Strategy<Value = Ring> {
    prop::collection::vec(0.05f64..1.0, 3..40).prop_map(|radii| {
        let n = radii.len() as f64;
        let point = |(k, r): (usize, &f64)| *r * DVec2::from_angle(TAU * k as f64 / n);
        ring(radii.iter().enumerate().map(point).collect())
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn any_two_shapes_match_and_share_vertices(a in jagged(), b in jagged()) {
        let forward = matched(&a, &b);
        assert_sound(&forward);
        prop_assert_eq!(matched(&b, &a), forward.inverse());
        assert_shared(&a, &b, f64::INFINITY);
    }

    #[test]
    fn any_pins_in_order_are_satisfied(
        a in jagged(), b in jagged(), shift in 0.0f64..1.0,
        gaps in prop::collection::vec((1e-6f64..1.0, 1e-6f64..1.0), 1..9),
    ) {
        let sums = gaps.iter().fold((0.0, 0.0), |s, g| (s.0 + g.0, s.1 + g.1));
        let mut at = (0.0, 0.0);
        let mut pins = Vec::new();
        for gap in &gaps {
            at = (at.0 + gap.0 / sums.0, at.1 + gap.1 / sums.1);
            pins.push(Pin { source: 0.99 * at.0, target: (0.99 * at.1 + shift) % 1.0 });
        }
        let found = match_rings(&a, &b, &pins, &MatchOptions::default()).expect("a match");
        assert_sound(&found);
        for pin in &pins {
            prop_assert!(found.knots().contains(&[pin.source, pin.target]));
        }
    }
}
