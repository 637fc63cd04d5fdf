//! Tests that figures of the code and its prose stay within the bounds in `budget.toml`: lines of
//! code, numeric constants, repeated type names, import cycles between folders, length of the
//! README, and words that plain language avoids. `cargo test --test budget -- --nocapture` prints
//! every figure.
#![expect(clippy::print_stdout, reason = "every figure is printed")]

mod source;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use source::production::ProductionCode;
use source::uses::{Crate, Names, Uses, reachable};
use source::{
    files_below, lines_outside_code, pages, parse, read, root, rust_files, source_folder,
};
use syn::visit::{self, Visit};

/// Contents of `budget.toml`: upper bounds on the figures.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Budget {
    production_lines: usize,
    #[serde(rename = "constants-per-1000-lines")]
    constants_per_1000_lines: f64,
    folder_cycles: usize,
    readme_lines: usize,
    readme_bytes: usize,
    language: LanguageBudget,
}

/// Upper bounds on the occurrences of words per 1,000 lines of prose.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct LanguageBudget {
    what_clauses: f64,
    told: f64,
    beside: f64,
    nobody_somebody: f64,
}

fn budget() -> Budget {
    toml::from_str(&read(&root().join("budget.toml"))).expect("a budget")
}

/// Prints a figure and asserts that it does not exceed its bound.
fn assert_within(name: &str, figure: f64, bound: f64) {
    println!("{name}: {figure:.2} (at most {bound})");
    assert!(
        figure <= bound,
        "{name}: {figure:.2}, but at most {bound} are allowed by budget.toml"
    );
}

/// Whether a file below `src` holds tests only: `tests.rs`, `testing.rs`, or a file in a folder of
/// one of these names.
fn is_test_file(file: &Path) -> bool {
    let inside = file
        .strip_prefix(source_folder())
        .unwrap_or(file)
        .with_extension("");
    inside
        .iter()
        .any(|part| part == "tests" || part == "testing")
}

#[test]
fn production_lines_and_constants_stay_within_the_budget() {
    let budget = budget();
    let (mut lines, mut constants) = (0, 0);
    for file in rust_files().iter().filter(|file| !is_test_file(file)) {
        let code = ProductionCode::read(file);
        lines += code.lines;
        constants += code.constants.iter().filter(|c| c.is_numeric).count();
    }
    assert_within(
        "production lines",
        lines as f64,
        budget.production_lines as f64,
    );
    let per_1000 = 1000.0 * constants as f64 / lines as f64;
    assert_within(
        "constants per 1,000 lines",
        per_1000,
        budget.constants_per_1000_lines,
    );
}

/// Names of all types that a file defines, including those in test code.
#[derive(Default)]
struct TypeNames(Vec<String>);

impl<'ast> Visit<'ast> for TypeNames {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let name = match item {
            syn::Item::Struct(item) => Some(&item.ident),
            syn::Item::Enum(item) => Some(&item.ident),
            syn::Item::Trait(item) => Some(&item.ident),
            syn::Item::Type(item) => Some(&item.ident),
            syn::Item::Union(item) => Some(&item.ident),
            _ => None,
        };
        self.0.extend(name.map(ToString::to_string));
        visit::visit_item(self, item);
    }
}

#[test]
fn type_names_are_used_once() {
    let mut files_of: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for file in rust_files() {
        let mut names = TypeNames::default();
        names.visit_file(&parse(&file));
        for name in names.0 {
            files_of.entry(name).or_default().push(file.clone());
        }
    }
    files_of.retain(|_, files| files.len() > 1);
    assert!(
        files_of.is_empty(),
        "type names used more than once: {files_of:#?}"
    );
}

/// Lists the uses between entries of a folder that are part of a cycle of uses. An entry is a file,
/// or a subfolder with all its files.
fn folder_cycles(uses: &Uses<'_>) -> Vec<String> {
    let mut graphs: BTreeMap<PathBuf, NeighbourGraph> = BTreeMap::new();
    for (from, used) in uses {
        for (to, name) in used {
            if let Some((parent, [a, b])) = neighbours(from, to) {
                let edges = graphs.entry(parent).or_default().entry(a).or_default();
                edges.insert(b, name.clone());
            }
        }
    }
    let mut cycles = Vec::new();
    for (parent, graph) in &graphs {
        for (a, edges) in graph {
            let back = edges
                .iter()
                .filter(|(b, _)| reachable(graph, b).contains(a));
            cycles
                .extend(back.map(|(b, name)| format!("{}: {a} -> {b}: {name}", parent.display())));
        }
    }
    cycles
}

/// For each entry of a folder: the entries that it uses, each with a path in the code that refers
/// to it.
type NeighbourGraph = BTreeMap<String, BTreeMap<String, String>>;

/// Finds where the paths of two files part. Returns the deepest folder that contains both, and, for
/// each file, the name of the entry of this folder that is or contains the file. A folder `a/` and
/// the file `a.rs` that declares its modules are one entry. `None` if both files belong to one
/// entry, so that their paths do not part.
fn neighbours(from: &Path, to: &Path) -> Option<(PathBuf, [String; 2])> {
    let [a, b] = [from, to].map(|file| -> Names {
        let file = file.with_extension("");
        let parts = file.components();
        parts
            .map(|part| part.as_os_str().to_string_lossy().into_owned())
            .collect()
    });
    let shared = a.iter().zip(&b).take_while(|(x, y)| x == y).count();
    let entries = [a.get(shared)?.clone(), b.get(shared)?.clone()];
    Some((a[..shared].iter().collect(), entries))
}

#[test]
fn folders_have_no_cycles() {
    let cycles = folder_cycles(&Crate::read(&source_folder()).uses());
    let bound = budget().folder_cycles as f64;
    for cycle in &cycles {
        println!("{cycle}");
    }
    assert_within("folder cycles", cycles.len() as f64, bound);
}

#[test]
fn the_readme_is_short() {
    let budget = budget();
    let text = read(&root().join("README.md"));
    assert_within(
        "README lines",
        text.lines().count() as f64,
        budget.readme_lines as f64,
    );
    assert_within(
        "README bytes",
        text.len() as f64,
        budget.readme_bytes as f64,
    );
}

/// Returns the lines of prose of a file: the comment lines of a Rust file, the lines outside code
/// blocks of a Markdown file.
fn prose(file: &Path) -> Vec<String> {
    let text = read(file);
    if file.extension().is_some_and(|extension| extension == "rs") {
        let comments = text.lines().map(str::trim_start);
        let comments = comments.filter(|line| line.starts_with("//"));
        return comments
            .map(|line| line.trim_start_matches(['/', '!']).trim().to_owned())
            .collect();
    }
    let lines = lines_outside_code(&text).filter(|line| !line.trim().is_empty());
    lines.map(str::to_owned).collect()
}

/// Number of clauses in a line that open with "What", as in "What comes or goes".
fn what_clauses(line: &str) -> usize {
    let lower = line.to_lowercase();
    let before_and_after = lower.match_indices("what").filter(|(at, word)| {
        let before = lower[..*at].trim_end();
        let is_whole = lower[at + word.len()..].starts_with([' ', ',']);
        is_whole && (before.is_empty() || before.ends_with(['.', ';', ':', ',', '(', '|', '-']))
    });
    before_and_after.count()
}

fn words<'a>(line: &'a str, wanted: &'a [&'a str]) -> usize {
    let words = line.split(|c: char| !c.is_alphabetic());
    words
        .filter(|word| wanted.contains(&word.to_lowercase().as_str()))
        .count()
}

/// All files with prose: Rust code, README and docs.
fn prose_files() -> Vec<PathBuf> {
    let folders = ["src", "tests", "benches", "examples"];
    let code = folders
        .iter()
        .flat_map(|name| files_below(&root().join(name), "rs"));
    code.chain(pages()).collect()
}

#[test]
fn prose_is_plain_english() {
    let budget = budget();
    let mut lines = 0;
    let mut counts = [0; 4];
    for file in prose_files() {
        for line in prose(&file) {
            lines += 1;
            let found = [
                what_clauses(&line),
                words(&line, &["told"]),
                words(&line, &["beside"]),
                words(&line, &["nobody", "somebody"]),
            ];
            if found.iter().any(|&n| n > 0) {
                let inside = file.strip_prefix(root()).unwrap_or(&file);
                println!("{}: {line}", inside.display());
            }
            for (count, n) in counts.iter_mut().zip(found) {
                *count += n;
            }
        }
    }
    let language = &budget.language;
    let bounds = [
        ("clauses that open with \"What\"", language.what_clauses),
        ("told", language.told),
        ("beside", language.beside),
        ("nobody, somebody", language.nobody_somebody),
    ];
    for ((name, bound), count) in bounds.into_iter().zip(counts) {
        assert_within(
            &format!("{name} per 1,000 lines"),
            1000.0 * count as f64 / lines as f64,
            bound,
        );
    }
}
