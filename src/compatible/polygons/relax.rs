//! All inner vertices moved together, in both designs at once, to lower the
//! weighted sum of the faces' costs.
//!
//! Guaranteed: a valid mesh stays valid, since the cost is infinite outside
//! and the result is checked exactly. A minimum is not promised.

use super::face_cost;
use super::mesh_energy::MeshEnergy;
use super::pair_mesh::PairMesh;
use super::springs::Springs;
use crate::work::progress::Progress;

/// All inner vertices moved together by at most `steps` steps; given up if
/// rounding leaves a face that is not exactly positive, and ended early by a
/// cancel.
pub(super) fn relax(mesh: &mut PairMesh, steps: usize, progress: &dyn Progress) {
    let motion = MeshEnergy::of_inner(mesh, face_cost::AREA_WEIGHT);
    let Some([mut source, mut target]) = springs(&motion, mesh, progress) else {
        return;
    };
    let n = motion.inner.len();
    let precondition = |forces: &mut [f64]| {
        source.solve(&mut forces[..2 * n]);
        target.solve(&mut forces[2 * n..]);
    };
    let (at, _) = motion.minimised(steps, precondition, progress);
    mesh.move_to(at);
}

/// The curvature of the cost where areas are kept, as springs in each
/// design.
fn springs(motion: &MeshEnergy, mesh: &PairMesh, progress: &dyn Progress) -> Option<[Springs; 2]> {
    let of = |d: usize| {
        let springs = motion.faces.iter().flat_map(|&(face, weight)| {
            let [p, q] = mesh.corners(face);
            let stiffness = face_cost::stiffness(p, q)[d];
            let ends = |k: usize| [face[(k + 1) % 3], face[(k + 2) % 3]];
            [0, 1, 2].map(|k| (ends(k), weight * stiffness[k]))
        });
        Springs::new(&motion.inner, springs, progress)
    };
    // Each design for itself: what couples the two may be negative.
    Some([of(0)?, of(1)?])
}
