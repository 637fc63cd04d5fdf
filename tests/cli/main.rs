//! Runs the built program from the command line with small inputs. Tests the output of each
//! command, notes, errors and exit codes, a closed pipe, and a missing display.
//!
//! Needs no graphics card and no display.

mod cli_fixture;
mod hostile_names;
mod output_files;
mod pair_tables;
mod protection;
mod structure;
mod videos;

use std::fs;

use crate::cli_fixture::{CliFixture, read_image, stderr};

#[test]
fn check_prints_one_json_object_or_a_table() {
    let cli = CliFixture::new();
    let json = cli.succeeds("check a.obj b.obj --samples 5 --json");
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(report["vertices"], 4);
    assert_eq!(report["faces"], 2);
    assert_eq!(report["warp"], "arap");
    assert_eq!(report["film"]["samples"].as_array().map(Vec::len), Some(5));
    for stage in ["import", "build", "frame"] {
        assert!(report["seconds"][stage].as_f64() > Some(0.0), "{stage}");
    }
    for measure in [
        "asymmetry",
        "conformal_excess",
        "worst_crossings",
        "min_det",
    ] {
        assert!(report["film"][measure].is_number(), "{measure}");
    }
    assert_eq!(report["verdict"]["words"], "no folds, no crossings");
    assert_eq!(report["mesh"]["steiner_per_boundary_point"], 0.0);
    let json = cli.succeeds("check a.svg b.svg --method field --cells 64 --samples 3 --json");
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(
        (&report["content"], &report["mesh"]),
        (&"field".into(), &().into())
    );
    assert_eq!(report["grid"][0], 64);
    let table = cli.succeeds("check a.obj b.obj --samples 5");
    assert!(table.lines().any(|line| line.starts_with("time  ")));
    let check = "check        no folds, no crossings";
    assert!(table.lines().any(|line| line == check), "{table}");
    assert!(table.lines().count() < 40, "{table}");
    let long = table.lines().find(|line| line.chars().count() > 110);
    assert_eq!(long, None);
}

#[test]
fn check_lists_notes_on_options_that_were_changed() {
    let cli = CliFixture::new();
    let check = "check a.svg b.svg --method field --cells 64 --samples 3 --metric city-block";
    let expected = "boundary runs between cells";
    let table = cli.succeeds(check);
    let is_note = |line: &str| line.starts_with("note  ") && line.contains(expected);
    assert!(table.lines().any(is_note), "{table}");
    let json = cli.succeeds(&format!("{check} --json"));
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let note = report["verdict"]["notes"][0].as_str().expect("a note");
    assert!(note.contains(expected), "{note}");
    let table = cli.succeeds(&format!("{check} --boundary binary"));
    assert!(!table.contains(expected), "{table}");
}

#[test]
fn a_new_project_in_a_subfolder_stores_relative_paths() {
    let cli = CliFixture::new();
    fs::create_dir(cli.path("sub")).expect("made");
    cli.succeeds("new a.svg b.svg --out sub/pair.morph --cells 64 --epsilon 2");
    let text = fs::read_to_string(cli.path("sub/pair.morph")).expect("text");
    assert!(
        text.contains("../a.svg") && text.contains("epsilon = 2.0"),
        "{text}"
    );
    cli.succeeds("render sub/pair.morph --at 0 --size 30x20 --out x.png");
    assert_eq!(read_image(&cli.path("x.png")).dimensions(), (30, 20));
    cli.fails(1, "new a.svg b.svg --out sub/pair.morph", "--force");
    cli.fails(2, "new a.svg b.svg --out pair.txt", ".morph");
    cli.fails(1, "new a.svg missing.svg --out p.morph", "missing.svg");
}

#[test]
fn a_new_project_may_store_its_match() {
    let cli = CliFixture::new();
    cli.succeeds("new a.svg b.svg --out plain.morph");
    cli.succeeds("new a.svg b.svg --out with-match.morph --film");
    let [plain, with_match] = ["plain", "with-match"].map(|name| {
        let text = fs::read_to_string(cli.path(&format!("{name}.morph"))).expect("text");
        let report = cli.succeeds(&format!("check {name}.morph --json"));
        let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
        (text.contains("[found]"), report)
    });
    assert_eq!([plain.0, with_match.0], [false, true]);
    let stages = |report: &serde_json::Value| report["seconds"]["stages"].as_object().cloned();
    let is_matched =
        |report: &serde_json::Value| stages(report).expect("stages").contains_key("matching");
    assert!(is_matched(&plain.1) && !is_matched(&with_match.1));
    assert_eq!(with_match.1["seconds"]["match"].to_string(), "0.0");
    assert_eq!(plain.1["distortion"], with_match.1["distortion"]);
    // `--method auto` stores the method that was chosen. A field blend of a horizontal and a
    // vertical bar breaks into pieces, so rigid parts are chosen.
    for (name, d) in [
        ("horizontal", "M0 40H100V60H0Z"),
        ("vertical", "M40 0H60V100H40Z"),
    ] {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg'><path d='{d}'/></svg>");
        cli.write(&format!("{name}.svg"), &svg);
    }
    cli.succeeds("new horizontal.svg vertical.svg --out auto.morph --method auto --cells 64");
    let text = fs::read_to_string(cli.path("auto.morph")).expect("text");
    assert!(text.contains("warp = \"arap\"") && text.contains("content = \"solid\""));
    assert!(!text.contains("[found]"), "{text}");
    // A field blend needs no match, so none is stored.
    cli.succeeds("new a.svg b.svg --out field.morph --film --method field");
    let text = fs::read_to_string(cli.path("field.morph")).expect("text");
    assert!(!text.contains("[found]"));
}

#[test]
fn a_map_path_is_rendered_and_saved_places_are_exported() {
    let cli = CliFixture::new();
    let document = |map: &str| {
        let designs =
            ["a.svg", "b.svg", "a.svg"].map(|path| format!("[[designs]]\npath = \"{path}\"\n"));
        let text = format!(
            "version = 2\nquality = \"draft\"\n{}[timing]\nto = 2.0\n{map}",
            designs.concat()
        );
        fs::write(cli.path("path.morph"), text).expect("a project");
    };
    document("");
    cli.fails(1, "catalogue path.morph --out saved", "no saved blends");
    document(
        "[map.path]\nplaces = [{ at = [0.0, 1.0] }, { at = [0.1, 0.1], passed = true }, \
         { at = [0.0, 0.0], name = \"Middle\" }, { at = [0.4, -0.2] }]\n\
         [[map.kept]]\nat = [0.0, 0.0]\nname = \"Half, and half\"\nstars = 2\n",
    );
    cli.succeeds("render path.morph --frames 3 --out f-#.png");
    let [first, middle] = ["f-0.png", "f-1.png"].map(|name| read_image(&cli.path(name)));
    assert_eq!(first.dimensions(), middle.dimensions());
    assert_ne!(first, middle);
    let json = cli.succeeds("check path.morph --samples 3 --json");
    let segments: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let segments = segments.as_array().expect("two segments");
    assert_eq!(segments.len(), 2);
    assert_eq!(segments[1]["title"], "Middle to ");
    assert_eq!(segments[0]["verdict"]["words"], "no folds, no crossings");
    let messages = stderr(&cli.run("catalogue path.morph --out saved --sort stars"));
    assert!(
        messages.contains("wrote 4 files of 1 saved blends"),
        "{messages}"
    );
    assert!(cli.path("saved/01-Half-and-half.svg").exists());
    cli.fails(1, "catalogue path.morph --out saved --stars 3", "3 stars");
    cli.fails(
        2,
        "catalogue path.morph --out saved --sort size",
        "kept, stars",
    );
    // A path blends all designs, but a comparison needs exactly two.
    cli.fails(
        2,
        "render path.morph --compare --out c.png",
        "exactly two designs",
    );
}

#[test]
fn several_designs_are_drawn_as_a_map() {
    let cli = CliFixture::new();
    let messages =
        stderr(&cli.run("render a.svg b.svg a.svg --quality draft --map 3x2 --out map.svg"));
    assert!(messages.contains("wrote map.svg"), "{messages}");
    let text = fs::read_to_string(cli.path("map.svg")).expect("text");
    assert!(text.matches("<path").count() >= 4, "{text}");
    for sites in ["line", "likeness", "polygon"] {
        cli.succeeds(&format!(
            "render a.svg b.svg a.svg --quality draft --map 3x1 --sites {sites} --size 90x40 \
             --out map.png"
        ));
        assert_eq!(read_image(&cli.path("map.png")).dimensions(), (90, 40));
    }
    cli.succeeds("render a.svg b.svg a.svg --method field --cells 64 --map 2x2 --out map.png");
    cli.fails(2, "render a.svg b.svg --map 3 --out map.png", "9x9");
    cli.fails(
        2,
        "render a.svg b.svg --map 3x3 --out map.gif",
        "--map makes a single image",
    );
    cli.fails(
        2,
        "render a.svg b.svg --map 3x3 --at 0.5 --out map.png",
        "cannot be used",
    );
    cli.fails(
        1,
        "render a.svg b.svg --warp lines --content field --map 3x3 --out map.png",
        "as distance fields without a warp",
    );
}

#[test]
fn several_designs_are_one_film() {
    let cli = CliFixture::new();
    let json = cli.succeeds("check a.svg b.svg a.svg --samples 3 --quality draft --json");
    let segments: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let title = |k: usize| segments[k]["title"].as_str().map(str::to_owned);
    assert_eq!(
        [title(0), title(1), title(2)],
        [Some("a to b".into()), Some("b to a".into()), None]
    );
    cli.succeeds("new a.svg b.svg a.svg --out three.morph --film");
    let text = fs::read_to_string(cli.path("three.morph")).expect("text");
    assert!(
        text.contains("version = 2") && text.contains("[legs.found]"),
        "{text}"
    );
    cli.succeeds("render three.morph --frames 5 --size 40x30 --out f-#.png");
    let [first, middle, last] =
        ["f-0.png", "f-2.png", "f-4.png"].map(|name| read_image(&cli.path(name)));
    // The first and the last frame show the same design in its own colour, the middle frame shows
    // the other design.
    assert_eq!(first, last);
    assert_ne!(first, middle);
    cli.succeeds("render a.svg b.svg a.svg --quality draft --sheet 5 --out sheet.png");
    cli.succeeds("render a.svg b.svg a.svg --quality draft --out film.html");
    cli.fails(
        2,
        "check a.svg b.svg a.svg --pin 1,2:3,4",
        "exactly two designs",
    );
    cli.fails(
        2,
        "render a.svg b.svg a.svg --compare --out c.png",
        "exactly two designs",
    );
    cli.fails(2, "check a.svg three.morph b.svg", "a single project");
}

#[test]
fn glyphs_and_svg_elements_are_accepted_as_designs() {
    let cli = CliFixture::new();
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"40\">\
        <rect id=\"bar\" width=\"20\" height=\"30\"/><rect x=\"30\" width=\"9\" height=\"9\"/></svg>";
    cli.write("c.svg", svg);
    cli.succeeds("render glyph:D glyph:S --method field --cells 40 --at 0.5 --out ds.png");
    assert!(cli.path("ds.png").is_file());
    fs::create_dir_all(cli.path("deep")).expect("made");
    cli.succeeds("new glyph:D%40 c.svg --quality draft --out deep/p.morph");
    let text = fs::read_to_string(cli.path("deep/p.morph")).expect("read");
    assert!(
        text.contains("\"glyph:D%40\"") && text.contains("\"../c.svg\""),
        "{text}"
    );
    cli.succeeds("render deep/p.morph --cells 40 --at 1 --out out.svg");
    cli.write("bow.json", "[[0, 0], [20, 20], [20, 0], [0, 20]]");
    let table = cli.succeeds("check bow.json c.svg#bar --quality draft --samples 2 --cells 40");
    assert!(table.contains("1 edge crossing was resolved"), "{table}");
    cli.fails(2, "check glyph:D", "a single design");
    cli.fails(1, "check glyph:D glyph:\u{2603}", "U+2603");
}

#[test]
fn a_mistyped_font_is_an_error_and_an_at_sign_in_text_is_possible() {
    let cli = CliFixture::new();
    let render = |text: &str| {
        format!("render {text} glyph:D --method field --cells 40 --at 0 --size 8x8 --out x.png")
    };
    for font in ["missing.ttf", "missing.tff", "fonts/missing", "home.org"] {
        let line = render(&format!("glyph:A@{font}"));
        cli.fails(1, &line, &format!("font {font}: the file does not exist"));
        cli.fails(1, &line, "write %40 for an @");
    }
    for text in ["glyph:me@home", "glyph:me%40home.org"] {
        cli.succeeds(&render(text));
    }
}

#[test]
fn the_gallery_is_listed_and_rendered() {
    let cli = CliFixture::new();
    let json = cli.succeeds("gallery --json");
    let entries: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let first = entries[0]["name"].as_str().expect("a name");
    let listed = cli.succeeds("gallery");
    assert!(listed.starts_with(&format!("gallery:{first} ")));
    cli.succeeds("render gallery:triangle-polar --at 0.5 --size 20x20 --out x.png");
    cli.fails(1, "render gallery:no-such --at 0.5 --out x.png", "no-such");
}

#[test]
fn wrong_usage_exits_with_code_two() {
    let cli = CliFixture::new();
    cli.fails(2, "render a.obj b.obj --at 0.5 --out x.jpg", ".png");
    cli.fails(2, "render a.obj b.obj --out x.png", "--at");
    cli.fails(2, "render a.obj b.obj --at 0.5 --out x.gif", "--at");
    cli.fails(2, "render a.obj b.obj --at nan --out x.png", "finite");
    cli.fails(
        2,
        "render a.obj b.obj --at 0.5 --sheet 3 --out x.png",
        "--sheet",
    );
    cli.fails(
        2,
        "render a.obj b.obj --at 0.5 --size 99999x99999 --out x.png",
        "too large",
    );
    cli.fails(
        2,
        "render a.obj b.obj --at 0.5 --size 0x5 --out x.png",
        "at least 1",
    );
    cli.fails(2, "render a.obj b.obj --frames 0 --out x.gif", "frames");
    cli.fails(
        2,
        "render a.obj b.obj --frames 4 --frames-range 5..2 --out f",
        "A..B",
    );
    cli.fails(
        2,
        "render a.obj b.obj --frames 4 --frames-range 2..9 --out f",
        "0 to 3",
    );
    cli.fails(
        2,
        "render a.obj b.obj --frames 4 --fps 60 --out x.gif",
        "50",
    );
    cli.fails(
        2,
        "render a.obj b.obj --ground puce --at 0 --out x.png",
        "#rrggbb",
    );
    cli.fails(2, "render a.obj --at 0 --out x.png", "a single design");
    cli.fails(2, "render", "--out");
    cli.fails(2, "check a.obj b.obj --samples 1", "--samples");
    assert_eq!(cli.file_names(".").len(), 4, "nothing was written");
}

#[test]
fn render_prints_what_the_import_left_out_once_for_each_design() {
    let cli = CliFixture::new();
    let square = "<path d=\"M5 5H25V35H5Z\"/><image width=\"9\" height=\"9\" href=\"x.png\"/>";
    cli.write(
        "c.svg",
        &format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"40\">{square}</svg>"
        ),
    );
    let runs = [
        ("render c.svg c.svg --at 0 --out x.png", 1),
        ("render c.svg a.svg c.svg --map 2x2 --out m.png", 1),
        ("render a.svg b.svg --at 0 --out y.png", 0),
    ];
    for (line, count) in runs {
        let output = cli.run(line);
        assert_eq!(output.status.code(), Some(0), "{line}");
        let messages = stderr(&output);
        let notes = messages.lines().filter(|line| line.starts_with("c: "));
        assert_eq!(notes.count(), count, "{line}: {messages}");
    }
}

#[test]
fn folders_as_output_and_projects_among_designs_are_wrong_usage() {
    let cli = CliFixture::new();
    let folder = "render a.obj b.obj --at 0.5 --out exist.png";
    fs::create_dir(cli.path("exist.png")).expect("made");
    cli.fails(2, folder, "`exist.png` is a folder: name a file in it");
    for command in ["check", "render --out x.png --at 0"] {
        let line = format!("{command} a.obj x.morph a.svg");
        cli.fails(2, &line, "3 inputs");
        assert_eq!(stderr(&cli.run(&line)).lines().count(), 1, "{line}");
    }
    cli.fails(
        2,
        "chek a.obj b.obj",
        "`chek` is neither a subcommand nor a file",
    );
}

#[test]
fn failures_exit_with_code_one_and_name_the_file() {
    let cli = CliFixture::new();
    cli.write("empty.svg", "");
    cli.write("bad.morph", "version = 1\ncolour = 3\n");
    let at = "--at 0.5 --size 8x8 --out";
    cli.fails(1, &format!("render a.obj none.obj {at} x.png"), "none.obj");
    cli.fails(1, &format!("render none.morph {at} x.png"), "none.morph");
    cli.fails(1, &format!("render bad.morph {at} x.png"), "line 2");
    cli.fails(
        1,
        &format!("render a.svg empty.svg {at} x.png"),
        "empty.svg",
    );
    cli.fails(
        1,
        &format!("render a.obj b.obj {at} none/x.png"),
        "none/x.png",
    );
    cli.fails(
        1,
        "render a.obj b.obj --frames 2 --size 8x8 --out a.obj/f-#.png",
        "a.obj",
    );
    cli.fails(1, "check a.obj none.obj --json", "none.obj");
    assert_eq!(cli.file_names(".").len(), 6, "nothing was written");
}

#[test]
fn help_and_version_go_to_stdout() {
    let cli = CliFixture::new();
    assert!(cli.succeeds("--version").starts_with("morphospace "));
    assert!(cli.succeeds("--help").contains("Examples:"));
    assert!(cli.succeeds("render --help").contains("--frames-range"));
}

#[test]
fn a_defect_is_reported_with_its_t_cause_and_remedy() {
    let cli = CliFixture::new();
    cli.write(
        "turned.obj",
        "v 0 0 0\nv -1 0 0\nv -1 -3 0\nv 0 -3 0\nf 1 2 3\nf 1 3 4\n",
    );
    let table = cli.succeeds("check a.obj turned.obj --homotopy linear");
    for text in [
        "2 faces fold near t = 0.38, at (",
        "Cause: straight",
        "Fix: use polar interpolation",
    ] {
        assert!(table.contains(text), "{text}: {table}");
    }
    let json = cli.succeeds("check a.obj turned.obj --homotopy linear --json");
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let finding = &report["verdict"]["findings"][0];
    assert_eq!(finding["trouble"]["kind"], "folds");
    assert_eq!(finding["cause"]["kind"], "straight-paths");
    assert_eq!(finding["remedy"]["left"], 0);
    assert!(finding["t"].is_number() && finding["place"][1].is_number());
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_the_program_quietly() {
    let cli = CliFixture::new();
    let mut command = cli.command("check a.obj b.obj --samples 2000 --json");
    command.stdout(std::process::Stdio::piped());
    command.stderr(std::process::Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stderr(&output), "");
}

/// Without a display the window cannot open; a build without the `app` feature has no window.
#[test]
#[cfg(all(feature = "app", target_os = "linux"))]
fn without_a_display_the_program_explains_what_works() {
    let cli = CliFixture::new();
    let mut command = cli.command("a.svg b.svg");
    command.env("HOME", cli.path("."));
    for display in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(display);
    }
    let output = command.output().expect("the program runs");
    let messages = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{messages}");
    let last = messages.lines().last().expect("a sentence");
    assert!(last.contains("no display was found"), "{messages}");
    assert!(!messages.contains("panicked"), "{messages}");
}
