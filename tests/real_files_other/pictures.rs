//! Pictures: the same figure in several encodings.

use std::io::Cursor;

use image::{DynamicImage, GrayImage, ImageBuffer, ImageFormat, Luma, Rgba, RgbaImage};
use morphospace::design::Design;
use morphospace::geometry::Regions;

use super::{assert_close, imported, outline};

const SIZE: [u32; 2] = [150, 190];

/// Area of the figure: a letter L with a foot of 70 by 24 pixels and a stem of 22 by 120.
const AREA: f64 = 70.0 * 24.0 + 22.0 * 120.0;

/// Returns whether a pixel belongs to the letter; row 0 is at the top.
fn is_ink(x: u32, y: u32) -> bool {
    let is_foot = (40..110).contains(&x) && (146..170).contains(&y);
    is_foot || (40..62).contains(&x) && (26..146).contains(&y)
}

fn encoded(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture
        .into()
        .write_to(&mut bytes, format)
        .expect("encoded");
    bytes.into_inner()
}

fn grey() -> GrayImage {
    GrayImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        Luma([if is_ink(x, y) { 20 } else { 240 }])
    })
}

/// A PNG of one byte per pixel or fewer, in indexed colours with a transparent one.
fn indexed(depth: png::BitDepth) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIZE[0], SIZE[1]);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(depth);
    encoder.set_palette(vec![255, 255, 255, 200, 30, 30]);
    encoder.set_trns(vec![0, 255]);
    let per_byte = 8 / depth as u32;
    let row = |y: u32| {
        (0..SIZE[0].div_ceil(per_byte)).map(move |byte| {
            let index = |k: u32| u32::from(is_ink(per_byte * byte + k, y));
            let bits = depth as u32;
            (0..per_byte).fold(0, |all, k| all << bits | index(k)) as u8
        })
    };
    let data: Vec<u8> = (0..SIZE[1]).flat_map(row).collect();
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&data).expect("data");
    writer.finish().expect("an end");
    bytes
}

/// A JPEG whose metadata say how it has to be turned (EXIF orientation).
fn oriented(picture: &GrayImage, orientation: u8) -> Vec<u8> {
    let jpeg = encoded(picture.clone(), ImageFormat::Jpeg);
    let tiff = [
        b"Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".as_slice(),
        &[orientation, 0, 0, 0, 0, 0, 0],
    ];
    let tiff = tiff.concat();
    let length = u16::try_from(tiff.len() + 2).expect("short").to_be_bytes();
    [&jpeg[..2], &[0xff, 0xe1], &length, &tiff, &jpeg[2..]].concat()
}

/// Asserts that a design is the letter, upright.
#[track_caller]
fn assert_letter(design: &Design) -> Regions {
    let found = outline(design);
    assert_eq!(found.len(), 1);
    assert_close(found.area(), AREA);
    let bounds = found.bounds();
    let height = f64::from(SIZE[1]);
    for (edge, expected) in [
        (bounds.min.x, 40.0),
        (bounds.max.x, 110.0),
        (bounds.min.y, height - 170.0),
        (bounds.max.y, height - 26.0),
    ] {
        assert!((edge - expected).abs() < 1.0, "{edge}, expected {expected}");
    }
    // The stem stands on the left.
    assert!(found.contains([45.0, height - 40.0].into()));
    assert!(!found.contains([100.0, height - 40.0].into()));
    found
}

#[test]
fn grey_levels_of_8_and_16_bits_give_the_same_figure() {
    assert_letter(&imported(encoded(grey(), ImageFormat::Png)));
    let deep = ImageBuffer::from_fn(SIZE[0], SIZE[1], |x, y| {
        Luma([if is_ink(x, y) { 5_000_u16 } else { 61_000 }])
    });
    assert_letter(&imported(encoded(
        DynamicImage::ImageLuma16(deep),
        ImageFormat::Png,
    )));
}

#[test]
fn transparency_of_each_kind_gives_the_same_figure() {
    let clear = RgbaImage::from_fn(SIZE[0], SIZE[1], |x, y| match is_ink(x, y) {
        true => Rgba([250, 250, 250, 255]),
        false => Rgba([0, 0, 0, 0]),
    });
    assert_letter(&imported(encoded(clear, ImageFormat::Png)));
    let deep = ImageBuffer::from_fn(SIZE[0], SIZE[1], |x, y| {
        Rgba([9_000, 9_000, 9_000, if is_ink(x, y) { u16::MAX } else { 0 }])
    });
    assert_letter(&imported(encoded(
        DynamicImage::ImageRgba16(deep),
        ImageFormat::Png,
    )));
    for depth in [
        png::BitDepth::One,
        png::BitDepth::Four,
        png::BitDepth::Eight,
    ] {
        assert_letter(&imported(indexed(depth)));
    }
}

#[test]
fn the_orientation_in_the_metadata_is_applied() {
    let upright = grey();
    let stored = [
        (1, upright.clone()),
        (3, image::imageops::rotate180(&upright)),
        (6, image::imageops::rotate270(&upright)),
        (8, image::imageops::rotate90(&upright)),
        (2, image::imageops::flip_horizontal(&upright)),
        (4, image::imageops::flip_vertical(&upright)),
    ];
    for (orientation, picture) in stored {
        assert_letter(&imported(oriented(&picture, orientation)));
    }
}

#[test]
fn a_light_figure_on_a_dark_ground_is_the_figure() {
    let mut negative = grey();
    image::imageops::invert(&mut negative);
    assert_letter(&imported(encoded(negative, ImageFormat::Bmp)));
    let webp = encoded(DynamicImage::from(grey()).to_rgb8(), ImageFormat::WebP);
    assert_letter(&imported(webp));
}
