//! Tests that the imports of the code agree with the list of layers in `src/lib.rs`: each top-level
//! module is listed once and uses only modules above it in the list. Also tests that no files use
//! each other in a cycle (`budget.rs` tests this for folders).

mod source;

use std::path::Path;

use source::uses::{Crate, Names, reachable};
use source::{read, source_folder};

/// Names of the modules in the list of layers in `lib.rs`, from the top.
fn layers() -> Names {
    let text = read(&source_folder().join("lib.rs"));
    let (_, text) = text.split_once("//! # Layers").expect("a list of layers");
    let (_, text) = text.split_once("```text\n").expect("its beginning");
    let (text, _) = text.split_once("//! ```").expect("its end");
    let modules = text.lines().flat_map(|line| {
        let line = line.trim_start_matches("//! ");
        // A line begins with one or more names; the description begins at column 30.
        let names = line.get(..30).unwrap_or(line);
        let names = names.split('(').next().unwrap_or(names);
        names.split([',', ' ']).map(str::to_owned)
    });
    modules.filter(|name| !name.is_empty()).collect()
}

/// Name of the top-level module that contains a file; `None` for `lib.rs`.
fn top_module(file: &Path) -> Option<String> {
    let inside = file
        .strip_prefix(source_folder())
        .expect("a file of the crate");
    let first = inside.components().next()?.as_os_str();
    let name = Path::new(first).with_extension("");
    Some(name.to_string_lossy().into_owned()).filter(|name| name != "lib")
}

#[test]
fn every_module_is_in_the_list_once() {
    let mut layers = layers();
    layers.sort();
    let parsed = Crate::read(&source_folder());
    let top = parsed.0.keys().filter(|path| path.len() == 1);
    assert_eq!(layers, top.map(|path| path[0].clone()).collect::<Names>());
}

#[test]
fn modules_use_only_modules_above_them() {
    let parsed = Crate::read(&source_folder());
    let layers = layers();
    let height = |name: &String| layers.iter().position(|layer| layer == name);
    let mut downward = Vec::new();
    for (from, uses) in parsed.uses() {
        for (to, name) in uses {
            let [Some(below), Some(above)] = [from, to].map(top_module) else {
                continue;
            };
            if below != above && height(&above) >= height(&below) {
                downward.push(format!("{} uses {name}", from.display()));
            }
        }
    }
    assert!(
        downward.is_empty(),
        "imports that go down:\n{}",
        downward.join("\n")
    );
}

/// Path of a file relative to `src`.
fn short(file: &Path) -> String {
    let inside = file.strip_prefix(source_folder()).unwrap_or(file);
    inside.display().to_string()
}

#[test]
fn no_files_use_each_other_in_a_cycle() {
    let parsed = Crate::read(&source_folder());
    let uses = parsed.uses();
    let mut cyclic = Vec::new();
    for (from, to) in &uses {
        let back = to
            .iter()
            .filter(|(to, _)| reachable(&uses, to).contains(from));
        cyclic.extend(back.map(|(to, name)| format!("{} -> {}: {name}", short(from), short(to))));
    }
    assert!(cyclic.is_empty(), "files in cycles:\n{}", cyclic.join("\n"));
}
