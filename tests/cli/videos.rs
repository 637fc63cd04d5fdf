//! Tests of videos, encoded and read back by ffmpeg. If ffmpeg is missing, they say so.

use std::path::Path;
use std::process::Command;

use image::RgbaImage;

use crate::cli_fixture::{CliFixture, read_image, stderr};

/// Returns whether ffmpeg is installed, and prints that a test was skipped if it is not.
#[expect(clippy::print_stderr, reason = "a skipped test is reported")]
fn has_ffmpeg(test: &str) -> bool {
    let is_there = Command::new("ffmpeg").arg("-version").output().is_ok();
    if !is_there {
        eprintln!("NOT TESTED: {test}, because ffmpeg is not on the path");
    }
    is_there
}

/// Codec, width, height, pixel format, colours and number of frames of a video, as `ffprobe` prints
/// them.
fn probe(path: &Path) -> String {
    let output = Command::new("ffprobe")
        .args("-v error -count_frames -select_streams v:0".split(' '))
        .args(
            "-show_entries stream=codec_name,width,height,color_space,nb_read_frames -of csv=p=0"
                .split(' '),
        )
        .arg(path)
        .output()
        .expect("ffprobe, which is installed with ffmpeg");
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

/// Decodes all frames of a video of the given size, with their opacity.
fn decode(path: &Path, [width, height]: [u32; 2]) -> Vec<RgbaImage> {
    // ffmpeg's own decoder of VP9 ignores the opacity.
    let is_webm = path
        .extension()
        .is_some_and(|extension| extension == "webm");
    let decoder: &[&str] = if is_webm {
        &["-c:v", "libvpx-vp9"]
    } else {
        &[]
    };
    let output = Command::new("ffmpeg")
        .args(["-v", "error"])
        .args(decoder)
        .arg("-i")
        .arg(path)
        .args("-f rawvideo -pix_fmt rgba -".split(' '))
        .output()
        .expect("ffmpeg");
    assert!(output.status.success(), "{}", stderr(&output));
    let frames = output.stdout.chunks_exact((4 * width * height) as usize);
    frames
        .map(|bytes| RgbaImage::from_raw(width, height, bytes.to_vec()).expect("a frame"))
        .collect()
}

#[test]
fn videos_have_even_sides_and_all_frames() {
    if !has_ffmpeg("the size of videos") {
        return;
    }
    let cli = CliFixture::new();
    for (file, codec) in [("x.mp4", "h264"), ("x.webm", "vp9"), ("x.mov", "prores")] {
        cli.succeeds(&format!(
            "render a.obj b.obj --frames 6 --play once --size 41x29 --out {file}"
        ));
        let expected = format!("{codec},42,30,bt709,6");
        assert_eq!(probe(&cli.path(file)), expected, "{file}");
        // Without transparency, every frame is opaque.
        let frames = decode(&cli.path(file), [42, 30]);
        let mut pixels = frames.iter().flat_map(RgbaImage::pixels);
        assert!(pixels.all(|pixel| pixel.0[3] == 255), "{file}");
    }
    assert_eq!(cli.file_names(".").len(), 7, "no temporary file is left");
}

#[test]
fn an_mp4_with_transparency_is_refused_with_the_formats_that_have_it() {
    let cli = CliFixture::new();
    let transparent = "render a.obj b.obj --frames 2 --ground transparent --out x.mp4";
    for way_out in [".webm", ".mov", ".apng", ".png", "background"] {
        cli.fails(2, transparent, way_out);
    }
}

#[test]
fn the_opacity_and_the_colours_of_transparent_videos_read_back() {
    if !has_ffmpeg("the opacity of videos") {
        return;
    }
    let cli = CliFixture::new();
    let size = [160, 120];
    let film = "render a.svg b.svg --frames 5 --play once --size 160x120 --ground transparent";
    cli.succeeds(&format!("{film} --out own-#.png"));
    let own: Vec<RgbaImage> = (0..5)
        .map(|k| read_image(&cli.path(&format!("own-{k}.png"))))
        .collect();
    for (file, max_mean, max_far) in [("x.webm", 1.0, 0.002), ("x.mov", 0.3, 0.0)] {
        cli.succeeds(&format!("{film} --out {file}"));
        let read = decode(&cli.path(file), size);
        assert_eq!(read.len(), own.len(), "{file}");
        for (k, (own, read)) in own.iter().zip(&read).enumerate() {
            let both = || own.pixels().zip(read.pixels());
            let count = both().count() as f64;
            let differences: Vec<u8> = both().map(|(a, b)| a.0[3].abs_diff(b.0[3])).collect();
            let mean = differences.iter().map(|&d| f64::from(d)).sum::<f64>() / count;
            let far = differences.iter().filter(|&&d| d > 32).count() as f64 / count;
            assert!(mean <= max_mean, "{file}, frame {k}: opacity off by {mean}");
            assert!(
                far <= max_far,
                "{file}, frame {k}: {far} of the opacity is far off"
            );
            // The ground is transparent and the shapes are opaque, so the test can fail.
            let shares = [0u8, 255].map(|level| both().filter(|(a, _)| a.0[3] == level).count());
            assert!(shares.into_iter().all(|share| share > 500), "{shares:?}");
            // Pixels at the edges have the colour of the shape, not that of a dark ground.
            let seen = both().filter(|(a, _)| a.0[3] > 64);
            let off = seen.map(|(a, b)| (0..3).map(|c| a.0[c].abs_diff(b.0[c])).max());
            let off: Vec<f64> = off.flatten().map(f64::from).collect();
            let mean = off.iter().sum::<f64>() / off.len() as f64;
            assert!(mean < 4.0, "{file}, frame {k}: colours off by {mean}");
        }
    }
}

#[test]
fn writing_a_video_without_ffmpeg_names_ffmpeg() {
    for file in ["x.mp4", "x.webm", "x.mov"] {
        let cli = CliFixture::new();
        let line = format!("render a.obj b.obj --frames 2 --size 8x8 --out {file}");
        let mut command = cli.command(&line);
        let output = command.env("PATH", "").output();
        let output = output.expect("the program starts");
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains("ffmpeg"), "{}", stderr(&output));
        assert_eq!(cli.file_names(".").len(), 4, "nothing is left");
    }
}
