//! The map of all designs in the window: built, walked on, laid out otherwise.

use std::path::PathBuf;

use bevy::input::keyboard::{Key, KeyCode};
use bevy::math::Vec2;
use morphospace::app::{Intent, MapView, StageArea};
use morphospace::geometry::DVec2;
use morphospace::space::MapLayout;
use tempfile::TempDir;

use crate::window::Window;

fn map(window: &Window) -> &MapView {
    window.0.world().resource::<MapView>()
}

/// Waits for the space and for all that is drawn of it.
fn wait(window: &mut Window) {
    for _ in 0..20_000 {
        window.update();
        let view = map(window);
        let is_drawn = view.made().is_some_and(|made| made.ground().is_some());
        if !view.is_busy() && (is_drawn || view.problem().is_some()) {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("the map is not there");
}

fn shown(mut window: Window) -> Window {
    let area = StageArea {
        size: Vec2::new(160.0, 120.0),
        ..StageArea::default()
    };
    window.0.insert_resource(area);
    window.send(Intent::ToggleMap);
    wait(&mut window);
    window
}

/// Rectangles as wide as their numbers, the last one with a hole where it is asked for.
fn opened(count: usize, has_hole: bool) -> (TempDir, Window) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |k: usize| {
        let path = folder.path().join(format!("d{k}.json"));
        let outer = format!("[[0,0],[{0},0],[{0},3],[0,3]]", k + 1);
        let hole = "[[0.2,1],[0.8,1],[0.8,2],[0.2,2]]";
        let text = match has_hole && k + 1 == count {
            true => format!("[{outer},{hole}]"),
            false => outer,
        };
        std::fs::write(&path, text).expect("a file");
        path
    };
    let files: Vec<PathBuf> = (0..count).map(file).collect();
    let mut window = Window::new();
    window.send(Intent::Open(files));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    (folder, shown(window))
}

fn weights(window: &Window) -> Vec<f64> {
    map(window).made().expect("a map").weights().to_vec()
}

#[test]
fn the_puck_walks_between_the_designs() {
    let (_folder, mut window) = opened(3, false);
    let made = map(&window).made().expect("a map");
    assert!(
        made.space().family().is_some(),
        "{:?}",
        made.space().notes()
    );
    let sites = made.map().sites().to_vec();
    assert_eq!(sites.len(), 3);
    // In the middle all count as much.
    let even = weights(&window);
    assert!(
        even.iter().all(|share| (share - 1.0 / 3.0).abs() < 1e-6),
        "{even:?}"
    );
    let before = map(&window).made().and_then(|made| made.blend().cloned());
    window.send(Intent::Puck(sites[2]));
    window.update();
    assert_eq!(weights(&window), [0.0, 0.0, 1.0]);
    let after = map(&window).made().and_then(|made| made.blend().cloned());
    assert!(before.is_some() && before != after);
    // An arrow goes a little, and t does not.
    let (t, puck) = (window.t(), map(&window).puck());
    window.press(KeyCode::ArrowLeft, Key::ArrowLeft);
    window.update();
    assert_eq!(window.t(), t);
    assert!(map(&window).puck().x < puck.x);
    // Places beyond all bounds are none.
    window.send(Intent::Puck(DVec2::NAN));
    window.send(Intent::Puck(DVec2::splat(1e300)));
    window.update();
    assert!(weights(&window).iter().all(|share| share.is_finite()));
}

#[test]
fn designs_are_laid_out_and_moved() {
    let (_folder, mut window) = opened(3, false);
    window.send(Intent::LayOut(MapLayout::Line));
    wait(&mut window);
    let sites = |window: &Window| {
        let made = map(window).made().expect("a map");
        made.map().sites().to_vec()
    };
    assert!(sites(&window).iter().all(|site| site.y == 0.0));
    let to = DVec2::new(0.1, 0.8);
    window.send(Intent::MoveSite(1, to));
    wait(&mut window);
    assert_eq!(sites(&window)[1], to);
    // Onto another one: it stays where it was.
    let other = sites(&window)[0];
    window.send(Intent::MoveSite(1, other));
    window.send(Intent::MoveSite(99, to));
    wait(&mut window);
    assert_eq!(sites(&window)[1], to);
    // Where they were put is of the project, and can be taken back.
    let kept = |window: &Window| {
        window
            .session()
            .whole()
            .expect("a project")
            .map
            .sites
            .clone()
    };
    assert_eq!(kept(&window)[1], to);
    window.send(Intent::Undo);
    wait(&mut window);
    assert!(kept(&window).is_empty());
}

/// Waits for the film as well.
fn wait_for_film(window: &mut Window) {
    window.wait();
    wait(window);
}

#[test]
fn a_path_is_drawn_played_and_taken_back() {
    let (_folder, mut window) = opened(3, false);
    let sites = map(&window).made().expect("a map").map().sites().to_vec();
    // One stop is no path yet.
    window.send(Intent::ExtendPath(vec![sites[0] + DVec2::splat(0.01)]));
    wait_for_film(&mut window);
    let whole = window.session().whole().expect("a project").clone();
    assert!(!whole.follows_path());
    assert_eq!(
        whole.map.path.places[0].at, sites[0],
        "it snaps to a design"
    );
    window.send(Intent::ExtendPath(vec![DVec2::ZERO]));
    wait_for_film(&mut window);
    window.send(Intent::ExtendPath(vec![DVec2::new(0.1, -0.1), sites[2]]));
    wait_for_film(&mut window);
    assert_eq!(window.problems(), Vec::<String>::new());
    let whole = window.session().whole().expect("a project").clone();
    assert!(whole.follows_path());
    assert_eq!(whole.leg_count(), 2);
    let sequence = window.session().sequence().expect("a film");
    assert_eq!(sequence.end(), 2.0);
    assert_eq!(window.session().names_on_the_way().len(), 3);
    // The puck goes with the film.
    window.send(Intent::Seek(1.0));
    window.update();
    window.update();
    assert!(
        map(&window).puck().length() < 1e-9,
        "{}",
        map(&window).puck()
    );
    window.send(Intent::Seek(2.0));
    window.update();
    window.update();
    assert_eq!(weights(&window), [0.0, 0.0, 1.0]);
    // Not one that two designs could be matched by.
    assert!(!window.session().can_match());
    window.send(Intent::ShortenPath);
    wait_for_film(&mut window);
    assert_eq!(window.session().leg_count(), 1);
    window.send(Intent::Undo);
    wait_for_film(&mut window);
    assert_eq!(window.session().leg_count(), 2);
    // Without it the film goes from design to design again.
    let mut settings = window.session().whole().expect("a project").map.clone();
    settings.path = morphospace::space::MapPath::default();
    window.send(Intent::EditMap(Box::new(settings)));
    wait_for_film(&mut window);
    let first = window.session().transition().expect("a film");
    assert!(first.arap().is_some());
    assert_eq!(window.session().leg_count(), 2);
}

#[test]
fn the_way_of_the_puck_becomes_a_path_and_places_are_kept() {
    let (_folder, mut window) = opened(3, false);
    window.send(Intent::RecordPath);
    window.update();
    for k in 1..=20 {
        window.send(Intent::Puck(DVec2::new(0.02 * f64::from(k), 0.0)));
        window.update();
    }
    window.send(Intent::RecordPath);
    wait_for_film(&mut window);
    let path = window
        .session()
        .whole()
        .expect("a project")
        .map
        .path
        .clone();
    // A straight way needs no places within.
    assert_eq!(path.places.len(), 2, "{path:?}");
    assert!((path.places[1].at.x - 0.4).abs() < 1e-9);
    window.send(Intent::Keep);
    wait_for_film(&mut window);
    let kept = window
        .session()
        .whole()
        .expect("a project")
        .map
        .kept
        .clone();
    assert_eq!(kept.len(), 1);
    assert!(kept[0].name.contains('%'), "{}", kept[0].name);
    let made = map(&window).made().expect("a map");
    assert!(made.kept(kept[0].at).is_some());
    // What is known of the land grows finer by itself.
    let side = made
        .land()
        .found()
        .map(morphospace::measure::MapLandscape::side);
    assert_eq!(side, Some(64));
}

#[test]
fn what_has_no_common_mesh_is_on_the_map_as_fields_and_esc_leaves() {
    let (_folder, mut window) = opened(3, true);
    let made = map(&window).made().expect("a map");
    assert!(made.space().family().is_none() && made.space().notes().len() == 1);
    window.send(Intent::Back);
    window.update();
    assert!(!map(&window).is_shown);
    // With the next project the map is another one.
    window.send(Intent::OpenGallery("girder-to-arch".to_owned()));
    window.wait();
    let window = shown(window);
    let made = map(&window).made().expect("a map");
    assert_eq!(made.space().designs().len(), 2);
}
