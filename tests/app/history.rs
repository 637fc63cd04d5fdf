//! Every change can be taken back.

use crate::window::{Window, entries};
use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::{ButtonInput, MouseButton};
use morphospace::app::Intent;
use morphospace::content::{Content, ContentKind};

#[test]
fn a_changed_blend_is_shown_without_measuring_again() {
    let mut window = Window::with_gallery();
    while window.session().project().and_then(|p| p.content) != Some(ContentKind::Field) {
        window.send(Intent::NextMethod);
        window.wait();
    }
    let source = |window: &Window| match window.session().transition().map(|t| t.content()) {
        Some(Content::Field(pair)) => std::ptr::from_ref(pair.first().source()),
        _ => panic!("a field is on the stage"),
    };
    let before = source(&window);
    let mut project = window.session().project().cloned().expect("a project");
    project.options.field.blend.threshold = 2.0;
    window.send(Intent::Edit(Box::new(project)));
    window.wait();
    assert_eq!(source(&window), before);
    let Some(Content::Field(pair)) = window.session().transition().map(|t| t.content()) else {
        panic!("a field is on the stage");
    };
    assert_eq!(pair.first().blend().threshold, 2.0);
}

#[test]
fn every_change_can_be_taken_back_and_made_again() {
    let mut window = Window::with_gallery();
    let before = window.session().project().cloned();
    window.type_char(KeyCode::KeyL, "l");
    window.send(Intent::Seek(0.437));
    window.type_char(KeyCode::KeyM, "m");
    let after = window.session().project().cloned();
    assert_ne!(before, after);
    let control = |window: &mut Window, code: KeyCode, key: &str| {
        window.hold(KeyCode::ControlLeft, Key::Control, |window| {
            window.type_char(code, key);
        });
        window.update();
    };
    control(&mut window, KeyCode::KeyZ, "z");
    assert_ne!(window.session().project().cloned(), before, "one at a time");
    control(&mut window, KeyCode::KeyZ, "z");
    assert_eq!(window.session().project().cloned(), before);
    assert!(!window.session().is_dirty());
    control(&mut window, KeyCode::KeyY, "y");
    window.hold(KeyCode::ShiftLeft, Key::Shift, |window| {
        control(window, KeyCode::KeyZ, "Z");
    });
    assert_eq!(window.session().project().cloned(), after);
    assert!(!window.session().can_redo());
}

#[test]
fn a_drag_is_one_step() {
    let mut window = Window::with_gallery();
    let before = window.session().project().cloned().expect("a project");
    let buttons = |window: &mut Window, down: bool| {
        let mut buttons = window
            .0
            .world_mut()
            .resource_mut::<ButtonInput<MouseButton>>();
        if down {
            buttons.press(MouseButton::Left);
        } else {
            buttons.release(MouseButton::Left);
        }
    };
    buttons(&mut window, true);
    let mut project = before.clone();
    for width in [0.02, 0.03, 0.04] {
        project.options.bar_width = width;
        window.send(Intent::Edit(Box::new(project.clone())));
    }
    buttons(&mut window, false);
    project.options.bar_width = 0.05;
    window.send(Intent::Edit(Box::new(project.clone())));
    window.send(Intent::Undo);
    assert_eq!(window.session().project(), Some(&before));
    window.send(Intent::Redo);
    assert_eq!(window.session().project(), Some(&project));
    window.wait();
}

#[test]
fn a_change_that_is_taken_back_is_on_the_stage_too() {
    let mut window = Window::with_gallery();
    let cell = |window: &Window| window.session().transition().map(|t| t.cell());
    let first = cell(&window);
    window.send(Intent::NextMethod);
    window.wait();
    assert_ne!(cell(&window), first);
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(cell(&window), first);
}

#[test]
fn opening_forgets_what_could_be_taken_back_and_saving_does_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = Window::with_gallery();
    window.send(Intent::CyclePlayMode);
    window.send(Intent::SaveTo(folder.path().join("one.morph")));
    assert!(window.session().can_undo());
    std::fs::create_dir(folder.path().join("in")).expect("a folder");
    window.send(Intent::SaveTo(folder.path().join("in").join("two.morph")));
    window.send(Intent::Undo);
    assert!(window.session().is_dirty());
    window.send(Intent::SaveTo(folder.path().join("in").join("three.morph")));
    let mut again = Window::new();
    again.send(Intent::Open(vec![
        folder.path().join("in").join("three.morph"),
    ]));
    again.wait();
    assert_eq!(again.problems(), Vec::<String>::new());
    assert!(again.session().transition().is_some(), "paths follow");
    window.send(Intent::OpenGallery(entries().remove(0)));
    window.wait();
    assert!(!window.session().can_undo());
}
