//! Sizing, findings, trusses between designs, and the analysis of whole transitions.

use super::{analysed, assert_close, truss};
use crate::design::{Design, Truss};
use crate::geometry::DVec2;
use crate::project::gallery;
use crate::structure::{
    FilmStructure, LoadSelection, SizingOptions, Soundness, StructuralBlend, StructureError,
    StructureFault, StructureLimits, StructureSolver,
};
use crate::transition::{Transition, TransitionSpec};
use crate::work::progress::{Progress, Silent};
use serde_json::{Value, json};
use std::sync::Arc;

fn solver(trusses: &[&Truss]) -> StructureSolver {
    let blend = StructuralBlend::of(trusses).expect("a blend");
    StructureSolver::new(Arc::new(blend)).expect("a solver")
}

fn film(files: [&Value; 2]) -> FilmStructure {
    let [source, target] = files.map(|file| Arc::new(Design::new("truss", truss(file))));
    let spec = TransitionSpec::new(source, target);
    let transition = Transition::build(&spec, &Silent).expect("a transition");
    let film = FilmStructure::of(&transition, 25, &StructureLimits::default(), &Silent);
    film.expect("a structure")
}

/// A bracket of two bars that carries a load at its tip.
fn bracket(tip: [f64; 2], areas: [f64; 2], load: f64) -> Value {
    json!({
        "units": {"length": "m", "force": "kN"},
        "nodes": [[0, 0], [0, 3], tip], "bars": [[0, 2], [1, 2]], "areas": areas,
        "materials": [{"name": "S235"}], "bar_materials": [0, 0],
        "supports": [{"node": 0, "fixed": [true, true]}, {"node": 1, "fixed": [true, true]}],
        "loads": [{"node": 2, "force": [0, -load]}],
    })
}

#[test]
fn sized_bars_just_carry_their_forces() {
    let truss = truss(&bracket([4.0, 0.0], [1e-3, 1e-3], 100.0));
    let mut solver = solver(&[&truss]);
    let options = SizingOptions::default();
    let sized = solver.size_members(truss.nodes(), &[1.0], LoadSelection::All, &options, &Silent);
    let sized = sized.expect("not cancelled").expect("it stands");
    assert!(sized.is_converged);
    // The tie carries 5/3 of the load, the strut 4/3 in compression, where buckling governs.
    assert_close(sized.areas[1], 100e3 * 5.0 / 3.0 / 235e6, 1e-6);
    let state = solver.state();
    assert_close(state.euler_utilisation(0).expect("pinned"), 1.0, 1e-5);
    assert!(state.utilisation(0) < 1.0);
    assert_close(
        sized.mass,
        7850.0 * (4.0 * sized.areas[0] + 5.0 * sized.areas[1]),
        1e-12,
    );
}

#[test]
fn a_sized_truss_needs_areas_that_the_given_ones_do_not_influence() {
    let sized = [[1e-3, 1e-3], [1e-2, 1e-5]].map(|areas| {
        let truss = truss(&bracket([4.0, 0.0], areas, 100.0));
        let options = SizingOptions::default();
        let mut solver = solver(&[&truss]);
        let loads = LoadSelection::All;
        let sized = solver.size_members(truss.nodes(), &[1.0], loads, &options, &Silent);
        sized.expect("not cancelled").expect("it stands").areas
    });
    for (a, b) in sized[0].iter().zip(&sized[1]) {
        assert_close(*a, *b, 1e-5);
    }
}

/// Load at the tip of a bracket whose tip moves down to the level of its foot and below.
#[test]
fn a_film_reports_what_governs() {
    let strong = bracket([4.0, 0.0], [5e-3, 5e-3], 100.0);
    let weak = bracket([4.0, 0.5], [5e-3, 2e-4], 100.0);
    let sound = film([&strong, &strong]);
    assert_eq!(sound.findings, []);
    assert!(sound.soundness.iter().all(|s| *s == Soundness::Sound));
    assert!(sound.proof.expect("a proof").holds());
    let film = film([&strong, &weak]);
    let StructureFault::OverStrength { bar, utilisation } = film.findings[0].fault else {
        panic!("{:?}", film.findings)
    };
    assert_eq!(
        (bar, film.findings[0].t, film.findings[0].to),
        (1, 1.0, 1.0)
    );
    assert!(utilisation > 3.0);
    let text = film.findings[0].to_string();
    assert!(
        text.starts_with("bar 1 is at ") && text.contains("of its strength at t = 1.000"),
        "{text}"
    );
    assert_eq!(film.soundness[0], Soundness::Sound);
    assert_eq!(film.soundness[24], Soundness::Unsound);
}

#[test]
fn a_film_that_passes_through_a_mechanism_falls_over() {
    let [above, below] = [2.0, -1.0].map(|height| {
        let mut file = bracket([1.0, height], [5e-3, 5e-3], 1.0);
        file["nodes"][1] = json!([3, 0]);
        file
    });
    let film = film([&above, &below]);
    let proof = film.proof.expect("a recording");
    assert!(!proof.holds());
    assert_eq!(proof.moving_nodes, [2]);
    // No sample lies exactly on the mechanism, but the proof finds it.
    assert!(proof.fails_at.is_some_and(|t| t > 0.1 && t < 0.9));
}

#[test]
fn every_kind_of_fault_of_a_standing_structure_is_found() {
    let kinds = |file: &Value| -> Vec<usize> {
        let film = film([file, file]);
        film.findings
            .iter()
            .map(|finding| finding.fault.rank())
            .collect()
    };
    let rank = |fault: StructureFault| fault.rank();
    let buckles = rank(StructureFault::BarBuckles {
        bar: 0,
        utilisation: 0.0,
    });
    assert!(kinds(&bracket([4.0, 0.0], [4e-4, 5e-3], 50.0)).contains(&buckles));
    let slender = rank(StructureFault::Slender {
        bar: 0,
        slenderness: 0.0,
        limit: 0.0,
    });
    assert!(kinds(&bracket([4.0, 0.0], [1e-5, 5e-3], 0.001)).contains(&slender));
    let sharp = rank(StructureFault::SharpAngle {
        bars: [0, 1],
        angle_deg: 0.0,
    });
    assert!(kinds(&bracket([40.0, 0.0], [1e-1, 1e-1], 1.0)).contains(&sharp));
    let mut file = bracket([4.0, 0.0], [5e-3, 5e-3], 1.0);
    file["loads"] = json!([{"node": 2, "force": [0, -1], "moment": 3}]);
    let on_nothing = rank(StructureFault::LoadOnNothing { nodes: vec![] });
    assert_eq!(kinds(&file)[0], on_nothing);
    let mut file = bracket([0.05, 0.0], [5e-3, 5e-3], 1.0);
    file["nodes"][1] = json!([0, 0.05]);
    assert!(kinds(&file).contains(&rank(StructureFault::Stub {
        bar: 0,
        length: 0.0
    })));
    let mut file = bracket([4.0, 0.0], [5e-3, 5e-3], 1.0);
    file["nodes"] = json!([[0, 0], [0, 3], [4, 0], [1, 1], [1, 2]]);
    file["bars"] = json!([[0, 2], [1, 2], [3, 4]]);
    file["areas"] = json!([5e-3, 5e-3, 5e-3]);
    file["bar_materials"] = json!([0, 0, 0]);
    let film = film([&file, &file]);
    let texts: Vec<String> = film.findings.iter().map(ToString::to_string).collect();
    assert!(
        texts[0].starts_with("not held: nodes 3 and 4 move as a whole"),
        "{texts:?}"
    );
    assert!(texts[1].starts_with("in 2 pieces"), "{texts:?}");
}

#[test]
fn numbers_that_cannot_be_computed_with_are_refused() {
    let error = |key: &str, value: Value| {
        let mut file = bracket([4.0, 0.0], [5e-3, 5e-3], 1.0);
        file[key] = value;
        StructuralBlend::of(&[&truss(&file)])
            .expect_err(key)
            .to_string()
    };
    let infinite = json!([{"node": 2, "force": [0, 1e308]}, {"node": 2, "force": [0, 1e308]}]);
    assert!(error("loads", infinite).starts_with("a load is too large to compute with"));
    let case = json!([{"name": "storm", "factor": 1e40, "self_weight": true}]);
    assert!(error("load_cases", case).starts_with("a load of the load case storm is too large"));
    let spring = json!([{"node": 2, "along": [0, 1], "stiffness": 1e300}]);
    assert!(error("springs", spring).starts_with("spring 0 is too stiff"));
}

#[test]
fn a_mechanism_at_a_design_is_reported_there() {
    let held = bracket([4.0, 0.0], [5e-3, 5e-3], 1.0);
    let mut loose = held.clone();
    loose["supports"] = json!([]);
    let film = film([&held, &loose]);
    let proof = film.proof.expect("a proof");
    // Without the supports nothing is proved, but the structure falls over only at t = 1.
    assert!(proof.is_mechanism);
    assert_eq!(proof.fails_at, Some(1.0));
}

/// Progress of work that was cancelled before it began.
struct CancelledSizing;

impl Progress for CancelledSizing {
    fn report(&self, _: &'static str, _: f64) {}

    fn is_cancelled(&self) -> bool {
        true
    }
}

#[test]
fn cancelled_sizing_ends() {
    let truss = truss(&bracket([4.0, 0.0], [1e-3, 1e-3], 100.0));
    let cancelled = solver(&[&truss]).size_members(
        truss.nodes(),
        &[1.0],
        LoadSelection::All,
        &SizingOptions::default(),
        &CancelledSizing,
    );
    assert!(cancelled.is_err());
}

#[test]
fn outlines_have_no_structure() {
    let spec = gallery::load("triangle-polar")
        .expect("a project")
        .spec()
        .expect("a pair");
    let transition = Transition::build(&spec, &Silent).expect("a transition");
    let film = FilmStructure::of(&transition, 3, &StructureLimits::default(), &Silent);
    let error = film.expect_err("no truss");
    assert!(matches!(error, StructureError::NoTruss(_)), "{error}");
    assert!(
        error
            .to_string()
            .ends_with("has no bars; open a truss to analyse it")
    );
}

/// Two frames with everything that a file can hold.
fn frames() -> [Truss; 2] {
    let file = |height: f64, area: f64, supports: Value, wind: f64| {
        truss(&json!({
            "units": {"length": "mm", "force": "kN", "stress": "MPa"},
            "nodes": [[0, 0], [0, height], [6000, height], [6000, 0]],
            "bars": [[0, 1], [1, 2], [2, 3], [0, 2]],
            "sections": [
                {"name": "IPE", "area": area, "shape": "i", "second_moment": 8e7, "depth": 300},
                {"shape": {"tube": {"ratio": 15}}, "area": 500}
            ],
            "bar_sections": [0, 0, 0, 1],
            "materials": [{"name": "steel S355"}, {"name": "timber", "youngs_modulus": 11000,
                "strength": 20, "density": 4.2e-7}],
            "bar_materials": [0, 1, 0, 0],
            "bar_fixity": [[0, 1], [1, 0.5], [0.5, 1], [0, 0]],
            "supports": supports,
            "springs": [{"node": 2, "along": [1, 1], "stiffness": 0.2}],
            "load_cases": [
                {"name": "wind", "factor": 1.5, "loads": [{"node": 1, "force": [wind, 0]}]},
                {"name": "snow", "line_loads": [{"bars": [1], "force": [0, -0.012], "in_plan": true}]},
                {"name": "weight", "self_weight": true},
            ],
        }))
    };
    [
        file(
            3000.0,
            6000.0,
            json!([{"node": 0, "fixed": [true, true]}, {"node": 3, "fixed": [true, true, true]}]),
            10.0,
        ),
        file(
            4500.0,
            8000.0,
            json!([{"node": 0, "fixed": [true, true]}, {"node": 3, "rolls_along": [1, 0.2]}]),
            20.0,
        ),
    ]
}

#[test]
fn a_truss_between_designs_has_the_same_results_when_it_is_read_again() {
    let frames = frames();
    let blend = Arc::new(StructuralBlend::of(&[&frames[0], &frames[1]]).expect("a blend"));
    let mut solver = StructureSolver::new(Arc::clone(&blend)).expect("a solver");
    for t in [0.0, 0.3, 0.5, 1.0] {
        let weights = [1.0 - t, t];
        let nodes = frames[0].nodes().iter().zip(frames[1].nodes());
        let places: Vec<DVec2> = nodes.map(|(a, b)| a.lerp(*b, t)).collect();
        let expected = solver.solve(&places, &weights, LoadSelection::All).clone();
        assert!(!expected.is_mechanism);
        let between = solver.truss_between(&weights).expect("a truss");
        let again = analysed(&Truss::from_json(&between.to_json()).expect("a valid file"));
        for (a, b) in again.forces.iter().zip(&expected.forces) {
            assert_close(a.axial, b.axial, 1e-8);
            assert!(
                (a.largest_moment() - b.largest_moment()).abs() < 1e-8 * 1e4,
                "{t}"
            );
        }
        for (a, b) in again.displacements.iter().zip(&expected.displacements) {
            assert!(
                (0..3).all(|k| (a[k] - b[k]).abs() < 1e-10),
                "{t}: {a:?} {b:?}"
            );
        }
        assert_close(again.mass, expected.mass, 1e-12);
        assert_close(again.frequency, expected.frequency, 1e-8);
        assert_close(again.total_load.y, expected.total_load.y, 1e-12);
    }
}
