//! Converts AutoCAD colour indices to red, green and blue.
//!
//! Colours are numbered by the AutoCAD colour index (DXF Reference): 1 to 6 are pure colours;
//! 10 to 249 are hues in steps of 15°, with ten colours per hue (five brightnesses, each at
//! full and at half saturation); 250 to 255 are greys. Index 7 is black or white, whichever
//! contrasts with the background; it is imported as black, as it is plotted on paper.

use crate::colour::Rgb;

/// Colour of index 7 and of invalid indices: black, as on paper.
pub(super) const BLACK: Rgb = Rgb([0; 3]);

/// Converts a colour index; a negative index (layer off) has the same colour as its absolute value.
/// Numbers that denote no colour, 0 and those above 255, count as index 7, black.
pub(super) fn from_index(number: i64) -> Rgb {
    let number = u8::try_from(number.unsigned_abs()).unwrap_or(7);
    Rgb(match number {
        1 => [255, 0, 0],
        2 => [255, 255, 0],
        3 => [0, 255, 0],
        4 => [0, 255, 255],
        5 => [0, 0, 255],
        6 => [255, 0, 255],
        8 => [128; 3],
        9 => [192; 3],
        10..=249 => hue_colour(number),
        250 => [51; 3],
        251 => [91; 3],
        252 => [132; 3],
        253 => [173; 3],
        254 => [214; 3],
        255 => [255; 3],
        0 | 7 => return BLACK,
    })
}

/// Converts a 24-bit colour with blue in the lowest byte and red in the highest.
pub(super) fn from_rgb_bits(bits: i64) -> Rgb {
    let [.., red, green, blue] = bits.to_be_bytes();
    Rgb([red, green, blue])
}

/// Converts a colour index in the range 10 to 249 to red, green and blue.
fn hue_colour(number: u8) -> [u8; 3] {
    /// Maximum channel value, 0 to 255, of each of the five brightnesses (DXF Reference).
    const BRIGHTNESS: [f64; 5] = [255.0, 165.0, 127.0, 76.0, 38.0];
    let hue = f64::from(number / 10 - 1) * 15.0 / 60.0;
    let brightness = BRIGHTNESS[usize::from(number % 10 / 2)];
    let min_share = if number.is_multiple_of(2) { 0.0 } else { 0.5 };
    // HSV to RGB on a hue circle of length 6: a channel has its maximum up to the distance 1 from
    // the hue `peak` and its minimum from the distance 2 on; in between it changes linearly.
    let channel = |peak: f64| {
        let distance = (hue - peak).rem_euclid(6.0);
        let share = (2.0 - distance.min(6.0 - distance)).clamp(0.0, 1.0);
        (brightness * (min_share + (1.0 - min_share) * share)).floor() as u8
    };
    [channel(0.0), channel(2.0), channel(4.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_follow_the_autocad_colour_index() {
        let known = [
            (1, [255, 0, 0]),
            (10, [255, 0, 0]),
            (11, [255, 127, 127]),
            (12, [165, 0, 0]),
            (18, [38, 0, 0]),
            (20, [255, 63, 0]),
            (30, [255, 127, 0]),
            (50, [255, 255, 0]),
            (90, [0, 255, 0]),
            (170, [0, 0, 255]),
            (240, [255, 0, 63]),
            (253, [173, 173, 173]),
        ];
        for (number, rgb) in known {
            assert_eq!(from_index(number), Rgb(rgb), "{number}");
        }
        assert_eq!(from_index(-1), from_index(1));
        assert_eq!(
            [from_index(7), from_index(256), from_index(i64::MIN)],
            [BLACK; 3]
        );
        assert_eq!(from_rgb_bits(0x00ff_8001), Rgb([255, 128, 1]));
    }
}
