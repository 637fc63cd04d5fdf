//! Drives the built program: each kind of output on small sizes, and what goes
//! wrong. Needs no graphics card and no display.

mod pictures;
mod tables;
mod workshop;

use std::fs;

use crate::workshop::{Workshop, image, words};

#[test]
fn a_check_is_one_json_object() {
    let shop = Workshop::new();
    let json = shop.done("check a.obj b.obj --samples 5 --json");
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
    let json = shop.done("check a.svg b.svg --method field --cells 64 --samples 3 --json");
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(
        (&report["content"], &report["mesh"]),
        (&"field".into(), &().into())
    );
    assert_eq!(report["grid"][0], 64);
    let table = shop.done("check a.obj b.obj --samples 5");
    assert!(table.lines().any(|line| line.starts_with("time  ")));
    let verdict = "verdict      no folds, no crossings";
    assert!(table.lines().any(|line| line == verdict), "{table}");
    assert!(table.lines().count() < 40, "{table}");
    let long = table.lines().find(|line| line.chars().count() > 110);
    assert_eq!(long, None);
}

#[test]
fn a_check_tells_what_was_done_otherwise_than_asked() {
    let shop = Workshop::new();
    let check = "check a.svg b.svg --method field --cells 64 --samples 3 --metric city-block";
    let said = "boundary runs between cells";
    let table = shop.done(check);
    let is_note = |line: &str| line.starts_with("note  ") && line.contains(said);
    assert!(table.lines().any(is_note), "{table}");
    let json = shop.done(&format!("{check} --json"));
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let note = report["verdict"]["notes"][0].as_str().expect("a note");
    assert!(note.contains(said), "{note}");
    let table = shop.done(&format!("{check} --boundary binary"));
    assert!(!table.contains(said), "{table}");
}

#[test]
fn a_new_project_is_rendered_from_anywhere() {
    let shop = Workshop::new();
    fs::create_dir(shop.path("sub")).expect("made");
    shop.done("new a.svg b.svg --out sub/pair.morph --cells 64 --epsilon 2");
    let text = fs::read_to_string(shop.path("sub/pair.morph")).expect("text");
    assert!(
        text.contains("../a.svg") && text.contains("epsilon = 2.0"),
        "{text}"
    );
    shop.done("render sub/pair.morph --at 0 --size 30x20 --out x.png");
    assert_eq!(image(&shop.path("x.png")).dimensions(), (30, 20));
    shop.fails(1, "new a.svg b.svg --out sub/pair.morph", "--force");
    shop.fails(2, "new a.svg b.svg --out pair.txt", ".morph");
    shop.fails(1, "new a.svg missing.svg --out p.morph", "missing.svg");
}

#[test]
fn a_new_project_may_keep_its_film() {
    let shop = Workshop::new();
    shop.done("new a.svg b.svg --out plain.morph");
    shop.done("new a.svg b.svg --out kept.morph --film");
    let [plain, kept] = ["plain", "kept"].map(|name| {
        let text = fs::read_to_string(shop.path(&format!("{name}.morph"))).expect("text");
        let report = shop.done(&format!("check {name}.morph --json"));
        let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
        (text.contains("[found]"), report)
    });
    assert_eq!([plain.0, kept.0], [false, true]);
    let stages = |report: &serde_json::Value| report["seconds"]["stages"].as_object().cloned();
    let is_matched =
        |report: &serde_json::Value| stages(report).expect("stages").contains_key("matching");
    assert!(is_matched(&plain.1) && !is_matched(&kept.1));
    assert_eq!(kept.1["seconds"]["match"].to_string(), "0.0");
    assert_eq!(plain.1["distortion"], kept.1["distortion"]);
    // What the films decide on is written down: bars across each other tear as fields.
    for (name, d) in [
        ("lying", "M0 40H100V60H0Z"),
        ("standing", "M40 0H60V100H40Z"),
    ] {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg'><path d='{d}'/></svg>");
        shop.put(&format!("{name}.svg"), &svg);
    }
    shop.done("new lying.svg standing.svg --out auto.morph --method auto --cells 64");
    let text = fs::read_to_string(shop.path("auto.morph")).expect("text");
    assert!(text.contains("warp = \"arap\"") && text.contains("content = \"solid\""));
    assert!(!text.contains("[found]"), "{text}");
    // A field needs no film.
    shop.done("new a.svg b.svg --out field.morph --film --method field");
    let text = fs::read_to_string(shop.path("field.morph")).expect("text");
    assert!(!text.contains("[found]"));
}

#[test]
fn a_path_over_the_map_is_a_film_and_what_is_kept_is_written() {
    let shop = Workshop::new();
    let document = |map: &str| {
        let designs =
            ["a.svg", "b.svg", "a.svg"].map(|path| format!("[[designs]]\npath = \"{path}\"\n"));
        let text = format!("version = 2\n{}[timing]\nto = 2.0\n{map}", designs.concat());
        fs::write(shop.path("walk.morph"), text).expect("a project");
    };
    document("");
    shop.fails(1, "catalogue walk.morph --out kept", "keeps no places");
    document(
        "[map.path]\nplaces = [{ at = [0.0, 1.0] }, { at = [0.1, 0.1], passed = true }, \
         { at = [0.0, 0.0], name = \"Middle\" }, { at = [0.4, -0.2] }]\n\
         [[map.kept]]\nat = [0.0, 0.0]\nname = \"Half, and half\"\nstars = 2\n",
    );
    shop.done("render walk.morph --frames 3 --out f-#.png");
    let [first, middle] = ["f-0.png", "f-1.png"].map(|name| image(&shop.path(name)));
    assert_eq!(first.dimensions(), middle.dimensions());
    assert_ne!(first, middle);
    let json = shop.done("check walk.morph --samples 3 --json");
    let legs: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let legs = legs.as_array().expect("two legs");
    assert_eq!(legs.len(), 2);
    assert_eq!(legs[1]["title"], "Middle to ");
    assert_eq!(legs[0]["verdict"]["words"], "no folds, no crossings");
    let told = words(&shop.run("catalogue walk.morph --out kept --sort stars"));
    assert!(told.contains("wrote 4 files of 1 kept places"), "{told}");
    assert!(shop.path("kept/01-Half-and-half.svg").exists());
    shop.fails(1, "catalogue walk.morph --out kept --stars 3", "3 stars");
    shop.fails(
        2,
        "catalogue walk.morph --out kept --sort size",
        "kept, stars",
    );
    // Of all designs, where others are of two.
    shop.fails(
        2,
        "render walk.morph --compare --out c.png",
        "of two designs",
    );
}

#[test]
fn many_designs_are_one_map() {
    let shop = Workshop::new();
    let told = words(&shop.run("render a.svg b.svg a.svg --map 3x2 --out map.svg"));
    assert!(told.contains("wrote map.svg"), "{told}");
    let text = fs::read_to_string(shop.path("map.svg")).expect("text");
    assert!(text.matches("<path").count() >= 4, "{text}");
    for sites in ["line", "likeness", "polygon"] {
        shop.done(&format!(
            "render a.svg b.svg a.svg --map 3x1 --sites {sites} --size 90x40 --out map.png"
        ));
        assert_eq!(image(&shop.path("map.png")).dimensions(), (90, 40));
    }
    shop.done("render a.svg b.svg a.svg --method field --cells 64 --map 2x2 --out map.png");
    shop.fails(2, "render a.svg b.svg --map 3 --out map.png", "9x9");
    shop.fails(
        2,
        "render a.svg b.svg --map 3x3 --out map.gif",
        "--map makes one picture",
    );
    shop.fails(
        2,
        "render a.svg b.svg --map 3x3 --at 0.5 --out map.png",
        "cannot be used",
    );
    shop.fails(
        1,
        "render a.svg b.svg --warp lines --content field --map 3x3 --out map.png",
        "rigid parts or as fields",
    );
}

#[test]
fn many_designs_are_one_film() {
    let shop = Workshop::new();
    let legs = shop.done("check a.svg b.svg a.svg --samples 3 --quality draft --json");
    let legs: serde_json::Value = serde_json::from_str(&legs).expect("JSON");
    let titles = |k: usize| legs[k]["title"].as_str().map(str::to_owned);
    assert_eq!(
        [titles(0), titles(1), titles(2)],
        [Some("a to b".into()), Some("b to a".into()), None]
    );
    shop.done("new a.svg b.svg a.svg --out three.morph --film");
    let text = fs::read_to_string(shop.path("three.morph")).expect("text");
    assert!(
        text.contains("version = 2") && text.contains("[legs.found]"),
        "{text}"
    );
    shop.done("render three.morph --frames 5 --size 40x30 --out f-#.png");
    let [first, middle, last] =
        ["f-0.png", "f-2.png", "f-4.png"].map(|name| image(&shop.path(name)));
    // The same design in the colours of both ends, and the other between them.
    assert_ne!(first, last);
    assert_ne!(first, middle);
    shop.done("render a.svg b.svg a.svg --sheet 5 --out sheet.png");
    shop.done("render a.svg b.svg a.svg --out film.html");
    shop.fails(2, "check a.svg b.svg a.svg --pin 1,2:3,4", "of two designs");
    shop.fails(
        2,
        "render a.svg b.svg a.svg --compare --out c.png",
        "of two designs",
    );
    shop.fails(2, "check a.svg three.morph b.svg", "one project alone");
}

#[test]
fn text_and_elements_are_designs_like_any_other() {
    let shop = Workshop::new();
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"40\">\
        <rect id=\"bar\" width=\"20\" height=\"30\"/><rect x=\"30\" width=\"9\" height=\"9\"/></svg>";
    shop.put("c.svg", svg);
    shop.done("render glyph:D glyph:S --method field --cells 40 --at 0.5 --out ds.png");
    assert!(shop.path("ds.png").is_file());
    fs::create_dir_all(shop.path("deep")).expect("made");
    shop.done("new glyph:D%40 c.svg --out deep/p.morph");
    let text = fs::read_to_string(shop.path("deep/p.morph")).expect("read");
    assert!(
        text.contains("\"glyph:D%40\"") && text.contains("\"../c.svg\""),
        "{text}"
    );
    shop.done("render deep/p.morph --cells 40 --at 1 --out out.svg");
    shop.put("bow.json", "[[0, 0], [20, 20], [20, 0], [0, 20]]");
    let table = shop.done("check bow.json c.svg#bar --samples 2 --cells 40");
    assert!(
        table.contains("1 crossing of edges was resolved"),
        "{table}"
    );
    shop.fails(2, "check glyph:D", "one design");
    shop.fails(1, "check glyph:D glyph:\u{2603}", "U+2603");
}

#[test]
fn the_gallery_is_listed_and_rendered() {
    let shop = Workshop::new();
    let json = shop.done("gallery --json");
    let entries: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let first = entries[0]["name"].as_str().expect("a name");
    let listed = shop.done("gallery");
    assert!(listed.starts_with(&format!("gallery:{first} ")));
    shop.done("render gallery:triangle-polar --at 0.5 --size 20x20 --out x.png");
    shop.fails(1, "render gallery:no-such --at 0.5 --out x.png", "no-such");
}

#[test]
fn wrong_use_ends_with_two() {
    let shop = Workshop::new();
    shop.fails(2, "render a.obj b.obj --at 0.5 --out x.jpg", ".png");
    shop.fails(2, "render a.obj b.obj --out x.png", "--at");
    shop.fails(2, "render a.obj b.obj --at 0.5 --out x.gif", "--at");
    shop.fails(2, "render a.obj b.obj --at nan --out x.png", "finite");
    shop.fails(
        2,
        "render a.obj b.obj --at 0.5 --sheet 3 --out x.png",
        "--sheet",
    );
    shop.fails(
        2,
        "render a.obj b.obj --at 0.5 --size 99999x99999 --out x.png",
        "too large",
    );
    shop.fails(
        2,
        "render a.obj b.obj --at 0.5 --size 0x5 --out x.png",
        "at least 1",
    );
    shop.fails(2, "render a.obj b.obj --frames 0 --out x.gif", "frames");
    shop.fails(
        2,
        "render a.obj b.obj --frames 4 --frames-range 5..2 --out f",
        "A..B",
    );
    shop.fails(
        2,
        "render a.obj b.obj --frames 4 --frames-range 2..9 --out f",
        "0 to 3",
    );
    shop.fails(
        2,
        "render a.obj b.obj --frames 4 --fps 60 --out x.gif",
        "50",
    );
    shop.fails(
        2,
        "render a.obj b.obj --ground puce --at 0 --out x.png",
        "#rrggbb",
    );
    shop.fails(2, "render a.obj --at 0 --out x.png", "one design");
    shop.fails(2, "render", "--out");
    shop.fails(2, "check a.obj b.obj --samples 1", "--samples");
    assert_eq!(shop.names(".").len(), 4, "nothing was written");
}

#[test]
fn a_folder_and_a_project_among_designs_are_wrong_use() {
    let shop = Workshop::new();
    let folder = "render a.obj b.obj --at 0.5 --out exist.png";
    fs::create_dir(shop.path("exist.png")).expect("made");
    shop.fails(2, folder, "`exist.png` is a folder: name a file in it");
    for command in ["check", "render --out x.png --at 0"] {
        let line = format!("{command} a.obj x.morph a.svg");
        shop.fails(2, &line, "3 inputs");
        assert_eq!(words(&shop.run(&line)).lines().count(), 1, "{line}");
    }
    shop.fails(
        2,
        "chek a.obj b.obj",
        "`chek` is neither a subcommand nor a file",
    );
}

#[test]
fn failures_end_with_one_and_name_the_file() {
    let shop = Workshop::new();
    shop.put("empty.svg", "");
    shop.put("bad.morph", "version = 1\ncolour = 3\n");
    let at = "--at 0.5 --size 8x8 --out";
    shop.fails(1, &format!("render a.obj none.obj {at} x.png"), "none.obj");
    shop.fails(1, &format!("render none.morph {at} x.png"), "none.morph");
    shop.fails(1, &format!("render bad.morph {at} x.png"), "line 2");
    shop.fails(
        1,
        &format!("render a.svg empty.svg {at} x.png"),
        "empty.svg",
    );
    shop.fails(
        1,
        &format!("render a.obj b.obj {at} none/x.png"),
        "none/x.png",
    );
    shop.fails(
        1,
        "render a.obj b.obj --frames 2 --size 8x8 --out a.obj/f-#.png",
        "a.obj",
    );
    shop.fails(1, "check a.obj none.obj --json", "none.obj");
    assert_eq!(shop.names(".").len(), 6, "nothing was written");
}

#[test]
fn help_and_version_are_data() {
    let shop = Workshop::new();
    assert!(shop.done("--version").starts_with("morphospace "));
    assert!(shop.done("--help").contains("Examples:"));
    assert!(shop.done("render --help").contains("--frames-range"));
}

#[test]
fn a_verdict_names_t_cause_and_remedy() {
    let shop = Workshop::new();
    shop.put(
        "turned.obj",
        "v 0 0 0\nv -1 0 0\nv -1 -3 0\nv 0 -3 0\nf 1 2 3\nf 1 3 4\n",
    );
    let table = shop.done("check a.obj turned.obj --homotopy linear");
    for words in [
        "2 faces fold at t = 0.38, about (",
        "cause: straight",
        "polar homotopy",
    ] {
        assert!(table.contains(words), "{words}: {table}");
    }
    let json = shop.done("check a.obj turned.obj --homotopy linear --json");
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let finding = &report["verdict"]["findings"][0];
    assert_eq!(finding["trouble"]["kind"], "folds");
    assert_eq!(finding["cause"]["kind"], "straight-paths");
    assert_eq!(finding["remedy"]["left"], 0);
    assert!(finding["t"].is_number() && finding["place"][1].is_number());
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_crash() {
    let shop = Workshop::new();
    let mut command = shop.command("check a.obj b.obj --samples 2000 --json");
    command.stdout(std::process::Stdio::piped());
    command.stderr(std::process::Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!(output.status.code(), Some(0), "{}", words(&output));
    assert_eq!(words(&output), "");
}

/// Where there is a window to open, and nowhere to open it.
#[test]
#[cfg(all(feature = "app", target_os = "linux"))]
fn without_a_display_the_window_says_what_there_is_instead() {
    let shop = Workshop::new();
    let mut command = shop.command("a.svg b.svg");
    command.env("HOME", shop.path("."));
    for display in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(display);
    }
    let output = command.output().expect("the program runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    let last = said.lines().last().expect("a sentence");
    assert!(last.contains("there is no display"), "{said}");
    assert!(!said.contains("panicked"), "{said}");
}
