//! Tests README and docs: every `morphospace` command line in them runs, every internal link has a
//! target, SUMMARY.md lists every page, the reference of project files names every key and its
//! examples parse, and the generated lists (command-line help, heuristic constants) are up to date.
//!
//! `UPDATE_DOCS=1 cargo test --test docs` updates the generated lists.
#![expect(clippy::print_stdout, reason = "a command that is not run is reported")]

mod source;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use morphospace::project::Project;
use source::production::ProductionCode;
use source::{lines_outside_code, pages, read, root, rust_files, source_folder};

/// Language and text of each fenced code block of a page.
fn blocks(text: &str) -> Vec<(&str, String)> {
    let mut blocks = Vec::new();
    let mut open: Option<(&str, String)> = None;
    for line in text.lines() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(language), None) => open = Some((language, String::new())),
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (None, Some((_, body))) => {
                body.push_str(line);
                body.push('\n');
            }
            (None, None) => {}
        }
    }
    blocks
}

/// Fills a folder with designs, projects and a table under the names that README and docs use.
fn fill_with_examples(folder: &Path) {
    let gallery = root().join("assets/gallery");
    let copies = [
        ("shape-heart.svg", "before.svg"),
        ("shape-duck.svg", "after.svg"),
        ("bottle-claret.svg", "one.svg"),
        ("bottle-flask.svg", "two.svg"),
        ("bottle-milk.svg", "three.svg"),
        ("bottle-vial.svg", "four.svg"),
        ("portrait-ada.png", "before.png"),
        ("portrait-max.png", "after.png"),
        ("rotor-straight.obj", "before.obj"),
        ("rotor-curled.obj", "after.obj"),
        ("bracket.json", "bracket.json"),
        ("davit.json", "davit.json"),
    ];
    for (from, to) in copies {
        fs::copy(gallery.join(from), folder.join(to)).expect(from);
    }
    let design = |path: &str| format!("[[designs]]\npath = \"{path}\"\n\n");
    let designs = |paths: &[&str]| paths.iter().map(|path| design(path)).collect::<String>();
    let bottles = designs(&["one.svg", "two.svg", "three.svg", "four.svg"]);
    let place = |x: f64, y: f64| format!("  {{ at = [{x}, {y}], name = \"\" }},\n");
    let path = place(0.0, 1.0) + &place(0.2, 0.1) + &place(0.0, -1.0);
    let files = [
        (
            "bridge.morph",
            format!(
                "version = 1\n\n{}",
                designs(&["bracket.json", "davit.json"])
            ),
        ),
        (
            "bottles.morph",
            format!(
                "version = 2\n\n{bottles}[[map.kept]]\nat = [0.2, 0.1]\nname = \"Best\"\nstars = 5\n"
            ),
        ),
        (
            "walk.morph",
            format!("version = 2\n\n{bottles}[map.path]\nplaces = [\n{path}]\n"),
        ),
        (
            "pairs.csv",
            "source,target\nbefore.svg,after.svg\none.svg,two.svg\n".to_owned(),
        ),
    ];
    for (name, text) in files {
        fs::write(folder.join(name), text).expect(name);
    }
}

/// Output of `morphospace` with the given arguments.
fn help(arguments: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_morphospace"));
    let output = command
        .args(arguments)
        .output()
        .expect("the program starts");
    assert!(output.status.success(), "{arguments:?}");
    String::from_utf8(output.stdout).expect("text")
}

/// Names of the subcommands except `help`, from the list in `morphospace --help`.
fn subcommands() -> Vec<String> {
    let help = help(&["--help"]);
    let (_, list) = help.split_once("Commands:\n").expect("a list of commands");
    let lines = list.lines().take_while(|line| !line.is_empty());
    let names = lines.filter_map(|line| line.split_whitespace().next());
    let names: Vec<String> = names
        .filter(|name| *name != "help")
        .map(str::to_owned)
        .collect();
    assert!(!names.is_empty(), "no commands:\n{help}");
    names
}

/// Arguments of each `morphospace` command with a subcommand in a block; lines continued with `\`
/// are joined.
fn command_lines(block: &str, subcommands: &[String]) -> Vec<Vec<String>> {
    let joined = block.replace("\\\n", " ");
    let lines = joined.lines().filter_map(|line| {
        let line = line.split(" # ").next().unwrap_or(line);
        let words: Vec<String> = line
            .split_whitespace()
            .map(|word| word.trim_matches('\'').to_owned())
            .collect();
        let (program, rest) = words.split_first()?;
        let runs = program == "morphospace" && subcommands.contains(rest.first()?);
        runs.then(|| rest.to_vec())
    });
    lines.collect()
}

fn has_ffmpeg() -> bool {
    let mut command = Command::new("ffmpeg");
    let command = command.arg("-version").stdout(Stdio::null());
    command.stderr(Stdio::null()).status().is_ok()
}

#[test]
fn every_command_line_runs() {
    let subcommands = subcommands();
    let mut count = 0;
    for page in pages() {
        for (_, block) in blocks(&read(&page))
            .iter()
            .filter(|(language, _)| *language == "sh")
        {
            let folder = tempfile::tempdir().expect("a folder");
            fill_with_examples(folder.path());
            for arguments in command_lines(block, &subcommands) {
                let is_video = |word: &String| {
                    [".mp4", ".webm", ".mov"]
                        .iter()
                        .any(|end| word.ends_with(end))
                };
                if arguments.iter().any(is_video) && !has_ffmpeg() {
                    println!("not run, since ffmpeg is not installed: {arguments:?}");
                    continue;
                }
                let mut command = Command::new(env!("CARGO_BIN_EXE_morphospace"));
                let output = command.args(&arguments).current_dir(folder.path()).output();
                let output = output.expect("the program starts");
                let error = String::from_utf8_lossy(&output.stderr);
                let page = page.display();
                assert!(output.status.success(), "{page}: {arguments:?}\n{error}");
                count += 1;
            }
        }
    }
    assert!(count > 15, "only {count} command lines were found");
}

/// Targets of the Markdown links of a page that are outside code blocks.
fn links(text: &str) -> Vec<String> {
    let links = lines_outside_code(text).flat_map(|line| {
        let after_text = line.split("](").skip(1);
        after_text.filter_map(|rest| Some(rest.split_once(')')?.0.to_owned()))
    });
    links.collect()
}

/// Anchors of the headings of a page, as GitHub and mdBook derive them.
fn anchors(text: &str) -> Vec<String> {
    let headings = lines_outside_code(text).filter(|line| line.starts_with('#'));
    let anchor = |line: &str| -> String {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let characters = title.chars().filter_map(|c| match c {
            ' ' => Some('-'),
            c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
            _ => None,
        });
        characters.collect()
    };
    headings.map(anchor).collect()
}

#[test]
fn every_internal_link_leads_somewhere() {
    let mut broken = Vec::new();
    for page in pages() {
        let text = read(&page);
        for link in links(&text) {
            if link.starts_with("http") || link.starts_with("mailto:") {
                continue;
            }
            let (path, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let folder = page.parent().expect("a folder");
            let target = match path {
                "" => page.clone(),
                path => folder.join(path),
            };
            let is_found = target.exists()
                && (anchor.is_empty() || anchors(&read(&target)).iter().any(|a| a == anchor));
            if !is_found {
                broken.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(broken.is_empty(), "broken links:\n{}", broken.join("\n"));
}

#[test]
fn the_summary_lists_every_page() {
    let summary = links(&read(&root().join("docs/SUMMARY.md")));
    let docs = root().join("docs");
    let listed: Vec<PathBuf> = summary.iter().map(|link| docs.join(link)).collect();
    for page in pages() {
        let is_page = page.starts_with(&docs) && !page.ends_with("SUMMARY.md");
        assert!(
            !is_page || listed.contains(&page),
            "{}: not in SUMMARY.md",
            page.display()
        );
    }
}

#[test]
fn every_project_file_in_the_docs_parses() {
    let page = root().join("docs/reference/project-file.md");
    let mut count = 0;
    for (_, block) in blocks(&read(&page))
        .iter()
        .filter(|(language, _)| *language == "toml")
    {
        if let Err(error) = Project::parse(block) {
            panic!("{error}\n{block}");
        }
        count += 1;
    }
    assert!(count > 3, "only {count} project files were found");
}

/// Returns the keys that a table of a project file may have, read from the error message for an
/// unknown key. `table` is its header, empty for the top level.
fn known_keys(table: &str) -> Vec<String> {
    let designs = "[[designs]]\npath = \"a\"\n[[designs]]\npath = \"b\"\n";
    let text = format!("version = 2\n{table}\nno-such-key = 1\n{designs}");
    let error = Project::parse(&text)
        .expect_err("a key that does not exist")
        .to_string();
    // The message is like "unknown key "no-such-key", expected one of a, b, c" or, from serde,
    // "unknown field `no-such-key`, expected `a` or `b`".
    let first_line = error.lines().next().unwrap_or("");
    let (_, list) = first_line.split_once("expected ").unwrap_or(("", ""));
    let list = list.trim_start_matches("one of ").replace(" or ", ", ");
    let keys = list.split(", ");
    let keys: Vec<String> = keys
        .map(|key| key.trim_matches('`').to_owned())
        .filter(|key| !key.is_empty())
        .collect();
    assert!(!keys.is_empty(), "no list of keys: {error}\n{text}");
    keys
}

/// All words in code spans of a Markdown text, such as `import` and `invert` of `` `import.invert` ``.
fn code_words(text: &str) -> Vec<&str> {
    let spans = text.split('`').skip(1).step_by(2);
    let is_separator = |c: char| !c.is_alphanumeric() && c != '-';
    spans.flat_map(|span| span.split(is_separator)).collect()
}

/// The part of a page from a heading of the second level to the next one.
fn section<'a>(page: &'a str, heading: &str) -> &'a str {
    let (_, rest) = page
        .split_once(&format!("\n## {heading}\n"))
        .unwrap_or_else(|| panic!("no section {heading}"));
    rest.split("\n## ").next().unwrap_or(rest)
}

#[test]
fn the_reference_of_project_files_names_every_key() {
    let page = read(&root().join("docs/reference/project-file.md"));
    // For each table of the project file: the section of the page that names its keys. A table
    // inside a `[[designs]]` entry, such as `[designs.import]`, is preceded by the header of that
    // entry.
    let tables = [
        ("[match]", "Match"),
        ("[triangulation]", "Match"),
        ("[arap]", "Rigid parts"),
        ("[paths]", "Boundary paths"),
        ("[field]", "Distance fields"),
        ("[field.blend]", "Distance fields"),
        ("[lines]", "Warps of the plane"),
        ("[scattered]", "Warps of the plane"),
        ("[lattice]", "Warps of the plane"),
        ("[colours]", "Pictures"),
        ("[coats]", "Paint"),
        ("[style]", "Paint"),
        ("[timing]", "Timing and stops"),
        ("[[stops]]", "Timing and stops"),
        ("[[parts]]", "Timing and stops"),
        ("[[legs]]", "Many designs"),
        ("[map]", "Map"),
        ("[map.path]", "Map"),
        ("[[map.kept]]", "Map"),
        ("[[designs]]", "Designs"),
        ("[[designs]]\n[designs.import]", "Designs"),
        ("[[designs]]\n[designs.placement]", "Designs"),
    ];
    for (table, heading) in tables {
        let words = code_words(section(&page, heading));
        for key in known_keys(table) {
            let is_named = words.contains(&key.as_str());
            assert!(is_named, "\"{heading}\" does not name `{key}` of {table}");
        }
    }
    let words = code_words(&page);
    for key in known_keys("") {
        assert!(
            words.contains(&key.as_str()),
            "project-file.md does not name `{key}`"
        );
    }
}

/// Asserts that the text of a page between `<!-- generated:NAME -->` and `<!-- end -->` is
/// `expected`; replaces it instead if `UPDATE_DOCS` is set.
fn check_generated(page: &Path, name: &str, expected: &str) {
    let text = read(page);
    let begin = format!("<!-- generated:{name} -->\n");
    let (before, rest) = text.split_once(&begin).unwrap_or_else(|| {
        panic!("{}: no block {begin}", page.display());
    });
    let (present, after) = rest.split_once("<!-- end -->").expect("the end of a block");
    if present == expected {
        return;
    }
    if std::env::var_os("UPDATE_DOCS").is_some() {
        let updated = format!("{before}{begin}{expected}<!-- end -->{after}");
        fs::write(page, updated).expect("written");
        return;
    }
    panic!(
        "{}: `{name}` is out of date; run UPDATE_DOCS=1 cargo test --test docs",
        page.display()
    );
}

#[test]
fn the_options_of_the_command_line_are_listed() {
    let page = root().join("docs/reference/command-line.md");
    for subcommand in subcommands() {
        let help = help(&[&subcommand, "--help"]);
        let lines: Vec<&str> = help.lines().map(str::trim_end).collect();
        let block = format!("```text\n{}\n```\n", lines.join("\n").trim_end());
        check_generated(&page, &format!("help {subcommand}"), &block);
    }
}

/// Text without the links of rustdoc, which have no target outside the API documentation:
/// ``[`x`]`` and ``[`x`](path)`` become `` `x` ``.
fn without_links(docs: &str) -> String {
    let mut parts = docs.split("[`");
    let mut text = parts.next().unwrap_or("").to_owned();
    for part in parts {
        let (label, rest) = part.split_once("`]").expect("the end of a link");
        let target = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
        let after = target.map_or(rest, |(_, after)| after);
        write!(text, "`{label}`{after}").expect("text");
    }
    text
}

/// For each top-level module of `src`: its constants that are marked as heuristic. Each constant is
/// described by two texts: its file and name, and its documentation up to the mark.
fn heuristics() -> BTreeMap<String, Vec<[String; 2]>> {
    let mut by_folder: BTreeMap<String, Vec<[String; 2]>> = BTreeMap::new();
    for file in rust_files() {
        let inside = file.strip_prefix(source_folder()).expect("a source file");
        let top = inside.iter().next().expect("a name").to_string_lossy();
        let folder = top.trim_end_matches(".rs").to_owned();
        for constant in ProductionCode::read(&file).constants {
            if let Some((meaning, _)) = constant.docs.split_once("(heuristic") {
                let entry = format!("`{}` `{}`", inside.display(), constant.name);
                let constants = by_folder.entry(folder.clone()).or_default();
                constants.push([entry, without_links(meaning.trim())]);
            }
        }
    }
    by_folder
}

#[test]
fn the_heuristics_are_listed() {
    let by_folder = heuristics();
    let mut list = String::new();
    let total: usize = by_folder.values().map(Vec::len).sum();
    writeln!(
        list,
        "\n{total} constants.\n\n| folder | constants |\n|---|---|"
    )
    .expect("text");
    for (folder, constants) in &by_folder {
        writeln!(list, "| `{folder}` | {} |", constants.len()).expect("text");
    }
    for (folder, constants) in &by_folder {
        writeln!(list, "\n## {folder}\n\n| constant | meaning |\n|---|---|").expect("text");
        for [name, meaning] in constants {
            let meaning = meaning.replace('|', "\\|");
            writeln!(list, "| {name} | {meaning} |").expect("text");
        }
    }
    list.push('\n');
    check_generated(&root().join("docs/heuristics.md"), "heuristics", &list);
}
