//! Tests of the check on films with known defects, one for each cause.

use super::cause;
use super::cause::CauseSearch;
use super::*;
use crate::content::BlendSpace;
use crate::content::Content;
use crate::design::{ImportOptions, import};
use crate::field::Metric;
use crate::geometry::{DMat2, DVec2};
use crate::measure::film_report;
use crate::measure::tests::{sheet, transition};
use crate::transition::{Transition, TransitionNote, TransitionOptions, TransitionSpec};
use crate::warp::ArapOptions;
use crate::warp::homotopy::Homotopy;
use crate::work::progress::Silent;
use std::f64::consts::PI;
use std::sync::Arc;

/// Number of t at which a film is checked.
const STEPS: usize = 65;

/// Difference between two consecutive sampled t.
const STEP: f64 = 1.0 / 64.0;

fn verdict(transition: &Transition) -> Verdict {
    let verdict = Verdict::of(transition, STEPS, &Silent).expect("not cancelled");
    let report = film_report(transition, STEPS, &Silent).expect("not cancelled");
    let of_film = Verdict::of_film(transition, &report, &Silent).expect("not cancelled");
    assert_eq!(verdict, of_film, "both constructors agree");
    verdict
}

fn options_with(homotopy: Homotopy) -> ArapOptions {
    ArapOptions {
        homotopy,
        ..ArapOptions::default()
    }
}

/// A sheet that rotates by half a turn and becomes three times as high. With the linear homotopy,
/// the linear map M(t) of each face has det M(t) = (1−2t)(1−4t).
fn half_turn(homotopy: Homotopy) -> Transition {
    let (faces, source) = sheet(4, 2);
    let map = DMat2::from_angle(PI) * DMat2::from_diagonal(DVec2::new(1.0, 3.0));
    let target: Vec<_> = source.iter().map(|&p| map * p).collect();
    transition(&faces, &source, &target, options_with(homotopy))
}

#[test]
fn straight_paths_fold_where_the_determinant_is_negative() {
    let result = verdict(&half_turn(Homotopy::Linear));
    let finding = &result.findings[0];
    assert!(matches!(&finding.trouble, FindingKind::Folds { faces } if faces.len() == 16));
    let [first, last] = finding.span;
    assert!((first - 0.25).abs() <= STEP && (last - 0.5).abs() <= STEP);
    assert!((finding.t - 0.375).abs() <= STEP, "{}", finding.t);
    assert!(
        matches!(finding.cause, FindingCause::StraightPaths { turn, .. } if (turn.abs() - PI).abs() < 1e-9)
    );
    let Remedy::Change {
        change,
        left: 0,
        of: 16,
    } = &finding.remedy
    else {
        panic!("{:?}", finding.remedy);
    };
    assert_eq!(*change, SettingChange::Homotopy(Homotopy::Polar));
    assert_eq!(finding.headline(), "16 faces fold near t = 0.38");
    assert!(result.headline().starts_with("16 faces fold near t = 0.38"));
    assert!(finding.cause.to_string().contains("180°"));
    // Applying the suggested change really removes the defects.
    assert!(verdict(&half_turn(Homotopy::Polar)).is_clear());
}

/// Two triangles joined at one vertex. Source and target are equal, except for `extra_turns` full
/// turns of each triangle.
fn hinge(extra_turns: Vec<i32>) -> Transition {
    let points = [
        (0.0, 0.0),
        (3.0, -1.0),
        (3.0, 1.0),
        (-2.0, 1.0),
        (-2.0, -1.0),
    ];
    let points = points.map(DVec2::from);
    let options = ArapOptions {
        extra_turns,
        ..ArapOptions::default()
    };
    transition(&[[0, 1, 2], [0, 3, 4]], &points, &points, options)
}

#[test]
fn a_part_that_rotates_too_far_is_rotated_the_other_way() {
    assert!(verdict(&hinge(vec![])).is_clear());
    for turns in [1, -1] {
        let result = verdict(&hinge(vec![0, turns]));
        let finding = &result.findings[0];
        assert!(
            matches!(finding.trouble, FindingKind::Crossings { .. }),
            "{result:?}"
        );
        let FindingCause::FarTurn {
            part: Some(1),
            turn,
        } = finding.cause
        else {
            panic!("{:?}", finding.cause);
        };
        assert!((turn - 2.0 * PI * f64::from(turns)).abs() < 1e-9);
        let Remedy::Change {
            change, left: 0, ..
        } = &finding.remedy
        else {
            panic!("{:?}", finding.remedy);
        };
        assert_eq!(*change, SettingChange::ExtraTurns(vec![0, 0]));
        assert!(result.headline().starts_with("the boundary crosses itself"));
        assert!(finding.place.length() < 4.0);
    }
}

/// Vertices of a thin band of length 1 whose curvature changes linearly from `begin` to `end`, in
/// full turns per unit of length.
fn band(begin: f64, end: f64) -> Vec<DVec2> {
    /// Number of quads along the band.
    const SEGMENTS: u32 = 60;
    let (mut angle, mut at) = (0.0_f64, DVec2::ZERO);
    let mut rows = [Vec::new(), Vec::new()];
    for i in 0..=SEGMENTS {
        let s = f64::from(i) / f64::from(SEGMENTS);
        for (row, side) in rows.iter_mut().zip([-1.0, 1.0]) {
            row.push(at + 0.004 * side * DVec2::from_angle(angle).perp());
        }
        angle += 2.0 * PI * (begin + (end - begin) * s) / f64::from(SEGMENTS);
        at += DVec2::from_angle(angle) / f64::from(SEGMENTS);
    }
    rows.concat()
}

/// A spiral band that is coiled at one end in the source and at the other end in the target. In
/// between it is a circle, traced more than once.
fn recoiled() -> Transition {
    let (faces, _) = sheet(60, 1);
    let (source, target) = (band(0.2, 2.6), band(2.6, 0.2));
    transition(&faces, &source, &target, ArapOptions::default())
}

#[test]
fn colliding_places_are_reported_with_both_rotations() {
    let transition = recoiled();
    let result = verdict(&transition);
    let finding = &result.findings[0];
    let FindingKind::Crossings { crossings } = &finding.trouble else {
        panic!("{result:?}");
    };
    assert_eq!(finding.place, crossings[0].place);
    assert!((finding.t - 0.5).abs() < 0.25, "{}", finding.t);
    let FindingCause::PlacesMeet { turns: [a, b], .. } = finding.cause else {
        panic!("{:?}", finding.cause);
    };
    assert!((a - b).abs() > 0.5, "{a} {b}");
    assert!(matches!(
        finding.remedy,
        Remedy::MoveVertices { .. } | Remedy::Change { .. }
    ));
}

/// Runs `test` on the transition of rigid parts, evaluated at t = 0.5.
fn with_search(transition: &Transition, test: impl FnOnce(&CauseSearch<'_>)) {
    let (Some(arap), Content::Solid(solid)) = (transition.arap(), transition.content()) else {
        panic!("rigid parts");
    };
    test(&CauseSearch::new(transition, arap, solid, 0.5));
}

#[test]
fn a_large_rotation_within_one_part_is_measured_relative_to_the_whole() {
    let (faces, _) = sheet(60, 1);
    let uncoiled = transition(
        &faces,
        &band(1.5, 2.5),
        &band(0.0, 0.0),
        options_with(Homotopy::Polar),
    );
    with_search(&uncoiled, |search| {
        // The faces at the two ends of the band rotate by about a full turn relative to those in
        // its middle.
        let Some(FindingCause::FarTurn { part: None, turn }) = cause::large_rotation(search, 0)
        else {
            panic!("{:?}", cause::large_rotation(search, 0));
        };
        assert!(turn.abs() > PI);
        assert_eq!(cause::large_rotation(search, 60), None);
    });
}

#[test]
fn a_squeezed_boundary_is_located() {
    let (faces, source) = sheet(40, 1);
    // The middle tenth of the lower side becomes five times shorter.
    let squeeze = |x: f64| match x {
        x if x < 18.0 => x * 19.6 / 18.0,
        x if x < 22.0 => 19.6 + (x - 18.0) * 0.2,
        x => 20.4 + (x - 22.0) * 19.6 / 18.0,
    };
    let squeezed_point = |p: &DVec2| {
        if p.y == 0.0 {
            DVec2::new(squeeze(p.x), 0.0)
        } else {
            *p
        }
    };
    let target: Vec<_> = source.iter().map(squeezed_point).collect();
    let squeezed = transition(&faces, &source, &target, ArapOptions::default());
    with_search(&squeezed, |search| {
        let Some(FindingCause::UnevenMatch {
            ratio,
            source,
            target,
        }) = cause::uneven_match(search, 40)
        else {
            panic!("no cause");
        };
        assert!(ratio < 1.0 / 3.0, "{ratio}");
        assert!((source - DVec2::new(20.0, 0.0)).abs().max_element() <= 2.0);
        assert!((target - DVec2::new(20.0, 0.0)).abs().max_element() <= 0.4);
        assert_eq!(cause::uneven_match(search, 0), None, "far from it");
        let text = FindingCause::UnevenMatch {
            ratio: 0.25,
            source,
            target,
        }
        .to_string();
        assert!(text.contains("4.0 times shorter"), "{text}");
    });
}

#[test]
fn neighbours_that_rotate_differently_are_reported() {
    // Two squares, sheared far in opposite directions.
    let (faces, source) = sheet(1, 2);
    let shear = |p: &DVec2| DVec2::new(p.x + 6.0 * (p.y - 1.0).abs(), p.y);
    let target: Vec<_> = source.iter().map(shear).collect();
    let sheared = transition(&faces, &source, &target, ArapOptions::default());
    with_search(&sheared, |search| {
        let Some(FindingCause::UnlikeNeighbours { turn }) =
            cause::differing_neighbours(search, &[1])
        else {
            panic!("no cause");
        };
        // A shear by s rotates by atan(s / 2), here in both directions.
        assert!((turn - 2.0 * 3f64.atan()).abs() < 1e-9, "{turn}");
    });
}

fn fields(source: &str, target: &str) -> Transition {
    fields_by(source, target, Metric::Euclidean)
}

fn fields_by(source: &str, target: &str, metric: Metric) -> Transition {
    let read = |shapes: &str| {
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"60\">{shapes}</svg>"
        );
        Arc::new(import("drawing", svg.as_bytes(), &ImportOptions::default()).expect("a drawing"))
    };
    let mut spec = TransitionSpec::new(read(source), read(target));
    spec.method = crate::transition::TransitionMethod::FIELD_BLEND;
    spec.options.field.cells = 96;
    spec.options.field.metric = metric;
    Transition::build(&spec, &Silent).expect("a transition")
}

fn rect(x: u32, y: u32, width: u32, height: u32) -> String {
    format!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>")
}

#[test]
fn fields_without_overlap_disappear_in_between() {
    let result = verdict(&fields(&rect(5, 20, 20, 20), &rect(75, 20, 20, 20)));
    let finding = &result.findings[0];
    assert_eq!(finding.trouble, FindingKind::Gone);
    assert_eq!(finding.cause, FindingCause::LittleOverlap { share: 0.0 });
    assert_eq!(finding.remedy, Remedy::LayOver);
    assert_eq!(
        result.headline(),
        format!("the shape disappears near t = {:.2}", finding.t)
    );
}

#[test]
fn fields_that_lose_a_bridge_break_apart() {
    let blobs = rect(5, 10, 30, 40) + &rect(65, 10, 30, 40);
    let above = blobs.clone() + &rect(30, 12, 40, 6);
    let below = blobs + &rect(30, 42, 40, 6);
    let result = verdict(&fields(&above, &below));
    let finding = &result.findings[0];
    assert_eq!(
        finding.trouble,
        FindingKind::Pieces {
            count: 2,
            at_ends: 1
        }
    );
    assert_eq!(finding.cause, FindingCause::BlindFields);
    assert_eq!(finding.remedy, Remedy::RigidParts);
    assert!((finding.t - 0.5).abs() < 0.2);
    assert!(
        result
            .headline()
            .starts_with("breaks into 2 pieces near t = 0.")
    );
}

#[test]
fn fields_that_keep_their_pieces_are_clear() {
    let result = verdict(&fields(&rect(10, 10, 40, 40), &rect(15, 10, 50, 40)));
    assert_eq!(result.headline(), "no extra pieces or holes");
}

#[test]
fn a_check_includes_the_notes_of_the_transition() {
    let (a, b) = (rect(10, 10, 40, 40), rect(15, 10, 50, 40));
    assert_eq!(verdict(&fields(&a, &b)).notes, []);
    let result = verdict(&fields_by(&a, &b, Metric::Chessboard));
    assert_eq!(result.notes, [TransitionNote::BinaryBoundary]);
    assert!(result.is_clear(), "a note is not a defect");
}

#[test]
fn a_change_is_applied_to_the_options() {
    let mut options = TransitionOptions::default();
    options.arap.symmetric = false;
    for change in [
        SettingChange::Homotopy(Homotopy::Exponential),
        SettingChange::Symmetric,
        SettingChange::ExtraTurns(vec![0, -1]),
        SettingChange::Space(BlendSpace::Real),
    ] {
        change.apply(&mut options);
        assert!(!change.to_string().is_empty());
    }
    assert_eq!(options.arap.homotopy, Homotopy::Exponential);
    assert!(options.arap.symmetric);
    assert_eq!(options.arap.extra_turns, [0, -1]);
    assert_eq!(options.field.blend.space, BlendSpace::Real);
}
