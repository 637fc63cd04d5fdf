//! Tests README and docs: every `morphospace` command line in them runs, every internal link has a
//! target, SUMMARY.md lists every page, the reference of project files names every key and its
//! examples parse, and the generated lists (command-line help, heuristic constants) are up to date.
//!
//! `UPDATE_DOCS=1 cargo test --test docs` updates the generated lists.
#![expect(clippy::print_stdout, reason = "a command that is not run is reported")]

#[path = "source/files.rs"]
mod files;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use morphospace::project::Project;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Paths of the README and of every Markdown page below `docs`.
fn pages() -> Vec<PathBuf> {
    let mut pages = vec![root().join("README.md")];
    let mut folders = vec![root().join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("docs").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                pages.push(path);
            }
        }
    }
    pages.sort();
    pages
}

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

/// Arguments of each `morphospace` command with a subcommand in a block; lines continued with `\`
/// are joined.
fn command_lines(block: &str) -> Vec<Vec<String>> {
    let joined = block.replace("\\\n", " ");
    let lines = joined.lines().filter_map(|line| {
        let line = line.split(" # ").next().unwrap_or(line);
        let words: Vec<String> = line
            .split_whitespace()
            .map(|word| word.trim_matches('\'').to_owned())
            .collect();
        let subcommands = ["render", "check", "new", "catalogue", "gallery"];
        let (program, rest) = words.split_first()?;
        let runs = program == "morphospace" && subcommands.contains(&rest.first()?.as_str());
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
    let mut count = 0;
    for page in pages() {
        for (_, block) in blocks(&read(&page))
            .iter()
            .filter(|(language, _)| *language == "sh")
        {
            let folder = tempfile::tempdir().expect("a folder");
            fill_with_examples(folder.path());
            for arguments in command_lines(block) {
                if arguments.iter().any(|word| word.ends_with(".mp4")) && !has_ffmpeg() {
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

/// Targets of the Markdown links of a page that lie outside code blocks.
fn links(text: &str) -> Vec<String> {
    let mut in_code = false;
    let mut links = Vec::new();
    for line in text.lines() {
        in_code ^= line.starts_with("```");
        if !in_code {
            let after_text = line.split("](").skip(1);
            links.extend(after_text.filter_map(|rest| Some(rest.split_once(')')?.0.to_owned())));
        }
    }
    links
}

/// Anchors of the headings of a page, as GitHub and mdBook derive them.
fn anchors(text: &str) -> Vec<String> {
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let anchor = |line: &str| -> String {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let kept = title.chars().filter_map(|c| match c {
            ' ' => Some('-'),
            c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
            _ => None,
        });
        kept.collect()
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

/// Returns the keys that a project file may have in a table, read from the error message for an
/// unknown key.
fn known_keys(table: &str) -> Vec<String> {
    let text = format!(
        "version = 2\n\n{table}no-such-key = 1\n\n[[designs]]\npath = \"a\"\n\n[[designs]]\npath = \"b\"\n"
    );
    let error = Project::parse(&text).expect_err("a key that does not exist");
    let message = error.to_string();
    // The message is like "unknown field `no-such-key`, expected one of `a`, `b`".
    let (_, keys) = message.split_once("expected").unwrap_or(("", ""));
    let keys = keys.split('`').skip(1).step_by(2);
    keys.map(str::to_owned).collect()
}

#[test]
fn the_reference_of_project_files_names_every_key() {
    let page = read(&root().join("docs/reference/project-file.md"));
    let tables = [
        "[timing]\n",
        "[[stops]]\n",
        "[match]\n",
        "[arap]\n",
        "[field]\n",
        "[map]\n",
        "[style]\n",
    ];
    for table in tables {
        for key in known_keys(table) {
            let forms = [
                format!("`{key}`"),
                format!("`{key}."),
                format!(".{key}`"),
                format!(".{key}]"),
            ];
            let is_named = forms.iter().any(|form| page.contains(form));
            assert!(is_named, "project-file.md does not name `{key}` of {table}");
        }
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
    for subcommand in ["render", "check", "new", "catalogue", "gallery"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_morphospace"));
        let output = command.args([subcommand, "--help"]).output();
        let help = String::from_utf8(output.expect("help").stdout).expect("text");
        let lines: Vec<&str> = help.lines().map(str::trim_end).collect();
        let block = format!("```text\n{}\n```\n", lines.join("\n").trim_end());
        check_generated(&page, &format!("help {subcommand}"), &block);
    }
}

/// For each top-level module of `src`: its constants that are marked as heuristic. Each constant is
/// described by two texts: its file and name, and its documentation up to the mark.
fn heuristics() -> BTreeMap<String, Vec<[String; 2]>> {
    let mut by_folder: BTreeMap<String, Vec<[String; 2]>> = BTreeMap::new();
    for file in files::files_below(&files::folder()) {
        let text = read(&file);
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        for (k, line) in lines.iter().enumerate() {
            let item = line.trim_start_matches("pub").trim_start();
            let item = item
                .strip_prefix("(crate)")
                .or(item.strip_prefix("(super)"));
            let item = item.unwrap_or(line.trim_start_matches("pub")).trim_start();
            let Some(rest) = item.strip_prefix("const ") else {
                continue;
            };
            let docs: Vec<&str> = lines[..k]
                .iter()
                .rev()
                .take_while(|line| line.starts_with("///"))
                .map(|line| line.trim_start_matches("///").trim())
                .collect();
            let sentence = docs.into_iter().rev().collect::<Vec<_>>().join(" ");
            let Some(at) = sentence.find("(heuristic") else {
                continue;
            };
            let inside = file.strip_prefix(files::folder()).expect("a source file");
            let mut parts = inside.components();
            let top = parts.next().expect("a name").as_os_str().to_string_lossy();
            let folder = top.trim_end_matches(".rs").to_owned();
            let name = rest.split(':').next().unwrap_or(rest);
            let entry = format!("`{}` `{name}`", inside.display());
            by_folder
                .entry(folder)
                .or_default()
                .push([entry, sentence[..at].trim().to_owned()]);
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
