//! Times the blending of two pictures of 1920 × 1080 pixels on the CPU: the warp by 40 pairs of
//! lines, the rendering of the pixels, and both together.
//!
//! `cargo bench --no-default-features --bench colours`

use criterion::Criterion;
use image::{Rgba, RgbaImage};
use morphospace::content::{ColourMix, PicturePair, PictureRaster};
use morphospace::correspondence::LinePair;
use morphospace::design::Picture;
use morphospace::geometry::{Bounds, DVec2};
use morphospace::warp::{GridWarp, LineOptions, LineWarp, PlaneGrid, Warp};
use std::error::Error;

/// Size of the pictures in pixels.
const SIZE: [u32; 2] = [1920, 1080];

fn main() -> Result<(), Box<dyn Error>> {
    let mut criterion = Criterion::default().configure_from_args().sample_size(20);
    let [width, height] = SIZE;
    let picture = |shift: u32| {
        let wave = |x: u32, k: u32| ((x * (k + 3) + shift * 17) % 511).abs_diff(255) as u8;
        let pixel = |x, y| Rgba([wave(x, 0), wave(y, 1), wave(x + y, 2), 255]);
        Picture::new(RgbaImage::from_fn(width, height, pixel))
    };
    let pair = PicturePair::new(&picture(0), &picture(9), ColourMix::default())?;
    let frame = Bounds {
        min: DVec2::ZERO,
        max: DVec2::new(f64::from(width), f64::from(height)),
    };
    let lines: Vec<LinePair> = (0..40).map(line).collect();
    let lines = LineWarp::new(&frame, &lines, &[], &LineOptions::default())?;
    let warp = GridWarp::new(lines, PlaneGrid::covering(&frame.padded(40.0), 160));
    let mut placer = warp.placer();
    let raster = PictureRaster {
        size: SIZE,
        corner: DVec2::new(0.0, f64::from(height)),
        pixel_size: 1.0,
    };
    criterion.bench_function("warp, 40 lines", |bencher| {
        bencher.iter(|| placer.place(0.5))
    });
    placer.place(0.5);
    criterion.bench_function("pixels, 1920 x 1080", |bencher| {
        bencher.iter(|| pair.render(placer.placement(), 0.5, &raster));
    });
    criterion.bench_function("frame, 1920 x 1080, 40 lines", |bencher| {
        bencher.iter(|| {
            placer.place(0.5);
            pair.render(placer.placement(), 0.5, &raster)
        });
    });
    criterion.final_summary();
    Ok(())
}

/// Returns the `k`-th pair of lines. The source lines are spread over the picture by an additive
/// recurrence; each target line is its source line moved, rotated and lengthened slightly.
fn line(k: u32) -> LinePair {
    let k = f64::from(k);
    let position = DVec2::new((k * 0.618_034).fract(), (k * 0.754_878).fract());
    let centre = position * DVec2::new(1800.0, 960.0) + 60.0;
    let half = DVec2::from_angle(k) * (30.0 + 2.0 * k);
    let shift = DVec2::from_angle(2.0 * k) * 25.0;
    LinePair {
        source: [centre - half, centre + half],
        target: [
            centre + shift - half.perp() * 0.2 - half,
            centre + shift + half,
        ],
    }
}
