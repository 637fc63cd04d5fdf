//! What is measured of one blend of many designs.

use super::distortion::{Distortion, distortion};
use crate::compatible::CompatibleMesh;
use crate::geometry::{DVec2, count_crossings, perimeter, signed_area};
use crate::space::{DesignSpace, SpaceFrame};
use serde::Serialize;

/// What is wrong with a blend, and how far it is from the designs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BlendReport {
    /// Faces that are turned over or flat.
    pub folds: usize,
    /// Proper crossings among the outlines.
    pub crossings: usize,
    /// σ₁/σ₂ that 95 % of the area keeps to, from the design that is nearest by that; none
    /// without a mesh.
    pub conformal_p95: Option<f64>,
    /// How far the area is from that of the designs, blended, as a share of it.
    pub area_off: f64,
}

/// A blend in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BlendMeasures {
    /// What is wrong with it.
    #[serde(flatten)]
    pub quality: BlendReport,
    /// What it fills, in square units of the designs; of bars their lengths times their width.
    pub area: f64,
    /// The length of its outlines; of bars of both their sides.
    pub perimeter: f64,
    /// How far its vertices are from those of the design that is nearest by that, on the mean,
    /// in diameters of the designs; none of fields.
    pub travel: Option<f64>,
}

impl BlendReport {
    pub(super) fn or_worse(self, other: Self) -> Self {
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

/// Measures blends of a space, with memory of its own.
#[derive(Debug)]
pub struct BlendSampler {
    frame: SpaceFrame,
    /// From each design, where there is a mesh with faces.
    meshes: Vec<CompatibleMesh>,
    /// Of each design.
    areas: Vec<f64>,
    diameter: f64,
}

impl BlendSampler {
    /// Of the blends of a space.
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

    /// The blend with these weights.
    ///
    /// # Panics
    /// If there are not as many weights as designs.
    pub fn at(&mut self, weights: &[f64]) -> BlendMeasures {
        self.frame.seek(weights);
        let seen = BlendMoment::of(&self.frame);
        let (found, travel) = match self.frame.places() {
            Some(places) => (self.distortion(places), self.travel(places)),
            None => (Vec::new(), None),
        };
        let p95 = found.iter().map(|found| found.conformal.p95);
        let wanted: f64 = self.areas.iter().zip(weights).map(|(a, w)| a * w).sum();
        let off = (seen.area - wanted).abs() / wanted;
        BlendMeasures {
            quality: BlendReport {
                folds: found.first().map_or(0, |found| found.folds),
                crossings: seen.crossings,
                conformal_p95: p95.min_by(f64::total_cmp),
                // Of bars that have none there is none.
                area_off: if off.is_finite() { off } else { 0.0 },
            },
            area: seen.area,
            perimeter: seen.perimeter,
            travel,
        }
    }

    fn distortion(&self, places: &[DVec2]) -> Vec<Distortion> {
        let each = self.meshes.iter();
        each.filter_map(|mesh| distortion(mesh, places)).collect()
    }

    fn travel(&self, places: &[DVec2]) -> Option<f64> {
        let far = |mesh: &CompatibleMesh| {
            let gaps = mesh.source().iter().zip(places);
            let sum: f64 = gaps.map(|(p, q)| p.distance(*q)).sum();
            sum / (places.len() as f64 * self.diameter)
        };
        self.meshes.iter().map(far).min_by(f64::total_cmp)
    }
}

/// What is seen of a blend, in numbers.
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
