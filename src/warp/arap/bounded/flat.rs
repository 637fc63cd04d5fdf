//! Flattens a sheet (a set of faces connected by shared edges) conformally.
//!
//! Each vertex has a factor e^u. The squared length of an edge becomes l² e^(u_i + u_j), and the
//! factors are chosen such that the angles around each vertex sum to 2π.
//!
//! Springborn, Schröder, Pinkall, "Conformal equivalence of triangle meshes" (2008), sections 3 and
//! 4: these u minimise a convex energy. Its gradient is the missing angle at each vertex: 2π minus
//! the sum of the angles there. Its Hessian is half the cotangent Laplacian. Each Newton step is
//! halved until the energy, at the end of the step, rises at most half as steeply as it falls at
//! the start. If the lengths of a face violate the triangle inequality, its angles are π, 0 and 0,
//! which keeps the energy convex. A few such faces count as flat, although they are no triangles;
//! they are corrected with the faces that exceed the distortion bound. With u = 0 along the outer
//! boundary, sizes change least.
//!
//! Guaranteed: nothing is allocated; the method terminates; the result depends only on the sheet
//! and t. Not guaranteed: convergence, which is reported.

use super::sheet::{FIXED, FaceSheet};
use crate::numerics::PatternWorkspace;

/// Missing angle (required minus actual sum of the angles at a vertex), in radians, up to which a
/// sheet counts as flat (tolerance: positions are then as accurate, and Newton's method has begun
/// to converge quadratically).
const FLAT: f64 = 1e-9;

/// Missing angle (required minus actual sum of the angles at a vertex), in radians, at which
/// Newton's method stops (tolerance: rounding).
const ENOUGH: f64 = 1e-13;

/// Maximum number of Newton steps (resource limit).
const STEPS: u32 = 60;
/// Maximum number of times that a step is halved (resource limit).
const HALVED: u32 = 40;

/// Dot product and cross product of the two sides that meet at a corner of a face. The cross
/// product is twice the area of the face.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CornerProducts {
    pub dot: f64,
    pub cross: f64,
}

/// Memory to flatten a sheet, and the result.
#[derive(Debug)]
pub(super) struct Flattening {
    /// For each unknown scale factor e^u of a vertex or hole, its logarithm u.
    u: Vec<f64>,
    /// For each unknown, the missing angle in radians: the required minus the actual sum of the
    /// angles at its vertices.
    lack: Vec<f64>,
    step: Vec<f64>,
    trial: Vec<f64>,
    scales: Vec<f64>,
    corners: Vec<[CornerProducts; 3]>,
    matrix: Option<PatternWorkspace>,
}

impl Flattening {
    pub(super) fn of(sheet: &FaceSheet) -> Self {
        let none = vec![0.0; sheet.sums.len()];
        Self {
            lack: none.clone(),
            step: none.clone(),
            trial: none.clone(),
            scales: none.clone(),
            u: none,
            corners: vec![[CornerProducts::default(); 3]; sheet.faces.len()],
            matrix: sheet.pattern.as_ref().map(|pattern| pattern.memory()),
        }
    }

    /// Returns the dot and cross products at the corners of all faces after the last flattening.
    pub(super) fn corners(&self) -> &[[CornerProducts; 3]] {
        &self.corners
    }

    /// Flattens a sheet at t. Returns whether the missing angles are at most [`FLAT`].
    pub(super) fn flatten(&mut self, sheet: &FaceSheet, t: f64) -> bool {
        self.u.fill(0.0);
        self.trial.fill(0.0);
        let mut off = self.measure(sheet, t);
        for _ in 0..STEPS {
            if off <= ENOUGH || !self.set_step(sheet) {
                break;
            }
            let before = off;
            let Some(found) = self.go(sheet, t) else {
                self.trial.copy_from_slice(&self.u);
                off = self.measure(sheet, t);
                break;
            };
            off = found;
            if off <= FLAT && off > 0.5 * before {
                break;
            }
        }
        off <= FLAT
    }

    /// Computes the step of Newton's method. Returns `false` if the sheet has no matrix
    /// ([`FaceSheet::pattern`] is `None`) or the matrix cannot be factored.
    fn set_step(&mut self, sheet: &FaceSheet) -> bool {
        let (Some(pattern), Some(matrix)) = (&sheet.pattern, &mut self.matrix) else {
            return false;
        };
        let entries = matrix.entries();
        entries.fill(0.0);
        for (corners, of_sides) in self.corners.iter().zip(&sheet.entries) {
            for (k, &[first, second, both]) in of_sides.iter().enumerate() {
                let CornerProducts { dot, cross } = corners[(k + 2) % 3];
                if cross <= 0.0 {
                    continue;
                }
                let pull = 0.5 * dot / cross;
                for (entry, by) in [(first, pull), (second, pull), (both, -pull)] {
                    if entry != FIXED {
                        entries[entry as usize] += by;
                    }
                }
            }
        }
        for (step, lack) in self.step.iter_mut().zip(&self.lack) {
            *step = -lack;
        }
        pattern.solve(matrix, &mut self.step)
    }

    /// Moves the unknowns along the Newton step, which is halved until the energy at its end hardly
    /// rises. Returns the largest missing angle at the new position, in radians; `None` if the step
    /// cannot be halved often enough.
    fn go(&mut self, sheet: &FaceSheet, t: f64) -> Option<f64> {
        let slope = self.slope();
        let mut length = 1.0;
        for _ in 0..HALVED {
            for ((trial, u), step) in self.trial.iter_mut().zip(&self.u).zip(&self.step) {
                *trial = u + length * step;
            }
            let off = self.measure(sheet, t);
            // Beyond the minimum the energy rises again. The comparison is false for NaN.
            if self.slope() <= 0.5 * slope.abs() {
                self.u.copy_from_slice(&self.trial);
                return Some(off);
            }
            length *= 0.5;
        }
        None
    }

    /// Returns the derivative of the energy along the Newton step, at the point where the missing
    /// angles were last measured.
    fn slope(&self) -> f64 {
        self.lack.iter().zip(&self.step).map(|(a, b)| a * b).sum()
    }

    /// Computes the corner products and the missing angles for the logarithms in `trial`. Returns
    /// the largest missing angle in radians.
    fn measure(&mut self, sheet: &FaceSheet, t: f64) -> f64 {
        for (scale, u) in self.scales.iter_mut().zip(&self.trial) {
            *scale = u.exp();
        }
        self.lack.copy_from_slice(&sheet.sums);
        let scale = |unknown: u32| match unknown {
            FIXED => 1.0,
            unknown => self.scales[unknown as usize],
        };
        let faces = sheet.lengths.iter().zip(&sheet.unknowns);
        for ((lengths, unknowns), corners) in faces.zip(&mut self.corners) {
            let scales = unknowns.map(scale);
            let [from, to] = lengths;
            let sides = [0, 1, 2].map(|k| {
                let length = from[k] * (1.0 - t) + to[k] * t;
                length * scales[k] * scales[(k + 1) % 3]
            });
            *corners = corners_of(sides);
            for (&unknown, corner) in unknowns.iter().zip(corners) {
                if unknown != FIXED {
                    self.lack[unknown as usize] -= corner.cross.atan2(corner.dot);
                }
            }
        }
        self.lack
            .iter()
            .fold(0.0, |most: f64, lack| most.max(lack.abs()))
    }
}

/// Returns the dot and cross products at the corners of a face with the given squared side lengths.
fn corners_of(squared: [f64; 3]) -> [CornerProducts; 3] {
    let cross = twice_area(squared.map(f64::sqrt));
    [0, 1, 2].map(|k| CornerProducts {
        dot: 0.5 * (squared[k] + squared[(k + 2) % 3] - squared[(k + 1) % 3]),
        cross,
    })
}

/// Returns twice the area of a triangle; 0 if the lengths violate the triangle inequality. Accurate
/// also for thin triangles (Kahan, "Miscalculating area and angles of a needle-like triangle").
fn twice_area(mut lengths: [f64; 3]) -> f64 {
    lengths.sort_unstable_by(f64::total_cmp);
    let [c, b, a] = lengths;
    let product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    0.5 * product.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn corners_are_those_of_the_triangle() {
        let corners = corners_of([9.0, 16.0, 25.0]);
        let angles = corners.map(|corner| corner.cross.atan2(corner.dot));
        assert!((angles[1] - 0.5 * PI).abs() < 1e-15);
        assert!((angles.iter().sum::<f64>() - PI).abs() < 1e-15);
        let broken = corners_of([1.0, 9.0, 1.0]);
        let angles = broken.map(|corner| corner.cross.atan2(corner.dot));
        assert_eq!(angles, [PI, 0.0, 0.0]);
    }
}
