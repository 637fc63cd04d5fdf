//! Numerical methods: linear algebra, L-BFGS minimisation (`lbfgs`) and the assignment problem
//! (`assignment`). No other module uses `faer`.
//!
//! [`Cholesky`] factors a sparse symmetric positive definite matrix once and then solves with it
//! for every frame of an animation. [`PatternCholesky`] is for sparse matrices whose values change
//! while the pattern of their entries stays the same, [`DenseLu`] is for small dense systems that
//! are factored for every frame of an animation, and [`symmetric_eigen`] is for the eigenvectors of
//! small symmetric matrices.
//!
//! A [`Cholesky`] uses a fill-reducing permutation (approximate minimum degree) and a simplicial
//! LLᵀ factorisation, or a supernodal one for large systems. [`Cholesky::solve_ordered`] works in
//! elimination order, so callers that assemble right-hand sides in that order pay for no
//! permutation. It allocates nothing and cannot fail. Each call uses a single thread, because
//! triangular solves get slower on several threads.

pub(crate) mod assignment;
mod dense_lu;
mod eigen;
pub(crate) mod lbfgs;
mod pattern_cholesky;

pub use dense_lu::DenseLu;
pub use eigen::symmetric_eigen;
pub use pattern_cholesky::{PatternCholesky, PatternWorkspace};

use crate::work::progress::{Cancelled, Progress, check_cancelled, run_cancellable};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::simplicial::SimplicialLltRef;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Side};

/// Symmetric matrix to which entries can be added; entries at the same row and column add up.
#[derive(Clone, Debug)]
pub struct SymmetricMatrix {
    /// Number of rows and of columns.
    n: usize,
    /// Entries as added: (row, column, value) with row ≥ column.
    lower: Vec<Triplet<u32, u32, f64>>,
}

impl SymmetricMatrix {
    /// Creates the n×n zero matrix, with room for `entries` calls of [`Self::add`].
    #[must_use]
    pub fn zero(n: usize, entries: usize) -> Self {
        Self {
            n,
            lower: Vec::with_capacity(entries),
        }
    }

    /// Returns the number of rows, which equals the number of columns.
    #[must_use]
    pub fn size(&self) -> usize {
        self.n
    }

    /// Adds `value` at (i, j) and, by symmetry, at (j, i). On the diagonal it is added once.
    pub fn add(&mut self, i: u32, j: u32, value: f64) {
        // The factorisation reads only the lower triangle.
        self.lower.push(Triplet::new(i.max(j), i.min(j), value));
    }

    /// Returns the entries as added: row, column and value, with row ≥ column.
    pub fn entries(&self) -> impl Iterator<Item = (u32, u32, f64)> + '_ {
        self.lower
            .iter()
            .map(|entry| (entry.row, entry.col, entry.val))
    }

    /// Increases each entry of the diagonal by the fraction `share` of itself.
    pub fn stiffen(&mut self, share: f64) {
        for entry in &mut self.lower {
            if entry.row == entry.col {
                entry.val *= 1.0 + share;
            }
        }
    }
}

/// Minimum number of unknowns for which columns are factored in dense blocks. For such large
/// systems, blocks make factoring several times faster and each solve somewhat slower (heuristic).
const SUPERNODAL_FROM: usize = 200_000;

/// Returns the kind of factorisation for a system with this many unknowns: supernodal (in dense
/// blocks) or simplicial (column by column).
const fn in_blocks(unknowns: usize) -> SupernodalThreshold {
    if unknowns >= SUPERNODAL_FROM {
        SupernodalThreshold::FORCE_SUPERNODAL
    } else {
        SupernodalThreshold::FORCE_SIMPLICIAL
    }
}

/// Minimum number of unknowns for which a factorisation runs on another thread, so that it can be
/// cancelled at once (heuristic: factoring the linear system of a warp with so many vertices takes
/// about 50 ms).
const BACKGROUND_FROM: usize = 20_000;

/// Reason why a matrix could not be factored.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FactorError {
    /// A pivot is zero, negative or NaN.
    #[error(
        "the system is not positive definite at unknown {index}; some face is too thin to compute with"
    )]
    NotPositiveDefinite {
        /// Index of the unknown, in the caller's numbering.
        index: usize,
    },
    /// The factorisation does not fit into memory.
    #[error("the factorisation does not fit into memory; use a coarser mesh")]
    OutOfMemory,
}

/// Cholesky factorisation of a symmetric positive definite matrix.
pub struct Cholesky {
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f64>,
    /// Position of each unknown in elimination order.
    place: Vec<u32>,
}

/// Scratch memory for [`Cholesky::solve_ordered`] and [`Cholesky::solve_in_place`].
pub struct CholeskyWorkspace(MemBuffer);

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cholesky")
            .field("size", &self.place.len())
            .field("entries", &self.values.len())
            .finish()
    }
}

impl std::fmt::Debug for CholeskyWorkspace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Workspace")
    }
}

impl Cholesky {
    /// Factors the matrix, which takes much longer than a solve.
    ///
    /// # Errors
    /// [`FactorError`] if the matrix is not positive definite or too large.
    ///
    /// ```
    /// use morphospace::numerics::{Cholesky, SymmetricMatrix};
    /// let mut a = SymmetricMatrix::zero(2, 3);
    /// a.add(0, 0, 4.0);
    /// a.add(1, 1, 2.0);
    /// a.add(0, 1, 1.0);
    /// let x = Cholesky::factor(&a)?.solve(&[5.0, 3.0]);
    /// assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 1.0).abs() < 1e-15);
    /// # Ok::<(), morphospace::numerics::FactorError>(())
    /// ```
    pub fn factor(matrix: &SymmetricMatrix) -> Result<Self, FactorError> {
        Self::factored(matrix, in_blocks(matrix.size()))
    }

    /// As [`Self::factor`], but can be cancelled while it runs.
    ///
    /// # Errors
    /// [`Cancelled`] if the work was cancelled; the inner result is that of [`Self::factor`].
    pub fn factor_cancellable(
        matrix: &SymmetricMatrix,
        progress: &dyn Progress,
    ) -> Result<Result<Self, FactorError>, Cancelled> {
        check_cancelled(progress)?;
        if matrix.size() < BACKGROUND_FROM {
            return Ok(Self::factor(matrix));
        }
        // The thread owns a copy of the matrix, because after a cancel the thread outlives this
        // call.
        let matrix = matrix.clone();
        run_cancellable(progress, move || Self::factor(&matrix))
    }

    /// Factors the matrix; `supernodal_from` selects a simplicial factorisation (column by column)
    /// or a supernodal one (in dense blocks).
    fn factored(
        matrix: &SymmetricMatrix,
        supernodal_from: SupernodalThreshold,
    ) -> Result<Self, FactorError> {
        let n = matrix.n;
        let lower = SparseColMat::<u32, f64>::try_new_from_triplets(n, n, &matrix.lower)
            .map_err(|_| FactorError::OutOfMemory)?;
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: supernodal_from,
            ..CholeskySymbolicParams::default()
        };
        let symbolic = factorize_symbolic_cholesky(
            lower.symbolic(),
            Side::Lower,
            SymmetricOrdering::Amd,
            params,
        )
        .map_err(|_| FactorError::OutOfMemory)?;
        // Take the inverse permutation, from unknowns to positions in elimination order. Without a
        // permutation, it is the identity.
        let place = match symbolic.perm() {
            Some(perm) => perm.arrays().1.to_vec(),
            None => (0..n as u32).collect(),
        };
        let mut factored = Self {
            values: vec![0.0; symbolic.len_val()],
            symbolic,
            place,
        };
        factored.factor_values(&lower)?;
        Ok(factored)
    }

    /// Computes the values of the Cholesky factor from the lower triangle of the matrix.
    fn factor_values(&mut self, lower: &SparseColMat<u32, f64>) -> Result<(), FactorError> {
        let request = self
            .symbolic
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(request).map_err(|_| FactorError::OutOfMemory)?;
        let result = self.symbolic.factorize_numeric_llt(
            &mut self.values,
            lower.as_ref(),
            Side::Lower,
            // Regularisation is off: the caller gets the error and may stiffen the matrix.
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        match result {
            Ok(_) => Ok(()),
            // The library counts pivots from 1.
            Err(LltError::NonPositivePivot { index }) => {
                let place = index.saturating_sub(1);
                let unknown = self.place.iter().position(|&p| p as usize == place);
                let index = unknown.unwrap_or(place);
                Err(FactorError::NotPositiveDefinite { index })
            }
        }
    }

    /// Returns the number of unknowns.
    #[must_use]
    pub fn size(&self) -> usize {
        self.place.len()
    }

    /// Returns the position of each unknown in elimination order. [`Self::solve_ordered`] takes
    /// right-hand sides and returns solutions in this order.
    #[must_use]
    pub fn elimination_places(&self) -> &[u32] {
        &self.place
    }

    /// Allocates scratch memory for [`Self::solve_ordered`] with the given number of right-hand
    /// sides.
    #[must_use]
    pub fn workspace(&self, columns: usize) -> CholeskyWorkspace {
        let request = self
            .symbolic
            .solve_in_place_scratch::<f64>(columns, Par::Seq);
        CholeskyWorkspace(MemBuffer::new(request))
    }

    /// Solves in place for all right-hand sides in `rhs`, which are stored one after the other,
    /// each in elimination order.
    ///
    /// # Panics
    /// If the length of `rhs` is not a multiple of [`Self::size`], or if the workspace was made for
    /// fewer columns or for another matrix.
    pub fn solve_ordered(&self, rhs: &mut [f64], workspace: &mut CholeskyWorkspace) {
        let Some(rhs) = self.columns(rhs) else {
            return;
        };
        let stack = MemStack::new(&mut workspace.0);
        // The library's own solve would permute the right-hand side to elimination order, and the
        // solution back.
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(symbolic) => {
                SimplicialLltRef::new(symbolic, &self.values).solve_in_place_with_conj(
                    Conj::No,
                    rhs,
                    Par::Seq,
                    stack,
                );
            }
            SymbolicCholeskyRaw::Supernodal(symbolic) => {
                SupernodalLltRef::new(symbolic, &self.values).solve_in_place_with_conj(
                    Conj::No,
                    rhs,
                    Par::Seq,
                    stack,
                );
            }
        }
    }

    /// As [`Self::solve_ordered`], but with right-hand sides and solutions in the caller's
    /// numbering.
    ///
    /// # Panics
    /// As [`Self::solve_ordered`].
    pub fn solve_in_place(&self, rhs: &mut [f64], workspace: &mut CholeskyWorkspace) {
        let Some(rhs) = self.columns(rhs) else {
            return;
        };
        let stack = MemStack::new(&mut workspace.0);
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            rhs,
            Par::Seq,
            stack,
        );
    }

    /// Returns the right-hand sides as columns of a matrix; `None` if there are no unknowns.
    fn columns<'a>(&self, rhs: &'a mut [f64]) -> Option<MatMut<'a, f64>> {
        let n = self.size();
        let columns = rhs.len().checked_div(n)?;
        assert_eq!(rhs.len() % n, 0, "right-hand sides have the matrix's size");
        Some(MatMut::from_column_major_slice_mut(rhs, n, columns))
    }

    /// Solves for one right-hand side in the caller's numbering. Allocates.
    ///
    /// # Panics
    /// If the length of `rhs` is not [`Self::size`].
    #[must_use]
    pub fn solve(&self, rhs: &[f64]) -> Vec<f64> {
        assert_eq!(rhs.len(), self.size());
        let mut solution = rhs.to_vec();
        self.solve_in_place(&mut solution, &mut self.workspace(1));
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the solution by plain Gaussian elimination (oracle).
    fn dense_solve(a: &SymmetricMatrix, rhs: &[f64]) -> Vec<f64> {
        let n = a.size();
        let mut columns = vec![vec![0.0; n]; n];
        for (i, j, value) in a.entries() {
            let (i, j) = (i as usize, j as usize);
            columns[j][i] += value;
            if i != j {
                columns[i][j] += value;
            }
        }
        let mut m: Vec<Vec<f64>> = (0..n)
            .map(|i| columns.iter().map(|c| c[i]).chain([rhs[i]]).collect())
            .collect();
        for k in 0..n {
            let pivot = m[k].clone();
            for row in m.iter_mut().skip(k + 1) {
                let factor = row[k] / pivot[k];
                row.iter_mut()
                    .zip(&pivot)
                    .for_each(|(x, p)| *x -= factor * p);
            }
        }
        let mut x = vec![0.0; n];
        for k in (0..n).rev() {
            let sum: f64 = (k + 1..n).map(|j| m[k][j] * x[j]).sum();
            x[k] = (m[k][n] - sum) / m[k][k];
        }
        x
    }

    /// Returns the Laplacian of a graph with weighted edges, plus 0.1 on the diagonal.
    fn laplacian(n: usize, edges: &[(usize, usize, f64)]) -> SymmetricMatrix {
        let mut a = SymmetricMatrix::zero(n, 4 * edges.len());
        for i in 0..n as u32 {
            a.add(i, i, 0.1);
        }
        for &(i, j, w) in edges {
            let (i, j) = ((i % n) as u32, (j % n) as u32);
            if i != j {
                a.add(i, i, w);
                a.add(j, j, w);
                a.add(i, j, -w);
            }
        }
        a
    }

    proptest! {
        #[test]
        fn both_factors_equal_dense_elimination(
            n in 1usize..20,
            edges in prop::collection::vec((0usize..20, 0usize..20, 0.1f64..10.0), 0..40),
            rhs in prop::collection::vec(-1.0f64..1.0, 20),
        ) {
            let a = laplacian(n, &edges);
            let slow = dense_solve(&a, &rhs[..n]);
            for from in [SupernodalThreshold::FORCE_SIMPLICIAL, SupernodalThreshold::FORCE_SUPERNODAL] {
                let fast = Cholesky::factored(&a, from).expect("positive definite").solve(&rhs[..n]);
                for (x, y) in fast.iter().zip(&slow) {
                    prop_assert!((x - y).abs() < 1e-10, "{x} {y}");
                }
            }
        }
    }

    #[test]
    fn an_indefinite_matrix_is_refused() {
        let mut a = SymmetricMatrix::zero(2, 2);
        a.add(0, 0, 1.0);
        a.add(1, 1, -1.0);
        assert_eq!(
            Cholesky::factor(&a).map(|_| ()),
            Err(FactorError::NotPositiveDefinite { index: 1 })
        );
    }
}
