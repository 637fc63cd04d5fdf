//! Tests that figures of the code and its prose stay within the bounds in `budget.toml`: lines of
//! code, numeric constants, repeated type names, import cycles between folders, length of the
//! README, and words that plain language avoids. `cargo test --test budget -- --nocapture` prints
//! every figure.
#![expect(clippy::print_stdout, reason = "every figure is printed")]

#[path = "source/files.rs"]
mod files;
#[path = "source/uses.rs"]
mod uses;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use files::{files_below, folder};
use proc_macro2::Span;
use serde::Deserialize;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use uses::{Crate, Names, Uses, is_test};

/// Contents of `budget.toml`: upper bounds on the figures, and exemptions from them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Budget {
    production_lines: usize,
    #[serde(rename = "constants-per-1000-lines")]
    constants_per_1000_lines: f64,
    repeated_type_names: usize,
    folder_cycles: usize,
    readme_lines: usize,
    readme_bytes: usize,
    language: LanguageBudget,
    language_exempt: LanguageExemption,
    repeated: BTreeMap<String, String>,
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

/// Files and folders below `src` whose wording is exempt from [`LanguageBudget`].
#[derive(Deserialize)]
struct LanguageExemption {
    paths: Vec<PathBuf>,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn budget() -> Budget {
    let text = fs::read_to_string(root().join("budget.toml")).expect("budget.toml");
    toml::from_str(&text).expect("a budget")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Prints a figure and asserts that it does not exceed its bound.
fn hold(name: &str, figure: f64, bound: f64) {
    println!("{name}: {figure:.2} (at most {bound})");
    assert!(
        figure <= bound,
        "{name}: {figure:.2}, but at most {bound} are allowed by budget.toml"
    );
}

/// Line numbers of a file's test code, and the number of numeric constants in its other code.
#[derive(Default)]
struct ProductionCode {
    test_lines: BTreeSet<usize>,
    constants: usize,
}

impl ProductionCode {
    fn exclude(&mut self, span: Span) {
        self.test_lines.extend(span.start().line..=span.end().line);
    }
}

fn is_numeric(ty: &syn::Type) -> bool {
    const NUMERIC: [&str; 13] = [
        "f32", "f64", "u8", "u16", "u32", "u64", "u128", "usize", "i8", "i16", "i32", "i64",
        "isize",
    ];
    matches!(ty, syn::Type::Path(path) if NUMERIC.iter().any(|name| path.path.is_ident(name)))
}

impl<'ast> Visit<'ast> for ProductionCode {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let attributes = match item {
            syn::Item::Mod(item) => &item.attrs,
            syn::Item::Fn(item) => &item.attrs,
            syn::Item::Use(item) => &item.attrs,
            syn::Item::Impl(item) => &item.attrs,
            syn::Item::Struct(item) => &item.attrs,
            syn::Item::Enum(item) => &item.attrs,
            syn::Item::Const(item) => &item.attrs,
            _ => return visit::visit_item(self, item),
        };
        if is_test(attributes) {
            self.exclude(item.span());
        } else {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_const(&mut self, item: &'ast syn::ItemConst) {
        self.constants += usize::from(is_numeric(&item.ty));
    }

    fn visit_impl_item_const(&mut self, item: &'ast syn::ImplItemConst) {
        self.constants += usize::from(is_numeric(&item.ty));
    }
}

/// Whether a file below `src` holds tests only: `tests.rs`, `testing.rs`, or a file in a folder of
/// one of these names.
fn is_test_file(file: &Path) -> bool {
    let inside = file
        .strip_prefix(folder())
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
    for file in files_below(&folder())
        .iter()
        .filter(|file| !is_test_file(file))
    {
        let text = read(file);
        let mut code = ProductionCode::default();
        code.visit_file(&syn::parse_file(&text).expect("Rust"));
        lines += text.lines().count() - code.test_lines.len();
        constants += code.constants;
    }
    hold(
        "production lines",
        lines as f64,
        budget.production_lines as f64,
    );
    let per_1000 = 1000.0 * constants as f64 / lines as f64;
    hold(
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
    let budget = budget();
    let mut files_of: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for file in files_below(&folder()) {
        let mut names = TypeNames::default();
        names.visit_file(&syn::parse_file(&read(&file)).expect("Rust"));
        for name in names.0 {
            files_of.entry(name).or_default().push(file.clone());
        }
    }
    files_of.retain(|_, files| files.len() > 1);
    for (name, files) in &files_of {
        println!("{name}: {files:?}");
        assert!(
            budget.repeated.contains_key(name),
            "the type name {name} is used more than once: {files:?}"
        );
    }
    let bound = budget.repeated_type_names as f64;
    hold("repeated type names", files_of.len() as f64, bound);
    let stale = budget
        .repeated
        .keys()
        .find(|name| !files_of.contains_key(*name));
    assert_eq!(
        stale, None,
        "no longer repeated; remove it from budget.toml"
    );
}

/// Lists the uses between entries of one folder that lie on a cycle of such uses. An entry is a
/// file, or a subfolder with all its files.
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
            let back = edges.iter().filter(|(b, _)| leads_to(graph, b, a));
            cycles
                .extend(back.map(|(b, name)| format!("{}: {a} -> {b}: {name}", parent.display())));
        }
    }
    cycles
}

/// For each entry of a folder: the entries that it uses, each with a path in the code that refers
/// to it.
type NeighbourGraph = BTreeMap<String, BTreeMap<String, String>>;

/// The deepest folder that contains both files, and the names of its entries that contain them. A
/// folder and the file that declares its modules (`a/` and `a.rs`) are one entry. `None` if both
/// files are in one entry.
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

fn leads_to(graph: &NeighbourGraph, from: &str, to: &str) -> bool {
    let mut seen = BTreeSet::new();
    let mut open = vec![from];
    while let Some(entry) = open.pop() {
        if entry == to {
            return true;
        }
        let next = graph.get(entry).into_iter().flat_map(|edges| edges.keys());
        open.extend(next.map(String::as_str).filter(|entry| seen.insert(*entry)));
    }
    false
}

#[test]
fn folders_have_no_cycles() {
    let cycles = folder_cycles(&Crate::read(&folder()).uses());
    let bound = budget().folder_cycles as f64;
    hold("folder cycles", cycles.len() as f64, bound);
}

#[test]
fn the_readme_is_short() {
    let budget = budget();
    let text = read(&root().join("README.md"));
    hold(
        "README lines",
        text.lines().count() as f64,
        budget.readme_lines as f64,
    );
    hold(
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
    let mut in_code = false;
    let lines = text.lines().filter(|line| {
        in_code ^= line.starts_with("```");
        !in_code && !line.trim().is_empty()
    });
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

/// Files whose prose is counted: all except those in `exempt`.
fn prose_files(exempt: &[PathBuf]) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = ["src", "tests", "benches", "examples"]
        .iter()
        .flat_map(|name| files_below(&root().join(name)))
        .collect();
    for path in exempt.iter().map(|path| folder().join(path)) {
        assert!(path.exists(), "{}: exempt, but not there", path.display());
    }
    files.retain(|file| {
        let is_exempt = |path: &PathBuf| file.starts_with(folder().join(path));
        !exempt.iter().any(is_exempt)
    });
    let mut folders = vec![root().to_owned(), root().join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.extension().is_some_and(|extension| extension == "md") {
                files.push(path);
            } else if path.starts_with(root().join("docs")) && path.is_dir() {
                folders.push(path);
            }
        }
    }
    files
}

#[test]
fn prose_is_plain_english() {
    let budget = budget();
    let mut lines = 0;
    let mut counts = [0; 4];
    for file in prose_files(&budget.language_exempt.paths) {
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
        hold(
            &format!("{name} per 1,000 lines"),
            1000.0 * count as f64 / lines as f64,
            bound,
        );
    }
}
