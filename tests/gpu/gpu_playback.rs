//! Compares recordings played on the GPU with frames solved on the CPU. Also tests when the CPU
//! takes over, and that recordings and transitions can be replaced at any time.

use bevy::render::render_resource::WgpuLimits;
use morphospace::recording::RecordingOptions;
use morphospace::transition::Transition;
use morphospace::work::progress::Silent;

use crate::offscreen::{OffscreenRenderer, RenderedScene};
use crate::transitions::{field, perforated, solid, spiral, truss};

/// Maximum fraction of pixels that may differ between played and solved images (tolerance: single
/// precision moves edges by a thousandth of a pixel).
const MAX_PLAYED_DIFFERENCE: f64 = 1e-4;

/// Records a transition and returns the transition with its recording.
fn recorded(transition: Transition) -> Transition {
    let film = transition.record(&RecordingOptions::default(), &Silent);
    film.expect("a recording");
    transition
}

/// Maximum distance between the played vertex positions `at` and the solved ones at t, relative to
/// the diameter of the transition.
fn deviation(played: &Transition, solved: &Transition, at: &[glam::DVec2], t: f64) -> f64 {
    let frame = solved.frame(t);
    let pairs = frame.placement().in_frame.iter().zip(at);
    let max_distance = pairs.map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
    max_distance / played.bounds().diameter()
}

pub fn gpu_playback_matches_solved_frames(renderer: &mut OffscreenRenderer) {
    let scenes: [(&str, &dyn Fn() -> Transition); 3] = [
        ("played", &|| solid(0.0)),
        ("played-far", &|| solid(1e6)),
        // The spiral makes six full turns, which need at least two intervals of the recording.
        ("played-spiral", &|| spiral(40.0)),
    ];
    for (name, make) in scenes {
        let (played, solved) = (
            RenderedScene::new(name, recorded(make())),
            RenderedScene::new(name, make()),
        );
        let intervals = played
            .transition
            .recording()
            .and_then(|film| film.as_ref().ok());
        let intervals = intervals.expect("a film").interval_count();
        assert!(
            name != "played-spiral" || intervals > 1,
            "{intervals} intervals"
        );
        renderer.place(&played, 0.9);
        renderer.wait_for_gpu_playback();
        // The ends of all intervals in order, then jumps back and forth between intervals.
        let interval_ends = (0..=intervals).map(|k| k as f64 / intervals as f64);
        let times = interval_ends.chain([0.35, 0.6, 0.0, 0.501, 0.499]);
        for t in times {
            renderer.seek(t);
            assert!(renderer.is_gpu_played(), "{name} at {t}");
            let deviation = renderer
                .read_vertices(|at| deviation(&played.transition, &solved.transition, at, t));
            assert!(deviation < 1e-8, "{name} at {t}: {deviation}");
            let image = renderer.capture(&played).expect("a picture");
            renderer.save_image(&format!("{name}-played"), t, &image);
            let hidden = renderer.hide();
            let (solved_gpu, solved_cpu) = renderer.compare(&solved, t);
            renderer.unhide(hidden);
            crate::assert_images_match(name, &solved, t, &image, &solved_cpu);
            let fraction = crate::different_fraction(&image, &solved_gpu);
            assert!(
                fraction <= MAX_PLAYED_DIFFERENCE,
                "{name} at {t}: {fraction}"
            );
        }
        renderer.clear();
    }
}

/// While t is in [0, 1], the GPU plays the recording and no mesh is written. For other t, frames
/// are solved on the CPU.
pub fn gpu_playback_writes_no_meshes(renderer: &mut OffscreenRenderer) {
    let mut scene = RenderedScene::new("unwritten", recorded(spiral(15.0)));
    scene.visibility.wireframe = true;
    renderer.place(&scene, 0.5);
    renderer.wait_for_gpu_playback();
    renderer.take_written_count();
    for k in 0..=30 {
        renderer.seek(f64::from(k) / 30.0);
        assert!(renderer.is_gpu_played());
    }
    assert_eq!(renderer.take_written_count(), 0);
    for t in [-0.2, 1.1] {
        renderer.seek(t);
        assert!(!renderer.is_gpu_played());
        let (outside, solved) = (renderer.capture(&scene), {
            let hidden = renderer.hide();
            let mut solved = RenderedScene::new("unwritten", spiral(15.0));
            solved.visibility = scene.visibility;
            let image = renderer.render(&solved, t);
            renderer.unhide(hidden);
            image
        });
        let fraction =
            crate::different_fraction(&outside.expect("a picture"), &solved.expect("a picture"));
        assert!(fraction <= MAX_PLAYED_DIFFERENCE, "{t}: {fraction}");
    }
    assert!(renderer.take_written_count() > 0);
    // The recording has no warp grid, so frames are solved while the grid is visible.
    renderer.seek(0.25);
    assert!(renderer.is_gpu_played());
    renderer.change_visibility(|show| show.grid = true);
    renderer.seek(0.3);
    assert!(!renderer.is_gpu_played());
    renderer.clear();
}

/// Compares played wireframes with solved ones, with and without filled faces.
pub fn gpu_playback_of_wireframes_matches_solved_frames(renderer: &mut OffscreenRenderer) {
    let [mut played, mut solved] = [recorded(spiral(15.0)), spiral(15.0)].map(|transition| {
        let mut scene = RenderedScene::new("wires", transition);
        scene.visibility.wireframe = true;
        scene
    });
    for fill in [true, false] {
        (played.visibility.fill, solved.visibility.fill) = (fill, fill);
        renderer.place(&played, 0.4);
        renderer.wait_for_gpu_playback();
        for t in [0.0, 0.3, 0.77, 1.0] {
            renderer.seek(t);
            assert!(renderer.is_gpu_played());
            let image = renderer.capture(&played).expect("a picture");
            renderer.save_image("wires-played", t, &image);
            let hidden = renderer.hide();
            let solved_gpu = renderer.render(&solved, t).expect("a picture");
            renderer.unhide(hidden);
            let fraction = crate::different_fraction(&image, &solved_gpu);
            assert!(fraction <= MAX_PLAYED_DIFFERENCE, "{t}: {fraction}");
        }
        renderer.clear();
    }
}

/// If vertex shaders can read no more storage buffers than Bevy itself needs, the CPU plays the
/// recording, with the same result. (The test does not forbid all storage buffers, because Bevy
/// then draws nothing on a software adapter.)
pub fn without_storage_buffers_the_cpu_plays(_: &mut OffscreenRenderer) {
    let mut renderer = OffscreenRenderer::open(Some(WgpuLimits {
        max_storage_buffers_per_shader_stage: 3,
        ..WgpuLimits::default()
    }))
    .expect("the same adapter");
    let scene = RenderedScene::new("without-buffers", recorded(solid(0.0)));
    renderer.place(&scene, 0.5);
    for k in 0..=50 {
        renderer.seek(f64::from(k) / 50.0);
        assert!(!renderer.is_gpu_played());
    }
    renderer.clear();
    renderer.compare(&scene, 0.35);
}

/// Removing a transition while its recording is being uploaded or played does not affect the
/// transition that follows.
pub fn recordings_are_released_with_their_transitions(renderer: &mut OffscreenRenderer) {
    let [long, short] = [recorded(spiral(15.0)), solid(0.0)];
    renderer.place(&RenderedScene::new("first", long.clone()), 0.5);
    renderer.seek(0.4);
    renderer.clear();
    renderer.place(&RenderedScene::new("second", long.clone()), 0.5);
    renderer.wait_for_gpu_playback();
    // The second transition replaces the first on the same entity, but is not recorded yet.
    renderer.replace(&short);
    for k in 0..20 {
        renderer.seek(f64::from(k) / 20.0);
        assert!(!renderer.is_gpu_played());
    }
    recorded(short.clone());
    renderer.wait_for_gpu_playback();
    renderer.seek(0.35);
    let scene = RenderedScene::new("second", short);
    let image = renderer.capture(&scene).expect("a picture");
    renderer.clear();
    let (_, solved_cpu) = renderer.compare(&RenderedScene::new("second", solid(0.0)), 0.35);
    crate::assert_images_match("second", &scene, 0.35, &image, &solved_cpu);
}

/// When a transition replaces another, no frame is empty, even if the new transition needs shaders
/// that are not compiled yet.
pub fn replacing_a_transition_leaves_no_empty_frame(_: &mut OffscreenRenderer) {
    let mut renderer = OffscreenRenderer::open_like_a_window().expect("the same adapter");
    let first = RenderedScene::new("replaced", solid(0.0));
    let others: [(&str, &dyn Fn() -> Transition); 3] = [
        ("rings", &perforated),
        ("bars", &truss),
        ("field", &|| field().swap_remove(0).1),
    ];
    for (name, make) in others {
        let other = make();
        let scene = RenderedScene {
            // The view is large enough for both transitions.
            view: first.view.union(&other.bounds()),
            ..RenderedScene::new("replaced", first.transition.clone())
        };
        renderer.place(&scene, 0.3);
        let images = renderer.capture_frames(&scene, |renderer| renderer.replace(&other), 6);
        let pixel_counts = images.iter().enumerate().map(|(k, image)| {
            renderer.save_image(&format!("replaced-by-{name}-{k}"), 0.3, image);
            let ground = image.get_pixel(0, 0);
            image.pixels().filter(|pixel| *pixel != ground).count()
        });
        let pixel_counts: Vec<usize> = pixel_counts.collect();
        assert!(
            pixel_counts.iter().all(|n| *n > 0),
            "{name}: {pixel_counts:?}"
        );
        renderer.clear();
    }
}
