//! Tests of autosave: unsaved changes survive a crash and are offered at the next start.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use morphospace::app::testing::{Autosave, Intent, Notices, RecoveryAnswer};

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
fn with_autosave(window: HeadlessWindow, folder: &Path) -> HeadlessWindow {
    with_autosave_places(window, &[folder])
}

/// Returns the window with autosaving enabled, to the first of these folders that can be used.
fn with_autosave_places(mut window: HeadlessWindow, folders: &[&Path]) -> HeadlessWindow {
    window.0.insert_resource(Autosave::start_in(folders));
    window.update();
    window
}

/// Dismisses all notices of a window.
fn dismiss_notices(window: &mut HeadlessWindow) {
    let notices = window.0.world().resource::<Notices>().list();
    let ids: Vec<u64> = notices.iter().map(|notice| notice.id).collect();
    for id in ids {
        window.send(Intent::DismissNotice(id));
    }
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

#[test]
fn a_failing_autosave_is_reported_until_it_works() {
    let folder = tempfile::tempdir().expect("a folder");
    let (blocked, autosaves) = (folder.path().join("x"), folder.path().join("x/autosave"));
    std::fs::write(&blocked, "not a folder").expect("a file");
    let mut window = with_autosave(HeadlessWindow::new(), &autosaves);
    let is_reported = |window: &HeadlessWindow| {
        let text = window.problems().join("; ");
        text.contains("Autosave is failing") && text.contains("autosave (")
    };
    assert!(is_reported(&window), "at once: {:?}", window.problems());
    window.send(Intent::OpenGallery(gallery_names().remove(0)));
    window.wait();
    dismiss_notices(&mut window);
    assert!(is_reported(&window), "the notice stays");
    window.send(Intent::CyclePlayMode);
    std::fs::remove_file(&blocked).expect("there");
    wait_until(&mut window, "autosaved", |window| {
        autosaves.is_dir() && autosave_count(&autosaves) == 1 && window.problems().is_empty()
    });
}

#[test]
fn a_second_folder_is_used_until_the_first_works_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    std::fs::write(&first, "not a folder").expect("a file");
    let places = [first.as_path(), second.as_path()];
    let mut window = with_autosave_places(HeadlessWindow::with_gallery(), &places);
    let notice = window.problems().join("; ");
    assert!(notice.contains("first (") && notice.contains("second instead"));
    window.send(Intent::CyclePlayMode);
    wait_until(&mut window, "autosaved", |_| autosave_count(&second) == 1);
    let title = window.session().title();
    drop(window);
    let mut window = with_autosave_places(HeadlessWindow::new(), &places);
    assert_eq!(offered_title(&window), Some(title));
    std::fs::remove_file(&first).expect("there");
    window.send(Intent::AnswerRecovery(RecoveryAnswer::Restore));
    window.wait();
    wait_until(&mut window, "moved to the first folder", |window| {
        let is_moved = first.is_dir() && autosave_count(&first) == 1;
        is_moved && autosave_count(&second) == 0 && window.problems().is_empty()
    });
}

#[test]
fn an_autosave_that_fails_later_moves_to_the_second_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    let places = [first.as_path(), second.as_path()];
    let mut window = with_autosave_places(HeadlessWindow::with_gallery(), &places);
    assert_eq!(window.problems(), Vec::<String>::new());
    std::fs::remove_dir_all(&first).expect("there");
    std::fs::write(&first, "not a folder").expect("a file");
    window.send(Intent::CyclePlayMode);
    wait_until(&mut window, "autosaved", |window| {
        second.is_dir() && autosave_count(&second) == 1 && !window.problems().is_empty()
    });
    window.send(Intent::Undo);
    wait_until(&mut window, "removed", |_| autosave_count(&second) == 0);
}

/// Creates a named pipe.
#[cfg(unix)]
fn make_pipe(path: PathBuf) {
    let made = std::process::Command::new("mkfifo").arg(path).status();
    assert!(made.expect("mkfifo").success());
}

#[cfg(unix)]
#[test]
fn pipes_and_folders_do_not_block_the_start_and_damaged_autosaves_are_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    make_pipe(path("0.lock"));
    std::fs::create_dir(path("1.lock")).expect("a folder");
    make_pipe(path("2.json"));
    std::fs::create_dir(path("3.json")).expect("a folder");
    std::fs::write(path("4.json"), "damaged").expect("a file");
    let (sender, receiver) = std::sync::mpsc::channel();
    let start_folder = folder.path().to_owned();
    std::thread::spawn(move || sender.send(Autosave::start_in(&[start_folder])).is_ok());
    let autosave = receiver.recv_timeout(TIMEOUT).expect("not blocked");
    let mut window = HeadlessWindow::with_gallery();
    window.0.insert_resource(autosave);
    window.update();
    let problems = window.problems();
    assert_eq!(problems.len(), 3, "{problems:?}");
    assert!(problems.iter().any(|text| text.ends_with("4.damaged")));
    let kept = std::fs::read_to_string(path("4.damaged"));
    assert_eq!(kept.expect("kept"), "damaged");
    window.send(Intent::CyclePlayMode);
    wait_until(&mut window, "autosaved", |_| path("4.json").is_file());
}

#[cfg(unix)]
#[test]
fn designs_with_non_utf8_names_are_autosaved() {
    use std::os::unix::ffi::OsStrExt;
    let [folder, drawings] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let pair = [&b"a\xe9.json"[..], b"b\xff.json"].map(|name| {
        let path = drawings.path().join(std::ffi::OsStr::from_bytes(name));
        std::fs::write(&path, "[[0,0],[4,0],[4,3],[0,3]]").expect("a file");
        path
    });
    let mut window = with_autosave(HeadlessWindow::new(), folder.path());
    window.send(Intent::Open(pair.to_vec()));
    window.wait();
    window.send(Intent::CyclePlayMode);
    wait_until(&mut window, "autosaved", |_| {
        autosave_count(folder.path()) == 1
    });
    drop(window);
    let mut window = with_autosave(HeadlessWindow::new(), folder.path());
    window.send(Intent::AnswerRecovery(RecoveryAnswer::Restore));
    window.wait();
    assert_eq!(window.session().files(), pair);
    assert!(window.session().transition().is_some());
}
