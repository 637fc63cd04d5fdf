//! Places and values made ready: those that coincide are one, those that come
//! near to each other give way, all are in coordinates of their own, and what
//! a similarity explains is taken off.
//!
//! Two features at distance d whose looks differ by D make the plane D / d
//! times as steep between them. Up to a limit K nothing is changed. Beyond it
//! their difference is shrunk by (K d / D)², so that the slope returns to zero
//! instead of growing without bound, which would tear the plane just before
//! they meet. What the two say of the slope between them also has to be heard
//! less and less, or it would be lost with a jump when they are one: that is
//! done by the system, for the pairs that are too near.

use super::kernel::{KernelCentres, RadialSum};
use crate::geometry::DVec2;

/// Places nearer than this share of the unit are one: a thousandth of a pixel.
const MERGED: f64 = 1e-6;

/// How many times steeper than the frame a look-up may be between two
/// features before they give way. At 20, two features a hundredth of the
/// frame apart may be a fifth of it apart in a design, and both are met.
pub(super) const STEEPEST: f64 = 20.0;

/// Two features that are too near for what they want.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ClosePair {
    pub(super) pair: [usize; 2],
    /// (K d / D)², below 1.
    pub(super) shrunk: f64,
    /// μ of the system; 0 until it is known.
    pub(super) tie: f64,
}

/// Places and values, and memory to make them ready in.
#[derive(Debug, Default)]
pub(super) struct CentreData {
    pub(super) at: Vec<DVec2>,
    pub(super) values: Vec<[DVec2; 2]>,
    pub(super) too_near: Vec<ClosePair>,
    memory: Vec<[DVec2; 2]>,
    /// How many are merged in each.
    counts: Vec<f64>,
}

impl CentreData {
    /// Each place joins the first one that is near enough; near is a share of
    /// the unit.
    pub(super) fn merge(
        &mut self,
        features: impl Iterator<Item = (DVec2, [DVec2; 2])> + Clone,
        unit: f64,
    ) {
        self.at.clear();
        self.values.clear();
        self.counts.clear();
        let first = features.clone().next().map_or(DVec2::ZERO, |(p, _)| p);
        let far = features.clone().map(|(p, _)| p.distance_squared(first));
        let extent = far.fold(0.0, f64::max).sqrt();
        let near = MERGED * unit.max(1e-3 * extent);
        for (place, value) in features {
            let mut known = self.at.iter();
            match known.position(|p| p.distance_squared(place) <= near * near) {
                Some(at) => {
                    self.counts[at] += 1.0;
                    for (sum, value) in self.values[at].iter_mut().zip(value) {
                        *sum += value;
                    }
                    let mean = self.at[at];
                    // The mean of all that joined so far.
                    self.at[at] = mean + (place - mean) / self.counts[at];
                }
                None => {
                    self.at.push(place);
                    self.values.push(value);
                    self.counts.push(1.0);
                }
            }
        }
        for (value, &count) in self.values.iter_mut().zip(&self.counts) {
            value.iter_mut().for_each(|v| *v /= count);
        }
    }

    /// Shrinks differences of values that are steeper than [`STEEPEST`], and
    /// notes whose.
    pub(super) fn ease(&mut self) {
        let Self { at, memory, .. } = self;
        self.too_near.clear();
        memory.clear();
        // From the values as they were, or the order of the features would count.
        memory.extend_from_slice(&self.values);
        for (i, value) in self.values.iter_mut().enumerate() {
            let (mut sums, mut weights) = (memory[i], [1.0; 2]);
            for (j, &other) in at.iter().enumerate() {
                let allowed = STEEPEST * STEEPEST * at[i].distance_squared(other);
                let mut least = 1.0_f64;
                for k in 0..2 {
                    let difference = memory[i][k].distance_squared(memory[j][k]);
                    // False for two places with the same look, whatever their distance.
                    if allowed < difference {
                        let shrunk = allowed / difference;
                        // With w at both, a difference shrinks by (1 − w) / (1 + w).
                        let weight = (1.0 - shrunk) / (1.0 + shrunk);
                        sums[k] += weight * memory[j][k];
                        weights[k] += weight;
                        least = least.min(shrunk);
                    }
                }
                if least < 1.0 && i < j {
                    self.too_near.push(ClosePair {
                        pair: [i, j],
                        shrunk: least,
                        tie: 0.0,
                    });
                }
            }
            for ((value, sum), weight) in value.iter_mut().zip(sums).zip(weights) {
                *value = sum / weight;
            }
        }
    }

    /// Origin and scale, the centres in these coordinates and their radii.
    pub(super) fn centre(&mut self, unit: f64, sum: &mut RadialSum) {
        let n = self.at.len();
        sum.origin = self.at.iter().sum::<DVec2>() / n.max(1) as f64;
        let far = self.at.iter().map(|p| p.distance_squared(sum.origin));
        let radius = far.fold(0.0, f64::max).sqrt();
        sum.scale = if radius > 0.0 { radius } else { unit };
        let KernelCentres { x, y, own } = &mut sum.centres;
        x.clear();
        y.clear();
        own.clear();
        for place in &mut self.at {
            *place = (*place - sum.origin) / sum.scale;
            x.push(place.x);
            y.push(place.y);
        }
        own.resize(n, f64::INFINITY);
        // Pairs that are too near are listed in the order of these loops.
        let mut too_near = self.too_near.iter().peekable();
        for i in 0..n {
            for j in i + 1..n {
                let mut apart = self.at[i].distance_squared(self.at[j]);
                if let Some(near) = too_near.next_if(|near| near.pair == [i, j]) {
                    // When they are one, there is no such neighbour.
                    apart /= near.shrunk * near.shrunk;
                }
                own[i] = own[i].min(apart);
                own[j] = own[j].min(apart);
            }
        }
        // A centre alone, or as good as alone with one that it meets, has no
        // neighbour: the extent of all will do.
        own.iter_mut().for_each(|own| *own = own.min(4.0));
    }

    /// Takes the similarity that fits the values best from them.
    pub(super) fn take_similarity(&mut self) -> [[[f64; 2]; 3]; 2] {
        let n = self.at.len().max(1) as f64;
        let spread: f64 = self.at.iter().map(|p| p.length_squared()).sum();
        std::array::from_fn(|k| {
            let mean = self.values.iter().map(|v| v[k]).sum::<DVec2>() / n;
            // Σ z̄ v / Σ z̄ z, as complex numbers.
            let turns = self.at.iter().zip(&self.values).map(|(&z, v)| {
                let v = v[k] - mean;
                DVec2::new(z.dot(v), z.perp_dot(v))
            });
            let turn = turns.sum::<DVec2>();
            let turn = if spread > 0.0 { turn / spread } else { turn };
            for (&z, v) in self.at.iter().zip(&mut self.values) {
                v[k] -= mean + turn.rotate(z);
            }
            [mean, turn, turn.perp()].map(|column| column.to_array())
        })
    }
}
