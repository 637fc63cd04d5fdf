//! One of the two pictures, to be looked up anywhere in the plane.

use super::super::placement_scan::AffinePlane;
use super::linear_light::{LinearLight, coded_premultiplied, decoded, mean, mixed};
use crate::design::Picture;
use crate::geometry::{Bounds, DMat2, DVec2};
use glam::DAffine2;
use image::RgbaImage;
use rayon::prelude::*;
use std::sync::Arc;

/// A picture in linear light, in its own size and smaller ones, where it lies
/// in the plane. Cloning is cheap.
#[derive(Clone, Debug)]
pub struct PictureLayer {
    picture: Picture,
    levels: Arc<Vec<MipLevel>>,
    /// From the plane to the picture's own coordinates: x across, y down.
    from_plane: DAffine2,
}

/// The picture at one size, row by row from above.
#[derive(Debug)]
pub(super) struct MipLevel {
    width: usize,
    height: usize,
    /// One pixel for each and, so that every pixel has one to its right and one
    /// below, another row and one more.
    light: Vec<LinearLight>,
}

impl PictureLayer {
    /// Decodes a picture. Takes 22 bytes a pixel.
    #[must_use]
    pub fn new(picture: &Picture) -> Self {
        let mut levels = vec![MipLevel::of(picture.pixels())];
        while let Some(next) = levels.last().and_then(MipLevel::halved) {
            levels.push(next);
        }
        let inverse = picture.place().inverse();
        let height = f64::from(picture.pixels().height());
        // Pictures have y down and their origin above, the plane has not.
        let flip = scaled(DVec2::new(1.0, -1.0), DVec2::new(0.0, height));
        let own = DAffine2::from_mat2_translation(inverse.linear(), inverse.apply(DVec2::ZERO));
        Self {
            from_plane: flip * own,
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
        self.from_plane.transform_point2(p)
    }

    /// All sizes, the largest first and each row by row from above: coded in
    /// sRGB, alpha premultiplied in linear light, four bytes a pixel; and how
    /// many sizes there are.
    #[must_use]
    pub fn texture(&self) -> (Vec<u8>, u32) {
        let lights = self.levels.iter().flat_map(MipLevel::pixels);
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
    pub(super) fn sampler(&self, size: f64) -> PictureSampler<'_> {
        let ratio = (size / self.pixel()).max(1.0);
        // A picture may have been shrunk to nothing.
        let wanted = if ratio.is_finite() {
            // Up to 1.7 of a level's pixels go into one of the output (2^0.75),
            // then the next level is taken.
            (ratio.log2() + 0.25) as usize
        } else {
            0
        };
        let level = wanted.min(self.levels.len() - 1);
        let level = &self.levels[level];
        let scale = level.size() / self.levels[0].size();
        // A sample is at the centre of its pixel, half a one from the corner.
        let from_plane = scaled(scale, DVec2::splat(-0.5)) * self.from_plane;
        PictureSampler { level, from_plane }
    }
}

/// Stretches along the axes, then moves.
fn scaled(by: DVec2, offset: DVec2) -> DAffine2 {
    DAffine2::from_mat2_translation(DMat2::from_diagonal(by), offset)
}

/// A layer at one of its sizes.
#[derive(Clone, Copy)]
pub(super) struct PictureSampler<'a> {
    level: &'a MipLevel,
    from_plane: DAffine2,
}

/// Fixed point: what a step from one pixel to the next is.
const ONE: f64 = (1u64 << 32) as f64;

/// How far from a picture a place is told from others, in its pixels; beyond
/// there is nothing but the edge. Twice as far away does not overflow.
const FAR: f64 = (1u64 << 29) as f64;

impl<'a> PictureSampler<'a> {
    /// Made to be looked up where samples near `first`, up to `reach` columns
    /// and rows further on, see it.
    ///
    /// Places are exact to `reach` · 2⁻³⁰ pixels where from one sample to the
    /// next they are up to 2²⁸ / `reach` pixels apart. Longer steps, which
    /// meet pixels that have nothing to do with each other, are shortened.
    pub fn across(
        &self,
        plane: &AffinePlane,
        first: [usize; 2],
        reach: usize,
    ) -> PixelFootprint<'a> {
        // From the start, at most FAR away, `reach` steps across and as many
        // down leave it at most twice as far.
        let farthest = 0.5 * FAR / reach.max(1) as f64;
        // NaN goes to 0.
        let fixed = |at: DVec2, limit: f64| {
            let at = at.to_array();
            at.map(|x| (x.clamp(-limit, limit) * ONE) as i64)
        };
        let level = self.level;
        let last = |count: usize| ((count - 1) as i64) << 32;
        let at = |by: DVec2| self.from_plane.transform_vector2(by);
        let start = self
            .from_plane
            .transform_point2(plane.at(first[0], first[1]));
        PixelFootprint {
            light: &level.light,
            width: level.width,
            last: [last(level.width), last(level.height)],
            first,
            start: fixed(start, FAR),
            by_x: fixed(at(plane.by_x), farthest),
            by_y: fixed(at(plane.by_y), farthest),
        }
    }
}

/// A picture as the samples of a face see it. Places are in fixed point: 32
/// bits are behind the point.
pub(super) struct PixelFootprint<'a> {
    light: &'a [LinearLight],
    width: usize,
    last: [i64; 2],
    first: [usize; 2],
    start: [i64; 2],
    by_x: [i64; 2],
    by_y: [i64; 2],
}

impl PixelFootprint<'_> {
    /// For each of `lights` what `with` makes of it and of the light that the
    /// samples of row `y` see from column `x` on: bilinear between pixel
    /// centres, beyond the picture its mirror image.
    #[inline]
    pub fn look(
        &self,
        [x, y]: [usize; 2],
        lights: &mut [LinearLight],
        with: impl Fn(LinearLight, LinearLight) -> LinearLight,
    ) {
        // Counted from the face's own first sample: that keeps the products
        // small, and what they lose.
        let right = (x - self.first[0]) as i64;
        let down = (y - self.first[1]) as i64;
        let place = |k: usize| self.start[k] + right * self.by_x[k] + down * self.by_y[k];
        let (mut x, mut y) = (place(0), place(1));
        for out in lights {
            *out = with(*out, self.at(x, y));
            (x, y) = (x + self.by_x[0], y + self.by_x[1]);
        }
    }

    #[inline]
    fn at(&self, x: i64, y: i64) -> LinearLight {
        let (x, y) = (mirrored(x, self.last[0]), mirrored(y, self.last[1]));
        let at = (y >> 32) as usize * self.width + (x >> 32) as usize;
        let (u, v) = (behind_the_point(x), behind_the_point(y));
        // In the last column u = 0: what is right of it does not matter. So it
        // is with the last row.
        let row = |at: usize| {
            let two = &self.light[at..at + 2];
            mixed(two[0], two[1], u)
        };
        mixed(row(at), row(at + self.width), v)
    }
}

/// Half a pixel in fixed point.
const HALF: i64 = 1 << 31;

/// The place between the first pixel's centre and the last's that mirrors at
/// the picture's edges bring to `x`, however often.
#[inline]
fn mirrored(x: i64, last: i64) -> i64 {
    // Nearly all samples lie in the picture, and a division takes longer than
    // the rest of the look-up.
    if (0..=last).contains(&x) {
        return x;
    }
    let size = last + 2 * HALF;
    let from_edge = (x + HALF).rem_euclid(2 * size);
    let folded = from_edge.min(2 * size - from_edge);
    (folded - HALF).clamp(0, last)
}

/// What a number in fixed point has over a whole one; to 24 bits.
#[inline]
fn behind_the_point(x: i64) -> f32 {
    const BITS: f32 = (1 << 24) as f32;
    ((x as u32) >> 8) as i32 as f32 * (1.0 / BITS)
}

impl MipLevel {
    fn new(width: usize, height: usize, mut light: Vec<LinearLight>) -> Self {
        let whole = width * height + width + 1;
        // `resize` alone would make room for twice as much.
        light.reserve_exact(whole - light.len());
        light.resize(whole, LinearLight::ZERO);
        Self {
            width,
            height,
            light,
        }
    }

    fn of(pixels: &RgbaImage) -> Self {
        let (width, height) = (pixels.width() as usize, pixels.height() as usize);
        let raw = pixels.as_raw().par_chunks_exact(4);
        let light = raw.map(|p| decoded(image::Rgba([p[0], p[1], p[2], p[3]])));
        Self::new(width, height, light.collect())
    }

    /// Width and height.
    fn size(&self) -> DVec2 {
        DVec2::new(self.width as f64, self.height as f64)
    }

    fn pixels(&self) -> &[LinearLight] {
        &self.light[..self.width * self.height]
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
                // A side of one pixel has no second one: it counts twice.
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
        let light = (0..height).flat_map(row).collect();
        Some(Self::new(width, height, light))
    }
}

#[cfg(test)]
mod tests {
    use super::super::linear_light::SrgbEncoder;
    use super::*;
    use image::Rgba;

    /// The light at one point.
    fn at(sampler: &PictureSampler<'_>, first: DVec2) -> LinearLight {
        let plane = AffinePlane {
            origin: first,
            by_x: DVec2::ZERO,
            by_y: DVec2::ZERO,
        };
        let mut light = [LinearLight::ZERO];
        let sight = sampler.across(&plane, [0, 0], 1);
        sight.look([0, 0], &mut light, |_, light| light);
        light[0]
    }

    fn encoded(light: LinearLight) -> Rgba<u8> {
        SrgbEncoder::new().encoded(light)
    }

    #[test]
    fn pixels_are_met_at_their_centres_and_edges_are_mirrors() {
        let image = RgbaImage::from_fn(5, 3, |x, y| Rgba([50 * x as u8, 80 * y as u8, 7, 255]));
        let layer = PictureLayer::new(&Picture::new(image.clone()));
        let sampler = layer.sampler(1.0);
        for (x, y, pixel) in image.enumerate_pixels() {
            let centre = DVec2::new(f64::from(x) + 0.5, 3.0 - f64::from(y) - 0.5);
            assert_eq!(encoded(at(&sampler, centre)), *pixel);
        }
        let beyond = |x, y| encoded(at(&sampler, DVec2::new(x, y)));
        assert_eq!(beyond(-1.5, 4.5), *image.get_pixel(1, 1));
        assert_eq!(beyond(7.5, -0.5), *image.get_pixel(2, 2));
        assert_eq!(beyond(-10.5, 10.5), *image.get_pixel(0, 1));
        assert!(at(&sampler, DVec2::splat(f64::NAN)).is_finite());
    }

    #[test]
    fn seen_small_a_fine_pattern_is_its_mean() {
        let image = RgbaImage::from_fn(64, 64, |x, y| {
            let v = if (x + y) % 2 == 0 { 255 } else { 0 };
            Rgba([v, v, v, 255])
        });
        let layer = PictureLayer::new(&Picture::new(image));
        let sampler = layer.sampler(8.0);
        let light = at(&sampler, DVec2::new(20.3, 31.7));
        assert!((light.x - 0.5).abs() < 1e-6);
    }
}
