//! What is on the stage is recorded beside the window, and proved.

use std::time::Duration;

use morphospace::app::{Intent, StageRecording};
use morphospace::recording::RecordingError;
use morphospace::transition::Transition;

use crate::window::Window;

fn settle(window: &mut Window) {
    for _ in 0..10_000 {
        window.update();
        let recording = window.0.world().resource::<StageRecording>();
        if !recording.is_busy() {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("it is recorded for ever");
}

#[test]
fn what_is_on_the_stage_is_played_from_memory_once_that_is_there() {
    let mut window = Window::new();
    window.send(Intent::OpenGallery("triangle-polar".to_owned()));
    window.wait();
    settle(&mut window);
    let film = window.session().transition().and_then(Transition::film);
    let film = film.expect("recorded").as_ref().expect("a film");
    assert!(film.solves() <= 16, "{} solves", film.solves());
    let proved = window.0.world().resource::<StageRecording>().proved();
    assert!(proved.expect("an answer").holds(), "{proved:?}");
    // Another film takes its place, and nothing is said of it before it is known.
    window.send(Intent::OpenGallery("letters".to_owned()));
    window.wait();
    settle(&mut window);
    assert!(
        window
            .session()
            .transition()
            .and_then(Transition::film)
            .is_some()
    );
}

#[test]
fn a_film_that_may_take_no_memory_is_solved_and_says_so() {
    let mut window = Window::new();
    window.0.insert_resource(StageRecording::within(Some(0)));
    window.send(Intent::OpenGallery("triangle-polar".to_owned()));
    window.wait();
    settle(&mut window);
    let film = window.session().transition().expect("a transition").film();
    assert!(film.is_none(), "{film:?}");
    let recording = window.0.world().resource::<StageRecording>();
    let why = recording.refused().expect("a reason");
    assert!(matches!(why, RecordingError::TooLarge { .. }), "{why}");
}

#[test]
fn a_recording_is_given_up_for_what_comes_next() {
    let mut window = Window::new();
    window.send(Intent::OpenGallery("rotor".to_owned()));
    window.wait();
    let first = window.session().transition().expect("a transition").clone();
    let recording = window.0.world().resource::<StageRecording>();
    assert!(recording.is_busy() && first.film().is_none());
    window.send(Intent::OpenGallery("triangle-polar".to_owned()));
    window.wait();
    settle(&mut window);
    let film = window.session().transition().and_then(Transition::film);
    assert!(matches!(film, Some(Ok(_))), "{film:?}");
    // Where the recording looked last, it heard that nobody wants it.
    std::thread::sleep(Duration::from_secs(2));
    assert!(first.film().is_none());
}
