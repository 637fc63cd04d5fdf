//! The [`Picture`] of a design: its pixels and the similarity that places them in the plane.

use crate::geometry::{Bounds, DVec2, Similarity};
use image::RgbaImage;
use image::imageops::thumbnail;
use std::collections::HashSet;
use std::sync::Arc;

/// Picture that is placed in the plane of its design. Cloning is cheap, because the pixels are
/// shared.
///
/// In the picture's own coordinates one pixel is one unit, the origin is the lower left
/// corner and y points up.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pixels: Arc<RgbaImage>,
    place: Similarity,
}

/// Maximum number of pixels that are stored for a picture (resource limit: blending needs 26 bytes
/// per pixel, so two pictures need 0.8 GiB).
const MAX_STORED_PIXELS: u64 = 1 << 24;

/// Minimum number of distinct colours, at 4 bits per channel, of a picture that counts as a
/// photograph. The anti-aliased edge of a silhouette has at most 16 greys (heuristic).
const PHOTOGRAPH_COLOURS: usize = 64;

/// Maximum number of pixels sampled along each side when the colours of a picture are counted
/// (resource limit: avoids scanning all pixels of a large picture).
const SAMPLES_PER_SIDE: u32 = 96;

impl Picture {
    /// Creates a picture with its lower left corner at the origin. Pixels are sRGB with
    /// straight alpha, row 0 at the top.
    #[must_use]
    pub fn new(pixels: RgbaImage) -> Self {
        Self {
            pixels: Arc::new(pixels),
            place: Similarity::default(),
        }
    }

    /// Creates a picture as [`Self::new`] does, but halves the resolution until at most
    /// [`MAX_STORED_PIXELS`] remain. The picture is then scaled up, so that it covers the same area
    /// as before.
    pub(super) fn downscaled(mut pixels: RgbaImage) -> Self {
        let mut scale = 1.0;
        while u64::from(pixels.width()) * u64::from(pixels.height()) > MAX_STORED_PIXELS {
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

    /// Returns the pixels: sRGB with straight alpha, row 0 at the top.
    #[must_use]
    pub fn pixels(&self) -> &Arc<RgbaImage> {
        &self.pixels
    }

    /// Returns the similarity that transforms the picture's own coordinates to the plane.
    #[must_use]
    pub fn place(&self) -> &Similarity {
        &self.place
    }

    /// Returns the bounding box of the picture in the plane.
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

    /// Returns the picture transformed by a similarity.
    #[must_use]
    pub fn transformed(&self, by: &Similarity) -> Self {
        Self {
            pixels: Arc::clone(&self.pixels),
            place: by.after(&self.place),
        }
    }

    /// Returns whether the picture has more colours than an anti-aliased silhouette, judged
    /// from a sparse sample of its pixels.
    #[must_use]
    pub fn is_photograph(&self) -> bool {
        let (width, height) = self.pixels.dimensions();
        // `step_by` panics on a step of 0, which a side of 0 pixels would give.
        let steps = |side: u32| (0..side).step_by(side.div_ceil(SAMPLES_PER_SIDE).max(1) as usize);
        let colours = steps(height).flat_map(|y| steps(width).map(move |x| (x, y)));
        let mut seen = HashSet::new();
        colours
            .map(|(x, y)| self.pixels.get_pixel(x, y).0.map(|channel| channel >> 4))
            .any(|colour| seen.insert(colour) && seen.len() >= PHOTOGRAPH_COLOURS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn a_silhouette_is_not_a_photograph() {
        let grey = |x: u32, _: u32| Rgba([(x * 4) as u8, (x * 4) as u8, (x * 4) as u8, 255]);
        assert!(!Picture::new(RgbaImage::from_fn(64, 64, grey)).is_photograph());
        let sky = |x: u32, y: u32| Rgba([(x * 4) as u8, (y * 4) as u8, 90, 255]);
        assert!(Picture::new(RgbaImage::from_fn(64, 64, sky)).is_photograph());
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn a_large_picture_is_downscaled_but_covers_the_same_area() {
        let large = Picture::downscaled(RgbaImage::new(6000, 4000));
        assert_eq!(large.pixels().dimensions(), (3000, 2000));
        assert_eq!(large.bounds().max, DVec2::new(6000.0, 4000.0));
        let small = Picture::downscaled(RgbaImage::new(4096, 4096));
        assert_eq!(small, Picture::new(RgbaImage::new(4096, 4096)));
        // A side of one pixel is not halved further.
        let thin = Picture::downscaled(RgbaImage::new(1 << 25, 1));
        assert_eq!(thin.pixels().dimensions(), (1 << 24, 1));
    }

    #[test]
    fn a_transformed_picture_has_transformed_bounds() {
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
