//! What a film is made of, and a frame of it: right-hand sides, solve, placement.

use super::assembly::LocalMaps;
use super::bounded::Memory;
use super::drift::Drift;
use super::guard::Guard;
use super::options::ArapOptions;
use super::put_back::{self, Solver};
use super::ridge::Ridge;
use super::sides::Outlined;
use super::stresses::Stresses;
use super::times::Times;
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;
use crate::homotopy::Homotopy;
use crate::linalg::{Cholesky, Workspace};
use crate::warp::Placement;
use std::sync::Arc;

/// All that a film is made of, factored.
#[derive(Debug)]
pub(super) struct Prepared {
    pub mesh: CompatibleMesh,
    /// Shared by films that differ by their guards.
    pub cholesky: Arc<Cholesky>,
    pub ridge: Option<Ridge>,
    pub stresses: Stresses,
    pub drift: Drift,
    pub maps: LocalMaps,
    /// Options of the mesh as it is: nothing left to subdivide.
    pub options: ArapOptions,
    pub outlined: Outlined,
    pub guard: Option<Arc<Guard>>,
}

/// A film with the memory that a frame takes.
pub(super) struct Player {
    arap: Arc<Prepared>,
    /// Right-hand sides, then the deviation U: all x, all y, in elimination order.
    deviation: Vec<f64>,
    workspace: Workspace,
    memory: Memory,
    /// Bounded only: what is added to the deviation.
    more: Vec<f64>,
    /// Of each connected part.
    shifts: Vec<DVec2>,
}

impl Player {
    pub(super) fn of(prepared: &Arc<Prepared>) -> Self {
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

    pub(super) fn place(&mut self, times: Times, placement: &mut Placement) {
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
                let solver = Solver::new(&arap.cholesky, in_frame, more, workspace);
                put_back::put_back((bounded, times), deviation, memory, solver);
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
