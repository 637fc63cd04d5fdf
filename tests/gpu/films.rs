//! Films that the graphics card plays, held against frames that were solved.

use bevy::render::render_resource::WgpuLimits;
use morphospace::recording::RecordingOptions;
use morphospace::transition::Transition;
use morphospace::work::progress::Silent;

use crate::scenes::{field, perforated, solid, truss, wound};
use crate::studio::{Scene, Studio};

/// How much of two pictures of the stage may differ, one of which was played: single
/// precision is a matter of a thousandth of a pixel.
const PLAYED: f64 = 1e-4;

fn recorded(transition: Transition) -> Transition {
    let film = transition.record(&RecordingOptions::default(), &Silent);
    film.expect("a film");
    transition
}

/// How far what is played is from what was solved, as a share of the designs' size.
fn off(played: &Transition, solved: &Transition, at: &[glam::DVec2], t: f64) -> f64 {
    let frame = solved.frame(t);
    let pairs = frame.placement().in_frame.iter().zip(at);
    let most = pairs.map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
    most / played.bounds().diameter()
}

pub fn films_are_played_as_they_would_be_solved(studio: &mut Studio) {
    let scenes: [(&str, &dyn Fn() -> Transition); 3] = [
        ("played", &|| solid(0.0)),
        ("played-far", &|| solid(1e6)),
        // Six times around: two reels at least.
        ("played-wound", &|| wound(40.0)),
    ];
    for (name, make) in scenes {
        let (played, solved) = (Scene::new(name, recorded(make())), Scene::new(name, make()));
        let reels = played.transition.film().and_then(|film| film.as_ref().ok());
        let reels = reels.expect("a film").reel_count();
        assert!(name != "played-wound" || reels > 1, "{reels} reels");
        studio.put(&played, 0.9);
        studio.wait_until_played();
        // Back and forth over the seams between reels, the ends among them.
        let seams = (0..=reels).map(|k| k as f64 / reels as f64);
        let times = seams.chain([0.35, 0.6, 0.0, 0.501, 0.499]);
        for t in times {
            studio.move_to(t);
            assert!(studio.is_played(), "{name} at {t}");
            let off = studio.read(|at| off(&played.transition, &solved.transition, at, t));
            assert!(off < 1e-8, "{name} at {t}: {off}");
            let picture = studio.take(&played).expect("a picture");
            studio.keep(&format!("{name}-played"), t, &picture);
            let stays = studio.put_away();
            let (by_stage, by_core) = studio.compare(&solved, t);
            studio.put_back(stays);
            crate::check(name, &solved, t, &picture, &by_core);
            let differs = crate::different(&picture, &by_stage);
            assert!(differs <= PLAYED, "{name} at {t}: {differs}");
        }
        studio.clear();
    }
}

/// Nothing is written while t moves, unless it leaves the film.
pub fn what_is_played_is_not_written(studio: &mut Studio) {
    let mut scene = Scene::new("unwritten", recorded(wound(15.0)));
    scene.show.wireframe = true;
    studio.put(&scene, 0.5);
    studio.wait_until_played();
    studio.count_written();
    for k in 0..=30 {
        studio.move_to(f64::from(k) / 30.0);
        assert!(studio.is_played());
    }
    assert_eq!(studio.count_written(), 0);
    for t in [-0.2, 1.1] {
        studio.move_to(t);
        assert!(!studio.is_played());
        let (outside, solved) = (studio.take(&scene), {
            let stays = studio.put_away();
            let mut solved = Scene::new("unwritten", wound(15.0));
            solved.show = scene.show;
            let picture = studio.picture(&solved, t);
            studio.put_back(stays);
            picture
        });
        let differs = crate::different(&outside.expect("a picture"), &solved.expect("a picture"));
        assert!(differs <= PLAYED, "{t}: {differs}");
    }
    assert!(studio.count_written() > 0);
    // A grid is no film's: while it is seen the frame is placed for it.
    studio.move_to(0.25);
    assert!(studio.is_played());
    studio.show(|show| show.grid = true);
    studio.move_to(0.3);
    assert!(!studio.is_played());
    studio.clear();
}

/// The wires are where the faces are.
pub fn wires_are_played_as_they_would_be_solved(studio: &mut Studio) {
    let [mut played, mut solved] = [recorded(wound(15.0)), wound(15.0)].map(|of| {
        let mut scene = Scene::new("wires", of);
        scene.show.wireframe = true;
        scene
    });
    for fill in [true, false] {
        (played.show.fill, solved.show.fill) = (fill, fill);
        studio.put(&played, 0.4);
        studio.wait_until_played();
        for t in [0.0, 0.3, 0.77, 1.0] {
            studio.move_to(t);
            assert!(studio.is_played());
            let picture = studio.take(&played).expect("a picture");
            studio.keep("wires-played", t, &picture);
            let stays = studio.put_away();
            let by_stage = studio.picture(&solved, t).expect("a picture");
            studio.put_back(stays);
            let differs = crate::different(&picture, &by_stage);
            assert!(differs <= PLAYED, "{t}: {differs}");
        }
        studio.clear();
    }
}

/// A card whose vertex shaders can read no more buffers than Bevy's shows the same, from
/// memory. (Of none at all Bevy's software renderer draws nothing.)
pub fn without_buffers_films_are_played_from_memory(_: &mut Studio) {
    let mut studio = Studio::open(Some(WgpuLimits {
        max_storage_buffers_per_shader_stage: 3,
        ..WgpuLimits::default()
    }))
    .expect("the same adapter");
    let scene = Scene::new("without-buffers", recorded(solid(0.0)));
    studio.put(&scene, 0.5);
    for k in 0..=50 {
        studio.move_to(f64::from(k) / 50.0);
        assert!(!studio.is_played());
    }
    studio.clear();
    studio.compare(&scene, 0.35);
}

/// What is taken from the stage while its film is on the way, or on the card, leaves
/// nothing behind, and another takes its place.
pub fn films_come_and_go_with_their_transitions(studio: &mut Studio) {
    let [long, short] = [recorded(wound(15.0)), solid(0.0)];
    studio.put(&Scene::new("first", long.clone()), 0.5);
    studio.move_to(0.4);
    studio.clear();
    studio.put(&Scene::new("second", long.clone()), 0.5);
    studio.wait_until_played();
    // In its place, on the same entity: not recorded yet.
    studio.replace(&short);
    for k in 0..20 {
        studio.move_to(f64::from(k) / 20.0);
        assert!(!studio.is_played());
    }
    recorded(short.clone());
    studio.wait_until_played();
    studio.move_to(0.35);
    let scene = Scene::new("second", short);
    let picture = studio.take(&scene).expect("a picture");
    studio.clear();
    let (_, by_core) = studio.compare(&Scene::new("second", solid(0.0)), 0.35);
    crate::check("second", &scene, 0.35, &picture, &by_core);
}

/// A film that is improved, or opened after another, takes its place from one frame to
/// the next: no frame between them shows neither, though it be drawn in ways that
/// nothing was drawn in before.
pub fn no_frame_is_empty_where_one_takes_the_place_of_another(_: &mut Studio) {
    let mut studio = Studio::as_a_window().expect("the same adapter");
    let first = Scene::new("replaced", solid(0.0));
    let others: [(&str, &dyn Fn() -> Transition); 3] = [
        ("rings", &perforated),
        ("bars", &truss),
        ("field", &|| field().swap_remove(0).1),
    ];
    for (name, make) in others {
        let other = make();
        let seen = Scene {
            // Both lie in it.
            view: first.view.union(&other.bounds()),
            ..Scene::new("replaced", first.transition.clone())
        };
        studio.put(&seen, 0.3);
        let pictures = studio.watch(&seen, |studio| studio.replace(&other), 6);
        let shapes = pictures.iter().enumerate().map(|(k, picture)| {
            studio.keep(&format!("replaced-by-{name}-{k}"), 0.3, picture);
            let ground = picture.get_pixel(0, 0);
            picture.pixels().filter(|pixel| *pixel != ground).count()
        });
        let shapes: Vec<usize> = shapes.collect();
        assert!(shapes.iter().all(|n| *n > 0), "{name}: {shapes:?}");
        studio.clear();
    }
}
