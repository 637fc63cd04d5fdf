//! Faces that are sheared more than at the worse end are put back, frame by frame.
//!
//! Many are put back all at once, each as its own map says. A needle gives way by next to
//! nothing of that, since its neighbours do not; so few are put back one after the other,
//! each by what it does not give way. Either is done farther than it should be, since what
//! is put back next pulls it forth again.
//!
//! Guaranteed: what is within the bound is not touched. Not guaranteed: that all is within
//! it at the end.

use super::bounded::{Bounded, Memory};
use super::evaluation_times::EvaluationTimes;
use crate::geometry::{DMat2, DVec2};
use crate::numerics::{Cholesky, CholeskyWorkspace};

/// How often any is put back in a frame, at most: most films need none.
const MOST: usize = 128;

/// How many times as far as it should: any less than twice gets there (Young 1954,
/// successive overrelaxation). By as far as it should, a face of an icon was sheared more
/// than twice what it may be after 128 times.
const FARTHER: f64 = 1.8;

/// So few are put back one after the other: all at once, a face of an icon was sheared
/// four times what it may be after 128 times.
const FEW: usize = 8;

/// Solves for what deviates by forces, with the memory of a frame to work in.
pub(super) struct DeviationSolver<'a> {
    cholesky: &'a Cholesky,
    /// Of each vertex.
    forces: &'a mut [DVec2],
    /// All x, all y, in elimination order.
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

    /// What deviates where so is pulled.
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

/// Puts faces back that are sheared more than at the worse end, of what deviates so from
/// the straight line: all x, all y, in elimination order.
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
