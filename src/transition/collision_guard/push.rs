//! The smallest displacement that keeps so much apart.
//!
//! min ½ |D|² in the energy of the mesh, C D ≥ b. By its dual, min ½ λᵀ A λ − bᵀ λ with
//! λ ≥ 0 and A = C G Cᵀ, G the response of the mesh: as many unknowns as there are
//! contacts, solved one after the other, over and over (projected Gauss–Seidel), which
//! converges since A is symmetric and not negative. The same in any order of threads.

use super::compliance::MeshCompliance;
use crate::geometry::DVec2;

/// Σ g · D over some vertices is to be `least` or more.
#[derive(Clone, Debug)]
pub(super) struct ContactConstraint {
    pub terms: Vec<(u32, DVec2)>,
    pub least: f64,
}

/// Contacts that push at one moment; what has more is a collision of the whole.
const MOST: usize = 600;

/// Sweeps over all contacts at most.
const SWEEPS: u32 = 400;

/// How often contacts are added that a displacement has run into.
const ADDED: u32 = 12;

/// What each vertex moves by; none where there are too many contacts. Contacts are met
/// to `tolerance`, as far as they can be met.
pub(super) fn smallest(
    rows: &[ContactConstraint],
    yielding: &mut MeshCompliance,
    tolerance: f64,
) -> Option<Vec<DVec2>> {
    let mut moved = vec![DVec2::ZERO; yielding.vertex_count()];
    // Most of what is near is neither in the way nor comes to be.
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
                let response = yielding.response(vertex).unwrap_or_default();
                let all = moved.iter_mut().zip(response);
                all.for_each(|(moved, share)| *moved += direction * (by * *share));
            }
        }
    }
    Some(moved)
}

/// A = C G Cᵀ, row by row.
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
                    .map(|&(v, along)| direction.dot(along) * response[v as usize])
                    .sum::<f64>();
            }
        }
    }
    a
}

fn multipliers(rows: &[&ContactConstraint], a: &[f64], tolerance: f64) -> Vec<f64> {
    let n = rows.len();
    let mut lambda = vec![0.0; n];
    // What C D is so far.
    let mut reached = vec![0.0; n];
    for _ in 0..SWEEPS {
        let mut off: f64 = 0.0;
        for i in 0..n {
            let own = a[i * n + i];
            // Nothing gives way.
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
