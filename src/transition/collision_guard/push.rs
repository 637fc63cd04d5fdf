//! The smallest displacement that satisfies all contact constraints.
//!
//! Solves min ½ |D|² subject to C D ≥ b for the displacements D. The contact constraints are the
//! rows of C D ≥ b, and |D| is measured in the energy of the mesh. The dual problem is min ½ λᵀ A λ
//! − bᵀ λ subject to λ ≥ 0, with A = C G Cᵀ and the compliance G of the mesh. The dual problem has
//! one unknown λ per contact. It is solved by projected Gauss–Seidel iteration, which converges
//! because A is symmetric and positive semidefinite. The result does not depend on the number of
//! threads.

use super::compliance::MeshCompliance;
use crate::geometry::DVec2;

/// The constraint Σ g · D ≥ `least` on the displacements D of some vertices; `terms` holds each
/// vertex with its vector g.
#[derive(Clone, Debug)]
pub(super) struct ContactConstraint {
    pub terms: Vec<(u32, DVec2)>,
    pub least: f64,
}

/// Maximum number of active constraints, that is, those that some displacement so far has violated
/// (resource limit; more of them mean that whole shapes collide).
const MOST: usize = 600;

/// Maximum number of Gauss–Seidel sweeps over all active constraints (resource limit).
const SWEEPS: u32 = 400;

/// Maximum number of times that the constraints violated by the displacements so far become active
/// and the displacements are computed again (resource limit).
const ADDED: u32 = 12;

/// Returns the smallest displacement of each vertex that satisfies the constraints `rows` within
/// `tolerance`, as far as they can be satisfied; `None` if too many are active.
pub(super) fn smallest(
    rows: &[ContactConstraint],
    yielding: &mut MeshCompliance,
    tolerance: f64,
) -> Option<Vec<DVec2>> {
    let mut moved = vec![DVec2::ZERO; yielding.vertex_count()];
    // Most constraints are never violated, so only violated ones become active.
    let mut pushing = vec![false; rows.len()];
    for _ in 0..ADDED {
        let mut is_more = false;
        for (row, pushes) in rows.iter().zip(&mut pushing) {
            let reached: f64 = row
                .terms
                .iter()
                .map(|&(v, along)| along.dot(moved[v as usize]))
                .sum();
            if !*pushes && reached < row.least - tolerance {
                *pushes = true;
                is_more = true;
            }
        }
        if !is_more {
            break;
        }
        let among = rows.iter().zip(&pushing).filter(|(_, pushes)| **pushes);
        let among: Vec<&ContactConstraint> = among.map(|(row, _)| row).collect();
        if among.len() > MOST {
            return None;
        }
        let terms = among.iter().flat_map(|row| &row.terms);
        terms.for_each(|&(vertex, _)| yielding.learn(vertex));
        let lambda = multipliers(&among, &products(&among, yielding), tolerance);
        moved.fill(DVec2::ZERO);
        for (row, by) in among.iter().zip(lambda).filter(|(_, by)| *by != 0.0) {
            for &(vertex, direction) in &row.terms {
                let Some(response) = yielding.response(vertex) else {
                    continue;
                };
                for (&v, share) in response.vertices.iter().zip(response.shares) {
                    moved[v as usize] += direction * (by * share);
                }
            }
        }
    }
    Some(moved)
}

/// Returns the matrix A = C G Cᵀ of the dual problem, row by row. The rows of C are the constraints
/// `rows`, and G is the compliance of the mesh.
fn products(rows: &[&ContactConstraint], yielding: &MeshCompliance) -> Vec<f64> {
    let n = rows.len();
    let mut a = vec![0.0; n * n];
    for (i, row) in rows.iter().enumerate() {
        for &(vertex, direction) in &row.terms {
            let Some(response) = yielding.response(vertex) else {
                continue;
            };
            for (j, other) in rows.iter().enumerate() {
                let terms = other.terms.iter();
                a[i * n + j] += terms
                    .map(|&(v, along)| direction.dot(along) * yielding.share(&response, vertex, v))
                    .sum::<f64>();
            }
        }
    }
    a
}

fn multipliers(rows: &[&ContactConstraint], a: &[f64], tolerance: f64) -> Vec<f64> {
    let n = rows.len();
    let mut lambda = vec![0.0; n];
    // Left-hand side of each constraint for the displacements that the current multipliers cause.
    let mut reached = vec![0.0; n];
    for _ in 0..SWEEPS {
        let mut off: f64 = 0.0;
        for i in 0..n {
            let own = a[i * n + i];
            // A push at this contact moves no vertex, so no multiplier can satisfy the constraint.
            if own <= 0.0 {
                continue;
            }
            let short = rows[i].least - reached[i];
            let next = f64::max(0.0, lambda[i] + short / own);
            let change = next - lambda[i];
            if change == 0.0 {
                continue;
            }
            off = off.max((change * own).abs());
            lambda[i] = next;
            let column = &a[i * n..][..n];
            let all = reached.iter_mut().zip(column);
            all.for_each(|(reached, by)| *reached += change * by);
        }
        if off < tolerance {
            break;
        }
    }
    lambda
}
