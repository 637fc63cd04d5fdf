//! Descriptors of boundary samples by their inner distances to other samples.
//!
//! An inner distance is the length of a shortest path inside the shape. A sample's descriptor is a
//! row of logarithms of inner distances. Bending a limb preserves these distances. They are small
//! between the two sides of a stroke, which are far apart along the boundary (Ling, Jacobs 2007).
//!
//! Guaranteed: descriptors are finite, and invariant under translation, rotation and scaling.

use super::curve::BoundaryCurve;
use super::inner_distance::InnerDistances;
use super::samples::CurveSamples;

/// The dissimilarity of two inner distances is x / (x + `HALF_RATIO`), where x is the squared
/// logarithm of their ratio; it is one half for a ratio of 1.65 (heuristic).
const HALF_RATIO: f64 = 0.25;

/// Minimum inner distance, as a fraction of the median inner distance. Smaller distances are raised
/// to this minimum, because the boundary features suffice to compare close neighbours (heuristic).
const MIN_DISTANCE: f64 = 0.03;

/// Number of evenly spaced places along the boundary to which a sample's inner distances are
/// measured before any corresponding samples are known (heuristic).
pub(super) const AHEAD: u32 = 48;

/// Inner distances between all samples of a curve.
#[derive(Clone, Debug)]
pub(super) struct InnerDescriptors {
    count: usize,
    /// One row for each sample: logarithms of its inner distances to all samples, in units of the
    /// median inner distance.
    logs: Vec<f64>,
}

impl InnerDescriptors {
    /// Computes the descriptors of a curve's samples. Returns `None` if the curve is not a simple
    /// counter-clockwise polygon.
    pub fn of(curve: &BoundaryCurve, samples: &CurveSamples) -> Option<Self> {
        let distances = InnerDistances::of(curve, &samples.places)?;
        let mut sorted = distances.lengths.clone();
        sorted.sort_by(f64::total_cmp);
        let median = sorted[sorted.len() / 2];
        let log = |length: &f64| (length / median).max(MIN_DISTANCE).ln();
        (median > 0.0).then(|| Self {
            count: distances.count,
            logs: distances.lengths.iter().map(log).collect(),
        })
    }

    /// Returns the row of a sample: the logarithms of its inner distances to all samples.
    fn row(&self, sample: usize) -> &[f64] {
        &self.logs[sample * self.count..][..self.count]
    }

    /// Returns one row for each sample: the logarithms of its inner distances to the samples
    /// `others`.
    pub fn distances_to(&self, others: impl Iterator<Item = usize> + Clone) -> Vec<f64> {
        let row = |sample| {
            let row = self.row(sample);
            others.clone().map(move |other| row[other])
        };
        (0..self.count).flat_map(row).collect()
    }

    /// Returns one row for each sample: the logarithms of its inner distances to [`AHEAD`] evenly
    /// spaced places that follow it along the boundary, interpolated between samples.
    pub fn distances_ahead(&self, samples: &CurveSamples) -> Vec<f64> {
        let mut rows = Vec::with_capacity(self.count * AHEAD as usize);
        for sample in 0..self.count {
            let row = self.row(sample);
            let mut next = sample;
            for k in 1..=AHEAD {
                let place = samples.unwrapped_place(sample) + f64::from(k) / f64::from(AHEAD + 1);
                while samples.unwrapped_place(next + 1) <= place {
                    next += 1;
                }
                let [from, to] = [next, next + 1].map(|k| samples.unwrapped_place(k));
                let fraction = (place - from) / (to - from);
                let [near, far] = [next, next + 1].map(|k| row[k % self.count]);
                rows.push((1.0 - fraction) * near + fraction * far);
            }
        }
        rows
    }
}

/// Returns the dissimilarities, in [0, 1], between all source samples and all target samples: one
/// row for each target sample, with one entry for each source sample.
///
/// `source` and `target` hold one row for each sample. Every sample has reference points on its own
/// curve, and column k of its row is the logarithm of the inner distance to the k-th of them. If
/// two samples correspond, their k-th reference points are assumed to correspond too. `weights[k]`
/// is the weight of column k.
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
