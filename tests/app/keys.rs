//! Tests of keyboard shortcuts: their effects on time, speed, stops, panels and the method, on
//! different keyboard layouts and while a text field has the focus.

use crate::headless_window::{HeadlessWindow, is_close};
use bevy::input::ButtonState;
use bevy::input::keyboard::{Key, KeyCode};
use morphospace::app::testing::{Intent, KeyboardFocus};
use morphospace::content::ContentKind;
use morphospace::transition::{PlayMode, TransitionMethod};

#[test]
fn space_plays_and_pauses() {
    let mut window = HeadlessWindow::with_gallery();
    window.press(KeyCode::Space, Key::Space);
    assert!(window.playback().is_playing());
    for _ in 0..60 {
        window.update();
    }
    assert!(window.t() > 0.0);
    window.press(KeyCode::Space, Key::Space);
    let t = window.t();
    window.update();
    assert_eq!(window.t(), t);
}

#[test]
fn arrows_step_and_repeat_and_shift_makes_steps_tenfold() {
    let mut window = HeadlessWindow::with_gallery();
    window.press(KeyCode::ArrowRight, Key::ArrowRight);
    assert!(is_close(window.t(), 0.01));
    window.key(
        ButtonState::Pressed,
        KeyCode::ArrowRight,
        Key::ArrowRight,
        true,
    );
    assert!(is_close(window.t(), 0.02));
    window.press(KeyCode::ArrowLeft, Key::ArrowLeft);
    window.hold(KeyCode::ShiftLeft, Key::Shift, |window| {
        window.press(KeyCode::ArrowLeft, Key::ArrowLeft);
    });
    assert!(is_close(window.t(), -0.09));
}

#[test]
fn home_and_end_jump_to_the_start_and_end() {
    let mut window = HeadlessWindow::with_gallery();
    window.press(KeyCode::End, Key::End);
    assert_eq!(window.t(), window.session().timing().to);
    window.press(KeyCode::Home, Key::Home);
    assert_eq!(window.t(), window.session().timing().from);
}

#[test]
fn digits_act_by_position_and_signs_by_the_printed_character() {
    let mut window = HeadlessWindow::with_gallery();
    // On a French keyboard, the key of the digit 1 types “&”.
    window.type_char(KeyCode::Digit1, "&");
    assert!(is_close(window.t(), 0.1));
    // On a German keyboard, AltGr with the key of the digit 8 types “[”.
    window.type_char(KeyCode::Digit8, "[");
    assert!(is_close(window.t(), 0.1));
    assert!(window.playback().speed() < 1.0);
    window.type_char(KeyCode::BracketRight, "]");
    assert_eq!(window.playback().speed(), 1.0);
    // On a Dvorak keyboard, the key of the US semicolon types “s”.
    window.type_char(KeyCode::Semicolon, "s");
    assert!(
        window
            .messages()
            .contains(&Intent::Screenshot { with_panels: false })
    );
}

#[test]
fn backspace_resets_the_speed_and_r_reverses_playback() {
    let mut window = HeadlessWindow::with_gallery();
    window.type_char(KeyCode::BracketRight, "]");
    window.press(KeyCode::Backspace, Key::Backspace);
    assert_eq!(window.playback().speed(), 1.0);
    window.type_char(KeyCode::KeyR, "r");
    assert!(window.playback().is_backwards());
}

#[test]
fn l_cycles_through_the_play_modes() {
    let mut window = HeadlessWindow::with_gallery();
    let mut seen = vec![window.session().timing().play];
    for _ in 0..3 {
        window.type_char(KeyCode::KeyL, "l");
        seen.push(window.session().timing().play);
    }
    assert_eq!(seen[0], seen[3]);
    for mode in [PlayMode::Once, PlayMode::Loop, PlayMode::PingPong] {
        assert!(seen.contains(&mode));
    }
}

#[test]
fn stops_are_added_jumped_to_and_played_to() {
    let mut window = HeadlessWindow::with_gallery();
    let before = window.session().stops().len();
    window.send(Intent::Seek(0.437));
    window.type_char(KeyCode::KeyM, "m");
    window.type_char(KeyCode::KeyM, "m");
    assert_eq!(
        window.session().stops().len(),
        before + 1,
        "a second stop at the same t is not added"
    );
    window.press(KeyCode::Home, Key::Home);
    window.press(KeyCode::ArrowUp, Key::ArrowUp);
    let first = window.t();
    assert!(first > window.session().timing().from);
    window.press(KeyCode::ArrowDown, Key::ArrowDown);
    assert_eq!(window.t(), window.session().timing().from);
    window.press(KeyCode::PageDown, Key::PageDown);
    assert!(window.playback().is_playing(), "plays instead of jumping");
    assert!(window.t() < first);
    while window.playback().is_playing() {
        window.update();
    }
    assert_eq!(window.t(), first, "stops exactly at the stop");
    window.press(KeyCode::PageUp, Key::PageUp);
    while window.playback().is_playing() {
        window.update();
    }
    assert_eq!(window.t(), window.session().timing().from);
}

#[test]
fn no_key_acts_while_a_text_field_has_the_focus() {
    let mut window = HeadlessWindow::with_gallery();
    window.0.insert_resource(KeyboardFocus(true));
    window.press(KeyCode::Space, Key::Space);
    window.type_char(KeyCode::Digit5, "5");
    window.type_char(KeyCode::KeyS, "s");
    assert!(!window.playback().is_playing());
    assert_eq!(window.t(), window.session().timing().from);
    assert!(window.messages().is_empty());
    window.0.insert_resource(KeyboardFocus(false));
    window.update();
    assert_eq!(
        window.t(),
        window.session().timing().from,
        "ignored keys do not act later"
    );
}

#[test]
fn shift_and_control_select_among_the_meanings_of_s() {
    let mut window = HeadlessWindow::with_gallery();
    window.hold(KeyCode::ShiftRight, Key::Shift, |window| {
        window.type_char(KeyCode::KeyS, "S");
        assert!(
            window
                .messages()
                .contains(&Intent::Screenshot { with_panels: true })
        );
    });
    window.update();
    window.update();
    window.hold(KeyCode::ControlLeft, Key::Control, |window| {
        window.type_char(KeyCode::KeyS, "s");
        assert!(window.messages().contains(&Intent::Save));
        assert!(
            !window
                .messages()
                .contains(&Intent::Screenshot { with_panels: false })
        );
    });
}

#[test]
fn escape_closes_one_thing_at_a_time() {
    let mut window = HeadlessWindow::with_gallery();
    window.type_char(KeyCode::KeyH, "h");
    window.press(KeyCode::F1, Key::F1);
    assert!(!window.preferences().panels && window.preferences().help);
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!window.preferences().panels && !window.preferences().help);
    window.press(KeyCode::Escape, Key::Escape);
    assert!(window.preferences().panels);
    window.type_char(KeyCode::Minus, "?");
    assert!(window.preferences().help);
}

#[test]
fn tab_cycles_through_the_available_methods() {
    let mut window = HeadlessWindow::with_gallery();
    let method = |window: &HeadlessWindow| window.session().transition().map(|t| t.method());
    let first = method(&window);
    let mut seen = vec![first];
    loop {
        window.press(KeyCode::Tab, Key::Tab);
        window.wait();
        let next = method(&window);
        if next == first {
            break;
        }
        assert!(!seen.contains(&next), "a method appears twice");
        seen.push(next);
    }
    // Two outlines have no pictures, so methods that blend colours are unavailable.
    let is_available = |cell: &TransitionMethod| cell.content() != ContentKind::Colours;
    assert_eq!(
        seen.len(),
        TransitionMethod::all().filter(is_available).count()
    );
}
