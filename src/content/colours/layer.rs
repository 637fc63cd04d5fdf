//! One of the two pictures, to be looked up anywhere in the plane.

use super::linear::{Light, coded_premultiplied, decoded, mean, mixed};
use crate::design::Picture;
use crate::geometry::{Bounds, DMat2, DVec2};
use image::RgbaImage;
use rayon::prelude::*;
use std::sync::Arc;

/// A picture in linear light, in its own size and smaller ones, where it lies
/// in the plane. Cloning is cheap.
#[derive(Clone, Debug)]
pub struct Layer {
    picture: Picture,
    levels: Arc<Vec<Level>>,
    /// From the plane to the picture's own coordinates: x across, y down.
    linear: DMat2,
    offset: DVec2,
}

/// The picture at one size, row by row from above.
#[derive(Debug)]
pub(super) struct Level {
    width: usize,
    height: usize,
    light: Vec<Light>,
}

impl Layer {
    /// Decodes a picture. Takes 22 bytes a pixel.
    #[must_use]
    pub fn new(picture: &Picture) -> Self {
        let mut levels = vec![Level::of(picture.pixels())];
        while let Some(next) = levels.last().and_then(Level::halved) {
            levels.push(next);
        }
        let inverse = picture.place().inverse();
        let height = f64::from(picture.pixels().height());
        let flip = DMat2::from_diagonal(DVec2::new(1.0, -1.0));
        Self {
            linear: flip * inverse.linear(),
            offset: flip * inverse.apply(DVec2::ZERO) + DVec2::new(0.0, height),
            levels: Arc::new(levels),
            picture: picture.clone(),
        }
    }

    /// The picture that this is.
    #[must_use]
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// The box around it in the plane.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.picture.bounds()
    }

    /// The plane in the picture's own coordinates: pixels from its upper left
    /// corner, y down.
    #[must_use]
    pub fn pixel_from_plane(&self, p: DVec2) -> DVec2 {
        self.linear * p + self.offset
    }

    /// All sizes, the largest first and each row by row from above: coded in
    /// sRGB, alpha premultiplied in linear light, four bytes a pixel; and how
    /// many sizes there are.
    #[must_use]
    pub fn texture(&self) -> (Vec<u8>, u32) {
        let lights = self.levels.iter().flat_map(|level| &level.light);
        let bytes = lights.flat_map(|&light| coded_premultiplied(light));
        (bytes.collect(), self.levels.len() as u32)
    }

    /// The size of one of its pixels in the plane.
    fn pixel(&self) -> f64 {
        self.picture.place().scale
    }

    /// Made to be looked up for pixels of the given size in the plane: of the
    /// smaller sizes the one whose pixels are not much finer, so that nothing
    /// flickers where many of the picture's go into one.
    pub(super) fn sampler(&self, size: f64) -> Sampler<'_> {
        let ratio = (size / self.pixel()).max(1.0);
        let wanted = if ratio.is_finite() {
            (ratio.log2() + 0.25) as usize
        } else {
            0
        };
        let level = wanted.min(self.levels.len() - 1);
        let shrunk = &self.levels[level];
        let full = &self.levels[0];
        let scale = DVec2::new(
            shrunk.width as f64 / full.width as f64,
            shrunk.height as f64 / full.height as f64,
        );
        Sampler {
            level: shrunk,
            linear: DMat2::from_diagonal(scale) * self.linear,
            offset: scale * self.offset - 0.5,
        }
    }
}

/// A layer at one of its sizes.
pub(super) struct Sampler<'a> {
    level: &'a Level,
    linear: DMat2,
    offset: DVec2,
}

impl Sampler<'_> {
    /// The light at a point of the plane, bilinear between pixel centres;
    /// beyond the picture that of its edge.
    #[inline]
    pub fn at(&self, p: DVec2) -> Light {
        let at = self.linear * p + self.offset;
        let Level {
            width,
            height,
            light,
        } = self.level;
        let (left, right, u) = bracket(at.x, *width);
        let (above, below, v) = bracket(at.y, *height);
        let row = |y: usize| {
            let row = &light[y * width..][..*width];
            mixed(row[left], row[right], u)
        };
        mixed(row(above), row(below), v)
    }
}

/// The two pixels around `x`, and how far it is from the first to the second.
/// What is within rounding of a pixel is on it.
#[inline]
fn bracket(x: f64, count: usize) -> (usize, usize, f32) {
    let clamped = x.max(0.0).min((count - 1) as f64);
    let first = clamped as usize;
    let share = (clamped - first as f64) as f32;
    (first, (first + 1).min(count - 1), share)
}

impl Level {
    fn of(pixels: &RgbaImage) -> Self {
        let raw = pixels.as_raw().par_chunks_exact(4);
        let light = raw.map(|p| decoded(image::Rgba([p[0], p[1], p[2], p[3]])));
        Self {
            width: pixels.width() as usize,
            height: pixels.height() as usize,
            light: light.collect(),
        }
    }

    /// Half as wide and high, rounded down as graphics cards do; `None` at a
    /// single pixel.
    fn halved(&self) -> Option<Self> {
        if self.width * self.height <= 1 {
            return None;
        }
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let row = |y: usize| {
            (0..width).map(move |x| {
                let (right, below) = (
                    (2 * x + 1).min(self.width - 1),
                    (2 * y + 1).min(self.height - 1),
                );
                let at = |x: usize, y: usize| self.light[y * self.width + x];
                mean([
                    at(2 * x, 2 * y),
                    at(right, 2 * y),
                    at(2 * x, below),
                    at(right, below),
                ])
            })
        };
        Some(Self {
            light: (0..height).flat_map(row).collect(),
            width,
            height,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::linear::encoded;
    use super::*;
    use image::Rgba;

    #[test]
    fn pixels_are_met_at_their_centres_and_edges_go_on() {
        let image = RgbaImage::from_fn(5, 3, |x, y| Rgba([50 * x as u8, 80 * y as u8, 7, 255]));
        let layer = Layer::new(&Picture::new(image.clone()));
        let sampler = layer.sampler(1.0);
        for (x, y, pixel) in image.enumerate_pixels() {
            let centre = DVec2::new(f64::from(x) + 0.5, 3.0 - f64::from(y) - 0.5);
            assert_eq!(encoded(sampler.at(centre)), *pixel);
        }
        assert_eq!(
            encoded(sampler.at(DVec2::new(-9.0, 99.0))),
            *image.get_pixel(0, 0)
        );
        let nowhere = sampler.at(DVec2::splat(f64::NAN));
        assert!(nowhere.iter().all(|c| c.is_finite()));
    }

    #[test]
    fn seen_small_a_fine_pattern_is_its_mean() {
        let image = RgbaImage::from_fn(64, 64, |x, y| {
            let v = if (x + y) % 2 == 0 { 255 } else { 0 };
            Rgba([v, v, v, 255])
        });
        let layer = Layer::new(&Picture::new(image));
        let sampler = layer.sampler(8.0);
        let light = sampler.at(DVec2::new(20.3, 31.7));
        assert!((light[0] - 0.5).abs() < 1e-6);
    }
}
