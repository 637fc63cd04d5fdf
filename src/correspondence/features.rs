//! What makes two boundary points alike.
//!
//! Turning at three reaches and the thickness of the shape behind a point
//! compare the shape itself and do not see rotation. Where a *pose* (the rotation of one design onto the
//! other) is known, the direction of the tangent and the place about the
//! centre are compared too: they tell apart what bends alike, such as the
//! fingers of a hand.

use super::curve::BoundaryCurve;
use super::samples::CurveSamples;
use super::thickness::log_thickness;
use crate::geometry::DVec2;
use std::f64::consts::PI;

/// Reaches of the turning, in fractions of the length, and their weights. The
/// long reach weighs little: a tail that curls the other way is still a tail.
const REACHES: [(f64, f64); 3] = [(0.012, 0.5), (0.035, 0.5), (0.09, 0.2)];

/// The squared logarithm of a ratio of thicknesses that counts half: that of
/// a factor of two.
const HALF_THICKNESS: f64 = 0.5;

/// Half the stretch over which the tangent's direction is a mean.
const TANGENT_REACH: f64 = 0.01;

/// How much the direction of tangents and the place about the centre weigh.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseWeights {
    tangent: f64,
    position: f64,
}

impl PoseWeights {
    /// For a pose that was guessed.
    pub const FREE: Self = Self {
        tangent: 0.25,
        position: 0.125,
    };

    /// For a pose that the user asked for.
    pub const FIXED: Self = Self {
        tangent: 2.0,
        position: 1.0,
    };
}

/// Squared distance, in mean squared radii of the outlines, that counts half.
const HALF_DISTANCE: f64 = 1.0;

/// The features of each sample of a curve.
#[derive(Clone, Debug)]
pub(super) struct BoundaryFeatures {
    turning: Vec<[f64; REACHES.len()]>,
    log_thickness: Vec<f64>,
    tangent: Vec<DVec2>,
    /// About the centre, in root mean squared radii.
    position: Vec<DVec2>,
}

impl BoundaryFeatures {
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
            position: centred(places.iter().map(|&s| curve.point_at(s)).collect()),
        }
    }

    /// How strongly the outline bends about a sample, either way.
    pub fn salience(&self, sample: usize) -> f64 {
        self.turning[sample].iter().map(|turn| turn.abs()).sum()
    }

    pub fn position(&self, sample: usize) -> DVec2 {
        self.position[sample]
    }

    /// How unlike the samples are, blind to rotation: at least 0, at
    /// most 1.2 and the price of differing `thickness`.
    pub fn unlike(&self, other: &Self, thickness: f64) -> Vec<f64> {
        let mut pairs = Vec::with_capacity(self.turning.len() * other.turning.len());
        for (b, other_thickness) in other.turning.iter().zip(&other.log_thickness) {
            for (a, own_thickness) in self.turning.iter().zip(&self.log_thickness) {
                let mut sum = 0.0;
                for (k, (_, weight)) in REACHES.iter().enumerate() {
                    sum += weight * saturated((a[k] - b[k]).powi(2), 0.5);
                }
                let thicker = own_thickness - other_thickness;
                pairs.push(sum + thickness * saturated(thicker * thicker, HALF_THICKNESS));
            }
        }
        pairs
    }

    /// `blind` and how unlike tangents and positions are once this curve is
    /// turned by `pose`.
    pub fn unlike_posed(
        &self,
        other: &Self,
        blind: &[f64],
        pose: f64,
        weights: PoseWeights,
    ) -> Vec<f64> {
        let turn = DVec2::from_angle(pose);
        let tangents: Vec<DVec2> = self.tangent.iter().map(|&t| turn.rotate(t)).collect();
        let positions: Vec<DVec2> = self.position.iter().map(|&p| turn.rotate(p)).collect();
        let mut unlike = Vec::with_capacity(blind.len());
        let rows = blind.chunks_exact(tangents.len());
        for ((row, tangent), place) in rows.zip(&other.tangent).zip(&other.position) {
            let mine = row.iter().zip(&tangents).zip(&positions);
            unlike.extend(mine.map(|((blind, own), position)| {
                let turned = 0.5 * (1.0 - own.dot(*tangent));
                let distance = position.distance_squared(*place);
                blind
                    + weights.tangent * turned
                    + weights.position * saturated(distance, HALF_DISTANCE)
            }));
        }
        unlike
    }
}

/// x / (x + half): a gross difference counts, but no more than others.
fn saturated(x: f64, half: f64) -> f64 {
    x / (x + half)
}

/// About the mean and in units of the root mean squared distance from it.
fn centred(mut points: Vec<DVec2>) -> Vec<DVec2> {
    // Scaled first: squares of very large or small coordinates are not finite.
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
