//! Tests of image files with few bytes and many pixels: the largest supported size is read, larger
//! ones are refused.

use png::{BitDepth, ColorType, Encoder};

use crate::bounded_run::BoundedFixture;

/// PNG file of a white page with a black rectangle, with one bit per pixel.
fn page(width: u32, height: u32) -> Vec<u8> {
    let row = |y: u32| {
        let is_in_rows = (height / 4..height / 2).contains(&y);
        let is_black = move |x: u32| is_in_rows && (width / 4..width / 2).contains(&x);
        let bits = move |byte: u32| if is_black(8 * byte) { 0 } else { u8::MAX };
        (0..width.div_ceil(8)).map(bits)
    };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::One);
    let mut writer = encoder.write_header().expect("a header");
    let pixels: Vec<u8> = (0..height).flat_map(row).collect();
    writer.write_image_data(&pixels).expect("an image");
    writer.finish().expect("an end");
    bytes
}

#[test]
fn the_largest_supported_image_is_read_and_a_larger_one_refused() {
    let fixture = BoundedFixture::new();
    fixture.write("large.png", page(8192, 6144));
    fixture.write("larger.png", page(8192, 6152));
    fixture.assert_refused("larger.png", "8192 × 6152 pixels");
    let field = ["check", "large.png", "large.png", "--samples", "2"];
    let output = fixture.run_long(&[&field[..], &["--method", "field"]].concat());
    assert_eq!(output.code, Some(0), "{output:?}");
    assert!(
        output.stdout.contains("to 4096 × 3072 pixels"),
        "{output:?}"
    );
}
