//! Springs along the edges of a mesh: the sparse matrix that says how a
//! minimisation's steps are to be measured, so that their number does not
//! grow with the mesh (Kovalsky, Galun, Lipman 2016, "Accelerated quadratic
//! proxy for geometric optimization").

use crate::linalg::{Cholesky, FactorError, SymmetricMatrix, Workspace};

/// Share of the mean stiffness that holds each vertex on its own: keeps the
/// matrix definite where springs cancel.
const HELD: f64 = 1e-6;

pub(super) struct Springs {
    factor: Cholesky,
    workspace: Workspace,
    ordered: Vec<f64>,
}

impl Springs {
    /// From springs between vertices, with their stiffness; `None` stands for
    /// what does not move.
    pub(super) fn new(
        vertices: usize,
        springs: impl Iterator<Item = ([Option<u32>; 2], f64)>,
    ) -> Result<Self, FactorError> {
        let mut matrix = SymmetricMatrix::zero(vertices, 16 * vertices);
        let mut sum = 0.0;
        for ([a, b], stiffness) in springs {
            sum += stiffness.abs();
            for v in [a, b].into_iter().flatten() {
                matrix.add(v, v, stiffness);
            }
            if let (Some(a), Some(b)) = (a, b) {
                matrix.add(a, b, -stiffness);
            }
        }
        let held = HELD * sum / vertices.max(1) as f64;
        for v in 0..vertices as u32 {
            matrix.add(v, v, held);
        }
        let factor = Cholesky::factor(&matrix)?;
        Ok(Self {
            workspace: factor.workspace(2),
            ordered: vec![0.0; 2 * vertices],
            factor,
        })
    }

    /// Forces along both axes, all of x first, become displacements.
    pub(super) fn solve(&mut self, forces: &mut [f64]) {
        let n = self.factor.size();
        for axis in 0..2 {
            let place = self.factor.place_in_order().iter();
            for (&place, &force) in place.zip(&forces[axis * n..]) {
                self.ordered[axis * n + place as usize] = force;
            }
        }
        self.factor
            .solve_ordered(&mut self.ordered, &mut self.workspace);
        for axis in 0..2 {
            let place = self.factor.place_in_order().iter();
            for (&place, force) in place.zip(&mut forces[axis * n..]) {
                *force = self.ordered[axis * n + place as usize];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_of_springs_is_stretched_evenly() {
        let links = [
            ([None, Some(0)], 1.0),
            ([Some(0), Some(1)], 1.0),
            ([Some(1), None], 1.0),
        ];
        let mut springs = Springs::new(2, links.into_iter()).expect("held");
        let mut forces = [0.0, 3.0, 3.0, 0.0];
        springs.solve(&mut forces);
        for (found, exact) in forces.into_iter().zip([1.0, 2.0, 2.0, 1.0]) {
            assert!((found - exact).abs() < 1e-4, "{found} {exact}");
        }
    }
}
