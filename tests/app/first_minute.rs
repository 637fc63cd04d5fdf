//! Tests of the first minute with the program: the invitation to open files, the gallery project
//! that plays meanwhile, when the invitation closes, and which films play as soon as they are
//! opened.

use std::path::{Path, PathBuf};

use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::Entity;
use bevy::window::FileDragAndDrop;
use morphospace::app::testing::{Intent, Invitation, RecoveryAnswer, START_PROJECT, StageArea};

use crate::headless_window::HeadlessWindow;
use crate::hidden_panels::{overlay, with_overlay_record};

/// Headline of the invitation.
const HEADLINE: &str = "Drop two or more files here";

/// A window as it is after the program starts without files: with the invitation.
fn started() -> HeadlessWindow {
    let mut window = HeadlessWindow::new();
    window.send(Intent::Welcome);
    window
}

fn is_invited(window: &HeadlessWindow) -> bool {
    window.0.world().resource::<Invitation>().is_shown()
}

/// Writes `count` files with rectangles of width 1, 2, …; returns their paths.
fn rectangles(folder: &Path, count: usize) -> Vec<PathBuf> {
    let file = |k: usize| {
        let path = folder.join(format!("r{k}.json"));
        let ring = format!("[[0,0],[{k},0],[{k},3],[0,3]]");
        std::fs::write(&path, ring).expect("a file");
        path
    };
    (1..=count).map(file).collect()
}

#[test]
fn without_files_a_gallery_project_plays_next_to_the_invitation() {
    let mut window = started();
    assert!(is_invited(&window));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    assert_eq!(window.session().gallery_name(), Some(START_PROJECT));
    assert!(window.playback().is_playing());
    let before = window.t();
    // The film may just pause at one of its ends.
    let moves = (0..200).any(|_| {
        window.update();
        window.t() != before
    });
    assert!(moves, "t stays {before}");
    assert!(
        is_invited(&window),
        "it stays until the user does something"
    );
}

#[test]
fn the_invitation_closes_when_anything_is_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let files = rectangles(folder.path(), 2);
    for intent in [
        Intent::Open(files.clone()),
        Intent::Open(vec!["saved.morph".into()]),
        Intent::OpenGallery("letters".to_owned()),
        Intent::PlayGallery("letters".to_owned()),
        Intent::AnswerRecovery(RecoveryAnswer::Restore),
        Intent::CloseInvitation,
    ] {
        let mut window = started();
        window.send(intent.clone());
        assert!(!is_invited(&window), "{intent:?}");
    }
    let mut window = started();
    for path_buf in files {
        let drop = FileDragAndDrop::DroppedFile {
            window: Entity::PLACEHOLDER,
            path_buf,
        };
        window.0.world_mut().write_message(drop);
    }
    // The drop is read in the first frame; its files are opened in the same frame or the next.
    (0..2).for_each(|_| window.update());
    assert!(!is_invited(&window), "dropped files");
}

#[test]
fn a_cancelled_dialog_leaves_the_invitation_open() {
    let mut window = started();
    window.send(Intent::AskOpen);
    window.send(Intent::AnswerDialog(Vec::new()));
    window.update();
    assert!(is_invited(&window));
}

#[test]
fn escape_closes_the_invitation_before_it_cancels_any_work() {
    let mut window = started();
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!is_invited(&window));
    window.wait();
    assert_eq!(window.session().gallery_name(), Some(START_PROJECT));
    assert!(window.playback().is_playing(), "the film goes on");
}

#[test]
fn a_single_design_opened_from_the_invitation_is_not_added_to_the_example() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = started();
    window.wait();
    let file = rectangles(folder.path(), 1).remove(0);
    window.send(Intent::Open(vec![file.clone()]));
    window.wait();
    assert_eq!(window.session().gallery_name(), Some(START_PROJECT));
    assert!(is_invited(&window), "the question comes first");
    window.send(Intent::OpenAlone(file));
    window.wait();
    assert!(!is_invited(&window));
    assert_eq!(window.session().gallery_name(), None);
    let designs = window.session().all_designs();
    let names: Vec<&str> = designs.iter().map(|design| design.name.as_str()).collect();
    assert_eq!(names, ["r1", "r1"], "it is its own partner");
}

#[test]
fn three_designs_play_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(rectangles(folder.path(), 3)));
    window.wait();
    assert_eq!(window.session().segment_count(), 2);
    assert!(window.playback().is_playing());
    window.send(Intent::TogglePlay);
    window.wait();
    assert!(!window.playback().is_playing(), "a pause is not overridden");
}

#[test]
fn a_gallery_picture_plays_and_the_same_project_opened_by_name_does_not() {
    let mut window = HeadlessWindow::new();
    let name = "triangle-polar".to_owned();
    window.send(Intent::PlayGallery(name.clone()));
    window.wait();
    assert!(window.playback().is_playing());
    window.send(Intent::OpenGallery(name));
    window.wait();
    assert!(!window.playback().is_playing());
}

#[test]
fn the_card_is_drawn_below_the_film_until_it_is_closed() {
    let stage_height = |window: &HeadlessWindow| window.0.world().resource::<StageArea>().size.y;
    let mut window = with_overlay_record();
    assert!(!overlay(&mut window).has_text(HEADLINE));
    window.send(Intent::Welcome);
    for text in [HEADLINE, "SVG, DXF, PNG", "Open …"] {
        assert!(overlay(&mut window).has_text(text), "{text}");
    }
    let height_above_card = stage_height(&window);
    // Hiding the panels hides the invitation as well.
    window.type_char(KeyCode::KeyH, "h");
    assert_eq!(overlay(&mut window).shape_count, 0);
    window.type_char(KeyCode::KeyH, "h");
    assert!(overlay(&mut window).has_text(HEADLINE));
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!overlay(&mut window).has_text(HEADLINE));
    let height = stage_height(&window);
    assert!(height_above_card < height, "the film lies above the card");
    assert!(height_above_card > 0.4 * height, "the film stays large");
}

#[test]
fn the_chosen_method_is_named_and_the_table_is_folded_away() {
    let mut window = with_overlay_record();
    let shown = overlay(&mut window);
    for text in ["Rigid parts", "Choose the best method", "Advanced"] {
        assert!(shown.has_text(text), "{text}");
    }
    assert!(!shown.has_text("Carried by lattice"));
}
