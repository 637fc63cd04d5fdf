//! Tests of the rate of redraws: continuous while something moves, seldom during background work,
//! and none while the window is idle or hidden.

use std::time::Duration;

use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::Entity;
use bevy::window::WindowOccluded;
use bevy::winit::{UpdateMode, WinitSettings};
use morphospace::app::testing::{Notices, RedrawPace, StageMeasures};

use crate::headless_window::HeadlessWindow;

fn mode(window: &HeadlessWindow) -> UpdateMode {
    let settings = window.0.world().resource::<WinitSettings>();
    assert_eq!(
        settings.focused_mode, settings.unfocused_mode,
        "the redraw rate does not depend on the focus"
    );
    settings.focused_mode
}

fn is_moving(window: &HeadlessWindow) -> bool {
    mode(window) == UpdateMode::Continuous
}

/// Time until the next frame if there is no input.
fn frame_wait(window: &HeadlessWindow) -> Duration {
    match mode(window) {
        UpdateMode::Continuous => Duration::ZERO,
        UpdateMode::Reactive { wait, .. } => wait,
    }
}

/// Wait between two frames above which the window counts as idle.
const IDLE: Duration = Duration::from_secs(60);

/// Updates the window until it is idle; returns the number of frames that this took.
fn wait_for_idle(window: &mut HeadlessWindow) -> usize {
    (0..5_000)
        .find(|_| {
            window.update();
            if !is_moving(window) {
                std::thread::sleep(Duration::from_millis(1));
            }
            frame_wait(window) > IDLE
        })
        .expect("an idle window")
}

#[test]
fn an_idle_window_does_not_redraw() {
    let mut window = HeadlessWindow::with_panels();
    wait_for_idle(&mut window);
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
        assert!(frame_wait(&window) > IDLE);
    }
}

#[test]
fn playback_redraws_continuously_until_it_is_paused() {
    let mut window = HeadlessWindow::with_panels();
    wait_for_idle(&mut window);
    window.press(KeyCode::Space, Key::Space);
    for _ in 0..50 {
        assert!(window.playback().is_playing() && is_moving(&window));
        window.update();
    }
    window.press(KeyCode::Space, Key::Space);
    assert!(
        wait_for_idle(&mut window) < 30,
        "the window is idle soon after a pause"
    );
}

#[test]
fn a_key_press_redraws_until_its_effect_is_visible() {
    let mut window = HeadlessWindow::with_panels();
    wait_for_idle(&mut window);
    window.press(KeyCode::ArrowRight, Key::ArrowRight);
    for _ in 0..3 {
        assert!(is_moving(&window));
        window.update();
    }
    wait_for_idle(&mut window);
}

#[test]
fn the_window_redraws_until_a_confirmation_disappears() {
    let mut window = HeadlessWindow::with_panels();
    wait_for_idle(&mut window);
    let mut notices = window.0.world_mut().resource_mut::<Notices>();
    notices.confirm("a confirmation");
    let frames = wait_for_idle(&mut window);
    assert!(frames > 250, "six seconds of 20 ms: {frames}");
    assert!(window.0.world().resource::<Notices>().list().is_empty());
}

#[test]
fn a_hidden_window_does_not_redraw_and_work_redraws_seldom() {
    let mut window = HeadlessWindow::with_panels();
    window.press(KeyCode::Space, Key::Space);
    let mut wait_with_occlusion = |occluded: bool| {
        window.0.world_mut().write_message(WindowOccluded {
            window: Entity::PLACEHOLDER,
            occluded,
        });
        window.update();
        frame_wait(&window)
    };
    assert!(wait_with_occlusion(true) > IDLE);
    assert_eq!(wait_with_occlusion(false), Duration::ZERO);
    let hidden = RedrawPace {
        is_moving: true,
        is_waiting: true,
        has_clock: true,
        is_hidden: true,
        frame: Duration::ZERO,
    };
    assert_ne!(hidden.update_mode(), UpdateMode::Continuous);
    // If only the clock of the speaker window changes, the window is redrawn twice a second.
    let clock = RedrawPace {
        is_moving: false,
        is_waiting: false,
        has_clock: true,
        is_hidden: false,
        frame: Duration::ZERO,
    };
    let low_power = |millis| UpdateMode::reactive_low_power(Duration::from_millis(millis));
    assert_eq!(clock.update_mode(), low_power(500));
    // During background work, redraws take at most half of the time.
    for (frame_millis, wait_millis) in [(16, 50), (40, 100), (150, 400), (5_000, 400)] {
        let work = RedrawPace {
            is_waiting: true,
            frame: Duration::from_millis(frame_millis),
            ..clock
        };
        assert_eq!(
            work.update_mode(),
            low_power(wait_millis),
            "{frame_millis} ms"
        );
    }
}
