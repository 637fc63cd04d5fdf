//! Tests of design spaces: blends with weight 1 on one design, order of designs, content, paths,
//! and errors.

use super::*;
use crate::content::ContentKind;
use crate::design::{Design, DesignForm, Truss};
use crate::geometry::{Bounds, DVec2};
use crate::transition::{BuildError, Transition, TransitionMethod, TransitionSpec};
use crate::work::budget::WorkloadKind;
use crate::work::progress::{Cancelled, Progress, Silent};
use proptest::prelude::*;
use std::sync::Arc;

mod pictures;

/// A star with the given number of points and depth of the notches.
fn star(name: &str, points: u32, depth: f64) -> Arc<Design> {
    let corner = |k: u32| {
        let angle = std::f64::consts::PI * f64::from(k) / f64::from(points);
        let size = if k.is_multiple_of(2) {
            3.0
        } else {
            3.0 - depth
        };
        (DVec2::from_angle(angle) * size).to_array()
    };
    let ring: Vec<[f64; 2]> = (0..2 * points).map(corner).collect();
    Arc::new(Design::from_rings(name, [ring]).expect("a star"))
}

fn ring(size: f64) -> [[f64; 2]; 4] {
    [[-size, -size], [size, -size], [size, size], [-size, size]]
}

/// A square with a square hole.
fn frame(name: &str, hole: f64) -> Arc<Design> {
    let rings = [ring(3.0), ring(hole)].map(|ring| ring.map(DVec2::from).to_vec());
    let regions = crate::geometry::Regions::from_rings(&rings, crate::geometry::FillRule::EvenOdd);
    Arc::new(Design::new(name, regions.expect("a frame")))
}

fn truss(name: &str, height: f64) -> Arc<Design> {
    let nodes = [
        (0.0, 0.0),
        (2.0, 0.0),
        (4.0, 0.0),
        (1.0, height),
        (3.0, height),
    ];
    let bars = [[0, 1], [1, 2], [0, 3], [3, 1], [1, 4], [4, 2], [3, 4]];
    let truss = Truss::new(nodes.map(DVec2::from).to_vec(), bars.to_vec()).expect("a truss");
    Arc::new(Design::new(name, truss))
}

fn space(designs: Vec<Arc<Design>>) -> DesignSpace {
    DesignSpace::build(&SpaceSpec::new(designs), &Silent).expect("a space")
}

fn corner(count: usize, index: usize) -> Vec<f64> {
    let mut weights = vec![0.0; count];
    weights[index] = 1.0;
    weights
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn weight_one_reproduces_the_design() {
    let designs = vec![star("a", 5, 1.5), star("b", 6, 0.8), star("c", 4, 2.0)];
    let space = space(designs);
    assert!(space.family().is_some() && space.notes().is_empty());
    let mut frame = space.frame();
    for (k, design) in space.designs().iter().enumerate() {
        frame.seek(&corner(3, k));
        let points = frame.figure().rings.concat();
        let drawn = design.outline(0.0).expect("an outline");
        for point in drawn.rings().flat_map(|ring| ring.points()) {
            assert!(points.contains(point), "{} has lost {point}", design.name);
        }
        let bounds = Bounds::of(points).expect("points");
        assert_eq!(bounds, drawn.bounds());
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn the_order_of_the_designs_hardly_affects_blends() {
    let [a, b, c] = [star("a", 5, 1.5), star("b", 6, 0.8), star("c", 4, 2.0)];
    let blend_points = |designs: Vec<Arc<Design>>, weights: [f64; 3]| {
        let space = space(designs);
        let mut frame = space.frame();
        frame.seek(&weights);
        let mut points = frame.figure().rings.concat();
        points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        points
    };
    let first = blend_points(vec![a.clone(), b.clone(), c.clone()], [0.5, 0.3, 0.2]);
    let reordered = blend_points(vec![c, a, b], [0.2, 0.5, 0.3]);
    assert_eq!(first.len(), reordered.len());
    // Single points may differ between the two meshes, so only the bounding boxes are compared.
    let bounds = |points: &[DVec2]| Bounds::of(points.iter().copied()).expect("points");
    let (p, q) = (bounds(&first), bounds(&reordered));
    assert!(p.min.distance(q.min) < 0.1 && p.max.distance(q.max) < 0.1);
}

#[test]
fn trusses_are_blended_bar_by_bar() {
    let space = space(vec![
        truss("low", 1.0),
        truss("high", 3.0),
        truss("higher", 5.0),
    ]);
    let mut frame = space.frame();
    frame.seek(&[0.25, 0.5, 0.25]);
    let figure = frame.figure();
    assert_eq!((figure.bars.len(), figure.rings.len()), (7, 0));
    let height = figure.bars[2][1].y - figure.bars[2][0].y;
    assert!((2.0..4.0).contains(&height), "{height}");
    frame.seek(&corner(3, 1));
    let DesignForm::Truss(high) = &space.designs()[1].form else {
        panic!("a truss");
    };
    let drawn: Vec<_> = high.segments().collect();
    assert_eq!(frame.figure().bars, drawn);
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn designs_without_a_common_mesh_are_blended_as_fields() {
    let designs = || {
        vec![
            frame("thin", 2.5),
            frame("thick", 1.0),
            star("star", 5, 1.0),
        ]
    };
    let mixed = space(designs());
    assert!(mixed.family().is_none());
    assert_eq!(mixed.notes().len(), 1);
    let note = mixed.notes()[0].to_string();
    assert!(
        note.starts_with("blended as distance fields: design "),
        "{note}"
    );
    let spec = SpaceSpec {
        content: Some(ContentKind::Solid),
        ..SpaceSpec::new(designs())
    };
    let error = DesignSpace::build(&spec, &Silent).expect_err("no common mesh");
    assert!(matches!(error, SpaceError::NoCommonMesh(_)), "{error}");
    // Without the star, the two squares with a hole have a common mesh.
    let frames = space(vec![frame("thin", 2.5), frame("thick", 1.0)]);
    assert!(frames.family().is_some());
}

#[test]
fn outlines_with_too_many_points_are_blended_as_fields() {
    let corner = |k: u32| {
        let angle = f64::from(k) / 13_000.0 * std::f64::consts::TAU;
        (DVec2::from_angle(angle) * 3.0).to_array()
    };
    let ring: Vec<[f64; 2]> = (0..13_000).map(corner).collect();
    let disc = Arc::new(Design::from_rings("disc", [ring]).expect("a disc"));
    let mut spec = SpaceSpec::new(vec![star("star", 5, 1.5), disc]);
    spec.options.field.cells = 32;
    let space = DesignSpace::build(&spec, &Silent).expect("fields");
    assert!(space.family().is_none());
    let note = space.notes()[0].to_string();
    assert!(note.contains("outline points may take more"), "{note}");
    spec.content = Some(ContentKind::Solid);
    let error = DesignSpace::build(&spec, &Silent).expect_err("too much");
    assert!(matches!(error, SpaceError::NoCommonMesh(_)), "{error}");
}

#[test]
fn outlines_of_too_many_designs_are_blended_as_fields() {
    let mut spec = SpaceSpec::new(vec![
        star("star", 5, 1.5);
        WorkloadKind::Designs.limit() + 1
    ]);
    spec.options.field.cells = 16;
    let space = DesignSpace::build(&spec, &Silent).expect("fields");
    assert!(space.family().is_none());
    let note = space.notes()[0].to_string();
    assert!(note.contains("designs on a map may take more"), "{note}");
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_space_of_two_fields_equals_their_transition() {
    let [a, b] = [star("a", 5, 1.5), frame("b", 1.0)];
    let spec = SpaceSpec {
        content: Some(ContentKind::Field),
        ..SpaceSpec::new(vec![a.clone(), b.clone()])
    };
    let space = DesignSpace::build(&spec, &Silent).expect("a space");
    let mut pair = TransitionSpec::new(a, b);
    pair.method = TransitionMethod::FIELD_BLEND;
    let pair = Transition::build(&pair, &Silent).expect("a pair");
    let mut frame = space.frame();
    for t in [0.0, 0.3, 1.0, 1.2] {
        frame.seek(&[1.0 - t, t]);
        assert_eq!(frame.figure(), pair.frame(t).figure(), "{t}");
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn weights_are_corrected_to_sum_to_one() {
    let space = space(vec![star("a", 5, 1.5), star("b", 6, 0.8)]);
    let mut frame = space.frame();
    frame.seek(&[f64::NAN, 0.5]);
    assert_eq!(frame.weights(), [0.25, 0.75]);
    frame.seek(&[2.0, -1.0]);
    assert!(frame.is_extrapolated());
    assert_eq!(space.colour_fraction(&[0.25, 0.75]), 0.75);
}

#[test]
fn too_few_designs_and_cancellation_are_errors() {
    let build = |designs: Vec<Arc<Design>>, progress: &dyn Progress| {
        DesignSpace::build(&SpaceSpec::new(designs), progress)
    };
    let too_few = build(vec![star("a", 5, 1.0)], &Silent);
    assert!(matches!(too_few, Err(SpaceError::TooFew(1))));
    #[derive(Debug)]
    struct CancelledSpaceProgress;
    impl Progress for CancelledSpaceProgress {
        fn report(&self, _: &'static str, _: f64) {}
        fn is_cancelled(&self) -> bool {
            true
        }
    }
    let designs = vec![star("a", 5, 1.0), star("b", 6, 1.0), frame("c", 1.0)];
    let cancelled = build(designs, &CancelledSpaceProgress);
    let is_cancelled = matches!(
        cancelled,
        Err(SpaceError::Cancelled(Cancelled) | SpaceError::Build(BuildError::Cancelled(Cancelled)))
    );
    assert!(is_cancelled, "{cancelled:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn every_blend_of_stars_has_one_ring(
        shapes in prop::collection::vec((3u32..8, 0.2..2.0_f64), 3..6),
        weights in prop::collection::vec(0.0..1.0_f64, 6),
    ) {
        let stars = shapes.iter().map(|&(points, depth)| star("star", points, depth));
        let space = space(stars.collect());
        prop_assert!(space.family().is_some(), "{:?}", space.notes());
        let weights = &weights[..shapes.len()];
        let sum: f64 = weights.iter().sum::<f64>().max(1e-9);
        let weights: Vec<f64> = weights.iter().map(|weight| weight / sum).collect();
        let mut frame = space.frame();
        frame.seek(&weights);
        let figure = frame.figure();
        prop_assert_eq!(figure.rings.len(), 1);
        prop_assert!(figure.rings[0].iter().all(|p| p.is_finite() && p.length() < 6.0));
    }
}

fn path_through(places: &[DVec2]) -> MapPath {
    MapPath {
        name: String::new(),
        places: places.iter().copied().map(Waypoint::stop).collect(),
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_path_shows_the_blends_along_it() {
    // The blends of these designs do not fold, so no face is unfolded, which would make the motion
    // less smooth in t.
    let space = space(vec![
        star("a", 5, 1.5),
        star("b", 6, 0.8),
        star("c", 4, 1.0),
    ]);
    let map = WeightMap::new(&MapLayout::Polygon.sites(space.distances())).expect("a map");
    let sites = map.sites();
    let path = path_through(&[sites[0], DVec2::new(0.1, 0.2), sites[2]]);
    let film = space.path_sequence(&map, &path, &Silent).expect("a film");
    assert_eq!(film.end(), 2.0);
    let curve = MapCurve::new(&path).expect("a curve");
    let (mut blend, mut weights) = (space.frame(), vec![0.0; 3]);
    let mut frame = film.frame(0.0);
    for t in [0.0, 0.3, 1.0, 1.5, 2.0] {
        frame.seek(t);
        map.weights(curve.at(t), &mut weights);
        blend.seek(&weights);
        let [on_path, on_map] = [frame.frame().figure(), blend.figure()].map(|f| f.rings.concat());
        let gaps = on_path.iter().zip(&on_map).map(|(p, q)| p.distance(*q));
        let max_gap = gaps.fold(0.0, f64::max);
        // The film is exact at stops and approximate in between.
        let tolerance = if t.fract() == 0.0 { 0.0 } else { 0.02 };
        assert!(max_gap <= tolerance, "{t}: {max_gap}");
    }
    let [first, last] = [&film.segments()[0], &film.segments()[1]];
    assert_eq!(first.designs()[0].name, "a");
    assert_eq!(last.designs()[1].name, "c");
    // The middle stop of the path is named after the designs with the largest weights.
    assert!(
        first.designs()[1].name.contains('%'),
        "{}",
        first.designs()[1].name
    );
    assert!(first.compatible().is_some() && first.arap().is_none());
    // The motion is smooth, so it can be recorded.
    let recorded = first.record(&crate::recording::RecordingOptions::default(), &Silent);
    assert!(recorded.is_ok(), "{recorded:?}");
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_path_through_fields_follows_the_map() {
    let spec = SpaceSpec {
        content: Some(ContentKind::Field),
        ..SpaceSpec::new(vec![star("a", 5, 1.5), frame("b", 1.0), star("c", 4, 2.0)])
    };
    let space = DesignSpace::build(&spec, &Silent).expect("a space");
    let map = WeightMap::new(&MapLayout::Polygon.sites(space.distances())).expect("a map");
    let sites = map.sites();
    let film = space.path_sequence(
        &map,
        &path_through(&[sites[1], sites[2], DVec2::ZERO]),
        &Silent,
    );
    let film = film.expect("a film");
    let (mut blend, mut frame) = (space.frame(), film.frame(0.0));
    frame.seek(0.0);
    blend.seek(&corner(3, 1));
    assert_eq!(frame.frame().figure().rings, blend.figure().rings);
    let area = |rings: &[Vec<DVec2>]| {
        let each = rings.iter().map(|ring| crate::geometry::signed_area(ring));
        each.sum::<f64>()
    };
    for t in [0.41, 1.0, 1.37, 2.0] {
        frame.seek(t);
        let fraction = if t < 1.0 { t } else { t - 1.0 };
        let place = match t < 1.0 {
            true => sites[1].lerp(sites[2], fraction),
            false => sites[2].lerp(DVec2::ZERO, fraction),
        };
        // The smooth curve leaves the straight line between the stops, so areas are compared with a
        // tolerance.
        let mut weights = vec![0.0; 3];
        map.weights(place, &mut weights);
        blend.seek(&weights);
        let [on_path, nearby] = [frame.frame().figure(), blend.figure()].map(|f| area(&f.rings));
        assert!(
            (on_path / nearby - 1.0).abs() < 0.15,
            "{t}: {on_path} {nearby}"
        );
    }
}

#[test]
fn a_path_through_trusses_keeps_their_bars() {
    let space = space(vec![truss("a", 1.0), truss("b", 2.0), truss("c", 3.0)]);
    let map = WeightMap::new(&MapLayout::Line.sites(space.distances())).expect("a map");
    let film = space.path_sequence(
        &map,
        &path_through(&[DVec2::NEG_X, DVec2::new(0.5, 0.0)]),
        &Silent,
    );
    let film = film.expect("a film");
    let frame = film.frame(1.0);
    assert_eq!(frame.frame().figure().bars.len(), 7);
    let DesignForm::Truss(end) = &film.segments()[0].designs()[1].form else {
        panic!("no truss");
    };
    assert_eq!(end.bars().len(), 7);
    // An empty path, or a map with another number of sites, gives no film.
    let result = space.path_sequence(&map, &MapPath::default(), &Silent);
    assert!(matches!(result, Err(SpaceError::NoPath)));
    let other = WeightMap::new(&[DVec2::ZERO, DVec2::X]).expect("a map");
    let result = space.path_sequence(&other, &path_through(&[DVec2::ZERO, DVec2::X]), &Silent);
    assert!(matches!(result, Err(SpaceError::NoPath)));
}
