//! The pixels of a design that came as a picture, and where they lie.

use crate::geometry::{Bounds, DVec2, Similarity};
use image::RgbaImage;
use image::imageops::thumbnail;
use std::collections::HashSet;
use std::sync::Arc;

/// A picture in the plane of its design. Cloning is cheap.
///
/// In its own coordinates a pixel is one unit, the lower left corner is the
/// origin and y points up.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pixels: Arc<RgbaImage>,
    place: Similarity,
}

/// Most pixels that are kept of a design's picture: decoded, as colours are
/// mixed, one takes 26 bytes, and two pictures of so many 0.8 GiB.
const MOST_KEPT: u64 = 1 << 24;

/// So many colours, of four bits a channel, make a photograph: the smoothed
/// edge of a silhouette has no more than sixteen greys.
const MANY_COLOURS: usize = 64;

/// How many pixels are looked at, along each side: some 9,000 show what colours
/// there are, and a picture of 64 million need not be gone through.
const LOOKED_AT: u32 = 96;

impl Picture {
    /// Pixels in sRGB with straight alpha, row 0 the uppermost.
    #[must_use]
    pub fn new(pixels: RgbaImage) -> Self {
        Self {
            pixels: Arc::new(pixels),
            place: Similarity::default(),
        }
    }

    /// The same at half the size, or less, if it has more pixels than are kept;
    /// it lies where it would have lain.
    pub(super) fn bounded(mut pixels: RgbaImage) -> Self {
        let mut scale = 1.0;
        while u64::from(pixels.width()) * u64::from(pixels.height()) > MOST_KEPT {
            let half = |side: u32| (side / 2).max(1);
            pixels = thumbnail(&pixels, half(pixels.width()), half(pixels.height()));
            scale *= 2.0;
        }
        let place = Similarity {
            scale,
            ..Similarity::default()
        };
        Self {
            pixels: Arc::new(pixels),
            place,
        }
    }

    /// Pixels in sRGB with straight alpha, row 0 the uppermost.
    #[must_use]
    pub fn pixels(&self) -> &Arc<RgbaImage> {
        &self.pixels
    }

    /// From the picture's own coordinates to the plane.
    #[must_use]
    pub fn place(&self) -> &Similarity {
        &self.place
    }

    /// The box around it in the plane.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let (width, height) = self.pixels.dimensions();
        let size = DVec2::new(f64::from(width), f64::from(height));
        let own = Bounds {
            min: DVec2::ZERO,
            max: size,
        };
        Bounds::of(own.corners().map(|p| self.place.apply(p))).unwrap_or(own)
    }

    /// The picture laid down by a similarity.
    #[must_use]
    pub fn transformed(&self, by: &Similarity) -> Self {
        Self {
            pixels: Arc::clone(&self.pixels),
            place: by.after(&self.place),
        }
    }

    /// Whether its colours matter: it has more of them than a silhouette.
    #[must_use]
    pub fn is_photograph(&self) -> bool {
        let (width, height) = self.pixels.dimensions();
        // A step is one at least, even where there is no pixel to take it.
        let steps = |side: u32| (0..side).step_by(side.div_ceil(LOOKED_AT).max(1) as usize);
        let colours = steps(height).flat_map(|y| steps(width).map(move |x| (x, y)));
        let mut seen = HashSet::new();
        colours
            .map(|(x, y)| self.pixels.get_pixel(x, y).0.map(|channel| channel >> 4))
            .any(|colour| seen.insert(colour) && seen.len() >= MANY_COLOURS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn a_silhouette_is_no_photograph() {
        let grey = |x: u32, _: u32| Rgba([(x * 4) as u8, (x * 4) as u8, (x * 4) as u8, 255]);
        assert!(!Picture::new(RgbaImage::from_fn(64, 64, grey)).is_photograph());
        let sky = |x: u32, y: u32| Rgba([(x * 4) as u8, (y * 4) as u8, 90, 255]);
        assert!(Picture::new(RgbaImage::from_fn(64, 64, sky)).is_photograph());
    }

    #[test]
    fn a_large_one_is_kept_at_half_its_size_in_its_place() {
        let large = Picture::bounded(RgbaImage::new(6000, 4000));
        assert_eq!(large.pixels().dimensions(), (3000, 2000));
        assert_eq!(large.bounds().max, DVec2::new(6000.0, 4000.0));
        let small = Picture::bounded(RgbaImage::new(4096, 4096));
        assert_eq!(small, Picture::new(RgbaImage::new(4096, 4096)));
        // A line is as long as it is, however thin.
        let thin = Picture::bounded(RgbaImage::new(1 << 25, 1));
        assert_eq!(thin.pixels().dimensions(), (1 << 24, 1));
    }

    #[test]
    fn it_moves_with_its_design() {
        let by = Similarity {
            offset: DVec2::new(5.0, 1.0),
            scale: 2.0,
            ..Similarity::default()
        };
        let moved = Picture::new(RgbaImage::new(4, 2)).transformed(&by);
        let bounds = moved.bounds();
        assert_eq!(bounds.min, DVec2::new(5.0, 1.0));
        assert_eq!(bounds.max, DVec2::new(13.0, 5.0));
    }
}
