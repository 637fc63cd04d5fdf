//! Flattening a sheet without shearing it: one factor e^u for each vertex, with
//! squared lengths l² e^(u_i + u_j), for which angles about each vertex add up to a
//! full turn.
//!
//! Springborn, Schröder, Pinkall, "Conformal equivalence of triangle meshes" (2008),
//! §§3 and 4: such u are where a convex energy is least. Its gradient is what the
//! angles lack, its Hessian half the cotangent Laplacian; Newton's method with
//! steps that are halved until the energy does not rise again behind them. Where the
//! lengths of a face break the triangle inequality its angles are π, 0 and 0, which
//! keeps the energy convex: a few such faces are flat too, as no triangles, and are put
//! right with what is sheared too much. With u = 0 along the boundary sizes change least.
//!
//! Guaranteed: nothing is allocated, it ends, and depends on nothing but the sheet
//! and t. Not guaranteed: that it gets there; it says whether it did.

use super::sheet::{FIXED, FaceSheet};
use crate::numerics::PatternWorkspace;

/// What the angles about a vertex may lack when a sheet is flat, in radians. The places
/// then are off by as little, and Newton's method has long begun to converge.
const FLAT: f64 = 1e-9;

/// What is not worth another step.
const ENOUGH: f64 = 1e-13;

/// Steps, and how often each is halved.
const STEPS: u32 = 60;
const HALVED: u32 = 40;

/// A corner of a face: of the two sides that meet there the dot product and the
/// cross product, twice the area.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CornerProducts {
    pub dot: f64,
    pub cross: f64,
}

/// The memory to flatten a sheet in, and what came of it.
#[derive(Debug)]
pub(super) struct Flattening {
    /// Of each unknown, and what its angles lack.
    u: Vec<f64>,
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

    /// The corners of the faces as they were flattened last.
    pub(super) fn corners(&self) -> &[[CornerProducts; 3]] {
        &self.corners
    }

    /// Flattens a sheet at t; whether it is flat.
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

    /// Newton's step from where it is; whether there is one.
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

    /// Goes along the step as far as is of use; how far off it is then.
    fn go(&mut self, sheet: &FaceSheet, t: f64) -> Option<f64> {
        let slope = self.slope();
        let mut length = 1.0;
        for _ in 0..HALVED {
            for ((trial, u), step) in self.trial.iter_mut().zip(&self.u).zip(&self.step) {
                *trial = u + length * step;
            }
            let off = self.measure(sheet, t);
            // Beyond the least it rises again; not a number is false.
            if self.slope() <= 0.5 * slope.abs() {
                self.u.copy_from_slice(&self.trial);
                return Some(off);
            }
            length *= 0.5;
        }
        None
    }

    /// How the energy changes along the step.
    fn slope(&self) -> f64 {
        self.lack.iter().zip(&self.step).map(|(a, b)| a * b).sum()
    }

    /// Corners, and what angles lack, with the factors that are tried; the most that any
    /// lacks.
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

/// The corners of a face with these squared lengths of its sides.
fn corners_of(squared: [f64; 3]) -> [CornerProducts; 3] {
    let cross = twice_area(squared.map(f64::sqrt));
    [0, 1, 2].map(|k| CornerProducts {
        dot: 0.5 * (squared[k] + squared[(k + 2) % 3] - squared[(k + 1) % 3]),
        cross,
    })
}

/// Twice the area of a triangle, zero where there is none of such lengths; to the last
/// digits also where it is thin (Kahan, "Miscalculating area and angles of a
/// needle-like triangle").
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
