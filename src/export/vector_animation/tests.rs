//! Tests of vector animations: accuracy of the recording and its keyframes, and validity of the
//! three formats.

use super::shape::PosedShape;
use super::*;
use crate::colour::Rgb;
use crate::export::Drawing;
use crate::export::test_camera::camera;
use crate::transition::{PlayMode, Timing, TransitionStop};
use crate::work::progress::Silent;

fn film() -> FilmSpec {
    let timing = Timing {
        duration_secs: 1.0,
        hold_secs: 0.2,
        play: PlayMode::PingPong,
        ..Timing::default()
    };
    FilmSpec::of_timing(&timing, &[TransitionStop::at(0.5).with_name("half")], 25.0)
        .expect("a film")
}

fn animation() -> (Camera, VectorAnimation) {
    let camera = camera(400, 300, Some(Rgb([250, 248, 240])));
    let animation = VectorAnimation::record(&camera, &film(), &Silent).expect("an animation");
    (camera, animation)
}

/// Returns the largest distance between corresponding points of two drawings of the same shapes, in
/// pixels.
fn max_distance(a: &Drawing, b: &Drawing) -> f64 {
    let points = |drawing: &Drawing| -> Vec<_> {
        let posed = drawing.items.iter().filter_map(PosedShape::of);
        posed.flat_map(|posed| posed.points).collect()
    };
    let (a, b) = (points(a), points(b));
    assert_eq!(a.len(), b.len());
    let distances = a.iter().zip(&b).map(|(a, b)| a.distance(*b));
    distances.fold(0.0, f64::max)
}

#[test]
fn recorded_points_match_the_camera_at_every_t() {
    let (camera, animation) = animation();
    for k in 0..=100 {
        let t = f64::from(k) / 100.0;
        let off = max_distance(&animation.at(t), &camera.draw(t));
        assert!(off < 0.05, "{off} px off at {t}");
    }
}

#[test]
fn linear_interpolation_between_keys_stays_within_the_tolerance() {
    let (camera, animation) = animation();
    let course = &animation.timeline;
    let numbered = course.times.iter().enumerate();
    let stations: Vec<(f64, f64)> = numbered.map(|(k, &t)| (k as f64, t)).collect();
    let layers = tracks::layers(&animation, &stations);
    let [layer] = layers.as_slice() else {
        panic!("expected one layer, not {}", layers.len());
    };
    let poses = &layer.shapes[0];
    let keys = layer.points(poses, 0..3, |posed| posed.points.clone()).keys;
    assert!(keys.len() < stations.len(), "{} keys", keys.len());
    for &(x, t) in &stations {
        let after = keys.partition_point(|key| key.0 < x).max(1);
        let [(a, from), (b, to)] = [&keys[after - 1], &keys[after]];
        let share = (x - a) / (b - a);
        let Some(exact) = PosedShape::of(&camera.draw(t).items[0]) else {
            panic!("a shape");
        };
        for ((p, q), expected) in from.iter().zip(to).zip(&exact.points) {
            let off = p.lerp(*q, share).distance(*expected);
            assert!(
                off <= VectorAnimation::TOLERANCE_PX - 0.01,
                "{off} px off at {t}"
            );
        }
    }
}

#[test]
fn files_are_valid_and_self_contained() {
    let (_, animation) = animation();
    let hostile = "</script><b>&{{film}}";
    let page = animation.page(hostile);
    assert!(page.len() < 20_000 && !page.contains("<b>"));
    assert_eq!(page.matches("</script>").count(), 2);
    let linked = page.replace("http://www.w3.org/2000/svg", "");
    assert!(!linked.contains("http") && !linked.contains("src="));
    let lottie: serde_json::Value = serde_json::from_str(&animation.lottie(hostile)).expect("JSON");
    assert_eq!(lottie["op"], film().times().len());
    assert_eq!(lottie["fr"], 25.0);
    let svg = animation.svg();
    assert!(usvg::Tree::from_str(&svg, &usvg::Options::default()).is_ok());
    assert!(svg.contains("repeatCount=\"indefinite\"") && !svg.contains("NaN"));
}

#[test]
fn each_frame_of_a_lottie_film_shows_a_whole_frame_of_its_composition() {
    let (_, animation) = animation();
    let lottie: serde_json::Value = serde_json::from_str(&animation.lottie("a")).expect("JSON");
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let keys: Vec<(f64, f64)> = (lottie["layers"][0]["tm"]["k"].as_array().expect("keys"))
        .iter()
        .map(|key| (number(&key["t"]), number(&key["s"][0])))
        .collect();
    let times = &animation.timeline.times;
    let mut shown = times.clone();
    shown.sort_by(f64::total_cmp);
    shown.dedup();
    assert!(keys.len() < 12, "pauses and turns only: {keys:?}");
    for (k, t) in times.iter().enumerate() {
        let after = keys.partition_point(|key| key.0 < k as f64).max(1);
        let [(a, from), (b, to)] = [keys[after - 1], keys[after]];
        let secs = from + (to - from) * (k as f64 - a) / (b - a);
        let frame = secs * animation.timeline.fps;
        let expected = shown.iter().position(|other| other == t).expect("shown");
        // Players that round down show this frame, and others one that looks the same.
        assert_eq!(frame.floor() as usize, expected, "frame {k}");
        assert!(frame - frame.floor() < 0.02, "{frame}");
    }
}

#[test]
fn a_film_of_one_frame_can_be_exported() {
    let camera = camera(40, 30, None);
    let film = FilmSpec::evenly(0.5, 0.5, 1, 10.0).expect("a film");
    let animation = VectorAnimation::record(&camera, &film, &Silent).expect("an animation");
    assert!(max_distance(&animation.at(0.5), &camera.draw(0.5)) < 0.05);
    let all = [
        animation.svg(),
        animation.page("one"),
        animation.lottie("one"),
    ];
    assert!(all.iter().all(|text| !text.contains("NaN")));
}
