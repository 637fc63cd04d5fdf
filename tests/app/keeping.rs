//! What is kept: changes that were not saved, and drawings that other programs change.

use std::path::Path;
use std::time::{Duration, Instant};

use morphospace::app::{Autosave, Intent, RecoveryAnswer};

use crate::window::{Window, entries};

const LONG: Duration = Duration::from_secs(20);

fn until(window: &mut Window, what: &str, is: impl Fn(&Window) -> bool) {
    let began = Instant::now();
    while !is(window) {
        assert!(began.elapsed() < LONG, "{what}");
        std::thread::sleep(Duration::from_millis(5));
        window.update();
    }
}

fn keeping(mut window: Window, folder: &Path) -> Window {
    let autosave = Autosave::enter(folder).expect("a folder");
    window.0.insert_resource(autosave);
    window
}

fn kept(folder: &Path) -> usize {
    let files = std::fs::read_dir(folder).expect("a folder").flatten();
    let is_kept = |name: &std::ffi::OsStr| name.to_string_lossy().ends_with(".json");
    files.filter(|file| is_kept(&file.file_name())).count()
}

fn lost(window: &Window) -> Option<String> {
    let autosave = window.0.world().resource::<Autosave>();
    autosave.lost().map(|(title, _)| title.to_owned())
}

/// Changed, and ended as a kill ends it: without asking.
fn killed(folder: &Path) -> String {
    let mut window = keeping(Window::with_gallery(), folder);
    window.send(Intent::CyclePlayMode);
    until(&mut window, "kept", |_| kept(folder) == 1);
    window.session().title()
}

#[test]
fn what_was_not_saved_is_offered_at_the_next_start() {
    let folder = tempfile::tempdir().expect("a folder");
    let title = killed(folder.path());
    let mut window = keeping(Window::new(), folder.path());
    assert_eq!(lost(&window), Some(title.clone()));
    window.send(Intent::Rescue(RecoveryAnswer::Restore));
    window.wait();
    assert_eq!(window.session().title(), title);
    assert!(window.session().is_dirty(), "it is still not saved");
    assert_eq!(lost(&window), None);
    let elsewhere = tempfile::tempdir().expect("a folder");
    let path = elsewhere.path().join("saved.morph");
    window.send(Intent::SaveTo(path));
    until(&mut window, "forgotten", |_| kept(folder.path()) == 0);
}

#[test]
fn what_is_put_off_is_offered_again_and_what_is_discarded_is_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let title = killed(folder.path());
    for answer in [RecoveryAnswer::Later, RecoveryAnswer::Discard] {
        let mut window = keeping(Window::new(), folder.path());
        assert_eq!(lost(&window), Some(title.clone()));
        window.send(Intent::Rescue(answer));
        assert_eq!(lost(&window), None);
    }
    assert_eq!(lost(&keeping(Window::new(), folder.path())), None);
    assert_eq!(kept(folder.path()), 0);
}

#[test]
fn what_is_open_elsewhere_is_not_lost() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut first = keeping(Window::with_gallery(), folder.path());
    first.send(Intent::CyclePlayMode);
    until(&mut first, "kept", |_| kept(folder.path()) == 1);
    assert_eq!(lost(&keeping(Window::new(), folder.path())), None);
    // Taken back, there is nothing to keep.
    first.send(Intent::Undo);
    until(&mut first, "forgotten", |_| kept(folder.path()) == 0);
}

#[test]
fn what_cannot_be_opened_again_stays_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawings = tempfile::tempdir().expect("a folder");
    let file = |name: &str| {
        let path = drawings.path().join(name);
        std::fs::write(&path, "[[0,0],[4,0],[4,3],[0,3]]").expect("a file");
        path
    };
    let pair = vec![file("a.json"), file("b.json")];
    let mut window = keeping(Window::new(), folder.path());
    window.send(Intent::Open(pair.clone()));
    window.wait();
    window.send(Intent::CyclePlayMode);
    until(&mut window, "kept", |_| kept(folder.path()) == 1);
    drop(window);
    std::fs::remove_file(&pair[0]).expect("there");
    let mut window = keeping(Window::new(), folder.path());
    window.send(Intent::Rescue(RecoveryAnswer::Restore));
    window.wait();
    assert_eq!(window.problems().len(), 1);
    window.send(Intent::OpenGallery(entries().remove(0)));
    window.wait();
    // What is changed now has a place of its own.
    window.send(Intent::CyclePlayMode);
    until(&mut window, "kept", |_| kept(folder.path()) == 2);
    window.send(Intent::Undo);
    until(&mut window, "forgotten", |_| kept(folder.path()) == 1);
    drop(window);
    file("a.json");
    let mut window = keeping(Window::new(), folder.path());
    window.send(Intent::Rescue(RecoveryAnswer::Restore));
    window.wait();
    assert!(window.session().transition().is_some() && window.session().is_dirty());
}
