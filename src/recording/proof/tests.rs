//! Planted faults are found, and what has none is proved.

use super::*;
use crate::recording::RecordingOptions;
use crate::warp::{Placement, Placer, Warp};
use crate::work::progress::Silent;
use std::sync::Arc;

/// Points that move as a function says.
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

fn film<F>(faces: Vec<[u32; 3]>, count: usize, at: F) -> Recording
where
    F: Fn(usize, f64) -> DVec2 + Copy + Send + Sync + 'static,
{
    let warp = Arc::new(FunctionWarp(faces, count, at));
    Recording::record(warp, &RecordingOptions::default(), &Silent).expect("a film")
}

fn walk(vertices: &[u32]) -> DrawnLoop {
    DrawnLoop {
        vertices: vertices.to_vec(),
        level: 0,
        drawn: [0.0, 1.0],
    }
}

/// Negative between these times alone, and by how little.
fn dips(t: f64, from: f64, to: f64) -> f64 {
    (t - from) * (t - to)
}

#[test]
fn a_fold_between_two_samples_is_found() {
    let folds = |from: f64, to: f64| {
        let film = film(vec![[0, 1, 2]], 3, move |k, t| match k {
            0 => DVec2::ZERO,
            1 => DVec2::X,
            _ => DVec2::new(0.3, dips(t, from, to)),
        });
        film.prove(&[], &Silent).expect("an answer").fold
    };
    for from in [0.3701, 0.5, 0.77] {
        let fold = folds(from, from + 1e-4).expect("a fold");
        assert_eq!(fold.face, 0);
        assert!((fold.t - from).abs() < 1e-7, "{} for {from}", fold.t);
        // As long as it is no less than rounding.
        let fold = folds(from, from + 1e-6).expect("a fold");
        assert!((fold.t - from).abs() < 1e-4, "{} for {from}", fold.t);
    }
    assert_eq!(folds(1.2, 1.3), None);
}

/// Two triangles, the tip of the second of which comes near a side of the first.
fn tip(gap: f64, from: f64, to: f64) -> Recording {
    film(vec![[0, 1, 2], [3, 4, 5]], 6, move |k, t| {
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
fn outlines_that_meet_for_a_millionth_are_found() {
    let walks = [walk(&[0, 1, 2]), walk(&[3, 4, 5])];
    let prove = |film: Recording| film.prove(&walks, &Silent).expect("an answer");
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
fn what_is_on_other_levels_or_not_drawn_yet_is_not_met() {
    let through = || tip(0.0, 0.4, 0.6);
    let mut walks = [walk(&[0, 1, 2]), walk(&[3, 4, 5])];
    assert!(
        through()
            .prove(&walks, &Silent)
            .expect("an answer")
            .meeting
            .is_some()
    );
    walks[1].level = 1;
    assert_eq!(
        through().prove(&walks, &Silent).expect("an answer").meeting,
        None
    );
}

#[test]
fn what_touches_at_an_end_is_counted() {
    // Both sides of a slit that opens.
    let film = film(vec![], 6, |k, t| match k {
        0 => DVec2::new(0.0, 0.1 * t),
        1 => DVec2::new(1.0, 0.1 * t),
        2 => DVec2::new(0.5, 1.0),
        3 => DVec2::ZERO,
        4 => DVec2::new(0.5, -1.0),
        _ => DVec2::new(1.0, 0.0),
    });
    let walks = [walk(&[0, 1, 2]), walk(&[3, 4, 5])];
    let proof = film.prove(&walks, &Silent).expect("an answer");
    assert!(proof.touching > 0 && proof.meeting.is_none(), "{proof:?}");
}

#[test]
fn a_proof_that_is_given_other_coefficients_fails() {
    let proves = |by: f64| {
        let film = film(vec![[0, 1, 2]], 3, move |k, t| match k {
            0 => DVec2::ZERO,
            1 => DVec2::X,
            _ => DVec2::new(0.3, 1e-4 + t * (1.0 - t) * (0.25 - by * 4.0)),
        });
        film.prove(&[], &Silent).expect("an answer").holds()
    };
    assert!(proves(0.0));
    assert!(!proves(0.063));
}

#[test]
fn the_answer_is_the_same_on_any_number_of_threads() {
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let film = tip(0.0, 0.4, 0.5);
        let walks = [walk(&[0, 1, 2]), walk(&[3, 4, 5])];
        let prove = || film.prove(&walks, &Silent).expect("an answer");
        pool.expect("threads").install(prove)
    };
    assert_eq!(of(1), of(3));
}

#[test]
fn what_crosses_from_the_first_is_not_proved() {
    // A bar across another; no vertex meets anything.
    let film = film(vec![], 6, |k, t| {
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
    let proof = film.prove(&[walk(&[0, 1, 2]), walk(&[3, 4, 5])], &Silent);
    assert!(proof.expect("an answer").meeting.is_some());
}

#[test]
fn what_touches_at_an_end_and_goes_in_is_found() {
    // The foot of the first stands on the second, sinks in and comes out again.
    let film = film(vec![], 6, |k, t| {
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
    let proof = film.prove(&[walk(&[0, 1, 2]), walk(&[3, 4, 5])], &Silent);
    let proof = proof.expect("an answer");
    assert!(proof.touching > 0 && proof.meeting.is_some(), "{proof:?}");
}
