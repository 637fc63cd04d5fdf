//! Tests of the background recording of the transition on the stage, and of the proof that the
//! recording has no folds and no crossings. Also tests of the memory limit of recordings, and of
//! their cancellation.

use std::time::Duration;

use morphospace::app::testing::{Intent, StageRecording};
use morphospace::recording::RecordingError;
use morphospace::transition::Transition;

use crate::headless_window::HeadlessWindow;

/// Updates the window until the recording of the transition and its proof have ended.
fn wait_for_recording(window: &mut HeadlessWindow) {
    for _ in 0..10_000 {
        window.update();
        let recording = window.0.world().resource::<StageRecording>();
        if !recording.is_busy() {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("the recording does not end");
}

#[test]
fn the_transition_on_the_stage_is_recorded_and_proved() {
    let mut window = HeadlessWindow::new();
    window.send(Intent::OpenGallery("triangle-polar".to_owned()));
    window.wait();
    wait_for_recording(&mut window);
    let film = window
        .session()
        .transition()
        .and_then(Transition::recording);
    let film = film
        .expect("an ended recording")
        .as_ref()
        .expect("a recording");
    assert!(
        film.evaluation_count() <= 16,
        "{} solves",
        film.evaluation_count()
    );
    let proved = window.0.world().resource::<StageRecording>().proof();
    assert!(proved.expect("an answer").holds(), "{proved:?}");
    // When another project is opened, its transition is recorded as well.
    window.send(Intent::OpenGallery("letters".to_owned()));
    window.wait();
    wait_for_recording(&mut window);
    assert!(
        window
            .session()
            .transition()
            .and_then(Transition::recording)
            .is_some()
    );
}

#[test]
fn a_recording_above_the_memory_limit_is_refused_with_the_reason() {
    let mut window = HeadlessWindow::new();
    window
        .0
        .insert_resource(StageRecording::with_memory_limit(Some(0)));
    window.send(Intent::OpenGallery("triangle-polar".to_owned()));
    window.wait();
    wait_for_recording(&mut window);
    let film = window
        .session()
        .transition()
        .expect("a transition")
        .recording();
    assert!(film.is_none(), "{film:?}");
    let recording = window.0.world().resource::<StageRecording>();
    let reason = recording.recording_error().expect("a reason");
    assert!(
        matches!(reason, RecordingError::TooLarge { .. }),
        "{reason}"
    );
}

#[test]
fn opening_another_project_cancels_the_recording() {
    let mut window = HeadlessWindow::new();
    window.send(Intent::OpenGallery("rotor".to_owned()));
    window.wait();
    let first = window.session().transition().expect("a transition").clone();
    let recording = window.0.world().resource::<StageRecording>();
    assert!(recording.is_busy() && first.recording().is_none());
    window.send(Intent::OpenGallery("triangle-polar".to_owned()));
    window.wait();
    wait_for_recording(&mut window);
    let film = window
        .session()
        .transition()
        .and_then(Transition::recording);
    assert!(matches!(film, Some(Ok(_))), "{film:?}");
    // The cancelled recording ends at its next check for cancellation, and stores nothing.
    std::thread::sleep(Duration::from_secs(2));
    assert!(first.recording().is_none());
}
