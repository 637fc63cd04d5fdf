//! Two pictures that are cross-dissolved while a warp moves them: the content *colours*.
//!
//! Pictures are mixed in linear light, because light is additive and sRGB values are not. Alpha is
//! premultiplied, so the colours of transparent pixels have no effect. The fraction of the target
//! in the mix follows its own easing over t, independent of the motion.
//!
//! Guaranteed: at t = 0 and t = 1, an output pixel that coincides with a pixel of the picture has
//! the same value. Beyond its edges a picture continues as its mirror image; repeated edge colours
//! would show as smears. The output is cropped to a rectangle that moves from the bounds of the
//! source to those of the target.

mod layer;
mod linear_light;
mod many_designs;

pub use layer::PictureLayer;
pub use many_designs::PictureSet;

use super::placement_scan::{SourceFacet, scan};
use crate::design::Picture;
use crate::geometry::{Bounds, DVec2};
use crate::time::NamedEasing;
use crate::warp::Placement;
use image::RgbaImage;
use layer::PictureSampler;
use linear_light::{LinearLight, SrgbEncoder, mix};
use serde::{Deserialize, Serialize};

/// Mix of two pictures: how the fraction of the target changes over t.
///
/// ```
/// use morphospace::content::ColourMix;
/// let late = ColourMix { from: 0.5, ..ColourMix::default() };
/// assert_eq!([0.4, 0.75, 1.0].map(|t| late.target_fraction(t)), [0.0, 0.5, 1.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ColourMix {
    /// Easing of the target's fraction between `from` and `to`.
    pub curve: NamedEasing,
    /// The t at which the mix starts, in [0, 1). Before it only the source is visible.
    pub from: f64,
    /// The t at which the mix ends, in (`from`, 1]. After it only the target is visible.
    pub to: f64,
}

/// Error of [`ColourMix::check`]: the interval of the mix is empty or extends beyond [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "colours cannot change from t = {from} to t = {to}; enter values with 0 \u{2264} from < to \u{2264} 1"
)]
pub struct ColourMixError {
    from: f64,
    to: f64,
}

impl Default for ColourMix {
    /// Returns a linear mix from t = 0 to t = 1.
    fn default() -> Self {
        Self {
            curve: NamedEasing::Linear,
            from: 0.0,
            to: 1.0,
        }
    }
}

impl ColourMix {
    /// Checks that 0 ≤ `from` < `to` ≤ 1.
    ///
    /// # Errors
    /// [`ColourMixError`] if the interval is empty or extends beyond [0, 1].
    pub fn check(&self) -> Result<(), ColourMixError> {
        let Self { from, to, .. } = *self;
        if from >= 0.0 && from < to && to <= 1.0 {
            Ok(())
        } else {
            Err(ColourMixError { from, to })
        }
    }

    /// Returns the fraction of the target in the mix at `t`, in [0, 1]. It is 0 before the mix
    /// starts and 1 after it ends.
    #[must_use]
    pub fn target_fraction(&self, t: f64) -> f64 {
        let fraction = ((t - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        self.curve.apply(fraction)
    }
}

/// Two pictures, and how they are mixed. Cloning is cheap.
#[derive(Clone, Debug)]
pub struct PicturePair {
    layers: [PictureLayer; 2],
    mix: ColourMix,
}

/// Pixel grid of an output image: its size, and its position in the plane.
#[derive(Clone, Copy, Debug)]
pub struct PictureRaster {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Position in the plane of the image's upper left corner, a corner of the first pixel.
    pub corner: DVec2,
    /// Side length of a pixel, in units of the plane.
    pub pixel_size: f64,
}

impl PictureRaster {
    /// Converts a point of the plane to pixel coordinates in the output image: from its upper left
    /// corner, y down.
    fn pixel_from_plane(&self, p: DVec2) -> DVec2 {
        let d = (p - self.corner) / self.pixel_size;
        DVec2::new(d.x, -d.y)
    }
}

impl PicturePair {
    /// Decodes two pictures to linear light.
    ///
    /// # Errors
    /// [`ColourMixError`] if the interval of the mix is invalid.
    pub fn new(source: &Picture, target: &Picture, mix: ColourMix) -> Result<Self, ColourMixError> {
        mix.check()?;
        // The pictures are decoded in parallel, because decoding one takes as long as rendering
        // several output images.
        let (source, target) =
            rayon::join(|| PictureLayer::new(source), || PictureLayer::new(target));
        Ok(Self {
            layers: [source, target],
            mix,
        })
    }

    /// Returns the decoded pictures of source and target.
    #[must_use]
    pub fn layers(&self) -> &[PictureLayer; 2] {
        &self.layers
    }

    /// Returns how the two pictures are mixed.
    #[must_use]
    pub fn mix(&self) -> &ColourMix {
        &self.mix
    }

    /// Returns the rectangle to which the output is cropped at `t`: the bounds of source and
    /// target, interpolated.
    #[must_use]
    pub fn window(&self, t: f64) -> Bounds {
        // Clamped, because in an extrapolated rectangle the minimum may exceed the maximum.
        let t = t.clamp(0.0, 1.0);
        let [a, b] = [self.layers[0].bounds(), self.layers[1].bounds()];
        Bounds {
            min: a.min.lerp(b.min, t),
            max: a.max.lerp(b.max, t),
        }
    }

    /// Renders the picture at `t` in sRGB with straight alpha; pixels that no face covers are
    /// transparent. Takes one bilinear lookup for each pixel and picture.
    ///
    /// `placement` must be the placement of the warp at the same `t`.
    ///
    /// # Panics
    /// Panics if a face of the placement has a vertex without a position.
    #[must_use]
    pub fn render(&self, placement: &Placement, t: f64, raster: &PictureRaster) -> RgbaImage {
        let [width, height] = raster.size;
        let mut out = RgbaImage::new(width, height);
        let (pixels, _) = out.as_chunks_mut::<4>();
        let to_lattice = |p: DVec2| raster.pixel_from_plane(p) - 0.5;
        let paint = PicturePaint::new(self, t, raster);
        let filler = |facet: SourceFacet| paint.filler(facet);
        scan(placement, to_lattice, width as usize, pixels, filler);
        out
    }
}

/// Number of pixels that are sampled from one picture before the other picture is sampled (resource
/// limit: the light of these pixels takes 512 bytes; the cost of switching is negligible).
const CHUNK: usize = 32;

/// Renders one output image, run by run: a run is a sequence of adjacent pixels of one row.
struct PicturePaint<'a> {
    /// Source and target, sampled at the resolution of the output.
    layers: [PictureSampler<'a>; 2],
    /// Fraction of the target in the mix, from 0 to 1.
    share: f32,
    /// For each column and for each row, the fraction of it that lies in the visible rectangle.
    coverages: [Vec<f32>; 2],
    encoder: SrgbEncoder,
}

impl<'a> PicturePaint<'a> {
    fn new(pair: &'a PicturePair, t: f64, raster: &PictureRaster) -> Self {
        Self {
            layers: [0, 1].map(|k| pair.layers[k].sampler(raster.pixel_size)),
            share: pair.mix.target_fraction(t) as f32,
            coverages: coverage(pair.window(t), raster),
            encoder: SrgbEncoder::new(),
        }
    }

    /// Returns the function that fills the pixels of a face. It is called with the column and the
    /// row of the first pixel of a run, and with the pixels of the run.
    fn filler(&self, facet: SourceFacet) -> impl FnMut(usize, usize, &mut [[u8; 4]]) {
        let [columns, rows] = &self.coverages;
        // Maximum number of columns or rows between two samples of the output.
        let max_offset = columns.len().max(rows.len());
        let [source, target] = &self.layers;
        let source = source.footprint(&facet.source, facet.first_sample, max_offset);
        let target = target.footprint(&facet.target, facet.first_sample, max_offset);
        let mut lights = [LinearLight::ZERO; CHUNK];
        move |x, y, pixels| {
            // The pictures are sampled one after the other, so that the pixels of only one picture
            // must fit into the cache.
            let columns = columns[x..].chunks(CHUNK);
            let starts = (x..).step_by(CHUNK);
            for ((x, pixels), columns) in starts.zip(pixels.chunks_mut(CHUNK)).zip(columns) {
                let lights = &mut lights[..pixels.len()];
                // Where the mix is all source or all target, only one picture is sampled.
                if self.share == 1.0 {
                    target.sample_row([x, y], lights, |_, light| light);
                } else {
                    source.sample_row([x, y], lights, |_, light| light);
                }
                if self.share > 0.0 && self.share < 1.0 {
                    target.sample_row([x, y], lights, |before, light| {
                        mix(before, light, self.share)
                    });
                }
                for ((pixel, light), column) in pixels.iter_mut().zip(lights).zip(columns) {
                    *pixel = self.encoder.encode(*light * (rows[y] * column)).0;
                }
            }
        }
    }
}

/// Returns, for each column and for each row, the fraction of it that lies in a rectangle. The
/// fraction of a pixel in the rectangle is the product of the two.
fn coverage(window: Bounds, raster: &PictureRaster) -> [Vec<f32>; 2] {
    let low = raster.pixel_from_plane(DVec2::new(window.min.x, window.max.y));
    let high = raster.pixel_from_plane(DVec2::new(window.max.x, window.min.y));
    let fractions = |count: u32, low: f64, high: f64| {
        let pixels = 0..count;
        pixels.map(|k| pixel_coverage(k, low, high)).collect()
    };
    let [width, height] = raster.size;
    [
        fractions(width, low.x, high.x),
        fractions(height, low.y, high.y),
    ]
}

/// Returns the fraction of column or row `k` that lies between two coordinates.
fn pixel_coverage(k: u32, from: f64, to: f64) -> f32 {
    let (low, high) = (f64::from(k), f64::from(k) + 1.0);
    // An edge that is within rounding of a pixel boundary counts as lying on it.
    let share = high.min(to) - low.max(from);
    if share > 1.0 - 1e-9 {
        1.0
    } else {
        share.max(0.0) as f32
    }
}

#[cfg(test)]
mod tests;
