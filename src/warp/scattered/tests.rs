//! Tests of the scattered-point warp against SciPy, exact identities and degenerate features.

use super::*;
use crate::warp::{FeatureError, MAX_FEATURES};
use proptest::prelude::*;

type ScatteredTestResult = Result<(), Box<dyn std::error::Error>>;

const BASES: [RadialBasis; 3] = [
    RadialBasis::ThinPlate,
    RadialBasis::Gaussian,
    RadialBasis::Multiquadric,
];

const FRAME: Bounds = Bounds {
    min: DVec2::new(-1.0, 2.0),
    max: DVec2::new(3.0, 5.0),
};

/// Returns well-spread points of the unit square (additive recurrence of the plastic number).
fn spread(count: usize, shift: f64) -> Vec<DVec2> {
    let step = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2);
    let point = |k| ((k as f64 + shift) * step).fract();
    (1..=count).map(point).collect()
}

/// Returns the values that `benches/scattered_scipy.py` assigns to the points.
fn values(points: &[DVec2]) -> Vec<DVec2> {
    let value = |p: &DVec2| DVec2::new((3.0 * p.x).sin() + p.y * p.y, p.x * (2.0 * p.y).cos());
    points.iter().map(value).collect()
}

fn with(basis: RadialBasis) -> ScatteredOptions {
    ScatteredOptions {
        basis,
        ..ScatteredOptions::default()
    }
}

fn pair(source: impl Into<DVec2>, target: impl Into<DVec2>) -> PointPair {
    PointPair {
        source: source.into(),
        target: target.into(),
    }
}

/// Returns the source and target points shown at `places` at t.
fn lookups(warp: &ScatteredWarp, t: f64, places: &[DVec2]) -> [Vec<DVec2>; 2] {
    let [mut source, mut target] = [(); 2].map(|()| vec![DVec2::NAN; places.len()]);
    warp.clone().look_up(t, places, &mut source, &mut target);
    [source, target]
}

/// Evaluates at `places` the mapping that takes `centres` to `values`, with a frame diameter of
/// `unit`.
///
/// This is the mapping from the frame to the target at t = 0.
fn mapped(
    centres: &[DVec2],
    values: &[DVec2],
    options: ScatteredOptions,
    unit: f64,
    places: &[DVec2],
) -> Result<Vec<DVec2>, ScatteredError> {
    let frame = Bounds {
        min: DVec2::ZERO,
        max: unit * DVec2::new(0.6, 0.8),
    };
    let ends = centres.iter().zip(values);
    let pairs: Vec<_> = ends.map(|(&c, &v)| pair(c, v)).collect();
    let [_, target] = lookups(
        &ScatteredWarp::new(&frame, &pairs, &[], options)?,
        0.0,
        places,
    );
    Ok(target)
}

#[test]
fn values_equal_those_of_scipy() -> ScatteredTestResult {
    // The table was written by `python3 benches/scattered_scipy.py table` with SciPy 1.17.1.
    let table = include_str!("scipy.csv");
    let kinds = [
        (RadialBasis::ThinPlate, 0.0),
        (RadialBasis::ThinPlate, 0.01),
        (RadialBasis::Gaussian, 0.0),
        (RadialBasis::Gaussian, 0.1),
    ];
    // The frame's diameter, `unit`, has no effect if the options relative to it are rescaled.
    for unit in [1.0, 2.5] {
        for (column, (basis, smoothing)) in kinds.into_iter().enumerate() {
            let is_plate = basis == RadialBasis::ThinPlate;
            let options = ScatteredOptions {
                width: 0.25 / unit,
                smoothing: if is_plate {
                    smoothing / (unit * unit)
                } else {
                    smoothing
                },
                ..with(basis)
            };
            let centres = spread(12, 0.0);
            let values = values(&centres);
            for line in table.lines().skip(1) {
                let row: Vec<f64> = line.split(',').map(str::parse).collect::<Result<_, _>>()?;
                let place = DVec2::new(row[0], row[1]);
                let actual = mapped(&centres, &values, options, unit, &[place])?[0];
                let expected = DVec2::new(row[2 + 2 * column], row[3 + 2 * column]);
                let error = actual.distance(expected);
                assert!(error < 1e-9, "{basis:?} {smoothing} {unit}: {error:e}");
            }
        }
    }
    Ok(())
}

#[test]
fn values_are_interpolated_at_their_centres() -> ScatteredTestResult {
    for basis in BASES {
        for exponent in [0.5, 0.3, -0.5] {
            let options = ScatteredOptions {
                exponent,
                ..with(basis)
            };
            for count in [1, 2, 3, 4, 40, 300] {
                let centres = spread(count, 0.0);
                let values = values(&centres);
                let actual = mapped(&centres, &values, options, 1.0, &centres)?;
                for (actual, expected) in actual.iter().zip(&values) {
                    let error = actual.distance(*expected);
                    assert!(error < 1e-9, "{basis:?} {exponent} {count}: {error:e}");
                }
            }
        }
    }
    Ok(())
}

#[test]
fn affine_maps_are_reproduced() -> ScatteredTestResult {
    let affine = |p: DVec2| DVec2::new(3.0 * p.x - p.y + 7.0, 0.2 * p.x + 1.5 * p.y - 2.0);
    for basis in BASES {
        for smoothing in [0.0, 0.1] {
            for count in [3, 5, 60] {
                let centres = spread(count, 0.0);
                let values: Vec<DVec2> = centres.iter().copied().map(affine).collect();
                let options = ScatteredOptions {
                    smoothing,
                    ..with(basis)
                };
                let places: Vec<DVec2> = spread(50, 0.5).iter().map(|&p| 3.0 * p - 1.0).collect();
                let actual = mapped(&centres, &values, options, 1.0, &places)?;
                for (actual, &place) in actual.iter().zip(&places) {
                    let error = actual.distance(affine(place));
                    assert!(error < 1e-9, "{basis:?} {smoothing} {count}: {error:e}");
                }
            }
        }
    }
    Ok(())
}

#[test]
fn few_features_give_identity_translation_and_similarity() -> ScatteredTestResult {
    let places = spread(30, 0.0);
    for basis in BASES {
        let none = ScatteredWarp::new(&FRAME, &[], &[], with(basis))?;
        assert_eq!(
            lookups(&none, 0.3, &places),
            [places.clone(), places.clone()]
        );

        let one = [pair((0.0, 3.0), (2.0, 3.5))];
        let one = ScatteredWarp::new(&FRAME, &one, &[], with(basis))?;
        let [source, _] = lookups(&one, 0.3, &places);
        for (actual, &place) in source.iter().zip(&places) {
            assert!(actual.distance(place - 0.3 * DVec2::new(2.0, 0.5)) < 1e-12);
        }

        // A quarter turn about the first point with a scale of 2; three collinear points
        // determine the same similarity as two.
        let turned = |p: DVec2| DVec2::new(0.0, 3.0) + 2.0 * (p - DVec2::new(0.0, 3.0)).perp();
        let on_line = [0.0, 1.0, 2.5].map(|x| DVec2::new(x, 3.0 + x));
        for points in [&on_line[..2], &on_line] {
            let pairs: Vec<_> = points.iter().map(|&p| pair(p, turned(p))).collect();
            let warp = ScatteredWarp::new(&FRAME, &pairs, &[], with(basis))?;
            let [_, target] = lookups(&warp, 0.0, &places);
            for (actual, &place) in target.iter().zip(&places) {
                assert!(actual.distance(turned(place)) < 1e-9, "{basis:?}");
            }
        }
    }
    Ok(())
}

#[test]
fn both_ends_are_exact_bit_for_bit() -> ScatteredTestResult {
    let places = spread(100, 0.0);
    let ends = spread(20, 7.0).into_iter().zip(spread(20, 1.5));
    let pairs: Vec<_> = ends.map(|(p, q)| pair(4.0 * p, 3.0 * q)).collect();
    for basis in BASES {
        let warp = ScatteredWarp::new(&FRAME, &pairs, &[], with(basis))?;
        assert_eq!(lookups(&warp, 0.0, &places)[0], places);
        assert_eq!(lookups(&warp, 1.0, &places)[1], places);
    }
    Ok(())
}

#[test]
fn points_and_line_samples_are_interpolated() -> ScatteredTestResult {
    let line = LinePair {
        source: [DVec2::new(-0.5, 2.5), DVec2::new(1.0, 2.5)],
        target: [DVec2::new(0.0, 4.5), DVec2::new(1.0, 4.0)],
    };
    let point = pair((2.0, 4.0), (2.5, 3.0));
    for basis in BASES {
        let warp = ScatteredWarp::new(&FRAME, &[point], &[line], with(basis))?;
        let on = |[a, b]: [DVec2; 2]| a.lerp(b, 0.75);
        let features = [point, pair(on(line.source), on(line.target))];
        for t in [0.0, 0.4, 1.0, 1.3] {
            let at = features.map(|f| f.source * (1.0 - t) + f.target * t);
            let [source, target] = lookups(&warp, t, &at);
            for (k, feature) in features.iter().enumerate() {
                assert!(source[k].distance(feature.source) < 1e-9);
                assert!(target[k].distance(feature.target) < 1e-9);
            }
        }
    }
    Ok(())
}

#[test]
fn more_smoothing_misses_features_by_more() -> ScatteredTestResult {
    let centres = spread(40, 0.0);
    for basis in BASES {
        let mut last_error = 0.0;
        for smoothing in [0.0, 1e-3, 1e-1, 1e1] {
            let options = ScatteredOptions {
                smoothing,
                ..with(basis)
            };
            let expected = values(&centres);
            let actual = mapped(&centres, &expected, options, 1.0, &centres)?;
            let pairs = actual.iter().zip(&expected);
            let error: f64 = pairs.map(|(v, w)| v.distance_squared(*w)).sum();
            assert!(smoothing == 0.0 || error > last_error, "{basis:?}");
            last_error = error;
        }
    }
    Ok(())
}

#[test]
fn coincident_centres_take_the_mean_value() -> ScatteredTestResult {
    let mut centres = spread(6, 0.0);
    let mut values = values(&centres);
    centres.extend([centres[2], centres[2]]);
    values.extend([values[2] + 3.0, values[2]]);
    for basis in BASES {
        let actual = mapped(&centres, &values, with(basis), 1.0, &centres)?;
        assert!(actual[2].distance(values[2] + 1.0) < 1e-9);
        assert!(actual[4].distance(values[4]) < 1e-9);
    }
    Ok(())
}

#[test]
fn numerically_singular_gaussians_are_solved_with_a_ridge() -> ScatteredTestResult {
    let centres = spread(300, 0.0);
    let wide = ScatteredOptions {
        width: 2.0,
        ..with(RadialBasis::Gaussian)
    };
    let expected = values(&centres);
    let actual = mapped(&centres, &expected, wide, 1.0, &centres)?;
    for (actual, expected) in actual.iter().zip(expected) {
        let error = actual.distance(expected);
        assert!(error < 1e-3, "{error:e}");
    }
    Ok(())
}

/// Divides the time from `from` to `to` into `steps` steps. Returns the largest distance that a
/// source or target point shown at a fixed frame point moves within one step.
fn farthest_step(warp: &ScatteredWarp, [from, to]: [f64; 2], steps: u32) -> f64 {
    let places: Vec<DVec2> = spread(200, 0.0).iter().map(|&p| 4.0 * p).collect();
    let mut last = lookups(warp, from, &places);
    let mut farthest = 0.0_f64;
    for step in 1..=steps {
        let t = from + (to - from) * f64::from(step) / f64::from(steps);
        let now = lookups(warp, t, &places);
        for (now, last) in now.iter().flatten().zip(last.iter().flatten()) {
            farthest = farthest.max(now.distance(*last));
        }
        last = now;
    }
    farthest
}

/// Asserts that the mapping of `pairs` is continuous in t: a jump would not shrink with the length
/// of the time steps.
fn assert_no_jump(pairs: &[PointPair]) -> ScatteredTestResult {
    for basis in BASES {
        let warp = ScatteredWarp::new(&FRAME, pairs, &[], with(basis))?;
        let [long, short] = [1000, 8000].map(|n| farthest_step(&warp, [0.45, 0.55], n));
        assert!(short < 0.3 * long, "{basis:?}: {long} {short}");
        assert!(short < 1.0, "{basis:?}: {short}");
    }
    Ok(())
}

/// One feature crosses the line through the other two, where an affine map would be infinitely
/// steep.
#[test]
#[ignore = "slow; run by scripts/test"]
fn a_triangle_flips_without_a_jump() -> ScatteredTestResult {
    assert_no_jump(&[
        pair((0.0, 3.0), (0.0, 3.0)),
        pair((2.0, 3.0), (2.0, 3.0)),
        pair((1.0, 4.0), (1.2, 2.0)),
    ])
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn features_that_swap_positions_cause_no_jump() -> ScatteredTestResult {
    let pairs = [
        pair((0.0, 3.0), (2.0, 3.5)),
        pair((2.0, 3.5), (0.0, 3.0)),
        pair((0.0, 5.0), (0.5, 5.0)),
        pair((2.0, 2.0), (2.0, 2.5)),
        pair((3.0, 5.0), (3.0, 4.5)),
    ];
    assert_no_jump(&pairs)?;
    assert_no_jump(&pairs[..2])
}

#[test]
fn invalid_input_is_rejected() {
    let valid = pair((0.0, 0.0), (1.0, 1.0));
    let new = |points: &[PointPair], options| ScatteredWarp::new(&FRAME, points, &[], options);
    let bad = pair((0.0, f64::NAN), (1.0, 1.0));
    assert_eq!(
        new(&[valid, bad], ScatteredOptions::default()).map(|_| ()),
        Err(FeatureError::Point(2).into())
    );
    let line = LinePair {
        source: [DVec2::ZERO, DVec2::X],
        target: [DVec2::INFINITY, DVec2::X],
    };
    assert_eq!(
        ScatteredWarp::new(&FRAME, &[], &[line], ScatteredOptions::default()).map(|_| ()),
        Err(FeatureError::Line(1).into())
    );
    assert_eq!(
        new(&[valid; MAX_FEATURES + 1], ScatteredOptions::default()).map(|_| ()),
        Err(FeatureError::TooMany { found: 513 }.into())
    );
    let default = ScatteredOptions::default();
    for options in [
        ScatteredOptions {
            width: 0.0,
            ..default
        },
        ScatteredOptions {
            width: f64::NAN,
            ..default
        },
        ScatteredOptions {
            exponent: 1.0,
            ..default
        },
        ScatteredOptions {
            exponent: 0.0,
            ..default
        },
        ScatteredOptions {
            smoothing: -1.0,
            ..default
        },
        ScatteredOptions {
            smoothing: f64::INFINITY,
            ..default
        },
    ] {
        assert!(new(&[valid], options).is_err());
    }
}

#[test]
fn options_are_read_in_kebab_case() -> ScatteredTestResult {
    let read: ScatteredOptions = toml::from_str("basis = 'thin-plate'\nsmoothing = 0.1")?;
    assert_eq!(read.smoothing, 0.1);
    assert!(toml::from_str::<ScatteredOptions>("bases = 1").is_err());
    Ok(())
}

fn any_place() -> impl Strategy<Value = DVec2> {
    let coordinate = || {
        prop_oneof![
            6 => -1.0f64..5.0,
            2 => (0_i32..3).prop_map(f64::from),
            1 => -1e300f64..1e300,
            1 => Just(1.0 + 1e-9),
        ]
    };
    (coordinate(), coordinate()).prop_map(|(x, y)| DVec2::new(x, y))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_frame_is_finite(
        basis in prop::sample::select(&BASES[..]),
        ends in prop::collection::vec((any_place(), any_place()), 0..12),
        exponent in prop_oneof![-1.0f64..-0.01, 0.01f64..0.99],
        width in 0.001f64..10.0,
        smoothing in prop_oneof![Just(0.0), 0.0f64..2.0],
        t in prop_oneof![Just(0.5), -0.5f64..1.5, Just(1e300), Just(f64::NAN)],
        point_frame in any::<bool>(),
    ) {
        let pairs: Vec<_> = ends.iter().map(|&(p, q)| pair(p, q)).collect();
        let options = ScatteredOptions { basis, width, exponent, smoothing };
        let frame = if point_frame { Bounds::at(DVec2::ONE) } else { FRAME };
        let warp = ScatteredWarp::new(&frame, &pairs, &[], options)?;
        let places: Vec<DVec2> = spread(20, 0.0).iter().map(|&p| 4.0 * p).collect();
        for place in lookups(&warp, t, &places).into_iter().flatten() {
            prop_assert!(place.is_finite(), "{place}");
        }
    }

    #[test]
    fn exchanged_designs_reverse_the_motion(
        basis in prop::sample::select(&BASES[..]),
        ends in prop::collection::vec((0.0f64..4.0, 2.0f64..5.0), 0..12),
        t in -0.2f64..1.2,
    ) {
        let target = spread(ends.len(), 3.0);
        let pairs: Vec<_> = ends.iter().zip(&target).map(|(&p, &q)| pair(p, 3.0 * q)).collect();
        let swapped: Vec<_> = pairs.iter().map(|p| pair(p.target, p.source)).collect();
        let warp = ScatteredWarp::new(&FRAME, &pairs, &[], with(basis))?;
        let back = ScatteredWarp::new(&FRAME, &swapped, &[], with(basis))?;
        let places: Vec<DVec2> = spread(20, 0.0).iter().map(|&p| 4.0 * p).collect();
        let [source, target] = lookups(&warp, t, &places);
        let [back_source, back_target] = lookups(&back, 1.0 - t, &places);
        for (a, b) in source.iter().zip(&back_target).chain(target.iter().zip(&back_source)) {
            prop_assert!(a.distance(*b) < 1e-6 * (1.0 + a.length()), "{a} {b}");
        }
    }
}
