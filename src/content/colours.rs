//! Two pictures, cross-dissolved through a warp.
//!
//! Light adds up, sRGB values do not: pictures are mixed in linear light, with
//! alpha premultiplied, so that what is transparent has no colour to bleed.
//! The mix runs over t by a curve of its own, apart from the shape's.
//!
//! Guarantees: at t = 0 and t = 1, and where a pixel of the output lies on one
//! of the picture, its value is the picture's. A picture goes on beyond its
//! edge with the colours of the edge; what is shown is cut to a rectangle on
//! its way from the source's to the target's.

mod layer;
mod linear;

pub use layer::Layer;

use super::scan::scan;
use crate::design::Picture;
use crate::easing::Easing;
use crate::geometry::{Bounds, DVec2};
use crate::warp::Placement;
use image::RgbaImage;
use layer::Sampler;
use linear::{Light, encoded, mixed};
use rayon::prelude::*;
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
    pub curve: Easing,
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
            curve: Easing::Linear,
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
    layers: [Layer; 2],
    mix: ColourMix,
}

/// Where the pixels of an output lie in the plane.
#[derive(Clone, Copy, Debug)]
pub struct Raster {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// The upper left corner of the upper left pixel.
    pub corner: DVec2,
    /// The side of a pixel.
    pub pixel: f64,
}

impl Raster {
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
        let (source, target) = rayon::join(|| Layer::new(source), || Layer::new(target));
        Ok(Self {
            layers: [source, target],
            mix,
        })
    }

    /// The same pictures mixed another way; decodes nothing again.
    ///
    /// # Errors
    /// Where the span of the mix is none.
    pub fn with_mix(&self, mix: ColourMix) -> Result<Self, ColourMixError> {
        mix.check()?;
        Ok(Self {
            layers: self.layers.clone(),
            mix,
        })
    }

    /// Source and target.
    #[must_use]
    pub fn layers(&self) -> &[Layer; 2] {
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
        let t = t.clamp(0.0, 1.0);
        let [a, b] = [self.layers[0].bounds(), self.layers[1].bounds()];
        Bounds {
            min: a.min.lerp(b.min, t),
            max: a.max.lerp(b.max, t),
        }
    }

    /// What is seen at t: sRGB with straight alpha, transparent where nothing
    /// is. Costs a bilinear look-up in each picture for each pixel.
    #[must_use]
    pub fn render(&self, placement: &Placement, t: f64, raster: &Raster) -> RgbaImage {
        let [width, height] = raster.size.map(|side| side as usize);
        let mut light: Vec<Light> = vec![[0.0; 4]; width * height];
        let [source, target] = [0, 1].map(|k| self.layers[k].sampler(raster.pixel));
        let to_lattice = |p: DVec2| raster.located(p) - 0.5;
        let share = self.mix.share(t) as f32;
        let only = |sampler: &Sampler, at: DVec2| sampler.at(at);
        // At the ends one of the pictures is not looked at.
        if share == 0.0 {
            let value = |at, _| only(&source, at);
            scan(placement, to_lattice, width, &mut light, value);
        } else if share == 1.0 {
            let value = |_, at| only(&target, at);
            scan(placement, to_lattice, width, &mut light, value);
        } else {
            let value = |a, b| mixed(source.at(a), target.at(b), share);
            scan(placement, to_lattice, width, &mut light, value);
        }
        let window = self.window(t);
        let upper_left = raster.located(DVec2::new(window.min.x, window.max.y));
        let lower_right = raster.located(DVec2::new(window.max.x, window.min.y));
        let mut out = vec![0; 4 * width * height];
        let rows = out.par_chunks_mut(4 * width.max(1));
        let lights = light.par_chunks(width.max(1));
        rows.zip(lights).enumerate().for_each(|(y, (row, light))| {
            let down = covered(y, upper_left.y, lower_right.y);
            for (x, (pixel, light)) in row.chunks_exact_mut(4).zip(light).enumerate() {
                let share = down * covered(x, upper_left.x, lower_right.x);
                pixel.copy_from_slice(&encoded(light.map(|c| c * share)).0);
            }
        });
        RgbaImage::from_raw(raster.size[0], raster.size[1], out).unwrap_or_default()
    }
}

/// How much of the pixel `k` lies between two edges.
fn covered(k: usize, from: f64, to: f64) -> f32 {
    let (low, high) = (k as f64, k as f64 + 1.0);
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
