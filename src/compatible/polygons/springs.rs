//! Network of springs along the edges of a mesh. Its stiffness matrix preconditions the
//! minimisation of a cost of the mesh: the number of minimisation steps then does not grow with the
//! mesh (Kovalsky, Galun, Lipman 2016, "Accelerated quadratic proxy for geometric optimization").

use crate::numerics::{Cholesky, CholeskyWorkspace, SymmetricMatrix};
use crate::work::progress::Progress;

/// Number added to each diagonal entry of the stiffness matrix, as a fraction of the mean stiffness
/// per movable vertex (tolerance: keeps the matrix positive definite where springs of positive and
/// negative stiffness cancel; small enough that descent steps hardly shorten, and far above
/// rounding).
const REGULARISATION: f64 = 1e-6;

/// Stiffness matrix of a network of springs, in factored form.
pub(super) struct Springs {
    factor: Cholesky,
    workspace: CholeskyWorkspace,
}

impl Springs {
    /// Assembles and factors the stiffness matrix of springs, each given by its two ends and its
    /// stiffness. The unknowns are the positions of the `movable` vertices, in ascending order; all
    /// other vertices are fixed. `None` if the matrix is not positive definite, or on a cancel.
    pub(super) fn new(
        movable: &[u32],
        springs: impl Iterator<Item = ([u32; 2], f64)>,
        progress: &dyn Progress,
    ) -> Option<Self> {
        let unknown = |v: u32| movable.binary_search(&v).ok().map(|i| i as u32);
        let mut matrix = SymmetricMatrix::zero(movable.len(), 16 * movable.len());
        let mut sum = 0.0;
        for (ends, stiffness) in springs {
            // Absolute values are added, because a spring opposite an obtuse corner has negative
            // stiffness.
            sum += stiffness.abs();
            let ends = ends.map(unknown);
            for v in ends.into_iter().flatten() {
                matrix.add(v, v, stiffness);
            }
            if let [Some(a), Some(b)] = ends {
                matrix.add(a, b, -stiffness);
            }
        }
        let regularisation = REGULARISATION * sum / movable.len().max(1) as f64;
        for v in 0..movable.len() as u32 {
            matrix.add(v, v, regularisation);
        }
        let factor = Cholesky::factor_cancellable(&matrix, progress).ok()?.ok()?;
        let workspace = factor.workspace(2);
        Some(Self { factor, workspace })
    }

    /// Replaces `forces`, the right-hand side of a linear system with the stiffness matrix, by the
    /// solution of the system. The list contains all x components, then all y components.
    pub(super) fn solve(&mut self, forces: &mut [f64]) {
        self.factor.solve_in_place(forces, &mut self.workspace);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::progress::Silent;

    #[test]
    fn a_chain_of_springs_is_stretched_evenly() {
        let links = [[0, 1], [1, 2], [2, 3]].map(|ends| (ends, 1.0));
        let mut springs = Springs::new(&[1, 2], links.into_iter(), &Silent).expect("held");
        let mut forces = [0.0, 3.0, 3.0, 0.0];
        springs.solve(&mut forces);
        for (found, exact) in forces.into_iter().zip([1.0, 2.0, 2.0, 1.0]) {
            assert!((found - exact).abs() < 1e-4, "{found} {exact}");
        }
    }
}
