//! Drives the built program: each kind of output on small sizes, and what goes
//! wrong. Needs no graphics card and no display.

use std::collections::HashMap;
use std::fs;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

const SOURCE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
const TARGET: &str = "v 0 0 0\nv 0 2 0\nv -2 2 0\nv -1 0.2 0\nf 1 2 3\nf 1 3 4\n";

/// A folder with two meshes and two drawings.
struct Workshop(TempDir);

impl Workshop {
    fn new() -> Self {
        let workshop = Self(tempfile::tempdir().expect("a folder"));
        let svg = |shape: &str| {
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"40\">{shape}</svg>"
            )
        };
        workshop.put("a.obj", SOURCE);
        workshop.put("b.obj", TARGET);
        workshop.put(
            "a.svg",
            &svg("<rect x=\"5\" y=\"5\" width=\"20\" height=\"30\"/>"),
        );
        workshop.put("b.svg", &svg("<circle cx=\"40\" cy=\"20\" r=\"12\"/>"));
        workshop
    }

    fn put(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("written");
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_morphospace"));
        command.current_dir(self.0.path());
        command.args(line.split_whitespace());
        command
    }

    fn run(&self, line: &str) -> Output {
        self.command(line).output().expect("the program starts")
    }

    /// Runs a command that must succeed, and returns its stdout.
    fn done(&self, line: &str) -> String {
        let output = self.run(line);
        assert_eq!(output.status.code(), Some(0), "{line}: {}", words(&output));
        String::from_utf8(output.stdout).expect("text")
    }

    /// Runs a command that must end with the code and say the words.
    fn fails(&self, code: i32, line: &str, said: &str) {
        let output = self.run(line);
        let words = words(&output);
        assert_eq!(output.status.code(), Some(code), "{line}: {words}");
        assert!(words.contains(said), "{line} said: {words}");
        assert!(!words.contains("panicked"), "{line}: {words}");
        assert!(output.stdout.is_empty(), "{line} wrote data");
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).expect("listed");
        let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
        let mut names: Vec<_> = entries.map(|e| name(e.expect("an entry"))).collect();
        names.sort();
        names
    }
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn image(path: &Path) -> image::RgbaImage {
    image::open(path).expect("a picture").into_rgba8()
}

#[test]
fn a_picture_is_a_png_or_an_svg() {
    let shop = Workshop::new();
    let stdout = shop.done("render a.obj b.obj --at 0.5 --size 64x48 --out x.png");
    assert_eq!(stdout, "", "stdout is for data");
    let picture = image(&shop.path("x.png"));
    assert_eq!(picture.dimensions(), (64, 48));
    assert_eq!(picture.get_pixel(0, 0).0[3], 255);
    shop.done("render a.obj b.obj --at 0.5 --size 64x48 --ground transparent --out x.png");
    assert_eq!(image(&shop.path("x.png")).get_pixel(0, 0).0[3], 0);
    shop.done("render a.obj b.obj --at 0.5 --size 64x48 --ground #010203 --out x.png");
    assert_eq!(image(&shop.path("x.png")).get_pixel(0, 0).0, [1, 2, 3, 255]);
    shop.done("render a.obj b.obj --at -0.25 --out x.svg");
    let svg = fs::read_to_string(shop.path("x.svg")).expect("text");
    assert!(usvg::Tree::from_str(&svg, &usvg::Options::default()).is_ok());
    assert_eq!(shop.names(".").len(), 6, "no temporary file is left");
}

#[test]
fn both_methods_draw_something() {
    let shop = Workshop::new();
    for line in [
        "a.svg b.svg --cells 64",
        "a.obj b.obj --method field --cells 64 --space real --metric chessboard --boundary binary",
        "a.obj b.obj --method arap --homotopy exponential --one-sided",
    ] {
        shop.done(&format!(
            "render {line} --at 0.4 --size 60x40 --ground transparent --out x.png"
        ));
        let picture = image(&shop.path("x.png"));
        let covered = picture.pixels().filter(|p| p.0[3] == 255).count();
        assert!(
            (100..2300).contains(&covered),
            "{line}: {covered} of 2400 pixels"
        );
    }
}

#[test]
fn a_sheet_is_one_picture() {
    let shop = Workshop::new();
    shop.done("render a.obj b.obj --sheet 5 --size 200x50 --out sheet.png");
    assert_eq!(image(&shop.path("sheet.png")).dimensions(), (200, 50));
    shop.done("render a.obj b.obj --sheet 9 --out sheet.svg");
    let svg = fs::read_to_string(shop.path("sheet.svg")).expect("text");
    assert_eq!(svg.matches("aria-label=\"t = ").count(), 9);
    assert!(svg.contains("t = 0.125\""));
}

#[test]
fn numbered_pictures_split_into_parts() {
    let shop = Workshop::new();
    let job = "render a.obj b.obj --frames 7 --size 32x24 --out";
    shop.done(&format!("{job} whole/f-###.png"));
    shop.done(&format!("{job} split/f-###.png --frames-range 3..7"));
    shop.done(&format!("{job} split/f-###.png --frames-range 0..3"));
    assert_eq!(shop.names("whole").len(), 7);
    assert_eq!(shop.names("whole"), shop.names("split"));
    for name in shop.names("whole") {
        let of = |folder: &str| fs::read(shop.path(folder).join(&name)).expect("read");
        assert!(of("whole") == of("split"), "{name}");
    }
    shop.done(&format!("{job} folder"));
    assert_eq!(shop.names("folder")[6], "frame-0006.png");
    let at_end = "render a.obj b.obj --at 1 --size 32x24 --out end.png";
    shop.done(at_end);
    let last = image(&shop.path("folder/frame-0006.png"));
    assert_eq!(
        last,
        image(&shop.path("end.png")),
        "the last frame is t = 1"
    );
}

#[test]
fn without_a_count_the_timing_decides() {
    let shop = Workshop::new();
    let line = "render a.obj b.obj --duration 1 --hold 0.5 --fps 10 --size 8x8 --out f/";
    shop.done(line);
    assert_eq!(shop.names("f").len(), 21);
}

#[test]
fn a_gif_has_its_frames_and_delays() {
    let shop = Workshop::new();
    let frames = |line: &str| -> Vec<u16> {
        shop.done(&format!(
            "render a.obj b.obj {line} --size 40x30 --out x.gif"
        ));
        let file = fs::File::open(shop.path("x.gif")).expect("opened");
        let mut decoder = gif::DecodeOptions::new().read_info(file).expect("a GIF");
        assert_eq!((decoder.width(), decoder.height()), (40, 30));
        let mut delays = vec![];
        while let Some(frame) = decoder.read_next_frame().expect("a frame") {
            delays.push(frame.delay);
        }
        delays
    };
    assert_eq!(frames("--frames 5 --fps 25 --play once"), [4; 5]);
    assert_eq!(frames("--frames 5 --fps 25 --play ping-pong"), [4; 8]);
    let timed = frames("--duration 1 --hold 0.5 --fps 20 --play loop");
    assert_eq!(
        timed.iter().sum::<u16>(),
        205,
        "two seconds and the last frame"
    );
    assert!(timed.len() < 30, "holds are one frame: {timed:?}");
}

#[test]
fn an_apng_has_its_frames() {
    let shop = Workshop::new();
    shop.done(
        "render a.obj b.obj --frames 6 --play loop --size 40x30 --ground transparent --out x.apng",
    );
    let file = BufReader::new(fs::File::open(shop.path("x.apng")).expect("opened"));
    let reader = png::Decoder::new(file).read_info().expect("a PNG");
    let control = reader.info().animation_control().expect("animated");
    assert_eq!((control.num_frames, control.num_plays), (6, 0));
    assert_eq!(reader.info().size(), (40, 30));
}

/// What ffprobe finds: width, height and frames; `None` without ffmpeg.
fn probe(path: &Path) -> Option<String> {
    let output = Command::new("ffprobe")
        .args("-v error -count_frames -select_streams v:0".split(' '))
        .args("-show_entries stream=width,height,nb_read_frames -of csv=p=0".split(' '))
        .arg(path)
        .output()
        .ok()?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

#[test]
#[expect(clippy::print_stderr, reason = "a test that cannot run says so")]
fn an_mp4_has_even_sides_and_its_frames() {
    let shop = Workshop::new();
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        eprintln!("NOT TESTED: writing MP4, for there is no ffmpeg on the path");
        return;
    }
    shop.done("render a.obj b.obj --frames 6 --play once --size 41x29 --out x.mp4");
    assert_eq!(probe(&shop.path("x.mp4")).as_deref(), Some("42,30,6"));
    assert_eq!(shop.names(".").len(), 5, "no temporary file is left");
    let transparent = "render a.obj b.obj --frames 2 --ground transparent --out x.mp4";
    shop.fails(2, transparent, "transparent");
}

#[test]
fn without_ffmpeg_an_mp4_says_what_to_do() {
    let shop = Workshop::new();
    let mut command = shop.command("render a.obj b.obj --frames 2 --size 8x8 --out x.mp4");
    let output = command
        .env("PATH", "")
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(1));
    assert!(words(&output).contains("ffmpeg"), "{}", words(&output));
    assert_eq!(shop.names(".").len(), 4, "nothing is left");
}

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

/// A report's rows by the names of its columns.
fn rows(path: &Path) -> Vec<HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).expect("a report");
    let rows = reader.deserialize();
    rows.map(|row| row.expect("a row")).collect()
}

#[test]
fn a_table_of_pairs_gives_a_row_each() {
    let shop = Workshop::new();
    fs::create_dir(shop.path("sub")).expect("made");
    shop.put(
        "sub/pairs.csv",
        "\u{feff}kind,source,target\n\"a, \"\"b\"\"\",../a.obj,../b.obj\ndrawn,../a.svg,../b.svg\n",
    );
    let line = "check --pairs sub/pairs.csv --out report.csv --sheet sheet.png --samples 5";
    let summary = shop.done(&format!("{line} --both"));
    assert!(summary.starts_with("pairs  "), "{summary}");
    let found = rows(&shop.path("report.csv"));
    let directions: Vec<_> = found.iter().map(|row| row["direction"].as_str()).collect();
    assert_eq!(directions, ["forward", "backward", "forward", "backward"]);
    assert_eq!(found[1]["kind"], "a, \"b\"");
    for row in &found {
        let told = ["status", "samples", "method"].map(|column| row[column].as_str());
        assert_eq!(told, ["ok", "5", "arap"]);
        for column in ["build_s", "match_and_triangulate_s", "conformal_worst"] {
            assert!(
                row[column].parse::<f64>().expect("a number") > 0.0,
                "{column}"
            );
        }
    }
    let worst = |row: usize| found[row]["conformal_worst"].parse::<f64>();
    let [there, back] = [worst(0), worst(1)].map(|x| x.expect("a number"));
    assert!((there / back - 1.0).abs() < 1e-9, "{there} {back}");
    assert!(image(&shop.path("sheet.png")).width() > 600);
    assert_eq!(shop.names(".").len(), 7, "no temporary file is left");
}

#[test]
fn a_table_of_fields_is_written_over_the_last_one() {
    let shop = Workshop::new();
    shop.put("pairs.csv", "source,target\na.svg,b.obj\n");
    shop.put("report.csv", "old");
    let line = "check --pairs pairs.csv --out report.csv --method field --cells 48 --samples 5";
    let json = shop.done(&format!("{line} --json"));
    let summary: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(
        (&summary["pairs"], &summary["failures"]),
        (&1.into(), &0.into())
    );
    let found = rows(&shop.path("report.csv"));
    let told = ["method", "faces", "grid_width_cells"].map(|column| found[0][column].as_str());
    assert_eq!(told, ["field", "", "48"]);
    assert_eq!(found[0]["pieces_excess"].parse::<usize>(), Ok(0));
}

#[test]
fn a_table_goes_on_past_failures() {
    let shop = Workshop::new();
    shop.put("bad.obj", "v 0 0 0\nf 1 2 3\n");
    shop.put(
        "pairs.csv",
        "source,target,kind\nnone.obj,a.obj,1\na.obj,bad.obj,2\na.obj,b.obj\n,b.obj,4\na.obj,.,5\na.obj,b.obj,6\n",
    );
    let output = shop.run("check --pairs pairs.csv --out r.csv --sheet s.svg --samples 3");
    let said = words(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("5 of 6 pairs failed, the first in line 2"),
        "{said}"
    );
    assert!(!said.contains("panicked"), "{said}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("failures"));
    let found = rows(&shop.path("r.csv"));
    let status: Vec<_> = found.iter().map(|row| row["status"].as_str()).collect();
    for (status, said) in status
        .iter()
        .zip(["none.obj", "bad.obj", "2 cells", "empty", ""])
    {
        assert!(status.contains(said) && *status != "ok", "{status}");
    }
    assert_eq!(status[5], "ok");
    assert_eq!(
        (found[0]["kind"].as_str(), found[2]["kind"].as_str()),
        ("1", "")
    );
    let svg = fs::read_to_string(shop.path("s.svg")).expect("a sheet");
    assert!(svg.contains("failed") && svg.contains("a to b"));
}

#[test]
fn hostile_tables_are_refused_in_words() {
    let shop = Workshop::new();
    let go = |name: &str| format!("check --pairs {name} --out out.csv");
    shop.fails(1, &go("missing.csv"), "missing.csv");
    shop.fails(1, &go("."), "cannot be read");
    for (text, said) in [
        ("", "empty"),
        ("source,target\n", "no pairs"),
        ("source,kind\na,b\n", "no column `target`"),
        ("source;target\na;b\n", "separate columns by commas"),
        (
            "source,target,target\na,b,c\n",
            "two columns are called `target`",
        ),
        ("source,target,faces\na,b,c\n", "`faces`"),
        ("\"source,target\na,b\n", "no column"),
    ] {
        shop.put("t.csv", text);
        shop.fails(1, &go("t.csv"), said);
    }
    fs::write(shop.path("t.csv"), b"\xff\xfes\0o\0u\0").expect("written");
    shop.fails(1, &go("t.csv"), "UTF-8");
    fs::write(shop.path("t.csv"), b"source,target\n\xff.obj,a.obj\n").expect("written");
    let output = shop.run(&go("t.csv"));
    assert_eq!(output.status.code(), Some(1), "{}", words(&output));
    let report = fs::read(shop.path("out.csv")).expect("a report");
    assert!(
        report.windows(5).any(|w| w == b"\xff.obj"),
        "carried along as it is"
    );
}

#[test]
fn tables_are_used_rightly_or_not_at_all() {
    let shop = Workshop::new();
    shop.put("t.csv", "source,target\na.obj,b.obj\n");
    shop.fails(2, "check", "PROJECT");
    shop.fails(2, "check --pairs t.csv", "--out");
    shop.fails(2, "check a.obj b.obj --out x.csv", "--pairs");
    shop.fails(2, "check a.obj b.obj --both", "--pairs");
    shop.fails(2, "check a.obj b.obj --pairs t.csv --out x.csv", "--pairs");
    shop.fails(2, "check --pairs t.csv --out t.csv", "the table itself");
    shop.fails(2, "check --pairs t.csv --out ./t.csv", "the table itself");
    shop.fails(
        2,
        "check --pairs t.csv --out x.csv --sheet x.gif",
        ".png or .svg",
    );
    shop.fails(
        2,
        "check --pairs t.csv --out x.svg --sheet x.svg",
        "two names",
    );
    shop.fails(1, "check --pairs t.csv --out none/x.csv", "none/x.csv");
    shop.fails(
        1,
        "check --pairs t.csv --out x.csv --sheet none/x.png",
        "none/x.png",
    );
    assert_eq!(shop.names(".").len(), 5, "nothing was written");
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
