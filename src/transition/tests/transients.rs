//! Tests of unmatched holes and parts, of drafts, and of the note on mirrored designs.

use super::*;
use crate::content::Content;
use crate::correspondence::UnmatchedPart;
use crate::geometry::{RingEdge, Side, winding};

/// Returns a plate with `holes` holes in a row.
fn perforated(holes: u32) -> Arc<Design> {
    let hole = |k: u32| format!("M{} 40v20h10v-20z", 15 + 15 * k);
    let holes: String = (0..holes).map(hole).collect();
    svg(&format!("M5 20h90v60h-90z {holes}"))
}

/// Returns the signed areas of rings in ascending order.
fn sorted(rings: &[Vec<DVec2>]) -> Vec<f64> {
    let mut areas: Vec<f64> = rings
        .iter()
        .map(|r| area(std::slice::from_ref(r)))
        .collect();
    areas.sort_by(f64::total_cmp);
    areas
}

#[test]
fn unmatched_holes_shrink_in_place() {
    let mut spec = TransitionSpec::new(perforated(5), perforated(0));
    spec.options.matching.holes = HoleRule::Transient;
    let transition = Transition::build(&spec, &Silent).unwrap();
    let mut frame = transition.frame(0.0);
    for (t, expected) in [(0.0, -200.0), (2.0 / 3.0, -50.0)] {
        frame.seek(t);
        let areas = sorted(&frame.figure().rings);
        assert_eq!(areas.len(), 6);
        assert!((areas[0] - expected).abs() < 1e-9, "{t}: {areas:?}");
        assert!((areas[5] - 5400.0).abs() < 1e-9);
    }
    frame.seek(1.0);
    let last = sorted(&frame.figure().rings);
    assert!(
        last.len() == 1 && (last[0] - 5400.0).abs() < 1e-9,
        "{last:?}"
    );
    // Beyond t = 1 the holes stay as they are at t = 1.
    frame.seek(1.5);
    assert_eq!(frame.figure().rings.len(), 1);
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn exchanging_the_designs_keeps_the_times_of_holes() {
    let (a, b) = (
        perforated(4),
        svg("M10 10L90 30L70 95L20 80z M40 40v20h20v-20z"),
    );
    let rings = |source: &Arc<Design>, target: &Arc<Design>| -> Vec<Vec<f64>> {
        let spec = TransitionSpec::new(Arc::clone(source), Arc::clone(target));
        let transition = Transition::build(&spec, &Silent).unwrap();
        let at = |k: u32| sorted(&transition.frame(f64::from(k) / 8.0).figure().rings);
        (0..=8).map(at).collect()
    };
    let (there, mut back) = (rings(&a, &b), rings(&b, &a));
    back.reverse();
    for (there, back) in there.iter().zip(&back) {
        assert_eq!(there.len(), back.len());
        for (p, q) in there.iter().zip(back) {
            assert!((p - q).abs() < 1e-6 * (1.0 + p.abs()), "{p} {q}");
        }
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn an_unmatched_hole_crosses_nothing() {
    let frame = svg("M10 10h80v80h-80z M20 20v60h60v-60z");
    let bend = svg("M10 10h80v20h-60v60h-20z");
    assert_eq!(
        [max_crossings(&frame, &bend), max_crossings(&bend, &frame)],
        [0, 0]
    );
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_hole_makes_way_for_one_inside_it() {
    // As long as the large hole exists, the small one would cross it, whatever its time window.
    let window = svg("M5 20h90v60h-90z M20 30v40h60v-40z");
    let dot = svg("M5 20h90v60h-90z M45 45v10h10v-10z");
    for (a, b) in [(&window, &dot), (&dot, &window)] {
        let mut spec = TransitionSpec::new(Arc::clone(a), Arc::clone(b));
        spec.options.matching.holes = HoleRule::Transient;
        let transition = Transition::build(&spec, &Silent).unwrap();
        let mut frame = transition.frame(0.0);
        let (mut crossings, mut max_ring_count) = (0, 0);
        for step in 0..=512 {
            frame.seek(f64::from(step) / 512.0);
            let rings = &frame.figure().rings;
            crossings += count_crossings(rings);
            max_ring_count = max_ring_count.max(rings.len());
        }
        assert_eq!((crossings, max_ring_count), (0, 2), "one after the other");
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_draft_has_the_same_ends_as_the_best_match() {
    let (a, b) = (svg("M10 10h80v80h-80z"), svg("M50 20L80 80H20z"));
    let spec = TransitionSpec::new(a, b);
    let draft = spec.draft(&Silent).unwrap();
    assert!(draft.draft(&Silent).is_none(), "a draft of a draft");
    let [best, draft] = [&spec, &draft].map(|spec| Transition::build(spec, &Silent).unwrap());
    for t in [0.0, 1.0] {
        let [best, draft] =
            [&best, &draft].map(|transition| area(&transition.frame(t).figure().rings));
        assert!((best - draft).abs() < 1e-9 * best, "{best} {draft}");
    }
    let given = TransitionSpec::new(design(SQUARE), design(SQUARE));
    assert!(given.draft(&Silent).is_none());
    let mut field = spec;
    field.method = TransitionMethod::FIELD_BLEND;
    assert!(field.draft(&Silent).is_none());
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn designs_that_would_match_better_mirrored_give_a_note() {
    // Two spirals of opposite handedness.
    let spring = "M10 10H90V90H20V40H60V70H40V60H50V50H30V80H80V20H10Z";
    let over = "M90 10H10V90H80V40H40V70H60V60H50V50H70V80H20V20H90Z";
    let notes = |source: &str, target: &str| {
        let spec = TransitionSpec::new(svg(source), svg(target));
        let transition = Transition::build(&spec, &Silent).unwrap();
        transition.notes().to_vec()
    };
    let mirror_notes = notes(spring, over);
    assert!(
        matches!(mirror_notes[..], [TransitionNote::Mirrored { .. }]),
        "{mirror_notes:?}"
    );
    let star = "M50 5L60 40H95L67 60 78 95 50 73 22 95 33 60 5 40H40z";
    for (source, target) in [(spring, spring), (spring, star)] {
        assert_eq!(notes(source, target), []);
    }
}

/// Returns the number of swelling parts, which grow in thickness within their outline.
fn swelling(transition: &Transition) -> usize {
    match transition.content() {
        Content::Solid(solid) => solid.swelling_shapes.len(),
        _ => 0,
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_ring_around_other_parts_appears_as_a_line_that_thickens() {
    let bars = svg("M32 30h12v40h-12z M56 30h12v40h-12z");
    let badge = svg(
        "M32 30h12v40h-12z M56 30h12v40h-12z M50 2a48 48 0 0 1 0 96a48 48 0 0 1 0-96 M50 12a38 38 0 0 0 0 76a38 38 0 0 0 0-76",
    );
    let build = |source: &Arc<Design>, target: &Arc<Design>| {
        let spec = TransitionSpec::new(Arc::clone(source), Arc::clone(target));
        Transition::build(&spec, &Silent).unwrap()
    };
    let (there, back) = (build(&bars, &badge), build(&badge, &bars));
    assert_eq!([swelling(&there), swelling(&back)], [1, 1]);
    let mut before = 0.0;
    for k in 0..=64 {
        let t = f64::from(k) / 64.0;
        let frame = there.frame(t);
        let rings = frame.figure().rings;
        assert_eq!(count_crossings(&rings), 0, "{t}");
        // For an edge of every ring, the face on which it lies must be found: reports of crossings
        // need it.
        if let Content::Solid(solid) = there.content() {
            let places = &frame.placement().in_frame;
            for ring in 0..solid.rings_at(places, t).len() {
                let edge = RingEdge { ring, point: 0 };
                assert!(
                    solid.face_vertices_at(edge, places, t).is_some(),
                    "{t}: {ring}"
                );
            }
        }
        let now = area(&rings);
        // The area only increases, as the ring grows.
        assert!(now >= before - 1e-6, "{t}: {now} after {before}");
        assert!((area(&back.frame(1.0 - t).figure().rings) - now).abs() < 1e-6);
        before = now;
    }
    let drawn = badge.outline(0.0).unwrap();
    let expected: f64 = drawn.rings().map(|ring| ring.signed_area()).sum();
    assert!((before - expected).abs() < 1e-6 * expected);
}

#[test]
fn designs_without_any_matched_part_are_interpolated() {
    let (a, b) = (svg("M10 10h30v30h-30z"), svg("M50 40h40v40h-40z"));
    let mut spec = TransitionSpec::new(a, b);
    let matching = &mut spec.options.matching;
    for side in Side::BOTH {
        let at = DVec2::new(60.0, 50.0);
        matching.lone.push(UnmatchedPart { side, at });
    }
    let transition = Transition::build(&spec, &Silent).unwrap();
    let mut frame = transition.frame(0.0);
    // At t = 0 and t = 1, the square that is absent is a seed shape of negligible area.
    for (t, expected) in [(0.0, 900.0), (1.0, 1600.0)] {
        frame.seek(t);
        let found = area(&frame.figure().rings);
        assert!((found - expected).abs() < 1e-3, "{t}: {found}");
    }
    frame.seek(0.5);
    assert!(area(&frame.figure().rings).is_finite());
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn nothing_appears_inside_a_disappearing_part() {
    // Each square alone could appear or disappear in place; together they would overlap.
    let one = svg("M10 10h30v80h-30z M62 42h16v16h-16z");
    let two = svg("M10 10h30v80h-30z M55 35h30v30h-30z");
    for (source, target) in [(&one, &two), (&two, &one)] {
        let mut spec = TransitionSpec::new(Arc::clone(source), Arc::clone(target));
        for side in Side::BOTH {
            let at = DVec2::new(70.0, 50.0);
            spec.options.matching.lone.push(UnmatchedPart { side, at });
        }
        let transition = Transition::build(&spec, &Silent).unwrap();
        let mut frame = transition.frame(0.0);
        for step in 1..1024 {
            frame.seek(f64::from(step) / 1024.0);
            let rings = &frame.figure().rings;
            assert_eq!(count_crossings(rings), 0, "{step}");
            let lie_in_another = rings.iter().filter(|ring| {
                let others = rings.iter().filter(|other| *other != *ring);
                others.map(|other| winding(other, ring[0])).sum::<i32>() != 0
            });
            assert_eq!(lie_in_another.count(), 0, "{step}");
        }
    }
}

#[test]
fn absent_parts_are_not_drawn() {
    let (one, two) = (
        svg("M10 10h40v40h-40z"),
        svg("M10 10h40v40h-40z M60 60h20v20h-20z"),
    );
    for (source, target, expected) in [(&one, &two, [1, 2]), (&two, &one, [2, 1])] {
        let mut spec = TransitionSpec::new(Arc::clone(source), Arc::clone(target));
        spec.options.matching.parts = PartRule::Transient;
        let transition = Transition::build(&spec, &Silent).unwrap();
        let rings = |t: f64| transition.frame(t).figure().rings.len();
        assert_eq!([rings(0.0), rings(1.0)], expected);
        // Outside [0, 1], the same parts exist as at the nearer of t = 0 and t = 1.
        assert_eq!([rings(-0.2), rings(1.2)], expected);
        assert_eq!(rings(0.5), 2);
    }
}

#[test]
fn holes_that_touch_in_a_corner_are_matched_like_others() {
    let source = design(
        "{\"rings\": [[[0,0],[200,0],[200,250],[0,250]], [[30,30],[20,120],[90,150]], \
         [[90,210],[20,120],[70,220]], [[200,100],[150,80],[150,120]]]}",
    );
    let target = design(
        "{\"rings\": [[[0,0],[220,20],[180,240],[20,230]], [[40,40],[100,40],[70,90]], \
         [[60,140],[120,150],[80,200]], [[140,90],[170,120],[150,150]]]}",
    );
    let spec = TransitionSpec::new(source, target);
    let transition = Transition::build(&spec, &Silent).unwrap();
    let pieces = &transition.matched().unwrap().pieces;
    assert_eq!((pieces.len(), pieces[0].rings.len()), (1, 4));
    for k in 0..=8 {
        let rings = transition.frame(f64::from(k) / 8.0).figure().rings;
        assert_eq!((rings.len(), count_crossings(&rings)), (4, 0), "{k}");
    }
    assert!((area(&transition.frame(0.0).figure().rings) / 44_450.0 - 1.0).abs() < 1e-6);
}
