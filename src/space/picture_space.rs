//! Blends of the pictures of many designs: warped by common features and mixed by weight.

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

/// Number of squares of the warp's grid along the longer side of the frame. The warp is linear in
/// each triangle of the grid (resource limit: half as many as for two designs, because each frame
/// warps all designs).
const GRID: u32 = 80;

/// Side length, in pixels, of the reduced pictures that are compared to find how dissimilar the
/// designs are (heuristic).
const COMPARED_PX: u32 = 32;

/// Maximum number of pixels of a blend that becomes a new design (resource limit: as many as a
/// large screen has).
const MAX_DESIGN_PX: f64 = 4e6;

/// Pictures of all designs and the warp that aligns their features.
#[derive(Debug)]
pub(super) struct PictureSpace {
    /// Pictures of the designs, and how their colours are mixed.
    pub set: PictureSet,
    /// Warp that aligns the features of all pictures, for any weights.
    pub blend: PlaneBlend,
    /// Kind of the warp. This and the next two fields specify the transitions along a path.
    warp_kind: WarpKind,
    features: ManyFeatures,
    options: TransitionOptions,
}

impl PictureSpace {
    /// Prepares the pictures of the designs, and a warp of the given kind that aligns the features
    /// common to all of them.
    pub fn of(
        designs: &[Arc<Design>],
        warp_kind: WarpKind,
        features: &ManyFeatures,
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
            .check(pictures.iter().map(pixels).sum(), progress)
            .map_err(BuildError::from)?;
        let borrowed: Vec<&Picture> = pictures.iter().collect();
        let set = PictureSet::new(&borrowed, options.colours).map_err(BuildError::from)?;
        let set = set.unwrap_or_else(|| unreachable!("there are designs"));
        let bounds = bounds(&set);
        // The mesh extends beyond the visible area, so that its edge is never seen.
        let frame = bounds.padded(0.02 * bounds.diameter());
        let (features, warp) = match warp_kind {
            WarpKind::Lines => (features.clone(), ManyWarp::Lines(options.lines)),
            WarpKind::Scattered => (features.clone(), ManyWarp::Scattered(options.scattered)),
            WarpKind::Lattice => (features.clone(), ManyWarp::Lattice(options.lattice)),
            // The pictures stay in place.
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
            warp_kind,
            features,
            options: options.clone(),
        })
    }

    /// Returns the bounding box of all pictures.
    pub fn bounds(&self) -> Bounds {
        bounds(&self.set)
    }

    /// Returns the dissimilarity of the pictures: the root mean square difference of their colours,
    /// from 0 to 1, at low resolution and without aligning them.
    pub fn distances(&self) -> DesignDistances {
        let count = self.set.layers().len();
        let bounds = self.bounds();
        let pixel = bounds.size().max_element() / f64::from(COMPARED_PX);
        let raster = PictureRaster {
            size: [COMPARED_PX; 2],
            corner: DVec2::new(bounds.min.x, bounds.max.y),
            pixel_size: pixel,
        };
        let reduced: Vec<Vec<u8>> = (0..count)
            .map(|k| {
                let mut weights = vec![0.0; count];
                weights[k] = 1.0;
                self.render(&weights, &raster).into_raw()
            })
            .collect();
        DesignDistances::of(count, |a, b| {
            let pairs = reduced[a].iter().zip(&reduced[b]);
            let sum: f64 = pairs.map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
            (sum / reduced[a].len() as f64).sqrt() / 255.0
        })
    }

    /// Renders a blend, in sRGB with straight alpha.
    pub fn render(&self, weights: &[f64], raster: &PictureRaster) -> RgbaImage {
        self.set
            .render(&self.blend.places(weights), weights, raster)
    }

    /// Returns a blend as a new picture, in the resolution of the finest picture but with at most
    /// [`MAX_DESIGN_PX`] pixels.
    pub fn picture(&self, weights: &[f64]) -> Picture {
        let window = self.set.window(weights);
        let finest = self
            .set
            .layers()
            .iter()
            .map(|layer| layer.picture().place().scale);
        let size = window.size();
        let min_pixel = (size.x * size.y / MAX_DESIGN_PX).sqrt();
        let pixel = finest.fold(f64::INFINITY, f64::min).max(min_pixel);
        let [width, height] = (size / pixel).ceil().to_array();
        let raster = PictureRaster {
            size: [width, height].map(|side| (side as u32).max(1)),
            corner: DVec2::new(window.min.x, window.max.y),
            pixel_size: pixel,
        };
        let place = Similarity {
            offset: DVec2::new(window.min.x, window.max.y - height.max(1.0) * pixel),
            scale: pixel,
            ..Similarity::IDENTITY
        };
        Picture::new(self.render(weights, &raster)).transformed(&place)
    }

    /// Builds the transition between two blends with the given weights. `ends` holds the same two
    /// blends as designs with pictures.
    pub fn transition_between(
        &self,
        ends: [Arc<Design>; 2],
        weights: [&[f64]; 2],
        progress: &dyn Progress,
    ) -> Result<Transition, SpaceError> {
        let between = match self.warp_kind {
            WarpKind::Lines => self.options.lines.between,
            _ => LineInterpolation::Ends,
        };
        let [(source_points, source_lines), (target_points, target_lines)] =
            weights.map(|weights| self.features.blended(weights, between));
        let pins = source_points.into_iter().zip(target_points);
        let pins = pins.map(|(source, target)| PointPair { source, target });
        let lines = source_lines.into_iter().zip(target_lines);
        let lines = lines.map(|(source, target)| LinePair { source, target });
        let [source, target] = ends;
        let mut spec = TransitionSpec::new(source, target);
        let has_features = !self.features.is_empty();
        let warp_kind = if has_features {
            self.warp_kind
        } else {
            WarpKind::None
        };
        spec.method =
            TransitionMethod::new(warp_kind, ContentKind::Colours).map_err(BuildError::from)?;
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

/// Returns the bounding box of all pictures of a set.
fn bounds(set: &PictureSet) -> Bounds {
    let boxes = set.layers().iter().map(|layer| layer.bounds());
    let all = boxes.reduce(|a, b| a.union(&b));
    all.unwrap_or_else(|| unreachable!("a set has a picture"))
}

/// Returns a design with this picture, and its rectangle as the outline.
pub(super) fn picture_design(name: String, picture: Picture) -> Option<Design> {
    let corners = picture.bounds().corners();
    let mut design = Design::from_rings(name, [corners]).ok()?;
    design.picture = Some(picture);
    Some(design)
}
