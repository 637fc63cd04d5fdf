//! Measures of one blend of several designs: folds, crossings, distortion, area, length and travel.

use super::distortion::{Distortion, distortion};
use crate::compatible::CompatibleMesh;
use crate::geometry::{DVec2, count_crossings, perimeter, signed_area};
use crate::space::{DesignSpace, SpaceFrame};
use serde::Serialize;

/// Defects and distortion of one blend of several designs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BlendReport {
    /// Number of faces that are folded or flat; 0 without a mesh.
    pub folds: usize,
    /// Number of pairs of outline edges that properly cross, within one outline or between two.
    pub crossings: usize,
    /// 95th percentile of the conformal distortion σ₁/σ₂ of the faces, weighted by area. It is
    /// computed relative to each design, and the smallest of these values is taken. `None` without
    /// a mesh.
    pub conformal_p95: Option<f64>,
    /// Absolute difference between the area of the blend and the weighted mean of the designs'
    /// areas, as a fraction of that mean.
    pub area_off: f64,
}

/// All measures of one blend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BlendMeasures {
    /// Defects and distortion of the blend.
    #[serde(flatten)]
    pub quality: BlendReport,
    /// Filled area of the blend in squared design units. A bar counts as its length times its
    /// width.
    pub area: f64,
    /// Length of the blend's outlines in design units. A bar counts as twice its length.
    pub perimeter: f64,
    /// Mean distance of the mesh vertices from their positions in a design, in design diameters.
    /// The design with the smallest mean distance counts. `None` without a mesh.
    pub travel: Option<f64>,
}

impl BlendReport {
    /// Combines two reports, taking the worse value of each measure.
    pub(super) fn worse_of_both(self, other: Self) -> Self {
        Self {
            folds: self.folds.max(other.folds),
            crossings: self.crossings.max(other.crossings),
            conformal_p95: match (self.conformal_p95, other.conformal_p95) {
                (Some(a), Some(b)) => Some(a.max(b)),
                (a, b) => a.or(b),
            },
            area_off: self.area_off.max(other.area_off),
        }
    }
}

/// Measures blends of a design space. A sampler holds one blend at a time, so each thread needs its
/// own sampler.
#[derive(Debug)]
pub struct BlendSampler {
    frame: SpaceFrame,
    /// For each design, the common mesh with that design as source and target; empty if the space
    /// has no mesh.
    meshes: Vec<CompatibleMesh>,
    /// Filled area of each design, in squared design units.
    areas: Vec<f64>,
    diameter: f64,
}

impl BlendSampler {
    /// Creates a sampler for a space.
    #[must_use]
    pub fn of(space: &DesignSpace) -> Self {
        let mut frame = space.frame();
        let count = space.designs().len();
        let areas = (0..count).map(|k| {
            let mut weights = vec![0.0; count];
            weights[k] = 1.0;
            frame.seek(&weights);
            BlendMoment::of(&frame).area
        });
        let areas = areas.collect();
        let meshes = space.family().into_iter();
        let meshes = meshes.flat_map(|family| (0..count).map(|k| family.pair(k, k)));
        Self {
            meshes: meshes.collect(),
            areas,
            frame,
            diameter: space.family().map_or(1.0, |family| family.diameter()),
        }
    }

    /// Measures the blend with the given weights, one per design.
    ///
    /// # Panics
    /// If there are not as many weights as designs.
    pub fn measure(&mut self, weights: &[f64]) -> BlendMeasures {
        self.frame.seek(weights);
        let shape = BlendMoment::of(&self.frame);
        let (distortions, travel) = match self.frame.places() {
            Some(places) => (self.distortion(places), self.travel(places)),
            None => (Vec::new(), None),
        };
        let p95 = distortions
            .iter()
            .map(|distortion| distortion.conformal.p95);
        let mean_area: f64 = self.areas.iter().zip(weights).map(|(a, w)| a * w).sum();
        let area_deviation = (shape.area - mean_area).abs() / mean_area;
        BlendMeasures {
            quality: BlendReport {
                folds: distortions.first().map_or(0, |distortion| distortion.folds),
                crossings: shape.crossings,
                conformal_p95: p95.min_by(f64::total_cmp),
                // Bars of width 0 have no area, so the quotient is NaN.
                area_off: if area_deviation.is_finite() {
                    area_deviation
                } else {
                    0.0
                },
            },
            area: shape.area,
            perimeter: shape.perimeter,
            travel,
        }
    }

    /// Returns the distortion of the mesh with vertices at `places`, once relative to each design.
    fn distortion(&self, places: &[DVec2]) -> Vec<Distortion> {
        let meshes = self.meshes.iter();
        meshes.filter_map(|mesh| distortion(mesh, places)).collect()
    }

    /// Returns the mean distance of the vertices from their positions in a design, in design
    /// diameters, for the design with the smallest mean distance.
    fn travel(&self, places: &[DVec2]) -> Option<f64> {
        let mean_distance = |mesh: &CompatibleMesh| {
            let gaps = mesh.source().iter().zip(places);
            let sum: f64 = gaps.map(|(p, q)| p.distance(*q)).sum();
            sum / (places.len() as f64 * self.diameter)
        };
        self.meshes.iter().map(mean_distance).min_by(f64::total_cmp)
    }
}

/// Area, perimeter and crossings of a blend's shape as it is drawn.
struct BlendMoment {
    area: f64,
    perimeter: f64,
    crossings: usize,
}

impl BlendMoment {
    fn of(frame: &SpaceFrame) -> Self {
        let figure = frame.figure();
        let bars: f64 = figure.bars.iter().map(|[a, b]| a.distance(*b)).sum();
        let rings = figure.rings.iter();
        Self {
            area: rings.clone().map(|ring| signed_area(ring)).sum::<f64>()
                + bars * figure.bar_width,
            perimeter: rings.map(|ring| perimeter(ring)).sum::<f64>() + 2.0 * bars,
            crossings: count_crossings(&figure.rings),
        }
    }
}
