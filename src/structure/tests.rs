//! Tests of the structural analysis against reference models, closed solutions and identities.

mod blends;
mod films;
mod mechanisms;
mod proofs;
mod reference_models;

use super::{LoadSelection, StructuralBlend, StructuralState, StructureSolver};
use crate::design::Truss;
use crate::geometry::DVec2;
use std::sync::Arc;

/// Returns the truss with the given JSON.
fn truss(json: &serde_json::Value) -> Truss {
    Truss::from_json(&json.to_string()).expect("a valid truss")
}

/// Analyses one truss under all loads.
fn analysed(truss: &Truss) -> StructuralState {
    let blend = StructuralBlend::of(&[truss]).expect("a structure");
    let mut solver = StructureSolver::new(Arc::new(blend)).expect("a solver");
    solver
        .solve(truss.nodes(), &[1.0], LoadSelection::All)
        .clone()
}

/// Asserts that two numbers agree to the relative tolerance, or absolutely if `expected` is zero.
#[track_caller]
fn assert_close(actual: f64, expected: f64, tolerance: f64) {
    let scale = if expected == 0.0 { 1.0 } else { expected.abs() };
    assert!(
        (actual - expected).abs() <= tolerance * scale,
        "{actual:.15e} is not {expected:.15e}"
    );
}

/// Asserts that the reactions balance the loads (place, force and moment), also in moments about
/// the origin, to a relative tolerance.
#[track_caller]
fn assert_balance(
    state: &StructuralState,
    places: &[DVec2],
    loads: &[(DVec2, DVec2, f64)],
    tolerance: f64,
) {
    let mut sums = [0.0; 3];
    let (mut scale, mut reach): (f64, f64) = (0.0, 1.0);
    for place in places {
        reach = reach.max(place.length());
    }
    for (place, reaction) in places.iter().zip(&state.reactions) {
        let [x, y, moment] = *reaction;
        sums[0] += x;
        sums[1] += y;
        sums[2] += moment + place.perp_dot(DVec2::new(x, y));
    }
    for (place, force, moment) in loads {
        sums[0] += force.x;
        sums[1] += force.y;
        sums[2] += moment + place.perp_dot(*force);
        scale = scale.max(force.length());
    }
    for (sum, lever) in sums.into_iter().zip([1.0, 1.0, reach]) {
        assert!(sum.abs() <= tolerance * scale * lever, "{sums:?}");
    }
}
