//! Converts masks from and to ASCII pictures, for tests: `#` is inside, and the first line is the
//! top row.

use super::Mask;

/// Parses an ASCII picture, which must have at least one `#`.
pub(super) fn mask(picture: &str) -> Mask {
    let rows: Vec<&str> = picture.split_whitespace().rev().collect();
    let bits = rows.iter().flat_map(|r| r.chars().map(|c| c == '#'));
    Mask::new(rows[0].len() as u32, rows.len() as u32, bits.collect())
        .expect("a rectangular picture with an inside")
}

/// Draws a mask as an ASCII picture with one line per row.
pub(super) fn text(mask: &Mask) -> String {
    let line = |row: &[bool]| -> String {
        let line = row.iter().map(|&b| if b { '#' } else { '.' });
        line.chain(['\n']).collect()
    };
    mask.bits()
        .chunks(mask.width() as usize)
        .rev()
        .map(line)
        .collect()
}
