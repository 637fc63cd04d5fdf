//! The method with the least trouble is found beside the window, and taken.

use std::path::Path;
use std::time::Duration;

use morphospace::app::{Intent, MethodSearch};
use morphospace::{Transition, TransitionMethod};

use crate::window::Window;

fn cell(window: &Window) -> Option<TransitionMethod> {
    window.session().transition().map(Transition::cell)
}

fn is_trying(window: &Window) -> bool {
    window.0.world().resource::<MethodSearch>().told().is_some()
}

/// Two outlines that blend as fields, of which pieces break off on the way.
fn with_fields(folder: &Path) -> Window {
    let outline = |name: &str, d: &str| {
        let path = folder.join(name);
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg'><path d='{d}'/></svg>");
        std::fs::write(&path, svg).expect("written");
        path
    };
    let bar = outline("bar.svg", "M0 40 H100 V60 H0 Z");
    let upright = outline("upright.svg", "M40 0 H60 V100 H40 Z");
    let mut window = Window::new();
    window.send(Intent::Open(vec![bar, upright]));
    window.wait();
    let field = TransitionMethod::FIELD_BLEND;
    window.send(Intent::UseCell(field.warp(), field.content()));
    window.wait();
    assert_eq!(cell(&window), Some(field));
    window
}

#[test]
fn the_best_method_is_taken_and_can_be_taken_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_fields(folder.path());
    window.send(Intent::ChooseMethod);
    while is_trying(&window) {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window.wait();
    assert_eq!(cell(&window), Some(TransitionMethod::RIGID_PARTS));
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(cell(&window), Some(TransitionMethod::FIELD_BLEND));
}

#[test]
fn a_choice_that_is_stopped_changes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_fields(folder.path());
    window.send(Intent::ChooseMethod);
    assert!(is_trying(&window));
    window.send(Intent::Back);
    assert!(!is_trying(&window));
    window.wait();
    assert_eq!(cell(&window), Some(TransitionMethod::FIELD_BLEND));
}
