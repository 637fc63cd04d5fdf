//! The colours of objects: their own, their layer's or their block's.
//!
//! Colours have numbers (the "AutoCAD colour index" of the DXF Reference). 1 to
//! 6 are pure; 10 to 249 go once around the hues in steps of 15°, ten for each:
//! five of falling brightness, each full and then half as pure; 250 to 255 are
//! greys. 7 is black on white and white on black: no colour of its own.

use crate::colour::Rgb;
use std::collections::HashMap;
use std::rc::Rc;

/// What an object is drawn with.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct EntityStyle {
    /// The name of its layer.
    pub layer: Rc<[u8]>,
    pub colour: ColourSource,
}

/// Where a colour comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum ColourSource {
    #[default]
    OfLayer,
    OfBlock,
    /// Its own; none where it has none.
    Own(Option<Rgb>),
}

/// The colours of layers, by their names.
pub(super) type LayerColours = HashMap<Vec<u8>, Option<Rgb>>;

/// The layer that takes the place of the one that its block is put on.
const OF_BLOCK: &[u8] = b"0";

impl ColourSource {
    /// Of an object with this number, and maybe 24 bits that say more.
    pub fn of(number: i64, exact: Option<i64>) -> Self {
        match (exact, number) {
            (Some(bits), _) => Self::Own(Some(from_rgb_bits(bits))),
            (None, 0) => Self::OfBlock,
            (None, 256) => Self::OfLayer,
            (None, number) => Self::Own(from_index(number)),
        }
    }
}

impl EntityStyle {
    /// What it is in a block that is drawn with `outer`.
    pub fn within(&self, outer: Option<&Self>) -> Self {
        let Some(outer) = outer else {
            return self.clone();
        };
        let layer = match *self.layer == *OF_BLOCK {
            true => Rc::clone(&outer.layer),
            false => Rc::clone(&self.layer),
        };
        let colour = match self.colour {
            ColourSource::OfBlock => outer.colour,
            own => own,
        };
        Self { layer, colour }
    }

    /// Its colour, if it is one.
    pub fn rgb(&self, layers: &LayerColours) -> Option<Rgb> {
        match self.colour {
            ColourSource::OfLayer => layers.get(&*self.layer).copied().flatten(),
            ColourSource::OfBlock => None,
            ColourSource::Own(rgb) => rgb,
        }
    }
}

/// The colour of a number, or of one that is negative since its layer is off.
pub(super) fn from_index(number: i64) -> Option<Rgb> {
    let number = u8::try_from(number.unsigned_abs()).ok()?;
    Some(Rgb(match number {
        1 => [255, 0, 0],
        2 => [255, 255, 0],
        3 => [0, 255, 0],
        4 => [0, 255, 255],
        5 => [0, 0, 255],
        6 => [255, 0, 255],
        8 => [128; 3],
        9 => [192; 3],
        10..=249 => of_wheel(number),
        250 => [51; 3],
        251 => [91; 3],
        252 => [132; 3],
        253 => [173; 3],
        254 => [214; 3],
        255 => [255; 3],
        0 | 7 => return None,
    }))
}

/// Red, green and blue from the lowest bits up are blue, green and red.
pub(super) fn from_rgb_bits(bits: i64) -> Rgb {
    let [.., red, green, blue] = bits.to_be_bytes();
    Rgb([red, green, blue])
}

fn of_wheel(number: u8) -> [u8; 3] {
    const BRIGHTNESS: [f64; 5] = [255.0, 165.0, 127.0, 76.0, 38.0];
    let hue = f64::from(number / 10 - 1) * 15.0 / 60.0;
    let brightness = BRIGHTNESS[usize::from(number % 10 / 2)];
    let least = if number.is_multiple_of(2) { 0.0 } else { 0.5 };
    // Each channel is full for a third of the way around, and rises and falls
    // within a sixth.
    let channel = |full_at: f64| {
        let away = (hue - full_at).rem_euclid(6.0);
        let share = (2.0 - away.min(6.0 - away)).clamp(0.0, 1.0);
        (brightness * (least + (1.0 - least) * share)).floor() as u8
    };
    [channel(0.0), channel(2.0), channel(4.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_colours_of_the_index() {
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
            assert_eq!(from_index(number), Some(Rgb(rgb)), "{number}");
        }
        assert_eq!(from_index(-1), from_index(1));
        assert_eq!(
            [from_index(7), from_index(256), from_index(i64::MIN)],
            [None; 3]
        );
        assert_eq!(from_rgb_bits(0x00ff_8001), Rgb([255, 128, 1]));
    }
}
