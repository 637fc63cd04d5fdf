//! Positions of the connected parts in a blend of many designs. The energy leaves them
//! undetermined.
//!
//! As for two designs, the parts move around the centroid of the whole design as it rotates.

use crate::compatible::{BarElement, CompatibleFamily};
use crate::geometry::{DMat2, DVec2, twice_signed_area};

/// The connected parts and their positions within the whole design.
#[derive(Debug)]
pub(super) struct BlendParts {
    /// For each vertex, the index of its part.
    pub of_vertex: Vec<u32>,
    /// For each vertex, its mass as a fraction of the mass of its part.
    shares: Vec<f64>,
    /// For each design, its rotation relative to a common orientation, in radians.
    angles: Vec<f64>,
    /// For each part, one entry per design: the offset of the part's centroid from the centroid of
    /// the whole design, rotated back to the common orientation.
    turned: Vec<DVec2>,
}

/// Returns the sum of `places`, each multiplied by its weight.
pub(super) fn blended(weights: &[f64], places: &[DVec2]) -> DVec2 {
    weights.iter().zip(places).map(|(&w, &p)| p * w).sum()
}

/// Returns the masses of the vertices: the mean over the designs of the areas around each vertex
/// (bars count as half their squared length), where each design has the total mass 1.
fn masses(family: &CompatibleFamily) -> Vec<f64> {
    let mut masses = vec![0.0; family.embeddings()[0].len()];
    for places in family.embeddings() {
        let area = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| places[v as usize]);
            0.5 * twice_signed_area(a, b, c)
        };
        let square =
            |&[a, b]: &BarElement| 0.5 * places[a as usize].distance_squared(places[b as usize]);
        let faces = family.faces().iter();
        let total = faces.clone().map(area).sum::<f64>()
            + family.elements().iter().map(square).sum::<f64>();
        let share = 1.0 / (total * family.count() as f64);
        for face in faces {
            let mass = area(face) * share / 3.0;
            face.iter().for_each(|&v| masses[v as usize] += mass);
        }
        for bar in family.elements() {
            let mass = square(bar) * share / 2.0;
            bar.iter().for_each(|&v| masses[v as usize] += mass);
        }
    }
    masses
}

impl BlendParts {
    pub fn of(family: &CompatibleFamily) -> Self {
        let masses = &masses(family)[..];
        let of_vertex = family.pair(0, 0).components();
        let count = of_vertex.iter().max().map_or(0, |&last| last as usize + 1);
        let mut mass = vec![0.0; count];
        for (&part, &m) in of_vertex.iter().zip(masses) {
            mass[part as usize] += m;
        }
        let shares = of_vertex.iter().zip(masses);
        let shares: Vec<f64> = shares.map(|(&part, &m)| m / mass[part as usize]).collect();
        let designs = family.count();
        let angles = common_angles(family, masses);
        let mut turned = vec![DVec2::ZERO; count * designs];
        // A single part has no offset.
        if count > 1 {
            for (design, places) in family.embeddings().iter().enumerate() {
                let mut centres = vec![DVec2::ZERO; count];
                for ((&part, &share), &p) in of_vertex.iter().zip(&shares).zip(places) {
                    centres[part as usize] += p * share;
                }
                let total: f64 = mass.iter().sum();
                let whole: DVec2 = centres
                    .iter()
                    .zip(&mass)
                    .map(|(&c, &m)| c * (m / total))
                    .sum();
                let back = DMat2::from_angle(-angles[design]);
                for (part, &centre) in centres.iter().enumerate() {
                    turned[part * designs + design] = back * (centre - whole);
                }
            }
        }
        Self {
            of_vertex,
            shares,
            angles,
            turned,
        }
    }

    /// Returns the number of parts.
    pub fn count(&self) -> usize {
        self.turned.len() / self.angles.len()
    }

    /// Computes the translation of each part that must be added to `deviation`. It removes the
    /// part's mean deviation, and moves the part around the centroid of the whole design as the
    /// design rotates.
    pub fn shifts(
        &self,
        weights: &[f64],
        deviation: impl Fn(usize) -> DVec2,
        shifts: &mut [DVec2],
    ) {
        let angle: f64 = self.angles.iter().zip(weights).map(|(a, w)| a * w).sum();
        let turn = DMat2::from_angle(angle);
        for (shift, turned) in shifts
            .iter_mut()
            .zip(self.turned.chunks_exact(weights.len()))
        {
            // `straight` and the offset from which it is subtracted are computed by the same
            // operations, so that they are exactly equal if the blend is a design.
            let ends = turned.iter().zip(&self.angles).zip(weights);
            let straight: DVec2 = ends
                .map(|((&end, &angle), &w)| DMat2::from_angle(angle) * end * w)
                .sum();
            *shift = turn * blended(weights, turned) - straight;
        }
        for (v, (&part, &share)) in self.of_vertex.iter().zip(&self.shares).enumerate() {
            shifts[part as usize] -= deviation(v) * share;
        }
    }
}

/// Returns, for each design, its rotation relative to an orientation common to all. The rotations
/// about the centroids minimise the squared distances between all pairs of designs (generalised
/// Procrustes analysis, Gower 1975, restricted to rotations).
fn common_angles(family: &CompatibleFamily, masses: &[f64]) -> Vec<f64> {
    /// Maximum number of power iterations (resource limit: convergence is fast unless the designs
    /// suggest no common orientation).
    const ROUNDS: usize = 200;
    let count = family.count();
    let total: f64 = masses.iter().sum();
    let centred: Vec<Vec<DVec2>> = family
        .embeddings()
        .iter()
        .map(|places| {
            let centre: DVec2 = places
                .iter()
                .zip(masses)
                .map(|(&p, &m)| p * (m / total))
                .sum();
            places.iter().map(|&p| p - centre).collect()
        })
        .collect();
    // The result is a complex number whose argument is the angle that rotates design k onto design
    // j.
    let onto = |j: usize, k: usize| -> DVec2 {
        let places = centred[j].iter().zip(&centred[k]).zip(masses);
        places
            .map(|((&p, &q), &m)| DVec2::new(q.dot(p), q.perp_dot(p)) * m)
            .sum()
    };
    let products: Vec<Vec<DVec2>> = (0..count)
        .map(|j| (0..count).map(|k| onto(j, k)).collect())
        .collect();
    let mut turns = vec![DVec2::X; count];
    for _ in 0..ROUNDS {
        let before = turns.clone();
        for (j, turn) in turns.iter_mut().enumerate() {
            let others = (0..count).filter(|&k| k != j);
            let sum: DVec2 = others.map(|k| before[k].rotate(products[j][k])).sum();
            // The rotation moves only half of the way to its new value; otherwise two designs would
            // swap their rotations for ever.
            *turn = (before[j] + sum.normalize_or(before[j])).normalize_or(before[j]);
        }
        let moved = turns.iter().zip(&before).map(|(a, b)| a.distance(*b));
        if moved.fold(0.0, f64::max) < 1e-15 {
            break;
        }
    }
    turns.iter().map(|turn| turn.to_angle()).collect()
}
