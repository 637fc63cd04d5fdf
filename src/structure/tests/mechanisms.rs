//! Mechanisms, whose moving nodes must be found, and structures that are nearly mechanisms.

use super::{analysed, truss};
use crate::geometry::DVec2;
use crate::structure::{LoadSelection, StructuralBlend, StructuralState, StructureSolver};
use serde_json::{Value, json};
use std::sync::Arc;

/// Returns a structure of steel bars of 10 cm² with a load at the last node. `supports` lists nodes
/// with the fixed displacements: a text of "x", "y" and "r".
fn structure(nodes: &[[f64; 2]], bars: &[[u32; 2]], supports: &[(u32, &str)]) -> Value {
    let support = |&(node, fixed): &(u32, &str)| {
        let fixed = ["x", "y", "r"].map(|axis| fixed.contains(axis));
        json!({"node": node, "fixed": fixed})
    };
    json!({
        "units": {"length": "m", "force": "kN"},
        "nodes": nodes, "bars": bars, "areas": vec![1e-3; bars.len()],
        "supports": supports.iter().map(support).collect::<Vec<_>>(),
        "loads": [{"node": nodes.len() - 1, "force": [3, -10]}],
    })
}

/// Returns the structure with one value replaced.
fn with(mut file: Value, key: &str, value: Value) -> Value {
    file[key] = value;
    file
}

fn state(file: &Value) -> StructuralState {
    analysed(&truss(file))
}

/// Nodes and bars of a row of square panels, without diagonals: bottom nodes first.
fn panels(count: u32) -> (Vec<[f64; 2]>, Vec<[u32; 2]>) {
    let row = |y: f64| (0..=count).map(move |k| [f64::from(k), y]);
    let nodes = row(0.0).chain(row(1.0)).collect();
    let top = count + 1;
    let chords = (0..count).flat_map(move |k| [[k, k + 1], [top + k, top + k + 1]]);
    let posts = (0..=count).map(move |k| [k, top + k]);
    (nodes, chords.chain(posts).collect())
}

/// A row of panels with the given diagonals, each from the bottom of the panel `k` to its top.
fn braced(count: u32, diagonals: &[u32], supports: &[(u32, &str)]) -> Value {
    let (nodes, mut bars) = panels(count);
    bars.extend(diagonals.iter().map(|&k| [k, count + 2 + k]));
    structure(&nodes, &bars, supports)
}

/// A straight chain of frame members with rigid joints, except at the bar ends in `hinges`.
fn beam(lengths: &[f64], hinges: &[(usize, usize)], supports: &[(u32, &str)]) -> Value {
    let mut x = 0.0;
    let steps = lengths.iter().map(|length| {
        x += length;
        [x, 0.0]
    });
    let nodes: Vec<[f64; 2]> = std::iter::once([0.0, 0.0]).chain(steps).collect();
    let bars: Vec<[u32; 2]> = (0..lengths.len() as u32).map(|k| [k, k + 1]).collect();
    let mut fixity = vec![[1.0, 1.0]; bars.len()];
    for &(bar, end) in hinges {
        fixity[bar][end] = 0.0;
    }
    with(
        structure(&nodes, &bars, supports),
        "bar_fixity",
        json!(fixity),
    )
}

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [4.0, 0.0], [1.0, 3.0]];
const TRIANGLE_BARS: [[u32; 2]; 3] = [[0, 1], [1, 2], [2, 0]];
const PINS: [(u32, &str); 2] = [(0, "xy"), (1, "xy")];
const SIMPLE: [(u32, &str); 2] = [(0, "xy"), (1, "y")];

fn rollers(file: Value, rolls: &[(u32, [f64; 2])]) -> Value {
    let support = |&(node, along): &(u32, [f64; 2])| json!({"node": node, "rolls_along": along});
    let supports = rolls.iter().map(support).collect();
    with(file, "supports", supports)
}

/// Named mechanisms with the nodes that move.
#[expect(clippy::too_many_lines, reason = "a table of structures")]
fn mechanisms() -> Vec<(&'static str, Value, Vec<u32>)> {
    let span = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]];
    let chain = [[0, 1], [1, 2], [2, 3]];
    let triangle = |supports: &[(u32, &str)]| structure(&TRIANGLE, &TRIANGLE_BARS, supports);
    let square_bars = [[0, 1], [1, 2], [2, 3], [3, 0]];
    let with_tip = [TRIANGLE[0], TRIANGLE[1], TRIANGLE[2], [5.0, 5.0]];
    let far = [
        [0.0, 0.0],
        [4.0, 0.0],
        [1.0, 3.0],
        [9.0, 0.0],
        [9.0, 1.0],
        [8.0, 0.5],
    ];
    let two_triangles = [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]];
    let tip = [[0, 1], [1, 2], [2, 0], [1, 3], [2, 3]];
    let gerber = |hinges: &[(usize, usize)]| beam(&[2.0, 3.0, 1.0], hinges, &[(0, "xy"), (3, "y")]);
    vec![
        (
            "a hinge in a span",
            structure(&span[..3], &chain[..2], &[(0, "xy"), (2, "xy")]),
            vec![1],
        ),
        (
            "two hinges in a span",
            structure(&span, &chain, &[(0, "xy"), (3, "xy")]),
            vec![1, 2],
        ),
        (
            "a hanging chain",
            structure(
                &[[0.0, 0.0], [1.0, -1.0], [2.0, -1.5], [3.0, 0.0]],
                &chain,
                &[(0, "xy"), (3, "xy")],
            ),
            vec![1, 2],
        ),
        (
            "a square without a diagonal",
            structure(&SQUARE, &square_bars, &PINS),
            vec![2, 3],
        ),
        (
            "three parallel rollers",
            triangle(&[(0, "y"), (1, "y"), (2, "y")]),
            vec![0, 1, 2],
        ),
        (
            // The lines across the rollers meet in the point (2, 1).
            "three rollers around a point",
            rollers(
                triangle(&[]),
                &[(0, [-1.0, 2.0]), (1, [1.0, 2.0]), (2, [2.0, 1.0])],
            ),
            vec![0, 1, 2],
        ),
        (
            "an unbraced panel of a cantilever",
            braced(3, &[0, 2], &[(0, "xy"), (4, "xy")]),
            vec![2, 3, 6, 7],
        ),
        (
            "a panel braced twice and one not at all",
            {
                let (nodes, mut bars) = panels(2);
                bars.extend([[0, 4], [1, 3]]);
                structure(&nodes, &bars, &[(0, "xy"), (3, "xy")])
            },
            vec![2, 5],
        ),
        (
            "a floating piece",
            structure(&far, &two_triangles, &SIMPLE),
            vec![3, 4, 5],
        ),
        (
            "a bar of no area",
            with(
                structure(&with_tip, &tip, &SIMPLE),
                "areas",
                json!([1e-3, 1e-3, 1e-3, 1e-3, 0.0]),
            ),
            vec![3],
        ),
        (
            "a node without any area around it",
            with(
                structure(&with_tip, &tip, &SIMPLE),
                "areas",
                json!([1e-3, 1e-3, 1e-3, 0.0, 0.0]),
            ),
            vec![3],
        ),
        (
            "bars without any area",
            with(triangle(&SIMPLE), "areas", json!([0.0, 0.0, 0.0])),
            vec![1, 2],
        ),
        (
            "a dangling bar",
            structure(&with_tip, &tip[..4], &SIMPLE),
            vec![3],
        ),
        ("no supports", triangle(&[]), vec![0, 1, 2]),
        ("a single pin", triangle(&[(0, "xy")]), vec![1, 2]),
        (
            "a pin and a roller that rolls around it",
            triangle(&[(0, "xy"), (1, "x")]),
            vec![1, 2],
        ),
        (
            "rafters without a tie",
            structure(
                &[[0.0, 0.0], [4.0, 0.0], [2.0, 1.0]],
                &[[0, 2], [2, 1]],
                &SIMPLE,
            ),
            vec![1, 2],
        ),
        (
            "a beam with two hinges in its span",
            gerber(&[(0, 1), (2, 0)]),
            vec![1, 2],
        ),
        (
            "a beam with one hinge in its span",
            gerber(&[(0, 1)]),
            vec![1, 2],
        ),
        (
            "a mast on a pin",
            beam(&[1.0, 1.0], &[], &[(0, "xy")]),
            vec![1, 2],
        ),
        (
            "a beam that slides off its rollers",
            beam(&[1.0, 1.0], &[], &[(0, "y"), (2, "y")]),
            vec![0, 1, 2],
        ),
        (
            "a frame with hinged corners and pinned feet",
            with(
                structure(
                    &[SQUARE[0], SQUARE[3], SQUARE[2], SQUARE[1]],
                    &chain,
                    &[(0, "xy"), (3, "xy")],
                ),
                "bar_fixity",
                json!([[1, 0], [0, 0], [0, 1]]),
            ),
            vec![1, 2],
        ),
    ]
}

#[test]
fn mechanisms_are_named_with_the_nodes_that_move() {
    let cases = mechanisms();
    assert!(cases.len() >= 20);
    for (name, file, moving) in cases {
        let state = state(&file);
        assert!(state.is_mechanism, "{name}: {} Hz", state.frequency);
        assert_eq!(state.moving_nodes(), moving, "{name}: {:?}", state.mode);
        assert!(
            state.forces.iter().all(|forces| forces.axial == 0.0),
            "{name}"
        );
    }
}

/// Structures that stand although they are near a mechanism.
#[expect(clippy::too_many_lines, reason = "a table of structures")]
fn near_mechanisms() -> Vec<(String, Value)> {
    let mut cases = Vec::new();
    for rise in [1e-1, 1e-2, 1e-3] {
        cases.push((
            format!("a shallow arch of two bars with a rise of {rise}"),
            structure(
                &[[0.0, 0.0], [2.0, 0.0], [1.0, rise]],
                &[[0, 2], [2, 1]],
                &PINS,
            ),
        ));
    }
    for share in [1e-2, 1e-4, 1e-6] {
        let file = braced(3, &[0, 1, 2], &[(0, "xy"), (4, "xy")]);
        let bars = file["bars"].as_array().expect("bars").len();
        let mut areas = vec![1e-3; bars];
        areas[bars - 2] *= share;
        cases.push((
            format!("a diagonal of {share} of the other areas"),
            with(file, "areas", json!(areas)),
        ));
    }
    for slope in [1e-1, 1e-2, 1e-3] {
        cases.push((
            format!("three rollers that are parallel but for {slope}"),
            rollers(
                structure(&TRIANGLE, &TRIANGLE_BARS, &[]),
                &[(0, [1.0, slope]), (1, [1.0, -slope]), (2, [1.0, 0.0])],
            ),
        ));
        cases.push((
            format!("three rollers that meet but for {slope}"),
            rollers(
                structure(&TRIANGLE, &TRIANGLE_BARS, &[]),
                &[(0, [-1.0, 2.0 + slope]), (1, [1.0, 2.0]), (2, [2.0, 1.0])],
            ),
        ));
    }
    for fixity in [1e-1, 1e-3, 1e-5] {
        let file = beam(&[2.0, 3.0], &[], &[(0, "xy"), (2, "y")]);
        cases.push((
            format!("a beam with joints of fixity {fixity}"),
            with(file, "bar_fixity", json!([[1.0, fixity], [fixity, 1.0]])),
        ));
    }
    for radius in [1e-1, 1e-2, 1e-3] {
        let file = beam(&[1.0; 100], &[], &[(0, "xyr")]);
        // The radius of gyration is that share of the length of 100 m.
        let sections = json!([{"area": 1e-3, "radius_of_gyration": 100.0 * radius}]);
        let file = with(
            with(file, "sections", sections),
            "bar_sections",
            json!(vec![0; 100]),
        );
        cases.push((
            format!("a cantilever of 100 members with i/L = {radius}"),
            file,
        ));
    }
    let all: Vec<u32> = (0..100).collect();
    let truss = braced(100, &all, &[(0, "xy"), (101, "xy")]);
    cases.push(("a cantilever of 100 panels".to_owned(), truss));
    let girder = braced(100, &all, &[(0, "xy"), (100, "y")]);
    cases.push(("a girder of 100 panels".to_owned(), girder));
    cases
}

#[test]
fn structures_near_a_mechanism_are_not_called_one() {
    let cases = near_mechanisms();
    assert!(cases.len() >= 20, "{}", cases.len());
    for (name, file) in cases {
        let state = state(&file);
        assert!(
            !state.is_mechanism,
            "{name}: nodes {:?}",
            state.moving_nodes()
        );
        assert!(state.frequency > 0.0, "{name}");
        let file = truss(&file);
        let load = &file.parts().loads[0];
        let place = file.nodes()[load.node as usize];
        super::assert_balance(
            &state,
            file.nodes(),
            &[(place, 1e3 * load.force, 0.0)],
            1e-7,
        );
    }
}

#[test]
fn a_bar_without_length_carries_nothing() {
    let bracket = |tip: [f64; 2]| {
        truss(&structure(
            &[[0.0, 0.0], [0.0, 3.0], tip],
            &TRIANGLE_BARS,
            &PINS,
        ))
    };
    let trusses = [bracket([4.0, 1.0]), bracket([-4.0, -1.0])];
    let blend = StructuralBlend::of(&[&trusses[0], &trusses[1]]).expect("a blend");
    let mut solver = StructureSolver::new(Arc::new(blend)).expect("a solver");
    // Half way on straight lines, node 2 lies on node 0.
    let places = [DVec2::ZERO, DVec2::new(0.0, 3.0), DVec2::ZERO];
    let state = solver.solve(&places, &[0.5, 0.5], LoadSelection::All);
    assert!(state.is_mechanism);
    assert_eq!(state.moving_nodes(), [2]);
    assert!(state.mass.is_finite());
    assert!(
        state
            .reactions
            .iter()
            .flatten()
            .all(|reaction| *reaction == 0.0)
    );
}
