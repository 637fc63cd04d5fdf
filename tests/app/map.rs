//! Tests of the map of all designs: building it, moving the marker, layouts, paths and saved
//! blends.

use std::path::PathBuf;

use bevy::input::keyboard::{Key, KeyCode};
use bevy::math::Vec2;
use morphospace::app::testing::{Intent, MapView, StageArea};
use morphospace::geometry::DVec2;
use morphospace::measure::MapMeasure;
use morphospace::settings::Choice;
use morphospace::space::MapLayout;
use tempfile::TempDir;

use crate::headless_window::HeadlessWindow;

fn map_view(window: &HeadlessWindow) -> &MapView {
    window.0.world().resource::<MapView>()
}

/// Updates the window until the map and its pictures are complete.
fn wait_for_map(window: &mut HeadlessWindow) {
    for _ in 0..20_000 {
        window.update();
        let view = map_view(window);
        let is_drawn = view
            .pictures()
            .is_some_and(|made| made.thumbnails().is_some());
        if !view.is_busy() && (is_drawn || view.problem().is_some()) {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("the map is not complete in time");
}

/// Opens the map on a stage of 160 × 120 pixels and waits until it is drawn.
fn with_map(mut window: HeadlessWindow) -> HeadlessWindow {
    let area = StageArea {
        size: Vec2::new(160.0, 120.0),
        ..StageArea::default()
    };
    window.0.insert_resource(area);
    window.send(Intent::ToggleMap);
    wait_for_map(&mut window);
    window
}

/// A window with the map of `count` rectangles of width 1, 2, …; if `has_hole`, the last one has a
/// hole.
fn with_rectangles(count: usize, has_hole: bool) -> (TempDir, HeadlessWindow) {
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
    (folder, with_map_of(files))
}

/// A window that shows the map of these files, with a film that stands still.
fn with_map_of(files: Vec<PathBuf>) -> HeadlessWindow {
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(files));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    // The film plays as soon as it is opened, and the marker would follow it.
    window.send(Intent::TogglePlay);
    window.send(Intent::SeekStart);
    with_map(window)
}

/// Weights of the designs at the marker.
fn weights(window: &HeadlessWindow) -> Vec<f64> {
    map_view(window)
        .pictures()
        .expect("a map")
        .weights()
        .to_vec()
}

#[test]
fn the_marker_sets_the_weights_and_the_blend() {
    let (_folder, mut window) = with_rectangles(3, false);
    let made = map_view(&window).pictures().expect("a map");
    assert!(
        made.space().family().is_some(),
        "{:?}",
        made.space().notes()
    );
    let sites = made.map().sites().to_vec();
    assert_eq!(sites.len(), 3);
    // The marker is at first at the centre of the map, where all designs have the same weight.
    let central = weights(&window);
    assert!(
        central.iter().all(|share| (share - 1.0 / 3.0).abs() < 1e-6),
        "{central:?}"
    );
    let before = map_view(&window)
        .pictures()
        .and_then(|made| made.blend().cloned());
    window.send(Intent::MoveMarker(sites[2]));
    window.update();
    assert_eq!(weights(&window), [0.0, 0.0, 1.0]);
    let after = map_view(&window)
        .pictures()
        .and_then(|made| made.blend().cloned());
    assert!(before.is_some() && before != after);
    // On the map an arrow key moves the marker and leaves t unchanged.
    let (t, marker) = (window.t(), map_view(&window).marker());
    window.press(KeyCode::ArrowLeft, Key::ArrowLeft);
    window.update();
    assert_eq!(window.t(), t);
    assert!(map_view(&window).marker().x < marker.x);
    // Invalid positions are ignored or clamped.
    window.send(Intent::MoveMarker(DVec2::NAN));
    window.send(Intent::MoveMarker(DVec2::splat(1e300)));
    window.update();
    assert!(weights(&window).iter().all(|share| share.is_finite()));
}

#[test]
fn designs_are_laid_out_on_a_line_and_moved_by_hand() {
    let (_folder, mut window) = with_rectangles(3, false);
    window.send(Intent::SetMapLayout(MapLayout::Line));
    wait_for_map(&mut window);
    let sites = |window: &HeadlessWindow| {
        let made = map_view(window).pictures().expect("a map");
        made.map().sites().to_vec()
    };
    assert!(sites(&window).iter().all(|site| site.y == 0.0));
    let new_site = DVec2::new(0.1, 0.8);
    window.send(Intent::MoveMapDesign(1, new_site));
    wait_for_map(&mut window);
    assert_eq!(sites(&window)[1], new_site);
    // The window does not move a design onto the position of another design. It also ignores a move
    // of design 99, which does not exist.
    let first_site = sites(&window)[0];
    window.send(Intent::MoveMapDesign(1, first_site));
    window.send(Intent::MoveMapDesign(99, new_site));
    wait_for_map(&mut window);
    assert_eq!(sites(&window)[1], new_site);
    // Moved sites are stored in the project, and a move can be undone.
    let stored_sites = |window: &HeadlessWindow| {
        window
            .session()
            .whole_project()
            .expect("a project")
            .map
            .sites
            .clone()
    };
    assert_eq!(stored_sites(&window)[1], new_site);
    window.send(Intent::Undo);
    wait_for_map(&mut window);
    assert!(stored_sites(&window).is_empty());
}

/// Updates the window until the film and the map are complete.
fn wait_for_film(window: &mut HeadlessWindow) {
    window.wait();
    wait_for_map(window);
}

#[test]
fn a_path_is_drawn_and_played() {
    let (_folder, mut window) = with_rectangles(3, false);
    let sites = map_view(&window)
        .pictures()
        .expect("a map")
        .map()
        .sites()
        .to_vec();
    // One stop is not a path yet.
    window.send(Intent::ExtendPath(vec![sites[0] + DVec2::splat(0.01)]));
    wait_for_film(&mut window);
    let whole = window.session().whole_project().expect("a project").clone();
    assert!(!whole.follows_path());
    assert_eq!(
        whole.map.path.places[0].at, sites[0],
        "a stop near a design snaps to it"
    );
    window.send(Intent::ExtendPath(vec![DVec2::ZERO]));
    wait_for_film(&mut window);
    window.send(Intent::ExtendPath(vec![DVec2::new(0.1, -0.1), sites[2]]));
    wait_for_film(&mut window);
    assert_eq!(window.problems(), Vec::<String>::new());
    let whole = window.session().whole_project().expect("a project").clone();
    assert!(whole.follows_path());
    assert_eq!(whole.segment_count(), 2);
    let sequence = window.session().sequence().expect("a film");
    assert_eq!(sequence.end(), 2.0);
    assert_eq!(window.session().names_along_path().len(), 3);
    // During the film the marker follows the path.
    window.send(Intent::Seek(1.0));
    window.update();
    window.update();
    assert!(
        map_view(&window).marker().length() < 1e-9,
        "{}",
        map_view(&window).marker()
    );
    window.send(Intent::Seek(2.0));
    window.update();
    window.update();
    assert_eq!(weights(&window), [0.0, 0.0, 1.0]);
}

#[test]
fn removing_the_path_restores_the_film_from_design_to_design() {
    let (_folder, mut window) = with_rectangles(3, false);
    let sites = map_view(&window)
        .pictures()
        .expect("a map")
        .map()
        .sites()
        .to_vec();
    for points in [
        vec![sites[0]],
        vec![DVec2::ZERO],
        vec![DVec2::new(0.1, -0.1), sites[2]],
    ] {
        window.send(Intent::ExtendPath(points));
        wait_for_film(&mut window);
    }
    // A film along a path blends all designs, so there is no match of two designs to edit.
    assert!(!window.session().has_match_editor());
    window.send(Intent::RemoveLastPathStop);
    wait_for_film(&mut window);
    assert_eq!(window.session().segment_count(), 1);
    window.send(Intent::Undo);
    wait_for_film(&mut window);
    assert_eq!(window.session().segment_count(), 2);
    // Without a path the film goes from design to design again.
    let mut settings = window
        .session()
        .whole_project()
        .expect("a project")
        .map
        .clone();
    settings.path = morphospace::space::MapPath::default();
    window.send(Intent::EditMap(Box::new(settings)));
    wait_for_film(&mut window);
    let first = window.session().transition().expect("a film");
    assert!(first.arap().is_some());
    assert_eq!(window.session().segment_count(), 2);
}

#[test]
fn marker_movement_is_recorded_as_a_path_and_places_are_saved() {
    let (_folder, mut window) = with_rectangles(3, false);
    window.send(Intent::TogglePathRecording);
    window.update();
    for k in 1..=20 {
        window.send(Intent::MoveMarker(DVec2::new(0.02 * f64::from(k), 0.0)));
        window.update();
    }
    window.send(Intent::TogglePathRecording);
    wait_for_film(&mut window);
    let path = window
        .session()
        .whole_project()
        .expect("a project")
        .map
        .path
        .clone();
    // The recorded movement is straight, so the path has no places between its ends.
    assert_eq!(path.places.len(), 2, "{path:?}");
    assert!((path.places[1].at.x - 0.4).abs() < 1e-9);
    window.send(Intent::SaveBlend);
    wait_for_film(&mut window);
    let saved = window
        .session()
        .whole_project()
        .expect("a project")
        .map
        .kept
        .clone();
    assert_eq!(saved.len(), 1);
    assert!(saved[0].name.contains('%'), "{}", saved[0].name);
    let made = map_view(&window).pictures().expect("a map");
    assert!(made.saved_blend(saved[0].at).is_some());
    // The blends on the map are measured on a grid that is refined in the background, up to 64 × 64
    // points.
    let grid_side = made
        .contours()
        .landscape()
        .map(morphospace::measure::MapLandscape::side);
    assert_eq!(grid_side, Some(64));
}

#[test]
fn designs_without_a_common_mesh_are_blended_as_fields_and_escape_closes_the_map() {
    let (_folder, mut window) = with_rectangles(3, true);
    let made = map_view(&window).pictures().expect("a map");
    assert!(made.space().family().is_none() && made.space().notes().len() == 1);
    window.send(Intent::Escape);
    window.update();
    assert!(!map_view(&window).is_shown);
    // Opening another project replaces the map.
    window.send(Intent::OpenGallery("girder-to-arch".to_owned()));
    window.wait();
    let window = with_map(window);
    let made = map_view(&window).pictures().expect("a map");
    assert_eq!(made.space().designs().len(), 2);
}

#[test]
fn escape_ends_drawing_before_it_closes_the_map() {
    let (_folder, mut window) = with_rectangles(3, false);
    let escape = |window: &mut HeadlessWindow| window.press(KeyCode::Escape, Key::Escape);
    window.type_char(KeyCode::KeyE, "e");
    assert!(map_view(&window).is_drawing_path);
    escape(&mut window);
    assert!(map_view(&window).is_shown && !map_view(&window).is_drawing_path);
    // Recording a path ends in the same way, and leaves no path.
    window.type_char(KeyCode::KeyW, "w");
    assert!(map_view(&window).is_recording());
    window.press(KeyCode::ArrowRight, Key::ArrowRight);
    escape(&mut window);
    assert!(map_view(&window).is_shown && !map_view(&window).is_recording());
    let path = window
        .session()
        .whole_project()
        .map(|whole| whole.map.path.clone());
    assert!(path.is_some_and(|path| path.places.is_empty()));
    // Before the map is hidden, Esc cancels work in the background.
    for _ in 0..4 {
        if map_view(&window).is_shown {
            escape(&mut window);
        }
    }
    assert!(!map_view(&window).is_shown);
}

#[test]
fn a_hidden_map_does_no_work() {
    let (_folder, window) = with_rectangles(3, false);
    let mut window = with_map(window);
    window.send(Intent::ShowMapMeasure(Some(MapMeasure::CHOICES[0])));
    window.send(Intent::ToggleMap);
    for _ in 0..2000 {
        std::thread::sleep(std::time::Duration::from_millis(1));
        window.update();
    }
    assert!(!map_view(&window).is_busy());
}

#[test]
fn the_map_keeps_the_colours_of_the_drawings() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, colour: &str, width: u32| {
        let path = folder.path().join(name);
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>\
             <rect width='{width}' height='100' fill='{colour}'/></svg>"
        );
        std::fs::write(&path, svg).expect("a file");
        path
    };
    let files = [("a.svg", "#c00000", 40), ("b.svg", "#00c000", 90)];
    let files = files.map(|(name, colour, width)| file(name, colour, width));
    let mut window = with_map_of(files.into());
    let shows = |window: &mut HeadlessWindow, design: usize, colour: [u8; 4]| {
        let site = map_view(window).pictures().expect("a map").map().sites()[design];
        window.send(Intent::MoveMarker(site));
        window.update();
        let pictures = map_view(window).pictures().expect("a map");
        let blend = pictures.blend().expect("a blend");
        blend.pixels().any(|pixel| pixel.0 == colour)
    };
    let [red, green] = [[0xc0, 0, 0, 255], [0, 0xc0, 0, 255]];
    assert!(shows(&mut window, 0, red) && !shows(&mut window, 0, green));
    assert!(shows(&mut window, 1, green) && !shows(&mut window, 1, red));
    let designs = map_view(&window)
        .pictures()
        .and_then(|pictures| pictures.thumbnails());
    let designs = &designs.expect("thumbnails").designs;
    assert!(designs.pixels().any(|pixel| pixel.0 == red));
}
