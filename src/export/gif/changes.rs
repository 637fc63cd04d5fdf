//! What of a frame differs from the one before: a GIF need hold no more.
//!
//! What stays the same is written as transparent, in the smallest rectangle that
//! holds what does not; the frame before is left standing under it.

use image::RgbaImage;

use crate::export::palette::GifPalette;

/// Index of the transparent colour; colours take the indices below it.
pub(super) const TRANSPARENT: u8 = 255;

/// How far a colour may be off what is shown, in any of red, green and blue,
/// before it is drawn anew while all is in motion. No colour is farther off
/// than that, or than its nearest in the palette.
const SLACK: u8 = 6;

/// A frame in the colours of a palette.
pub(super) struct IndexedFrame {
    /// As it was drawn.
    pub image: RgbaImage,
    /// For each pixel its colour.
    pub indices: Vec<u8>,
}

/// A rectangle of a frame that is drawn over the one before.
#[derive(Debug, PartialEq)]
pub(super) struct FramePatch {
    /// Columns before it.
    pub left: u32,
    /// Rows above it.
    pub top: u32,
    /// Columns of it.
    pub width: u32,
    /// Its colours, row by row.
    pub indices: Vec<u8>,
}

impl FramePatch {
    /// Rows of it.
    pub fn height(&self) -> u32 {
        self.indices.len() as u32 / self.width
    }
}

/// What is shown once some frames have been drawn over each other.
#[derive(Default)]
pub(super) struct GifCanvas(Vec<u8>);

impl GifCanvas {
    /// What has to be drawn for a frame without transparent pixels; where it is
    /// not `held`, colours may be off by a little.
    pub fn patch(
        &mut self,
        next: &IndexedFrame,
        is_held: bool,
        palette: &GifPalette,
    ) -> FramePatch {
        let width = next.image.width();
        if self.0.is_empty() {
            self.0.clone_from(&next.indices);
            return crop_to_opaque(width, &self.0);
        }
        let slack = if is_held { 0 } else { SLACK };
        let colours = palette.colours();
        let stays = |shown: u8, index: u8, exact: [u8; 4]| {
            let near = || {
                let off = colours[usize::from(shown)].iter().zip(exact);
                off.map(|(a, b)| a.abs_diff(b)).max() <= Some(slack)
            };
            shown == index || (slack > 0 && near())
        };
        let pixels = next.image.pixels().zip(&next.indices);
        let shown = self.0.iter_mut();
        let changes = shown.zip(pixels).map(|(shown, (pixel, &index))| {
            if stays(*shown, index, pixel.0) {
                return TRANSPARENT;
            }
            *shown = index;
            index
        });
        let changes: Vec<u8> = changes.collect();
        crop_to_opaque(width, &changes)
    }
}

/// The smallest rectangle of a frame that holds all that is not transparent, one
/// pixel at least.
pub(super) fn crop_to_opaque(width: u32, indices: &[u8]) -> FramePatch {
    let columns = width as usize;
    let is_drawn = |&k: &usize| indices[k] != TRANSPARENT;
    let drawn = || (0..indices.len()).filter(is_drawn);
    let rows = drawn().next().zip(drawn().next_back());
    let (top, bottom) = rows.map_or((0, 0), |(a, b)| (a / columns, b / columns));
    let rows = || (top..=bottom).map(|row| &indices[row * columns..][..columns]);
    let left = |row: &[u8]| row.iter().position(|&k| k != TRANSPARENT);
    let right = |row: &[u8]| row.iter().rposition(|&k| k != TRANSPARENT);
    let left = rows().filter_map(left).min().unwrap_or(0);
    let right = rows().filter_map(right).max().unwrap_or(0);
    FramePatch {
        left: left as u32,
        top: top as u32,
        width: (right - left + 1) as u32,
        indices: rows().flat_map(|row| &row[left..=right]).copied().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    const GREYS: [u8; 4] = [0, 4, 100, 200];

    fn palette() -> GifPalette {
        GifPalette::of(GREYS.map(|grey| ([grey; 3], 1)).into(), 255)
    }

    /// Three columns, in these greys of the palette.
    fn frame(indices: &[u8]) -> IndexedFrame {
        let image = RgbaImage::from_fn(3, indices.len() as u32 / 3, |x, y| {
            let [grey, ..] = [GREYS[usize::from(indices[(3 * y + x) as usize])]];
            Rgba([grey, grey, grey, 255])
        });
        IndexedFrame {
            image,
            indices: indices.to_vec(),
        }
    }

    #[test]
    fn only_what_changes_is_drawn() {
        let (palette, mut canvas) = (palette(), GifCanvas::default());
        let whole = canvas.patch(&frame(&[0; 9]), true, &palette);
        assert_eq!((whole.width, whole.height()), (3, 3));
        let next = frame(&[0, 0, 0, 0, 2, 0, 0, 3, 0]);
        let patch = canvas.patch(&next, true, &palette);
        let expected = FramePatch {
            left: 1,
            top: 1,
            width: 1,
            indices: vec![2, 3],
        };
        assert_eq!(patch, expected);
        let same = canvas.patch(&next, true, &palette);
        assert_eq!(same.indices, [TRANSPARENT]);
    }

    #[test]
    fn a_colour_may_be_off_by_a_little_but_not_where_it_is_held() {
        let (palette, mut canvas) = (palette(), GifCanvas::default());
        canvas.patch(&frame(&[0, 2, 3]), true, &palette);
        let next = frame(&[1, 2, 3]);
        let moving = canvas.patch(&next, false, &palette);
        assert_eq!(moving.indices, [TRANSPARENT]);
        let held = canvas.patch(&next, true, &palette);
        assert_eq!(held.indices, [1]);
    }
}
