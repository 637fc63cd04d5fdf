//! Compliance of a mesh: displacement of all vertices when one vertex is pushed.
//!
//! The displacements solve a linear system whose right-hand side is the push. If its matrix were K,
//! the matrix of the motion's own energy, the pushed vertex would become a spike, because the
//! response of the plane to a point load is a logarithm. The matrix is therefore (K + μM) M⁻¹ (K +
//! μM), where M is the diagonal matrix of the vertex masses. The response is then a smooth dent,
//! whose width depends on μ, and a connected part can also be pushed away as a whole. A part that
//! exists in only one design is only pushed as a whole, because it is small and must not change its
//! shape.
//!
//! Connected parts do not affect each other, so each has a matrix of its own.

use crate::numerics::{Cholesky, CholeskyWorkspace, FactorError, SymmetricMatrix};
use crate::warp::Arap;
use std::collections::BTreeMap;

/// The factor μ of the masses in the matrix (K + μM) M⁻¹ (K + μM). Dents are about √(1/μ) times as
/// wide as the design (heuristic).
const LOCAL: f64 = 30.0;

/// Displacements of all vertices of a mesh when one vertex is pushed. They are computed separately
/// for each vertex that is pushed.
pub(super) struct MeshCompliance {
    parts: Vec<PartCompliance>,
    /// For each vertex, the index of its connected part, and its index in that part.
    places: Vec<(u32, u32)>,
    /// For each vertex that has been pushed, the displacements of the vertices of its part, as
    /// multiples of the push.
    columns: BTreeMap<u32, Vec<f64>>,
}

/// A connected part of a mesh.
struct PartCompliance {
    vertices: Vec<u32>,
    masses: Vec<f64>,
    /// The factored matrix K + μM; `None` for a part that exists in only one design.
    system: Option<(Cholesky, CholeskyWorkspace)>,
}

/// Displacements of the vertices of a connected part when one of them is pushed.
pub(super) struct PushResponse<'a> {
    /// Indices of the vertices in the mesh.
    pub(super) vertices: &'a [u32],
    /// Displacement of each of `vertices`, as a multiple of the push.
    pub(super) shares: &'a [f64],
}

impl MeshCompliance {
    pub(super) fn of(film: &Arap) -> Result<Self, FactorError> {
        let components = film.mesh().components();
        let count = components.iter().max().map_or(0, |&part| part as usize + 1);
        let mut vertices = vec![Vec::new(); count];
        let mut places = Vec::with_capacity(components.len());
        for (vertex, &part) in (0..).zip(&components) {
            let members: &mut Vec<u32> = &mut vertices[part as usize];
            places.push((part, members.len() as u32));
            members.push(vertex);
        }
        let mut entries = vec![Vec::new(); count];
        for (i, j, value) in film.free_system().entries() {
            let [(part, i), (other, j)] = [places[i as usize], places[j as usize]];
            debug_assert_eq!(part, other, "parts do not affect each other");
            entries[part as usize].push((i, j, value));
        }
        let is_transient = |part: usize| film.time_windows().get(part).is_some_and(Option::is_some);
        let parts = vertices.into_iter().zip(entries).enumerate();
        let parts = parts.map(|(part, (vertices, entries))| {
            let masses = vertices.iter().map(|&v| film.masses()[v as usize]);
            let masses: Vec<f64> = masses.collect();
            let system = match is_transient(part) {
                true => None,
                false => Some(factored(&masses, &entries)?),
            };
            Ok(PartCompliance {
                vertices,
                masses,
                system,
            })
        });
        Ok(Self {
            parts: parts.collect::<Result<_, _>>()?,
            places,
            columns: BTreeMap::new(),
        })
    }

    /// Computes the displacements when `vertex` is pushed, unless they have been computed already.
    pub(super) fn learn(&mut self, vertex: u32) {
        let (part, place) = self.places[vertex as usize];
        let part = &mut self.parts[part as usize];
        self.columns.entry(vertex).or_insert_with(|| {
            let Some((cholesky, workspace)) = &mut part.system else {
                let mass: f64 = part.masses.iter().sum();
                return vec![(LOCAL * LOCAL * mass).recip(); part.masses.len()];
            };
            let mut column = vec![0.0; part.masses.len()];
            column[place as usize] = 1.0;
            cholesky.solve_in_place(&mut column, workspace);
            column
                .iter_mut()
                .zip(&part.masses)
                .for_each(|(x, mass)| *x *= mass);
            cholesky.solve_in_place(&mut column, workspace);
            column
        });
    }

    /// Returns the displacements when `vertex` is pushed; `None` before [`Self::learn`] was called
    /// for it.
    pub(super) fn response(&self, vertex: u32) -> Option<PushResponse<'_>> {
        let (part, _) = self.places[vertex as usize];
        let shares = self.columns.get(&vertex)?;
        Some(PushResponse {
            vertices: &self.parts[part as usize].vertices,
            shares,
        })
    }

    /// Returns the displacement of `vertex` in the response to a push at `pushed`.
    pub(super) fn share(&self, response: &PushResponse, pushed: u32, vertex: u32) -> f64 {
        let (part, place) = self.places[vertex as usize];
        match part == self.places[pushed as usize].0 {
            true => response.shares[place as usize],
            false => 0.0,
        }
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.places.len()
    }
}

/// Factors the matrix K + μM of a part, where `entries` are those of K.
fn factored(
    masses: &[f64],
    entries: &[(u32, u32, f64)],
) -> Result<(Cholesky, CholeskyWorkspace), FactorError> {
    let mut matrix = SymmetricMatrix::zero(masses.len(), entries.len() + masses.len());
    for &(i, j, value) in entries {
        matrix.add(i, j, value);
    }
    for (v, mass) in (0..).zip(masses) {
        matrix.add(v, v, LOCAL * mass);
    }
    let cholesky = Cholesky::factor(&matrix)?;
    let workspace = cholesky.workspace(1);
    Ok((cholesky, workspace))
}
