//! Structures between two designs.

use super::{analysed, assert_close, truss};
use crate::design::Truss;
use crate::geometry::DVec2;
use crate::structure::{LoadSelection, StructuralBlend, StructuralState, StructureSolver};
use serde_json::{Value, json};
use std::sync::Arc;

/// A bracket of three bars; the second differs in places, areas and the order of its bars.
fn brackets() -> [Value; 2] {
    let first = json!({
        "units": {"length": "m", "force": "kN"},
        "nodes": [[0, 0], [0, 3], [4, 1]],
        "bars": [[0, 1], [0, 2], [1, 2]],
        "areas": [1e-3, 2e-3, 3e-3],
        "sections": [{"shape": "round"}], "bar_sections": [0, 0, 0],
        "supports": [{"node": 0, "fixed": [true, true]}, {"node": 1, "fixed": [true, false]}],
        "loads": [{"node": 2, "force": [0, -10]}],
    });
    let mut second = first.clone();
    second["nodes"] = json!([[0, 0], [0, 3], [6, 4]]);
    second["bars"] = json!([[2, 1], [1, 0], [0, 2]]);
    second["areas"] = json!([5e-3, 1e-3, 4e-3]);
    [first, second]
}

/// Analyses the blend of two trusses at t, with nodes that move on straight lines.
fn between(trusses: &[Truss; 2], t: f64) -> StructuralState {
    let blend = StructuralBlend::of(&[&trusses[0], &trusses[1]]).expect("a blend");
    let mut solver = StructureSolver::new(Arc::new(blend)).expect("a solver");
    let places = trusses[0].nodes().iter().zip(trusses[1].nodes());
    let places: Vec<DVec2> = places.map(|(a, b)| a.lerp(*b, t)).collect();
    solver
        .solve(&places, &[1.0 - t, t], LoadSelection::All)
        .clone()
}

#[test]
fn both_ends_are_the_designs_themselves() {
    let trusses = brackets().map(|file| truss(&file));
    let order = [1, 2, 0];
    let ends = [analysed(&trusses[0]), analysed(&trusses[1])];
    let [first, last] = [0.0, 1.0].map(|t| between(&trusses, t));
    for (bar, &other) in order.iter().enumerate() {
        assert_eq!(first.forces[bar].axial, ends[0].forces[bar].axial);
        assert_close(last.forces[bar].axial, ends[1].forces[other].axial, 1e-12);
        assert_close(
            last.properties[bar].area,
            ends[1].properties[other].area,
            1e-15,
        );
    }
    let middle = between(&trusses, 0.5);
    assert_close(middle.properties[1].area, 3e-3, 1e-15);
    let radius = |area: f64| (area / (4.0 * std::f64::consts::PI)).sqrt();
    let mean = 0.5 * (radius(2e-3) + radius(4e-3));
    assert_close(middle.properties[1].radius, mean, 1e-14);
    assert_close(
        middle.properties[1].second_moment(),
        3e-3 * mean * mean,
        1e-14,
    );
}

#[test]
fn designs_with_other_bars_are_refused() {
    let [first, mut second] = brackets();
    second["nodes"] = json!([[0, 0], [0, 3], [6, 4], [7, 7]]);
    second["bars"] = json!([[2, 1], [1, 0], [0, 2], [2, 3]]);
    second["areas"] = json!([5e-3, 1e-3, 4e-3, 1e-3]);
    second["bar_sections"] = json!([0, 0, 0, 0]);
    let [first, second] = [first, second].map(|file| truss(&file));
    let error = StructuralBlend::of(&[&first, &second]).expect_err("other bars");
    assert!(
        error
            .to_string()
            .starts_with("the designs do not have the same bars")
    );
}

#[test]
fn designs_in_other_units_are_one_structure() {
    let [metric, _] = brackets();
    let mut millimetres = metric.clone();
    millimetres["units"] = json!({"length": "mm", "force": "N"});
    millimetres["nodes"] = json!([[0, 0], [0, 3000], [4000, 1000]]);
    millimetres["areas"] = json!([1e3, 2e3, 3e3]);
    millimetres["loads"][0]["force"] = json!([0, -1e4]);
    let trusses = [metric, millimetres].map(|file| truss(&file));
    let [a, b] = trusses.each_ref().map(analysed);
    for (a, b) in a.forces.iter().zip(&b.forces) {
        assert_close(a.axial, b.axial, 1e-12);
    }
    assert_close(a.displacements[2][1], b.displacements[2][1], 1e-12);
}

/// A beam whose right support exists only in the first design.
#[test]
fn a_support_that_one_design_lacks_is_a_spring() {
    let file = |supports: Value| {
        truss(&json!({
            "units": {"length": "m", "force": "N"},
            "nodes": [[0, 0], [2, 0]], "bars": [[0, 1]], "fixity": 1,
            "sections": [{"area": 2e-3, "second_moment": 3e-6}], "bar_sections": [0],
            "supports": supports,
            "loads": [{"node": 1, "force": [0, -100]}],
        }))
    };
    let foot = json!({"node": 0, "fixed": [true, true, true]});
    let trusses = [
        file(json!([foot, {"node": 1, "fixed": [false, true]}])),
        file(json!([foot])),
    ];
    let mut last = 0.0;
    for t in [0.0, 0.1, 0.5, 0.9, 0.999, 1.0] {
        let state = between(&trusses, t);
        assert!(!state.is_mechanism);
        let sag = -state.displacements[1][1];
        assert!(sag > last || t == 0.0, "{t}: {sag} after {last}");
        assert!(t > 0.0 || sag.abs() < 1e-15, "{sag}");
        // Reactions of the support and of the foot carry the load together.
        assert_close(state.reactions[0][1] + state.reactions[1][1], 100.0, 1e-9);
        last = sag;
    }
    assert_close(last, 100.0 * 8.0 / (3.0 * 210e9 * 3e-6), 1e-12);
    // k₀ is the mean EA/L.
    let spring = 210e9 * 2e-3 / 2.0 * 1.0;
    let beam = 3.0 * 210e9 * 3e-6 / 8.0;
    assert_close(
        between(&trusses, 0.5).displacements[1][1],
        -100.0 / (spring + beam),
        1e-12,
    );
}

#[test]
fn a_roller_that_turns_is_held_in_between() {
    let [first, second] = [[1.0, 0.0], [1.0, 1.0]].map(|along| {
        let mut file = brackets()[0].clone();
        file["supports"] = json!([
            {"node": 0, "fixed": [true, true]}, {"node": 1, "rolls_along": along}
        ]);
        truss(&file)
    });
    let state = between(&[first, second], 0.5);
    assert!(!state.is_mechanism);
    let across = DVec2::from_angle(std::f64::consts::FRAC_PI_8).perp();
    let [x, y, _] = state.displacements[1];
    assert!(DVec2::new(x, y).dot(across).abs() < 1e-15);
    let [x, y, _] = state.reactions[1];
    assert!(DVec2::new(x, y).perp_dot(across).abs() < 1e-6);
}

#[test]
fn loads_along_a_chain_keep_their_sum_when_it_becomes_longer() {
    let file = |height: f64, load: f64| {
        truss(&json!({
            "units": {"length": "m", "force": "N"},
            "nodes": [[0, 0], [2, height], [4, 0]], "bars": [[0, 1], [1, 2], [0, 2]],
            "supports": [{"node": 0, "fixed": [true, true]}, {"node": 2, "fixed": [false, true]}],
            "load_cases": [
                {"name": "roof", "line_loads": [{"bars": [0, 1], "force": [0, -load]}]},
                {"name": "weight", "self_weight": true, "factor": 0},
            ],
        }))
    };
    // Roofs of 4.47 m and of 8.25 m in length with the same sum of 1,000 N.
    let lengths = [2.0_f64, 8.0].map(|h| 2.0 * (4.0 + (0.5 * h).powi(2)).sqrt());
    let trusses = [
        file(1.0, 1000.0 / lengths[0]),
        file(4.0, 1000.0 / lengths[1]),
    ];
    for t in [0.0, 0.3, 0.8, 1.0] {
        let state = between(&trusses, t);
        assert_close(state.total_load.y, -1000.0, 1e-12);
        assert_close(state.reactions[0][1] + state.reactions[2][1], 1000.0, 1e-9);
    }
    let blend = Arc::new(StructuralBlend::of(&[&trusses[0]]).expect("a structure"));
    assert_eq!(blend.case_names(), ["roof", "weight"]);
    let mut solver = StructureSolver::new(blend).expect("a solver");
    let weight = solver.solve(trusses[0].nodes(), &[1.0], LoadSelection::Case(1));
    assert_close(weight.total_load.y, -9.80665 * weight.mass, 1e-12);
}
