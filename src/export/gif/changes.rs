//! Reduces a GIF frame to the rectangle that differs from the previous frame.
//!
//! Within the rectangle, unchanged pixels are written as transparent: the previous frame shows
//! through, and equal pixels compress well.

use image::RgbaImage;

use crate::export::palette::GifPalette;

/// Palette index of transparent pixels. The colours of the palette have the indices below it.
pub(super) const TRANSPARENT: u8 = 255;

/// Maximum difference between the colour that a pixel shows and its exact colour in the next frame,
/// per channel, on the scale from 0 to 255 (heuristic). A pixel that differs by no more is not
/// redrawn. Still frames are exempt: they always get the nearest palette colours.
pub(in crate::export) const SLACK: u8 = 6;

/// A frame, and its pixels mapped to the colours of the palette.
pub(super) struct IndexedFrame {
    /// Pixels of the frame in their exact colours.
    pub image: RgbaImage,
    /// Palette index of each pixel of the frame, row by row.
    pub indices: Vec<u8>,
}

/// Rectangle of a frame whose pixels are drawn over the previous frame.
#[derive(Debug, PartialEq)]
pub(super) struct FramePatch {
    /// Number of pixel columns to the left of the rectangle.
    pub left: u32,
    /// Number of pixel rows above the rectangle.
    pub top: u32,
    /// Number of pixel columns of the rectangle.
    pub width: u32,
    /// Palette index of each pixel of the rectangle, row by row.
    pub indices: Vec<u8>,
}

impl FramePatch {
    /// Returns the number of pixel rows of the rectangle.
    pub fn height(&self) -> u32 {
        self.indices.len() as u32 / self.width
    }
}

/// Palette indices of the image that a player shows after the frames so far; empty before the first
/// frame.
#[derive(Default)]
pub(super) struct GifCanvas(Vec<u8>);

impl GifCanvas {
    /// Returns the rectangle to draw so that the shown image becomes `next`, which must have no
    /// transparent pixels, and updates the canvas. Pixels whose colour changes by at most [`SLACK`]
    /// are redrawn only if `is_still`.
    pub fn patch(
        &mut self,
        next: &IndexedFrame,
        is_still: bool,
        palette: &GifPalette,
    ) -> FramePatch {
        let width = next.image.width();
        if self.0.is_empty() {
            self.0.clone_from(&next.indices);
            return crop_to_opaque(width, &self.0);
        }
        let slack = if is_still { 0 } else { SLACK };
        let colours = palette.colours();
        let can_stay = |shown: u8, index: u8, exact: [u8; 4]| {
            let near = || {
                let off = colours[usize::from(shown)].iter().zip(exact);
                off.map(|(a, b)| a.abs_diff(b)).max() <= Some(slack)
            };
            shown == index || (slack > 0 && near())
        };
        let pixels = next.image.pixels().zip(&next.indices);
        let shown = self.0.iter_mut();
        let changes = shown.zip(pixels).map(|(shown, (pixel, &index))| {
            if can_stay(*shown, index, pixel.0) {
                return TRANSPARENT;
            }
            *shown = index;
            index
        });
        let changes: Vec<u8> = changes.collect();
        crop_to_opaque(width, &changes)
    }
}

/// Returns the smallest rectangle that contains all pixels that are not transparent. If there are
/// none, returns the first pixel of the frame.
pub(super) fn crop_to_opaque(width: u32, indices: &[u8]) -> FramePatch {
    let columns = width as usize;
    let is_drawn = |&k: &usize| indices[k] != TRANSPARENT;
    let drawn = || (0..indices.len()).filter(is_drawn);
    let ends = drawn().next().zip(drawn().next_back());
    let (top, bottom) = ends.map_or((0, 0), |(a, b)| (a / columns, b / columns));
    let rows = || (top..=bottom).map(|row| &indices[row * columns..][..columns]);
    let first_drawn = |row: &[u8]| row.iter().position(|&k| k != TRANSPARENT);
    let last_drawn = |row: &[u8]| row.iter().rposition(|&k| k != TRANSPARENT);
    let left = rows().filter_map(first_drawn).min().unwrap_or(0);
    let right = rows().filter_map(last_drawn).max().unwrap_or(0);
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

    /// Returns a frame of three columns with these palette indices.
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
    fn only_changed_pixels_are_drawn() {
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
    fn small_deviations_are_accepted_only_in_moving_frames() {
        let (palette, mut canvas) = (palette(), GifCanvas::default());
        canvas.patch(&frame(&[0, 2, 3]), true, &palette);
        let next = frame(&[1, 2, 3]);
        let moving = canvas.patch(&next, false, &palette);
        assert_eq!(moving.indices, [TRANSPARENT]);
        let still = canvas.patch(&next, true, &palette);
        assert_eq!(still.indices, [1]);
    }
}
