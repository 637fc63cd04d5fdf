//! Tests of autosave: unsaved changes survive a crash and are offered at the next start.

use std::path::Path;
use std::time::{Duration, Instant};

use morphospace::app::testing::{Autosave, Intent, RecoveryAnswer};

use crate::headless_window::{HeadlessWindow, gallery_names};

/// Maximum time that [`wait_until`] waits.
const TIMEOUT: Duration = Duration::from_secs(20);

/// Updates the window until a condition holds. If that takes longer than [`TIMEOUT`], panics with
/// `state`, the name of the condition.
fn wait_until(
    window: &mut HeadlessWindow,
    state: &str,
    is_reached: impl Fn(&HeadlessWindow) -> bool,
) {
    let start = Instant::now();
    while !is_reached(window) {
        assert!(start.elapsed() < TIMEOUT, "not {state} in time");
        std::thread::sleep(Duration::from_millis(5));
        window.update();
    }
}

/// Returns the window with autosaving to a folder enabled.
fn with_autosave(mut window: HeadlessWindow, folder: &Path) -> HeadlessWindow {
    let autosave = Autosave::start_in(folder).expect("a folder");
    window.0.insert_resource(autosave);
    window
}

/// Number of autosaved projects in a folder.
fn autosave_count(folder: &Path) -> usize {
    let files = std::fs::read_dir(folder).expect("a folder").flatten();
    let is_autosave = |name: &std::ffi::OsStr| name.to_string_lossy().ends_with(".json");
    files.filter(|file| is_autosave(&file.file_name())).count()
}

/// Title of the unsaved project that is offered for recovery.
fn offered_title(window: &HeadlessWindow) -> Option<String> {
    let autosave = window.0.world().resource::<Autosave>();
    autosave.recoverable().map(|(title, _)| title.to_owned())
}

/// Changes a project, waits until it is autosaved, and drops the window without closing it, as if
/// the program had been killed. Returns the title of the project.
fn leave_unsaved_project(folder: &Path) -> String {
    let mut window = with_autosave(HeadlessWindow::with_gallery(), folder);
    window.send(Intent::CyclePlayMode);
    wait_until(&mut window, "autosaved", |_| autosave_count(folder) == 1);
    window.session().title()
}

#[test]
fn unsaved_changes_are_offered_at_the_next_start() {
    let folder = tempfile::tempdir().expect("a folder");
    let title = leave_unsaved_project(folder.path());
    let mut window = with_autosave(HeadlessWindow::new(), folder.path());
    assert_eq!(offered_title(&window), Some(title.clone()));
    window.send(Intent::AnswerRecovery(RecoveryAnswer::Restore));
    window.wait();
    assert_eq!(window.session().title(), title);
    assert!(
        window.session().is_dirty(),
        "a recovered project is still unsaved"
    );
    assert_eq!(offered_title(&window), None);
    let elsewhere = tempfile::tempdir().expect("a folder");
    let path = elsewhere.path().join("saved.morph");
    window.send(Intent::SaveTo(path));
    wait_until(&mut window, "removed", |_| {
        autosave_count(folder.path()) == 0
    });
}

#[test]
fn a_postponed_recovery_is_offered_again_and_a_discarded_one_is_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let title = leave_unsaved_project(folder.path());
    for answer in [RecoveryAnswer::Later, RecoveryAnswer::Discard] {
        let mut window = with_autosave(HeadlessWindow::new(), folder.path());
        assert_eq!(offered_title(&window), Some(title.clone()));
        window.send(Intent::AnswerRecovery(answer));
        assert_eq!(offered_title(&window), None);
    }
    assert_eq!(
        offered_title(&with_autosave(HeadlessWindow::new(), folder.path())),
        None
    );
    assert_eq!(autosave_count(folder.path()), 0);
}

#[test]
fn a_project_open_in_another_window_is_not_offered() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut first = with_autosave(HeadlessWindow::with_gallery(), folder.path());
    first.send(Intent::CyclePlayMode);
    wait_until(&mut first, "autosaved", |_| {
        autosave_count(folder.path()) == 1
    });
    assert_eq!(
        offered_title(&with_autosave(HeadlessWindow::new(), folder.path())),
        None
    );
    // Undoing the only change leaves nothing to autosave.
    first.send(Intent::Undo);
    wait_until(&mut first, "removed", |_| {
        autosave_count(folder.path()) == 0
    });
}

#[test]
fn an_autosave_that_cannot_be_opened_is_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawings = tempfile::tempdir().expect("a folder");
    let file = |name: &str| {
        let path = drawings.path().join(name);
        std::fs::write(&path, "[[0,0],[4,0],[4,3],[0,3]]").expect("a file");
        path
    };
    let pair = vec![file("a.json"), file("b.json")];
    let mut window = with_autosave(HeadlessWindow::new(), folder.path());
    window.send(Intent::Open(pair.clone()));
    window.wait();
    window.send(Intent::CyclePlayMode);
    wait_until(&mut window, "autosaved", |_| {
        autosave_count(folder.path()) == 1
    });
    drop(window);
    std::fs::remove_file(&pair[0]).expect("there");
    let mut window = with_autosave(HeadlessWindow::new(), folder.path());
    window.send(Intent::AnswerRecovery(RecoveryAnswer::Restore));
    window.wait();
    assert_eq!(window.problems().len(), 1);
    window.send(Intent::OpenGallery(gallery_names().remove(0)));
    window.wait();
    // New changes are stored in another file, so the project that cannot be opened is not
    // overwritten.
    window.send(Intent::CyclePlayMode);
    wait_until(&mut window, "autosaved", |_| {
        autosave_count(folder.path()) == 2
    });
    window.send(Intent::Undo);
    wait_until(&mut window, "removed", |_| {
        autosave_count(folder.path()) == 1
    });
    drop(window);
    file("a.json");
    let mut window = with_autosave(HeadlessWindow::new(), folder.path());
    window.send(Intent::AnswerRecovery(RecoveryAnswer::Restore));
    window.wait();
    assert!(window.session().transition().is_some() && window.session().is_dirty());
}
