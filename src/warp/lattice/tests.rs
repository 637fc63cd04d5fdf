//! Tests of the lattice warp: interpolation, exactness at t = 0 and t = 1, absence of folds,
//! features outside the frame, exchanged designs, invalid input.

use super::*;
use crate::warp::FeatureError;
use proptest::prelude::*;

type LatticeTestResult = Result<(), Box<dyn std::error::Error>>;

const FRAME: Bounds = Bounds {
    min: DVec2::new(-1.0, 2.0),
    max: DVec2::new(3.0, 5.0),
};

fn pair(source: impl Into<DVec2>, target: impl Into<DVec2>) -> PointPair {
    PointPair {
        source: source.into(),
        target: target.into(),
    }
}

/// Returns well-spread points of the frame (additive recurrence of the plastic number).
fn spread(count: usize, shift: f64) -> Vec<DVec2> {
    let step = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2);
    let point = |k| FRAME.min + FRAME.size() * ((k as f64 + shift) * step).fract();
    (1..=count).map(point).collect()
}

fn lookups(warp: &Lattice, t: f64, places: &[DVec2]) -> [Vec<DVec2>; 2] {
    let [mut source, mut target] = [(); 2].map(|()| vec![DVec2::NAN; places.len()]);
    warp.clone().look_up(t, places, &mut source, &mut target);
    [source, target]
}

fn summed() -> LatticeOptions {
    LatticeOptions {
        fold_free: false,
        ..LatticeOptions::default()
    }
}

/// Returns features that move by up to a tenth of the frame.
fn moderate(count: usize) -> Vec<PointPair> {
    let ends = spread(count, 0.0).into_iter().zip(spread(count, 0.3));
    ends.map(|(p, by)| pair(p, p + 0.1 * (by - FRAME.centre())))
        .collect()
}

#[test]
fn features_are_interpolated_within_the_tolerance() -> LatticeTestResult {
    for options in [LatticeOptions::default(), summed()] {
        for count in [1, 2, 10, 40] {
            let pairs = moderate(count);
            let warp = Lattice::new(&FRAME, &pairs, &[], options)?;
            for t in [0.0, 0.3, 0.5, 1.0] {
                let at: Vec<DVec2> = pairs.iter().map(|f| f.source.lerp(f.target, t)).collect();
                let [source, target] = lookups(&warp, t, &at);
                let residuals = warp.residuals(t);
                for (k, pair) in pairs.iter().enumerate() {
                    let errors = [
                        source[k].distance(pair.source),
                        target[k].distance(pair.target),
                    ];
                    let larger = errors[0].max(errors[1]);
                    assert!(
                        larger <= warp.tolerance(),
                        "{options:?} {count} {t}: {larger:e}"
                    );
                    assert!((errors[0] - residuals[k][0]).abs() < 1e-12);
                    assert!((errors[1] - residuals[k][1]).abs() < 1e-12);
                }
            }
        }
    }
    Ok(())
}

#[test]
fn a_feature_crosses_the_frame() -> LatticeTestResult {
    let pairs = [
        pair((-0.9, 2.1), (2.9, 4.9)),
        pair((1.0, 2.1), (1.0, 2.1)),
        pair((-0.9, 4.9), (-0.9, 4.9)),
    ];
    let warp = Lattice::new(&FRAME, &pairs, &[], LatticeOptions::default())?;
    for t in [0.0, 0.2, 0.8, 1.0] {
        for missed in warp.residuals(t) {
            assert!(missed[0].max(missed[1]) <= warp.tolerance(), "{missed:?}");
        }
    }
    Ok(())
}

#[test]
fn ends_are_exact_and_without_features_nothing_moves() -> LatticeTestResult {
    let places = spread(200, 0.5);
    for options in [LatticeOptions::default(), summed()] {
        let warp = Lattice::new(&FRAME, &moderate(30), &[], options)?;
        assert_eq!(lookups(&warp, 0.0, &places)[0], places);
        assert_eq!(lookups(&warp, 1.0, &places)[1], places);
        let none = Lattice::new(&FRAME, &[], &[], options)?;
        assert_eq!(
            lookups(&none, 0.4, &places),
            [places.clone(), places.clone()]
        );
        assert!(none.residuals(0.4).is_empty());
    }
    Ok(())
}

#[test]
fn features_far_from_the_frame_have_no_effect_in_it() -> LatticeTestResult {
    let places = spread(200, 0.5);
    let far = pair((40.0, 3.0), (41.0, 3.0));
    let warp = Lattice::new(&FRAME, &[far], &[], LatticeOptions::default())?;
    assert_eq!(lookups(&warp, 0.5, &places)[0], places);
    assert_eq!(warp.residuals(0.5)[0][0], 0.5);
    Ok(())
}

#[test]
fn features_fade_out_without_a_jump() -> LatticeTestResult {
    let places = spread(100, 0.5);
    let at = |x: f64| -> Result<Vec<DVec2>, LatticeError> {
        let leaving = pair((x, 3.0), (x, 4.0));
        let staying = pair((2.5, 3.5), (2.0, 3.5));
        let options = LatticeOptions {
            coarsest: 1,
            ..LatticeOptions::default()
        };
        let warp = Lattice::new(&FRAME, &[leaving, staying], &[], options)?;
        Ok(lookups(&warp, 0.5, &places)[0].clone())
    };
    let mut last = at(3.0)?;
    for step in 1..=500 {
        let now = at(3.0 + f64::from(step) * 0.01)?;
        for (now, last) in now.iter().zip(&last) {
            assert!(
                now.distance(*last) < 0.05,
                "{step}: {}",
                now.distance(*last)
            );
        }
        last = now;
    }
    Ok(())
}

/// Returns the smallest Jacobian determinant on a fine grid that extends beyond the frame.
///
/// In fold-free mode the determinants of the individual layers count as well.
fn smallest_determinant(warp: &Lattice, t: f64, steps: u32) -> f64 {
    let mut warp = warp.clone();
    warp.build(t);
    let steps = f64::from(steps);
    let (low, size) = (FRAME.min - 2.0, FRAME.size() + 4.0);
    let mut smallest = f64::INFINITY;
    for k in 0..(steps * steps) as u32 {
        let (i, j) = (f64::from(k) % steps, (f64::from(k) / steps).floor());
        let place = low + size * DVec2::new(i, j) / steps;
        for tower in &warp.stacks {
            let [total, step] = tower.determinants(place);
            smallest = smallest.min(total).min(if warp.domain.options.fold_free {
                step
            } else {
                total
            });
        }
    }
    smallest
}

#[test]
fn summed_layers_fold_where_composed_ones_do_not() -> LatticeTestResult {
    let pairs = [pair((0.5, 3.5), (1.5, 3.5)), pair((1.2, 3.5), (0.8, 3.5))];
    let folding = Lattice::new(&FRAME, &pairs, &[], summed())?;
    assert!(smallest_determinant(&folding, 0.0, 150) < 0.0);
    let composed = Lattice::new(&FRAME, &pairs, &[], LatticeOptions::default())?;
    assert!(smallest_determinant(&composed, 0.0, 150) > 0.0);
    Ok(())
}

#[test]
fn features_that_meet_report_their_residuals() -> LatticeTestResult {
    let pairs = [pair((0.0, 3.0), (2.0, 4.0)), pair((2.0, 4.0), (0.0, 3.0))];
    let warp = Lattice::new(&FRAME, &pairs, &[], LatticeOptions::default())?;
    let half = 0.5 * 5.0_f64.sqrt();
    for residual in warp.residuals(0.5) {
        assert!((residual[0] - half).abs() < 1e-9, "{residual:?}");
        assert!((residual[1] - half).abs() < 1e-9, "{residual:?}");
    }
    Ok(())
}

#[test]
fn options_out_of_range_are_rejected() {
    let new = |options| Lattice::new(&FRAME, &[], &[], options).map(|_| ());
    let default = LatticeOptions::default();
    assert_eq!(new(default), Ok(()));
    let levels = LatticeOptions {
        levels: 0,
        ..default
    };
    assert_eq!(new(levels), Err(LatticeError::Levels(0)));
    let levels = LatticeOptions {
        levels: 10,
        ..default
    };
    assert_eq!(new(levels), Err(LatticeError::Levels(10)));
    let coarsest = LatticeOptions {
        coarsest: 0,
        ..default
    };
    assert_eq!(new(coarsest), Err(LatticeError::Coarsest(0)));
    let finest = LatticeOptions {
        coarsest: 8,
        levels: 9,
        ..default
    };
    assert_eq!(new(finest), Err(LatticeError::Finest(2048)));
    for tolerance in [0.0, 1.5, f64::NAN] {
        assert!(
            new(LatticeOptions {
                tolerance,
                ..default
            })
            .is_err()
        );
    }
    let bad = Lattice::new(&FRAME, &[pair((f64::NAN, 0.0), (0.0, 0.0))], &[], default);
    assert_eq!(bad.map(|_| ()), Err(FeatureError::Point(1).into()));
}

#[test]
fn options_are_read_in_kebab_case() -> LatticeTestResult {
    let read: LatticeOptions = toml::from_str("fold-free = false\ncoarsest = 2")?;
    assert_eq!((read.fold_free, read.coarsest, read.levels), (false, 2, 5));
    assert!(toml::from_str::<LatticeOptions>("fold_free = false").is_err());
    Ok(())
}

fn any_place() -> impl Strategy<Value = DVec2> {
    let coordinate = || {
        prop_oneof![
            8 => -1.0f64..5.0,
            2 => (0_i32..4).prop_map(f64::from),
            1 => -20.0f64..20.0,
            1 => -1e300f64..1e300,
            1 => Just(1.0 + 1e-9),
        ]
    };
    (coordinate(), coordinate()).prop_map(|(x, y)| DVec2::new(x, y))
}

fn any_options() -> impl Strategy<Value = LatticeOptions> {
    (1_u32..6, 1_u32..=8, -6.0f64..0.0).prop_map(|(levels, coarsest, tolerance)| LatticeOptions {
        levels,
        coarsest,
        tolerance: 10.0_f64.powf(tolerance),
        fold_free: true,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn composed_layers_never_fold_and_stay_finite(
        ends in prop::collection::vec((any_place(), any_place()), 0..12),
        options in any_options(),
        t in prop_oneof![Just(0.5), -0.5f64..1.5, Just(1e300), Just(f64::NAN)],
    ) {
        let pairs: Vec<_> = ends.iter().map(|&(p, q)| pair(p, q)).collect();
        let warp = Lattice::new(&FRAME, &pairs, &[], options)?;
        let smallest = smallest_determinant(&warp, t, 60);
        prop_assert!(smallest > 0.0, "{smallest:e}");
        for place in lookups(&warp, t, &spread(30, 0.0)).into_iter().flatten() {
            prop_assert!(place.is_finite());
        }
        prop_assert!(warp.residuals(t).iter().all(|r| r[0].is_finite()));
    }

    #[test]
    fn summed_layers_are_finite(
        ends in prop::collection::vec((any_place(), any_place()), 0..12),
        options in any_options(),
        t in prop_oneof![Just(0.5), -0.5f64..1.5, Just(1e300)],
    ) {
        let pairs: Vec<_> = ends.iter().map(|&(p, q)| pair(p, q)).collect();
        let options = LatticeOptions { fold_free: false, ..options };
        let warp = Lattice::new(&FRAME, &pairs, &[], options)?;
        for place in lookups(&warp, t, &spread(30, 0.0)).into_iter().flatten() {
            prop_assert!(place.is_finite());
        }
    }

    #[test]
    fn exchanged_designs_reverse_the_motion(
        ends in prop::collection::vec((0.0f64..4.0, 2.0f64..5.0), 0..12),
        fold_free in any::<bool>(),
        t in -0.2f64..1.2,
    ) {
        let target = spread(ends.len(), 3.0);
        let pairs: Vec<_> = ends.iter().zip(&target).map(|(&p, &q)| pair(p, q)).collect();
        let swapped: Vec<_> = pairs.iter().map(|p| pair(p.target, p.source)).collect();
        let options = LatticeOptions { fold_free, ..LatticeOptions::default() };
        let warp = Lattice::new(&FRAME, &pairs, &[], options)?;
        let back = Lattice::new(&FRAME, &swapped, &[], options)?;
        let places = spread(20, 0.0);
        let [source, target] = lookups(&warp, t, &places);
        let [back_source, back_target] = lookups(&back, 1.0 - t, &places);
        for (a, b) in source.iter().zip(&back_target).chain(target.iter().zip(&back_source)) {
            prop_assert!(a.distance(*b) < 1e-6, "{a} {b}");
        }
    }
}
