//! Compliance of a mesh: displacement of all vertices when one vertex is pushed.
//!
//! The displacements solve a linear system whose right-hand side is the push. If its matrix were K,
//! the matrix of the motion's own energy, the pushed vertex would become a spike, because the
//! response of the plane to a point load is a logarithm. The matrix is therefore (K + μM) M⁻¹ (K +
//! μM), where M is the diagonal matrix of the vertex masses. The response is then a smooth dent,
//! whose width depends on μ, and a connected part can also be pushed away as a whole. A part that
//! exists in only one design is only pushed as a whole, because it is small and must not change its
//! shape.

use crate::numerics::{Cholesky, CholeskyWorkspace, FactorError};
use crate::warp::Arap;
use std::collections::BTreeMap;

/// The factor μ of the masses in the matrix (K + μM) M⁻¹ (K + μM). Dents are about √(1/μ) times as
/// wide as the design (heuristic).
const LOCAL: f64 = 30.0;

/// Displacements of all vertices of a mesh when one vertex is pushed. They are computed separately
/// for each vertex that is pushed.
pub(super) struct MeshCompliance {
    cholesky: Cholesky,
    workspace: CholeskyWorkspace,
    masses: Vec<f64>,
    /// For each vertex, the index of its connected part.
    parts: Vec<u32>,
    /// For each connected part, whether it exists in only one design.
    living: Vec<bool>,
    /// For each vertex that has been pushed, the displacements of all vertices, as multiples of the
    /// push.
    columns: BTreeMap<u32, Vec<f64>>,
}

impl MeshCompliance {
    pub(super) fn of(film: &Arap) -> Result<Self, FactorError> {
        let living = film.time_windows().iter().map(Option::is_some).collect();
        let masses = film.masses().to_vec();
        let mut matrix = film.free_system();
        for (v, &mass) in masses.iter().enumerate() {
            matrix.add(v as u32, v as u32, LOCAL * mass);
        }
        let cholesky = Cholesky::factor(&matrix)?;
        Ok(Self {
            workspace: cholesky.workspace(1),
            cholesky,
            masses,
            parts: film.mesh().components(),
            living,
            columns: BTreeMap::new(),
        })
    }

    /// Computes the displacements of all vertices when `vertex` is pushed, unless they have been
    /// computed already.
    pub(super) fn learn(&mut self, vertex: u32) {
        if self.columns.contains_key(&vertex) {
            return;
        }
        let mut column = vec![0.0; self.masses.len()];
        let part = self.parts[vertex as usize];
        if self.living.get(part as usize) == Some(&true) {
            let whole = || self.parts.iter().enumerate().filter(|(_, of)| **of == part);
            let mass: f64 = whole().map(|(v, _)| self.masses[v]).sum();
            whole().for_each(|(v, _)| column[v] = (LOCAL * LOCAL * mass).recip());
            self.columns.insert(vertex, column);
            return;
        }
        column[vertex as usize] = 1.0;
        self.cholesky
            .solve_in_place(&mut column, &mut self.workspace);
        column
            .iter_mut()
            .zip(&self.masses)
            .for_each(|(x, m)| *x *= m);
        self.cholesky
            .solve_in_place(&mut column, &mut self.workspace);
        self.columns.insert(vertex, column);
    }

    /// Returns the displacement of each vertex, as a multiple of the push at `vertex`; `None`
    /// before [`Self::learn`] was called for it.
    pub(super) fn response(&self, vertex: u32) -> Option<&[f64]> {
        self.columns.get(&vertex).map(Vec::as_slice)
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.masses.len()
    }
}
