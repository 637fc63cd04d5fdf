//! Tests of the compatible triangulation of pieces with holes and slits.

use super::*;

/// Boundary rings of a piece, the outer one first.
type TestPiece = Vec<Vec<DVec2>>;

/// Random star-shaped ring with `n` points around a centre, counter-clockwise; the first point has
/// the direction `turn`, in radians.
fn ring(centre: DVec2, radius: f64, n: usize, turn: f64, random: &mut Random) -> Vec<DVec2> {
    let at = |k: usize| {
        let angle = turn + TAU * k as f64 / n as f64;
        centre + polar(radius * (0.6 + 0.4 * random.next()), angle)
    };
    (0..n).map(at).collect()
}

/// Returns the ring reversed, because holes run clockwise.
fn hole(mut ring: Vec<DVec2>) -> Vec<DVec2> {
    ring.reverse();
    ring
}

/// Regular polygon with `n` points around a centre, counter-clockwise; the first point has the
/// direction `turn`, in radians.
fn circle(centre: DVec2, radius: f64, n: usize, turn: f64) -> Vec<DVec2> {
    let at = |k: usize| centre + polar(radius, turn + TAU * k as f64 / n as f64);
    (0..n).map(at).collect()
}

/// Builds the base mesh of a piece, without trying a transfer first.
fn from_the_base(source: &TestPiece, target: &TestPiece) -> CompatibleMesh {
    let base = from_base(
        &BoundaryRings::of(source),
        &BoundaryRings::of(target),
        &Silent,
    );
    let base = base.expect("a base");
    let (faces, [p, q]) = base.compacted();
    CompatibleMesh::new(faces, p, q, vec![]).expect("valid")
}

/// Checks the complete triangulation of a piece, and its base mesh alone, in both orders of the
/// designs.
fn assert_all_ways(source: &TestPiece, target: &TestPiece) {
    let options = PolygonOptions::default();
    for (p, q) in [(source, target), (target, source)] {
        let mesh = CompatibleMesh::from_piece(p, q, &options, &Silent).expect("a piece");
        assert_valid_piece(&mesh, p, q);
        assert_valid_piece(&from_the_base(p, q), p, q);
    }
}

/// Ring-shaped piece between two circles. The points of the hole are rotated by `turn` radians
/// against those of the outline.
fn annulus(turn: f64) -> TestPiece {
    let outer = circle(DVec2::ZERO, 2.0, 24, 0.0);
    vec![outer, hole(circle(DVec2::ZERO, 1.0, 16, turn))]
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn an_annulus_whose_hole_turns() {
    for turn in [0.0, 0.5, 2.0, 3.1] {
        assert_all_ways(&annulus(0.0), &annulus(turn));
    }
}

#[test]
fn a_hole_that_closes_to_a_point() {
    let (mut p, mut q) = (annulus(0.0), annulus(0.0));
    for point in &mut q[1] {
        *point = DVec2::new(0.3, 0.2) + 1e-4 * *point;
    }
    assert_all_ways(&p, &q);
    for point in &mut p[1] {
        *point = DVec2::new(0.99, 0.0) + 0.999 * *point;
    }
    assert_all_ways(&p, &q);
}

/// Letter B, a piece with two holes. `waist` is the x coordinate of the notch between its two bows;
/// `lean` is the factor of a shear along x.
fn b(waist: f64, lean: f64) -> TestPiece {
    let outer = [
        (0.0, 0.0),
        (3.0, 0.0),
        (4.0, 1.0),
        (4.0, 2.5),
        (waist, 3.0),
        (4.0, 3.5),
        (3.5, 6.0),
        (0.0, 6.0),
        (0.0, 3.0),
    ];
    let low = [(1.0, 1.0), (1.0, 2.5), (2.5, 2.5), (3.0, 1.5), (2.5, 1.0)];
    let high = [(1.0, 3.5), (1.0, 5.0), (2.5, 5.0), (2.5, 3.5)];
    let lean = |&(x, y): &(f64, f64)| DVec2::new(x + lean * y, y);
    let rings: [&[(f64, f64)]; 3] = [&outer, &low, &high];
    rings.map(|ring| ring.iter().map(lean).collect()).to_vec()
}

#[test]
fn a_letter_with_two_holes() {
    assert_all_ways(&b(3.8, 0.0), &b(2.8, 0.4));
    let other = b(3.8, 0.0);
    let exchanged = vec![
        other[0].clone(),
        with_points(other[2].clone(), 5),
        other[1][..4].to_vec(),
    ];
    assert_all_ways(&b(3.8, 0.0), &exchanged);
}

/// Thick ring that is cut open at the point with the index `cut`, and a bent strip with the same
/// number of points.
fn d_cut_open(cut: usize) -> (TestPiece, TestPiece) {
    let m = 16;
    let at = |k: usize, r: f64| polar(r, TAU * ((cut + k) % m) as f64 / m as f64);
    let slit: Vec<DVec2> = [1.75, 1.5, 1.25].map(|r| at(0, r)).to_vec();
    let mut open: Vec<DVec2> = (0..=m).map(|k| at(k, 2.0)).collect();
    open.extend(&slit);
    open.extend((0..=m).rev().map(|k| at(k, 1.0)));
    open.extend(slit.iter().rev());
    let across = |share: f64, side: f64| {
        let x = TAU * share;
        DVec2::new(x, 2.0 * x.sin() + side)
    };
    let mut strip: Vec<DVec2> = (0..=m).map(|k| across(k as f64 / m as f64, -0.5)).collect();
    strip.extend([-0.25, 0.0, 0.25].map(|side| across(1.0, side)));
    strip.extend((0..=m).rev().map(|k| across(k as f64 / m as f64, 0.5)));
    strip.extend([0.25, 0.0, -0.25].map(|side| across(0.0, side)));
    (vec![open], vec![strip])
}

#[test]
fn a_ring_cut_open_becomes_a_strip() {
    for cut in [0, 5] {
        let (d, s) = d_cut_open(cut);
        assert_all_ways(&d, &s);
        assert_all_ways(&d, &d_cut_open(cut + 3).0);
    }
}

#[test]
fn a_slit_with_an_end_inside_opens_to_a_notch() {
    let slit = [
        (0.0, 0.0),
        (4.0, 0.0),
        (4.0, 4.0),
        (2.0, 4.0),
        (2.0, 3.0),
        (2.0, 2.0),
        (2.0, 3.0),
        (2.0, 4.0),
        (0.0, 4.0),
    ];
    let mut notch = slit;
    notch[3].0 = 3.0;
    notch[4].0 = 2.5;
    let piece = |points: [(f64, f64); 9]| vec![points.map(DVec2::from).to_vec()];
    assert_all_ways(&piece(slit), &piece(notch));
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_hole_close_to_the_boundary() {
    let near = |x: f64| {
        let outer = with_points(circle(DVec2::ZERO, 2.0, 12, 0.0), 40);
        vec![outer, hole(circle(DVec2::new(x, 0.0), 0.5, 12, 0.0))]
    };
    for gap in [1e-2, 1e-4, 1e-7] {
        assert_all_ways(&near(0.0), &near(1.5 - gap));
        assert_all_ways(&near(gap - 1.4), &near(1.5 - gap));
    }
}

fn random_piece(counts: &[usize], random: &mut Random) -> TestPiece {
    let outer = ring(DVec2::ZERO, 4.0, counts[0], 0.0, random);
    // Holes around these places lie inside the outline, whose distance from the centre is at least
    // 0.6 · 4 cos(π/n).
    let places = [(0.0, 0.0), (1.2, 0.0), (0.0, 1.2), (-0.9, -0.9)];
    let mut rings = vec![outer];
    let first = (4.0 * random.next()) as usize;
    for (k, &n) in counts[1..].iter().enumerate() {
        let place = DVec2::from(places[(first + k) % 4]);
        let size = 10f64.powf(-3.0 * random.next());
        rings.push(hole(ring(
            place,
            0.5 * size,
            n,
            6.0 * random.next(),
            random,
        )));
    }
    rings
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn stars_with_star_shaped_holes(
        counts in prop::collection::vec(8usize..24, 2..5), seed: u64,
    ) {
        let mut random = Random(seed);
        let (p, q) = (random_piece(&counts, &mut random), random_piece(&counts, &mut random));
        assert_all_ways(&p, &q);
    }
}

#[test]
fn holes_without_a_partner_are_named() {
    let options = PolygonOptions::default();
    let of = |p: &[Vec<DVec2>], q: &[Vec<DVec2>]| {
        CompatibleMesh::from_piece(p, q, &options, &Silent).map(|_| ())
    };
    let ring = annulus(0.0);
    assert_eq!(
        of(&ring, &ring[..1]),
        Err(PieceMeshError::RingCounts([2, 1]))
    );
    assert_eq!(of(&[], &[]), Err(PieceMeshError::NoOutline));
    let fewer = vec![ring[0].clone(), ring[1][1..].to_vec()];
    let counts = PieceMeshError::PointCounts {
        ring: 1,
        points: [16, 15],
    };
    assert_eq!(of(&ring, &fewer), Err(counts));
}
