//! Tests of undo and redo of changes to the project. Also tests of the reuse of distance fields
//! when a setting that does not affect them changes.

use crate::headless_window::{HeadlessWindow, gallery_names};
use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::{ButtonInput, MouseButton};
use morphospace::app::testing::Intent;
use morphospace::content::{Content, ContentKind};

#[test]
fn a_changed_blend_threshold_reuses_the_distance_fields() {
    let mut window = HeadlessWindow::with_gallery();
    while window.session().project().and_then(|p| p.content) != Some(ContentKind::Field) {
        window.send(Intent::NextMethod);
        window.wait();
    }
    let source_field =
        |window: &HeadlessWindow| match window.session().transition().map(|t| t.content()) {
            Some(Content::Field(pair)) => std::ptr::from_ref(pair.first_pair().source()),
            _ => panic!("a field is on the stage"),
        };
    let before = source_field(&window);
    let mut project = window.session().project().cloned().expect("a project");
    project.options.field.blend.threshold = 2.0;
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window.wait();
    assert_eq!(source_field(&window), before);
    let Some(Content::Field(pair)) = window.session().transition().map(|t| t.content()) else {
        panic!("a field is on the stage");
    };
    assert_eq!(pair.first_pair().blend().threshold, 2.0);
}

#[test]
fn every_change_can_be_undone_and_redone() {
    let mut window = HeadlessWindow::with_gallery();
    let before = window.session().project().cloned();
    window.type_char(KeyCode::KeyL, "l");
    window.send(Intent::Seek(0.437));
    window.type_char(KeyCode::KeyM, "m");
    let after = window.session().project().cloned();
    assert_ne!(before, after);
    let press_with_control = |window: &mut HeadlessWindow, code: KeyCode, key: &str| {
        window.hold(KeyCode::ControlLeft, Key::Control, |window| {
            window.type_char(code, key);
        });
        window.update();
    };
    press_with_control(&mut window, KeyCode::KeyZ, "z");
    assert_ne!(
        window.session().project().cloned(),
        before,
        "each undo reverts one change"
    );
    press_with_control(&mut window, KeyCode::KeyZ, "z");
    assert_eq!(window.session().project().cloned(), before);
    assert!(!window.session().is_dirty());
    press_with_control(&mut window, KeyCode::KeyY, "y");
    window.hold(KeyCode::ShiftLeft, Key::Shift, |window| {
        press_with_control(window, KeyCode::KeyZ, "Z");
    });
    assert_eq!(window.session().project().cloned(), after);
    assert!(!window.session().can_redo());
}

#[test]
fn a_drag_is_one_undo_step() {
    let mut window = HeadlessWindow::with_gallery();
    let before = window.session().project().cloned().expect("a project");
    let set_left_button = |window: &mut HeadlessWindow, is_down: bool| {
        let mut buttons = window
            .0
            .world_mut()
            .resource_mut::<ButtonInput<MouseButton>>();
        if is_down {
            buttons.press(MouseButton::Left);
        } else {
            buttons.release(MouseButton::Left);
        }
    };
    set_left_button(&mut window, true);
    let mut project = before.clone();
    for width in [0.02, 0.03, 0.04] {
        project.options.bar_width = width;
        window.send(Intent::ReplaceSettings(Box::new(project.clone())));
    }
    set_left_button(&mut window, false);
    project.options.bar_width = 0.05;
    window.send(Intent::ReplaceSettings(Box::new(project.clone())));
    window.send(Intent::Undo);
    assert_eq!(window.session().project(), Some(&before));
    window.send(Intent::Redo);
    assert_eq!(window.session().project(), Some(&project));
    window.wait();
}

#[test]
fn undoing_a_method_change_rebuilds_the_stage() {
    let mut window = HeadlessWindow::with_gallery();
    let method = |window: &HeadlessWindow| window.session().transition().map(|t| t.method());
    let first = method(&window);
    window.send(Intent::NextMethod);
    window.wait();
    assert_ne!(method(&window), first);
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(method(&window), first);
}

#[test]
fn opening_clears_the_undo_history_and_saving_does_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = HeadlessWindow::with_gallery();
    window.send(Intent::CyclePlayMode);
    window.send(Intent::SaveTo(folder.path().join("one.morph")));
    assert!(window.session().can_undo());
    std::fs::create_dir(folder.path().join("in")).expect("a folder");
    window.send(Intent::SaveTo(folder.path().join("in").join("two.morph")));
    window.send(Intent::Undo);
    assert!(window.session().is_dirty());
    window.send(Intent::SaveTo(folder.path().join("in").join("three.morph")));
    let mut reopened = HeadlessWindow::new();
    reopened.send(Intent::Open(vec![
        folder.path().join("in").join("three.morph"),
    ]));
    reopened.wait();
    assert_eq!(reopened.problems(), Vec::<String>::new());
    assert!(
        reopened.session().transition().is_some(),
        "paths in the project are adapted to its folder"
    );
    window.send(Intent::OpenGallery(gallery_names().remove(0)));
    window.wait();
    assert!(!window.session().can_undo());
}

#[test]
fn undo_brings_back_the_film_that_was_there_at_once() {
    let mut window = HeadlessWindow::with_gallery();
    let before = window.session().transition().cloned().expect("a film");
    let mut project = window.session().project().cloned().expect("a project");
    project.options.arap.symmetric = !project.options.arap.symmetric;
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window.wait();
    let changed = window.session().transition().cloned().expect("a film");
    assert!(!changed.is_same(&before));
    let shown = |window: &HeadlessWindow| window.session().transition().cloned().expect("a film");
    window.send(Intent::Undo);
    assert!(shown(&window).is_same(&before), "without a new build");
    assert!(window.session().work().is_none());
    window.send(Intent::Redo);
    assert!(shown(&window).is_same(&changed));
    assert!(window.session().work().is_none());
}

#[test]
fn undo_during_a_build_ends_it() {
    let mut window = HeadlessWindow::with_gallery();
    let before = window.session().transition().cloned().expect("a film");
    window.send(Intent::NextMethod);
    window.wait();
    let mut project = window.session().project().cloned().expect("a project");
    project.options.bar_width *= 1.5;
    window.send(Intent::Undo);
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window.send(Intent::Undo);
    assert!(
        window.session().work().is_none(),
        "nothing is left to build"
    );
    let shown = window.session().transition().expect("a film");
    assert!(shown.is_same(&before));
}
