//! Tests of films through several designs: opening, playing, reordering and saving them.

use std::path::PathBuf;

use bevy::prelude::With;
use morphospace::app::testing::{Intent, OnStage};
use morphospace::project::LoadedProject;
use morphospace::stage::{Blend, StageTransition};
use tempfile::TempDir;

use crate::headless_window::HeadlessWindow;

/// Writes files d0.json, d1.json, … with rectangles of width 1, 2, …; returns their folder and
/// paths.
fn designs(count: usize) -> (TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |k: usize| {
        let path = folder.path().join(format!("d{k}.json"));
        let ring = format!("[[0,0],[{0},0],[{0},3],[0,3]]", k + 1);
        std::fs::write(&path, ring).expect("a file");
        path
    };
    let files = (0..count).map(file).collect();
    (folder, files)
}

/// A window with a paused film through `count` rectangles, and the folder of their files.
fn with_designs(count: usize) -> (TempDir, HeadlessWindow) {
    let (folder, files) = designs(count);
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(files));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    pause_at_start(&mut window);
    (folder, window)
}

/// Pauses the film, which plays as soon as its designs are opened, and returns to its start.
fn pause_at_start(window: &mut HeadlessWindow) {
    assert!(window.playback().is_playing());
    window.send(Intent::TogglePlay);
    window.send(Intent::SeekStart);
}

/// Names of the two designs that the stage blends at the moment, and the blend parameter between
/// them: 0 at the first, 1 at the second.
fn on_stage(window: &mut HeadlessWindow) -> (String, f64) {
    let world = window.0.world_mut();
    let mut staged = world.query_filtered::<(&StageTransition, &Blend), With<OnStage>>();
    let (StageTransition(transition), blend) = staged.single(world).expect("one on the stage");
    let names = transition
        .designs()
        .each_ref()
        .map(|design| design.name.as_str());
    (names.join(" "), blend.t)
}

#[test]
fn the_stage_shows_the_segment_that_contains_t() {
    let (_folder, mut window) = with_designs(4);
    assert_eq!(window.session().title(), "d0 to d3, 4 designs");
    for (t, names, t_in_segment) in [
        (0.25, "d0 d1", 0.25),
        (1.0, "d1 d2", 0.0),
        (2.75, "d2 d3", 0.75),
        (3.5, "d2 d3", 1.5),
        (-0.5, "d0 d1", -0.5),
    ] {
        window.send(Intent::Seek(t));
        assert_eq!(on_stage(&mut window), (names.to_owned(), t_in_segment));
    }
    assert_eq!(window.session().sequence().map(|all| all.end()), Some(3.0));
}

#[test]
fn playing_to_the_next_stop_stops_at_each_design() {
    let (_folder, mut window) = with_designs(3);
    let mut stop_times = Vec::new();
    for _ in 0..2 {
        window.send(Intent::PlayToNextStop);
        while window.playback().is_playing() {
            window.update();
        }
        stop_times.push(window.t());
    }
    assert_eq!(stop_times, [1.0, 2.0]);
}

#[test]
fn a_presentation_starts_with_the_first_design() {
    let (_folder, mut window) = with_designs(3);
    window.send(Intent::Seek(1.5));
    window.send(Intent::Present { is_all: false });
    window.update();
    assert_eq!(window.t(), 0.0);
}

#[test]
fn settings_of_a_segment_stay_with_its_two_designs() {
    let (_folder, mut window) = with_designs(4);
    window.send(Intent::Seek(2.5));
    let mut pair = window.session().project().expect("a segment").clone();
    assert_eq!(pair.designs.len(), 2);
    pair.options.matching.keep_up = true;
    window.send(Intent::ReplaceSettings(Box::new(pair)));
    window.wait();
    let keeps_upright = |window: &HeadlessWindow| -> Vec<bool> {
        let whole = window.session().whole_project().expect("a project");
        let of_segment = |segment: usize| whole.segment(segment).options.matching.keep_up;
        (0..whole.segment_count()).map(of_segment).collect()
    };
    assert_eq!(keeps_upright(&window), [false, false, true]);
    // Move the first design to the end. Two designs that still follow each other keep the settings
    // of the segment between them.
    let mut order = window
        .session()
        .whole_project()
        .expect("a project")
        .designs_with_indices();
    order.rotate_left(1);
    window.send(Intent::ReorderDesigns(order));
    window.wait();
    assert_eq!(keeps_upright(&window), [false, true, false]);
    window.send(Intent::Seek(1.5));
    assert_eq!(on_stage(&mut window).0, "d2 d3");
    window.send(Intent::Seek(2.5));
    assert_eq!(on_stage(&mut window).0, "d3 d0");
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(keeps_upright(&window), [false, false, true]);
    assert_eq!(on_stage(&mut window).0, "d2 d3");
}

#[test]
fn t_follows_its_design_when_designs_are_removed_or_inserted() {
    let (folder, mut window) = with_designs(3);
    window.send(Intent::Seek(2.0));
    let mut order = window
        .session()
        .whole_project()
        .expect("a project")
        .designs_with_indices();
    order.remove(1);
    window.send(Intent::ReorderDesigns(order));
    window.wait();
    assert_eq!(
        (window.t(), on_stage(&mut window)),
        (1.0, ("d0 d2".to_owned(), 1.0))
    );
    window.send(Intent::InsertDesigns(
        1,
        vec![folder.path().join("d1.json")],
    ));
    window.wait();
    assert_eq!(window.session().segment_count(), 2);
    window.send(Intent::CloseLoop(true));
    window.wait();
    window.send(Intent::Seek(2.5));
    assert_eq!(on_stage(&mut window).0, "d2 d0");
    assert_eq!(window.problems(), Vec::<String>::new());
}

#[test]
fn a_film_of_several_designs_is_saved_and_opened_again() {
    let (folder, mut window) = with_designs(3);
    let path = folder.path().join("all.morph");
    window.send(Intent::SaveTo(path.clone()));
    assert!(!window.session().is_dirty());
    let text = std::fs::read_to_string(&path).expect("a file");
    assert!(text.contains("version = 2"), "{text}");
    let saved = LoadedProject::open(&path).expect("a project");
    assert_eq!(saved.segments().len(), 2);
    let mut other = HeadlessWindow::new();
    other.send(Intent::Open(vec![path]));
    other.wait();
    assert_eq!(other.session().sequence().map(|all| all.end()), Some(2.0));
}

#[test]
fn a_segment_that_cannot_be_built_is_reported_and_the_others_play() {
    let (folder, mut window) = with_designs(3);
    let bad = folder.path().join("gone.json");
    window.send(Intent::ReplaceDesign(2, bad));
    window.wait();
    assert!(window.problems()[0].contains("gone.json"));
    window.send(Intent::Seek(1.5));
    assert_eq!(on_stage(&mut window).0, "d1 d2");
}
