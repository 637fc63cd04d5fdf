//! Tests of the certificates: planted folds and meetings are found, recordings without any are
//! proved.

use super::*;
use crate::recording::RecordingOptions;
use crate::warp::{Placement, Placer, Warp};
use crate::work::progress::Silent;
use std::sync::Arc;

/// Warp of points. The fields are the faces, the number of points, and a function that returns the
/// position of a point from its index and t.
struct FunctionWarp<F>(Vec<[u32; 3]>, usize, F);

impl<F> std::fmt::Debug for FunctionWarp<F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Moves")
    }
}

impl<F: Fn(usize, f64) -> DVec2 + Copy + Send + Sync + 'static> Warp for FunctionWarp<F> {
    fn placer(&self) -> Placer {
        let (count, at) = (self.1, self.2);
        let all = |t: f64| (0..count).map(|k| at(k, t)).collect::<Vec<_>>();
        let faces: Arc<[[u32; 3]]> = self.0.clone().into();
        let rest = Placement::of_source(faces, &all(0.0), &all(1.0));
        Placer::new(rest, move |t, placement| {
            let places = placement.in_frame.iter_mut().enumerate();
            places.for_each(|(k, place)| *place = at(k, t));
        })
    }
}

fn recording_of<F>(faces: Vec<[u32; 3]>, count: usize, at: F) -> Recording
where
    F: Fn(usize, f64) -> DVec2 + Copy + Send + Sync + 'static,
{
    let warp = Arc::new(FunctionWarp(faces, count, at));
    Recording::record(warp, &RecordingOptions::default(), &Silent).expect("a recording")
}

fn drawn_loop(vertices: &[u32]) -> DrawnLoop {
    DrawnLoop {
        vertices: vertices.to_vec(),
        layer: 0,
        visible_interval: [0.0, 1.0],
    }
}

/// Parabola in t that is slightly negative between two times and positive elsewhere.
fn dips(t: f64, from: f64, to: f64) -> f64 {
    (t - from) * (t - to)
}

#[test]
fn a_fold_between_two_samples_is_found() {
    let folds = |from: f64, to: f64| {
        let recording = recording_of(vec![[0, 1, 2]], 3, move |k, t| match k {
            0 => DVec2::ZERO,
            1 => DVec2::X,
            _ => DVec2::new(0.3, dips(t, from, to)),
        });
        recording.prove(&[], &Silent).expect("an answer").fold
    };
    for from in [0.3701, 0.5, 0.77] {
        let fold = folds(from, from + 1e-4).expect("a fold");
        assert_eq!(fold.face, 0);
        assert!((fold.t - from).abs() < 1e-7, "{} for {from}", fold.t);
        // A dip that is barely larger than rounding is found too, but less accurately.
        let fold = folds(from, from + 1e-6).expect("a fold");
        assert!((fold.t - from).abs() < 1e-4, "{} for {from}", fold.t);
    }
    assert_eq!(folds(1.2, 1.3), None);
}

/// Recording of two triangles. The tip of the second approaches a side of the first: the distance
/// is `gap` plus a parabola that is negative between the two times.
fn tip(gap: f64, from: f64, to: f64) -> Recording {
    recording_of(vec![[0, 1, 2], [3, 4, 5]], 6, move |k, t| {
        let turn = DVec2::from_angle(0.7 * t);
        let at = match k {
            0 => DVec2::ZERO,
            1 => DVec2::new(1.0, 0.0),
            2 => DVec2::new(0.5, 1.0),
            3 => DVec2::new(0.4, -gap - dips(t, from, to)),
            4 => DVec2::new(0.2, -3.0),
            _ => DVec2::new(0.6, -3.0),
        };
        turn.rotate(at + 2.0)
    })
}

#[test]
fn outlines_that_meet_for_a_millionth_of_the_time_are_found() {
    let loops = [drawn_loop(&[0, 1, 2]), drawn_loop(&[3, 4, 5])];
    let prove = |recording: Recording| recording.prove(&loops, &Silent).expect("an answer");
    for from in [0.123_456, 0.61] {
        let proof = prove(tip(0.0, from, from + 1e-6));
        let meeting = proof.meeting.expect("they meet");
        assert!((meeting.t - from).abs() < 1e-4, "{} for {from}", meeting.t);
        assert_eq!((meeting.vertex, meeting.edge), (3, [0, 1]));
        assert_eq!(proof.fold, None);
    }
    assert!(!prove(tip(-1e-9, 2.0, 3.0)).holds() || !prove(tip(0.0, 0.4, 0.400_01)).holds());
    let apart = prove(tip(1e-3, 0.3, 0.31));
    assert!(apart.holds() && apart.touching == 0, "{apart:?}");
}

#[test]
fn loops_on_different_layers_may_cross() {
    let through = || tip(0.0, 0.4, 0.6);
    let mut loops = [drawn_loop(&[0, 1, 2]), drawn_loop(&[3, 4, 5])];
    assert!(
        through()
            .prove(&loops, &Silent)
            .expect("an answer")
            .meeting
            .is_some()
    );
    loops[1].layer = 1;
    assert_eq!(
        through().prove(&loops, &Silent).expect("an answer").meeting,
        None
    );
}

#[test]
fn pairs_that_touch_at_an_end_are_counted() {
    // The two loops touch along a slit at t = 0; then the slit opens.
    let recording = recording_of(vec![], 6, |k, t| match k {
        0 => DVec2::new(0.0, 0.1 * t),
        1 => DVec2::new(1.0, 0.1 * t),
        2 => DVec2::new(0.5, 1.0),
        3 => DVec2::ZERO,
        4 => DVec2::new(0.5, -1.0),
        _ => DVec2::new(1.0, 0.0),
    });
    let loops = [drawn_loop(&[0, 1, 2]), drawn_loop(&[3, 4, 5])];
    let proof = recording.prove(&loops, &Silent).expect("an answer");
    assert!(proof.touching > 0 && proof.meeting.is_none(), "{proof:?}");
}

#[test]
fn a_slightly_larger_dip_is_not_proved() {
    let proves = |by: f64| {
        let recording = recording_of(vec![[0, 1, 2]], 3, move |k, t| match k {
            0 => DVec2::ZERO,
            1 => DVec2::X,
            _ => DVec2::new(0.3, 1e-4 + t * (1.0 - t) * (0.25 - by * 4.0)),
        });
        recording.prove(&[], &Silent).expect("an answer").holds()
    };
    assert!(proves(0.0));
    assert!(!proves(0.063));
}

/// Two triangles move together, a millionth apart and so far from the origin that coordinates are
/// only known to a ten-millionth. Their boxes are disjoint in each of millions of parts of the
/// interval.
#[test]
fn motions_that_rounding_hides_are_given_up() {
    let at = |k: usize, t: f64| {
        let corners = [
            (0.0, 0.0),
            (4.0, 1.0),
            (1.0, 3.0),
            (6.0, 2.0),
            (9.0, 3.0),
            (5.0, 6.0),
        ];
        let corner = DVec2::from(corners[k]) * 1e-6;
        DVec2::splat(1e9) + corner + DVec2::new(t, t * t)
    };
    let warp = Arc::new(FunctionWarp(Vec::new(), 6, at));
    let options = RecordingOptions {
        tolerance: 1e-4,
        ..RecordingOptions::default()
    };
    let recording = Recording::record(warp, &options, &Silent).expect("a recording");
    let loops = [drawn_loop(&[0, 1, 2]), drawn_loop(&[3, 4, 5])];
    let proof = recording.prove(&loops, &Silent).expect("an answer");
    assert!(proof.meeting.is_some(), "{proof:?}");
}

#[test]
fn the_proof_is_the_same_on_any_number_of_threads() {
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let recording = tip(0.0, 0.4, 0.5);
        let loops = [drawn_loop(&[0, 1, 2]), drawn_loop(&[3, 4, 5])];
        let prove = || recording.prove(&loops, &Silent).expect("an answer");
        pool.expect("threads").install(prove)
    };
    assert_eq!(of(1), of(3));
}

#[test]
fn outlines_that_cross_from_the_beginning_are_found() {
    // Two thin triangles cross like bars. At no time does a vertex meet an edge.
    let recording = recording_of(vec![], 6, |k, t| {
        let at = match k {
            0 => DVec2::new(-5.0, -0.1),
            1 => DVec2::new(5.0, -0.1),
            2 => DVec2::new(0.0, 0.3),
            3 => DVec2::new(0.1, -5.0),
            4 => DVec2::new(0.2, 5.0),
            _ => DVec2::new(-0.3, 0.0),
        };
        DVec2::from_angle(t).rotate(at)
    });
    let proof = recording.prove(&[drawn_loop(&[0, 1, 2]), drawn_loop(&[3, 4, 5])], &Silent);
    assert!(proof.expect("an answer").meeting.is_some());
}

#[test]
fn outlines_that_touch_at_an_end_and_then_cross_are_found() {
    // The base of the first triangle lies on a side of the second, sinks in and comes out again.
    let recording = recording_of(vec![], 6, |k, t| {
        let sinks = -0.2 * t * (1.0 - t);
        match k {
            0 => DVec2::new(0.2, sinks),
            1 => DVec2::new(0.8, sinks),
            2 => DVec2::new(0.5, 1.0),
            3 => DVec2::new(0.0, 0.0),
            4 => DVec2::new(0.5, -1.0),
            _ => DVec2::new(1.0, 0.0),
        }
    });
    let proof = recording.prove(&[drawn_loop(&[0, 1, 2]), drawn_loop(&[3, 4, 5])], &Silent);
    let proof = proof.expect("an answer");
    assert!(proof.touching > 0 && proof.meeting.is_some(), "{proof:?}");
}
