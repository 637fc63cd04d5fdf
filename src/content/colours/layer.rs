//! Picture in linear light with a mipmap pyramid, sampled bilinearly at any point of the plane.

use super::super::placement_scan::AffinePlane;
use super::linear_light::{LinearLight, decode, encode_premultiplied, mean, mix};
use crate::design::Picture;
use crate::geometry::{Bounds, DMat2, DVec2};
use glam::DAffine2;
use image::RgbaImage;
use rayon::prelude::*;
use std::sync::Arc;

/// Picture in linear light with its mipmap pyramid and its place in the plane. Cloning is cheap.
#[derive(Clone, Debug)]
pub struct PictureLayer {
    picture: Picture,
    /// Levels of the pyramid, from full resolution down to a single pixel.
    mip_levels: Arc<Vec<MipLevel>>,
    /// Affine map from the plane to pixel coordinates of the picture: x right, y down, origin in
    /// the picture's upper left corner.
    from_plane: DAffine2,
}

/// Level of the mipmap pyramid.
#[derive(Debug)]
pub(super) struct MipLevel {
    width: usize,
    height: usize,
    /// Pixels row by row from the top, followed by padding of one row and one pixel. Every pixel
    /// then has a neighbour to its right and one below.
    light: Vec<LinearLight>,
}

impl PictureLayer {
    /// Decodes a picture and builds its pyramid. Takes 22 bytes of memory for each pixel.
    #[must_use]
    pub fn new(picture: &Picture) -> Self {
        let mut levels = vec![MipLevel::of(picture.pixels())];
        while let Some(next) = levels.last().and_then(MipLevel::halved) {
            levels.push(next);
        }
        let inverse = picture.place().inverse();
        let height = f64::from(picture.pixels().height());
        // In pictures y points down and the origin is at the top; in the plane y points up.
        let flip = scale_then_translate(DVec2::new(1.0, -1.0), DVec2::new(0.0, height));
        let own = DAffine2::from_mat2_translation(inverse.linear(), inverse.apply(DVec2::ZERO));
        Self {
            from_plane: flip * own,
            mip_levels: Arc::new(levels),
            picture: picture.clone(),
        }
    }

    /// The picture from which the layer was made.
    #[must_use]
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Bounding box of the picture in the plane.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.picture.bounds()
    }

    /// Converts a point of the plane to pixel coordinates of the picture: from its upper left
    /// corner, y down.
    #[must_use]
    pub fn pixel_from_plane(&self, p: DVec2) -> DVec2 {
        self.from_plane.transform_point2(p)
    }

    /// Returns the bytes of all pyramid levels, the largest level first, and the number of levels.
    /// Each level is stored row by row from the top, with four bytes for each pixel: sRGB values of
    /// the light multiplied by alpha, and alpha.
    #[must_use]
    pub fn texture(&self) -> (Vec<u8>, u32) {
        let lights = self.mip_levels.iter().flat_map(MipLevel::pixels);
        let bytes = lights.flat_map(|&light| encode_premultiplied(light));
        (bytes.collect(), self.mip_levels.len() as u32)
    }

    /// Side length of a pixel of the picture, in units of the plane.
    fn pixel(&self) -> f64 {
        self.picture.place().scale
    }

    /// Returns a sampler for output pixels of the side length `size` in the plane. It reads the
    /// pyramid level whose pixels have about that size. This avoids flicker where many pixels of
    /// the picture fall into one output pixel.
    pub(super) fn sampler(&self, size: f64) -> PictureSampler<'_> {
        let ratio = (size / self.pixel()).max(1.0);
        // The ratio is infinite if the scale of the picture is 0.
        let index = if ratio.is_finite() {
            // A level is used until its pixels are 2^0.75 ≈ 1.7 times finer than the output's;
            // beyond that, the next level is used.
            (ratio.log2() + 0.25) as usize
        } else {
            0
        };
        let level = &self.mip_levels[index.min(self.mip_levels.len() - 1)];
        let scale = level.size() / self.mip_levels[0].size();
        // Samples lie at the centres of pixels, half a pixel from the corner.
        let from_plane = scale_then_translate(scale, DVec2::splat(-0.5)) * self.from_plane;
        PictureSampler { level, from_plane }
    }
}

/// Returns the affine map that scales by `by` along the axes and then translates by `offset`.
fn scale_then_translate(by: DVec2, offset: DVec2) -> DAffine2 {
    DAffine2::from_mat2_translation(DMat2::from_diagonal(by), offset)
}

/// Level of a picture's pyramid, ready to be sampled.
#[derive(Clone, Copy)]
pub(super) struct PictureSampler<'a> {
    level: &'a MipLevel,
    from_plane: DAffine2,
}

/// The length of one pixel in 32.32 fixed-point format.
const ONE: f64 = (1u64 << 32) as f64;

/// Maximum distance of a sampled position from the picture's upper left corner, in pixels along
/// each axis; positions farther away are clamped to it (derived: twice that distance does not
/// overflow the fixed-point format).
const FAR: f64 = (1u64 << 29) as f64;

impl<'a> PictureSampler<'a> {
    /// Prepares the sampling of a face. Its samples start at column and row `first` and extend over
    /// at most `max_offset` columns and rows. `plane` maps columns and rows of samples to points of
    /// the plane.
    ///
    /// Positions are exact to `max_offset` · 2⁻³⁰ pixels if neighbouring samples are at most 2²⁸ /
    /// `max_offset` pixels apart. Longer distances are shortened to that; neighbouring samples
    /// would read unrelated pixels anyway.
    pub fn footprint(
        &self,
        plane: &AffinePlane,
        first: [usize; 2],
        max_offset: usize,
    ) -> PixelFootprint<'a> {
        // The first sample is at most [`FAR`] away. The sample that is `max_offset` columns and as
        // many rows after it is at most twice as far away.
        let max_step = 0.5 * FAR / max_offset.max(1) as f64;
        // The cast turns NaN into 0.
        let fixed = |at: DVec2, limit: f64| {
            let at = at.to_array();
            at.map(|x| (x.clamp(-limit, limit) * ONE) as i64)
        };
        let level = self.level;
        let last = |count: usize| ((count - 1) as i64) << 32;
        let step = |by: DVec2| self.from_plane.transform_vector2(by);
        let start = self
            .from_plane
            .transform_point2(plane.at(first[0], first[1]));
        PixelFootprint {
            light: &level.light,
            width: level.width,
            last: [last(level.width), last(level.height)],
            first,
            start: fixed(start, FAR),
            by_x: fixed(step(plane.by_x), max_step),
            by_y: fixed(step(plane.by_y), max_step),
        }
    }
}

/// Picture that is sampled along an affine map, with positions in 32.32 fixed-point format.
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
    /// Samples the picture at consecutive output pixels of row `y`, from column `x` on: bilinearly
    /// between pixel centres, and mirrored beyond the edges.
    ///
    /// Replaces each element of `lights` by `with(element, sampled light)`.
    #[inline]
    pub fn sample_row(
        &self,
        [x, y]: [usize; 2],
        lights: &mut [LinearLight],
        with: impl Fn(LinearLight, LinearLight) -> LinearLight,
    ) {
        // Positions are relative to the face's first sample, which keeps the products and their
        // rounding errors small.
        let right = (x - self.first[0]) as i64;
        let down = (y - self.first[1]) as i64;
        let place = |k: usize| self.start[k] + right * self.by_x[k] + down * self.by_y[k];
        let (mut x, mut y) = (place(0), place(1));
        for out in lights {
            *out = with(*out, self.at(x, y));
            (x, y) = (x + self.by_x[0], y + self.by_x[1]);
        }
    }

    /// Returns the light at a position in fixed-point format.
    #[inline]
    fn at(&self, x: i64, y: i64) -> LinearLight {
        let (x, y) = (
            mirror_coordinate(x, self.last[0]),
            mirror_coordinate(y, self.last[1]),
        );
        let at = (y >> 32) as usize * self.width + (x >> 32) as usize;
        let (u, v) = (fractional_part(x), fractional_part(y));
        // In the last column the fraction u is 0, so the right neighbour has no weight; the same
        // holds for the last row.
        let row = |at: usize| {
            let two = &self.light[at..at + 2];
            mix(two[0], two[1], u)
        };
        mix(row(at), row(at + self.width), v)
    }
}

/// The length of half a pixel in 32.32 fixed-point format.
const HALF: i64 = 1 << 31;

/// Reflects `x` at the edges of the picture, as often as needed. Returns a position between the
/// centres of the first and the last pixel, 0 and `last`.
#[inline]
fn mirror_coordinate(x: i64, last: i64) -> i64 {
    // Fast path: nearly all samples lie in the picture, and a division would take longer than the
    // rest of the lookup.
    if (0..=last).contains(&x) {
        return x;
    }
    let size = last + 2 * HALF;
    let from_edge = (x + HALF).rem_euclid(2 * size);
    let folded = from_edge.min(2 * size - from_edge);
    (folded - HALF).clamp(0, last)
}

/// Returns the fractional part of a number in fixed-point format, to 24 bits.
#[inline]
fn fractional_part(x: i64) -> f32 {
    /// Number of steps into which the fractional part divides a pixel.
    const BITS: f32 = (1 << 24) as f32;
    ((x as u32) >> 8) as i32 as f32 * (1.0 / BITS)
}

impl MipLevel {
    /// Creates a level from its pixels and adds the padding of one row and one pixel.
    fn new(width: usize, height: usize, mut light: Vec<LinearLight>) -> Self {
        let padded_len = width * height + width + 1;
        // `resize` alone may reserve twice as much memory.
        light.reserve_exact(padded_len - light.len());
        light.resize(padded_len, LinearLight::ZERO);
        Self {
            width,
            height,
            light,
        }
    }

    /// Creates the level of full resolution by decoding the pixels of a picture.
    fn of(pixels: &RgbaImage) -> Self {
        let (width, height) = (pixels.width() as usize, pixels.height() as usize);
        let raw = pixels.as_raw().par_chunks_exact(4);
        let light = raw.map(|p| decode(image::Rgba([p[0], p[1], p[2], p[3]])));
        Self::new(width, height, light.collect())
    }

    /// Width and height of the level in pixels.
    fn size(&self) -> DVec2 {
        DVec2::new(self.width as f64, self.height as f64)
    }

    /// Pixels of the level without the padding.
    fn pixels(&self) -> &[LinearLight] {
        &self.light[..self.width * self.height]
    }

    /// Returns the next level: half as wide and half as high, rounded down as on graphics cards;
    /// `None` for a single pixel.
    fn halved(&self) -> Option<Self> {
        if self.width * self.height <= 1 {
            return None;
        }
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let row = |y: usize| {
            (0..width).map(move |x| {
                // If a side is one pixel long, there is no second pixel and the first one counts
                // twice.
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

    /// Returns the light that a sampler reads at one point of the plane.
    fn at(sampler: &PictureSampler<'_>, first: DVec2) -> LinearLight {
        let plane = AffinePlane {
            origin: first,
            by_x: DVec2::ZERO,
            by_y: DVec2::ZERO,
        };
        let mut light = [LinearLight::ZERO];
        let footprint = sampler.footprint(&plane, [0, 0], 1);
        footprint.sample_row([0, 0], &mut light, |_, light| light);
        light[0]
    }

    fn encoded(light: LinearLight) -> Rgba<u8> {
        SrgbEncoder::new().encode(light)
    }

    #[test]
    fn samples_at_centres_are_pixels_and_edges_mirror() {
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
    fn a_fine_pattern_seen_small_is_its_mean() {
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
