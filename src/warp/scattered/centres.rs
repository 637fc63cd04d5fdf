//! Centres of the radial functions: preparation of the features for the linear system.
//!
//! Coincident centres are merged, slopes between close centres are limited, coordinates are
//! normalised, and the best-fit similarity is subtracted from the displacements.
//!
//! Slope limit: two features at distance d whose displacements differ by D require a slope of D / d
//! between them. Up to a limit K nothing is changed. Above it, the difference is multiplied by (K d
//! / D)², so that the slope returns to zero as the features meet. Without this, the slope would
//! grow without bound and tear the plane. In addition, the linear system penalises different
//! coefficients of such a pair, the more strongly the closer the two features are; otherwise the
//! mapping would jump at the moment they merge.

use super::kernel::{KernelCentres, RadialSum};
use crate::geometry::DVec2;

/// Distance below which features are merged, as a fraction of the frame's diameter (tolerance:
/// about a thousandth of a pixel).
const MERGE_DISTANCE: f64 = 1e-6;

/// Maximum slope K of the displacement between two features (heuristic).
///
/// The slope between two features is the difference of their displacements divided by their
/// distance. With 20, two features that are 0.01 frame diameters apart are interpolated exactly if
/// their displacements differ by at most 0.2 frame diameters.
pub(super) const MAX_SLOPE: f64 = 20.0;

/// Two centres whose displacements would exceed the slope limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ClosePair {
    /// Indices of the two centres, in increasing order.
    pub(super) pair: [usize; 2],
    /// Factor below 1 by which the difference between the two displacements is multiplied: the
    /// square of (maximum slope / required slope), in the design in which this square is smaller.
    pub(super) shrink_factor: f64,
    /// Weight μ of the term that pulls the coefficients of the two centres together; 0 until the
    /// linear system is assembled.
    pub(super) coupling: f64,
}

/// Centres and displacements at one t, with reusable memory.
#[derive(Debug, Default)]
pub(super) struct CentreData {
    /// Positions of the centres; in plane coordinates until [`Self::normalise`] converts them.
    pub(super) positions: Vec<DVec2>,
    /// Displacements of each centre to the source and to the target.
    pub(super) values: Vec<[DVec2; 2]>,
    /// Pairs of centres whose displacements exceed the slope limit, in lexicographic order.
    pub(super) close_pairs: Vec<ClosePair>,
    /// Displacements of each centre to the source and to the target before slopes are limited.
    previous_values: Vec<[DVec2; 2]>,
    /// Number of features merged into each centre.
    counts: Vec<f64>,
}

impl CentreData {
    /// Loads features and merges each into the first centre within the merge distance.
    ///
    /// `unit` is the frame's diameter. A merged centre has the mean position and displacement.
    pub(super) fn merge(
        &mut self,
        features: impl Iterator<Item = (DVec2, [DVec2; 2])> + Clone,
        unit: f64,
    ) {
        self.positions.clear();
        self.values.clear();
        self.counts.clear();
        let first = features.clone().next().map_or(DVec2::ZERO, |(p, _)| p);
        let distances = features.clone().map(|(p, _)| p.distance_squared(first));
        let extent = distances.fold(0.0, f64::max).sqrt();
        // Coordinates far outside the frame are less precise, so the merge distance grows with the
        // extent of the features.
        let near = MERGE_DISTANCE * unit.max(1e-3 * extent);
        for (place, value) in features {
            let mut centres = self.positions.iter();
            match centres.position(|p| p.distance_squared(place) <= near * near) {
                Some(at) => {
                    self.counts[at] += 1.0;
                    for (sum, value) in self.values[at].iter_mut().zip(value) {
                        *sum += value;
                    }
                    // Running mean of the merged positions.
                    let mean = self.positions[at];
                    self.positions[at] = mean + (place - mean) / self.counts[at];
                }
                None => {
                    self.positions.push(place);
                    self.values.push(value);
                    self.counts.push(1.0);
                }
            }
        }
        for (value, &count) in self.values.iter_mut().zip(&self.counts) {
            value.iter_mut().for_each(|v| *v /= count);
        }
    }

    /// For each pair of centres whose displacements require a slope above [`MAX_SLOPE`], shrinks
    /// the difference between the displacements and records the pair.
    pub(super) fn limit_slopes(&mut self) {
        let Self {
            positions: at,
            previous_values: memory,
            ..
        } = self;
        self.close_pairs.clear();
        memory.clear();
        // Uses the original displacements, so that the result does not depend on the order of the
        // centres.
        memory.extend_from_slice(&self.values);
        for (i, value) in self.values.iter_mut().enumerate() {
            let (mut sums, mut weights) = (memory[i], [1.0; 2]);
            for (j, &other) in at.iter().enumerate() {
                let allowed = MAX_SLOPE * MAX_SLOPE * at[i].distance_squared(other);
                let mut min_factor = 1.0_f64;
                for k in 0..2 {
                    let difference = memory[i][k].distance_squared(memory[j][k]);
                    // Strict comparison: equal displacements never need shrinking.
                    if allowed < difference {
                        let shrunk = allowed / difference;
                        // If each value is averaged with the other at weight w, their difference is
                        // multiplied by (1 − w) / (1 + w).
                        let weight = (1.0 - shrunk) / (1.0 + shrunk);
                        sums[k] += weight * memory[j][k];
                        weights[k] += weight;
                        min_factor = min_factor.min(shrunk);
                    }
                }
                if min_factor < 1.0 && i < j {
                    self.close_pairs.push(ClosePair {
                        pair: [i, j],
                        shrink_factor: min_factor,
                        coupling: 0.0,
                    });
                }
            }
            for ((value, sum), weight) in value.iter_mut().zip(sums).zip(weights) {
                *value = sum / weight;
            }
        }
    }

    /// Normalises the centres and computes the squared radius rᵢ² of each: its squared distance to
    /// the nearest other centre.
    ///
    /// The origin is the mean of the centres, and the scale is their largest distance from the
    /// origin, or `unit` if all centres coincide.
    pub(super) fn normalise(&mut self, unit: f64, sum: &mut RadialSum) {
        let n = self.positions.len();
        sum.origin = self.positions.iter().sum::<DVec2>() / n.max(1) as f64;
        let distances = self
            .positions
            .iter()
            .map(|p| p.distance_squared(sum.origin));
        let radius = distances.fold(0.0, f64::max).sqrt();
        sum.scale = if radius > 0.0 { radius } else { unit };
        let KernelCentres { x, y, own } = &mut sum.centres;
        x.clear();
        y.clear();
        own.clear();
        for place in &mut self.positions {
            *place = (*place - sum.origin) / sum.scale;
            x.push(place.x);
            y.push(place.y);
        }
        own.resize(n, f64::INFINITY);
        // The recorded pairs have the same order as these loops.
        let mut too_near = self.close_pairs.iter().peekable();
        for i in 0..n {
            for j in i + 1..n {
                let mut squared = self.positions[i].distance_squared(self.positions[j]);
                if let Some(near) = too_near.next_if(|near| near.pair == [i, j]) {
                    // A neighbour that is about to merge with this centre gradually stops counting.
                    squared /= near.shrink_factor * near.shrink_factor;
                }
                own[i] = own[i].min(squared);
                own[j] = own[j].min(squared);
            }
        }
        // Normalised distances are at most 2. A single centre, which has no neighbour, gets this
        // bound.
        own.iter_mut().for_each(|own| *own = own.min(4.0));
    }

    /// Subtracts the best-fit similarity from the displacements and returns the similarity.
    ///
    /// For each design, the result holds the constant term, the coefficient of x and the
    /// coefficient of y, each as a vector [x, y].
    pub(super) fn remove_similarity(&mut self) -> [[[f64; 2]; 3]; 2] {
        let n = self.positions.len().max(1) as f64;
        let spread: f64 = self.positions.iter().map(|p| p.length_squared()).sum();
        std::array::from_fn(|k| {
            let mean = self.values.iter().map(|v| v[k]).sum::<DVec2>() / n;
            // The best fit is v ≈ mean + z · Σ z̄ v / Σ z̄ z, with vectors as complex numbers.
            let turns = self.positions.iter().zip(&self.values).map(|(&z, v)| {
                let v = v[k] - mean;
                DVec2::new(z.dot(v), z.perp_dot(v))
            });
            let turn = turns.sum::<DVec2>();
            let turn = if spread > 0.0 { turn / spread } else { turn };
            for (&z, v) in self.positions.iter().zip(&mut self.values) {
                v[k] -= mean + turn.rotate(z);
            }
            [mean, turn, turn.perp()].map(|column| column.to_array())
        })
    }
}
