//! Pictures of many designs: from a specification to what is seen of them, and a blend of
//! them as a picture of its own.

use super::design_distance::DesignDistances;
use super::error::SpaceError;
use crate::content::{ContentKind, PictureRaster, PictureSet};
use crate::correspondence::{LinePair, MatchSettings, PointPair};
use crate::design::{Design, Picture};
use crate::geometry::{Bounds, DVec2, Similarity};
use crate::transition::{
    BuildError, Transition, TransitionMethod, TransitionOptions, TransitionSpec,
};
use crate::warp::{LineInterpolation, ManyFeatures, ManyWarp, PlaneBlend, PlaneGrid, WarpKind};
use crate::work::budget::WorkloadKind;
use crate::work::progress::{Progress, checkpoint};
use image::RgbaImage;
use std::sync::Arc;

/// Squares along the longer side of the frame, in which a warp is taken as linear: half of
/// what a film has, as each of many designs is looked up in each frame.
const GRID: u32 = 80;

/// Pixels along each side of the pictures that are compared.
const COMPARED_PX: u32 = 32;

/// The most pixels of a blend that becomes a design: those of a large screen.
const MOST_PX: f64 = 4e6;

/// Pictures and what takes them along.
#[derive(Debug)]
pub(super) struct PictureSpace {
    pub set: PictureSet,
    pub blend: PlaneBlend,
    /// From stop to stop they go as these have it.
    kind: WarpKind,
    features: ManyFeatures,
    options: TransitionOptions,
}

impl PictureSpace {
    /// Those of designs, led as it is said by what all of them have.
    pub fn of(
        designs: &[Arc<Design>],
        (kind, features): (WarpKind, &ManyFeatures),
        options: &TransitionOptions,
        progress: &dyn Progress,
    ) -> Result<Self, SpaceError> {
        checkpoint(progress, "reading colours", 0.0)?;
        let picture = |design: &Arc<Design>| {
            let missing = || BuildError::Unavailable(format!("{} has no colours", design.name));
            design.picture.clone().ok_or_else(missing)
        };
        let pictures: Vec<Picture> = designs.iter().map(picture).collect::<Result<_, _>>()?;
        let pixels = |p: &Picture| p.pixels().width() as usize * p.pixels().height() as usize;
        WorkloadKind::Pixels
            .allow(pictures.iter().map(pixels).sum(), progress)
            .map_err(BuildError::from)?;
        let borrowed: Vec<&Picture> = pictures.iter().collect();
        let set = PictureSet::new(&borrowed, options.colours).map_err(BuildError::from)?;
        let set = set.unwrap_or_else(|| unreachable!("there are designs"));
        let bounds = bounds(&set);
        // The mesh reaches beyond what is shown, so that its edge is never seen.
        let frame = bounds.padded(0.02 * bounds.diameter());
        let (features, warp) = match kind {
            WarpKind::Lines => (features.clone(), ManyWarp::Lines(options.lines)),
            WarpKind::Scattered => (features.clone(), ManyWarp::Scattered(options.scattered)),
            WarpKind::Lattice => (features.clone(), ManyWarp::Lattice(options.lattice)),
            // Nothing is led anywhere.
            _ => (
                ManyFeatures::default(),
                ManyWarp::Scattered(options.scattered),
            ),
        };
        let grid = match features.is_empty() {
            true => PlaneGrid::covering(&frame, 1),
            false => PlaneGrid::covering(&frame, GRID),
        };
        let count = designs.len();
        let blend = PlaneBlend::new(count, features.clone(), warp, (frame, grid));
        Ok(Self {
            set,
            blend: blend.map_err(BuildError::Unavailable)?,
            kind,
            features,
            options: options.clone(),
        })
    }

    /// The box around all pictures.
    pub fn bounds(&self) -> Bounds {
        bounds(&self.set)
    }

    /// How unlike they are: the root mean square difference of their colours, seen small and
    /// where they lie.
    pub fn likeness(&self) -> DesignDistances {
        let count = self.set.layers().len();
        let bounds = self.bounds();
        let pixel = bounds.size().max_element() / f64::from(COMPARED_PX);
        let raster = PictureRaster {
            size: [COMPARED_PX; 2],
            corner: DVec2::new(bounds.min.x, bounds.max.y),
            pixel,
        };
        let seen: Vec<Vec<u8>> = (0..count)
            .map(|k| {
                let mut weights = vec![0.0; count];
                weights[k] = 1.0;
                self.render(&weights, &raster).into_raw()
            })
            .collect();
        DesignDistances::of(count, |a, b| {
            let off = seen[a].iter().zip(&seen[b]);
            let sum: f64 = off.map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
            (sum / seen[a].len() as f64).sqrt() / 255.0
        })
    }

    /// A blend as pixels.
    pub fn render(&self, weights: &[f64], raster: &PictureRaster) -> RgbaImage {
        self.set
            .render(&self.blend.places(weights), weights, raster)
    }

    /// A blend as a picture of its own, as fine as the finest.
    pub fn picture(&self, weights: &[f64]) -> Picture {
        let window = self.set.window(weights);
        let finest = self
            .set
            .layers()
            .iter()
            .map(|layer| layer.picture().place().scale);
        let size = window.size();
        let coarsest = (size.x * size.y / MOST_PX).sqrt();
        let pixel = finest.fold(f64::INFINITY, f64::min).max(coarsest);
        let [width, height] = (size / pixel).ceil().to_array();
        let raster = PictureRaster {
            size: [width, height].map(|side| (side as u32).max(1)),
            corner: DVec2::new(window.min.x, window.max.y),
            pixel,
        };
        let place = Similarity {
            offset: DVec2::new(window.min.x, window.max.y - height.max(1.0) * pixel),
            scale: pixel,
            ..Similarity::IDENTITY
        };
        Picture::new(self.render(weights, &raster)).transformed(&place)
    }

    /// The film from one blend to another: of two pictures, straight.
    pub fn film(
        &self,
        ends: [Arc<Design>; 2],
        weights: [&[f64]; 2],
        progress: &dyn Progress,
    ) -> Result<Transition, SpaceError> {
        let between = match self.kind {
            WarpKind::Lines => self.options.lines.between,
            _ => LineInterpolation::Ends,
        };
        let [(points, lines), (points_there, lines_there)] =
            weights.map(|weights| self.features.blended(weights, between));
        let pins = points.into_iter().zip(points_there);
        let pins = pins.map(|(source, target)| PointPair { source, target });
        let lines = lines.into_iter().zip(lines_there);
        let lines = lines.map(|(source, target)| LinePair { source, target });
        let [source, target] = ends;
        let mut spec = TransitionSpec::new(source, target);
        let is_led = !self.features.is_empty();
        let kind = if is_led { self.kind } else { WarpKind::None };
        spec.cell = TransitionMethod::new(kind, ContentKind::Colours).map_err(BuildError::from)?;
        spec.options = TransitionOptions {
            matching: MatchSettings {
                pins: pins.collect(),
                lines: lines.collect(),
                ..self.options.matching.without_places()
            },
            ..self.options.clone()
        };
        Ok(Transition::build(&spec, progress)?)
    }
}

/// The box around all pictures.
fn bounds(set: &PictureSet) -> Bounds {
    let boxes = set.layers().iter().map(|layer| layer.bounds());
    let all = boxes.reduce(|a, b| a.union(&b));
    all.unwrap_or_else(|| unreachable!("a set has a picture"))
}

/// A blend of pictures as a design: with the rectangle as its form.
pub(super) fn design(name: String, picture: Picture) -> Option<Design> {
    let corners = picture.bounds().corners();
    let mut design = Design::of_rings(name, [corners]).ok()?;
    design.picture = Some(picture);
    Some(design)
}
