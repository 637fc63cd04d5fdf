//! Tests of pictures that make the libraries that decode them fail.

use crate::bounded_run::BoundedFixture;

/// Chunk of a PNG file with its length and checksum.
fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let content = [&kind[..], data].concat();
    let mut checksum = flate2::Crc::new();
    checksum.update(&content);
    let length = data.len() as u32;
    [
        &length.to_be_bytes()[..],
        &content,
        &checksum.sum().to_be_bytes(),
    ]
    .concat()
}

/// PNG file of one pixel whose palette has one colour and a third of another one.
fn palette_with_a_rest() -> Vec<u8> {
    let header = [0, 0, 0, 1, 0, 0, 0, 1, 8, 3, 0, 0, 0];
    // A stored block of the two bytes 0, 0 with its checksum.
    let pixels = [0x78, 1, 1, 2, 0, 0xfd, 0xff, 0, 0, 0, 2, 0, 1];
    [
        b"\x89PNG\r\n\x1a\n".to_vec(),
        chunk(b"IHDR", &header),
        chunk(b"PLTE", &[9; 4]),
        chunk(b"IDAT", &pixels),
        chunk(b"IEND", &[]),
    ]
    .concat()
}

#[test]
fn a_broken_palette_is_an_error() {
    let fixture = BoundedFixture::new();
    fixture.write("palette.png", palette_with_a_rest());
    fixture.assert_refused("palette.png", "palette.png: ");
}
