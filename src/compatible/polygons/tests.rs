//! Tests of the compatible triangulation of random simple polygons with arbitrary correspondences,
//! checked against exact oracles.

mod pieces;

use super::boundary_rings;
use super::boundary_rings::BoundaryRings;
use super::error::PieceMeshError;
use super::options::PolygonOptions;
use super::pair_mesh::PairMesh;
use super::ring_contacts;
use super::two_designs::from_base;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DVec2, Ring, Side, orient2d};
use crate::work::progress::Silent;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Pseudo-random numbers in [0, 1) from a seed (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn polar(radius: f64, angle: f64) -> DVec2 {
    radius * DVec2::from_angle(angle)
}

/// Random star-shaped polygon around the origin, with `n` points.
fn star(n: usize, random: &mut Random) -> Vec<DVec2> {
    let point = |i| polar(0.05 + random.next(), TAU * f64::from(i) / n as f64);
    (0..n as u32).map(point).collect()
}

/// Random points, ordered into a simple polygon by reversing sections (2-opt).
fn two_opt(n: usize, random: &mut Random) -> Vec<DVec2> {
    let mut points: Vec<DVec2> = (0..n)
        .map(|_| DVec2::new(random.next(), random.next()))
        .collect();
    while let Some([i, j]) = ring_contacts::touching_edges(&[&points]) {
        points[i + 1..=j].reverse();
    }
    counter_clockwise(points)
}

fn counter_clockwise(mut points: Vec<DVec2>) -> Vec<DVec2> {
    if Ring::new(points.clone()).is_ok_and(|ring| ring.signed_area() < 0.0) {
        points.reverse();
    }
    points
}

/// Comb-shaped polygon with the given number of teeth.
fn comb(teeth: usize, depth: f64) -> Vec<DVec2> {
    let mut points = vec![DVec2::ZERO, DVec2::new(teeth as f64, 0.0)];
    for tooth in (0..teeth).rev() {
        let x = tooth as f64;
        let tips = [(0.9, depth), (0.1, depth), (0.0, 0.1)];
        points.extend(tips.map(|(dx, y)| DVec2::new(x + dx, y)));
    }
    points
}

/// Band that winds around itself in a spiral.
fn spiral(steps: usize, turns: f64) -> Vec<DVec2> {
    let at = |i: usize, offset: f64| {
        let share = i as f64 / steps as f64;
        polar(0.2 + turns * share + offset, TAU * turns * share)
    };
    let outer = (0..=steps).map(|i| at(i, 0.6));
    let inner = (0..=steps).rev().map(|i| at(i, 0.0));
    outer.chain(inner).collect::<Vec<_>>()
}

/// Square with about `n` points, which deviate from its straight sides by up to half of `by`.
fn nearly_straight(n: usize, by: f64, random: &mut Random) -> Vec<DVec2> {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    let mut points = Vec::new();
    for side in 0..4 {
        let (a, b) = (corners[side], corners[(side + 1) % 4]);
        points.push(a);
        for k in 1..n / 4 {
            let out = by * (random.next() - 0.5);
            points.push(a.lerp(b, k as f64 / (n / 4) as f64) + out * (b - a).perp());
        }
    }
    points
}

/// Inserts midpoints of the longest edges until there are `n` points.
fn with_points(mut points: Vec<DVec2>, n: usize) -> Vec<DVec2> {
    while points.len() < n {
        let k = points.len();
        let length = |i: usize| points[i].distance_squared(points[(i + 1) % k]);
        let longest = (0..k).fold(0, |best, i| if length(i) > length(best) { i } else { best });
        let middle = points[longest].midpoint(points[(longest + 1) % k]);
        points.insert(longest + 1, middle);
    }
    points
}

/// Random polygon of one of six kinds, with at least `n` points.
fn shape(kind: usize, n: usize, random: &mut Random) -> Vec<DVec2> {
    let points = match kind {
        0 => star(n, random),
        1 => two_opt(n, random),
        2 => comb(
            3 + (6.0 * random.next()) as usize,
            0.5 + 6.0 * random.next(),
        ),
        3 => counter_clockwise(spiral(n / 2 - 1, 0.3 + 2.5 * random.next())),
        4 => nearly_straight(n, 1e-3 * random.next(), random),
        _ => nearly_straight(n, 0.0, random),
    };
    with_points(points, n)
}

/// Checks a mesh of two polygons for all guarantees of the triangulation, by slow and simple
/// oracles.
fn assert_valid(mesh: &CompatibleMesh, source: &[DVec2], target: &[DVec2]) {
    assert_valid_piece(mesh, &[source], &[target]);
}

/// Same as [`assert_valid`], for a piece with holes.
fn assert_valid_piece<R: AsRef<[DVec2]>>(mesh: &CompatibleMesh, source: &[R], target: &[R]) {
    let mut loops = mesh.boundary_loops();
    for boundary in &mut loops {
        let first = (0..boundary.len())
            .min_by_key(|&k| boundary[k])
            .expect("not empty");
        boundary.rotate_left(first);
    }
    loops.sort_unstable();
    let mut n = 0;
    let ring = |ring: &R| {
        n += ring.as_ref().len() as u32;
        (n - ring.as_ref().len() as u32..n).collect()
    };
    let rings: Vec<Vec<u32>> = source.iter().map(ring).collect();
    assert_eq!(loops, rings);
    let (n, holes) = (n as usize, rings.len() - 1);
    assert_eq!(
        mesh.faces().len() + n + 2,
        2 * (mesh.source().len() + holes)
    );
    for (points, rings) in [(mesh.source(), source), (mesh.target(), target)] {
        let given: Vec<DVec2> = rings.iter().flat_map(|r| r.as_ref()).copied().collect();
        assert_eq!(points[..n], given);
        let mut twice_area = 0.0;
        for face in mesh.faces().iter() {
            let [a, b, c] = face.map(|v| points[v as usize]);
            assert!(orient2d(a, b, c) > 0.0, "{face:?}");
            twice_area += (b - a).perp_dot(c - a);
        }
        let ring = |r: &R| Ring::new(r.as_ref().to_vec()).expect("a ring");
        let area: f64 = rings.iter().map(|r| ring(r).signed_area()).sum();
        assert!(
            (0.5 * twice_area - area).abs() < 1e-9 * area,
            "{twice_area} {area}"
        );
    }
}

/// Triangulates two polygons with the same faces, checks the result and returns it.
fn together(source: &[DVec2], target: &[DVec2]) -> CompatibleMesh {
    let mesh =
        CompatibleMesh::from_piece(&[source], &[target], &PolygonOptions::default(), &Silent)
            .expect("simple polygons");
    assert_valid(&mesh, source, target);
    mesh
}

/// Builds the base mesh of two polygons, without trying a transfer first, checks it and returns it.
fn base(source: &[DVec2], target: &[DVec2]) -> PairMesh {
    let mesh = from_base(
        &BoundaryRings::of(&[source]),
        &BoundaryRings::of(&[target]),
        &Silent,
    )
    .expect("simple");
    let (faces, [p, q]) = mesh.compacted();
    assert_valid(
        &CompatibleMesh::new(faces, p, q, vec![]).expect("valid"),
        source,
        target,
    );
    mesh
}

/// Two random polygons with the same number of points; `None` unless both are simple.
fn pair(kinds: (usize, usize), n: usize, seed: u64) -> Option<[Vec<DVec2>; 2]> {
    let mut random = Random(seed);
    let source = shape(kinds.0, n, &mut random);
    let n = source.len();
    let mut target = shape(kinds.1, n, &mut random);
    let m = target.len();
    let source = with_points(source, m);
    target.rotate_left((random.next() * m as f64) as usize);
    let simple = |points| {
        boundary_rings::validate_rings(&BoundaryRings::of(&[points]), Side::Source).is_ok()
    };
    (simple(&source) && simple(&target)).then_some([source, target])
}

proptest! {
    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn any_two_polygons_at_any_shift_are_triangulated(
        kinds in (0usize..6, 0usize..6), n in 8usize..60, seed: u64,
    ) {
        let Some([source, target]) = pair(kinds, n, seed) else {
            return Err(TestCaseError::reject("not simple"));
        };
        together(&source, &target);
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn the_base_alone_never_fails(
        kinds in (0usize..6, 0usize..6), n in 8usize..60, seed: u64,
    ) {
        let Some([source, target]) = pair(kinds, n, seed) else {
            return Err(TestCaseError::reject("not simple"));
        };
        base(&source, &target);
    }
}

#[test]
fn equal_polygons_are_not_distorted() {
    for kind in 0..4 {
        let polygon = shape(kind, 40, &mut Random(7));
        let mesh = together(&polygon, &polygon);
        for (p, q) in mesh.source().iter().zip(mesh.target()) {
            assert!(p.distance(*q) < 1e-9, "{kind}: {p} {q}");
        }
    }
}

#[test]
fn the_same_input_gives_the_same_mesh() {
    let [source, target] = pair((1, 2), 40, 3).expect("simple");
    let (a, b) = (together(&source, &target), together(&source, &target));
    assert_eq!(a.faces(), b.faces());
    assert_eq!((a.source(), a.target()), (b.source(), b.target()));
}

#[test]
fn designs_exchanged_give_the_mesh_exchanged() {
    for (kinds, seed) in [((1, 2), 3), ((0, 3), 5), ((3, 2), 8)] {
        let [source, target] = pair(kinds, 40, seed).expect("simple");
        let there = together(&source, &target);
        let back = together(&target, &source);
        assert_eq!(there.faces(), back.faces());
        assert_eq!(there.source(), back.target());
        assert_eq!(there.target(), back.source());
    }
}

#[test]
fn a_shorter_edge_length_gives_shorter_edges() {
    let square = shape(5, 16, &mut Random(1));
    let fine = PolygonOptions {
        edge_length: Some(0.05),
    };
    let mesh = CompatibleMesh::from_piece(&[&square], &[&square], &fine, &Silent).expect("simple");
    assert_valid(&mesh, &square, &square);
    assert!(mesh.source().len() > 2 * together(&square, &square).source().len());
}

#[test]
fn invalid_input_is_named_in_the_error() {
    let square = shape(5, 8, &mut Random(1));
    let options = PolygonOptions::default();
    let of = |a: &[DVec2], b: &[DVec2], options| {
        CompatibleMesh::from_piece(&[a], &[b], options, &Silent).map(|_| ())
    };
    assert_eq!(
        of(&square, &square[1..], &options),
        Err(PieceMeshError::PointCounts {
            ring: 0,
            points: [8, 7]
        })
    );
    let mut nan = square.clone();
    nan[3].x = f64::NAN;
    let not_finite = PieceMeshError::NotFinite {
        side: Side::Target,
        ring: 0,
        vertex: 3,
    };
    assert_eq!(of(&square, &nan, &options), Err(not_finite));
    let reversed: Vec<DVec2> = square.iter().rev().copied().collect();
    assert_eq!(
        of(&reversed, &square, &options),
        Err(PieceMeshError::Clockwise(Side::Source))
    );
    let zero = PolygonOptions {
        edge_length: Some(0.0),
    };
    assert_eq!(
        of(&square, &square, &zero),
        Err(PieceMeshError::EdgeLength(0.0))
    );
}
