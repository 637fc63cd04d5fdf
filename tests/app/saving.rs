//! Every way to save ends in words: where it was saved, or that it was not.

use std::path::{Path, PathBuf};

use bevy::input::keyboard::{Key, KeyCode};
use morphospace::app::{
    DialogPurpose, FileDialogRequest, Intent, NoticeKind, Notices, UnsavedAnswer,
};
use morphospace::work::progress::Silent;

use crate::window::{Window, entries};

fn asks(window: &Window) -> Option<DialogPurpose> {
    window
        .0
        .world()
        .resource::<FileDialogRequest>()
        .asks()
        .cloned()
}

fn said(window: &Window) -> Vec<String> {
    let notices = window.0.world().resource::<Notices>().list();
    let done = notices
        .iter()
        .filter(|notice| notice.kind == NoticeKind::Done);
    done.map(|notice| notice.text.clone()).collect()
}

/// What the dialog answers; whether the window closes then.
fn choose(window: &mut Window, paths: &[&Path]) -> bool {
    let paths = paths.iter().map(|path| path.to_path_buf()).collect();
    window.send(Intent::Choose(paths));
    (0..3).fold(false, |is_closed, _| {
        window.update();
        is_closed || window.0.should_exit().is_some()
    })
}

fn changed() -> Window {
    let mut window = Window::with_gallery();
    window.send(Intent::CyclePlayMode);
    assert!(window.session().is_dirty());
    window
}

#[test]
fn a_film_that_was_found_is_saved_and_not_looked_for_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawing = |name: &str, path: &str| {
        let file = folder.path().join(name);
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg'><path d='{path}'/></svg>");
        std::fs::write(&file, text).expect("a file");
        file
    };
    let square = drawing("square.svg", "M10 10h80v80h-80z");
    let bend = drawing("bend.svg", "M10 10h80v20h-60v60h-20z");
    let mut window = Window::new();
    window.send(Intent::Open(vec![square, bend]));
    window.wait();
    let path = folder.path().join("kept.morph");
    window.send(Intent::SaveTo(path.clone()));
    assert!(!window.session().is_dirty());
    let mut again = Window::new();
    again.send(Intent::Open(vec![path.clone()]));
    again.wait();
    let spec = again
        .session()
        .staged()
        .expect("a film")
        .spec()
        .expect("settings");
    assert!(!spec.found.is_none());
    assert!(
        spec.draft(&Silent).is_none(),
        "it would be looked for again"
    );
    // What is changed is looked for, and what is saved then is that.
    let before = std::fs::read_to_string(&path).expect("text");
    let mut project = again.session().project().cloned().expect("a project");
    project.options.arap.symmetric = false;
    again.send(Intent::Edit(Box::new(project)));
    again.wait();
    again.send(Intent::Save);
    let found = |text: &str| text.split("[found]").nth(1).map(str::to_owned);
    let after = std::fs::read_to_string(&path).expect("text");
    assert!(found(&after).is_some() && found(&after) != found(&before));
}

fn name() -> String {
    format!("{}.morph", entries().remove(0))
}

#[test]
fn a_project_without_a_file_is_asked_for_a_place_and_told_where_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = changed();
    window.send(Intent::Save);
    assert_eq!(asks(&window), Some(DialogPurpose::Save(name())));
    let path = folder.path().join("mine");
    choose(&mut window, &[&path]);
    let path = path.with_extension("morph");
    assert!(path.is_file() && !window.session().is_dirty());
    assert!(said(&window).contains(&format!("Saved {}", path.display())));
    assert_eq!(asks(&window), None);
    // From now on it has a place, and the next dialog opens there.
    window.send(Intent::CyclePlayMode);
    window.send(Intent::Save);
    assert!(asks(&window).is_none() && !window.session().is_dirty());
    window.send(Intent::AskOpen);
    let dialog: &FileDialogRequest = window.0.world().resource();
    assert_eq!(dialog.folder(), Some(folder.path()));
}

#[test]
fn leaving_the_dialog_is_told_and_nothing_is_closed() {
    let mut window = changed();
    window.send(Intent::Close);
    window.send(Intent::Answer(UnsavedAnswer::Save));
    window.update();
    assert!(matches!(asks(&window), Some(DialogPurpose::Save(_))));
    assert!(!choose(&mut window, &[]));
    assert!(
        said(&window)
            .iter()
            .any(|words| words.contains("not saved"))
    );
    assert!(window.session().is_dirty());
    // Nothing waits any more.
    let folder = tempfile::tempdir().expect("a folder");
    window.send(Intent::SaveTo(folder.path().join("later.morph")));
    window.update();
    assert!(window.0.should_exit().is_none());
}

#[test]
fn closing_waits_for_the_save_and_an_error_keeps_the_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    std::fs::write(&file, "").expect("a file");
    let mut window = changed();
    let mut close_and_save_to = |path: PathBuf| {
        window.send(Intent::Close);
        window.send(Intent::Answer(UnsavedAnswer::Save));
        window.update();
        let is_closed = choose(&mut window, &[&path]);
        (window.problems(), is_closed)
    };
    let (problems, is_closed) = close_and_save_to(file.join("below.morph"));
    assert!(
        problems.len() == 1 && problems[0].contains("file"),
        "{problems:?}"
    );
    assert!(!is_closed);
    let path = folder.path().join("mine.morph");
    let (problems, is_closed) = close_and_save_to(path.clone());
    assert_eq!(problems, Vec::<String>::new());
    assert!(path.is_file());
    assert!(is_closed);
}

#[test]
fn a_name_that_becomes_that_of_another_file_is_asked_about() {
    let folder = tempfile::tempdir().expect("a folder");
    let taken = folder.path().join("taken.morph");
    std::fs::write(&taken, "precious").expect("a file");
    let mut window = changed();
    window.send(Intent::SaveAs);
    choose(&mut window, &[&folder.path().join("taken")]);
    assert_eq!(std::fs::read_to_string(&taken).expect("text"), "precious");
    assert!(window.problems()[0].contains("taken.morph"));
    assert_eq!(
        asks(&window),
        Some(DialogPurpose::Save("taken.morph".into()))
    );
    // The dialog asks itself about a file that is pointed at.
    choose(&mut window, &[&taken]);
    assert!(!window.session().is_dirty() && window.problems().is_empty());
    assert_ne!(std::fs::read_to_string(&taken).expect("text"), "precious");
}

#[test]
fn what_is_chosen_is_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.morph");
    let mut window = changed();
    window.send(Intent::SaveTo(path.clone()));
    let mut again = Window::new();
    again.send(Intent::SaveAs);
    assert_eq!(asks(&again), None, "there is nothing to save");
    again.send(Intent::AskOpen);
    assert_eq!(asks(&again), Some(DialogPurpose::Open));
    choose(&mut again, &[&path]);
    again.wait();
    assert_eq!(again.session().path(), Some(path.as_path()));
}

/// With the dialog itself: keys belong to it while it is there.
#[test]
fn the_keyboard_leaves_the_dialog_and_takes_what_it_offers() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = Window::with_panels();
    window.send(Intent::SaveTo(folder.path().join("first.morph")));
    let press = |window: &mut Window, code: KeyCode, key: Key| {
        // It lists its folder beside the window.
        for _ in 0..20 {
            std::thread::sleep(std::time::Duration::from_millis(5));
            window.update();
        }
        window.press(code, key);
        window.update();
        window.update();
    };
    window.send(Intent::SaveAs);
    press(&mut window, KeyCode::Escape, Key::Escape);
    assert_eq!(asks(&window), None);
    assert!(
        said(&window)
            .iter()
            .any(|words| words.contains("not saved"))
    );
    window.send(Intent::SaveAs);
    press(&mut window, KeyCode::Enter, Key::Enter);
    // The name that it offers is taken: it asks, and Enter says yes.
    press(&mut window, KeyCode::Enter, Key::Enter);
    assert_eq!(asks(&window), None);
    let saved = |words: &String| words.ends_with("first.morph");
    assert!(said(&window).iter().any(saved));
}
