//! Strain limiting: at each t, corrects the faces whose distortion exceeds the bound of their
//! sheet. A sheet is a set of faces connected by shared edges. Its bound is the largest distortion
//! (ratio of singular values) of the linear maps that take its faces from source to target.
//!
//! If many faces exceed the bound, all are corrected at once, each by the change that its own local
//! map needs. A needle-shaped face hardly yields to that, because its neighbours resist. If only a
//! few faces exceed the bound, they are therefore corrected one after the other, and each change is
//! enlarged by the resistance of its face. All corrections are overrelaxed (enlarged by a constant
//! factor), because each correction partly undoes the previous ones.
//!
//! Guaranteed: if all faces satisfy the bound, nothing is changed. Not guaranteed: that all faces
//! satisfy it in the end.

use super::bounded::{Bounded, Memory};
use super::evaluation_times::EvaluationTimes;
use crate::geometry::{DMat2, DVec2};
use crate::numerics::{Cholesky, CholeskyWorkspace};

/// Maximum number of corrections at one t. One correction changes the deviations for a single face,
/// or for all faces at once (resource limit; a pass over single faces is always completed).
const MOST: usize = 128;

/// Factor by which each correction is enlarged (overrelaxation); the iteration converges for
/// factors between 0 and 2 (Young 1954, successive overrelaxation) (heuristic).
const FARTHER: f64 = 1.8;

/// Maximum number of faces that are corrected one after the other (heuristic).
const FEW: usize = 8;

/// Solver for the deviations of the vertices with given right-hand sides. It borrows its memory
/// from the evaluation of the warp.
pub(super) struct DeviationSolver<'a> {
    cholesky: &'a Cholesky,
    /// Right-hand side at each vertex.
    forces: &'a mut [DVec2],
    /// The deviations that were solved for last: all x, then all y, in elimination order.
    solved: &'a mut [f64],
    workspace: &'a mut CholeskyWorkspace,
}

impl<'a> DeviationSolver<'a> {
    pub(super) fn new(
        cholesky: &'a Cholesky,
        forces: &'a mut [DVec2],
        solved: &'a mut [f64],
        workspace: &'a mut CholeskyWorkspace,
    ) -> Self {
        Self {
            cholesky,
            forces,
            solved,
            workspace,
        }
    }

    /// Returns the deviations for the right-hand sides that `pull` writes.
    fn solve(&mut self, pull: impl FnOnce(&mut [DVec2])) -> &[f64] {
        self.forces.fill(DVec2::ZERO);
        pull(self.forces);
        let place = self.cholesky.elimination_places();
        let (x, y) = self.solved.split_at_mut(place.len());
        for (force, &at) in self.forces.iter().zip(place) {
            x[at as usize] = force.x;
            y[at as usize] = force.y;
        }
        self.cholesky.solve_ordered(self.solved, self.workspace);
        self.solved
    }
}

/// Corrects the faces that exceed the distortion bound by changing `deviation`, the deviations of
/// the vertices from their straight paths: all x, then all y, in elimination order.
pub(super) fn put_back(
    (bounded, times): (&Bounded, EvaluationTimes),
    deviation: &mut [f64],
    memory: &mut Memory,
    mut solver: DeviationSolver,
) {
    let place = solver.cholesky.elimination_places();
    let of = |all: &[f64], v: u32| {
        let at = place[v as usize] as usize;
        DVec2::new(all[at], all[place.len() + at])
    };
    let add = |sum: &mut [f64], by: &[f64]| {
        sum.iter_mut().zip(by).for_each(|(sum, by)| *sum += by);
    };
    let mut done = 0;
    while done < MOST {
        bounded.find_beyond(times, memory, |v| of(deviation, v));
        let beyond = &memory.beyond[..];
        if beyond.is_empty() {
            return;
        }
        if beyond.len() > FEW {
            let pull = |forces: &mut [DVec2]| {
                for &(face, lacks) in beyond {
                    bounded.face(face).pull(lacks * FARTHER, forces);
                }
            };
            add(deviation, solver.solve(pull));
            done += 1;
            continue;
        }
        for &(which, _) in beyond {
            done += 1;
            let face = bounded.face(which);
            let Some(lacks) = bounded.lacking(which, times, |v| of(deviation, v)) else {
                continue;
            };
            let unyielding = bounded.unyielding(which, || {
                let solved = solver.solve(|forces| face.pull(DMat2::IDENTITY, forces));
                face.strayed(|v| of(solved, v))
            });
            let by = lacks * unyielding * FARTHER;
            add(deviation, solver.solve(|forces| face.pull(by, forces)));
        }
    }
}
