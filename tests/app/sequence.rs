//! Many designs in the window: opened together, walked through, put in another order.

use std::path::PathBuf;

use bevy::prelude::With;
use morphospace::app::{Intent, OnStage};
use morphospace::project::LoadedProject;
use morphospace::stage::{Blend, StageTransition};
use tempfile::TempDir;

use crate::window::Window;

/// A rectangle as wide as its number, of each number.
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

fn opened(count: usize) -> (TempDir, Window) {
    let (folder, files) = designs(count);
    let mut window = Window::new();
    window.send(Intent::Open(files));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    (folder, window)
}

/// The names of the two designs on the stage, and where between them.
fn on_stage(window: &mut Window) -> (String, f64) {
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
fn the_stage_shows_the_leg_that_t_is_in() {
    let (_folder, mut window) = opened(4);
    assert_eq!(window.session().title(), "d0 to d3, 4 designs");
    for (t, names, within) in [
        (0.25, "d0 d1", 0.25),
        (1.0, "d1 d2", 0.0),
        (2.75, "d2 d3", 0.75),
        (3.5, "d2 d3", 1.5),
        (-0.5, "d0 d1", -0.5),
    ] {
        window.send(Intent::Seek(t));
        assert_eq!(on_stage(&mut window), (names.to_owned(), within));
    }
    assert_eq!(window.session().sequence().map(|all| all.end()), Some(3.0));
}

#[test]
fn a_pass_goes_through_all_and_slides_stop_at_each() {
    let (_folder, mut window) = opened(3);
    let mut places = Vec::new();
    for _ in 0..2 {
        window.send(Intent::PlayToNextStop);
        while window.playback().is_playing() {
            window.update();
        }
        places.push(window.t());
    }
    assert_eq!(places, [1.0, 2.0]);
}

#[test]
fn a_talk_begins_with_the_first_design() {
    let (_folder, mut window) = opened(3);
    window.send(Intent::Seek(1.5));
    window.send(Intent::Present { is_all: false });
    window.update();
    assert_eq!(window.t(), 0.0);
}

#[test]
fn what_is_said_of_two_designs_stays_with_them() {
    let (_folder, mut window) = opened(4);
    window.send(Intent::Seek(2.5));
    let mut pair = window.session().project().expect("a leg").clone();
    assert_eq!(pair.designs.len(), 2);
    pair.options.matching.keep_up = true;
    window.send(Intent::Edit(Box::new(pair)));
    window.wait();
    let ups = |window: &Window| -> Vec<bool> {
        let whole = window.session().whole().expect("a project");
        let up = |leg: usize| whole.leg(leg).options.matching.keep_up;
        (0..whole.leg_count()).map(up).collect()
    };
    assert_eq!(ups(&window), [false, false, true]);
    // The first design comes last: the legs that stay keep theirs.
    let mut order = window.session().whole().expect("a project").in_order();
    order.rotate_left(1);
    window.send(Intent::Arrange(order));
    window.wait();
    assert_eq!(ups(&window), [false, true, false]);
    window.send(Intent::Seek(1.5));
    assert_eq!(on_stage(&mut window).0, "d2 d3");
    window.send(Intent::Seek(2.5));
    assert_eq!(on_stage(&mut window).0, "d3 d0");
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(ups(&window), [false, false, true]);
    assert_eq!(on_stage(&mut window).0, "d2 d3");
}

#[test]
fn designs_come_and_go_and_t_with_them() {
    let (folder, mut window) = opened(3);
    window.send(Intent::Seek(2.0));
    let mut order = window.session().whole().expect("a project").in_order();
    order.remove(1);
    window.send(Intent::Arrange(order));
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
    assert_eq!(window.session().leg_count(), 2);
    window.send(Intent::LeadBack(true));
    window.wait();
    window.send(Intent::Seek(2.5));
    assert_eq!(on_stage(&mut window).0, "d2 d0");
    assert_eq!(window.problems(), Vec::<String>::new());
}

#[test]
fn it_is_saved_and_opened_again() {
    let (folder, mut window) = opened(3);
    let path = folder.path().join("all.morph");
    window.send(Intent::SaveTo(path.clone()));
    assert!(!window.session().is_dirty());
    let text = std::fs::read_to_string(&path).expect("a file");
    assert!(text.contains("version = 2"), "{text}");
    let again = LoadedProject::open(&path).expect("a project");
    assert_eq!(again.legs().len(), 2);
    let mut other = Window::new();
    other.send(Intent::Open(vec![path]));
    other.wait();
    assert_eq!(other.session().sequence().map(|all| all.end()), Some(2.0));
}

#[test]
fn a_leg_that_cannot_be_had_is_told_and_the_others_play() {
    let (folder, mut window) = opened(3);
    let bad = folder.path().join("gone.json");
    window.send(Intent::ReplaceDesign(2, bad));
    window.wait();
    assert!(window.problems()[0].contains("gone.json"));
    window.send(Intent::Seek(1.5));
    assert_eq!(on_stage(&mut window).0, "d1 d2");
}
