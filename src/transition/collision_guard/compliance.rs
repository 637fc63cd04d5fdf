//! How a mesh gives way where it is pushed.
//!
//! By the film's own energy K a point that is pushed draws a spike, since the response
//! to a point load in the plane is a logarithm. With (K + μM) M⁻¹ (K + μM) instead, M
//! the masses of the vertices, it is a smooth dent, which ends where μ says, and a part
//! may also be pushed away as a whole. What comes or goes is only pushed as a whole: it is
//! small, and its form is its design's.

use crate::numerics::{Cholesky, CholeskyWorkspace, FactorError};
use crate::warp::Arap;
use std::collections::BTreeMap;

/// μ: dents are some √(1/μ) as wide as the design.
const LOCAL: f64 = 30.0;

/// The responses of a mesh to pushes at its vertices, as far as they were asked for.
pub(super) struct MeshCompliance {
    cholesky: Cholesky,
    workspace: CholeskyWorkspace,
    masses: Vec<f64>,
    /// The connected part of each vertex.
    parts: Vec<u32>,
    /// Of each part whether it comes or goes.
    living: Vec<bool>,
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

    /// Learns how all vertices move where one is pushed.
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

    /// How all vertices move where one is pushed; none where that was not learnt.
    pub(super) fn response(&self, vertex: u32) -> Option<&[f64]> {
        self.columns.get(&vertex).map(Vec::as_slice)
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.masses.len()
    }
}
