//! Tests of the line warp: exact identities, comparison with the paper's formula, features that
//! meet, extreme coordinates and invalid input.

use super::line::LineEnds;
use super::*;
use proptest::prelude::*;
use std::f64::consts::PI;

type LinesTestResult<T = ()> = std::result::Result<T, Box<dyn std::error::Error>>;

const FRAME: Bounds = Bounds {
    min: DVec2::new(-3.0, -4.0),
    max: DVec2::new(3.0, 4.0),
};

const BOTH: [LineInterpolation; 2] = [LineInterpolation::Ends, LineInterpolation::MiddleAndAngle];

fn line([a, b, c, d]: [DVec2; 4]) -> LinePair {
    LinePair {
        source: [a, b],
        target: [c, d],
    }
}

fn pin(source: DVec2, target: DVec2) -> PointPair {
    PointPair { source, target }
}

fn swapped(lines: &[LinePair]) -> Vec<LinePair> {
    let swap = |l: &LinePair| LinePair {
        source: l.target,
        target: l.source,
    };
    lines.iter().map(swap).collect()
}

/// Returns a grid of points that covers the frame and its surroundings.
fn places() -> Vec<DVec2> {
    (0..15 * 15)
        .map(|i| DVec2::new(f64::from(i % 15), f64::from(i / 15)) - 7.0)
        .collect()
}

/// Returns the source and target points shown at `places`.
fn looked_up(lines: &LineWarp, t: f64, places: &[DVec2]) -> [Vec<DVec2>; 2] {
    let mut actual = [places.to_vec(), places.to_vec()];
    let [source, target] = &mut actual;
    lines.clone().look_up(t, places, source, target);
    actual
}

/// Mapping from the frame into one design, given line pairs `[in_frame, in_design]` and the
/// constant a in plane units.
struct OneWayMap(LinesAtTime);

impl OneWayMap {
    fn new(pairs: &[[LineEnds; 2]], a: f64, b: f64, p: f64) -> Self {
        let mut lines = LinesAtTime::new(BeierNeelyConstants { a, b, p });
        lines.fill(pairs.iter().map(|&[in_frame, in_design]| LineFeature {
            in_frame,
            in_designs: [in_design; 2],
            nominal: None,
        }));
        Self(lines)
    }

    fn map(&self, place: DVec2) -> DVec2 {
        self.map_all(&[place])[0]
    }

    fn map_all(&self, places: &[DVec2]) -> Vec<DVec2> {
        let [mut source, mut target] = [(); 2].map(|()| places.to_vec());
        self.0.map_into(places, [&mut source, &mut target]);
        assert!(
            source
                .iter()
                .zip(&target)
                .all(|(a, b)| a == b || a.is_nan())
        );
        source
    }
}

/// Evaluates the paper's formula literally.
fn reference_map(pairs: &[[LineEnds; 2]], a: f64, b: f64, p: f64, x: DVec2) -> DVec2 {
    let (mut sum, mut total) = (DVec2::ZERO, 0.0);
    for &[[start, end], [other_start, other_end]] in pairs {
        let (along, other) = (end - start, other_end - other_start);
        let u = (x - start).dot(along) / along.length_squared();
        let v = (x - start).dot(along.perp()) / along.length();
        let seen = other_start + u * other + v * other.perp() / other.length();
        let distance = if u < 0.0 {
            x.distance(start)
        } else if u > 1.0 {
            x.distance(end)
        } else {
            v.abs()
        };
        let weight = (along.length().powf(p) / (a + distance)).powf(b);
        sum += weight * (seen - x);
        total += weight;
    }
    x + sum / total
}

fn point() -> impl Strategy<Value = DVec2> {
    (-4.0..4.0, -4.0..4.0).prop_map(|(x, y): (f64, f64)| DVec2::new(x, y))
}

fn segment() -> impl Strategy<Value = LineEnds> {
    let long = |[a, b]: &LineEnds| a.distance(*b) > 0.1;
    [point(), point()].prop_filter("a line", long)
}

fn pairs() -> impl Strategy<Value = Vec<[LineEnds; 2]>> {
    prop::collection::vec([segment(), segment()], 1..20)
}

/// Generates points of a 3 × 3 grid, which often coincide or are collinear.
fn corner() -> impl Strategy<Value = DVec2> {
    (-1..2, -1..2).prop_map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)))
}

fn corners() -> impl Strategy<Value = (Vec<LinePair>, Vec<PointPair>)> {
    let corner_line = [corner(), corner(), corner(), corner()].prop_map(line);
    let corner_pin = (corner(), corner()).prop_map(|(a, b)| pin(a, b));
    (
        prop::collection::vec(corner_line, 0..6),
        prop::collection::vec(corner_pin, 0..4),
    )
}

fn options() -> impl Strategy<Value = LineOptions> {
    let b = prop_oneof![Just(1.0), Just(2.0), 0.1..8.0];
    (1e-4..0.3, b, 0.0..2.0, prop::sample::select(&BOTH)).prop_map(|(a, b, p, between)| {
        LineOptions {
            smoothness: a,
            falloff: b,
            length_exponent: p,
            between,
        }
    })
}

#[test]
fn without_features_nothing_moves() -> LinesTestResult {
    let lines = LineWarp::new(&FRAME, &[], &[], &LineOptions::default())?;
    assert_eq!(looked_up(&lines, 0.3, &places()), [places(), places()]);
    Ok(())
}

#[test]
fn a_pair_of_one_length_is_a_rigid_motion() {
    let turn = DVec2::from_angle(2.3);
    let rigid = |p: DVec2| turn.rotate(p) + DVec2::new(5.0, -3.0);
    let segment = [DVec2::new(1.0, 2.0), DVec2::new(-0.5, 2.25)];
    let map = OneWayMap::new(&[[segment, segment.map(rigid)]], 0.1, 2.0, 0.5);
    for p in places() {
        assert!(map.map(p).distance(rigid(p)) < 1e-14 * 10.0);
    }
}

#[test]
fn a_longer_counterpart_stretches_along_the_line_only() {
    let [from, to] = [[DVec2::ZERO, DVec2::X], [DVec2::ZERO, 3.0 * DVec2::X]];
    let map = OneWayMap::new(&[[from, to]], 0.1, 2.0, 0.5);
    for p in places() {
        assert!(map.map(p).distance(DVec2::new(3.0 * p.x, p.y)) < 1e-13);
    }
}

#[test]
fn a_single_pin_translates_the_plane() -> LinesTestResult {
    let pins = [pin(DVec2::ONE, DVec2::new(3.0, 2.0))];
    let lines = LineWarp::new(&FRAME, &[], &pins, &LineOptions::default())?;
    let [source, target] = looked_up(&lines, 0.25, &places());
    for (i, p) in places().into_iter().enumerate() {
        assert!(source[i].distance(p - 0.25 * DVec2::new(2.0, 1.0)) < 1e-14);
        assert!(target[i].distance(p + 0.75 * DVec2::new(2.0, 1.0)) < 1e-14);
    }
    Ok(())
}

#[test]
fn a_pin_weighs_as_much_as_a_line_of_a_tenth_of_the_diameter() -> LinesTestResult {
    // The line and the pin are both at distance 1 from the origin, and b p = 1, so their weights
    // are in the ratio of their lengths, 4 to 1.
    let far = DVec2::X;
    let standing = line([-far, DVec2::new(-5.0, 0.0), -far, DVec2::new(-5.0, 0.0)]);
    let options = LineOptions::default();
    let lines = LineWarp::new(&FRAME, &[standing], &[pin(far, far + DVec2::Y)], &options)?;
    let [_, target] = looked_up(&lines, 0.0, &[DVec2::ZERO]);
    let share = 1.0 / (1.0 + 4.0);
    assert!(target[0].distance(share * DVec2::Y) < 1e-15);
    Ok(())
}

#[test]
fn a_half_turn_has_a_fixed_direction_and_keeps_its_length() {
    for angle in [0.0, 0.5 * PI, 0.3, 2.9] {
        let half = DVec2::from_angle(angle);
        for noise in [0.0, 1e-13, -1e-13] {
            let back = DVec2::from_angle(noise).rotate(half);
            let forward = MovingLine::new([-half, half], [back, -back]);
            let backward = MovingLine::new([back, -back], [-half, half]);
            let [middle, reversed] =
                [&forward, &backward].map(|m| m.at(0.5, LineInterpolation::MiddleAndAngle));
            let [a, b] = middle;
            assert!((a.distance(b) - 2.0).abs() < 1e-12);
            assert!((b - a).dot(DVec2::new(0.123, 1.0)) > 0.0 || angle == 0.0 && b.y > a.y);
            assert!(a.distance(reversed[0]) < 1e-12 && b.distance(reversed[1]) < 1e-12);
        }
    }
}

#[test]
fn a_line_that_shrinks_to_a_point_causes_no_jump() -> LinesTestResult {
    // Halfway, the ends of the rotating line meet; two other lines still determine the mapping.
    let turning = line([-DVec2::X, DVec2::X, DVec2::X, -DVec2::X]);
    let other = |y: f64| {
        let [a, b] = [DVec2::new(-2.0, y), DVec2::new(2.0, y)];
        line([a, b, a + 0.3, b + 0.3])
    };
    let options = LineOptions {
        between: LineInterpolation::Ends,
        length_exponent: 0.0,
        ..LineOptions::default()
    };
    let lines = LineWarp::new(&FRAME, &[turning, other(2.0), other(-2.0)], &[], &options)?;
    let [before, after] = [-1e-9, 1e-9].map(|dt| looked_up(&lines, 0.5 + dt, &places()));
    for (before, after) in before.iter().flatten().zip(after.iter().flatten()) {
        assert!(before.distance(*after) < 1e-2, "{before} {after}");
    }
    Ok(())
}

#[test]
fn invalid_input_is_reported() {
    let frame = &FRAME;
    let good = line([DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE]);
    let mut bad = good;
    bad.target[1].y = f64::NAN;
    let usual = LineOptions::default();
    let error = |lines: &[LinePair], pins: &[PointPair], options: LineOptions| {
        LineWarp::new(frame, lines, pins, &options).err()
    };
    let actual = error(&[good, bad], &[], usual);
    assert_eq!(actual, Some(FeatureError::Line(2).into()));
    let actual = error(&[good], &[pin(DVec2::INFINITY, DVec2::X)], usual);
    assert_eq!(actual, Some(FeatureError::Point(1).into()));
    for smoothness in [0.0, -1.0, f64::INFINITY] {
        let options = LineOptions {
            smoothness,
            ..usual
        };
        let actual = error(&[], &[], options);
        assert_eq!(actual, Some(LinesError::Smoothness(smoothness)));
    }
    for falloff in [0.0, 8.5, f64::INFINITY] {
        let options = LineOptions { falloff, ..usual };
        assert_eq!(error(&[], &[], options), Some(LinesError::Falloff(falloff)));
    }
    let options = LineOptions {
        length_exponent: -0.5,
        ..usual
    };
    assert_eq!(
        error(&[], &[], options),
        Some(LinesError::LengthExponent(-0.5))
    );
}

#[test]
fn options_survive_a_round_trip_through_toml() -> LinesTestResult {
    let options = LineOptions {
        between: LineInterpolation::Ends,
        falloff: 1.25,
        ..LineOptions::default()
    };
    let text = toml::to_string(&options)?;
    assert!(text.contains("length-exponent = 0.5") && text.contains("\"ends\""));
    assert_eq!(toml::from_str::<LineOptions>(&text)?, options);
    assert_eq!(toml::from_str::<LineOptions>("")?, LineOptions::default());
    assert!(toml::from_str::<LineOptions>("strength = 1.0").is_err());
    Ok(())
}

#[test]
fn the_map_is_independent_of_the_coordinates_scale() {
    let pairs = [
        [[DVec2::ZERO, DVec2::X], [DVec2::Y, DVec2::ONE * 1.25]],
        [[DVec2::Y, DVec2::NEG_X], [DVec2::Y, DVec2::NEG_ONE]],
    ];
    let usual = OneWayMap::new(&pairs, 0.125, 2.0, 0.5);
    for exponent in [-1000, -333, -40, 40, 333, 1000] {
        let scale = 2.0_f64.powi(exponent);
        let scaled = pairs.map(|pair| pair.map(|segment| segment.map(|p| p * scale)));
        let map = OneWayMap::new(&scaled, 0.125 * scale, 2.0, 0.5);
        for p in places() {
            let (actual, expected) = (map.map(p * scale) / scale, usual.map(p));
            assert!(actual.distance(expected) < 1e-13, "{exponent}");
        }
    }
}

#[test]
fn extreme_coordinates_neither_panic_nor_overflow() -> LinesTestResult {
    let numbers = [0.0, 1.0, 1e-300, 1e-100, 1e100, -1e100, 1e300, -f64::MAX];
    let points: Vec<_> = (0..64)
        .map(|i| DVec2::new(numbers[i % 8], numbers[i / 8]))
        .collect();
    for at in 0..64 {
        let four = [0, 9, 22, 35].map(|k| points[(at + k) % 64]);
        let pins = [pin(points[(at + 7) % 64], points[(at + 40) % 64])];
        for between in BOTH {
            let options = LineOptions {
                between,
                ..LineOptions::default()
            };
            let lines = LineWarp::new(&FRAME, &[line(four)], &pins, &options)?;
            for t in [0.0, 0.3, 1.0, 1e9] {
                looked_up(&lines, t, &points);
            }
        }
        // Features with ordinary coordinates, evaluated at extreme frame points.
        let lines = LineWarp::new(
            &FRAME,
            &[],
            &[pin(DVec2::ZERO, DVec2::X)],
            &LineOptions::default(),
        )?;
        let moderate: Vec<_> = points
            .iter()
            .map(|p| p.clamp(-DVec2::splat(1e300), DVec2::splat(1e300)))
            .collect();
        let actual = looked_up(&lines, 0.5, &moderate);
        assert!(actual.iter().flatten().all(|p| p.is_finite()));
    }
    Ok(())
}

#[test]
fn a_nan_point_does_not_affect_its_neighbours() {
    let map = OneWayMap::new(
        &[[[DVec2::ZERO, DVec2::X], [DVec2::Y, DVec2::ONE]]],
        1.0,
        2.0,
        0.5,
    );
    let mut places = places();
    let expected: Vec<_> = places.iter().map(|&p| map.map(p)).collect();
    places[8] = DVec2::NAN;
    let actual = map.map_all(&places);
    for (i, (actual, expected)) in actual.iter().zip(&expected).enumerate() {
        assert!(i == 8 || actual == expected);
    }
}

#[test]
fn blocks_of_every_length_give_the_same_results_as_single_points() {
    let map = OneWayMap::new(
        &[[[DVec2::ZERO, DVec2::X], [DVec2::Y, DVec2::ONE]]],
        1.0,
        1.5,
        0.5,
    );
    let places: Vec<_> = places().into_iter().cycle().take(300).collect();
    for count in [0, 1, 7, 127, 128, 129, 256, 300] {
        for (actual, &place) in map.map_all(&places[..count]).iter().zip(&places) {
            assert_eq!(*actual, map.map(place));
        }
    }
}

#[test]
fn slices_of_different_lengths_are_filled_up_to_the_shortest() {
    let map = OneWayMap::new(&[[[DVec2::ZERO; 2], [DVec2::ONE; 2]]], 1.0, 2.0, 0.5);
    let [mut source, mut target] = [[DVec2::ZERO; 3]; 2];
    map.0.map_into(&[DVec2::X], [&mut source, &mut target]);
    assert_eq!(source, [DVec2::X + DVec2::ONE, DVec2::ZERO, DVec2::ZERO]);
    map.0
        .map_into(&[DVec2::X; 5], [&mut source[..2], &mut target]);
    assert_eq!(source[1..], [DVec2::X + DVec2::ONE, DVec2::ZERO]);
    assert_eq!(target, [DVec2::X + DVec2::ONE; 3]);
}

proptest! {
    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn the_map_equals_the_papers_formula(
        pairs in pairs(), a in 1e-3..1.0, b in prop_oneof![Just(1.0), Just(2.0), 0.5..3.0],
        p in 0.0..1.0,
    ) {
        let mut map = OneWayMap::new(&pairs, a, b, p);
        for arch in [map.0.arch, Arch::Scalar] {
            map.0.arch = arch;
            for (actual, place) in map.map_all(&places()).into_iter().zip(places()) {
                let expected = reference_map(&pairs, a, b, p, place);
                // The tolerance allows for short lines that stretch a hundredfold.
                prop_assert!(actual.distance(expected) < 1e-10, "{place}: {actual} {expected}");
                prop_assert!(map.map(place).distance(actual) < 1e-12);
            }
        }
    }

    #[test]
    fn designs_are_unchanged_at_their_own_ends((lines, pins) in corners(), options in options()) {
        let lines = LineWarp::new(&FRAME, &lines, &pins, &options)?;
        prop_assert_eq!(&looked_up(&lines, 0.0, &places())[0], &places());
        prop_assert_eq!(&looked_up(&lines, 1.0, &places())[1], &places());
    }

    #[test]
    fn exchanged_designs_reverse_the_motion(
        pairs in pairs(), pins in prop::collection::vec((point(), point()), 0..4),
        options in options(), t in -0.2..1.2,
    ) {
        let lines: Vec<_> = pairs.iter().map(|&[source, target]| LinePair { source, target }).collect();
        let forward_pins: Vec<_> = pins.iter().map(|&(a, b)| pin(a, b)).collect();
        let backward_pins: Vec<_> = pins.iter().map(|&(a, b)| pin(b, a)).collect();
        let forward = LineWarp::new(&FRAME, &lines, &forward_pins, &options)?;
        let backward = LineWarp::new(&FRAME, &swapped(&lines), &backward_pins, &options)?;
        let [source, target] = looked_up(&forward, t, &places());
        let [other_source, other_target] = looked_up(&backward, 1.0 - t, &places());
        for (a, b) in source.iter().zip(&other_target).chain(target.iter().zip(&other_source)) {
            // Lines that nearly vanish in between lose digits.
            prop_assert!(a.distance(*b) < 1e-7 * (1.0 + a.length()), "{a} {b}");
        }
    }

    #[test]
    fn features_that_meet_give_finite_points(
        (lines, pins) in corners(), options in options(), t in -2.0..3.0,
    ) {
        let lines = LineWarp::new(&FRAME, &lines, &pins, &options)?;
        for t in [t, 0.0, 0.25, 0.5, 1.0, 2.0] {
            for place in looked_up(&lines, t, &places()).iter().flatten() {
                prop_assert!(place.is_finite());
            }
        }
    }
}
