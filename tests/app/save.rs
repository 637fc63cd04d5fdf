//! Tests of saving: every save is confirmed with its path or reported as cancelled, existing files
//! are not overwritten by accident, and the match is saved. Also tests of the file dialog.

use std::path::{Path, PathBuf};

use bevy::input::keyboard::{Key, KeyCode};
use morphospace::app::testing::{
    CaptureFolder, ConflictAnswer, ConflictQuestion, DialogPurpose, ExportKind, FileDialogRequest,
    FilmExporter, Intent, NoticeKind, Notices, UnsavedAnswer,
};
use morphospace::work::progress::Silent;

use crate::headless_window::{HeadlessWindow, gallery_names};

/// Purpose of the file dialog; `None` if no dialog is open.
fn open_dialog(window: &HeadlessWindow) -> Option<DialogPurpose> {
    window
        .0
        .world()
        .resource::<FileDialogRequest>()
        .purpose()
        .cloned()
}

/// Texts of the confirmations that the window shows at the moment.
fn confirmations(window: &HeadlessWindow) -> Vec<String> {
    let notices = window.0.world().resource::<Notices>().list();
    let done = notices
        .iter()
        .filter(|notice| notice.kind == NoticeKind::Confirmation);
    done.map(|notice| notice.text.clone()).collect()
}

/// Whether the window reports that saving was cancelled. The report must be a note: a confirmation
/// would have a tick as its icon.
fn reports_cancelled_save(window: &HeadlessWindow) -> bool {
    let notices = window.0.world().resource::<Notices>().list();
    notices
        .iter()
        .any(|notice| notice.kind == NoticeKind::Note && notice.text.contains("Save cancelled"))
}

/// Answers the file dialog with `paths`, or cancels it if there are none; returns whether the
/// window then closes.
fn choose(window: &mut HeadlessWindow, paths: &[&Path]) -> bool {
    let paths = paths.iter().map(|path| path.to_path_buf()).collect();
    window.send(Intent::AnswerDialog(paths));
    (0..3).fold(false, |is_closed, _| {
        window.update();
        is_closed || window.0.should_exit().is_some()
    })
}

/// A window with an unsaved change.
fn with_change() -> HeadlessWindow {
    let mut window = HeadlessWindow::with_gallery();
    window.send(Intent::CyclePlayMode);
    assert!(window.session().is_dirty());
    window
}

#[test]
fn a_saved_match_is_reused_when_the_project_is_reopened() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawing = |name: &str, path: &str| {
        let file = folder.path().join(name);
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg'><path d='{path}'/></svg>");
        std::fs::write(&file, text).expect("a file");
        file
    };
    let square = drawing("square.svg", "M10 10h80v80h-80z");
    let angle = drawing("angle.svg", "M10 10h80v20h-60v60h-20z");
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(vec![square, angle]));
    window.wait();
    let path = folder.path().join("saved.morph");
    window.send(Intent::SaveTo(path.clone()));
    assert!(!window.session().is_dirty());
    let mut reopened = HeadlessWindow::new();
    reopened.send(Intent::Open(vec![path.clone()]));
    reopened.wait();
    let spec = reopened
        .session()
        .staged_segment()
        .expect("a film")
        .spec()
        .expect("settings");
    assert!(!spec.cached_match.is_none());
    assert!(
        spec.draft(&Silent).is_none(),
        "the saved match makes a draft unnecessary"
    );
    // After a change of settings the window searches for a new match, and saving stores that match.
    let before = std::fs::read_to_string(&path).expect("text");
    let mut project = reopened.session().project().cloned().expect("a project");
    project.options.arap.symmetric = false;
    reopened.send(Intent::ReplaceSettings(Box::new(project)));
    reopened.wait();
    reopened.send(Intent::Save);
    let saved_match = |text: &str| text.split("[found]").nth(1).map(str::to_owned);
    let after = std::fs::read_to_string(&path).expect("text");
    assert!(saved_match(&after).is_some() && saved_match(&after) != saved_match(&before));
}

/// File name that the save dialog suggests for the first gallery project.
fn suggested_name() -> String {
    format!("{}.morph", gallery_names().remove(0))
}

#[test]
fn saving_a_new_project_asks_for_a_file_and_confirms_where_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_change();
    window.send(Intent::Save);
    assert_eq!(
        open_dialog(&window),
        Some(DialogPurpose::Save(suggested_name()))
    );
    let path = folder.path().join("mine");
    choose(&mut window, &[&path]);
    let path = path.with_extension("morph");
    assert!(path.is_file() && !window.session().is_dirty());
    assert!(confirmations(&window).contains(&format!("Saved {}", path.display())));
    assert_eq!(open_dialog(&window), None);
    // Now that the project has a file, saving opens no dialog, and the next dialog starts in the
    // folder of the file.
    window.send(Intent::CyclePlayMode);
    window.send(Intent::Save);
    assert!(open_dialog(&window).is_none() && !window.session().is_dirty());
    window.send(Intent::AskOpen);
    let dialog: &FileDialogRequest = window.0.world().resource();
    assert_eq!(dialog.folder(), Some(folder.path()));
}

#[test]
fn the_save_dialog_opens_next_to_the_designs() {
    let [elsewhere, folder] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let files = ["a.json", "b.json"].map(|name| {
        let file = folder.path().join(name);
        std::fs::write(&file, "[[0,0],[4,0],[4,3],[0,3]]").expect("a file");
        file
    });
    let mut window = HeadlessWindow::with_gallery();
    // The folder chosen last is another one.
    window.send(Intent::AskOpen);
    choose(&mut window, &[&elsewhere.path().join("none.morph")]);
    window.send(Intent::Open(files.into()));
    window.wait();
    window.send(Intent::Save);
    let dialog: &FileDialogRequest = window.0.world().resource();
    assert!(matches!(dialog.purpose(), Some(DialogPurpose::Save(_))));
    assert_eq!(dialog.folder(), Some(folder.path()));
    choose(&mut window, &[]);
    window.send(Intent::AskOpen);
    let dialog: &FileDialogRequest = window.0.world().resource();
    assert_eq!(
        dialog.folder(),
        Some(elsewhere.path()),
        "a cancelled dialog does not change the folder chosen last"
    );
}

#[test]
fn cancelling_the_save_dialog_is_reported_and_cancels_closing() {
    let mut window = with_change();
    window.send(Intent::Close);
    window.send(Intent::AnswerUnsaved(UnsavedAnswer::Save));
    window.update();
    assert!(matches!(open_dialog(&window), Some(DialogPurpose::Save(_))));
    assert!(!choose(&mut window, &[]));
    assert!(reports_cancelled_save(&window));
    assert!(window.session().is_dirty());
    // Cancelling the dialog cancels the request to close: a later save leaves the window open.
    let folder = tempfile::tempdir().expect("a folder");
    window.send(Intent::SaveTo(folder.path().join("later.morph")));
    window.update();
    assert!(window.0.should_exit().is_none());
}

#[test]
fn closing_waits_for_the_save_and_an_error_keeps_the_window_open() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    std::fs::write(&file, "").expect("a file");
    let mut window = with_change();
    let mut close_and_save_to = |path: PathBuf| {
        window.send(Intent::Close);
        window.send(Intent::AnswerUnsaved(UnsavedAnswer::Save));
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
fn a_name_that_gets_the_extension_of_an_existing_file_does_not_overwrite_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let taken = folder.path().join("taken.morph");
    std::fs::write(&taken, "precious").expect("a file");
    let mut window = with_change();
    window.send(Intent::SaveAs);
    choose(&mut window, &[&folder.path().join("taken")]);
    assert_eq!(std::fs::read_to_string(&taken).expect("text"), "precious");
    assert!(window.problems()[0].contains("taken.morph"));
    assert_eq!(
        open_dialog(&window),
        Some(DialogPurpose::Save("taken.morph".into()))
    );
    // If the user selects the existing file itself, it is replaced.
    choose(&mut window, &[&taken]);
    assert!(!window.session().is_dirty() && window.problems().is_empty());
    assert_ne!(std::fs::read_to_string(&taken).expect("text"), "precious");
}

#[test]
fn the_file_selected_in_the_dialog_is_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.morph");
    let mut window = with_change();
    window.send(Intent::SaveTo(path.clone()));
    let mut reopened = HeadlessWindow::new();
    reopened.send(Intent::SaveAs);
    assert_eq!(open_dialog(&reopened), None, "there is nothing to save");
    reopened.send(Intent::AskOpen);
    assert_eq!(open_dialog(&reopened), Some(DialogPurpose::Open));
    choose(&mut reopened, &[&path]);
    reopened.wait();
    assert_eq!(reopened.session().path(), Some(path.as_path()));
}

/// While the file dialog is open, it receives all keys.
#[test]
fn escape_cancels_the_dialog_and_enter_accepts_its_suggestion() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = HeadlessWindow::with_panels();
    window.send(Intent::SaveTo(folder.path().join("first.morph")));
    let press = |window: &mut HeadlessWindow, code: KeyCode, key: Key| {
        // The dialog reads its folder in the background before it reacts to keys.
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
    assert_eq!(open_dialog(&window), None);
    assert!(reports_cancelled_save(&window));
    window.send(Intent::SaveAs);
    press(&mut window, KeyCode::Enter, Key::Enter);
    // A file with the suggested name exists, so the dialog asks whether to replace it; Enter
    // confirms.
    press(&mut window, KeyCode::Enter, Key::Enter);
    assert_eq!(open_dialog(&window), None);
    let is_saved = |text: &String| text.ends_with("first.morph");
    assert!(confirmations(&window).iter().any(is_saved));
}

/// Waits until the running export has ended.
fn wait_for_export(window: &mut HeadlessWindow) {
    while window.0.world().resource::<FilmExporter>().work().is_some() {
        std::thread::sleep(std::time::Duration::from_millis(1));
        window.update();
    }
    window.update();
}

/// Opens a window with a short, small film, saved as `mine.morph` in a folder.
fn window_with_short_film(folder: &Path) -> HeadlessWindow {
    let mut window = HeadlessWindow::with_gallery();
    let mut project = window.session().project().cloned().expect("a project");
    project.timing.duration_secs = 0.1;
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window.send(Intent::SaveTo(folder.join("mine.morph")));
    let mut preferences = *window.preferences();
    preferences.film.layout.lines = 32;
    window.send(Intent::SetPreferences(preferences));
    window
}

#[test]
fn an_export_asks_for_folder_and_name_and_remembers_the_folder() {
    let [designs, other] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let mut window = window_with_short_film(designs.path());
    let folder = |window: &HeadlessWindow| {
        let dialog = window.0.world().resource::<FileDialogRequest>();
        dialog.folder().map(Path::to_owned)
    };
    window.type_char(KeyCode::KeyG, "g");
    window.update();
    let film = DialogPurpose::Export(ExportKind::Film, "mine.gif".to_owned());
    assert_eq!(open_dialog(&window), Some(film));
    assert_eq!(
        folder(&window).as_deref(),
        Some(designs.path()),
        "next to the project"
    );
    choose(&mut window, &[]);
    let is_running = window.0.world().resource::<FilmExporter>().work().is_some();
    assert!(!is_running, "cancelled");
    window.send(Intent::AskExport(ExportKind::Film));
    // The extension is added, and decides the file type if there is one.
    choose(&mut window, &[&other.path().join("first")]);
    wait_for_export(&mut window);
    assert_eq!(window.problems(), Vec::<String>::new());
    assert!(other.path().join("first.gif").is_file());
    window.send(Intent::AskExport(ExportKind::Film));
    assert_eq!(
        folder(&window).as_deref(),
        Some(other.path()),
        "the last folder"
    );
    choose(&mut window, &[&other.path().join("second.apng")]);
    wait_for_export(&mut window);
    assert!(other.path().join("second.apng").is_file());
}

#[test]
fn an_export_replaces_only_a_file_that_was_selected() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = window_with_short_film(folder.path());
    let file = folder.path().join("first.gif");
    std::fs::write(&file, "old").expect("written");
    let is_old = || std::fs::read(&file).expect("a file") == b"old";
    let unselected = folder.path().join("first");
    window.send(Intent::Export(ExportKind::Film, unselected));
    wait_for_export(&mut window);
    assert!(is_old() && folder.path().join("first-2.gif").is_file());
    window.send(Intent::Export(ExportKind::Film, file.clone()));
    wait_for_export(&mut window);
    assert!(!is_old());
}

#[test]
fn a_preset_stores_the_export_folder() {
    let [first, second] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let mut window = HeadlessWindow::with_gallery();
    let set_folder = |window: &mut HeadlessWindow, folder: &Path| {
        let mut chosen = window.0.world_mut().resource_mut::<CaptureFolder>();
        chosen.choose(folder);
    };
    set_folder(&mut window, first.path());
    window.send(Intent::SavePreset("talk".to_owned()));
    set_folder(&mut window, second.path());
    window.send(Intent::UsePreset("talk".to_owned()));
    window.send(Intent::AskExport(ExportKind::Film));
    let dialog: &FileDialogRequest = window.0.world().resource();
    assert_eq!(dialog.folder(), Some(first.path()));
}

/// Whether the window asks about a file that was changed elsewhere.
fn asks_about_conflict(window: &HeadlessWindow) -> bool {
    window.0.world().resource::<ConflictQuestion>().is_open()
}

/// Two windows with the same project file, which the second has changed since the first opened it;
/// also returns the text of the file. The project of the first window has unsaved changes.
fn window_with_conflict(path: &Path) -> (HeadlessWindow, String) {
    with_change().send(Intent::SaveTo(path.to_owned()));
    let mut windows = [(); 2].map(|()| {
        let mut window = HeadlessWindow::new();
        window.send(Intent::Open(vec![path.to_owned()]));
        window.wait();
        window.send(Intent::CyclePlayMode);
        window
    });
    windows[1].send(Intent::CyclePlayMode);
    windows[1].send(Intent::Save);
    assert!(!asks_about_conflict(&windows[1]) && !windows[1].session().is_dirty());
    let [mut window, _] = windows;
    window.send(Intent::Save);
    assert!(asks_about_conflict(&window) && window.session().is_dirty());
    (window, std::fs::read_to_string(path).expect("text"))
}

#[test]
fn a_file_that_another_window_changed_is_replaced_only_if_the_user_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.morph");
    let (mut window, theirs) = window_with_conflict(&path);
    let text = || std::fs::read_to_string(&path).expect("text");
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!asks_about_conflict(&window) && reports_cancelled_save(&window));
    assert_eq!(text(), theirs);
    window.send(Intent::Save);
    window.send(Intent::AnswerConflict(ConflictAnswer::Overwrite));
    window.update();
    assert!(!asks_about_conflict(&window) && !window.session().is_dirty());
    assert_ne!(text(), theirs);
    // The file is now the one that this window saved.
    window.send(Intent::CyclePlayMode);
    window.send(Intent::Save);
    assert!(!asks_about_conflict(&window) && !window.session().is_dirty());
}

#[test]
fn the_version_of_another_window_can_be_opened_instead() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.morph");
    let (mut window, theirs) = window_with_conflict(&path);
    let mine = window.session().timing().play;
    window.send(Intent::AnswerConflict(ConflictAnswer::Reload));
    window.wait();
    assert!(!window.session().is_dirty());
    assert_ne!(window.session().timing().play, mine);
    assert_eq!(std::fs::read_to_string(&path).expect("text"), theirs);
}

#[test]
fn a_conflicting_version_can_be_saved_in_another_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.morph");
    let (mut window, theirs) = window_with_conflict(&path);
    window.send(Intent::AnswerConflict(ConflictAnswer::SaveAs));
    window.update();
    let other = folder.path().join("other.morph");
    choose(&mut window, &[&other]);
    assert_eq!(window.session().path(), Some(other.as_path()));
    assert!(other.is_file() && !window.session().is_dirty());
    assert_eq!(std::fs::read_to_string(&path).expect("text"), theirs);
}

#[test]
fn closing_waits_for_the_answer_about_a_changed_file() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, answer, is_replaced) in [
        ("a.morph", ConflictAnswer::Overwrite, true),
        ("b.morph", ConflictAnswer::Reload, false),
    ] {
        let path = folder.path().join(name);
        let (mut window, theirs) = window_with_conflict(&path);
        window.send(Intent::AnswerConflict(ConflictAnswer::Cancel));
        window.send(Intent::Close);
        window.send(Intent::AnswerUnsaved(UnsavedAnswer::Save));
        window.update();
        assert!(asks_about_conflict(&window) && window.0.should_exit().is_none());
        window.send(Intent::AnswerConflict(answer));
        let mut updates = 0;
        while window.0.should_exit().is_none() && updates < 5 {
            window.update();
            updates += 1;
        }
        assert!(window.0.should_exit().is_some(), "{answer:?}");
        let is_theirs = std::fs::read_to_string(&path).expect("text") == theirs;
        assert_eq!(is_theirs, !is_replaced);
    }
}

#[test]
fn the_question_about_a_changed_file_closes_when_another_project_is_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let paths = ["mine.morph", "other.morph"].map(|name| folder.path().join(name));
    with_change().send(Intent::SaveTo(paths[1].clone()));
    let (mut window, theirs) = window_with_conflict(&paths[0]);
    let other = std::fs::read_to_string(&paths[1]).expect("text");
    window.send(Intent::Open(vec![paths[1].clone()]));
    window.send(Intent::AnswerUnsaved(UnsavedAnswer::Discard));
    window.wait();
    window.update();
    assert_eq!(window.session().path(), Some(paths[1].as_path()));
    assert!(!asks_about_conflict(&window));
    window.send(Intent::AnswerConflict(ConflictAnswer::Overwrite));
    window.update();
    let texts = paths.map(|path| std::fs::read_to_string(path).expect("text"));
    assert_eq!(texts, [theirs, other]);
}

#[test]
fn a_touched_or_deleted_file_raises_no_question() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.morph");
    let mut window = with_change();
    window.send(Intent::SaveTo(path.clone()));
    let bytes = std::fs::read(&path).expect("a file");
    std::fs::write(&path, bytes).expect("written again");
    window.send(Intent::CyclePlayMode);
    window.send(Intent::Save);
    assert!(!asks_about_conflict(&window) && !window.session().is_dirty());
    std::fs::remove_file(&path).expect("there");
    window.send(Intent::CyclePlayMode);
    window.send(Intent::Save);
    assert!(!asks_about_conflict(&window) && path.is_file());
}

#[cfg(unix)]
#[test]
fn a_project_with_non_utf8_names_is_saved_and_opened() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &[u8]| folder.path().join(std::ffi::OsStr::from_bytes(name));
    let files = [path(b"a\xe9.json"), path(b"b%20\xff.json")];
    for file in &files {
        std::fs::write(file, "[[0,0],[4,0],[4,3],[0,3]]").expect("a file");
    }
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(files.to_vec()));
    window.wait();
    let project = path(b"\xe9.morph");
    window.send(Intent::SaveTo(project.clone()));
    assert_eq!(window.problems(), Vec::<String>::new());
    let mut reopened = HeadlessWindow::new();
    reopened.send(Intent::Open(vec![project]));
    reopened.wait();
    assert_eq!(reopened.session().files(), files);
}
