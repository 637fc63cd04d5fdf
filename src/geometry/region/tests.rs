//! Tests of regions: repairs, holes, transforms and hostile coordinates.

use super::*;
use crate::geometry::{MAX_COORDINATE, MIN_SIZE};
use proptest::prelude::*;

fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&p| p.into()).collect()
}

#[test]
fn a_bow_tie_becomes_two_pieces() {
    let bow = ring(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
    let regions = Regions::from_rings(&[bow], FillRule::EvenOdd).expect("area");
    assert_eq!(regions.len(), 2);
    assert!((regions.area() - 2.0).abs() < 1e-9);
}

#[test]
fn a_hole_runs_clockwise_and_is_outside() {
    let outer = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
    let inner = ring(&[(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)]);
    let regions = Regions::from_rings(&[outer, inner], FillRule::EvenOdd).expect("area");
    assert_eq!(regions.rings().count(), 2);
    assert!((regions.area() - 12.0).abs() < 1e-9);
    assert!(!regions.contains(DVec2::new(2.0, 2.0)));
    assert!(regions.contains(DVec2::new(0.5, 0.5)));
    let mirrored = regions.transformed(&Similarity {
        mirror: true,
        ..Similarity::IDENTITY
    });
    assert!((mirrored.area() - 12.0).abs() < 1e-9);
}

/// Generates any finite number, extremes as often as ordinary values.
fn finite() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    let bounds = [
        1e150,
        1e18,
        MAX_COORDINATE.next_up(),
        1e15,
        1e-18,
        1e-160,
        f64::MAX,
    ];
    prop_oneof![
        POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO,
        (-4i32..5).prop_map(f64::from),
        prop::sample::select(bounds.to_vec()),
        (-4i32..5).prop_map(|i| 1e15 + f64::from(i)),
    ]
}

proptest! {
    #[test]
    fn any_finite_numbers_make_regions_or_are_refused(
        rings in prop::collection::vec(
            prop::collection::vec((finite(), finite()).prop_map(DVec2::from), 0..9), 0..4),
        even_odd in any::<bool>(),
    ) {
        let rule = if even_odd { FillRule::EvenOdd } else { FillRule::NonZero };
        let reported = Regions::from_rings_reporting(&rings, rule);
        for regions in [Regions::from_rings(&rings, rule), reported.map(|(found, _)| found)] {
            let Ok(regions) = regions else { continue };
            prop_assert!(regions.area() > 0.0 && regions.area().is_finite());
            for region in regions.iter() {
                prop_assert!(region.outer.signed_area() > 0.0);
                prop_assert!(region.holes.iter().all(|hole| hole.signed_area() < 0.0));
            }
        }
    }
}

#[test]
fn limits_apply_to_large_and_small_designs() {
    let square = |size: f64| {
        let points = [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)];
        Regions::from_rings(&[ring(&points)], FillRule::NonZero)
    };
    for size in [MAX_COORDINATE, MIN_SIZE] {
        let area = square(size).expect("in range").area();
        assert!((area / (size * size) - 1.0).abs() < 1e-9);
    }
    let far = square(MAX_COORDINATE.next_up());
    assert!(matches!(
        far,
        Err(RegionsError::OutOfRange { ring: 0, point: 1 })
    ));
    let small = square(MIN_SIZE.next_down());
    assert!(matches!(small, Err(RegionsError::Size(_))));
    let away = |size: f64| {
        let points = [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)];
        let points = points.map(|(x, y)| (1e15 + x, y));
        Regions::from_rings(&[ring(&points)], FillRule::NonZero)
    };
    let area = away(2000.0).expect("fine enough").area();
    assert!((area / 4e6 - 1.0).abs() < 1e-3, "{area}");
    let coarse = away(10.0).expect_err("too coarse").to_string();
    assert!(
        coarse.contains("1e15 away") && coarse.contains("move"),
        "{coarse}"
    );
}

#[test]
fn a_nearly_closed_outline_keeps_no_tiny_last_edge() {
    let last = (1.0, 24.0 + 6e-14);
    let nearly = ring(&[(1.0, 24.0), (0.0, 0.0), (24.0, 0.0), (24.0, 24.0), last]);
    let regions = Regions::from_rings(&[nearly], FillRule::NonZero).expect("a region");
    let points = regions.rings().next().expect("an outline").points();
    assert_eq!(points.len(), 4, "{points:?}");
}

#[test]
fn holes_that_touch_in_a_corner_are_holes_of_their_own() {
    let plate = ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0)]);
    let left = ring(&[(5.0, 4.0), (2.0, 6.0), (2.0, 2.0)]);
    let right = ring(&[(5.0, 4.0), (7.0, 2.0), (7.0, 6.0)]);
    let notch = ring(&[(10.0, 4.0), (8.0, 5.0), (8.0, 3.0)]);
    let rings = [plate, left, right, notch];
    for rule in [FillRule::EvenOdd, FillRule::NonZero] {
        let mut rings = rings.clone();
        if rule == FillRule::NonZero {
            rings[1..].iter_mut().for_each(|hole| hole.reverse());
        }
        let (regions, repairs) = Regions::from_rings_reporting(&rings, rule).expect("area");
        assert_eq!((regions.len(), regions.rings().count()), (1, 4), "{rule:?}");
        assert!((regions.area() - (80.0 - 6.0 - 4.0 - 2.0)).abs() < 1e-9);
        assert_eq!(repairs.slivers, 0);
    }
}

#[test]
fn squares_that_touch_in_a_corner_are_pieces_of_their_own() {
    let square = |x: f64| ring(&[(x, x), (x + 2.0, x), (x + 2.0, x + 2.0), (x, x + 2.0)]);
    let regions = Regions::from_rings(&[square(0.0), square(2.0)], FillRule::NonZero);
    let regions = regions.expect("area");
    assert_eq!((regions.len(), regions.rings().count()), (2, 2));
    // Two openings around a square that touches the frame with two opposite corners.
    let frame = ring(&[(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)]);
    let opening = ring(&[(1.0, 1.0), (5.0, 1.0), (5.0, 5.0), (1.0, 5.0)]);
    let island = ring(&[(1.0, 1.0), (3.0, 2.0), (5.0, 5.0), (2.0, 3.0)]);
    let regions = Regions::from_rings(&[frame, opening, island], FillRule::EvenOdd);
    let area = regions.expect("area").area();
    assert!((area - (36.0 - 16.0 + 4.0)).abs() < 1e-9, "{area}");
}

#[test]
fn outlines_without_area_are_an_error() {
    let line = ring(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]);
    assert_eq!(
        Regions::from_rings(&[line], FillRule::NonZero),
        Err(RegionsError::Empty)
    );
    assert_eq!(
        Regions::from_rings(&[], FillRule::NonZero),
        Err(RegionsError::Empty)
    );
    let nan = ring(&[(0.0, 0.0), (f64::NAN, 1.0), (2.0, 2.0)]);
    assert!(matches!(
        Regions::from_rings(&[nan], FillRule::NonZero),
        Err(RegionsError::OutOfRange { ring: 0, point: 1 })
    ));
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn nearly_coincident_edges_are_cleaned_quickly() {
    // The fuzzer found these rings. Cleaning them took 15 s with the library's own settings.
    let rings: [&[(f64, f64)]; 5] = [
        &[
            (1.0843959206559366e16, 1.0843961455707782e16),
            (1.0843961455707782e16, 2429515387216289.5),
            (2.1429373431091396e-307, 5.076791793838071e-81),
            (1.0844159026807362e16, 1408271740096720.8),
            (1.0843961455690886e16, 6.032153789438771e-293),
        ],
        &[
            (1.0843961455707782e16, -2.5301701079419506e-98),
            (1.0843961455707782e16, 1.0843961455707782e16),
            (1.084396145570799e16, 5.076791793838071e-81),
            (1.0843961455707782e16, 1.0843965296738682e16),
        ],
        &[
            (1.0843961455707782e16, 1408271740096720.8),
            (1.0843961455709318e16, -9.169109864596823e-101),
            (-1.06578932171617e-220, 1.0843961455707782e16),
            (1.0843961455707782e16, 1.1072663377631062e16),
            (1.0843961455707782e16, 1.0843961455673344e16),
            (1.084396145570799e16, 2524806.525490196),
            (1.0843961455707782e16, 1.084396148041127e16),
            (1.0843994741704192e16, 1.0843961455707782e16),
            (1.0843987225511464e16, -2.752134346067909e-100),
            (1.0843961469392466e16, -2.1430515280367397e-307),
        ],
        &[
            (572194474715240.4, 1.1072663377631062e16),
            (1.0843961455707782e16, 1.0843961455673344e16),
            (1.084396145570799e16, 4.218927018705964e-149),
            (1.0843961455707782e16, 1.0844132109092486e16),
            (1.0843961446925958e16, 4399840224190881.5),
            (1.0843961455707782e16, 1.0843961455707782e16),
            (562949953421312.0, 1.0705345681196678e16),
        ],
        &[
            (1.0843961455707782e16, 1.0844858295211862e16),
            (1.084396410650791e16, 1.0843961455707782e16),
            (-2.5301701079419506e-98, 1.084396145576103e16),
            (1.0696051371968134e16, 1.0843961446891654e16),
            (8.5073e-320, 0.0),
        ],
    ];
    let rings = rings.map(|ring| ring.iter().copied().map(DVec2::from).collect::<Vec<_>>());
    let regions = Regions::from_rings(&rings, FillRule::EvenOdd).expect("an area");
    assert!(regions.area().is_finite() && regions.area() > 0.0);
}
