use super::*;
use crate::export::testing::camera;
use crate::progress::Silent;
use crate::transition::{PlayMode, Stop, Timing};

fn film() -> Film {
    let timing = Timing {
        duration_secs: 1.0,
        hold_secs: 0.2,
        play: PlayMode::PingPong,
        ..Timing::default()
    };
    Film::of_timing(&timing, &[Stop::at(0.5).named("half")], 25.0).expect("a film")
}

fn motion() -> (Camera, Motion) {
    let camera = camera(400, 300, Some(Rgb([250, 248, 240])));
    let motion = Motion::record(&camera, &film(), &Silent).expect("a motion");
    (camera, motion)
}

/// How far the points of two drawings of the same shapes are from each other.
fn apart(a: &Drawing, b: &Drawing) -> f64 {
    let points = |drawing: &Drawing| -> Vec<_> {
        let posed = drawing.items.iter().filter_map(Posed::of);
        posed.flat_map(|posed| posed.points).collect()
    };
    let (a, b) = (points(a), points(b));
    assert_eq!(a.len(), b.len());
    let far = a.iter().zip(&b).map(|(a, b)| a.distance(*b));
    far.fold(0.0, f64::max)
}

#[test]
fn a_motion_is_where_the_camera_draws_at_every_t() {
    let (camera, motion) = motion();
    for k in 0..=100 {
        let t = f64::from(k) / 100.0;
        let off = apart(&motion.at(t), &camera.shoot(t));
        assert!(off < 0.05, "{off} px off at {t}");
    }
}
