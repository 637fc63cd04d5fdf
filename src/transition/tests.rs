//! Tests of transitions: methods, frames, notes, cancellation, and the placement of designs in one
//! coordinate system.
#![expect(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::content::ContentKind;
use crate::correspondence::{HoleRule, MatchNote, PartRule};
use crate::design::{Design, ImportOptions, import};
use crate::geometry::{DVec2, Similarity, count_crossings};
use crate::warp::WarpKind;
use crate::work::progress::{Progress, Silent};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

mod names;
mod outline_turning;
mod pages;
mod paint;
mod part_times;
mod transients;
mod upright;

fn design(text: &str) -> Arc<Design> {
    Arc::new(import("test", text.as_bytes(), &ImportOptions::default()).unwrap())
}

fn svg(path: &str) -> Arc<Design> {
    design(&format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d='{path}'/></svg>"
    ))
}

/// A unit square as a mesh of two triangles, in OBJ format.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
/// A truss of three bars that form a triangle.
const TRUSS: &str = r#"{"nodes": [[0,0],[2,0],[1,1.5]], "bars": [[0,1],[1,2],[2,0]]}"#;

/// Returns the specification of a blend of distance fields on a coarse grid.
fn field_spec(source: Arc<Design>, target: Arc<Design>) -> TransitionSpec {
    let mut spec = TransitionSpec::new(source, target);
    spec.method = TransitionMethod::new(WarpKind::None, ContentKind::Field).unwrap();
    spec.options.field.cells = 128;
    spec
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn any_two_forms_become_rigid_parts() {
    let outline = svg("M10 10h80v80h-80z");
    let (mesh, truss) = (design(SQUARE), design(TRUSS));
    for source in [&outline, &mesh, &truss] {
        for target in [&outline, &mesh, &truss] {
            let spec = TransitionSpec::new(Arc::clone(source), Arc::clone(target));
            assert_eq!(spec.method.warp(), WarpKind::Arap);
            if source.name == target.name {
                Transition::build(&spec, &Silent).unwrap();
            }
        }
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn rigid_outlines_show_the_designs_at_the_ends() {
    let (a, b) = (
        svg("M10 10h80v80h-80z"),
        svg("M50 20L80 80H20zM85 10h10v10h-10z"),
    );
    let transition = Transition::build(&TransitionSpec::new(a, b), &Silent).unwrap();
    let matched = transition.matched().unwrap();
    assert_eq!(matched.pieces.len(), 2);
    for (t, area) in [(0.0, 6400.0), (1.0, 1900.0)] {
        let rings = transition.frame(t).figure().rings;
        let found: f64 = rings
            .iter()
            .map(|ring| {
                crate::geometry::Ring::new(ring.clone())
                    .unwrap()
                    .signed_area()
            })
            .sum();
        assert!((found - area).abs() < 1e-6 * area, "t = {t}: {found}");
    }
}

#[test]
fn field_ends_show_the_designs() {
    let transition = Transition::build(
        &field_spec(svg("M10 10h80v80h-80z"), svg("M50 20L80 80H20z")),
        &Silent,
    )
    .unwrap();
    for (t, area) in [(0.0, 6400.0), (1.0, 1800.0)] {
        let rings = transition.frame(t).figure().rings;
        let found: f64 = rings
            .iter()
            .map(|ring| {
                crate::geometry::Ring::new(ring.clone())
                    .unwrap()
                    .signed_area()
            })
            .sum();
        assert!((found / area - 1.0).abs() < 0.01, "t = {t}: {found}");
    }
}

#[test]
fn a_truss_is_drawn_as_bars_and_as_a_field() {
    let truss = design(TRUSS);
    let spec = TransitionSpec::new(Arc::clone(&truss), Arc::clone(&truss));
    let bars = Transition::build(&spec, &Silent)
        .unwrap()
        .frame(0.3)
        .figure();
    assert_eq!((bars.rings.len(), bars.bars.len()), (0, 3));
    assert!(bars.bar_width > 0.0);
    let mut spec = field_spec(Arc::clone(&truss), truss);
    spec.options.bar_width = 0.05;
    let figure = Transition::build(&spec, &Silent)
        .unwrap()
        .frame(0.5)
        .figure();
    assert_eq!(figure.rings.len(), 2, "a triangle of bars has one hole");
}

/// Returns the specification of boundary paths between two designs.
fn paths_spec(source: Arc<Design>, target: Arc<Design>) -> TransitionSpec {
    let mut spec = TransitionSpec::new(source, target);
    spec.method = TransitionMethod::new(WarpKind::Paths, ContentKind::Solid).unwrap();
    spec
}

/// Returns the sum of the signed areas of closed polygons.
fn area(rings: &[Vec<DVec2>]) -> f64 {
    let of = |ring: &Vec<DVec2>| -> f64 {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
    };
    0.5 * rings.iter().map(of).sum::<f64>()
}

#[test]
fn boundary_paths_show_the_designs_at_the_ends_and_unmatched_rings_as_points() {
    let (a, b) = (
        svg("M10 10h80v80h-80z"),
        svg("M50 20L80 80H20zM48 60v6h4v-6zM85 10h10v10h-10z"),
    );
    let mut spec = paths_spec(a, b);
    spec.options.matching.holes = HoleRule::Close;
    let transition = Transition::build(&spec, &Silent).unwrap();
    assert!(transition.arap().is_none() && transition.matched().is_some());
    for (t, expected) in [(0.0, 6400.0), (1.0, 1876.0)] {
        let found = area(&transition.frame(t).figure().rings);
        assert!(
            (found - expected).abs() < 1e-9 * expected,
            "t = {t}: {found}"
        );
    }
    let first = transition.frame(0.0).figure().rings;
    assert_eq!(first.len(), 3);
    let is_point = |ring: &&Vec<DVec2>| ring.iter().all(|p| *p == ring[0]);
    assert_eq!(first.iter().filter(is_point).count(), 1, "the hole");
    let middle = transition.frame(0.5).figure().rings;
    assert!(!middle.iter().any(|ring| is_point(&ring)));
}

#[test]
fn a_letter_appears_from_a_point() {
    let mut spec = crate::project::gallery::load("words")
        .unwrap()
        .spec()
        .unwrap();
    spec.method = TransitionMethod::new(WarpKind::Paths, ContentKind::Solid).unwrap();
    let transition = Transition::build(&spec, &Silent).unwrap();
    let pieces = &transition.matched().unwrap().pieces;
    let born = pieces.iter().filter(|p| p.source_part.is_none());
    let born: usize = born.map(|piece| piece.rings.len()).sum();
    let first = transition.frame(0.0).figure().rings;
    let points = first
        .iter()
        .filter(|ring| ring.iter().all(|p| *p == ring[0]));
    assert!(born > 0 && points.count() >= born);
}

#[test]
fn meshes_bring_their_boundaries_and_other_forms_are_matched() {
    let turned = "v 0 0 0\nv 0 1 0\nv -1 1 0\nv -1 0 0\nf 1 2 3\nf 1 3 4\n";
    let mirrored = "v 0 0 0\nv -1 0 0\nv -1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    let clockwise = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 3 2\nf 1 4 3\n";
    let truss = r#"{"nodes": [[0,0],[2,0],[1,1.5]], "bars": [[0,1],[1,2],[2,0]]}"#;
    for (source, target, is_numbered) in [
        (SQUARE, turned, true),
        (SQUARE, mirrored, false),
        (clockwise, clockwise, true),
        (SQUARE, truss, false),
        (truss, truss, false),
    ] {
        let spec = paths_spec(design(source), design(target));
        let transition = Transition::build(&spec, &Silent).unwrap();
        assert_eq!(transition.matched().is_none(), is_numbered, "{target}");
        let figure = transition.frame(0.5).figure();
        assert!(figure.bars.is_empty() && !figure.rings.is_empty());
    }
    let spec = paths_spec(design(SQUARE), design(turned));
    let half = Transition::build(&spec, &Silent).unwrap().frame(0.5);
    assert!(
        (area(&half.figure().rings) - 1.0).abs() < 1e-12,
        "turned whole"
    );
}

#[test]
fn a_mesh_with_a_hole_is_one_part() {
    let points = [
        (0, 0),
        (3, 0),
        (3, 3),
        (0, 3),
        (1, 1),
        (2, 1),
        (2, 2),
        (1, 2),
    ];
    let vertices = |turn: f64| -> String {
        let place = |&(x, y): &(i32, i32)| {
            let p = DVec2::from_angle(turn).rotate(DVec2::new(x.into(), y.into()));
            format!("v {} {} 0\n", p.x, p.y)
        };
        points.iter().map(place).collect()
    };
    let faces = "f 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";
    let ends = [0.0, 2.0].map(|turn| design(&format!("{}{faces}", vertices(turn))));
    let [source, target] = ends;
    let transition = Transition::build(&paths_spec(source, target), &Silent).unwrap();
    for t in [-0.5, 0.3, 0.5, 1.2] {
        let rings = transition.frame(t).figure().rings;
        assert_eq!(rings.len(), 2);
        assert!((area(&rings) - 8.0).abs() < 1e-9);
        assert!(
            (rings[0][0].distance(rings[1][0]) - ring_distance_at_start(&transition)).abs() < 1e-9
        );
    }
}

/// Returns the distance between the first points of the first two rings at t = 0; a rigid motion
/// must preserve it.
fn ring_distance_at_start(transition: &Transition) -> f64 {
    let rings = transition.frame(0.0).figure().rings;
    rings[0][0].distance(rings[1][0])
}

#[test]
fn frames_do_not_depend_on_earlier_frames() {
    let turned = "v 0 0 0\nv 0 1 0\nv -1 1 0\nv -1 0 0\nf 1 2 3\nf 1 3 4\n";
    let spec = TransitionSpec::new(design(SQUARE), design(turned));
    let transition = Transition::build(&spec, &Silent).unwrap();
    let mut frame = transition.frame(0.9);
    frame.seek(f64::NAN);
    assert_eq!(frame.t(), 0.0);
    frame.seek(0.25);
    assert_eq!(frame.figure(), transition.frame(0.25).figure());
    assert!(!frame.is_extrapolated());
    frame.seek(1.5);
    assert!(frame.is_extrapolated());
    assert!(frame.figure().rings[0].iter().all(|p| p.is_finite()));
}

#[test]
fn fits_centre_and_scale_the_target() {
    let (small, large) = (svg("M10 10h20v20h-20z"), svg("M40 40h40v40h-40z"));
    let still = Similarity::IDENTITY;
    let bounds = |design: &Design| design.outline(0.0).unwrap().bounds();
    for (fit, width) in [
        (DesignFit::AsDrawn, 40.0),
        (DesignFit::Centred, 40.0),
        (DesignFit::SameArea, 20.0),
    ] {
        let [a, b] = [&small, &large].map(|d| place_in_frame(d, &small, fit, still).unwrap());
        assert!(Arc::ptr_eq(&a, &small), "the first stays as it is");
        assert!((bounds(&b).size().x - width).abs() < 1e-6, "{fit:?}");
        let together = bounds(&a).centre().distance(bounds(&b).centre()) < 1e-6;
        assert_eq!(together, fit != DesignFit::AsDrawn, "{fit:?}");
    }
    let auto = place_in_frame(&large, &small, DesignFit::Auto, still).unwrap();
    assert!(Arc::ptr_eq(&auto, &large), "equal pages stay as drawn");
    let placement = Similarity {
        rotation: std::f64::consts::FRAC_PI_4,
        offset: DVec2::new(5.0, 0.0),
        ..Similarity::IDENTITY
    };
    let a = place_in_frame(&small, &small, DesignFit::AsDrawn, placement).unwrap();
    let moved = bounds(&a).centre() - bounds(&small).centre();
    assert!(
        moved.distance(DVec2::new(5.0, 0.0)) < 1e-6,
        "turned about its own middle"
    );
    let flat = Similarity {
        scale: 0.0,
        ..Similarity::IDENTITY
    };
    assert!(place_in_frame(&large, &small, DesignFit::AsDrawn, flat).is_err());
}

#[test]
fn a_mirrored_target_is_offered_the_mirror() {
    let mirrored = "v 0 0 0\nv -1 0 0\nv -1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    let spec = TransitionSpec::new(design(SQUARE), design(mirrored));
    let error = Transition::build(&spec, &Silent).unwrap_err().to_string();
    assert!(error.contains("mirror"), "{error}");
    let flip = Similarity {
        mirror: true,
        ..Similarity::IDENTITY
    };
    let source = design(SQUARE);
    let target = place_in_frame(&design(mirrored), &source, DesignFit::AsDrawn, flip).unwrap();
    Transition::build(&TransitionSpec::new(source, target), &Silent).unwrap();
}

/// Progress that is cancelled once the given number of reports has been received.
struct CancelAtReport(usize, AtomicUsize);

impl Progress for CancelAtReport {
    fn report(&self, _stage: &'static str, _fraction: f64) {
        self.1.fetch_add(1, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.1.load(Ordering::Relaxed) >= self.0
    }
}

#[test]
fn a_build_can_be_cancelled_at_every_report() {
    let arap = TransitionSpec::new(design(SQUARE), design(SQUARE));
    let field = field_spec(svg("M10 10h80v80h-80z"), svg("M50 20L80 80H20z"));
    let paths = paths_spec(svg("M10 10h80v80h-80z"), svg("M50 20L80 80H20z"));
    for spec in [arap, field, paths] {
        for at in 1.. {
            let progress = CancelAtReport(at, AtomicUsize::new(0));
            let built = Transition::build(&spec, &progress);
            if progress.1.load(Ordering::Relaxed) < at {
                built.unwrap();
                assert!(at > 2, "progress is reported");
                break;
            }
            let error = built.unwrap_err().to_string();
            assert!(error.contains("cancelled"), "{error}");
        }
    }
}

fn arrow(turned: bool) -> Arc<Design> {
    // The arrow is much longer than high, so it leaves the rectangle around both designs while it
    // rotates.
    let right = "M5 45h60v-5l30 10l-30 10v-5h-60z";
    let left = "M95 55h-60v5l-30-10l30-10v5h60z";
    svg(if turned { left } else { right })
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn fields_that_turn_are_not_cropped_by_the_frame() {
    for warp in [WarpKind::Scattered, WarpKind::Lattice, WarpKind::Arap] {
        let mut spec = field_spec(arrow(false), arrow(true));
        spec.method = TransitionMethod::new(warp, ContentKind::Field).unwrap();
        let transition = Transition::build(&spec, &Silent).unwrap();
        let rings = transition.frame(0.5).figure().rings;
        let ends = area(&transition.frame(0.0).figure().rings);
        assert!(
            (area(&rings) / ends - 1.0).abs() < 0.1,
            "{warp:?}: {} of {ends}",
            area(&rings)
        );
        let all = transition.bounds().padded(1e-6);
        assert!(rings.iter().flatten().all(|p| all.contains(*p)), "{warp:?}");
    }
}

#[test]
fn automatic_pins_can_be_set_by_hand() {
    let mut spec = field_spec(arrow(false), arrow(true));
    spec.method = TransitionMethod::new(WarpKind::Arap, ContentKind::Field).unwrap();
    let found = Transition::build(&spec, &Silent).unwrap();
    assert!(found.automatic_pins().len() > 8);
    spec.options.matching.pins = found.automatic_pins().to_vec();
    let taken = Transition::build(&spec, &Silent).unwrap();
    assert_eq!(taken.automatic_pins(), []);
    let areas = [&found, &taken].map(|t| area(&t.frame(0.5).figure().rings));
    assert!((areas[0] / areas[1] - 1.0).abs() < 0.05, "{areas:?}");
}

#[test]
fn rigid_parts_carry_a_rotated_field_rigidly() {
    let boot = "M10 10h20v40h30v20h-50z";
    let turned = "M20 70v-20h40v-30h20v50z";
    let mut spec = field_spec(svg(boot), svg(turned));
    spec.method = TransitionMethod::new(WarpKind::Arap, ContentKind::Field).unwrap();
    let transition = Transition::build(&spec, &Silent).unwrap();
    let mut frame = transition.frame(0.0);
    for t in [0.0, 0.2, 0.5, 0.9, 1.0] {
        frame.seek(t);
        let placement = frame.placement();
        let (seen, source) = (&placement.in_frame, &placement.in_source);
        for k in (0..seen.len()).step_by(7) {
            let apart = seen[0].distance(seen[k]);
            let expected = source[0].distance(source[k]);
            assert!(
                (apart - expected).abs() < 1e-4 * 200.0,
                "{apart}, not {expected}, at {t}"
            );
        }
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn one_part_and_two_are_carried_by_every_warp() {
    let one = svg("M20 20h60v60h-60z");
    let two = svg("M10 20h30v60h-30z M60 20h30v60h-30z");
    for warp in [
        WarpKind::Arap,
        WarpKind::Lines,
        WarpKind::Scattered,
        WarpKind::Lattice,
    ] {
        for (source, target) in [(&one, &two), (&two, &one)] {
            let mut spec = field_spec(Arc::clone(source), Arc::clone(target));
            spec.method = TransitionMethod::new(warp, ContentKind::Field).unwrap();
            let transition = Transition::build(&spec, &Silent).unwrap();
            assert!(!transition.frame(0.5).figure().rings.is_empty(), "{warp:?}");
        }
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn the_mesh_that_carries_fields_and_pictures_is_accessible() {
    let mut fields = field_spec(arrow(false), arrow(true));
    fields.method = TransitionMethod::new(WarpKind::Arap, ContentKind::Field).unwrap();
    let mut loaded = crate::project::gallery::load("portraits-points").unwrap();
    loaded.project.warp = Some(WarpKind::Arap);
    let pictures = loaded.spec().unwrap();
    assert_eq!(pictures.method.content(), ContentKind::Colours);
    for spec in [fields, pictures] {
        let transition = Transition::build(&spec, &Silent).unwrap();
        let arap = transition.arap().expect("rigid parts");
        assert!(arap.part_count() > 0);
        let faces = &transition.frame(0.5).placement().faces.clone();
        assert_eq!(faces, arap.mesh().faces());
        assert!(transition.compatible().is_none(), "a mesh of the frame");
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn every_method_is_built() {
    let loaded = crate::project::gallery::load("portraits-points").unwrap();
    let pictures = loaded.spec().unwrap();
    let (a, b) = (svg("M10 10h80v80h-80z"), svg("M50 20L80 80H20z"));
    for cell in TransitionMethod::all() {
        let mut spec = match cell.content() {
            ContentKind::Colours => pictures.clone(),
            ContentKind::Solid | ContentKind::Field => field_spec(Arc::clone(&a), Arc::clone(&b)),
        };
        spec.method = cell;
        let transition = Transition::build(&spec, &Silent).unwrap();
        assert_eq!(transition.method(), cell);
        assert_eq!(transition.notes(), [], "{}", cell.name());
        let has_arap = cell.warp() == WarpKind::Arap;
        assert_eq!(transition.arap().is_some(), has_arap, "{}", cell.name());
    }
}

fn rigid_fields(source: &str, target: &str) -> TransitionSpec {
    let mut spec = field_spec(svg(source), svg(target));
    spec.method = TransitionMethod::new(WarpKind::Arap, ContentKind::Field).unwrap();
    spec.options.matching.holes = HoleRule::Close;
    spec
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn parts_that_leave_a_hole_are_carried_by_fewer_pins_with_a_note() {
    let inside = "M5 20h60v60h-60z M15 30v40h40v-40z M30 45h10v10h-10z";
    let outside = "M5 20h60v60h-60z M15 30v40h40v-40z M80 45h10v10h-10z";
    let spec = rigid_fields(inside, outside);
    let transition = Transition::build(&spec, &Silent).unwrap();
    let [
        TransitionNote::PinsInsteadOfOutlines(_),
        TransitionNote::FewerPins { left, of },
    ] = transition.notes()
    else {
        panic!("{:?}", transition.notes());
    };
    assert!(left < of, "{left} of {of}");
    assert_eq!(transition.automatic_pins().len(), *left);
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn pins_that_contradict_their_outlines_carry_alone_with_a_note() {
    let ring = "M10 10h80v80h-80z M40 40v20h20v-20z";
    let mut spec = rigid_fields(ring, ring);
    // A pin from the hole to the outer boundary contradicts closing the hole.
    let [y, hole] = [50.0, 40.0];
    let outer = 10.0;
    spec.options.matching.pins = vec![crate::correspondence::PointPair {
        source: DVec2::new(hole, y),
        target: DVec2::new(outer, y),
    }];
    let transition = Transition::build(&spec, &Silent).unwrap();
    assert!(
        matches!(transition.notes(), [TransitionNote::PinsUnmatched(_)]),
        "{:?}",
        transition.notes()
    );
}

#[test]
fn a_boundary_that_cannot_be_exact_gives_a_note() {
    let mut spec = field_spec(svg("M10 10h80v80h-80z"), svg("M50 20L80 80H20z"));
    spec.options.field.metric = crate::field::Metric::CityBlock;
    let notes = |spec: &TransitionSpec| {
        let transition = Transition::build(spec, &Silent).unwrap();
        let mixed = transition.with_blend(spec.options.field.blend).unwrap();
        assert_eq!(mixed.unwrap().notes(), transition.notes());
        transition.notes().to_vec()
    };
    assert_eq!(notes(&spec), [TransitionNote::BinaryBoundary]);
    spec.options.field.boundary = FieldBoundary::Binary;
    assert_eq!(notes(&spec), []);
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn impossible_cuts_give_a_note() {
    // An island lies within a hole that winds around it, so that no straight cut leads to the
    // island.
    let drawn = |island: &str| {
        let winding = "M5.25 13V5.25H14.75V14.75H3.25V8H2.75V15.25H15.25V4.75H4.75V13z";
        design(&format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 20 20'>\
             <path fill-rule='evenodd' d='M0 0h20v20h-20z{winding}{island}'/></svg>"
        ))
    };
    let mut spec = TransitionSpec::new(drawn("M9 9h2v2h-2z"), drawn(""));
    spec.options.matching.holes = HoleRule::Cut;
    let transition = Transition::build(&spec, &Silent).unwrap();
    assert!(
        matches!(
            transition.notes(),
            [TransitionNote::Match(MatchNote::Uncut { part: 0, .. })]
        ),
        "{:?}",
        transition.notes()
    );
}

/// Returns the largest number of crossings in any of 51 frames.
fn max_crossings(source: &Arc<Design>, target: &Arc<Design>) -> usize {
    let spec = TransitionSpec::new(Arc::clone(source), Arc::clone(target));
    let transition = Transition::build(&spec, &Silent).unwrap();
    let mut frame = transition.frame(0.0);
    let steps = (0..=50).map(|step| {
        frame.seek(f64::from(step) / 50.0);
        count_crossings(&frame.figure().rings)
    });
    steps.max().unwrap()
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn parts_do_not_collide() {
    let two = svg("M35 35h30v30h-30z M5 5h10v10h-10z");
    let badge = svg("M10 10h80v80h-80z M20 20v60h60v-60z M40 40h20v20h-20z");
    let bar = svg("M10 40h80v20h-80z");
    let column = svg("M40 10h20v20h-20z M40 40h20v20h-20z M40 70h20v20h-20z");
    for (a, b) in [(&two, &badge), (&bar, &badge), (&bar, &column)] {
        assert_eq!([max_crossings(a, b), max_crossings(b, a)], [0, 0]);
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn parts_split_by_the_user_stay_together() {
    let bar = svg("M10 40h80v20h-80z");
    let column = svg("M40 10h20v20h-20z M40 40h20v20h-20z M40 70h20v20h-20z");
    let mut spec = TransitionSpec::new(bar, column);
    spec.options.matching.parts = PartRule::Split;
    let transition = Transition::build(&spec, &Silent).unwrap();
    let pieces = &transition.matched().unwrap().pieces;
    assert!(pieces.iter().all(|piece| piece.source_part == Some(0)));
}
