//! Tests of decoding pictures, choosing the threshold, removing specks and tracing silhouettes.

use super::*;
use crate::design::{Design, DesignForm, ImportProblem, PictureReading, import};
use image::{GrayImage, Luma, Rgba};

fn encoded(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture
        .into()
        .write_to(&mut bytes, format)
        .expect("encodes");
    bytes.into_inner()
}

fn read_with(bytes: &[u8], options: &ImportOptions) -> Result<Design, ImportProblem> {
    import("picture", bytes, options).map_err(|e| e.problem)
}

fn regions(bytes: &[u8], options: &ImportOptions) -> Regions {
    match read_with(bytes, options).expect("a silhouette").form {
        DesignForm::Outline(regions) => regions,
        other => unreachable!("{other:?}"),
    }
}

/// Draws a picture from ASCII art: `#` is black, `.` is white, and the first line is the top row.
fn ascii(art: &[&str]) -> GrayImage {
    let (width, height) = (art[0].len() as u32, art.len() as u32);
    GrayImage::from_fn(width, height, |x, y| {
        let ink = art[y as usize].as_bytes()[x as usize] == b'#';
        Luma([if ink { 0 } else { 255 }])
    })
}

fn png(art: &[&str]) -> Vec<u8> {
    encoded(ascii(art), ImageFormat::Png)
}

/// Draws a disc anti-aliased by 256 samples per pixel.
fn disc(size: u32, centre: DVec2, radius: f64) -> GrayImage {
    GrayImage::from_fn(size, size, |x, y| {
        let inside = (0..256)
            .filter(|k| {
                let p = DVec2::new(
                    f64::from(x) + (f64::from(k % 16) + 0.5) / 16.0,
                    f64::from(y) + (f64::from(k / 16) + 0.5) / 16.0,
                );
                p.distance(centre) < radius
            })
            .count();
        Luma([255 - inside.min(255) as u8])
    })
}

#[test]
fn an_antialiased_disc_is_accurate_to_a_tenth_of_a_pixel() {
    let centre = DVec2::new(30.3, 28.6);
    let bytes = encoded(disc(64, centre, 20.0), ImageFormat::Png);
    let regions = regions(&bytes, &ImportOptions::default());
    assert_eq!(regions.rings().count(), 1);
    let up = DVec2::new(centre.x, 64.0 - centre.y);
    for ring in regions.rings() {
        for p in ring.points() {
            assert!((p.distance(up) - 20.0).abs() < 0.1, "{p}");
        }
    }
    assert!((regions.area() / (400.0 * std::f64::consts::PI) - 1.0).abs() < 2e-3);
}

#[test]
fn y_points_up_and_a_pixel_is_a_unit() {
    let bytes = png(&[
        "......", //
        ".####.", //
        ".####.", //
        ".##...", //
        "......", //
        "......",
    ]);
    let design = read_with(&bytes, &ImportOptions::default()).expect("silhouette");
    assert_eq!(design.extent.size(), DVec2::splat(6.0));
    let bounds = design.outline(0.0).expect("area").bounds();
    // Tracing between pixel centres cuts off the corners by less than half a pixel.
    assert!(bounds.min.distance(DVec2::new(1.0, 2.0)) < 0.5);
    assert!(bounds.max.distance(DVec2::new(5.0, 5.0)) < 0.5);
}

#[test]
fn every_format_gives_the_same_outline() {
    let mut picture = image::RgbImage::from_pixel(64, 48, image::Rgb([250, 240, 230]));
    for (x, y) in (10..40).flat_map(|x| (8..40).map(move |y| (x, y))) {
        picture.put_pixel(x, y, image::Rgb([20, 40, 90]));
    }
    for format in [
        ImageFormat::Png,
        ImageFormat::Bmp,
        ImageFormat::Jpeg,
        ImageFormat::WebP,
    ] {
        let bytes = encoded(picture.clone(), format);
        let area = regions(&bytes, &ImportOptions::default()).area();
        assert!((area - 30.0 * 32.0).abs() < 4.0, "{format:?}: {area}");
    }
}

#[test]
fn opacity_takes_precedence_over_grey_level() {
    let picture = RgbaImage::from_fn(8, 8, |x, _| {
        // One grey level everywhere; only the right half is opaque.
        Rgba([200, 200, 200, if x < 4 { 0 } else { 255 }])
    });
    let bytes = encoded(picture, ImageFormat::Png);
    let found = regions(&bytes, &ImportOptions::default()).bounds();
    assert_eq!(found.min, DVec2::new(4.0, 0.0));
    assert_eq!(found.max, DVec2::new(8.0, 8.0));
    let inverted = ImportOptions {
        invert: true,
        ..ImportOptions::default()
    };
    assert_eq!(
        regions(&bytes, &inverted).bounds().max,
        DVec2::new(4.0, 8.0)
    );
}

#[test]
fn the_class_of_the_border_is_background() {
    let dark_on_light = ascii(&["....", ".##.", ".##.", "...."]);
    let mut light_on_dark = dark_on_light.clone();
    image::imageops::invert(&mut light_on_dark);
    let options = ImportOptions::default();
    let a = regions(&encoded(dark_on_light, ImageFormat::Png), &options);
    let b = regions(&encoded(light_on_dark, ImageFormat::Png), &options);
    assert_eq!(a, b);
    assert!(a.contains(DVec2::splat(2.0)));
}

#[test]
fn specks_and_pinholes_are_removed() {
    let bytes = png(&[
        "#.........", //
        "..........", //
        "..######..", //
        "..######..", //
        "..##.###..", //
        "..######..", //
        "..........", //
        "....##....", //
        "..........", //
        "..........",
    ]);
    let rings = |specks_px| {
        let options = ImportOptions {
            specks_px,
            ..ImportOptions::default()
        };
        regions(&bytes, &options).rings().count()
    };
    assert_eq!(rings(0), 4);
    assert_eq!(rings(1), 4);
    assert_eq!(rings(2), 2);
    assert_eq!(rings(3), 1);
    let all = ImportOptions {
        specks_px: 1000,
        ..ImportOptions::default()
    };
    assert!(matches!(
        read_with(&bytes, &all),
        Err(ImportProblem::Picture(SilhouetteError::Empty { .. }))
    ));
}

#[test]
fn a_threshold_moves_the_boundary() {
    let ramp = GrayImage::from_fn(64, 16, |x, _| Luma([(x * 4) as u8]));
    let bytes = encoded(ramp, ImageFormat::Png);
    let bounds_at = |threshold| {
        let options = ImportOptions {
            threshold: Some(threshold),
            ..ImportOptions::default()
        };
        regions(&bytes, &options).bounds()
    };
    // The grey level is 4x at the pixel centre x + ½, so the ramp crosses 50 − ½ at 49.5 / 4 + ½.
    assert!(
        (bounds_at(50).max.x - 12.875).abs() < 1e-6,
        "{:?}",
        bounds_at(50)
    );
    assert!((bounds_at(200).min.x - (199.5 / 4.0 + 0.5)).abs() < 1e-6);
}

#[test]
fn a_full_picture_is_a_rectangle_and_an_empty_one_an_error() {
    let one_tone = encoded(GrayImage::from_pixel(5, 3, Luma([9])), ImageFormat::Png);
    let options = ImportOptions::default();
    assert!(matches!(
        read_with(&one_tone, &options),
        Err(ImportProblem::Picture(SilhouetteError::OneTone))
    ));
    let full = ImportOptions {
        threshold: Some(100),
        invert: true,
        ..options
    };
    assert!((regions(&one_tone, &full).area() - 15.0).abs() < 1e-9);
    let clear = encoded(RgbaImage::new(4, 4), ImageFormat::Png);
    assert!(matches!(
        read_with(&clear, &options),
        Err(ImportProblem::Picture(SilhouetteError::Empty {
            threshold: 128
        }))
    ));
}

#[test]
fn otsu_separates_two_levels_in_the_middle() {
    assert_eq!(otsu(&[0, 0, 0, 255]), Some(128));
    assert_eq!(otsu(&[10, 20]), Some(15));
    assert_eq!(otsu(&[7; 9]), None);
    let tones: Vec<u8> = (0..100)
        .map(|k| if k < 70 { 40 + k % 8 } else { 180 + k % 9 })
        .collect();
    assert_eq!(otsu(&tones), otsu_slow(&tones));
}

/// Brute-force Otsu: evaluates the definition for every threshold.
fn otsu_slow(tones: &[u8]) -> Option<u8> {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let means = |t: u8| {
        let (low, high): (Vec<f64>, Vec<f64>) = tones
            .iter()
            .map(|&x| f64::from(x))
            .partition(|&x| x < f64::from(t));
        let weight = low.len() as f64 * high.len() as f64;
        (weight > 0.0).then(|| (weight, mean(&low), mean(&high)))
    };
    let candidates = (1..=255).filter_map(means);
    let best = candidates.max_by(|a, b| {
        let variance = |c: &(f64, f64, f64)| c.0 * (c.1 - c.2).powi(2);
        variance(a).total_cmp(&variance(b))
    })?;
    Some((0.5 * (best.1 + best.2)).ceil() as u8)
}

#[test]
fn the_area_of_an_antialiased_figure_is_exact() {
    // A letter T whose edges cover a quarter of their pixels; no pixel has a level in the middle.
    let covered = |from: f64, to: f64, pixel: u32| {
        let (low, high) = (f64::from(pixel), f64::from(pixel) + 1.0);
        (to.min(high) - from.max(low)).max(0.0)
    };
    let boxes = [[20.0, 100.25, 20.0, 56.25], [44.0, 76.25, 56.25, 120.25]];
    let letter = GrayImage::from_fn(128, 140, |x, y| {
        let share = |&[left, right, top, bottom]: &[f64; 4]| {
            covered(left, right, x) * covered(top, bottom, y)
        };
        let share: f64 = boxes.iter().map(share).sum();
        Luma([(255.0 * (1.0 - share)).round() as u8])
    });
    let area = regions(
        &encoded(letter, ImageFormat::Png),
        &ImportOptions::default(),
    )
    .area();
    let expected = 80.25 * 36.25 + 32.25 * 64.0;
    assert!((area / expected - 1.0).abs() < 0.01, "{area} of {expected}");
}

#[test]
fn noise_is_refused_before_it_is_traced() {
    let mut state = 1u32;
    let noise = GrayImage::from_fn(2048, 1024, |_, _| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        Luma([(state >> 24) as u8])
    });
    let bytes = encoded(noise, ImageFormat::Bmp);
    assert!(matches!(
        read_with(&bytes, &ImportOptions::default()),
        Err(ImportProblem::Picture(SilhouetteError::TooRagged))
    ));
}

/// Rasterises an outline by testing pixel centres; returns the pixels row by row, top row first.
fn redrawn(regions: &Regions, size: u32) -> Vec<bool> {
    let centre = |x: u32, y: u32| DVec2::new(f64::from(x) + 0.5, f64::from(size - y) - 0.5);
    let pixels = (0..size).flat_map(|y| (0..size).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| regions.contains(centre(x, y)))
        .collect()
}

#[test]
fn stair_steps_are_smoothed_but_pixels_are_preserved() {
    // A leaf without anti-aliasing: two arcs that meet in sharp tips.
    let size = 200;
    let is_ink = |x: u32, y: u32| {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        [DVec2::new(60.0, 60.0), DVec2::new(140.0, 140.0)]
            .iter()
            .all(|c| p.distance(*c) < 85.0)
    };
    let leaf = GrayImage::from_fn(size, size, |x, y| {
        Luma([if is_ink(x, y) { 0 } else { 255 }])
    });
    let found = regions(
        &encoded(leaf.clone(), ImageFormat::Png),
        &ImportOptions::default(),
    );
    let ring = found.rings().next().expect("one ring").points();
    assert!(ring.len() < 80, "{}", ring.len());
    // All pixels are preserved except some on the edge.
    let drawn: Vec<bool> = leaf.pixels().map(|p| p.0[0] == 0).collect();
    let again = redrawn(&found, size);
    let changed = drawn.iter().zip(&again).filter(|(a, b)| a != b).count();
    assert!(changed <= 34, "{changed} of {} around it", 2 * 170);
    // If stair steps remained, the outline would turn back by 45° about 80 times.
    let turn = |k: usize| {
        let [a, b, c] = [k, k + 1, k + 2].map(|k| ring[k % ring.len()]);
        (b - a).angle_to(c - b)
    };
    let back: f64 = (0..ring.len()).map(turn).filter(|turn| *turn < 0.0).sum();
    assert!(back > -1.5, "{back}");
}

fn coloured(size: u32, pixel: impl Fn(i32, i32) -> [u8; 4]) -> RgbaImage {
    RgbaImage::from_fn(size, size, |x, y| Rgba(pixel(x as i32, y as i32)))
}

/// Returns the design of a picture, imported with this reading.
fn design_read_by(picture: &RgbaImage, reading: PictureReading) -> Design {
    let options = ImportOptions {
        reading,
        ..ImportOptions::default()
    };
    Design::from_picture("p", picture.clone(), &options).expect("silhouette")
}

fn area_of(design: &Design) -> f64 {
    design.outline(0.0).expect("area").area()
}

/// Returns whether a pixel lies in a disc about the middle of a picture 80 pixels wide.
fn in_disc(x: i32, y: i32, radius: i32) -> bool {
    let [dx, dy] = [2 * x - 79, 2 * y - 79];
    dx * dx + dy * dy < 4 * radius * radius
}

const DISC: f64 = 400.0 * std::f64::consts::PI;

#[test]
fn nearly_opaque_pictures_are_read_by_brightness() {
    // Some programs write 254 instead of 255, or a faint shadow over the whole picture.
    for opacity in [254, 200, 129] {
        let picture = coloured(80, |x, y| {
            let grey = if in_disc(x, y, 20) { 20 } else { 240 };
            [grey, grey, grey, if x > 40 { opacity } else { 255 }]
        });
        let design = design_read_by(&picture, PictureReading::Auto);
        assert!((area_of(&design) / DISC - 1.0).abs() < 0.03, "{opacity}");
        assert_eq!(design.notes, []);
    }
}

#[test]
fn a_tile_with_transparent_corners_is_read_by_brightness_and_reported() {
    let tile = |mark: [u8; 4]| {
        coloured(80, move |x, y| {
            match (in_disc(x, y, 20), in_disc(x, y, 50)) {
                (true, _) => mark,
                (_, true) => [30, 60, 200, 255],
                _ => [0; 4],
            }
        })
    };
    let icon = tile([255; 4]);
    let design = design_read_by(&icon, PictureReading::Auto);
    assert!((area_of(&design) / DISC - 1.0).abs() < 0.03);
    let words = design.notes[0].to_string();
    assert!(
        words.contains("by brightness") && words.contains("reading = opacity"),
        "{words}"
    );
    let whole = design_read_by(&icon, PictureReading::Opacity);
    assert!(area_of(&whole) > 6000.0 && whole.notes.is_empty());
    let candidates = silhouette_candidates(&icon, &ImportOptions::default()).expect("readings");
    let kinds: Vec<_> = candidates
        .iter()
        .map(|candidate| candidate.reading)
        .collect();
    assert_eq!(kinds, [PictureReading::Brightness, PictureReading::Opacity]);
    assert_eq!(candidates[1].regions.area(), area_of(&whole));
    // A tile of one colour has nothing but its opacity.
    let plain = design_read_by(&tile([30, 60, 200, 255]), PictureReading::Auto);
    assert_eq!((area_of(&plain), plain.notes.len()), (area_of(&whole), 0));
}

#[test]
fn a_coloured_figure_on_a_transparent_ground_is_read_by_opacity() {
    let picture = coloured(80, |x, y| match (in_disc(x, y, 10), in_disc(x, y, 20)) {
        (true, _) => [0, 0, 0, 255],
        (_, true) => [255, 200, 60, 255],
        _ => [255, 255, 255, 0],
    });
    let design = design_read_by(&picture, PictureReading::Auto);
    assert!((area_of(&design) / DISC - 1.0).abs() < 0.03);
    assert_eq!(design.notes, []);
}

#[test]
fn a_faint_figure_is_read_by_its_opacity() {
    let picture = coloured(80, |x, y| {
        [0, 0, 0, if in_disc(x, y, 20) { 100 } else { 10 }]
    });
    let design = design_read_by(&picture, PictureReading::Auto);
    assert!((area_of(&design) / DISC - 1.0).abs() < 0.03);
}

#[test]
fn colours_of_equal_brightness_are_separated() {
    let (red, green) = ([255, 0, 0, 255], [0, 76, 0, 255]);
    assert_eq!(luminance(red), luminance(green));
    let picture = coloured(80, |x, y| if in_disc(x, y, 20) { red } else { green });
    // The same with the noise of a camera, which a threshold of brightness would trace.
    let noisy = coloured(80, |x, y| {
        let noise = ((x * 31 + y * 17) % 7) as u8;
        let [r, g, _, a] = if in_disc(x, y, 20) { red } else { green };
        [r.saturating_sub(noise), g + noise, noise, a]
    });
    for picture in [picture, noisy] {
        let design = design_read_by(&picture, PictureReading::Auto);
        assert!((area_of(&design) / DISC - 1.0).abs() < 0.03);
        assert_eq!(design.notes, []);
    }
}

#[test]
fn a_figure_both_darker_and_lighter_than_its_ground_has_two_readings() {
    // The left half of the disc is black, the right half white, on grey.
    let picture = coloured(80, |x, y| match (in_disc(x, y, 20), x < 40) {
        (true, true) => [0, 0, 0, 255],
        (true, false) => [255, 255, 255, 255],
        _ => [128, 128, 128, 255],
    });
    let design = design_read_by(&picture, PictureReading::Auto);
    assert!(area_of(&design) < 0.6 * DISC);
    let words = design.notes[0].to_string();
    assert!(words.contains("reading = colour"), "{words}");
    let whole = design_read_by(&picture, PictureReading::Colour);
    assert!((area_of(&whole) / DISC - 1.0).abs() < 0.03);
}
