//! Tests of files that are made to keep the program busy: Esc ends reading them, and the window can
//! open other files afterwards.

use crate::endless_fonts::{nested_components, nested_subroutines};
use crate::headless_window::HeadlessWindow;
use bevy::input::keyboard::{Key, KeyCode};
use morphospace::app::testing::Intent;
use std::fs;
use std::path::{Path, PathBuf};

/// Number of updates between opening a file and pressing Esc (heuristic: some files are still being
/// read, others are refused).
const UPDATES: u32 = 30;

/// Writes a file into a folder and returns its path.
fn write(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).expect("written");
    path
}

/// Writes a project with more texts than there are workers that could read them, in fonts whose
/// letter takes practically forever to draw.
fn endless_letters(folder: &Path) -> PathBuf {
    write(folder, "components.ttf", nested_components(30));
    write(folder, "subroutines.otf", nested_subroutines(9, 200));
    let designs: String = ["components.ttf", "subroutines.otf"]
        .iter()
        .flat_map(|font| (1..=8).map(move |count| ("A".repeat(count), font)))
        .map(|(letters, font)| format!("[[designs]]\npath = \"glyph:{letters}@{font}\"\n"))
        .collect();
    write(folder, "letters.morph", format!("version = 2\n{designs}"))
}

#[test]
fn other_files_open_after_hostile_ones_were_cancelled() {
    let temporary = tempfile::tempdir().expect("a folder");
    let folder = temporary.path();
    let square = write(folder, "square.json", "[[0,0],[15,0],[15,15],[0,15]]");
    let slanted = write(folder, "slanted.json", "[[0,0],[15,0],[19,15],[0,15]]");
    let tiny_edges = write(
        folder,
        "edges.morph",
        "version = 1\n[[designs]]\npath = \"square.json\"\n[[designs]]\npath = \"slanted.json\"\n[triangulation]\nedge-length = 1e-300\n",
    );
    let distant = write(
        folder,
        "distant.json",
        "[[1e9,1e9],[1000000001,1e9],[1000000001.25,1000000001],[1e9,1000000001]]",
    );
    let mut window = HeadlessWindow::new();
    for hostile in [
        vec![endless_letters(folder)],
        vec![tiny_edges],
        vec![square.clone(), distant],
    ] {
        window.send(Intent::Open(hostile.clone()));
        for _ in 0..UPDATES {
            window.update();
        }
        window.press(KeyCode::Escape, Key::Escape);
        window.wait();
        window.send(Intent::Open(vec![square.clone(), slanted.clone()]));
        window.wait();
        let transition = window.session().transition().expect("a transition");
        let names = transition
            .designs()
            .each_ref()
            .map(|design| design.name.clone());
        assert_eq!(
            names,
            ["square", "slanted"],
            "{hostile:?}: {:?}",
            window.problems()
        );
    }
}
