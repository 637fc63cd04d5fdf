//! Each kind of picture and film, on small sizes.

use std::fs;
use std::io::BufReader;
use std::path::Path;
use std::process::Command;

use crate::workshop::{Workshop, image, words};

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
fn presets_shape_pictures_and_flags_go_before_them() {
    let shop = Workshop::new();
    let size = |flags: &str| {
        shop.done(&format!("render a.obj b.obj --at 0 {flags} --out x.png"));
        image(&shop.path("x.png")).dimensions()
    };
    assert_eq!(size("--preset deck"), (1920, 1080));
    let story = "--preset story --lines 90 --frame-margin 0.1";
    assert_eq!(size(story), (90, 160));
    assert_eq!(size("--aspect 4:3 --lines 30 --captions"), (40, 30));
    assert_eq!(size("--size 50x20 --captions"), (50, 20));
    shop.fails(2, "render a.obj b.obj --at 0 --lines 0 --out x.png", "0x0");
    shop.fails(
        2,
        "render a.obj b.obj --at 0 --frame-margin 2 --out x.png",
        "0.4",
    );
}
