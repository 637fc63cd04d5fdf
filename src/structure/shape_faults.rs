//! Faults that follow from the shape of a structure: mechanisms, pieces, sharp angles, stubs and
//! crossing bars.

use super::findings::StructureFault;
use super::limits::StructureLimits;
use super::solver::{StructuralState, StructureSolver};
use crate::compatible::conflicts_in;
use crate::geometry::DVec2;
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use std::collections::BTreeSet;

/// Pairs of bars that cross in a design.
pub(super) type CrossingBars = BTreeSet<[u32; 2]>;

/// Finds the faults of the shape at the last analysis of `solver`. `designed_crossings` are the
/// pairs of bars that cross in both designs.
pub(super) fn find(
    solver: &StructureSolver,
    limits: &StructureLimits,
    designed_crossings: &CrossingBars,
    progress: &dyn Progress,
) -> Result<Vec<StructureFault>, Cancelled> {
    let state = solver.state();
    let pieces = Pieces::of(solver);
    let mut faults = Vec::new();
    if state.is_mechanism {
        faults.push(pieces.mechanism(solver, state));
    }
    let loaded = solver.unresisted_moments();
    if !loaded.is_empty() {
        faults.push(StructureFault::LoadOnNothing { nodes: loaded });
    }
    if pieces.count > 1 {
        let pieces = pieces.count;
        faults.push(StructureFault::InPieces { pieces });
    }
    faults.extend(sharpest_angle(solver, limits.least_angle_deg));
    faults.extend(shortest_stub(state));
    let crossings = crossing_bars(solver, progress)?;
    let first = crossings.difference(designed_crossings).next();
    faults.extend(first.map(|bars| StructureFault::CrossesWithoutJoint {
        bars: bars.map(|bar| bar as usize),
    }));
    Ok(faults)
}

/// Connected pieces of a structure.
struct Pieces {
    /// For each node, the index of its piece.
    of_nodes: Vec<usize>,
    count: usize,
}

impl Pieces {
    fn of(solver: &StructureSolver) -> Self {
        let nodes = solver.places().len();
        let mut parent: Vec<usize> = (0..nodes).collect();
        fn root(parent: &mut [usize], mut node: usize) -> usize {
            while parent[node] != node {
                parent[node] = parent[parent[node]];
                node = parent[node];
            }
            node
        }
        let bars = solver.blend().bars().iter().zip(&solver.state().properties);
        for (&[a, b], _) in bars.filter(|(_, own)| own.area > 0.0) {
            let [a, b] = [a, b].map(|node| root(&mut parent, node as usize));
            parent[a] = b;
        }
        let roots: Vec<usize> = (0..nodes).map(|node| root(&mut parent, node)).collect();
        let distinct: BTreeSet<usize> = roots.iter().copied().collect();
        let index = |root: &usize| distinct.range(..root).count();
        Self {
            of_nodes: roots.iter().map(index).collect(),
            count: distinct.len(),
        }
    }

    /// Returns the fault of a mechanism: whether whole pieces move, or parts against each other.
    fn mechanism(&self, solver: &StructureSolver, state: &StructuralState) -> StructureFault {
        let nodes = state.moving_nodes();
        let moving: BTreeSet<usize> = nodes.iter().map(|&n| self.of_nodes[n as usize]).collect();
        let is_rigid = |&piece: &usize| {
            let members = (0..self.of_nodes.len()).filter(|&node| self.of_nodes[node] == piece);
            let motion: Vec<(DVec2, DVec2)> = members
                .map(|node| {
                    let [x, y, _] = state.mode[node];
                    (solver.places()[node], DVec2::new(x, y))
                })
                .collect();
            is_rigid_motion(&motion)
        };
        match moving.iter().all(is_rigid) {
            true => StructureFault::NotHeld { nodes },
            false => StructureFault::FallsOver { nodes },
        }
    }
}

/// Returns whether displacements at places are those of an infinitesimal rigid motion.
fn is_rigid_motion(motion: &[(DVec2, DVec2)]) -> bool {
    let count = motion.len() as f64;
    let centre = motion.iter().map(|(place, _)| *place).sum::<DVec2>() / count;
    let mean = motion.iter().map(|(_, moved)| *moved).sum::<DVec2>() / count;
    let spread = motion
        .iter()
        .map(|(place, _)| place.distance_squared(centre))
        .sum::<f64>();
    let turns = motion
        .iter()
        .map(|(place, moved)| (*place - centre).perp_dot(*moved - mean));
    let turn = if spread > 0.0 {
        turns.sum::<f64>() / spread
    } else {
        0.0
    };
    let largest = motion
        .iter()
        .map(|(_, moved)| moved.length())
        .fold(0.0, f64::max);
    let is_followed = |(place, moved): &(DVec2, DVec2)| {
        let rigid = mean + turn * (*place - centre).perp();
        rigid.distance(*moved) <= 1e-3 * largest
    };
    motion.iter().all(is_followed)
}

/// Returns the two bars that meet at the smallest angle, if it is below the limit.
fn sharpest_angle(solver: &StructureSolver, limit_deg: f64) -> Option<StructureFault> {
    let places = solver.places();
    let mut at_nodes: Vec<Vec<(usize, f64)>> = vec![Vec::new(); places.len()];
    let bars = solver.blend().bars().iter().zip(&solver.state().properties);
    for (bar, (&[a, b], _)) in bars.enumerate().filter(|(_, (_, own))| own.area > 0.0) {
        let direction = places[b as usize] - places[a as usize];
        at_nodes[a as usize].push((bar, direction.to_angle()));
        at_nodes[b as usize].push((bar, (-direction).to_angle()));
    }
    let mut sharpest: Option<([usize; 2], f64)> = None;
    for bars in &mut at_nodes {
        bars.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (k, &(bar, angle)) in bars.iter().enumerate() {
            let (other, next) = bars[(k + 1) % bars.len()];
            let between = (next - angle)
                .rem_euclid(std::f64::consts::TAU)
                .to_degrees();
            if bar != other && sharpest.is_none_or(|(_, least)| between < least) {
                sharpest = Some(([bar.min(other), bar.max(other)], between));
            }
        }
    }
    let (bars, angle_deg) = sharpest.filter(|(_, angle)| *angle < limit_deg)?;
    Some(StructureFault::SharpAngle { bars, angle_deg })
}

/// Returns the bar that is shortest in comparison with the height of its section, if it is shorter
/// than that.
fn shortest_stub(state: &StructuralState) -> Option<StructureFault> {
    let bars = state.forces.iter().zip(&state.properties).enumerate();
    let ratio = |forces: f64, depth: f64| forces / depth;
    let stubs = bars.filter(|(_, (forces, own))| own.area > 0.0 && forces.length < own.depth);
    let shortest = stubs.min_by(|(_, (a, own_a)), (_, (b, own_b))| {
        ratio(a.length, own_a.depth).total_cmp(&ratio(b.length, own_b.depth))
    });
    shortest.map(|(bar, (forces, _))| StructureFault::Stub {
        bar,
        length: forces.length,
    })
}

/// Returns the pairs of bars that meet other than in a common node; none if they are so many that
/// the search is given up.
///
/// # Errors
/// [`Cancelled`] if the work is cancelled.
pub(super) fn crossing_bars(
    solver: &StructureSolver,
    progress: &dyn Progress,
) -> Result<CrossingBars, Cancelled> {
    let found = conflicts_in(solver.blend().bars(), solver.places(), progress);
    check_cancelled(progress)?;
    Ok(found.unwrap_or_default().into_iter().collect())
}
