//! Cross-dissolve of any number of pictures cⱼ with weights wⱼ: c = Σ wⱼ cⱼ in linear light. In
//! each face, each picture is sampled along its own affine map.
//!
//! Guaranteed: with all weight on one design the result is the picture of this design; for two
//! designs with the weights (1 − t, t) it equals a [`PicturePair`](super::PicturePair) at t to
//! within one of the 255 steps of a channel. Pictures with weight 0 are not sampled.

use super::layer::PictureLayer;
use super::linear_light::{LinearLight, SrgbEncoder};
use super::{ColourMix, ColourMixError, PictureRaster, coverage};
use crate::content::placement_scan::{SourceFacet, scan};
use crate::design::Picture;
use crate::geometry::{Bounds, DVec2};
use crate::warp::ManyPlaces;
use image::RgbaImage;
use rayon::prelude::*;
use std::sync::Arc;

/// One or more pictures, and how they are mixed. Cloning is cheap.
#[derive(Clone, Debug)]
pub struct PictureSet {
    layers: Arc<[PictureLayer]>,
    mix: ColourMix,
}

impl PictureSet {
    /// Decodes the pictures to linear light. Returns `None` if there are none.
    ///
    /// # Errors
    /// [`ColourMixError`] if the interval of the mix is invalid.
    pub fn new(pictures: &[&Picture], mix: ColourMix) -> Result<Option<Self>, ColourMixError> {
        mix.check()?;
        let layers: Vec<PictureLayer> = pictures.par_iter().map(|p| PictureLayer::new(p)).collect();
        Ok((!layers.is_empty()).then(|| Self {
            layers: layers.into(),
            mix,
        }))
    }

    /// Decoded pictures, one for each design.
    #[must_use]
    pub fn layers(&self) -> &[PictureLayer] {
        &self.layers
    }

    /// Returns the rectangle to which the output is cropped for these weights: the weighted mean of
    /// the bounds of all pictures. Weights are clamped to [0, 1], because in an extrapolated
    /// rectangle the minimum may exceed the maximum.
    ///
    /// # Panics
    /// Panics if the number of weights differs from the number of pictures.
    #[must_use]
    pub fn window(&self, weights: &[f64]) -> Bounds {
        let [mut min, mut max] = [DVec2::ZERO; 2];
        for (layer, share) in self.layers.iter().zip(self.normalised(weights, |w| w)) {
            let own = layer.bounds();
            if share == 1.0 {
                return own;
            }
            min += share * own.min;
            max += share * own.max;
        }
        Bounds { min, max }
    }

    /// Returns for each picture its fraction in the mix: its weight, clamped to [0, 1] and
    /// converted by [`ColourMix::target_fraction`], divided by the sum over all pictures.
    fn shares(&self, weights: &[f64]) -> Vec<f64> {
        self.normalised(weights, |weight| self.mix.target_fraction(weight))
    }

    /// Clamps the weights to [0, 1], applies `curve` to each and scales the results to the sum 1.
    fn normalised(&self, weights: &[f64], curve: impl Fn(f64) -> f64) -> Vec<f64> {
        assert_eq!(
            weights.len(),
            self.layers.len(),
            "a weight for each picture"
        );
        let curved: Vec<f64> = weights.iter().map(|w| curve(w.clamp(0.0, 1.0))).collect();
        let sum: f64 = curved.iter().sum();
        if sum > 0.0 {
            curved.into_iter().map(|share| share / sum).collect()
        } else {
            // If the mix starts late, `curve` may give 0 for every weight. Then all pictures count
            // equally.
            vec![1.0 / curved.len() as f64; curved.len()]
        }
    }

    /// Renders the mix for these weights in sRGB with straight alpha, with each picture sampled at
    /// its own positions in `places`. Pixels that no face covers are transparent.
    ///
    /// # Panics
    /// Panics if the number of weights or the number of designs in `places` differs from the number
    /// of pictures.
    #[must_use]
    pub fn render(
        &self,
        places: &ManyPlaces,
        weights: &[f64],
        raster: &PictureRaster,
    ) -> RgbaImage {
        let [width, height] = raster.size;
        let to_lattice = |p: DVec2| raster.pixel_from_plane(p) - 0.5;
        let mut lights = vec![LinearLight::ZERO; width as usize * height as usize];
        for ((k, layer), share) in self.layers.iter().enumerate().zip(self.shares(weights)) {
            if share == 0.0 {
                continue;
            }
            let placement = places.of(k);
            let sampler = layer.sampler(raster.pixel_size);
            let max_offset = raster.size.into_iter().max().unwrap_or_default() as usize;
            let share = share as f32;
            let filler = |facet: SourceFacet| {
                let footprint = sampler.footprint(&facet.source, facet.first_sample, max_offset);
                move |x: usize, y: usize, row: &mut [LinearLight]| {
                    footprint.sample_row([x, y], row, |_, light| share * light);
                }
            };
            // Each picture is sampled into a buffer of its own. A sample on an edge between two
            // faces is written by both; if it were added to the sum directly, it would count twice.
            let mut picture_lights = vec![LinearLight::ZERO; lights.len()];
            scan(
                &placement,
                to_lattice,
                width as usize,
                &mut picture_lights,
                filler,
            );
            let sums = lights.par_iter_mut().zip(&picture_lights);
            sums.for_each(|(sum, light)| *sum += *light);
        }
        let [columns, rows] = coverage(self.window(weights), raster);
        let mut out = RgbaImage::new(width, height);
        let (pixels, _) = out.as_chunks_mut::<4>();
        let encoder = SrgbEncoder::new();
        let width = width as usize;
        let rows_of_pixels = pixels
            .par_chunks_mut(width.max(1))
            .zip(lights.par_chunks(width.max(1)));
        rows_of_pixels
            .zip(&rows)
            .for_each(|((pixels, lights), row)| {
                for ((pixel, light), column) in pixels.iter_mut().zip(lights).zip(&columns) {
                    *pixel = encoder.encode(*light * (row * column)).0;
                }
            });
        out
    }
}
