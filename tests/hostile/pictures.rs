//! Pictures of a few bytes and many pixels.

use png::{BitDepth, ColorType, Encoder};

use crate::child::Folder;

/// A white page with a black square, a bit for each pixel.
fn page(width: u32, height: u32) -> Vec<u8> {
    let row = |y: u32| {
        let inside = (height / 4..height / 2).contains(&y);
        let black = move |x: u32| inside && (width / 4..width / 2).contains(&x);
        let bits = move |byte: u32| if black(8 * byte) { 0 } else { u8::MAX };
        (0..width.div_ceil(8)).map(bits)
    };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::One);
    let mut writer = encoder.write_header().expect("a header");
    let pixels: Vec<u8> = (0..height).flat_map(row).collect();
    writer.write_image_data(&pixels).expect("a picture");
    writer.finish().expect("an end");
    bytes
}

#[test]
fn the_largest_picture_is_read_and_a_larger_one_refused() {
    let folder = Folder::new();
    folder.put("large.png", page(8192, 6144));
    folder.put("larger.png", page(8192, 6152));
    folder.refused("larger.png", "8192 × 6152 pixels");
    let field = ["check", "large.png", "large.png", "--samples", "2"];
    let answer = folder.ask_patiently(&[&field[..], &["--method", "field"]].concat());
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(
        answer.data.contains("are kept as 4096 × 3072"),
        "{answer:?}"
    );
}
