//! Evaluation of the rigidity-preserving interpolation at one t: right-hand sides, solve and
//! placement.

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

/// The rigidity-preserving interpolation of a mesh with its factored matrix.
#[derive(Debug)]
pub(super) struct FactoredArap {
    pub mesh: CompatibleMesh,
    /// Factorisation, shared by interpolations that differ only in their guards.
    pub cholesky: Arc<Cholesky>,
    /// Ridge (a small increase of the diagonal) that the factorisation needed, or `None`.
    pub ridge: Option<Ridge>,
    /// Precomputed data for the right-hand sides of the linear system.
    pub forces: ForceAssembly,
    pub translations: PartTranslations,
    pub maps: LocalMaps,
    /// Options for the already subdivided mesh; `subdivisions` is 0.
    pub options: ArapOptions,
    pub outline_constraints: OutlineConstraints,
    pub guard: Option<Arc<Guard>>,
}

/// Evaluates an interpolation at one t after another, in its own working memory.
pub(super) struct FrameSolver {
    arap: Arc<FactoredArap>,
    /// Holds the right-hand sides before the solve. After it, holds the deviation of each vertex
    /// from the straight line between its positions in the designs. All x come first, then all y,
    /// each in elimination order.
    deviation: Vec<f64>,
    workspace: CholeskyWorkspace,
    memory: Memory,
    /// Memory for a change of `deviation` that reduces the distortion of faces, in the same layout;
    /// empty unless the homotopy has bounded distortion.
    correction: Vec<f64>,
    /// Translation of each connected part, recomputed for each t.
    shifts: Vec<DVec2>,
}

impl FrameSolver {
    /// Allocates the memory for evaluating `prepared`.
    pub(super) fn of(prepared: &Arc<FactoredArap>) -> Self {
        Self {
            deviation: vec![0.0; 2 * prepared.mesh.source().len()],
            workspace: prepared.cholesky.workspace(2),
            memory: prepared.forces.memory(),
            correction: match prepared.forces.bounded() {
                Some(_) => vec![0.0; 2 * prepared.mesh.source().len()],
                None => Vec::new(),
            },
            shifts: vec![DVec2::ZERO; prepared.translations.part_count()],
            arap: Arc::clone(prepared),
        }
    }

    /// Moves the placement to the vertex positions at `times`, the time of each part.
    pub(super) fn place(&mut self, times: EvaluationTimes, placement: &mut Placement) {
        let Self {
            arap,
            deviation,
            workspace,
            memory,
            correction,
            shifts,
        } = self;
        let place = arap.cholesky.elimination_places();
        let Placement {
            in_frame,
            in_source,
            in_target,
            ..
        } = placement;
        // The linear homotopy has zero deviation and needs no solve.
        if arap.options.homotopy != Homotopy::Linear {
            // `in_frame` serves as memory for computing the right-hand sides before it receives the
            // positions.
            arap.forces
                .right_hand_sides(times, place, memory, in_frame, deviation);
            arap.cholesky.solve_ordered(deviation, workspace);
            if let Some(bounded) = arap.forces.bounded() {
                let solver = DeviationSolver::new(&arap.cholesky, in_frame, correction, workspace);
                strain_limiting::put_back((bounded, times), deviation, memory, solver);
            }
            arap.translations.shifts(times, deviation, shifts);
        }
        let (dx, dy) = deviation.split_at(place.len());
        for (run, part) in arap.translations.runs() {
            let (shift, t) = (shifts[part], times.of_part(part));
            // The local maps of all faces of a transient part are the same scaling. Its exact
            // deviation is therefore zero, and the computed deviation is only rounding and is
            // ignored.
            let (t, weight) = match arap.translations.time_window(part) {
                Some(window) => (window.fraction_done(t), 0.0),
                None => (t, 1.0),
            };
            let ends = in_source[run.clone()].iter().zip(&in_target[run.clone()]);
            let vertices = in_frame[run.clone()].iter_mut().zip(&place[run]);
            for ((&p, &q), (out, &unknown)) in ends.zip(vertices) {
                let u = DVec2::new(dx[unknown as usize], dy[unknown as usize]);
                // The deviation and the shift are exactly 0 at t = 0 and t = 1. They are added
                // last, so that the positions at these times are exact.
                *out = (p * (1.0 - t) + q * t) + (u * weight + shift);
            }
        }
        if let Some(guard) = &arap.guard {
            for (run, part) in arap.translations.runs() {
                let Some(mix) = guard.at(times.of_part(part)) else {
                    continue;
                };
                guard.add(&mix, run.clone(), &mut in_frame[run]);
            }
        }
    }
}
