//! Tests of recordings: they reproduce the warps from which they were recorded, are exact at both
//! ends, and report jumps and limits.

use super::*;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DVec2, Side};
use crate::time::NamedEasing;
use crate::warp::homotopy::Homotopy;
use crate::warp::{Arap, ArapOptions, PartClock, StaggeredArap, TimeWindow};
use crate::work::progress::Silent;

/// Straight strip of `2 n` faces whose target is bent by `turn` radians over its length. If it
/// bends by more than a full turn, it becomes a spiral.
fn strip(n: u32, turn: f64) -> CompatibleMesh {
    let points = (0..=n).flat_map(|i| [[i, 0], [i, 1]]);
    let source: Vec<DVec2> = points
        .map(|[i, side]| DVec2::new(10.0 * f64::from(i) / f64::from(n), f64::from(side)))
        .collect();
    let bent = |p: &DVec2| {
        let angle = turn * p.x / 10.0;
        DVec2::from_angle(angle) * (20.0 + 2.0 * turn - angle - 0.9 * p.y)
    };
    let target = source.iter().map(bent).collect();
    let faces = (0..n).flat_map(|i| {
        let v = 2 * i;
        [[v, v + 2, v + 3], [v, v + 3, v + 1]]
    });
    CompatibleMesh::new(faces.collect(), source, target, vec![]).expect("a mesh")
}

fn arap(mesh: &CompatibleMesh, homotopy: Homotopy, time_windows: &[Option<TimeWindow>]) -> Arap {
    let options = ArapOptions {
        homotopy,
        ..ArapOptions::default()
    };
    Arap::of_outlines(mesh, &options, time_windows, &Silent).expect("a solution")
}

/// Records a warp and returns the recording and the warp.
fn recorded(warp: impl Warp + 'static) -> (Recording, Arc<dyn Warp>) {
    let warp: Arc<dyn Warp> = Arc::new(warp);
    let recording = Recording::record(Arc::clone(&warp), &RecordingOptions::default(), &Silent);
    (recording.expect("a recording"), warp)
}

/// Returns the largest distance between a vertex in the recording and the same vertex in the warp,
/// at 201 times. It is a fraction of the diameter of all vertex positions in source and target.
fn off(recording: &dyn Warp, warp: &dyn Warp) -> f64 {
    let [mut recording, mut warp] = [recording.placer(), warp.placer()];
    let ends = recording
        .placement()
        .in_source
        .iter()
        .chain(&recording.placement().in_target);
    let diameter = crate::geometry::Bounds::of(ends.copied())
        .expect("points")
        .diameter();
    let mut farthest: f64 = 0.0;
    for k in 0..=200 {
        let t = f64::from(k) / 200.0;
        recording.place(t);
        warp.place(t);
        let places = [&recording, &warp].map(|placer| &placer.placement().in_frame);
        for (p, q) in places[0].iter().zip(places[1]) {
            farthest = farthest.max(p.distance(*q));
        }
    }
    farthest / diameter
}

#[test]
fn a_recording_matches_its_warp_within_the_stated_error() {
    for (turn, solves) in [(0.1, 12), (2.0, 14), (6.0, 22), (19.0, 80)] {
        // The homotopy of bounded distortion is not smooth in t, so it cannot be recorded.
        let smooth = |homotopy: &Homotopy| *homotopy != Homotopy::Bounded;
        for homotopy in Homotopy::ALL.into_iter().filter(smooth) {
            let (recording, warp) = recorded(arap(&strip(40, turn), homotopy, &[]));
            let off = off(&recording, warp.as_ref());
            assert!(
                off <= recording.error() + 1e-14,
                "{turn} {homotopy:?}: {off} {}",
                recording.error()
            );
            assert!(recording.error() <= 1.3e-9, "{}", recording.error());
            assert!(
                recording.evaluation_count() <= solves,
                "{turn} {homotopy:?}: {}",
                recording.evaluation_count()
            );
        }
    }
}

#[test]
fn ends_are_exact_and_beyond_them_the_warp_is_evaluated() {
    let mesh = strip(30, 2.5);
    let (recording, warp) = recorded(arap(&mesh, Homotopy::Polar, &[]));
    let [mut recording, mut warp] = [recording.placer(), warp.placer()];
    for t in [0.7, 0.0, 1.0, -0.5, 1.25] {
        recording.place(t);
        warp.place(t);
        if !(t > 0.0 && t < 1.0) {
            assert_eq!(
                recording.placement().in_frame,
                warp.placement().in_frame,
                "{t}"
            );
        }
    }
    recording.place(0.0);
    assert_eq!(recording.placement().in_frame, mesh.source());
    recording.place(1.0);
    assert_eq!(recording.placement().in_frame, mesh.target());
}

#[test]
fn a_rigid_target_moves_rigidly_and_an_equal_target_stands_still() {
    let mesh = strip(10, 1.0);
    let turned = mesh
        .source()
        .iter()
        .map(|p| DVec2::from_angle(2.0).rotate(*p));
    let of = |target: Vec<DVec2>| {
        CompatibleMesh::new(
            mesh.faces().to_vec(),
            mesh.source().to_vec(),
            target,
            vec![],
        )
        .expect("a mesh")
    };
    let rigid = of(turned.collect());
    let (recording, _) = recorded(arap(&rigid, Homotopy::Polar, &[]));
    let mut placer = recording.placer();
    for t in [0.2, 0.5, 0.9] {
        placer.place(t);
        let at = &placer.placement().in_frame;
        for k in 1..at.len() {
            let lengths = [
                at[k].distance(at[0]),
                mesh.source()[k].distance(mesh.source()[0]),
            ];
            assert!((lengths[0] - lengths[1]).abs() < 1e-8, "{lengths:?} at {t}");
        }
    }
    let still = of(mesh.source().to_vec());
    let (recording, _) = recorded(arap(&still, Homotopy::Polar, &[]));
    let mut placer = recording.placer();
    placer.place(0.6);
    assert_eq!(placer.placement().in_frame, mesh.source());
    assert_eq!(recording.bytes(), 0);
}

#[test]
fn exchanging_the_designs_reverses_the_recording() {
    let there = arap(&strip(30, 3.0), Homotopy::Polar, &[]);
    let back = there.swapped(&Silent).expect("a reversed recording");
    let [(there, _), (back, _)] = [there, back].map(recorded);
    let [mut there, mut back] = [there.placer(), back.placer()];
    for k in 0..=20 {
        let t = f64::from(k) / 20.0;
        there.place(t);
        back.place(1.0 - t);
        let places = [&there, &back].map(|placer| &placer.placement().in_frame);
        for (p, q) in places[0].iter().zip(places[1]) {
            assert!(p.distance(*q) < 1e-9 * 30.0, "{p} {q} at {t}");
        }
    }
}

/// Mesh of two strips; in the source the second one is only a seed shape (a tiny copy of itself).
/// Also returns the time window in which that strip grows.
fn with_an_appearing_part() -> (CompatibleMesh, [Option<TimeWindow>; 2]) {
    let [a, b] = [strip(6, 2.0), strip(4, 1.0)];
    let n = a.source().len() as u32;
    let faces = (a.faces().iter().copied()).chain(b.faces().iter().map(|f| f.map(|v| v + n)));
    let away = DVec2::new(40.0, 3.0);
    let seed = b.target().iter().map(|p| *p * 1e-3 + away);
    let source = a.source().iter().copied().chain(seed);
    let target = a
        .target()
        .iter()
        .copied()
        .chain(b.target().iter().map(|p| *p + away));
    let mesh = CompatibleMesh::new(faces.collect(), source.collect(), target.collect(), vec![]);
    let window = TimeWindow {
        side: Side::Target,
        from: 0.4,
        to: 0.8,
    };
    (mesh.expect("a mesh"), [None, Some(window)])
}

#[test]
fn a_part_that_starts_late_begins_a_new_interval() {
    let (mesh, time_windows) = with_an_appearing_part();
    let (recording, warp) = recorded(arap(&mesh, Homotopy::Polar, &time_windows));
    assert_eq!(recording.interval_count(), 3);
    assert!(off(&recording, warp.as_ref()) <= recording.error() + 1e-14);
    let clock = PartClock {
        from: 0.25,
        to: 0.75,
        easing: NamedEasing::Smooth.into(),
    };
    let arap = arap(&mesh, Homotopy::Polar, &time_windows);
    let (recording, warp) = recorded(StaggeredArap::new(arap, &[clock], &[Some(0), Some(0)]));
    assert!(off(&recording, warp.as_ref()) <= recording.error() + 1e-14);
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_recording_is_the_same_on_any_number_of_threads() {
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| {
            let (recording, _) = recorded(arap(&strip(30_000, 2.0), Homotopy::Polar, &[]));
            let mut placer = recording.placer();
            placer.place(0.3);
            placer.placement().in_frame.clone()
        })
    };
    assert!(of(1) == of(3));
}

#[test]
fn too_large_and_cancelled_recordings_are_refused() {
    let warp: Arc<dyn Warp> = Arc::new(arap(&strip(100, 2.0), Homotopy::Polar, &[]));
    let options = RecordingOptions {
        max_bytes: 10_000,
        ..RecordingOptions::default()
    };
    let error = Recording::record(Arc::clone(&warp), &options, &Silent).expect_err("too large");
    assert!(
        matches!(error, RecordingError::TooLarge { limit: 10_000, .. }),
        "{error}"
    );
    struct CancelledProgress;
    impl Progress for CancelledProgress {
        fn report(&self, _: &'static str, _: f64) {}
        fn is_cancelled(&self) -> bool {
            true
        }
    }
    let error = Recording::record(warp, &RecordingOptions::default(), &CancelledProgress)
        .expect_err("cancelled");
    assert!(matches!(error, RecordingError::Cancelled(_)));
}

/// Warp of one point that jumps at t = 0.3 and does not report a break time.
#[derive(Debug)]
struct JumpingWarp;

impl Warp for JumpingWarp {
    fn placer(&self) -> Placer {
        let none: Arc<[[u32; 3]]> = Arc::new([]);
        let placement = Placement::of_source(none, &[DVec2::ZERO], &[DVec2::ONE]);
        Placer::new(placement, |t, placement| {
            placement.in_frame[0] = if t < 0.3 { DVec2::ZERO } else { DVec2::ONE };
        })
    }
}

#[test]
fn a_jump_is_reported_and_not_smoothed_over() {
    let error = Recording::record(Arc::new(JumpingWarp), &RecordingOptions::default(), &Silent);
    let error = error.expect_err("a jump");
    assert!(
        matches!(error, RecordingError::NotSmooth { t } if (t - 0.3).abs() < 2e-3),
        "{error}"
    );
}

/// Warp of two points, the first of which starts to move at the first given time, accelerates at
/// the second, and is back at its start at t = 1.
#[derive(Debug)]
struct ReturningWarp([f64; 2]);

impl Warp for ReturningWarp {
    fn placer(&self) -> Placer {
        let none: Arc<[[u32; 3]]> = Arc::new([]);
        let placement = Placement::of_source(none, &[DVec2::ZERO, DVec2::ONE], &[DVec2::ZERO; 2]);
        let [from, then] = self.0;
        Placer::new(placement, move |t, placement| {
            let late = (t - from).max(0.0) * (1.0 - t) + (t - then).max(0.0) * (1.0 - t);
            placement.in_frame[0] = DVec2::X * late;
        })
    }

    fn break_times(&self) -> Vec<f64> {
        self.0.to_vec()
    }
}

#[test]
fn late_motion_and_breaks_close_together_are_recorded() {
    for breaks in [[0.5, 0.5], [0.3, 0.3003], [0.5, 0.9995]] {
        let (recording, warp) = recorded(ReturningWarp(breaks));
        assert!(
            off(&recording, warp.as_ref()) <= recording.error() + 1e-14,
            "{breaks:?}"
        );
        let mut placer = recording.placer();
        placer.place(0.75);
        assert!(placer.placement().in_frame[0].x > 0.01, "{breaks:?}");
    }
}
