//! Tests of files that are made to keep the program busy: Esc ends reading them, and the window can
//! open other files afterwards.

use crate::endless_fonts::{nested_components, nested_subroutines};
use crate::headless_window::HeadlessWindow;
use bevy::input::keyboard::{Key, KeyCode};
use morphospace::app::testing::Intent;
use std::fs;
use std::path::PathBuf;

/// Number of updates between opening a file and pressing Esc (heuristic: some files are still being
/// read, others are refused).
const UPDATES: u32 = 30;

#[test]
fn other_files_open_after_hostile_ones_were_cancelled() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, bytes: &[u8]| -> PathBuf {
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("written");
        path
    };
    let square = write("square.json", b"[[0,0],[15,0],[15,15],[0,15]]");
    let slanted = write("slanted.json", b"[[0,0],[15,0],[19,15],[0,15]]");
    write("components.ttf", &nested_components(30));
    write("subroutines.otf", &nested_subroutines(9, 200));
    // More designs than there are workers that could read them.
    let letters: String = ["components.ttf", "subroutines.otf"]
        .iter()
        .flat_map(|font| (1..=8).map(move |count| ("A".repeat(count), font)))
        .map(|(letters, font)| format!("[[designs]]\npath = \"glyph:{letters}@{font}\"\n"))
        .collect();
    let letters = write(
        "letters.morph",
        format!("version = 2\n{letters}").as_bytes(),
    );
    let tiny_edges = write(
        "edges.morph",
        b"version = 1\n[[designs]]\npath = \"square.json\"\n[[designs]]\npath = \"slanted.json\"\n[triangulation]\nedge-length = 1e-300\n",
    );
    let distant = write(
        "distant.json",
        b"[[1e9,1e9],[1000000001,1e9],[1000000001.25,1000000001],[1e9,1000000001]]",
    );
    let mut window = HeadlessWindow::new();
    for hostile in [
        vec![letters],
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
