//! Local features by which boundary samples are compared.
//!
//! Two features do not depend on rotation: the turning of the tangent over sections of three
//! lengths, and the thickness of the shape at the point. If a *pose* (the rotation of one design
//! onto the other) is given, the tangent's direction and the position relative to the centre are
//! compared as well. These two distinguish places that bend alike, such as the fingers of a hand.

use super::curve::BoundaryCurve;
use super::samples::CurveSamples;
use super::thickness::log_thickness;
use crate::geometry::DVec2;
use std::f64::consts::PI;

/// Half-lengths of the sections over which turning is measured, as fractions of the curve's length,
/// each with its weight. The longest section has the smallest weight, so that a tail still matches
/// a tail that curls the other way (heuristic).
const REACHES: [(f64, f64); 3] = [(0.012, 0.5), (0.035, 0.5), (0.09, 0.2)];

/// The dissimilarity of two thicknesses is x / (x + `HALF_THICKNESS`), where x is the squared
/// logarithm of their ratio; it is one half for a ratio of about two (heuristic).
const HALF_THICKNESS: f64 = 0.5;

/// Half-length of the section of a curve over which the tangent's direction is averaged, as a
/// fraction of the curve's length (heuristic).
const TANGENT_REACH: f64 = 0.01;

/// Weights of the two features that depend on the pose: the tangent's direction and the position.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseWeights {
    tangent: f64,
    position: f64,
}

impl PoseWeights {
    /// Weights for a pose that the search estimates (heuristic).
    pub const FREE: Self = Self {
        tangent: 0.25,
        position: 0.125,
    };

    /// Weights for rotation 0, which the user requested with `keep_up` (heuristic).
    pub const FIXED: Self = Self {
        tangent: 2.0,
        position: 1.0,
    };
}

/// The dissimilarity of two positions is d² / (d² + `HALF_DISTANCE`), where d is their distance in
/// units of the outline's root mean squared radius; it is one half for a distance of one such
/// radius.
const HALF_DISTANCE: f64 = 1.0;

/// Features of each sample of a curve: turning, thickness, direction and position.
#[derive(Clone, Debug)]
pub(super) struct BoundaryFeatures {
    /// For each sample: turning (change of direction) over the sections with the half-lengths in
    /// [`REACHES`], in units of π.
    turning: Vec<[f64; REACHES.len()]>,
    /// For each sample: logarithm of the thickness, minus its mean along the curve.
    log_thickness: Vec<f64>,
    /// For each sample: unit vector in the mean direction of the boundary near the sample.
    tangent: Vec<DVec2>,
    /// For each sample: position relative to the mean of all samples, in units of the samples' root
    /// mean squared distance from this mean.
    position: Vec<DVec2>,
}

impl BoundaryFeatures {
    /// Computes the features of all samples of a curve.
    pub fn of(curve: &BoundaryCurve, samples: &CurveSamples) -> Self {
        let places = &samples.places;
        let direction = |s: f64| curve.direction(s - TANGENT_REACH, s + TANGENT_REACH);
        let posed: Vec<(f64, f64)> = places.iter().map(|&s| (s, direction(s))).collect();
        Self {
            log_thickness: log_thickness(curve, &posed),
            turning: (places.iter())
                .map(|&s| REACHES.map(|(reach, _)| curve.turning(s, reach) / PI))
                .collect(),
            tangent: (posed.iter())
                .map(|&(_, direction)| DVec2::from_angle(direction))
                .collect(),
            position: normalise_points(places.iter().map(|&s| curve.point_at(s)).collect()),
        }
    }

    /// Returns how strongly the outline bends at a sample, to either side: the sum of the absolute
    /// turnings over the sections with the half-lengths in [`REACHES`], in units of π.
    pub fn salience(&self, sample: usize) -> f64 {
        self.turning[sample].iter().map(|turn| turn.abs()).sum()
    }

    /// Returns a sample's position relative to the mean of all samples, in units of the samples'
    /// root mean squared distance from this mean.
    pub fn position(&self, sample: usize) -> DVec2 {
        self.position[sample]
    }

    /// Returns the rotation-invariant dissimilarity of each pair of samples, one row for each
    /// sample of `other`. `thickness` is the weight of the thickness feature; each value lies
    /// between 0 and 1.2 + `thickness`.
    pub fn dissimilarities(&self, other: &Self, thickness: f64) -> Vec<f64> {
        let mut dissimilarities = Vec::with_capacity(self.turning.len() * other.turning.len());
        for (other_turning, other_thickness) in other.turning.iter().zip(&other.log_thickness) {
            for (own_turning, own_thickness) in self.turning.iter().zip(&self.log_thickness) {
                let mut sum = 0.0;
                for (k, (_, weight)) in REACHES.iter().enumerate() {
                    sum += weight * saturate((own_turning[k] - other_turning[k]).powi(2), 0.5);
                }
                let log_ratio = own_thickness - other_thickness;
                let thickness_term = saturate(log_ratio * log_ratio, HALF_THICKNESS);
                dissimilarities.push(sum + thickness * thickness_term);
            }
        }
        dissimilarities
    }

    /// Returns the dissimilarities of all pairs of samples, including tangent and position, with
    /// this curve rotated by `pose` (radians). `invariant` holds the rotation-invariant
    /// dissimilarities in the same order.
    pub fn posed_dissimilarities(
        &self,
        other: &Self,
        invariant: &[f64],
        pose: f64,
        weights: PoseWeights,
    ) -> Vec<f64> {
        let rotation = DVec2::from_angle(pose);
        let tangents: Vec<DVec2> = self.tangent.iter().map(|&t| rotation.rotate(t)).collect();
        let positions: Vec<DVec2> = self.position.iter().map(|&p| rotation.rotate(p)).collect();
        let mut dissimilarities = Vec::with_capacity(invariant.len());
        let rows = invariant.chunks_exact(tangents.len());
        for ((row, tangent), other_position) in rows.zip(&other.tangent).zip(&other.position) {
            let own_samples = row.iter().zip(&tangents).zip(&positions);
            dissimilarities.extend(own_samples.map(|((invariant, own), position)| {
                let tangent_difference = 0.5 * (1.0 - own.dot(*tangent));
                let distance = position.distance_squared(*other_position);
                invariant
                    + weights.tangent * tangent_difference
                    + weights.position * saturate(distance, HALF_DISTANCE)
            }));
        }
        dissimilarities
    }
}

/// Returns x / (x + half), which limits the influence of a single large difference.
fn saturate(x: f64, half: f64) -> f64 {
    x / (x + half)
}

/// Translates the points so that their mean is the origin, and scales them so that their root mean
/// squared distance from the origin is 1.
fn normalise_points(mut points: Vec<DVec2>) -> Vec<DVec2> {
    // Scale first: squares of very large or small coordinates overflow or underflow.
    let scale = points
        .iter()
        .fold(0.0, |s: f64, p| s.max(p.abs().max_element()));
    if scale > 0.0 {
        points.iter_mut().for_each(|p| *p /= scale);
    }
    let count = points.len() as f64;
    let mean = points.iter().sum::<DVec2>() / count;
    points.iter_mut().for_each(|p| *p -= mean);
    let square = points.iter().map(|p| p.length_squared()).sum::<f64>() / count;
    if square > 0.0 {
        let radius = square.sqrt();
        points.iter_mut().for_each(|p| *p /= radius);
    }
    points
}
