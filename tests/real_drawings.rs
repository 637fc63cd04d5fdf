//! Tests that a film shows its drawings at t = 0 and t = 1 as the renderer `resvg` draws their SVG
//! files.
//!
//! The environment variable `MORPHOSPACE_TEST_DRAWINGS` replaces the folder of drawings;
//! `MORPHOSPACE_TEST_PICTURES` names a folder to which both images of each drawing are written.

use image::RgbaImage;
use morphospace::colour::Rgb;
use morphospace::design::{Design, ImportOptions, import};
use morphospace::export::{Camera, PixelSize, PlaneView};
use morphospace::transition::{Transition, TransitionSpec, TransitionStyle};
use morphospace::work::progress::Silent;
use resvg::{tiny_skia, usvg};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The bundled font, with which `resvg` draws text.
const FONT: &[u8] = include_bytes!("../assets/fonts/Roboto-Bold.ttf");

/// Length of the longer side of a compared image, in pixels.
///
/// It is a prime number. With a round number, straight edges of drawings on a grid of hundredths
/// would all fall exactly between two samples of a pixel, where rounding decides which sample is
/// covered.
const SIDE_PX: f32 = 601.0;

/// Factor by which images are drawn larger before they are reduced.
///
/// The rasteriser takes 16 samples per pixel. Without oversampling, a single sample on the other
/// side of an edge would change a channel by 16 of 255, which is the difference that the test
/// allows.
const OVERSAMPLING: u32 = 4;

/// Reduces an image by the factor [`OVERSAMPLING`]: each pixel is the mean of a block.
fn reduced(image: &RgbaImage) -> RgbaImage {
    let area = OVERSAMPLING * OVERSAMPLING;
    let mean = |x, y| {
        let mut sum = [area / 2; 4];
        for k in 0..area {
            let pixel = image.get_pixel(
                OVERSAMPLING * x + k % OVERSAMPLING,
                OVERSAMPLING * y + k / OVERSAMPLING,
            );
            for (sum, value) in sum.iter_mut().zip(pixel.0) {
                *sum += u32::from(value);
            }
        }
        image::Rgba(sum.map(|sum| (sum / area) as u8))
    };
    RgbaImage::from_fn(
        image.width() / OVERSAMPLING,
        image.height() / OVERSAMPLING,
        mean,
    )
}

/// Renders the SVG text of a drawing with `resvg` on white, [`OVERSAMPLING`] times as large as the
/// compared image.
fn expected(text: &str) -> RgbaImage {
    let mut options = usvg::Options::default();
    options.fontdb_mut().load_font_data(FONT.to_vec());
    let tree = usvg::Tree::from_str(text, &options).expect("a drawing");
    let size = tree.size();
    let oversampling = OVERSAMPLING as f32;
    let scale = oversampling * SIDE_PX / size.width().max(size.height());
    let sides = [size.width(), size.height()].map(|side| side * scale);
    // Sides are rounded up to whole pixels of the compared image. The longer side is a whole number
    // except for rounding errors, which 1e-3 absorbs.
    let [width, height] = sides.map(|side| oversampling * (side / oversampling - 1e-3).ceil());
    let mut pixmap = tiny_skia::Pixmap::new(width as u32, height as u32).expect("a size");
    pixmap.fill(tiny_skia::Color::WHITE);
    let [x, y] = [width - sides[0], height - sides[1]].map(|margin| 0.5 * margin);
    let at = usvg::Transform::from_row(scale, 0.0, 0.0, scale, x, y);
    resvg::render(&tree, at, &mut pixmap.as_mut());
    RgbaImage::from_raw(width as u32, height as u32, pixmap.take()).expect("as large")
}

/// Paths of the drawings in the test folder and of two gallery drawings, sorted.
fn drawings() -> Vec<PathBuf> {
    let bundled = || Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/drawings");
    let folder = std::env::var_os("MORPHOSPACE_TEST_DRAWINGS").map_or_else(bundled, PathBuf::from);
    let entries = std::fs::read_dir(folder).expect("the drawings");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a file").path()).collect();
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/gallery");
    paths.extend(["day.svg", "night.svg"].map(|name| gallery.join(name)));
    paths.sort();
    paths
}

/// Fraction of the pixels of two images in which a channel differs by more than 16 of 255.
fn differing_fraction(a: &RgbaImage, b: &RgbaImage) -> f64 {
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
fn the_ends_of_a_film_match_the_drawings() {
    let read = |path: &PathBuf| {
        let text = std::fs::read_to_string(path).expect("a file");
        let name = path.display().to_string();
        let design = import(&name, text.as_bytes(), &ImportOptions::default()).expect("a design");
        (name, text, Arc::new(design))
    };
    let drawings: Vec<(String, String, Arc<Design>)> = drawings().iter().map(read).collect();
    let mut failures = Vec::new();
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
            let [shown, expected] = [camera.pixels(t), expected].map(|image| reduced(&image));
            let fraction = differing_fraction(&shown, &expected);
            if fraction >= 0.005 {
                failures.push(format!("{name} at {t}: {fraction:.4}"));
            }
            if let Ok(folder) = std::env::var("MORPHOSPACE_TEST_PICTURES") {
                let name = Path::new(name)
                    .file_stem()
                    .expect("a name")
                    .to_string_lossy();
                shown
                    .save(format!("{folder}/{name}-{t}.png"))
                    .expect("saved");
                expected
                    .save(format!("{folder}/{name}-expected.png"))
                    .expect("saved");
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
