//! Tests of the boundary paths: exact identities, rigid and similar copies, degenerate rings.
#![expect(clippy::unwrap_used, reason = "tests")]

use super::*;
use proptest::prelude::*;

/// Times inside and outside [0, 1].
const TIMES: [f64; 7] = [-0.4, 0.1, 0.25, 0.5, 0.77, 0.9, 1.4];

fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
    list.iter().copied().map(DVec2::from).collect()
}

/// Returns the outline of an arm of eight unit segments, bent by `bend` radians at each joint.
fn arm(bend: f64) -> Vec<DVec2> {
    let (mut at, mut middle) = (DVec2::ZERO, Vec::new());
    for k in 0..9 {
        let along = DVec2::from_angle(bend * f64::from(k));
        middle.push((at, along.perp()));
        at += along;
    }
    let right = middle.iter().map(|(p, n)| *p - 0.3 * *n);
    let left = middle.iter().rev().map(|(p, n)| *p + 0.3 * *n);
    right.chain(left).collect()
}

fn ring(source: Vec<DVec2>, target: Vec<DVec2>) -> RingPair {
    RingPair { source, target }
}

fn intrinsic(parts: &[Vec<RingPair>]) -> BoundaryPaths {
    BoundaryPaths::new(parts, PathOptions::default()).unwrap()
}

fn positions(paths: &BoundaryPaths, t: f64) -> Vec<DVec2> {
    let mut placer = paths.placer();
    placer.place(t);
    placer.placement().in_frame.clone()
}

fn moved(ring: &[DVec2], angle: f64, by: DVec2) -> Vec<DVec2> {
    let turn = DVec2::from_angle(angle);
    ring.iter().map(|&p| turn.rotate(p) + by).collect()
}

/// Returns a plate with two holes and a second part next to it.
fn plate() -> [Vec<Vec<DVec2>>; 2] {
    let square = |x: f64, y: f64, s: f64| points(&[(x, y), (x + s, y), (x + s, y + s), (x, y + s)]);
    let hole = |x: f64, y: f64, s: f64| square(x, y, s).into_iter().rev().collect();
    [
        vec![
            square(0.0, 0.0, 5.0),
            hole(1.0, 1.0, 1.0),
            hole(3.0, 3.5, 0.5),
        ],
        vec![square(8.0, 1.0, 2.0)],
    ]
}

fn pairs(parts: &[Vec<Vec<DVec2>>], target: impl Fn(&[DVec2]) -> Vec<DVec2>) -> Vec<Vec<RingPair>> {
    let pair = |r: &Vec<DVec2>| ring(r.clone(), target(r));
    parts
        .iter()
        .map(|rings| rings.iter().map(pair).collect())
        .collect()
}

fn swapped(parts: &[Vec<RingPair>]) -> Vec<Vec<RingPair>> {
    let swap = |pair: &RingPair| ring(pair.target.clone(), pair.source.clone());
    parts
        .iter()
        .map(|rings| rings.iter().map(swap).collect())
        .collect()
}

fn worst_gap(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(p, q)| p.distance(*q))
        .fold(0.0, f64::max)
}

/// Returns the largest difference between a vertex distance and `scale` times that distance in
/// the source, over all vertex pairs.
fn worst_stretch(source: &[DVec2], now: &[DVec2], scale: f64) -> f64 {
    let indices = 0..source.len();
    let all = indices
        .clone()
        .flat_map(|i| indices.clone().map(move |j| (i, j)));
    all.map(|(i, j)| (now[i].distance(now[j]) - scale * source[i].distance(source[j])).abs())
        .fold(0.0, f64::max)
}

#[test]
fn the_ends_are_the_designs_bit_for_bit() {
    let parts = vec![vec![ring(arm(-0.0), arm(0.35))]];
    for course in [VertexPath::Straight, VertexPath::Intrinsic] {
        let paths = BoundaryPaths::new(&parts, PathOptions { course }).unwrap();
        let bits = |points: &[DVec2]| -> Vec<[u64; 2]> {
            points
                .iter()
                .map(|p| p.to_array().map(f64::to_bits))
                .collect()
        };
        assert_eq!(bits(&positions(&paths, 0.0)), bits(&parts[0][0].source));
        assert_eq!(bits(&positions(&paths, 1.0)), bits(&parts[0][0].target));
        // The motion is continuous at t = 0 and t = 1.
        for (t, end) in [
            (1e-9, &parts[0][0].source),
            (1.0 - 1e-9, &parts[0][0].target),
        ] {
            assert!(worst_gap(&positions(&paths, t), end) < 1e-7, "{course:?}");
        }
    }
}

#[test]
fn straight_paths_are_straight() {
    let parts = vec![vec![ring(arm(0.0), arm(0.35))]];
    let straight = PathOptions {
        course: VertexPath::Straight,
    };
    let middle = positions(&BoundaryPaths::new(&parts, straight).unwrap(), 0.5);
    let pair = &parts[0][0];
    let expected: Vec<DVec2> = pair
        .source
        .iter()
        .zip(&pair.target)
        .map(|(p, q)| p.midpoint(*q))
        .collect();
    assert!(worst_gap(&middle, &expected) < 1e-12);
}

#[test]
fn a_rigid_copy_moves_rigidly_with_holes_and_parts() {
    for degrees in [-179.0, -90.0, 1.0, 60.0, 135.0, 179.0_f64] {
        let by = DVec2::new(7.0, -30.0);
        let parts = pairs(&plate(), |r| moved(r, degrees.to_radians(), by));
        let paths = intrinsic(&parts);
        let source = positions(&paths, 0.0);
        for t in TIMES {
            let stretch = worst_stretch(&source, &positions(&paths, t), 1.0);
            assert!(stretch < 1e-9, "{degrees}° at {t}: {stretch}");
        }
        let quarter = positions(&paths, 0.25);
        let turned = (source[1] - source[0]).angle_to(quarter[1] - quarter[0]);
        assert!((turned - 0.25 * degrees.to_radians()).abs() < 1e-9);
    }
}

#[test]
fn a_larger_copy_stays_similar() {
    let parts = pairs(&plate(), |r| {
        moved(r, 2.0, DVec2::ONE).iter().map(|&p| 3.0 * p).collect()
    });
    let paths = intrinsic(&parts);
    let source = positions(&paths, 0.0);
    for t in TIMES {
        let stretch = worst_stretch(&source, &positions(&paths, t), 1.0 + 2.0 * t);
        assert!(stretch < 1e-9, "at {t}: {stretch}");
    }
}

#[test]
fn an_arm_that_bends_keeps_its_length() {
    let parts = vec![vec![ring(arm(-0.25), arm(0.25))]];
    let middle = positions(&intrinsic(&parts), 0.5);
    let straight = arm(0.0);
    let stretch = worst_stretch(&straight, &middle, 1.0);
    assert!(stretch < 0.2, "of a length of 8: {stretch}");
}

#[test]
fn a_hole_moves_with_its_limb() {
    let hole: Vec<DVec2> = points(&[(7.9, 0.1), (8.0, 0.1), (8.0, -0.1), (7.9, -0.1)]);
    let tip = |bend: f64| {
        let ring = arm(bend);
        (ring[8], ring[8] - ring[7])
    };
    let (from, along) = tip(0.0);
    let (to, along_target) = tip(0.35);
    let turn = along.angle_to(along_target)
        + if along.angle_to(along_target) < 0.0 {
            std::f64::consts::TAU
        } else {
            0.0
        };
    let carried: Vec<DVec2> = hole
        .iter()
        .map(|&p| to + DVec2::from_angle(turn).rotate(p - from))
        .collect();
    let parts = vec![vec![ring(arm(0.0), arm(0.35)), ring(hole.clone(), carried)]];
    let now = positions(&intrinsic(&parts), 0.5);
    let distance = |ring: &[DVec2], hole: &[DVec2]| ring[8].distance(hole[0]);
    let expected = distance(&parts[0][0].source, &hole);
    assert!((distance(&now, &now[18..]) - expected).abs() < 0.05);
    assert!(worst_stretch(&hole, &now[18..], 1.0) < 1e-9);
}

#[test]
fn exchanged_designs_reverse_the_motion() {
    let bent = vec![vec![ring(arm(-0.1), moved(&arm(0.35), 2.5, DVec2::X))]];
    let shear = |r: &[DVec2]| {
        r.iter()
            .map(|p| DVec2::new(p.x + 0.7 * p.y, 1.5 * p.y))
            .collect()
    };
    for parts in [bent, pairs(&plate(), shear)] {
        let (forward, backward) = (intrinsic(&parts), intrinsic(&swapped(&parts)));
        for t in TIMES {
            let gap = worst_gap(&positions(&forward, t), &positions(&backward, 1.0 - t));
            assert!(gap < 1e-9, "at {t}: {gap}");
        }
    }
}

#[test]
fn a_hole_and_a_part_appear_from_points() {
    let mut parts = pairs(&plate(), |r| moved(r, 1.0, DVec2::X));
    let hole = &mut parts[0][1];
    hole.source = vec![DVec2::new(1.5, 1.5); 4];
    let other = &mut parts[1][0];
    other.target = vec![DVec2::new(-3.0, 9.0); 4];
    let paths = intrinsic(&parts);
    let half = positions(&paths, 0.5);
    let side = |k: usize| half[k].distance(half[k + 1]);
    assert!((side(4) - 0.5).abs() < 1e-9, "the hole has half its size");
    assert!((side(12) - 1.0).abs() < 1e-9, "the part has half its size");
}

#[test]
fn invalid_rings_are_rejected() {
    let build = |source: usize, target: usize| {
        let pair = ring(vec![DVec2::ONE; source], vec![DVec2::ONE; target]);
        BoundaryPaths::new(&[vec![pair]], PathOptions::default()).map(|_| ())
    };
    let counts = [3, 4];
    assert_eq!(
        build(3, 4),
        Err(PathsError::Counts {
            part: 0,
            ring: 0,
            counts
        })
    );
    assert_eq!(build(0, 0), Err(PathsError::Empty { part: 0, ring: 0 }));
    assert_eq!(build(1, 1), Ok(()));
    let empty = BoundaryPaths::new(&[], PathOptions::default()).map(|_| ());
    assert_eq!(empty, Err(PathsError::NoRings));
    let out_of_range = [f64::NAN, f64::NEG_INFINITY, 1e76];
    for point in out_of_range.map(|x| DVec2::new(x, 1.0)) {
        let bad_ring = ring(vec![DVec2::ONE, point], vec![DVec2::ONE; 2]);
        let result = BoundaryPaths::new(&[vec![bad_ring]], PathOptions::default()).map(|_| ());
        assert_eq!(result, Err(PathsError::OutOfRange { part: 0, ring: 0 }));
    }
}

fn any_ring(count: usize) -> impl Strategy<Value = Vec<DVec2>> {
    let place = |(x, y): (i8, i8)| DVec2::new(f64::from(x), f64::from(y));
    let rough = (-3i8..4, -3i8..4).prop_map(place);
    let smooth = (-9.0..9.0, -9.0..9.0).prop_map(DVec2::from);
    prop_oneof![
        prop::collection::vec(rough, count),
        prop::collection::vec(smooth, count),
        (-5i8..5, -5i8..5).prop_map(move |at| vec![place(at); count]),
        prop::collection::vec(-5i8..5, count)
            .prop_map(move |xs| xs.into_iter().map(|x| place((x, 2 * (x / 2)))).collect()),
        prop::collection::vec(-5i8..5, count)
            .prop_map(move |xs| xs.into_iter().map(|x| place((x, 0))).collect()),
    ]
}

fn any_parts() -> impl Strategy<Value = Vec<Vec<RingPair>>> {
    let pair = (1usize..9)
        .prop_flat_map(|n| (any_ring(n), any_ring(n)))
        .prop_map(|(source, target)| ring(source, target));
    prop::collection::vec(prop::collection::vec(pair, 1..3), 1..3)
}

proptest! {
    #[test]
    fn vertices_are_always_finite(parts in any_parts(), t in -1.0..2.0, size in -290i32..145) {
        let scale = 10f64.powi(size / 2);
        let scaled = |r: &Vec<DVec2>| r.iter().map(|&p| scale * p).collect();
        let parts: Vec<Vec<RingPair>> = parts
            .iter()
            .map(|rings| rings.iter().map(|r| ring(scaled(&r.source), scaled(&r.target))).collect())
            .collect();
        for course in [VertexPath::Straight, VertexPath::Intrinsic] {
            let paths = BoundaryPaths::new(&parts, PathOptions { course }).unwrap();
            prop_assert!(positions(&paths, t).iter().all(|p| p.is_finite()));
        }
    }

    #[test]
    fn any_rigid_copy_moves_rigidly(
        source in prop::collection::vec((-9.0..9.0, -9.0..9.0).prop_map(DVec2::from), 3..20),
        degrees in -179.0..179.0, x in -50.0..50.0, t in -1.0..2.0,
    ) {
        let target = moved(&source, f64::to_radians(degrees), DVec2::new(x, -x));
        let paths = intrinsic(&[vec![ring(source.clone(), target)]]);
        prop_assert!(worst_stretch(&source, &positions(&paths, t), 1.0) < 1e-9);
    }

    #[test]
    fn any_exchanged_designs_reverse_the_motion(
        corners in prop::collection::vec((0.5..9.0, 0.5..9.0), 4..16),
        angle in -2.9..2.9, t in -1.0..2.0,
    ) {
        let star = |radius: &dyn Fn(&(f64, f64)) -> f64| -> Vec<DVec2> {
            let turn = std::f64::consts::TAU / corners.len() as f64;
            let at = |(k, c)| radius(c) * DVec2::from_angle(turn * k as f64);
            corners.iter().enumerate().map(at).collect()
        };
        let (source, target) = (star(&|c| c.0), moved(&star(&|c| c.1), angle, DVec2::X));
        let parts = [vec![ring(source, target)]];
        let (forward, backward) = (intrinsic(&parts), intrinsic(&swapped(&parts)));
        let gap = worst_gap(&positions(&forward, t), &positions(&backward, 1.0 - t));
        prop_assert!(gap < 1e-9, "{}", gap);
    }
}
