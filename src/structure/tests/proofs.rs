//! Proofs that structures stand at every t.

use super::truss;
use crate::design::Design;
use crate::project::gallery;
use crate::recording::RecordingOptions;
use crate::structure::{StabilityProof, StructuralBlend};
use crate::transition::{Transition, TransitionSpec};
use crate::work::progress::Silent;
use serde_json::{Value, json};
use std::sync::Arc;

fn proof(transition: &Transition) -> StabilityProof {
    let blend = Arc::new(StructuralBlend::of_transition(transition).expect("a structure"));
    let recording = transition.record(&RecordingOptions::default(), &Silent);
    let recording = recording.expect("a recording");
    let proof = StabilityProof::of(&blend, &recording, &Silent);
    proof.expect("small enough")
}

fn between(files: [&Value; 2]) -> Transition {
    let [source, target] = files.map(|file| Arc::new(Design::new("truss", truss(file))));
    Transition::build(&TransitionSpec::new(source, target), &Silent).expect("a transition")
}

#[test]
fn the_trusses_of_the_gallery_stand_at_every_t() {
    for name in ["girder-to-arch", "bracket-to-davit"] {
        let spec = gallery::load(name)
            .expect("a project")
            .spec()
            .expect("a pair");
        let proof = proof(&Transition::build(&spec, &Silent).expect("a transition"));
        assert!(proof.holds(), "{name}: {proof:?}");
        assert!(proof.intervals < 50, "{name}: {proof:?}");
    }
}

/// Two bars between pins, whose common node is at the given height.
fn two_bars(height: f64) -> Value {
    json!({
        "units": {"length": "m", "force": "kN"},
        "nodes": [[0, 0], [4, 0], [1, height]],
        "bars": [[0, 2], [1, 2]],
        "supports": [{"node": 0, "fixed": [true, true]}, {"node": 1, "fixed": [true, true]}],
        "loads": [{"node": 2, "force": [0, -10]}],
    })
}

#[test]
fn a_node_that_passes_through_the_line_of_its_supports_is_found() {
    let [above, below] = [1.0, -3.0].map(two_bars);
    let proof = proof(&between([&above, &below]));
    assert!(!proof.holds());
    assert_eq!(proof.moving_nodes, [2]);
    let t = proof.fails_at.expect("a t");
    assert!(t > 0.0 && t < 1.0, "{t}");
    // The same bars do not pass the line on their way to a higher place.
    let higher = two_bars(3.0);
    assert!(super::proofs::proof(&between([&above, &higher])).holds());
}

/// A portal frame with pinned feet; the corners have the given fixity.
fn portal(height: f64, fixity: f64) -> Value {
    json!({
        "units": {"length": "m", "force": "kN"},
        "nodes": [[0, 0], [0, height], [6, height], [6, 0]],
        "bars": [[0, 1], [1, 2], [2, 3]],
        "areas": [5e-3, 5e-3, 5e-3],
        "bar_fixity": [[0, fixity], [fixity, fixity], [fixity, 0]],
        "supports": [{"node": 0, "fixed": [true, true]}, {"node": 3, "fixed": [true, true]}],
        "loads": [{"node": 1, "force": [10, 0]}],
    })
}

#[test]
fn a_frame_stands_by_its_rigid_corners() {
    assert!(proof(&between([&portal(3.0, 1.0), &portal(5.0, 0.5)])).holds());
    let failing = proof(&between([&portal(3.0, 1.0), &portal(5.0, 0.0)]));
    // Its corners are hinges at t = 1, so that the frame falls over there.
    assert!(!failing.holds(), "{failing:?}");
}

#[test]
fn a_support_of_one_design_does_not_count() {
    let [first, mut second] = [1.0, 2.0].map(two_bars);
    second["supports"] = json!([{"node": 0, "fixed": [true, true]}]);
    let proof = proof(&between([&first, &second]));
    assert!(!proof.holds());
}
