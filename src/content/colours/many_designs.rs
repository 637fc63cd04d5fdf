//! Pictures of many designs, and how they mix: c = Σ w_j c_j in linear light, each picture
//! looked up through a map of its own.
//!
//! Guaranteed: with all weight on one design its own picture, and of two designs with the
//! weights (1 − t, t) what a [`PicturePair`](super::PicturePair) shows at t, to one step of
//! the 255 of a channel; what has no weight is not looked up.

use super::layer::PictureLayer;
use super::linear_light::{LinearLight, SrgbEncoder};
use super::{ColourMix, ColourMixError, PictureRaster, shown};
use crate::content::placement_scan::{SourceFacet, scan};
use crate::design::Picture;
use crate::geometry::{Bounds, DVec2};
use crate::warp::ManyPlaces;
use image::RgbaImage;
use rayon::prelude::*;
use std::sync::Arc;

/// Pictures, at least one, and their mix. Cloning is cheap.
#[derive(Clone, Debug)]
pub struct PictureSet {
    layers: Arc<[PictureLayer]>,
    mix: ColourMix,
}

impl PictureSet {
    /// None of no pictures.
    ///
    /// # Errors
    /// Where the span of the mix is none.
    pub fn new(pictures: &[&Picture], mix: ColourMix) -> Result<Option<Self>, ColourMixError> {
        mix.check()?;
        let layers: Vec<PictureLayer> = pictures.par_iter().map(|p| PictureLayer::new(p)).collect();
        Ok((!layers.is_empty()).then(|| Self {
            layers: layers.into(),
            mix,
        }))
    }

    /// The pictures, one for each design.
    #[must_use]
    pub fn layers(&self) -> &[PictureLayer] {
        &self.layers
    }

    /// The rectangle that is shown with these weights; beyond the designs that of the
    /// nearest blend, as it might turn inside out.
    ///
    /// # Panics
    /// If there are not as many weights as pictures.
    #[must_use]
    pub fn window(&self, weights: &[f64]) -> Bounds {
        let [mut min, mut max] = [DVec2::ZERO; 2];
        for (layer, share) in self.layers.iter().zip(self.evened(weights, |w| w)) {
            let own = layer.bounds();
            if share == 1.0 {
                return own;
            }
            min += share * own.min;
            max += share * own.max;
        }
        Bounds { min, max }
    }

    /// How much of each picture is seen: its weight by the curve of the mix, of what all
    /// have. Weights outside [0, 1] count as the nearer of these.
    fn shares(&self, weights: &[f64]) -> Vec<f64> {
        self.evened(weights, |weight| self.mix.share(weight))
    }

    fn evened(&self, weights: &[f64], curve: impl Fn(f64) -> f64) -> Vec<f64> {
        assert_eq!(
            weights.len(),
            self.layers.len(),
            "a weight for each picture"
        );
        let own: Vec<f64> = weights.iter().map(|w| curve(w.clamp(0.0, 1.0))).collect();
        let sum: f64 = own.iter().sum();
        if sum > 0.0 {
            own.into_iter().map(|share| share / sum).collect()
        } else {
            // By a curve that begins late nothing may be seen of many: then all alike.
            vec![1.0 / own.len() as f64; own.len()]
        }
    }

    /// What is seen with these weights where each picture is looked up at its own places:
    /// sRGB with straight alpha, transparent where nothing is.
    ///
    /// # Panics
    /// If there are not as many weights, or designs with places, as pictures.
    #[must_use]
    pub fn render(
        &self,
        places: &ManyPlaces,
        weights: &[f64],
        raster: &PictureRaster,
    ) -> RgbaImage {
        let [width, height] = raster.size;
        let to_lattice = |p: DVec2| raster.located(p) - 0.5;
        let mut lights = vec![LinearLight::ZERO; width as usize * height as usize];
        for ((k, layer), share) in self.layers.iter().enumerate().zip(self.shares(weights)) {
            if share == 0.0 {
                continue;
            }
            let placement = places.of(k);
            let sampler = layer.sampler(raster.pixel);
            let reach = raster.size.into_iter().max().unwrap_or_default() as usize;
            let share = share as f32;
            let filler = |facet: SourceFacet| {
                let sight = sampler.across(&facet.source, facet.first, reach);
                move |x: usize, y: usize, row: &mut [LinearLight]| {
                    sight.look([x, y], row, |_, light| share * light);
                }
            };
            // Apart from the others: what lies on an edge is given by both faces beside it.
            let mut own = vec![LinearLight::ZERO; lights.len()];
            scan(&placement, to_lattice, width as usize, &mut own, filler);
            let all = lights.par_iter_mut().zip(&own);
            all.for_each(|(sum, light)| *sum += *light);
        }
        let [columns, rows] = shown(self.window(weights), raster);
        let mut out = RgbaImage::new(width, height);
        let (pixels, _) = out.as_chunks_mut::<4>();
        let encoder = SrgbEncoder::new();
        let width = width as usize;
        let lines = pixels
            .par_chunks_mut(width.max(1))
            .zip(lights.par_chunks(width.max(1)));
        lines.zip(&rows).for_each(|((pixels, lights), row)| {
            for ((pixel, light), column) in pixels.iter_mut().zip(lights).zip(&columns) {
                *pixel = encoder.encoded(*light * (row * column)).0;
            }
        });
        out
    }
}
