//! At rest the window draws nothing; whatever moves wakes it.

use std::time::Duration;

use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::Entity;
use bevy::window::WindowOccluded;
use bevy::winit::{UpdateMode, WinitSettings};
use morphospace::app::{Notices, RedrawPace, StageMeasures};

use crate::window::Window;

fn mode(window: &Window) -> UpdateMode {
    let settings = window.0.world().resource::<WinitSettings>();
    assert_eq!(
        settings.focused_mode, settings.unfocused_mode,
        "the focus says nothing of what moves"
    );
    settings.focused_mode
}

fn is_moving(window: &Window) -> bool {
    mode(window) == UpdateMode::Continuous
}

/// Until the next frame, if nothing happens.
fn waits(window: &Window) -> Duration {
    match mode(window) {
        UpdateMode::Continuous => Duration::ZERO,
        UpdateMode::Reactive { wait, .. } => wait,
    }
}

const LONG: Duration = Duration::from_secs(60);

/// Frames until the window rests.
fn settle(window: &mut Window) -> usize {
    (0..5_000)
        .find(|_| {
            window.update();
            if !is_moving(window) {
                std::thread::sleep(Duration::from_millis(1));
            }
            waits(window) > LONG
        })
        .expect("the window never rests")
}

#[test]
fn at_rest_nothing_is_drawn() {
    let mut window = Window::with_panels();
    settle(&mut window);
    assert!(
        window
            .0
            .world()
            .resource::<StageMeasures>()
            .measures()
            .is_some()
    );
    for _ in 0..50 {
        window.update();
        assert!(waits(&window) > LONG);
    }
}

#[test]
fn what_plays_is_drawn_all_the_time_and_starts_where_it_was() {
    let mut window = Window::with_panels();
    settle(&mut window);
    window.press(KeyCode::Space, Key::Space);
    for _ in 0..50 {
        assert!(window.playback().is_playing() && is_moving(&window));
        window.update();
    }
    window.press(KeyCode::Space, Key::Space);
    assert!(settle(&mut window) < 30, "a pause is a rest at once");
}

#[test]
fn a_key_is_drawn_until_all_that_came_of_it_is_seen() {
    let mut window = Window::with_panels();
    settle(&mut window);
    window.press(KeyCode::ArrowRight, Key::ArrowRight);
    for _ in 0..3 {
        assert!(is_moving(&window));
        window.update();
    }
    settle(&mut window);
}

#[test]
fn a_message_that_passes_is_waited_for() {
    let mut window = Window::with_panels();
    settle(&mut window);
    let mut notices = window.0.world_mut().resource_mut::<Notices>();
    notices.done("a confirmation");
    let frames = settle(&mut window);
    assert!(frames > 250, "six seconds of 20 ms: {frames}");
    assert!(window.0.world().resource::<Notices>().list().is_empty());
}

#[test]
fn what_nobody_sees_is_not_drawn() {
    let mut window = Window::with_panels();
    window.press(KeyCode::Space, Key::Space);
    let mut cover = |occluded: bool| {
        window.0.world_mut().write_message(WindowOccluded {
            window: Entity::PLACEHOLDER,
            occluded,
        });
        window.update();
        waits(&window)
    };
    assert!(cover(true) > LONG);
    assert_eq!(cover(false), Duration::ZERO);
    let hidden = RedrawPace {
        moves: true,
        waits: true,
        ticks: true,
        is_hidden: true,
        frame: Duration::ZERO,
    };
    assert_ne!(hidden.mode(), UpdateMode::Continuous);
    // A clock alone is drawn twice a second.
    let clock = RedrawPace {
        moves: false,
        waits: false,
        ticks: true,
        is_hidden: false,
        frame: Duration::ZERO,
    };
    let in_millis = |millis| UpdateMode::reactive_low_power(Duration::from_millis(millis));
    assert_eq!(clock.mode(), in_millis(500));
    // Work keeps half of a processor that draws, and is seen to go on all the same.
    for (frame, look) in [(16, 50), (40, 100), (150, 400), (5_000, 400)] {
        let work = RedrawPace {
            waits: true,
            frame: Duration::from_millis(frame),
            ..clock
        };
        assert_eq!(work.mode(), in_millis(look), "{frame} ms");
    }
}
