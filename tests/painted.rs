//! A drawing shown at an end of a film is the drawing: as `resvg` draws the file.

use image::RgbaImage;
use morphospace::colour::Rgb;
use morphospace::design::{Design, ImportOptions, import};
use morphospace::export::{Camera, PixelSize, PlaneView};
use morphospace::transition::{Transition, TransitionSpec, TransitionStyle};
use morphospace::work::progress::Silent;
use resvg::{tiny_skia, usvg};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The font that comes with the program.
const FONT: &[u8] = include_bytes!("../assets/fonts/Roboto-Bold.ttf");

/// Pixels along the longer side of a drawing. A prime number: at a round one the straight
/// edges of drawings on a grid of hundredths all fall between two samples of a pixel,
/// where rounding alone says which of the two is covered.
const SIDE: f32 = 601.0;

/// Both are drawn so many times as large and reduced: the rasteriser takes sixteen samples
/// of a pixel, so one that falls on the other side of an edge is a sixteenth of the range,
/// as much as the test allows.
const FINER: u32 = 4;

/// The mean of each block of pixels.
fn reduced(image: &RgbaImage) -> RgbaImage {
    let area = FINER * FINER;
    let mean = |x, y| {
        let mut sum = [area / 2; 4];
        for k in 0..area {
            let pixel = image.get_pixel(FINER * x + k % FINER, FINER * y + k / FINER);
            for (sum, value) in sum.iter_mut().zip(pixel.0) {
                *sum += u32::from(value);
            }
        }
        image::Rgba(sum.map(|sum| (sum / area) as u8))
    };
    RgbaImage::from_fn(image.width() / FINER, image.height() / FINER, mean)
}

/// The drawing as `resvg` has it, on white, before it is reduced.
fn expected(text: &str) -> RgbaImage {
    let mut options = usvg::Options::default();
    options.fontdb_mut().load_font_data(FONT.to_vec());
    let tree = usvg::Tree::from_str(text, &options).expect("a drawing");
    let size = tree.size();
    let finer = FINER as f32;
    let scale = finer * SIDE / size.width().max(size.height());
    let sides = [size.width(), size.height()].map(|side| side * scale);
    // The longer side is whole but for rounding.
    let [width, height] = sides.map(|side| finer * (side / finer - 1e-3).ceil());
    let mut pixmap = tiny_skia::Pixmap::new(width as u32, height as u32).expect("a size");
    pixmap.fill(tiny_skia::Color::WHITE);
    let [x, y] = [width - sides[0], height - sides[1]].map(|rest| 0.5 * rest);
    let at = usvg::Transform::from_row(scale, 0.0, 0.0, scale, x, y);
    resvg::render(&tree, at, &mut pixmap.as_mut());
    RgbaImage::from_raw(width as u32, height as u32, pixmap.take()).expect("as large")
}

/// The drawings in a folder that may be named.
fn drawings() -> Vec<PathBuf> {
    let own = || Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/drawings");
    let folder = std::env::var_os("MORPHOSPACE_TEST_DRAWINGS").map_or_else(own, PathBuf::from);
    let entries = std::fs::read_dir(folder).expect("the drawings");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a file").path()).collect();
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/gallery");
    paths.extend(["day.svg", "night.svg"].map(|name| gallery.join(name)));
    paths.sort();
    paths
}

/// The share of pixels that differ by more than 16 in a channel.
fn differing(a: &RgbaImage, b: &RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let differs = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| {
        let channels = a.0.iter().zip(b.0);
        channels.into_iter().any(|(a, b)| a.abs_diff(b) > 16)
    };
    let count = a
        .pixels()
        .zip(b.pixels())
        .filter(|&pair| differs(pair))
        .count();
    count as f64 / f64::from(a.width() * a.height())
}

#[test]
fn the_ends_of_a_film_look_like_the_drawings() {
    let read = |path: &PathBuf| {
        let text = std::fs::read_to_string(path).expect("a file");
        let name = path.display().to_string();
        let design = import(&name, text.as_bytes(), &ImportOptions::default()).expect("a design");
        (name, text, Arc::new(design))
    };
    let drawings: Vec<(String, String, Arc<Design>)> = drawings().iter().map(read).collect();
    let mut others = Vec::new();
    for (k, a) in drawings.iter().enumerate() {
        let b = &drawings[(k + 1) % drawings.len()];
        let spec = TransitionSpec::new(a.2.clone(), b.2.clone());
        let film = Transition::build(&spec, &Silent).expect("a film");
        for (t, (name, text, design)) in [(0.0, a), (1.0, b)] {
            let expected = expected(text);
            let size = PixelSize::new(expected.width(), expected.height()).expect("a size");
            let camera = Camera {
                sequence: film.clone().into(),
                style: TransitionStyle::default(),
                view: PlaneView::fit(design.extent, size),
                ground: Some(Rgb([255; 3])),
                captions: None,
            };
            let [seen, expected] = [camera.pixels(t), expected].map(|image| reduced(&image));
            let share = differing(&seen, &expected);
            if share >= 0.005 {
                others.push(format!("{name} at {t}: {share:.4}"));
            }
            if let Ok(folder) = std::env::var("MORPHOSPACE_TEST_PICTURES") {
                let name = Path::new(name)
                    .file_stem()
                    .expect("a name")
                    .to_string_lossy();
                seen.save(format!("{folder}/{name}-{t}.png"))
                    .expect("saved");
                expected
                    .save(format!("{folder}/{name}-expected.png"))
                    .expect("saved");
            }
        }
    }
    assert!(others.is_empty(), "{others:#?}");
}
