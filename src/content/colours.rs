//! Two pictures, cross-dissolved through a warp.
//!
//! Light adds up, sRGB values do not: pictures are mixed in linear light, with
//! alpha premultiplied, so that what is transparent has no colour to bleed.
//! The mix runs over t by a curve of its own, apart from the shape's.
//!
//! Guarantees: at t = 0 and t = 1, and where a pixel of the output lies on one
//! of the picture, its value is the picture's. A picture goes on beyond its
//! edge as its mirror image, where the edge's colours alone would smear; what
//! is shown is cut to a rectangle on its way from the source's to the target's.

mod layer;
mod linear_light;
mod many_designs;

pub use layer::PictureLayer;
pub use many_designs::PictureSet;

use super::placement_scan::{SourceFacet, scan};
use crate::design::Picture;
use crate::geometry::{Bounds, DVec2};
use crate::time::easing::NamedEasing;
use crate::warp::Placement;
use image::RgbaImage;
use layer::PictureSampler;
use linear_light::{LinearLight, SrgbEncoder, mixed};
use serde::{Deserialize, Serialize};

/// How the mix of two pictures runs over t.
///
/// ```
/// use morphospace::content::ColourMix;
/// let late = ColourMix { from: 0.5, ..ColourMix::default() };
/// assert_eq!([0.4, 0.75, 1.0].map(|t| late.share(t)), [0.0, 0.5, 1.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ColourMix {
    /// How fast within its span.
    pub curve: NamedEasing,
    /// The t at which the source begins to give way, in [0, 1).
    pub from: f64,
    /// The t from which on only the target is seen, in (from, 1].
    pub to: f64,
}

/// Why a mix is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("colours cannot change from t = {from} to t = {to}: give 0 \u{2264} from < to \u{2264} 1")]
pub struct ColourMixError {
    from: f64,
    to: f64,
}

impl Default for ColourMix {
    /// Evenly, all the way.
    fn default() -> Self {
        Self {
            curve: NamedEasing::Linear,
            from: 0.0,
            to: 1.0,
        }
    }
}

impl ColourMix {
    /// That the span is one.
    ///
    /// # Errors
    /// Where it is empty, or reaches beyond [0, 1].
    pub fn check(&self) -> Result<(), ColourMixError> {
        let Self { from, to, .. } = *self;
        if from >= 0.0 && from < to && to <= 1.0 {
            Ok(())
        } else {
            Err(ColourMixError { from, to })
        }
    }

    /// How much of the target is seen at t, in [0, 1]; beyond the ends that of
    /// the nearer end.
    #[must_use]
    pub fn share(&self, t: f64) -> f64 {
        let along = ((t - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        self.curve.apply(along)
    }
}

/// The content *colours*: two pictures and how they mix. Cloning is cheap.
#[derive(Clone, Debug)]
pub struct PicturePair {
    layers: [PictureLayer; 2],
    mix: ColourMix,
}

/// Where the pixels of an output lie in the plane.
#[derive(Clone, Copy, Debug)]
pub struct PictureRaster {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// The upper left corner of the upper left pixel.
    pub corner: DVec2,
    /// The side of a pixel.
    pub pixel: f64,
}

impl PictureRaster {
    /// Where a point of the plane is, in pixels from the upper left corner.
    fn located(&self, p: DVec2) -> DVec2 {
        let d = (p - self.corner) / self.pixel;
        DVec2::new(d.x, -d.y)
    }
}

impl PicturePair {
    /// Two pictures, mixed.
    ///
    /// # Errors
    /// Where the span of the mix is none.
    pub fn new(source: &Picture, target: &Picture, mix: ColourMix) -> Result<Self, ColourMixError> {
        mix.check()?;
        // Decoding takes as long as several frames, and each knows nothing of
        // the other.
        let (source, target) =
            rayon::join(|| PictureLayer::new(source), || PictureLayer::new(target));
        Ok(Self {
            layers: [source, target],
            mix,
        })
    }

    /// Source and target.
    #[must_use]
    pub fn layers(&self) -> &[PictureLayer; 2] {
        &self.layers
    }

    /// How they mix.
    #[must_use]
    pub fn mix(&self) -> &ColourMix {
        &self.mix
    }

    /// The rectangle that is shown at t.
    #[must_use]
    pub fn window(&self, t: f64) -> Bounds {
        // Beyond the ends the window stays: extrapolated, it might turn inside
        // out.
        let t = t.clamp(0.0, 1.0);
        let [a, b] = [self.layers[0].bounds(), self.layers[1].bounds()];
        Bounds {
            min: a.min.lerp(b.min, t),
            max: a.max.lerp(b.max, t),
        }
    }

    /// What is seen at t: sRGB with straight alpha, transparent where nothing
    /// is. Costs a bilinear look-up in each picture for each pixel.
    ///
    /// # Panics
    /// Where a face of the placement has a vertex without a place.
    #[must_use]
    pub fn render(&self, placement: &Placement, t: f64, raster: &PictureRaster) -> RgbaImage {
        let [width, height] = raster.size;
        let mut out = RgbaImage::new(width, height);
        let (pixels, _) = out.as_chunks_mut::<4>();
        let to_lattice = |p: DVec2| raster.located(p) - 0.5;
        let paint = PicturePaint::new(self, t, raster);
        let filler = |facet: SourceFacet| paint.filler(facet);
        scan(placement, to_lattice, width as usize, pixels, filler);
        out
    }
}

/// Pixels that are looked up at a time, in one picture after the other: their
/// light takes 512 bytes, and starting over hardly counts any more.
const CHUNK: usize = 32;

/// How runs of pixels are painted.
struct PicturePaint<'a> {
    layers: [PictureSampler<'a>; 2],
    /// Of the target, in the mix.
    share: f32,
    /// Of each column and of each row, how much is shown.
    shown: [Vec<f32>; 2],
    encoder: SrgbEncoder,
}

impl<'a> PicturePaint<'a> {
    fn new(pair: &'a PicturePair, t: f64, raster: &PictureRaster) -> Self {
        Self {
            layers: [0, 1].map(|k| pair.layers[k].sampler(raster.pixel)),
            share: pair.mix.share(t) as f32,
            shown: shown(pair.window(t), raster),
            encoder: SrgbEncoder::new(),
        }
    }

    /// Writes the pixels of a face, a part of a row at a time.
    fn filler(&self, facet: SourceFacet) -> impl FnMut(usize, usize, &mut [[u8; 4]]) {
        let [columns, rows] = &self.shown;
        // No sample of the output is farther than this from another.
        let reach = columns.len().max(rows.len());
        let [source, target] = &self.layers;
        let source = source.across(&facet.source, facet.first, reach);
        let target = target.across(&facet.target, facet.first, reach);
        let mut lights = [LinearLight::ZERO; CHUNK];
        move |x, y, pixels| {
            // One picture after the other, so that the rows of only one are
            // walked at a time.
            let columns = columns[x..].chunks(CHUNK);
            let starts = (x..).step_by(CHUNK);
            for ((x, pixels), columns) in starts.zip(pixels.chunks_mut(CHUNK)).zip(columns) {
                let lights = &mut lights[..pixels.len()];
                // At the ends one of the pictures is not looked at.
                if self.share == 1.0 {
                    target.look([x, y], lights, |_, light| light);
                } else {
                    source.look([x, y], lights, |_, light| light);
                }
                if self.share > 0.0 && self.share < 1.0 {
                    target.look([x, y], lights, |before, light| {
                        mixed(before, light, self.share)
                    });
                }
                for ((pixel, light), column) in pixels.iter_mut().zip(lights).zip(columns) {
                    *pixel = self.encoder.encoded(*light * (rows[y] * column)).0;
                }
            }
        }
    }
}

/// How much of each column of a raster, and of each row, a rectangle covers: of a pixel it
/// covers its share of the column times that of the row.
fn shown(window: Bounds, raster: &PictureRaster) -> [Vec<f32>; 2] {
    let low = raster.located(DVec2::new(window.min.x, window.max.y));
    let high = raster.located(DVec2::new(window.max.x, window.min.y));
    let along = |count: u32, low: f64, high: f64| {
        let pixels = 0..count;
        pixels.map(|k| covered(k, low, high)).collect()
    };
    let [width, height] = raster.size;
    [along(width, low.x, high.x), along(height, low.y, high.y)]
}

/// How much of the pixel `k` lies between two edges.
fn covered(k: u32, from: f64, to: f64) -> f32 {
    let (low, high) = (f64::from(k), f64::from(k) + 1.0);
    // What is within rounding of an edge of the pixel is on it.
    let share = high.min(to) - low.max(from);
    if share > 1.0 - 1e-9 {
        1.0
    } else {
        share.max(0.0) as f32
    }
}

#[cfg(test)]
mod tests;
