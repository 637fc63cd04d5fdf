//! What a film is made of, and a frame of it: right-hand sides, solve, placement.

use super::assembly::LocalMaps;
use super::bounded::Memory;
use super::evaluation_times::EvaluationTimes;
use super::forces::ForceAssembly;
use super::guard::Guard;
use super::options::ArapOptions;
use super::part_translations::PartTranslations;
use super::ridge::Ridge;
use super::straight_sides::OutlineConstraints;
use super::strain_limiting;
use super::strain_limiting::DeviationSolver;
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;
use crate::numerics::{Cholesky, CholeskyWorkspace};
use crate::warp::Placement;
use crate::warp::homotopy::Homotopy;
use std::sync::Arc;

/// All that a film is made of, factored.
#[derive(Debug)]
pub(super) struct FactoredArap {
    pub mesh: CompatibleMesh,
    /// Shared by films that differ by their guards.
    pub cholesky: Arc<Cholesky>,
    pub ridge: Option<Ridge>,
    pub stresses: ForceAssembly,
    pub drift: PartTranslations,
    pub maps: LocalMaps,
    /// Options of the mesh as it is: nothing left to subdivide.
    pub options: ArapOptions,
    pub outlined: OutlineConstraints,
    pub guard: Option<Arc<Guard>>,
}

/// A film with the memory that a frame takes.
pub(super) struct FrameSolver {
    arap: Arc<FactoredArap>,
    /// Right-hand sides, then the deviation U: all x, all y, in elimination order.
    deviation: Vec<f64>,
    workspace: CholeskyWorkspace,
    memory: Memory,
    /// Bounded only: what is added to the deviation.
    more: Vec<f64>,
    /// Of each connected part.
    shifts: Vec<DVec2>,
}

impl FrameSolver {
    pub(super) fn of(prepared: &Arc<FactoredArap>) -> Self {
        Self {
            deviation: vec![0.0; 2 * prepared.mesh.source().len()],
            workspace: prepared.cholesky.workspace(2),
            memory: prepared.stresses.memory(),
            more: match prepared.stresses.bounded() {
                Some(_) => vec![0.0; 2 * prepared.mesh.source().len()],
                None => Vec::new(),
            },
            shifts: vec![DVec2::ZERO; prepared.drift.part_count()],
            arap: Arc::clone(prepared),
        }
    }

    pub(super) fn place(&mut self, times: EvaluationTimes, placement: &mut Placement) {
        let Self {
            arap,
            deviation,
            workspace,
            memory,
            more,
            shifts,
        } = self;
        let place = arap.cholesky.place_in_order();
        let Placement {
            in_frame,
            in_source,
            in_target,
            ..
        } = placement;
        // The linear path needs no solve: its deviation is zero.
        if arap.options.homotopy != Homotopy::Linear {
            // The forces stand where the positions will stand.
            arap.stresses
                .right_hand_sides(times, place, (memory, in_frame), deviation);
            arap.cholesky.solve_ordered(deviation, workspace);
            if let Some(bounded) = arap.stresses.bounded() {
                let solver = DeviationSolver::new(&arap.cholesky, in_frame, more, workspace);
                strain_limiting::put_back((bounded, times), deviation, memory, solver);
            }
            arap.drift.shifts(times, deviation, shifts);
        }
        let (dx, dy) = deviation.split_at(place.len());
        for (run, part) in arap.drift.runs() {
            let (shift, t) = (shifts[part], times.of_part(part));
            // Of what only changes its size every map is that change: it
            // deviates by nothing but rounding.
            let (t, weight) = match arap.drift.life(part) {
                Some(life) => (life.share(t), 0.0),
                None => (t, 1.0),
            };
            let ends = in_source[run.clone()].iter().zip(&in_target[run.clone()]);
            let rest = in_frame[run.clone()].iter_mut().zip(&place[run]);
            for ((&p, &q), (out, &at)) in ends.zip(rest) {
                let u = DVec2::new(dx[at as usize], dy[at as usize]);
                // What is exactly 0 at an end is added last, so that the
                // end is met to the last bit.
                *out = (p * (1.0 - t) + q * t) + (u * weight + shift);
            }
        }
        if let Some(guard) = &arap.guard {
            for (run, part) in arap.drift.runs() {
                let Some(mix) = guard.at(times.of_part(part)) else {
                    continue;
                };
                guard.add(&mix, run.clone(), &mut in_frame[run]);
            }
        }
    }
}
