//! Tests of the match of whole designs: parts, holes, cuts, pins, links and notes.

use super::*;
use crate::correspondence::{HoleRule, PairError, PartRule, PointPair, RingCut, UnmatchedPart};
use crate::geometry::{Bounds, DVec2, FillRule, Ring, Side};
use crate::work::progress::Silent;

fn block(x: f64, y: f64, w: f64, h: f64) -> Vec<DVec2> {
    [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
        .map(DVec2::from)
        .to_vec()
}

fn design(rings: &[Vec<DVec2>]) -> Regions {
    Regions::from_rings(rings, FillRule::EvenOdd).expect("area")
}

/// Returns a plate with square holes at the given places.
fn plate(holes: &[(f64, f64)]) -> Regions {
    let mut rings = vec![block(0.0, 0.0, 10.0, 6.0)];
    rings.extend(holes.iter().map(|&(x, y)| block(x, y, 1.5, 1.5)));
    design(&rings)
}

/// Matches two designs and checks that corresponding rings have the same number of vertices.
fn run(a: &Regions, b: &Regions, settings: &MatchSettings) -> RegionMatch {
    let matched = match_regions(a, b, settings, &Silent).expect("matched");
    for piece in &matched.pieces {
        for ring in &piece.rings {
            assert_eq!(ring.source.len(), ring.target.len());
        }
    }
    matched
}

fn area(points: &[DVec2]) -> f64 {
    Ring::new(points.to_vec()).expect("a ring").signed_area()
}

fn kinds(piece: &PieceMatch) -> Vec<RingKind> {
    piece.rings.iter().map(|ring| ring.kind).collect()
}

#[test]
fn closing_holes_keep_apart_from_each_other() {
    // In a grid of 5 × 5 holes, the centre of the plate suits the middle hole best. However, the
    // first hole already closes there, because it finds little space near its own place.
    let places = (0..25).map(|k| (f64::from(k % 5), f64::from(k / 5)));
    let holes = places.map(|(x, y)| block(2.0 * x + 0.5, 2.0 * y + 0.5, 1.0, 1.0));
    let rings: Vec<_> = [block(0.0, 0.0, 10.0, 10.0)]
        .into_iter()
        .chain(holes)
        .collect();
    let (full, bare) = (design(&rings), design(&rings[..1]));
    let settings = MatchSettings {
        holes: HoleRule::Close,
        ..MatchSettings::default()
    };
    for (matched, side) in [
        (run(&full, &bare, &settings), Side::Target),
        (run(&bare, &full, &settings), Side::Source),
    ] {
        let points = |ring: &RingMatch| Bounds::of([&ring.source, &ring.target][side].clone());
        let closed = matched.pieces[0].rings[1..].iter().filter_map(points);
        let closed: Vec<Bounds> = closed.collect();
        assert_eq!(closed.len(), 25);
        for (i, a) in closed.iter().enumerate() {
            assert!(a.diameter() > 1e-4 && bare.contains(a.centre()));
            let apart = |b: &Bounds| a.centre().distance(b.centre());
            let nearest = closed[..i].iter().map(apart).fold(f64::INFINITY, f64::min);
            assert!(nearest > 2.0 * a.diameter(), "{a:?}");
        }
    }
}

#[test]
fn equal_holes_are_matched_and_unmatched_ones_close() {
    let settings = MatchSettings {
        holes: HoleRule::Close,
        ..MatchSettings::default()
    };
    let (two, one) = (plate(&[(1.0, 2.0), (7.0, 2.0)]), plate(&[(7.0, 2.5)]));
    let matched = run(&two, &one, &settings);
    let piece = &matched.pieces[0];
    assert_eq!(
        kinds(piece),
        [RingKind::Matched, RingKind::Matched, RingKind::Closes]
    );
    let point = &piece.rings[2].target;
    assert!(area(point) < 0.0 && area(point) > -1e-5);
    assert!((point[0] - DVec2::new(1.75, 2.75)).length() < 1.0);
    let back = run(&one, &two, &settings);
    assert_eq!(
        kinds(&back.pieces[0]),
        [RingKind::Matched, RingKind::Matched, RingKind::Opens]
    );
}

#[test]
fn a_cut_open_ring_keeps_its_area_and_follows_its_slit_twice() {
    let ring = design(&[block(-3.0, -3.0, 6.0, 6.0), block(-2.0, -2.0, 4.0, 4.0)]);
    let strip = design(&[block(0.0, 0.0, 20.0, 1.0)]);
    let settings = MatchSettings {
        holes: HoleRule::Cut,
        ..MatchSettings::default()
    };
    let matched = run(&ring, &strip, &settings);
    let piece = &matched.pieces[0];
    assert_eq!((piece.rings.len(), piece.cuts.len()), (1, 1));
    let outline = &piece.rings[0];
    assert!((area(&outline.source) - 20.0).abs() < 1e-9);
    assert!((area(&outline.target) - 20.0).abs() < 1e-9);
    let n = outline.source.len();
    let edges: Vec<[DVec2; 2]> = (0..n)
        .map(|k| [outline.source[k], outline.source[(k + 1) % n]])
        .collect();
    let cut = piece.cuts[0];
    let on_slit = |p: DVec2| {
        let (a, b) = (cut.outer, cut.hole);
        (p - a).perp_dot(b - a).abs() < 1e-9 && (p - a).dot(b - a) > -1e-9
    };
    let slit: Vec<_> = edges
        .iter()
        .filter(|e| e.iter().all(|p| on_slit(*p)))
        .collect();
    assert!(slit.len() >= 2);
    for [a, b] in slit {
        assert!(edges.contains(&[*b, *a]), "{a} {b}");
    }
}

#[test]
fn a_requested_cut_is_made_where_requested() {
    let ring = design(&[block(-3.0, -3.0, 6.0, 6.0), block(-2.0, -2.0, 4.0, 4.0)]);
    let strip = design(&[block(0.0, 0.0, 20.0, 1.0)]);
    let mut settings = MatchSettings::default();
    settings.cuts.push(RingCut {
        side: Side::Source,
        outer: DVec2::new(1.0, 3.4),
        hole: DVec2::new(1.2, 1.9),
    });
    let piece = &run(&ring, &strip, &settings).pieces[0];
    assert_eq!(piece.cuts[0].outer, DVec2::new(1.0, 3.0));
    assert!(piece.cuts[0].hole.distance(DVec2::new(1.2, 2.0)) < 1e-12);
    settings.cuts[0].outer = DVec2::new(1.0, -3.0);
    let error = match_regions(&ring, &strip, &settings, &Silent).expect_err("through the hole");
    assert_eq!(error, RegionMatchError::Cut(0));
}

#[test]
fn a_single_part_is_split_and_an_extra_part_among_several_appears() {
    let one = design(&[block(0.0, 0.0, 9.0, 1.0)]);
    let three = design(&[
        block(0.0, 0.0, 2.0, 1.0),
        block(4.0, 0.0, 2.0, 1.0),
        block(8.0, 0.0, 2.0, 1.0),
    ]);
    let two = design(&[block(0.0, 0.0, 2.0, 1.0), block(4.0, 0.0, 2.0, 1.0)]);
    let split = run(&one, &three, &MatchSettings::default());
    assert_eq!(split.pieces.len(), 3);
    let whole: f64 = split.pieces.iter().map(|p| area(&p.rings[0].source)).sum();
    assert!((whole - 9.0).abs() < 1e-9);
    for piece in &split.pieces {
        assert!((area(&piece.rings[0].source) - 3.0).abs() < 0.7);
    }
    let with_extra = run(&two, &three, &MatchSettings::default());
    let appearing: Vec<_> = with_extra
        .pieces
        .iter()
        .filter(|p| p.source_part.is_none())
        .collect();
    assert_eq!((with_extra.pieces.len(), appearing.len()), (3, 1));
    let settings = MatchSettings {
        parts: PartRule::Transient,
        ..MatchSettings::default()
    };
    assert_eq!(run(&one, &three, &settings).pieces.len(), 3);
}

#[test]
fn a_part_is_not_split_for_a_tiny_mark() {
    let one = design(&[block(0.0, 0.0, 9.0, 1.0)]);
    let marked = design(&[block(0.0, 0.0, 9.0, 1.0), block(9.2, 0.9, 0.08, 0.08)]);
    let appearing_count = |parts: PartRule| {
        let settings = MatchSettings {
            parts,
            ..MatchSettings::default()
        };
        let pieces = run(&one, &marked, &settings).pieces;
        pieces.iter().filter(|p| p.source_part.is_none()).count()
    };
    assert_eq!(
        [PartRule::Auto, PartRule::Split].map(appearing_count),
        [1, 0]
    );
}

#[test]
fn pins_and_links_pair_their_parts() {
    let two = design(&[block(0.0, 0.0, 2.0, 1.0), block(4.0, 0.0, 2.0, 1.0)]);
    let mut settings = MatchSettings::default();
    settings.links.push(PointPair {
        source: DVec2::new(1.0, 0.5),
        target: DVec2::new(5.0, 0.5),
    });
    let parts = |matched: &RegionMatch| -> Vec<_> {
        let both = |p: &PieceMatch| [p.source_part, p.target_part];
        matched.pieces.iter().map(both).collect()
    };
    let crossed = run(&two, &two, &settings);
    for [a, b] in parts(&crossed) {
        assert_ne!(a, b);
    }
    let pinned = MatchSettings {
        pins: settings.links.drain(..).collect(),
        ..MatchSettings::default()
    };
    assert_eq!(parts(&run(&two, &two, &pinned)), parts(&crossed));
}

#[test]
fn the_error_for_contradictory_links_names_the_part_that_they_share() {
    let three = design(&[0.0, 4.0, 8.0].map(|x| block(x, 0.0, 2.0, 1.0)));
    let centre = |part: f64| DVec2::new(4.0 * part + 1.0, 0.5);
    let error = |links: [[f64; 2]; 2]| {
        let settings = MatchSettings {
            parts: PartRule::Transient,
            links: (links.into_iter())
                .map(|[source, target]| PointPair {
                    source: centre(source),
                    target: centre(target),
                })
                .collect(),
            ..MatchSettings::default()
        };
        match_regions(&three, &three, &settings, &Silent).err()
    };
    let twice = Some(RegionMatchError::Pairs(PairError::Twice(2)));
    assert_eq!(error([[0.0, 2.0], [1.0, 2.0]]), twice);
    assert_eq!(error([[2.0, 0.0], [2.0, 1.0]]), twice);
}

#[test]
fn parts_declared_unmatched_stay_unmatched_unless_linked() {
    let two = design(&[block(0.0, 0.0, 2.0, 1.0), block(4.0, 0.0, 2.0, 1.0)]);
    let one = design(&[block(0.0, 0.0, 2.0, 1.0)]);
    let parts = |a: &Regions, b: &Regions, settings: &MatchSettings| -> Vec<_> {
        let both = |p: &PieceMatch| [p.source_part, p.target_part];
        run(a, b, settings).pieces.iter().map(both).collect()
    };
    let at = DVec2::new(1.0, 0.5);
    let mut settings = MatchSettings::default();
    for side in Side::BOTH {
        settings.lone.push(UnmatchedPart { side, at });
    }
    // The single part is declared unmatched, so it is not split for the parts of the other design.
    let found = parts(&two, &one, &settings);
    assert_eq!(found, [[Some(0), None], [Some(1), None], [None, Some(0)]]);
    let found = parts(&two, &two, &settings);
    assert_eq!(
        found,
        [[Some(0), None], [Some(1), Some(1)], [None, Some(0)]]
    );
    settings.links.push(PointPair {
        source: at,
        target: at,
    });
    let found = parts(&two, &two, &settings);
    assert_eq!(found, [[Some(0), Some(0)], [Some(1), Some(1)]]);
    let swapped = settings.swapped().lone;
    assert_eq!(
        swapped
            .iter()
            .map(|lone| lone.side.index())
            .collect::<Vec<_>>(),
        [1, 0]
    );
}

#[test]
fn contradictory_pins_are_named_by_their_index_among_all_pins() {
    let two = design(&[block(0.0, 0.0, 2.0, 1.0), block(4.0, 0.0, 2.0, 1.0)]);
    let pin = |a: (f64, f64), b: (f64, f64)| PointPair {
        source: a.into(),
        target: b.into(),
    };
    let settings = MatchSettings {
        pins: vec![
            pin((0.0, 0.0), (0.0, 0.0)),
            pin((4.0, 0.0), (4.0, 0.0)),
            pin((5.0, 0.0), (6.0, 1.0)),
            pin((6.0, 1.0), (5.0, 0.0)),
        ],
        ..MatchSettings::default()
    };
    let error = match_regions(&two, &two, &settings, &Silent).expect_err("crossing");
    assert!(matches!(error, RegionMatchError::Pins(_)), "{error}");
    assert!(
        error.to_string().contains('4') || error.to_string().contains('3'),
        "{error}"
    );
}

#[test]
fn a_hole_that_no_straight_cut_reaches_closes_and_is_reported() {
    // A small hole, and a hole that winds around it.
    let winding = [
        (5.25, 13.0),
        (5.25, 5.25),
        (14.75, 5.25),
        (14.75, 14.75),
        (3.25, 14.75),
        (3.25, 8.0),
        (2.75, 8.0),
        (2.75, 15.25),
        (15.25, 15.25),
        (15.25, 4.75),
        (4.75, 4.75),
        (4.75, 13.0),
    ];
    let winding = winding.map(DVec2::from).to_vec();
    let plate = block(0.0, 0.0, 20.0, 20.0);
    let source = design(&[plate.clone(), winding.clone(), block(9.0, 9.0, 2.0, 2.0)]);
    let target = design(&[plate, winding]);
    let mut settings = MatchSettings {
        holes: HoleRule::Cut,
        ..MatchSettings::default()
    };
    let uncut = |matched: &RegionMatch| {
        let notes: Vec<MatchNote> = matched.notes().copied().collect();
        assert!(matched.pieces[0].cuts.is_empty());
        assert!(matches!(
            notes[0],
            MatchNote::Uncut {
                side: Side::Source,
                part: 0,
                ..
            }
        ));
        notes[1..].to_vec()
    };
    assert_eq!(uncut(&run(&source, &target, &settings)), []);
    settings.pins.push(PointPair {
        source: DVec2::new(9.0, 9.0),
        target: DVec2::ZERO,
    });
    let notes = uncut(&run(&source, &target, &settings));
    assert_eq!(notes, [MatchNote::PinLeftOut(0)]);
}

#[test]
fn transient_holes_are_excluded_from_the_piece() {
    let (two, one) = (plate(&[(1.0, 2.0), (7.0, 2.0)]), plate(&[(1.0, 2.0)]));
    let settings = MatchSettings {
        holes: HoleRule::Transient,
        ..MatchSettings::default()
    };
    for (matched, side) in [
        (run(&two, &one, &settings), Side::Source),
        (run(&one, &two, &settings), Side::Target),
    ] {
        let piece = &matched.pieces[0];
        assert_eq!(kinds(piece), [RingKind::Matched; 2]);
        let [lone] = &piece.lone[..] else {
            panic!("{:?}", piece.lone);
        };
        let (whole, points) = lone.transient_side().expect("not matched");
        assert_eq!(whole, side);
        assert!((area(points) + 2.25).abs() < 1e-9, "clockwise");
        assert!(points.iter().all(|p| (7.0..=8.5).contains(&p.x)));
    }
}

#[test]
fn unpaired_holes_are_all_excluded_from_the_piece() {
    let (two, one) = (plate(&[(1.0, 2.0), (7.0, 2.0)]), plate(&[(1.0, 2.0)]));
    let settings = MatchSettings::default();
    let no_looks = PartAppearances::default();
    let plan = MatchPlan::new([&two, &one], &no_looks, &settings, &Silent).expect("prepared");
    let options = settings.options();
    let pieces = plan.match_group(0, &options, HolePolicy::Unpaired, &Silent);
    let pieces = pieces.expect("matched");
    assert_eq!((pieces[0].rings.len(), pieces[0].lone.len()), (1, 3));
}
