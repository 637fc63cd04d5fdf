//! Relaxation: moves all inner vertices together, in both designs at once, to lower the weighted
//! sum of the face costs.
//!
//! Guaranteed: a valid mesh stays valid, because the cost of an invalid face is infinite and the
//! result is checked by exact predicates. Not guaranteed: that the sum reaches a minimum.

use super::face_cost;
use super::mesh_energy::MeshEnergy;
use super::pair_mesh::PairMesh;
use super::springs::Springs;
use crate::work::progress::Progress;

/// Lowers the sum of the face costs by moving all inner vertices, in at most `steps` descent steps.
/// Leaves the mesh unchanged if rounding makes a face of the result invalid. A cancel ends the
/// descent early.
pub(super) fn relax(mesh: &mut PairMesh, steps: usize, progress: &dyn Progress) {
    let energy = MeshEnergy::of_inner_vertices(mesh, face_cost::AREA_WEIGHT);
    let Some([mut source, mut target]) = springs(&energy, mesh, progress) else {
        return;
    };
    let n = energy.inner.len();
    // The unknowns of the source come first, then those of the target.
    let precondition = |forces: &mut [f64]| {
        source.solve(&mut forces[..2 * n]);
        target.solve(&mut forces[2 * n..]);
    };
    let (points, _) = energy.minimise(steps, precondition, progress);
    mesh.move_to(points);
}

/// Returns two networks of springs, one for each design, that precondition the descent. Their
/// stiffness is the second derivative of the cost at fixed face areas. `None` if a stiffness matrix
/// is not positive definite, or on a cancel.
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
    // Each design has its own network. Second derivatives that couple the two designs are left out,
    // because with them the matrix might not be positive definite.
    Some([of(0)?, of(1)?])
}
