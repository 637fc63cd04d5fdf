//! What comes out of a file reaches nobody's terminal but as text.

use crate::child::{Folder, acting};

const RED: &str = "\u{1b}[31mred\n\u{9b}2J\u{202e}";
/// The same as it may stand in JSON, TOML and XML.
const JSON_RED: &str = r"\u001b]0;owned\u0007\n\u009b2J";
const XML_RED: &str = "red&#10;&#x9b;2J&#x202e;";

/// Each file, and what must be said of it.
fn files() -> Vec<(&'static str, String, &'static str)> {
    let svg = |body: &str| {
        format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\">{body}</svg>")
    };
    let spline = "8\n0\n71\n3\n40\n0\n10\n0\n20\n0\n";
    vec![
        (
            "key.json",
            format!("{{\"nodes\":[[0,0],[1,0]],\"bars\":[[0,1]],\"{JSON_RED}\":1}}"),
            "unknown field",
        ),
        ("lines.json", "{\n \"[od\n[[n\n".to_owned(), "line 3"),
        (
            "kind.json",
            format!("{{\"type\": \"{JSON_RED}\"}}"),
            "correct the type",
        ),
        (
            "word.obj",
            "v 0 0\nv 1 0\nv 0 1\nf 1 2 \u{1b}[31m3\n".to_owned(),
            "a vertex number",
        ),
        (
            "tag.svg",
            svg(&format!("</{}>", "\u{9b}g\u{202e}")),
            "tag.svg",
        ),
        (
            "lines.svg",
            "<svg xmlns=\"a\nb.C\n16,2\"\n> </g>\n</svg>".to_owned(),
            "lines.svg",
        ),
        (
            "only.dxf",
            "0\nSECTION\n2\nENTITIES\n0\n\u{1b}[31mTEXT\n8\n0\n0\nENDSEC\n0\nEOF\n".to_owned(),
            "only 1",
        ),
        (
            "spline.dxf",
            format!("0\nSECTION\n2\nENTITIES\n0\nSPLINE\n{spline}0\nENDSEC\n0\nEOF\n"),
            "SPLINE",
        ),
    ]
}

#[test]
fn what_stands_in_a_file_is_told_in_one_line() {
    let folder = Folder::new();
    for (name, text, said) in files() {
        folder.put(name, text);
        folder.refused(name, said);
    }
    let id = format!("<svg xmlns=\"http://www.w3.org/2000/svg\"><rect id=\"{XML_RED}\"/></svg>");
    folder.put("id.svg", id);
    folder.refused("id.svg#none", "it has red\\n\\u{9b}2J\\u{202e}");
}

#[test]
fn what_stands_in_a_project_is_told_in_one_line() {
    let folder = Folder::new();
    let designs = "[[designs]]\npath = \"square.json\"\n".repeat(2);
    for (name, text) in [
        (
            "key.morph",
            format!("\"{JSON_RED}\" = 1\nversion = 1\n{designs}"),
        ),
        (
            "value.morph",
            format!("version = 1\nfit = \"{JSON_RED}\"\n{designs}"),
        ),
        (
            "colour.morph",
            format!("version = 1\n{designs}[style]\nsource = \"{JSON_RED}\"\n"),
        ),
        (
            "path.morph",
            format!("version = 1\n[[designs]]\npath = \"{JSON_RED}\"\n{designs}"),
        ),
    ] {
        folder.put(name, text);
        let said = if name == "path.morph" {
            "no such file"
        } else {
            "line"
        };
        let file = if name == "path.morph" { "owned" } else { name };
        folder.refused_with(&[name], file, said);
    }
    let named = designs.replace("path", &format!("name = \"{JSON_RED}\"\npath"));
    folder.put(
        "title.morph",
        format!("version = 1\ntitle = \"{JSON_RED}\"\n{named}"),
    );
    let answer = folder.ask(&["check", "title.morph", "--samples", "2"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let lines: Vec<_> = answer.data.lines().collect();
    assert!(
        lines[0].starts_with("\\u{1b}]0;owned\\u{7}\\n"),
        "{}",
        lines[0]
    );
    assert_eq!(lines.iter().find_map(|line| acting(line)), None);
}

#[test]
fn what_stands_in_an_argument_is_shown_and_does_not_act() {
    let folder = Folder::new();
    let file = format!("{RED}.svg");
    let gallery = format!("gallery:{RED}");
    for arguments in [
        &["check", &file, "square.json"][..],
        &["check", &gallery, "--json"],
        &["check", "--pairs", RED, "--out", "x.csv"],
        &["new", &file, "square.json", "--out", "x.morph"],
        &[
            "render",
            "square.json",
            "square.json",
            "--at",
            "0",
            "--out",
            RED,
        ],
        &["render", "--method", RED],
        &["render", RED],
    ] {
        let answer = folder.ask(arguments);
        assert!(matches!(answer.code, Some(1 | 2)), "{answer:?}");
        let acts = answer.words.lines().find_map(acting);
        assert_eq!(acts, None, "{answer:?}");
        assert!(answer.words.contains("red"), "{answer:?}");
    }
}

/// The program on a terminal, and what it wrote there.
#[cfg(target_os = "linux")]
fn on_a_terminal(line: &str, no_colour: Option<&str>) -> String {
    let mut script = std::process::Command::new("script");
    script.args(["-qec", line, "/dev/null"]);
    script.env("TERM", "xterm").env_remove("NO_COLOR");
    script.envs(no_colour.map(|value| ("NO_COLOR", value)));
    let output = script.stdin(std::process::Stdio::null()).output();
    let output = output.expect("`script`, which is of every util-linux, gives a terminal");
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[cfg(target_os = "linux")]
#[test]
fn colour_is_for_terminals_that_want_it() {
    let line = format!("{} render", env!("CARGO_BIN_EXE_morphospace"));
    let coloured = |words: &str| words.contains('\u{1b}');
    let words = on_a_terminal(&line, None);
    assert!(coloured(&words) && words.contains("--out"), "{words:?}");
    let words = on_a_terminal(&line, Some("1"));
    assert!(!coloured(&words) && words.contains("--out"), "{words:?}");
    let piped = Folder::new().ask(&["render"]);
    assert!(!coloured(&piped.words), "{piped:?}");
}

#[test]
fn what_does_not_go_together_is_told_by_its_names() {
    let folder = Folder::new();
    folder.put(
        "bar.json",
        "{\"nodes\": [[0, 0], [1, 0]], \"bars\": [[0, 1]]}",
    );
    folder.put(
        "tri.json",
        "{\"nodes\": [[0, 0], [1, 0], [0, 1]], \"bars\": [[0, 1], [1, 2]]}",
    );
    let pair = ["bar.json", "tri.json", "--method", "arap"];
    folder.refused_with(&pair, "bar to tri: ", "has 2 nodes");
    folder.put("empty.ttf", "");
    folder.refused("glyph:A@empty.ttf", "the file is empty");
    let accents = format!("glyph:A{}", "\u{301}".repeat(500));
    folder.refused(&accents, "marks stand on one letter");
    folder.put("cut.ttf", [0, 1, 0, 0, 0, 9]);
    folder.refused("glyph:A@cut.ttf", "damaged, or no font");
    let many = [
        "check",
        "square.json",
        "square.json",
        "--subdivisions",
        "4294967295",
    ];
    let answer = folder.ask(&many);
    answer.is_one_line();
    assert_eq!(answer.code, Some(2), "{answer:?}");
    assert!(answer.words.contains("choose fewer"), "{answer:?}");
}
