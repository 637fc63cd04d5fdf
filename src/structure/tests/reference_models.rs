//! Reference models with known results, closed solutions and patch tests.

use super::{analysed, assert_balance, assert_close, truss};
use crate::design::Truss;
use crate::geometry::{DVec2, Similarity};
use crate::structure::{LoadSelection, StructuralBlend, StructureSolver};
use serde_json::{Value, json};
use std::sync::Arc;

const KIP: f64 = 453.592_37 * 9.80665;
const INCH: f64 = 0.0254;

/// Supports that fix the displacements of nodes.
fn pins(nodes: &[u32]) -> Value {
    let pin = |node| json!({"node": node, "fixed": [true, true]});
    nodes.iter().map(pin).collect()
}

/// Three bars that meet in a loaded node.
fn three_bars() -> Value {
    json!({
        "units": {"length": "m", "force": "kN"},
        "nodes": [[-3, 4], [0, 4], [3, 4], [0, 0]],
        "bars": [[0, 3], [1, 3], [2, 3]],
        "areas": [2e-3, 1e-3, 1.5e-3],
        "materials": [{"name": "steel", "youngs_modulus": 210e6, "density": 7850}],
        "bar_materials": [0, 0, 0],
        "supports": pins(&[0, 1, 2]),
        "loads": [{"node": 3, "force": [30, -100]}],
    })
}

#[test]
fn three_bars_have_the_reference_displacements_and_forces() {
    let state = analysed(&truss(&three_bars()));
    assert_close(state.displacements[3][0], 4.427_458_803_2e-4, 1e-10);
    assert_close(state.displacements[3][1], -6.517_746_044_9e-4, 1e-10);
    let forces = [66.113_645_790_129, 34.218_166_735_794, 16.113_645_790_129];
    for (forces, expected) in state.forces.iter().zip(forces) {
        assert_close(forces.axial, 1e3 * expected, 1e-13);
    }
}

/// The ten-bar truss of structural optimisation, in inches and kips.
fn ten_bars(areas: [f64; 10]) -> Value {
    json!({
        "units": {"length": "in", "force": "kip"},
        "nodes": [[720, 360], [720, 0], [360, 360], [360, 0], [0, 360], [0, 0]],
        "bars": [[4, 2], [2, 0], [5, 3], [3, 1], [2, 3], [0, 1], [4, 3], [5, 2], [2, 1], [3, 0]],
        "areas": areas,
        "materials": [{"name": "aluminium", "youngs_modulus": 1e4, "density": 1e-4, "strength": 25}],
        "bar_materials": vec![0; 10],
        "supports": pins(&[4, 5]),
        "loads": [{"node": 1, "force": [0, -100]}, {"node": 3, "force": [0, -100]}],
    })
}

#[test]
fn the_ten_bar_truss_has_the_reference_displacements_and_forces() {
    let state = analysed(&truss(&ten_bars([10.0; 10])));
    let sags = [
        -3.795_126_309_303,
        -3.939_574_985_423,
        -1.674_352_450_305,
        -1.802_115_079_512,
    ];
    for (displacement, expected) in state.displacements.iter().zip(sags) {
        assert_close(displacement[1], INCH * expected, 1e-12);
    }
    let forces = [
        195.364_986_968_811,
        40.124_632_255_496,
        -204.635_013_031_188,
        -59.875_367_744_504,
        35.489_619_224_308,
        40.124_632_255_496,
        147.976_254_527_792,
        -134.866_457_946_827,
        84.676_557_116_354,
        -56.744_799_120_955,
    ];
    for (forces, expected) in state.forces.iter().zip(forces) {
        assert_close(forces.axial, KIP * expected, 1e-13);
    }
}

#[test]
fn the_published_optima_of_the_ten_bar_truss_have_the_published_weights() {
    let optimum = [
        30.522, 0.1, 23.200, 15.223, 0.1, 0.551, 7.457, 21.036, 21.528, 0.1,
    ];
    let mut file = ten_bars(optimum);
    // Density in pounds per cubic inch, although forces are in kips.
    file["materials"][0]["density"] = json!(0.1);
    let state = analysed(&truss(&file));
    assert_close(state.mass / 0.453_592_37, 5060.8007, 1e-8);
    assert_close(state.displacements[0][1], -2.000_020_335_001 * INCH, 1e-12);
    let stressed = [7.94, 0.1, 8.06, 3.94, 0.1, 0.1, 5.74, 5.57, 5.57, 0.1];
    let mut file = ten_bars(stressed);
    file["materials"][0]["density"] = json!(0.1);
    let state = analysed(&truss(&file));
    assert_close(state.mass / 0.453_592_37, 1593.12, 1e-5);
}

/// A portal frame with a fixed foot and a pinned foot.
fn portal() -> Value {
    let section = |area: f64, moment: f64| json!({"area": area, "second_moment": moment});
    json!({
        "units": {"length": "m", "force": "kN"},
        "nodes": [[0, 0], [0, 4], [4, 5.5], [8, 4], [8, 0]],
        "bars": [[0, 1], [1, 2], [2, 3], [3, 4]],
        "sections": [section(5.38e-3, 8.36e-5), section(2.85e-3, 1.943e-5)],
        "bar_sections": [0, 1, 1, 0],
        "materials": [{"name": "steel", "youngs_modulus": 210e6}],
        "bar_materials": vec![0; 4],
        "fixity": 1,
        "supports": [
            {"node": 0, "fixed": [true, true, true]},
            {"node": 4, "fixed": [true, true]},
        ],
        "load_cases": [{
            "name": "wind and snow",
            "loads": [{"node": 1, "force": [15, 0]}],
            "line_loads": [{"bars": [1, 2], "force": [0, -12]}],
        }],
    })
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table of reference values")]
fn the_portal_frame_has_the_reference_displacements_reactions_and_moments() {
    let frame = truss(&portal());
    let state = analysed(&frame);
    let displacements = [
        [
            0.014_123_791_619_2,
            -0.000_167_232_745,
            -0.007_429_602_616_7,
        ],
        [0.025_319_458_083_9, -0.030_508_133_373_3, 0.002_807_835_124],
        [0.036_482_856_333, -0.000_195_762_635, -0.003_828_453_807],
    ];
    for (actual, expected) in state.displacements[1..4].iter().zip(displacements) {
        for (actual, expected) in actual.iter().zip(expected) {
            // The references have twelve decimals.
            assert!((actual - expected).abs() < 1e-12, "{actual} {expected}");
        }
    }
    let [first, .., last] = &state.reactions[..] else {
        panic!("no reactions")
    };
    for (actual, expected) in
        first
            .iter()
            .zip([2.420_797_764_470, 47.234_888_766_36, 27.766_930_355_64])
    {
        assert_close(*actual, 1e3 * expected, 1e-11);
    }
    for (actual, expected) in last
        .iter()
        .zip([-17.420_797_764_47, 55.293_156_177_45, 0.0])
    {
        assert!(
            (actual - 1e3 * expected).abs() < 1e-6,
            "{actual} {expected}"
        );
    }
    for (member, expected) in [
        (1, 37.450_121_413_52),
        (2, 22.830_192_061_40),
        (3, 69.683_191_057_88),
    ] {
        assert_close(
            state.forces[member].moment_at(0.0).abs(),
            1e3 * expected,
            1e-11,
        );
    }
    let length = 73.0_f64.sqrt() / 2.0;
    let snow = DVec2::new(0.0, -12e3 * length);
    assert_balance(
        &state,
        frame.nodes(),
        &[
            (DVec2::new(0.0, 4.0), DVec2::new(15e3, 0.0), 0.0),
            (DVec2::new(2.0, 4.75), snow, 0.0),
            (DVec2::new(6.0, 4.75), snow, 0.0),
        ],
        1e-12,
    );
}

/// A straight beam of `members` members from (0, 0) to (length, 0), with supports and load cases.
fn beam(members: u32, length: f64, supports: Value, case: Value) -> Truss {
    let nodes: Vec<_> = (0..=members)
        .map(|k| [length * f64::from(k) / f64::from(members), 0.0])
        .collect();
    truss(&json!({
        "units": {"length": "m", "force": "N", "stress": "Pa"},
        "nodes": nodes,
        "bars": (0..members).map(|k| [k, k + 1]).collect::<Vec<_>>(),
        "sections": [{"area": 2e-3, "second_moment": 3e-6}],
        "bar_sections": vec![0; members as usize],
        "materials": [{"name": "steel", "youngs_modulus": 210e9}],
        "bar_materials": vec![0; members as usize],
        "fixity": 1,
        "supports": supports,
        "load_cases": [case],
    }))
}

const BENDING_STIFFNESS: f64 = 210e9 * 3e-6;

#[test]
fn a_cantilever_sags_by_the_closed_solution() {
    let supports = json!([{"node": 0, "fixed": [true, true, true]}]);
    let case = json!({"name": "tip", "loads": [{"node": 1, "force": [0, -700]}]});
    let state = analysed(&beam(1, 3.0, supports.clone(), case));
    assert_close(
        state.displacements[1][1],
        -700.0 * 27.0 / (3.0 * BENDING_STIFFNESS),
        1e-12,
    );
    assert_close(state.forces[0].moment_at(0.0), -2100.0, 1e-12);
    let case = json!({"name": "tip", "loads": [{"node": 100, "force": [0, -700]}]});
    let state = analysed(&beam(100, 3.0, supports, case));
    assert!(!state.is_mechanism);
    assert_close(
        state.displacements[100][1],
        -700.0 * 27.0 / (3.0 * BENDING_STIFFNESS),
        1e-9,
    );
}

#[test]
fn a_beam_under_uniform_load_sags_by_the_closed_solution() {
    for members in [1, 2, 7, 40] {
        let supports = json!([
            {"node": 0, "fixed": [true, true]},
            {"node": members, "fixed": [false, true]},
        ]);
        let bars: Vec<u32> = (0..members).collect();
        let case = json!({"name": "deck", "line_loads": [{"bars": bars, "force": [0, -900]}]});
        let state = analysed(&beam(members, 5.0, supports, case));
        let sag = 5.0 * 900.0 * 625.0 / (384.0 * BENDING_STIFFNESS);
        if members % 2 == 0 {
            assert_close(state.displacements[members as usize / 2][1], -sag, 1e-9);
        }
        let moments = state.forces.iter().map(|forces| forces.largest_moment());
        assert_close(moments.fold(0.0, f64::max), 900.0 * 25.0 / 8.0, 1e-9);
        assert_close(state.reactions[0][1], 900.0 * 2.5, 1e-9);
    }
}

#[test]
fn partly_fixed_ends_are_between_pinned_and_rigid() {
    // End moments of a uniformly loaded beam between equal rotational springs of fixity r:
    // wL²/12 · 3r/(2 + r).
    for (fixity, share) in [(0.0, 0.0), (0.25, 1.0 / 3.0), (0.5, 0.6), (1.0, 1.0)] {
        let supports = json!([
            {"node": 0, "fixed": [true, true, true]},
            {"node": 1, "fixed": [true, true, true]},
        ]);
        let case = json!({"name": "deck", "line_loads": [{"bars": [0], "force": [0, -900]}]});
        let mut file: Value =
            serde_json::from_str(&beam(1, 5.0, supports, case).to_json()).expect("JSON");
        file["fixity"] = json!(fixity);
        let state = analysed(&truss(&file));
        let expected = share * 900.0 * 25.0 / 12.0;
        assert_close(state.forces[0].moment_at(0.0), -expected, 1e-12);
        assert_close(state.reactions[0][2], expected, 1e-12);
    }
}

#[test]
fn loads_along_a_slanted_member_and_in_plan_are_resolved() {
    // A pinned bar that rises at 3:4 carries its load to both ends.
    for (in_plan, length) in [(false, 5.0), (true, 4.0)] {
        let state = analysed(&truss(&json!({
            "units": {"length": "m", "force": "N"},
            "nodes": [[0, 0], [4, 3]], "bars": [[0, 1]],
            "supports": [
                {"node": 0, "fixed": [true, true]}, {"node": 1, "rolls_along": [4, 3]}
            ],
            "load_cases": [{"name": "", "line_loads": [
                {"bars": [0], "force": [0, -10], "in_plan": in_plan}
            ]}],
        })));
        let total = 10.0 * length;
        // Half of the load across the member goes to each end; all along it goes to the pin.
        assert_close(state.reactions[1][0], -0.5 * total * 0.8 * 0.6, 1e-12);
        assert_close(state.reactions[1][1], 0.5 * total * 0.8 * 0.8, 1e-12);
        assert_close(
            state.forces[0].largest_moment(),
            total * 0.8 * 5.0 / 8.0,
            1e-12,
        );
        assert_close(state.forces[0].axial_at(0.0), -total * 0.6, 1e-12);
        assert!(state.forces[0].axial_at(5.0).abs() < 1e-12 * total);
    }
}

/// A patch of bars with an irregular inner node, loaded by the forces of a linear displacement
/// field, must take on exactly this field.
#[test]
fn a_patch_of_bars_takes_on_a_linear_displacement_field() {
    let nodes = [[0.0, 0.0], [4.0, 0.0], [4.2, 3.0], [-0.3, 2.5], [1.7, 1.1]].map(DVec2::from);
    let bars = [
        [0, 1],
        [1, 2],
        [2, 3],
        [3, 0],
        [0, 4],
        [1, 4],
        [2, 4],
        [3, 4],
    ];
    let areas = [1e-3, 2e-3, 1.5e-3, 1e-3, 3e-3, 1e-3, 2e-3, 1e-3];
    // Zero at the origin and without a vertical part on the x axis, where the supports are.
    let field = |p: DVec2| DVec2::new(2e-4 * p.x - 1e-4 * p.y, 3e-4 * p.y);
    let force = |bar: usize| {
        let [a, b] = bars[bar].map(|node: usize| nodes[node]);
        let direction = (b - a).normalize();
        210e9 * areas[bar] * (field(b) - field(a)).dot(direction) / a.distance(b)
    };
    let mut loads = [DVec2::ZERO; 5];
    for (bar, ends) in bars.iter().enumerate() {
        let pull = force(bar) * (nodes[ends[1]] - nodes[ends[0]]).normalize();
        loads[ends[0]] -= pull;
        loads[ends[1]] += pull;
    }
    let load = |(node, force): (usize, &DVec2)| json!({"node": node, "force": force});
    let state = analysed(&truss(&json!({
        "units": {"length": "m", "force": "N"},
        "nodes": nodes, "bars": bars, "areas": areas,
        "supports": [{"node": 0, "fixed": [true, true]}, {"node": 1, "fixed": [false, true]}],
        "loads": loads.iter().enumerate().map(load).collect::<Vec<_>>(),
    })));
    for (bar, forces) in state.forces.iter().enumerate() {
        assert_close(forces.axial, force(bar), 1e-9);
    }
    for (node, displacement) in state.displacements.iter().enumerate() {
        let expected = field(nodes[node]);
        assert!((DVec2::new(displacement[0], displacement[1]) - expected).length() < 1e-15);
    }
    for reaction in &state.reactions {
        assert!(
            reaction[0].abs() < 1e-6 && reaction[1].abs() < 1e-6,
            "{reaction:?}"
        );
    }
}

#[test]
fn a_patch_of_beams_takes_on_a_constant_curvature() {
    let nodes: [f64; 6] = [0.0, 0.3, 1.1, 2.0, 2.2, 4.0];
    let state = analysed(&truss(&json!({
        "units": {"length": "m", "force": "N"},
        "nodes": nodes.map(|x| [x, 0.0]),
        "bars": [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]],
        "sections": [{"area": 2e-3, "second_moment": 3e-6}], "bar_sections": [0, 0, 0, 0, 0],
        "fixity": 1,
        "supports": [{"node": 0, "fixed": [true, true, true]}],
        "loads": [{"node": 5, "force": [0, 0], "moment": 800}],
    })));
    for forces in &state.forces {
        assert_close(forces.moment_at(0.0), 800.0, 1e-9);
        assert_close(forces.largest_moment(), 800.0, 1e-9);
        assert!(forces.largest_shear() < 1e-6);
    }
    for (x, displacement) in nodes.iter().zip(&state.displacements) {
        let expected = 800.0 * x * x / (2.0 * BENDING_STIFFNESS);
        assert!((displacement[1] - expected).abs() < 1e-12);
    }
}

/// Places and rotates a structure; forces, reactions and displacements must turn with it.
#[test]
fn a_placed_structure_has_the_same_forces() {
    let portal = truss(&portal());
    let expected = analysed(&portal);
    for mirror in [false, true] {
        let placed = portal.transformed(&Similarity {
            rotation: 0.7,
            scale: 40.0,
            offset: DVec2::new(3.0, -8.0),
            mirror,
        });
        let state = analysed(&placed);
        let turn = placed.placement().linear() * (1.0 / 40.0);
        for (a, b) in state.forces.iter().zip(&expected.forces) {
            assert!((a.axial - b.axial).abs() < 1e-6, "{a:?} {b:?}");
            assert_close(a.largest_moment(), b.largest_moment(), 1e-9);
        }
        for (a, b) in state.displacements.iter().zip(&expected.displacements) {
            let b = turn * DVec2::new(b[0], b[1]);
            assert!((DVec2::new(a[0], a[1]) - b).length() < 1e-11, "{a:?} {b:?}");
        }
    }
}

#[test]
fn rigid_motions_of_the_supports_cause_no_stress() {
    use crate::structure::element::{Element, MemberProperties};
    let properties = MemberProperties {
        area: 2e-3,
        radius: 0.04,
        depth: 0.1,
        modulus: 210e9,
        strength: 235e6,
        density: 7850.0,
        fixity: [1.0, 0.4],
    };
    let ends = [DVec2::new(1.0, -2.0), DVec2::new(4.0, 2.0)];
    let axes = [DVec2::from_angle(0.3), DVec2::from_angle(-1.0)];
    let element = Element::new(ends, &properties, axes);
    // Translation by (0.3, -0.2) m and an infinitesimal rotation by 0.1 about the origin.
    let move_of = |place: DVec2, axis: DVec2| {
        let moved = DVec2::new(0.3, -0.2) + 0.1 * place.perp();
        [moved.dot(axis), moved.dot(axis.perp()), 0.1]
    };
    let [a, b] = [0, 1].map(|k: usize| move_of(ends[k], axes[k]));
    let forces = element.forces(&[a[0], a[1], a[2], b[0], b[1], b[2]], [0.0; 2]);
    let strain = forces.axial / (properties.modulus * properties.area);
    assert!(strain.abs() < 1e-15, "{strain}");
    let bending = properties.modulus * properties.second_moment();
    for moment in forces.end_moments {
        assert!((moment / bending).abs() < 1e-15, "{moment}");
    }
}

#[test]
fn a_hanging_mass_vibrates_at_the_closed_frequency() {
    // A bar with half of its mass lumped at the free end.
    let state = analysed(&truss(&json!({
        "units": {"length": "m", "force": "N"},
        "nodes": [[0, 0], [0, -2]], "bars": [[0, 1]], "areas": [1e-3],
        "materials": [{"name": "steel", "youngs_modulus": 210e9, "density": 7850}],
        "bar_materials": [0],
        "supports": [
            {"node": 0, "fixed": [true, true]}, {"node": 1, "fixed": [true, false]},
        ],
    })));
    let stiffness = 210e9 * 1e-3 / 2.0;
    let mass = 7850.0 * 1e-3 * 2.0 / 2.0;
    let expected = f64::sqrt(stiffness / mass) / std::f64::consts::TAU;
    assert_close(state.frequency, expected, 1e-12);
    assert_close(state.mode[1][1].abs(), 1.0, 1e-12);
}

#[test]
fn results_do_not_depend_on_earlier_frames() {
    let trusses = [truss(&three_bars()), {
        let mut other = three_bars();
        other["nodes"][3] = json!([1, -2]);
        truss(&other)
    }];
    let blend = Arc::new(StructuralBlend::of(&[&trusses[0], &trusses[1]]).expect("a blend"));
    let mut solver = StructureSolver::new(Arc::clone(&blend)).expect("a solver");
    let weights = [0.5, 0.5];
    let fresh = solver
        .solve(trusses[0].nodes(), &weights, LoadSelection::All)
        .clone();
    solver.solve(trusses[1].nodes(), &[0.0, 1.0], LoadSelection::All);
    let again = solver.solve(trusses[0].nodes(), &weights, LoadSelection::All);
    assert_eq!(fresh.forces, again.forces);
    assert_eq!(fresh.frequency.to_bits(), again.frequency.to_bits());
}

/// Buckling factor of a straight column of `members` members of length 5 m in all, compressed by
/// 1 kN.
fn column_factor(members: u32, supports: Value) -> f64 {
    let last = f64::from(members);
    let case = json!({"name": "", "loads": [{"node": last as u32, "force": [-1000, 0]}]});
    let column = beam(members, 5.0, supports, case);
    let blend = StructuralBlend::of(&[&column]).expect("a structure");
    let mut solver = StructureSolver::new(Arc::new(blend)).expect("a solver");
    solver.solve(column.nodes(), &[1.0], LoadSelection::All);
    solver.critical_load_factor(None) * 1000.0
        / (BENDING_STIFFNESS * (std::f64::consts::PI / 5.0).powi(2))
}

#[test]
fn columns_buckle_at_eulers_loads() {
    let pinned = json!([{"node": 0, "fixed": [true, true]}, {"node": 1, "fixed": [false, true]}]);
    // Four elements: 1.00051.
    assert!((column_factor(1, pinned) - 1.000_51).abs() < 5e-6);
    let pinned = json!([{"node": 0, "fixed": [true, true]}, {"node": 2, "fixed": [false, true]}]);
    // Eight elements: 1.000033.
    assert!((column_factor(2, pinned) - 1.000_033).abs() < 5e-7);
    let foot = json!({"node": 0, "fixed": [true, true, true]});
    assert_close(column_factor(4, json!([foot])), 0.25, 1e-5);
    let head = json!({"node": 4, "fixed": [false, true, true]});
    assert!((column_factor(4, json!([foot, head])) - 4.0).abs() < 1e-3);
    let head = json!({"node": 4, "fixed": [false, true]});
    assert!((column_factor(4, json!([foot, head])) - 2.045_748).abs() < 1e-4);
}

#[test]
fn a_pinned_bar_of_a_truss_buckles_between_its_nodes() {
    let state = {
        let truss = truss(&three_bars());
        let mut reversed = three_bars();
        reversed["loads"][0]["force"] = json!([0, 100]);
        let reversed = super::truss(&reversed);
        let blend = StructuralBlend::of(&[&reversed]).expect("a structure");
        let mut solver = StructureSolver::new(Arc::new(blend)).expect("a solver");
        solver.solve(truss.nodes(), &[1.0], LoadSelection::All);
        (solver.critical_load_factor(None), solver.state().clone())
    };
    let (factor, state) = state;
    let members = state.forces.iter().zip(&state.properties);
    let euler = members.map(|(forces, own)| own.euler_load(forces.length) / -forces.axial);
    let least = euler.fold(f64::INFINITY, f64::min);
    assert_close(factor, 1.000_51 * least, 1e-5);
    // Without compression nothing buckles.
    let hanging = truss(&three_bars());
    let blend = StructuralBlend::of(&[&hanging]).expect("a structure");
    let mut solver = StructureSolver::new(Arc::new(blend)).expect("a solver");
    solver.solve(hanging.nodes(), &[1.0], LoadSelection::All);
    assert_eq!(solver.critical_load_factor(None), f64::INFINITY);
}

#[test]
fn a_spring_at_the_foot_of_a_column_holds_it() {
    // A column on a rotational spring k with a free head buckles where z tan z = kL/EI, with
    // z² = N L²/EI; at z = 1 that is kL/EI = tan 1.
    let mut file: Value = serde_json::from_str(
        &beam(
            4,
            5.0,
            json!([]),
            json!({"name": "", "loads": [{"node": 4, "force": [-1000, 0]}]}),
        )
        .to_json(),
    )
    .expect("JSON");
    let stiffness = 1.0_f64.tan() * BENDING_STIFFNESS / 5.0;
    file["supports"] = pins(&[0]);
    file["springs"] = json!([{"node": 0, "stiffness": stiffness}]);
    let column = truss(&file);
    let blend = StructuralBlend::of(&[&column]).expect("a structure");
    let mut solver = StructureSolver::new(Arc::new(blend)).expect("a solver");
    let state = solver.solve(column.nodes(), &[1.0], LoadSelection::All);
    assert!(!state.is_mechanism);
    assert_close(
        solver.critical_load_factor(None) * 1000.0 * 25.0 / BENDING_STIFFNESS,
        1.0,
        1e-5,
    );
}
