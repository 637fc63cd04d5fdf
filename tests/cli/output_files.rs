//! Tests of every output format of `render`, at small sizes: images, sheets, numbered frames and
//! films. Also tests of the number of frames, and of the flags that override a preset.

use std::fs;
use std::io::BufReader;

use crate::cli_fixture::{CliFixture, read_image, stderr};

#[test]
fn an_image_is_written_as_png_or_svg() {
    let cli = CliFixture::new();
    let stdout = cli.succeeds("render a.obj b.obj --at 0.5 --size 64x48 --out x.png");
    assert_eq!(stdout, "", "stdout is for data");
    let picture = read_image(&cli.path("x.png"));
    assert_eq!(picture.dimensions(), (64, 48));
    assert_eq!(picture.get_pixel(0, 0).0[3], 255);
    cli.succeeds("render a.obj b.obj --at 0.5 --size 64x48 --ground transparent --out x.png");
    assert_eq!(read_image(&cli.path("x.png")).get_pixel(0, 0).0[3], 0);
    cli.succeeds("render a.obj b.obj --at 0.5 --size 64x48 --ground #010203 --out x.png");
    assert_eq!(
        read_image(&cli.path("x.png")).get_pixel(0, 0).0,
        [1, 2, 3, 255]
    );
    cli.succeeds("render a.obj b.obj --at -0.25 --out x.svg");
    let svg = fs::read_to_string(cli.path("x.svg")).expect("text");
    assert!(usvg::Tree::from_str(&svg, &usvg::Options::default()).is_ok());
    assert_eq!(cli.file_names(".").len(), 6, "no temporary file is left");
}

#[test]
fn notes_on_the_import_and_the_transition_are_printed() {
    let cli = CliFixture::new();
    let lossy = r#"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="40">
        <rect id="soft" width="30" height="30" filter="blur(2px)"/></svg>"#;
    cli.write("lossy.svg", lossy);
    let lines = |designs: &str| {
        let output = cli.run(&format!("render {designs} --quality draft --out x.svg"));
        let lines = stderr(&output);
        lines.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(lines("a.svg b.svg --at 0"), ["wrote x.svg"]);
    let expected = ["lossy: filter: ignored (#soft)", "wrote x.svg"];
    // A design that is used twice is reported once.
    assert_eq!(lines("lossy.svg lossy.svg --at 0"), expected);
    assert_eq!(lines("a.svg lossy.svg b.svg --map 2x2"), expected);
    let field = lines("a.svg b.svg --at 0 --method field --cells 64 --metric city-block");
    assert!(
        field[0].contains("boundary runs between cells"),
        "{field:?}"
    );
}

#[test]
fn both_methods_fill_part_of_the_image() {
    let cli = CliFixture::new();
    for line in [
        "a.svg b.svg --cells 64",
        "a.obj b.obj --method field --cells 64 --space real --metric chessboard --boundary binary",
        "a.obj b.obj --method arap --homotopy exponential --one-sided",
    ] {
        cli.succeeds(&format!(
            "render {line} --at 0.4 --size 60x40 --ground transparent --out x.png"
        ));
        let picture = read_image(&cli.path("x.png"));
        let covered = picture.pixels().filter(|p| p.0[3] == 255).count();
        assert!(
            (100..2300).contains(&covered),
            "{line}: {covered} of 2400 pixels"
        );
    }
}

#[test]
fn a_contact_sheet_is_one_image() {
    let cli = CliFixture::new();
    cli.succeeds("render a.obj b.obj --sheet 5 --size 200x50 --out sheet.png");
    assert_eq!(read_image(&cli.path("sheet.png")).dimensions(), (200, 50));
    cli.succeeds("render a.obj b.obj --sheet 9 --out sheet.svg");
    let svg = fs::read_to_string(cli.path("sheet.svg")).expect("text");
    assert_eq!(svg.matches("aria-label=\"t = ").count(), 9);
    assert!(svg.contains("t = 0.125\""));
}

#[test]
fn frame_ranges_render_the_same_frames_as_one_run() {
    let cli = CliFixture::new();
    let job = "render a.obj b.obj --frames 7 --size 32x24 --out";
    cli.succeeds(&format!("{job} whole/f-###.png"));
    cli.succeeds(&format!("{job} split/f-###.png --frames-range 3..7"));
    cli.succeeds(&format!("{job} split/f-###.png --frames-range 0..3"));
    assert_eq!(cli.file_names("whole").len(), 7);
    assert_eq!(cli.file_names("whole"), cli.file_names("split"));
    for name in cli.file_names("whole") {
        let bytes_in = |folder: &str| fs::read(cli.path(folder).join(&name)).expect("read");
        assert!(bytes_in("whole") == bytes_in("split"), "{name}");
    }
    cli.succeeds(&format!("{job} folder"));
    assert_eq!(cli.file_names("folder")[6], "frame-0006.png");
    let at_end = "render a.obj b.obj --at 1 --size 32x24 --out end.png";
    cli.succeeds(at_end);
    let last = read_image(&cli.path("folder/frame-0006.png"));
    assert_eq!(
        last,
        read_image(&cli.path("end.png")),
        "the last frame is t = 1"
    );
}

#[test]
fn without_a_frame_count_the_timing_sets_it() {
    let cli = CliFixture::new();
    let line = "render a.obj b.obj --duration 1 --hold 0.5 --fps 10 --size 8x8 --out f/";
    cli.succeeds(line);
    assert_eq!(cli.file_names("f").len(), 21);
}

#[test]
fn a_gif_has_its_frames_and_delays() {
    let cli = CliFixture::new();
    let frames = |line: &str| -> Vec<u16> {
        cli.succeeds(&format!(
            "render a.obj b.obj {line} --size 40x30 --out x.gif"
        ));
        let file = fs::File::open(cli.path("x.gif")).expect("opened");
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
    let cli = CliFixture::new();
    cli.succeeds(
        "render a.obj b.obj --frames 6 --play loop --size 40x30 --ground transparent --out x.apng",
    );
    let file = BufReader::new(fs::File::open(cli.path("x.apng")).expect("opened"));
    let reader = png::Decoder::new(file).read_info().expect("a PNG");
    let control = reader.info().animation_control().expect("animated");
    assert_eq!((control.num_frames, control.num_plays), (6, 0));
    assert_eq!(reader.info().size(), (40, 30));
}

#[test]
fn flags_override_the_layout_of_a_preset() {
    let cli = CliFixture::new();
    let size = |flags: &str| {
        cli.succeeds(&format!("render a.obj b.obj --at 0 {flags} --out x.png"));
        read_image(&cli.path("x.png")).dimensions()
    };
    assert_eq!(size("--preset deck"), (1920, 1080));
    let story = "--preset story --lines 90 --frame-margin 0.1";
    assert_eq!(size(story), (90, 160));
    assert_eq!(size("--aspect 4:3 --lines 30 --captions"), (40, 30));
    assert_eq!(size("--size 50x20 --captions"), (50, 20));
    cli.fails(2, "render a.obj b.obj --at 0 --lines 0 --out x.png", "0x0");
    cli.fails(
        2,
        "render a.obj b.obj --at 0 --frame-margin 2 --out x.png",
        "0.4",
    );
}
