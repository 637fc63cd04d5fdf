//! The project's own source code and documentation as input of tests.
//!
//! - `production`: the code of a file that is not a test, and its constants
//! - `uses`: which file uses which
#![allow(dead_code, reason = "each of the tests needs only a part")]

pub mod production;
pub mod uses;

use std::fs;
use std::path::{Path, PathBuf};

/// Root folder of the repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The folder `src`.
pub fn source_folder() -> PathBuf {
    root().join("src")
}

/// Reads a file as text.
pub fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Parses a Rust file.
pub fn parse(path: &Path) -> syn::File {
    syn::parse_file(&read(path)).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Paths of all files with an extension below a folder, sorted.
pub fn files_below(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|found| found == extension) {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

/// Paths of all Rust files of the crate.
pub fn rust_files() -> Vec<PathBuf> {
    files_below(&source_folder(), "rs")
}

/// Paths of the Markdown files at the root, such as the README, and of all pages below `docs`.
pub fn pages() -> Vec<PathBuf> {
    let at_root = fs::read_dir(root()).expect("the root").flatten();
    let at_root = at_root.map(|entry| entry.path());
    let mut pages: Vec<PathBuf> = at_root
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .collect();
    pages.extend(files_below(&root().join("docs"), "md"));
    pages.sort();
    pages
}

/// Lines of a Markdown page that are outside code blocks.
pub fn lines_outside_code(page: &str) -> impl Iterator<Item = &str> {
    let mut in_code = false;
    page.lines().filter(move |line| {
        let is_fence = line.starts_with("```");
        in_code ^= is_fence;
        !in_code && !is_fence
    })
}
