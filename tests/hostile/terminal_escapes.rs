//! Tests of error messages: text from files and arguments is quoted on one line, without the escape
//! sequences that control a terminal; colour is used only in terminals; and inputs that do not fit
//! together are named. The project title that `check` prints is tested in the same way.

use crate::bounded_run::{BoundedFixture, terminal_control};

/// Text with control characters that would colour a terminal red, clear it and reverse its text.
const RED: &str = "\u{1b}[31mred\n\u{9b}2J\u{202e}";

/// Text with control characters, as escaped in JSON and TOML files.
const JSON_RED: &str = r"\u001b]0;owned\u0007\n\u009b2J";

/// Text with control characters, as escaped in XML files.
const XML_RED: &str = "red&#10;&#x9b;2J&#x202e;";

/// Name and content of each hostile file, and a part of the expected error message.
fn hostile_files() -> Vec<(&'static str, String, &'static str)> {
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
            "GeoJSON does not define",
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
            "1 \\u{1b}[31mTEXT left out",
        ),
        (
            "spline.dxf",
            format!("0\nSECTION\n2\nENTITIES\n0\nSPLINE\n{spline}0\nENDSEC\n0\nEOF\n"),
            "SPLINE",
        ),
    ]
}

#[test]
fn text_from_files_is_shown_in_one_line() {
    let fixture = BoundedFixture::new();
    for (name, text, reason) in hostile_files() {
        fixture.write(name, text);
        fixture.assert_refused(name, reason);
    }
    let id = format!("<svg xmlns=\"http://www.w3.org/2000/svg\"><rect id=\"{XML_RED}\"/></svg>");
    fixture.write("id.svg", id);
    fixture.assert_refused("id.svg#none", "it has red\\n\\u{9b}2J\\u{202e}");
}

#[test]
fn text_from_projects_is_shown_in_one_line() {
    let fixture = BoundedFixture::new();
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
        fixture.write(name, text);
        let reason = if name == "path.morph" {
            "does not exist"
        } else {
            "line"
        };
        let file = if name == "path.morph" { "owned" } else { name };
        fixture.assert_inputs_refused(&[name], file, reason);
    }
    let named = designs.replace("path", &format!("name = \"{JSON_RED}\"\npath"));
    fixture.write(
        "title.morph",
        format!("version = 1\ntitle = \"{JSON_RED}\"\n{named}"),
    );
    let output = fixture.run(&["check", "title.morph", "--samples", "2"]);
    assert_eq!(output.code, Some(0), "{output:?}");
    let lines: Vec<_> = output.stdout.lines().collect();
    assert!(
        lines[0].starts_with("\\u{1b}]0;owned\\u{7}\\n"),
        "{}",
        lines[0]
    );
    assert_eq!(lines.iter().find_map(|line| terminal_control(line)), None);
}

#[test]
fn escape_sequences_in_arguments_are_shown_harmlessly() {
    let fixture = BoundedFixture::new();
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
        let output = fixture.run(arguments);
        assert!(matches!(output.code, Some(1 | 2)), "{output:?}");
        let control = output.stderr.lines().find_map(terminal_control);
        assert_eq!(control, None, "{output:?}");
        assert!(output.stderr.contains("red"), "{output:?}");
    }
}

/// Runs a command line in a terminal and returns the output of the terminal. `no_colour` is the
/// value of the environment variable `NO_COLOR`.
#[cfg(target_os = "linux")]
fn on_a_terminal(line: &str, no_colour: Option<&str>) -> String {
    let mut script = std::process::Command::new("script");
    script.args(["-qec", line, "/dev/null"]);
    script.env("TERM", "xterm").env_remove("NO_COLOR");
    script.envs(no_colour.map(|value| ("NO_COLOR", value)));
    let output = script.stdin(std::process::Stdio::null()).output();
    let output = output.expect("`script` of util-linux");
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[cfg(target_os = "linux")]
#[test]
fn colour_is_used_only_in_terminals_without_no_color() {
    let line = format!("{} render", env!("CARGO_BIN_EXE_morphospace"));
    let is_coloured = |text: &str| text.contains('\u{1b}');
    let text = on_a_terminal(&line, None);
    assert!(is_coloured(&text) && text.contains("--out"), "{text:?}");
    let text = on_a_terminal(&line, Some("1"));
    assert!(!is_coloured(&text) && text.contains("--out"), "{text:?}");
    let piped = BoundedFixture::new().run(&["render"]);
    assert!(!is_coloured(&piped.stderr), "{piped:?}");
}

#[test]
fn inputs_that_do_not_fit_are_named() {
    let fixture = BoundedFixture::new();
    fixture.write(
        "bar.json",
        "{\"nodes\": [[0, 0], [1, 0]], \"bars\": [[0, 1]]}",
    );
    fixture.write(
        "tri.json",
        "{\"nodes\": [[0, 0], [1, 0], [0, 1]], \"bars\": [[0, 1], [1, 2]]}",
    );
    let pair = ["bar.json", "tri.json", "--method", "arap"];
    fixture.assert_inputs_refused(&pair, "bar to tri: ", "has 2 nodes");
    fixture.write("empty.ttf", "");
    fixture.assert_refused("glyph:A@empty.ttf", "the file is empty");
    let accents = format!("glyph:A{}", "\u{301}".repeat(500));
    fixture.assert_refused(&accents, "combining marks");
    fixture.write("cut.ttf", [0, 1, 0, 0, 0, 9]);
    fixture.assert_refused("glyph:A@cut.ttf", "damaged or not a font");
    let many = [
        "check",
        "square.json",
        "square.json",
        "--subdivisions",
        "4294967295",
    ];
    let output = fixture.run(&many);
    output.assert_one_line_error();
    assert_eq!(output.code, Some(2), "{output:?}");
    assert!(output.stderr.contains("choose fewer"), "{output:?}");
}
