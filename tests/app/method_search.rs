//! Tests of the search for the best method: it runs in the background, can be cancelled, and its
//! result is applied and can be undone.

use std::path::Path;
use std::time::Duration;

use morphospace::app::testing::{Intent, MethodSearch};
use morphospace::{Transition, TransitionMethod};

use crate::headless_window::HeadlessWindow;

fn method(window: &HeadlessWindow) -> Option<TransitionMethod> {
    window.session().transition().map(Transition::method)
}

fn is_searching(window: &HeadlessWindow) -> bool {
    window
        .0
        .world()
        .resource::<MethodSearch>()
        .visible_progress()
        .is_some()
}

/// A window with a field blend from a horizontal to a vertical bar; midway, the blend breaks into
/// pieces.
fn with_field_blend(folder: &Path) -> HeadlessWindow {
    let outline = |name: &str, d: &str| {
        let path = folder.join(name);
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg'><path d='{d}'/></svg>");
        std::fs::write(&path, svg).expect("written");
        path
    };
    let bar = outline("bar.svg", "M0 40 H100 V60 H0 Z");
    let vertical = outline("upright.svg", "M40 0 H60 V100 H40 Z");
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(vec![bar, vertical]));
    window.wait();
    let field = TransitionMethod::FIELD_BLEND;
    window.send(Intent::SetMethod(field.warp(), field.content()));
    window.wait();
    assert_eq!(method(&window), Some(field));
    window
}

#[test]
fn the_best_method_is_applied_and_can_be_undone() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_field_blend(folder.path());
    window.send(Intent::ChooseBestMethod);
    while is_searching(&window) {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window.wait();
    assert_eq!(method(&window), Some(TransitionMethod::RIGID_PARTS));
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(method(&window), Some(TransitionMethod::FIELD_BLEND));
}

#[test]
fn a_cancelled_search_changes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_field_blend(folder.path());
    window.send(Intent::ChooseBestMethod);
    assert!(is_searching(&window));
    window.send(Intent::Escape);
    assert!(!is_searching(&window));
    window.wait();
    assert_eq!(method(&window), Some(TransitionMethod::FIELD_BLEND));
}
