//! Measures of one blend of many designs.

use super::distortion::{Distortion, distortion};
use crate::compatible::CompatibleMesh;
use crate::geometry::{DVec2, count_crossings, perimeter, signed_area};
use crate::space::{DesignSpace, SpaceFrame};
use serde::Serialize;

/// Defects and distortion of a blend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BlendReport {
    /// Number of faces that are folded or flat.
    pub folds: usize,
    /// Number of proper crossings among the outlines.
    pub crossings: usize,
    /// 95th percentile by area of the conformal distortion σ₁/σ₂, relative to the design for
    /// which it is smallest; `None` without a mesh.
    pub conformal_p95: Option<f64>,
    /// Difference between the area and the weighted mean of the designs' areas, as a fraction of
    /// that mean.
    pub area_off: f64,
}

/// All measures of one blend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BlendMeasures {
    /// Defects and distortion.
    #[serde(flatten)]
    pub quality: BlendReport,
    /// Filled area in squared design units; for bars, length times width.
    pub area: f64,
    /// Length of the outlines in design units; for bars, of both sides.
    pub perimeter: f64,
    /// Mean distance of the vertices from those of the nearest design, in design diameters; `None`
    /// without a mesh.
    pub travel: Option<f64>,
}

impl BlendReport {
    /// Combines two reports, taking the worse value of each measure.
    pub(super) fn worst_of(self, other: Self) -> Self {
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

/// Measures blends of a space; owns a frame, so that each thread needs its own sampler.
#[derive(Debug)]
pub struct BlendSampler {
    frame: SpaceFrame,
    /// Common mesh with each design as its reference; empty if the space has no mesh.
    meshes: Vec<CompatibleMesh>,
    /// Area of each design.
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
                // Bars of width 0 have no area, which would give NaN.
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

    /// Returns the distortion relative to each design.
    fn distortion(&self, places: &[DVec2]) -> Vec<Distortion> {
        let meshes = self.meshes.iter();
        meshes.filter_map(|mesh| distortion(mesh, places)).collect()
    }

    /// Returns the mean vertex distance from the nearest design.
    fn travel(&self, places: &[DVec2]) -> Option<f64> {
        let mean_distance = |mesh: &CompatibleMesh| {
            let gaps = mesh.source().iter().zip(places);
            let sum: f64 = gaps.map(|(p, q)| p.distance(*q)).sum();
            sum / (places.len() as f64 * self.diameter)
        };
        self.meshes.iter().map(mean_distance).min_by(f64::total_cmp)
    }
}

/// Measures of the drawn shape of a blend.
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
