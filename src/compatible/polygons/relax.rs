//! Moves all inner vertices together, in both designs at once, to lower the weighted sum of the
//! face costs.
//!
//! Guaranteed: a valid mesh stays valid, because the cost is infinite for invalid faces and the
//! result is checked exactly. Not guaranteed: a minimum.

use super::face_cost;
use super::mesh_energy::MeshEnergy;
use super::pair_mesh::PairMesh;
use super::springs::Springs;
use crate::work::progress::Progress;

/// Takes at most `steps` descent steps with all inner vertices. Changes nothing if rounding leaves
/// a face that is not exactly positive. A cancel ends it early.
pub(super) fn relax(mesh: &mut PairMesh, steps: usize, progress: &dyn Progress) {
    let energy = MeshEnergy::of_inner_vertices(mesh, face_cost::AREA_WEIGHT);
    let Some([mut source, mut target]) = springs(&energy, mesh, progress) else {
        return;
    };
    let n = energy.inner.len();
    // The unknowns of each design are contiguous.
    let precondition = |forces: &mut [f64]| {
        source.solve(&mut forces[..2 * n]);
        target.solve(&mut forces[2 * n..]);
    };
    let (points, _) = energy.minimised(steps, precondition, progress);
    mesh.move_to(points);
}

/// Returns springs with the cost's curvature at fixed areas, one network for each design.
fn springs(energy: &MeshEnergy, mesh: &PairMesh, progress: &dyn Progress) -> Option<[Springs; 2]> {
    let of = |d: usize| {
        let springs = energy.faces.iter().flat_map(|&(face, weight)| {
            let [p, q] = mesh.corners(face);
            let stiffness = face_cost::stiffness(p, q)[d];
            let ends = |k: usize| [face[(k + 1) % 3], face[(k + 2) % 3]];
            [0, 1, 2].map(|k| (ends(k), weight * stiffness[k]))
        });
        Springs::new(&energy.inner, springs, progress)
    };
    // Each design on its own, because the terms that couple the two may be negative.
    Some([of(0)?, of(1)?])
}
