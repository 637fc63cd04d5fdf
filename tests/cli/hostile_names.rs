//! Tests that names from files stay text in every kind of output file: they end no string, element
//! or line, and start no formula.

use std::fs;

use morphospace::design::{ImportOptions, import};

use crate::cli_fixture::CliFixture;

/// Name of the part of the drawings: it attacks HTML, SVG, scripts and lines of DXF.
const PART: &str = "</script><script>alert(1)</script>\"'>&lt;]]>\\P%%c=1+1";

/// Writes two drawings with hostile names of their parts and their files; returns a command line
/// that renders them.
fn drawings(cli: &CliFixture) -> String {
    let escaped = PART
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;");
    let shape = |shape: &str| {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"40\"><g id=\"{escaped}\" fill=\"#c30\">{shape}</g></svg>"
        )
    };
    cli.write("=1+1.svg", &shape("<path d=\"M5 5H25V35H5Z\"/>"));
    cli.write("@x'<b>.svg", &shape("<path d=\"M30 5H55V30H30Z\"/>"));
    "render =1+1.svg @x'<b>.svg".to_owned()
}

#[test]
fn names_stay_text_in_drawings_and_animations() {
    let cli = CliFixture::new();
    let render = drawings(&cli);
    let read = |name: &str| fs::read_to_string(cli.path(name)).expect("a file");
    for (options, name) in [
        ("--at 0.3 --out", "x.svg"),
        ("--frames 4 --out", "film.svg"),
    ] {
        cli.succeeds(&format!("{render} {options} {name}"));
        let text = read(name);
        let tree = usvg::roxmltree::Document::parse(&text).expect("well-formed");
        let is_script = |node: &usvg::roxmltree::Node| node.tag_name().name() == "script";
        assert!(!tree.descendants().any(|node| is_script(&node)), "{name}");
    }
    cli.succeeds(&format!("{render} --frames 4 --out film.html"));
    let page = read("film.html");
    assert!(!page.contains("<script>alert"));
    assert_eq!(page.matches("</script>").count(), 2);
    cli.succeeds(&format!("{render} --frames 4 --out film.json"));
    let lottie: serde_json::Value = serde_json::from_str(&read("film.json")).expect("JSON");
    assert!(lottie["layers"].is_array());
    assert!(!read("film.json").contains('<'));
}

/// Characters that control the writing direction (Unicode UAX #9, section 2).
const DIRECTION_CONTROLS: [char; 12] = [
    '\u{61c}', '\u{200e}', '\u{200f}', '\u{202a}', '\u{202b}', '\u{202c}', '\u{202d}', '\u{202e}',
    '\u{2066}', '\u{2067}', '\u{2068}', '\u{2069}',
];

/// Word between characters that control the writing direction.
fn turned(word: &str) -> String {
    let controls: String = DIRECTION_CONTROLS.iter().collect();
    format!("\u{202e}{word}{controls}")
}

/// Writes a project of two drawings with names that control the writing direction.
fn project_of_turned_names(cli: &CliFixture) {
    for (file, path) in [("a.svg", "M5 5H25V35H5Z"), ("b.svg", "M30 5H55V30H30Z")] {
        let layer = turned("שכבה");
        cli.write(file, &format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"40\"><g id=\"{layer}\" fill=\"#c30\"><path d=\"{path}\"/></g></svg>"
            ),
        );
    }
    let (title, first, stop) = (turned("שלום"), turned("نجمة"), turned("exe.gpj"));
    cli.write("p.toml", &format!(
            "version = 1\ntitle = \"{title}\"\n[[designs]]\npath = \"a.svg\"\nname = \"{first}\"\n[[designs]]\npath = \"b.svg\"\n[[stops]]\nt = 0.5\nname = \"{stop}\"\n"
        ),
    );
}

/// Asserts that a text has no characters that control the writing direction, neither as they are
/// nor as escape sequences of JSON, XML or messages.
#[track_caller]
fn assert_has_no_direction_controls(text: &str) {
    let text = text.to_ascii_lowercase();
    assert!(!text.contains(DIRECTION_CONTROLS), "{text}");
    for control in DIRECTION_CONTROLS {
        let code = u32::from(control);
        for escape in [
            format!("\\u{code:04x}"),
            format!("\\u+{code:04x}"),
            format!("\\u{{{code:x}}}"),
            format!("&#x{code:x};"),
            format!("&#{code};"),
        ] {
            assert!(!text.contains(&escape), "{escape} in {text}");
        }
    }
}

#[test]
fn names_do_not_change_the_writing_direction() {
    let cli = CliFixture::new();
    project_of_turned_names(&cli);
    let mut texts = Vec::new();
    for (options, name) in [
        ("--at 0.5 --out", "x.svg"),
        ("--at 0 --out", "x.dxf"),
        ("--frames 4 --captions --out", "film.svg"),
        ("--frames 4 --out", "film.html"),
        ("--frames 4 --out", "film.json"),
    ] {
        cli.succeeds(&format!("render p.toml {options} {name}"));
        texts.push(fs::read_to_string(cli.path(name)).expect("text"));
    }
    texts.push(cli.succeeds("check p.toml --samples 3 --quality draft --json"));
    texts.push(cli.succeeds("check p.toml --samples 3 --quality draft"));
    for text in &texts {
        assert_has_no_direction_controls(text);
    }
    let [_, dxf, film, page, lottie, report, shown] = &texts[..] else {
        unreachable!("seven texts")
    };
    // Words from right to left are as they were written.
    assert!(film.contains("exe.gpj"), "the caption of the stop");
    assert!(page.contains("<title>שלום</title>"));
    let lottie: serde_json::Value = serde_json::from_str(lottie).expect("JSON");
    assert_eq!(lottie["nm"], "שלום");
    assert!(report.contains("نجمة"), "{report}");
    assert!(shown.contains("نجمة"), "{shown}");
    let escaped: String = "שכבה"
        .chars()
        .map(|c| format!("\\U+{:04X}", u32::from(c)))
        .collect();
    assert!(dxf.contains(&escaped), "{dxf}");
}

#[test]
fn names_stay_on_their_line_in_dxf_files() {
    let cli = CliFixture::new();
    let render = drawings(&cli);
    cli.succeeds(&format!("{render} --at 0 --out x.dxf"));
    let bytes = fs::read(cli.path("x.dxf")).expect("a file");
    let text = String::from_utf8(bytes.clone()).expect("text");
    let codes = text.lines().step_by(2);
    assert!(
        codes
            .into_iter()
            .all(|code| code.trim().parse::<i32>().is_ok())
    );
    let design = import("x.dxf", &bytes, &ImportOptions::default()).expect("a design");
    let names: Vec<&str> = design
        .paint_layers
        .iter()
        .map(|layer| layer.name.as_str())
        .collect();
    let is_harmless = |name: &&str| !name.contains(|c| "<>\"\\|=;:,*?%".contains(c));
    assert!(
        !names.is_empty() && names.iter().all(is_harmless),
        "{names:?}"
    );
}

#[test]
fn names_of_files_start_no_formula_in_reports() {
    let cli = CliFixture::new();
    drawings(&cli);
    cli.write("pairs.csv", "source,target\n=1+1.svg,@x'<b>.svg\n");
    cli.succeeds("check --pairs pairs.csv --out report.csv --samples 3 --quality draft");
    let mut report = csv::Reader::from_path(cli.path("report.csv")).expect("a report");
    let starts_formula =
        |cell: &str| cell.starts_with(['=', '+', '-', '@', '\t']) && cell.parse::<f64>().is_err();
    let rows: Vec<csv::StringRecord> = report.records().map(|row| row.expect("a row")).collect();
    assert_eq!(rows.len(), 1);
    assert!(!rows[0].iter().any(starts_formula), "{:?}", rows[0]);
    assert!(
        rows[0].iter().any(|cell| cell == "'=1+1.svg"),
        "{:?}",
        rows[0]
    );
    let json = cli.succeeds("check =1+1.svg @x'<b>.svg --samples 3 --quality draft --json");
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert!(report.to_string().contains("@x'<b>"), "{json}");
}
