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
    FilmSpec::of_timing(&timing, &[TransitionStop::at(0.5).named("half")], 25.0).expect("a film")
}

fn motion() -> (Camera, VectorAnimation) {
    let camera = camera(400, 300, Some(Rgb([250, 248, 240])));
    let motion = VectorAnimation::record(&camera, &film(), &Silent).expect("a motion");
    (camera, motion)
}

/// How far the points of two drawings of the same shapes are from each other.
fn apart(a: &Drawing, b: &Drawing) -> f64 {
    let points = |drawing: &Drawing| -> Vec<_> {
        let posed = drawing.items.iter().filter_map(PosedShape::of);
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

#[test]
fn straight_ways_between_keys_stay_within_the_tolerance() {
    let (camera, motion) = motion();
    let course = &motion.course;
    let stations = course.times.iter().enumerate();
    let stations: Vec<(f64, f64)> = stations.map(|(k, &t)| (k as f64, t)).collect();
    let layers = tracks::layers(&motion, &stations);
    let [layer] = layers.as_slice() else {
        panic!("one scene: {} layers", layers.len());
    };
    let poses = &layer.shapes[0];
    let keys = layer.points(poses, 0..3, |posed| posed.points.clone()).keys;
    assert!(keys.len() < stations.len(), "{} keys", keys.len());
    for &(x, t) in &stations {
        let after = keys.partition_point(|key| key.0 < x).max(1);
        let [(a, from), (b, to)] = [&keys[after - 1], &keys[after]];
        let share = (x - a) / (b - a);
        let Some(own) = PosedShape::of(&camera.shoot(t).items[0]) else {
            panic!("a shape");
        };
        for ((p, q), wanted) in from.iter().zip(to).zip(&own.points) {
            let off = p.lerp(*q, share).distance(*wanted);
            assert!(
                off <= VectorAnimation::TOLERANCE_PX - 0.01,
                "{off} px off at {t}"
            );
        }
    }
}

#[test]
fn what_is_written_is_whole_and_asks_for_nothing_else() {
    let (_, motion) = motion();
    let hostile = "</script><b>&{{film}}";
    let page = motion.page(hostile);
    assert!(page.len() < 20_000 && !page.contains("<b>"));
    assert_eq!(page.matches("</script>").count(), 2);
    let linked = page.replace("http://www.w3.org/2000/svg", "");
    assert!(!linked.contains("http") && !linked.contains("src="));
    let lottie: serde_json::Value = serde_json::from_str(&motion.lottie(hostile)).expect("JSON");
    assert_eq!(lottie["op"], film().times().len());
    assert_eq!(lottie["fr"], 25.0);
    let svg = motion.svg();
    assert!(usvg::Tree::from_str(&svg, &usvg::Options::default()).is_ok());
    assert!(svg.contains("repeatCount=\"indefinite\"") && !svg.contains("NaN"));
}

#[test]
fn a_single_frame_is_a_film_too() {
    let camera = camera(40, 30, None);
    let film = FilmSpec::evenly(0.5, 0.5, 1, 10.0).expect("a film");
    let motion = VectorAnimation::record(&camera, &film, &Silent).expect("a motion");
    assert!(apart(&motion.at(0.5), &camera.shoot(0.5)) < 0.05);
    let all = [motion.svg(), motion.page("one"), motion.lottie("one")];
    assert!(all.iter().all(|text| !text.contains("NaN")));
}
