//! A talk: nothing but the drawing, from the first stop, by the keys of a talk alone.

use bevy::input::keyboard::{Key, KeyCode};
use morphospace::app::{Intent, Presentation, UnsavedQuestion};
use morphospace::transition::TransitionStop;

use crate::window::Window;

fn with_stops() -> Window {
    let mut window = Window::with_gallery();
    let mut project = window.session().project().expect("a project").clone();
    project.stops = [0.25, 0.75].map(TransitionStop::at).into();
    project.stops[0].name = "here".to_owned();
    window.send(Intent::Edit(Box::new(project)));
    window
}

fn talk(window: &Window) -> &Presentation {
    window.0.world().resource()
}

fn present(window: &mut Window) {
    window.press(KeyCode::F5, Key::F5);
    window.update();
}

#[test]
fn it_begins_at_the_first_stop_and_goes_on_by_stops() {
    let mut window = with_stops();
    window.send(Intent::Seek(0.6));
    present(&mut window);
    assert!(talk(&window).is_on());
    assert_eq!(window.t(), 0.25);
    assert!(!window.preferences().panels);
    window.press(KeyCode::PageDown, Key::PageDown);
    while window.playback().is_playing() {
        window.update();
    }
    assert_eq!(window.t(), 0.75);
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!talk(&window).is_on() && window.preferences().panels);
}

#[test]
fn nothing_comes_before_an_audience_but_the_drawing() {
    let mut window = with_stops();
    present(&mut window);
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
fn black_and_captions_come_and_go_by_their_keys() {
    let mut window = with_stops();
    window.type_char(KeyCode::KeyB, "b");
    assert!(!talk(&window).is_black(), "not before a talk");
    present(&mut window);
    window.type_char(KeyCode::KeyB, "b");
    assert!(talk(&window).is_black());
    window.type_char(KeyCode::Period, ".");
    assert!(!talk(&window).is_black());
    let caption = |window: &Window| {
        let captions = talk(window).captions(window.session());
        captions.and_then(|captions| captions.at(window.t()).map(|(name, _)| name.to_owned()))
    };
    assert_eq!(caption(&window), Some("here".to_owned()));
    window.type_char(KeyCode::KeyT, "t");
    assert_eq!(caption(&window), None);
    window.type_char(KeyCode::KeyT, "t");
    assert_eq!(caption(&window), Some("here".to_owned()));
}

/// As the command line begins one.
fn begun(open: Intent) -> Window {
    let mut window = Window::new();
    window.0.world_mut().write_message(open);
    window.send(Intent::Present { is_all: true });
    window
}

#[test]
fn closing_in_a_talk_ends_it_and_asks_where_it_is_seen() {
    let mut window = with_stops();
    present(&mut window);
    window.send(Intent::Close);
    assert!(!talk(&window).is_on() && window.preferences().panels);
    let question = window.0.world().resource::<UnsavedQuestion>();
    assert!(question.text().is_some() && window.0.should_exit().is_none());
}

#[test]
fn a_talk_that_the_window_was_opened_for_closes_it() {
    let name = crate::window::entries().remove(0);
    let mut window = begun(Intent::OpenGallery(name));
    assert!(!window.preferences().panels, "before there is a drawing");
    window.wait();
    assert_eq!(window.t(), window.session().timing().from);
    window.send(Intent::Back);
    assert!(window.0.should_exit().is_some() && !window.preferences().panels);
}

#[test]
fn a_talk_of_nothing_ends_with_the_reason() {
    let mut window = begun(Intent::Open(vec!["missing.morph".into()]));
    window.wait();
    for _ in 0..3 {
        window.update();
    }
    assert!(!talk(&window).is_on() && window.preferences().panels);
    assert_eq!(window.problems().len(), 1);
    assert!(window.0.should_exit().is_none());
}
