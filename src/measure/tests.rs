//! Tests of the measures on built transitions, against closed forms and identities.

use super::*;
use crate::content::ContentKind;
use crate::design::{Design, ImportOptions, import};
use crate::geometry::{DMat2, DVec2};
use crate::project::gallery;
use crate::transition::{Transition, TransitionMethod, TransitionSpec};
use crate::warp::homotopy::Homotopy;
use crate::warp::{ArapOptions, VertexPath, WarpKind};
use crate::work::progress::{Cancelled, Progress, Silent};
use std::fmt::Write as _;
use std::sync::Arc;

/// Returns a mesh design with these vertices and faces, imported from OBJ text.
pub(super) fn design(points: &[DVec2], faces: &[[u32; 3]]) -> Arc<Design> {
    let mut text = String::new();
    for p in points {
        writeln!(text, "v {} {} 0", p.x, p.y).expect("text");
    }
    for [a, b, c] in faces {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).expect("text");
    }
    let read = import("mesh", text.as_bytes(), &ImportOptions::default());
    Arc::new(read.expect("a mesh"))
}

pub(super) fn transition(
    faces: &[[u32; 3]],
    source: &[DVec2],
    target: &[DVec2],
    arap: ArapOptions,
) -> Transition {
    let mut spec = TransitionSpec::new(design(source, faces), design(target, faces));
    spec.options.arap = arap;
    Transition::build(&spec, &Silent).expect("a transition")
}

/// Returns the faces and vertices of a rectangle of `n` by `m` squares of side 1, two faces each.
pub(super) fn sheet(n: u32, m: u32) -> (Vec<[u32; 3]>, Vec<DVec2>) {
    let points = (0..=m).flat_map(|j| (0..=n).map(move |i| DVec2::new(i.into(), j.into())));
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let quad = |i, j| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let squares = (0..m).flat_map(|j| (0..n).map(move |i| (i, j)));
    (
        squares.flat_map(|(i, j)| quad(i, j)).collect(),
        points.collect(),
    )
}

/// Returns the measures of the film from a rectangle of 4 by 2 to its image under `map`.
fn film_of(map: impl Fn(DVec2) -> DVec2, homotopy: Homotopy) -> FilmReport {
    let (faces, source) = sheet(4, 2);
    let target: Vec<_> = source.iter().map(|&p| map(p)).collect();
    let options = ArapOptions {
        homotopy,
        ..ArapOptions::default()
    };
    film_report(&transition(&faces, &source, &target, options), 17, &Silent).expect("not cancelled")
}

#[test]
fn boundary_paths_are_measured_without_a_mesh() {
    let loaded = gallery::load("gecko").expect("bundled");
    let mut spec = loaded.spec().expect("a specification");
    spec.method = TransitionMethod::new(WarpKind::Paths, ContentKind::Solid).expect("a cell");
    for vertex_path in [VertexPath::Straight, VertexPath::Intrinsic] {
        spec.options.paths.course = vertex_path;
        let transition = Transition::build(&spec, &Silent).expect("a transition");
        let report = film_report(&transition, 17, &Silent).expect("not cancelled");
        assert_eq!((report.worst_folds, report.asymmetry), (None, None));
        assert!(report.motion.is_none() && report.conformal_excess.is_none());
        assert_eq!(report.pieces_excess, Some(0));
        let verdict = Verdict::of_film(&transition, &report, &Silent).expect("not cancelled");
        assert_eq!(
            verdict,
            Verdict::of(&transition, 17, &Silent).expect("not cancelled")
        );
        assert_eq!(verdict.is_clear(), report.worst_crossings == Some(0));
        if let Some(finding) = verdict.findings.first() {
            assert!(matches!(finding.trouble, FindingKind::Crossings { .. }));
            let cause_and_remedy = (&finding.cause, &finding.remedy);
            assert_eq!(
                cause_and_remedy,
                (&FindingCause::NothingInside, &Remedy::RigidParts)
            );
        } else {
            assert_eq!(verdict.headline(), "no crossings");
        }
    }
}

#[test]
fn a_rigid_motion_has_no_excess_in_any_measure() {
    let turn = DMat2::from_angle(2.5);
    let report = film_of(|p| turn * p + DVec2::new(30.0, -7.0), Homotopy::Exponential);
    assert_eq!(report.worst_folds, Some(0));
    assert_eq!(report.worst_crossings, Some(0));
    assert_eq!((report.first_fold_t, report.first_crossing_t), (None, None));
    for excess in [
        report.conformal_excess,
        report.isometric_excess,
        report.area_distortion_excess,
        report.asymmetry,
        Some(report.area_variation_excess),
        Some(report.perimeter_variation_excess),
        report.motion.map(|m| m.max_travel),
    ] {
        assert!(excess.expect("measured") < 1e-9, "{report:?}");
    }
    let acceleration = report.motion.expect("measured").max_acceleration;
    assert!(acceleration < 1e-6, "{acceleration}");
    assert_eq!(
        (report.pieces_excess, report.holes_excess),
        (Some(0), Some(0))
    );
    assert!((report.min_det.expect("faces") - 1.0).abs() < 1e-9);
}

#[test]
fn the_distortion_of_a_shear_matches_the_closed_form() {
    let s: f64 = 1.5;
    let report = film_of(|p| DVec2::new(p.x + s * p.y, p.y), Homotopy::Polar);
    let large = 0.5 * (s + s.hypot(2.0));
    let last = report.samples.last().expect("samples");
    let distortion = last.distortion.expect("faces");
    assert!((distortion.conformal.worst - large * large).abs() < 1e-9);
    assert!((distortion.isometric.median - large).abs() < 1e-9);
    assert!((distortion.area.worst - 1.0).abs() < 1e-9 && (distortion.max_det - 1.0).abs() < 1e-9);
    assert!(report.conformal_excess.expect("faces") < 1e-9);
}

#[test]
fn scaling_to_nine_times_the_area_rises_evenly() {
    let report = film_of(|p| 3.0 * p, Homotopy::Exponential);
    assert!(report.area_variation_excess < 1e-12);
    let areas = report.series(Quantity::Area);
    assert_eq!(areas.len(), 17);
    assert_eq!(areas[0], [0.0, 8.0]);
    assert!((areas[8][1] - 8.0 * 3.0).abs() < 1e-9, "{:?}", areas[8]);
    assert!((areas[16][1] - 72.0).abs() < 1e-9);
    let dets = report.series(Quantity::MinDet);
    assert!((dets[16][1] - 9.0).abs() < 1e-9);
}

#[test]
fn each_quantity_has_a_value_per_sample_or_none() {
    let report = film_of(|p| p, Homotopy::Polar);
    for quantity in Quantity::ALL {
        assert_eq!(report.series(quantity).len(), 17, "{}", quantity);
    }
    let truss = r#"{"nodes": [[0,0],[1,0],[0,1]], "bars": [[0,1],[1,2],[2,0]]}"#;
    let read = import("truss", truss.as_bytes(), &ImportOptions::default());
    let truss = Arc::new(read.expect("a truss"));
    let spec = TransitionSpec::new(Arc::clone(&truss), truss);
    let transition = Transition::build(&spec, &Silent).expect("a transition");
    let report = film_report(&transition, 3, &Silent).expect("not cancelled");
    assert_eq!(report.series(Quantity::Crossings), Vec::<[f64; 2]>::new());
    assert_eq!(report.series(Quantity::Perimeter).len(), 3);
}

#[test]
fn steiner_points_are_the_inner_vertices() {
    let (faces, points) = sheet(4, 2);
    let mesh = transition(&faces, &points, &points, ArapOptions::default());
    let report = super::mesh_report(mesh.compatible().expect("a mesh")).expect("faces");
    assert_eq!((report.boundary_vertices, report.inner_vertices), (12, 3));
    assert_eq!(report.steiner_per_boundary_point, 0.25);
    assert_eq!(report.thin_faces, 0.0);
    assert!((report.min_angle_target_deg - 45.0).abs() < 1e-9);
}

struct CancelledMeasure;

impl Progress for CancelledMeasure {
    fn report(&self, _: &'static str, _: f64) {}

    fn is_cancelled(&self) -> bool {
        true
    }
}

#[test]
fn film_and_check_stop_when_cancelled() {
    let (faces, points) = sheet(1, 1);
    let still = transition(&faces, &points, &points, ArapOptions::default());
    assert_eq!(
        film_report(&still, 9, &CancelledMeasure).map(|_| ()),
        Err(Cancelled)
    );
    assert_eq!(Verdict::of(&still, 9, &CancelledMeasure), Err(Cancelled));
}
