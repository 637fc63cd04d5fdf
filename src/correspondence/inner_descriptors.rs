//! How unlike boundary points are by what is seen of the inside.
//!
//! A sample's row is the logarithms of its inner distances to others. A limb
//! keeps them however it is bent, and the two sides of a stroke are near each
//! other by them (Ling, Jacobs 2007).
//!
//! Guaranteed: blind to position, rotation and size; finite.

use super::curve::BoundaryCurve;
use super::inner_distance::InnerDistances;
use super::samples::CurveSamples;

/// The squared logarithm of a ratio of inner distances that counts half:
/// that of 1.65. A stricter one, of 1.37, gave films as good.
const HALF_RATIO: f64 = 0.25;

/// Inner distances below this share of their median count as that: what
/// tells of neighbours is the boundary between them. No measure fixed it.
const LEAST: f64 = 0.03;

/// Places ahead in a row of inner distances, evenly along the boundary.
pub(super) const AHEAD: u32 = 48;

/// Inner distances between the samples of a curve.
#[derive(Clone, Debug)]
pub(super) struct InnerDescriptors {
    count: usize,
    /// Logarithms of the distances in medians, a row for each sample.
    logs: Vec<f64>,
}

impl InnerDescriptors {
    /// Those of a curve's samples; none if it is no simple polygon.
    pub fn of(curve: &BoundaryCurve, samples: &CurveSamples) -> Option<Self> {
        let found = InnerDistances::of(curve, &samples.places)?;
        let mut sorted = found.lengths.clone();
        sorted.sort_by(f64::total_cmp);
        let median = sorted[sorted.len() / 2];
        let log = |length: &f64| (length / median).max(LEAST).ln();
        (median > 0.0).then(|| Self {
            count: found.count,
            logs: found.lengths.iter().map(log).collect(),
        })
    }

    fn row(&self, sample: usize) -> &[f64] {
        &self.logs[sample * self.count..][..self.count]
    }

    /// For each sample its distances to these.
    pub fn to(&self, others: impl Iterator<Item = usize> + Clone) -> Vec<f64> {
        let row = |sample| {
            let row = self.row(sample);
            others.clone().map(move |other| row[other])
        };
        (0..self.count).flat_map(row).collect()
    }

    /// For each sample its distances to even places ahead.
    pub fn ahead(&self, samples: &CurveSamples) -> Vec<f64> {
        let mut rows = Vec::with_capacity(self.count * AHEAD as usize);
        for sample in 0..self.count {
            let row = self.row(sample);
            let mut next = sample;
            for k in 1..=AHEAD {
                let at = samples.unrolled(sample) + f64::from(k) / f64::from(AHEAD + 1);
                while samples.unrolled(next + 1) <= at {
                    next += 1;
                }
                let [from, to] = [next, next + 1].map(|k| samples.unrolled(k));
                let share = (at - from) / (to - from);
                let [near, far] = [next, next + 1].map(|k| row[k % self.count]);
                rows.push((1.0 - share) * near + share * far);
            }
        }
        rows
    }
}

/// How unlike each two rows of logarithms are, in [0, 1]: a row of the
/// target's after the other, each against all of the source's.
pub(super) fn inner_dissimilarities(source: &[f64], target: &[f64], weights: &[f64]) -> Vec<f64> {
    let total: f64 = weights.iter().sum();
    let mut pairs = Vec::with_capacity(source.len() / weights.len() * target.len() / weights.len());
    for other in target.chunks_exact(weights.len()) {
        for own in source.chunks_exact(weights.len()) {
            let mut sum = 0.0;
            for ((a, b), weight) in own.iter().zip(other).zip(weights) {
                let square = (a - b) * (a - b);
                sum += weight * square / (square + HALF_RATIO);
            }
            pairs.push(sum / total);
        }
    }
    pairs
}
