//! Tests of presentation mode: it shows only the drawing, starts at the first stop and reacts to
//! few keys. Also tests of presentations started from the command line.

use bevy::input::keyboard::{Key, KeyCode};
use morphospace::app::testing::{Intent, Presentation, UnsavedAnswer, UnsavedQuestion};
use morphospace::transition::TransitionStop;

use crate::headless_window::HeadlessWindow;

/// A window whose project has a stop named "here" at t = 0.25, and one without a name at t = 0.75.
fn with_stops() -> HeadlessWindow {
    let mut window = HeadlessWindow::with_gallery();
    let mut project = window.session().project().expect("a project").clone();
    project.stops = [0.25, 0.75].map(TransitionStop::at).into();
    project.stops[0].name = "here".to_owned();
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window
}

fn presentation(window: &HeadlessWindow) -> &Presentation {
    window.0.world().resource()
}

/// Starts a presentation with the key F5.
fn start_presentation(window: &mut HeadlessWindow) {
    window.press(KeyCode::F5, Key::F5);
    window.update();
}

#[test]
fn a_presentation_starts_at_the_first_stop_and_advances_by_stops() {
    let mut window = with_stops();
    window.send(Intent::Seek(0.6));
    start_presentation(&mut window);
    assert!(presentation(&window).is_active());
    assert_eq!(window.t(), 0.25);
    assert!(!window.preferences().panels);
    window.press(KeyCode::PageDown, Key::PageDown);
    while window.playback().is_playing() {
        window.update();
    }
    assert_eq!(window.t(), 0.75);
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!presentation(&window).is_active() && window.preferences().panels);
}

#[test]
fn editing_keys_do_nothing_during_a_presentation() {
    let mut window = with_stops();
    start_presentation(&mut window);
    let before = window.session().project().cloned();
    let keys = [
        (KeyCode::KeyE, "e"),
        (KeyCode::KeyM, "m"),
        (KeyCode::KeyL, "l"),
        (KeyCode::KeyV, "v"),
        (KeyCode::KeyH, "h"),
        (KeyCode::KeyP, "p"),
    ];
    for (code, letter) in keys {
        window.type_char(code, letter);
    }
    window.press(KeyCode::F1, Key::F1);
    window.press(KeyCode::Tab, Key::Tab);
    assert_eq!(window.session().project().cloned(), before);
    assert!(!window.editor().is_open);
    let preferences = window.preferences();
    assert!(!(preferences.panels || preferences.help || preferences.plots));
}

#[test]
fn keys_toggle_the_black_screen_and_the_captions() {
    let mut window = with_stops();
    window.type_char(KeyCode::KeyB, "b");
    assert!(
        !presentation(&window).is_black(),
        "only during a presentation"
    );
    start_presentation(&mut window);
    window.type_char(KeyCode::KeyB, "b");
    assert!(presentation(&window).is_black());
    window.type_char(KeyCode::Period, ".");
    assert!(!presentation(&window).is_black());
    let caption = |window: &HeadlessWindow| {
        let captions = presentation(window).captions(window.session());
        captions.and_then(|captions| captions.at(window.t()).map(|(name, _)| name.to_owned()))
    };
    assert_eq!(caption(&window), Some("here".to_owned()));
    window.type_char(KeyCode::KeyT, "t");
    assert_eq!(caption(&window), None);
    window.type_char(KeyCode::KeyT, "t");
    assert_eq!(caption(&window), Some("here".to_owned()));
}

/// A new window that opens the files or the project of the intent `open` and presents them, as
/// `--present` on the command line does.
fn with_presentation_of(open: Intent) -> HeadlessWindow {
    let mut window = HeadlessWindow::new();
    window.0.world_mut().write_message(open);
    window.send(Intent::Present { is_all: true });
    window
}

#[test]
fn closing_ends_the_presentation_and_asks_about_unsaved_changes() {
    let mut window = with_stops();
    start_presentation(&mut window);
    window.send(Intent::Close);
    assert!(!presentation(&window).is_active() && window.preferences().panels);
    let question = window.0.world().resource::<UnsavedQuestion>();
    assert!(question.text().is_some() && window.0.should_exit().is_none());
}

#[test]
fn ending_a_presentation_from_the_command_line_closes_the_window() {
    let name = crate::headless_window::gallery_names().remove(0);
    let mut window = with_presentation_of(Intent::OpenGallery(name));
    assert!(
        !window.preferences().panels,
        "the panels are hidden before the drawing is loaded"
    );
    window.wait();
    assert_eq!(window.t(), window.session().timing().from);
    window.send(Intent::Escape);
    assert!(window.0.should_exit().is_some());
}

#[test]
fn a_presentation_of_a_missing_file_ends_with_the_reason() {
    let mut window = with_presentation_of(Intent::Open(vec!["missing.morph".into()]));
    window.wait();
    for _ in 0..3 {
        window.update();
    }
    assert!(!presentation(&window).is_active() && window.preferences().panels);
    assert_eq!(window.problems().len(), 1);
    assert!(window.0.should_exit().is_none());
}

#[test]
fn a_talk_that_closes_the_window_restores_the_panels_if_closing_is_cancelled() {
    let mut window = HeadlessWindow::with_gallery();
    window.send(Intent::CyclePlayMode);
    assert!(window.session().is_dirty());
    for end in [Intent::Escape, Intent::Close] {
        window.send(Intent::Present { is_all: true });
        assert!(!window.preferences().panels);
        window.send(end);
        window.update();
        window.send(Intent::AnswerUnsaved(UnsavedAnswer::Cancel));
        (0..3).for_each(|_| window.update());
        assert!(window.preferences().panels);
        let question = window.0.world().resource::<UnsavedQuestion>();
        assert_eq!(question.text(), None, "it asks once");
        assert!(window.0.should_exit().is_none());
    }
}
