//! Sparse symmetric positive definite systems that are factored once and
//! solved in every frame; in `pattern`, those whose values change while their
//! entries stay where they are; in `dense`, small full ones that are factored in
//! every frame, and in `eigen` their axes. The only place that names `faer`.
//!
//! A [`Cholesky`] is made by a fill-reducing permutation (approximate minimum
//! degree) and a simplicial LLᵀ factorisation, or a supernodal one where it is
//! large. [`Cholesky::solve_ordered`] works in elimination
//! order, allocates nothing and cannot fail, so that callers who assemble in
//! that order pay for no permutation. Everything runs on the calling thread:
//! triangular solves get slower, not faster, on several.

pub(crate) mod assignment;
mod dense_lu;
mod eigen;
pub(crate) mod lbfgs;
mod pattern_cholesky;

pub use dense_lu::DenseLu;
pub use eigen::symmetric_eigen;
pub use pattern_cholesky::{PatternCholesky, PatternWorkspace};

use crate::work::progress::{Cancelled, Progress, beside, still_wanted};
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

/// A symmetric matrix under assembly: entries at equal places add up.
#[derive(Clone, Debug)]
pub struct SymmetricMatrix {
    n: usize,
    /// (row, column, value) with row ≥ column.
    lower: Vec<Triplet<u32, u32, f64>>,
}

impl SymmetricMatrix {
    /// The n×n zero matrix, with room for `entries` additions.
    #[must_use]
    pub fn zero(n: usize, entries: usize) -> Self {
        Self {
            n,
            lower: Vec::with_capacity(entries),
        }
    }

    /// How many rows and columns there are.
    #[must_use]
    pub fn size(&self) -> usize {
        self.n
    }

    /// Adds `value` at (i, j), and by symmetry at (j, i); once on the diagonal.
    pub fn add(&mut self, i: u32, j: u32, value: f64) {
        // The lower triangle: it is what the factorisation is told to read.
        self.lower.push(Triplet::new(i.max(j), i.min(j), value));
    }

    /// What was added: row, column and value, the row at least the column.
    pub fn entries(&self) -> impl Iterator<Item = (u32, u32, f64)> + '_ {
        self.lower
            .iter()
            .map(|entry| (entry.row, entry.col, entry.val))
    }

    /// Makes each entry of the diagonal larger by this share of itself.
    pub fn stiffen(&mut self, share: f64) {
        for entry in &mut self.lower {
            if entry.row == entry.col {
                entry.val *= 1.0 + share;
            }
        }
    }
}

/// Unknowns from which on columns are factored in dense blocks. Of a sheet of
/// 250,000 vertices that takes 0.45 s instead of 1.4 s, of a million 2.2 s
/// instead of 12 s; two right-hand sides are then solved a third and a fifth
/// slower on a busy machine (54 ms instead of 40, 237 instead of 200), and a whole
/// frame of a million in 284 ms instead of 155 on a quiet one
/// (`cargo bench --bench film`), which the few solves of a film repay. With 100,000 vertices what is saved (0.2 s) is no longer felt,
/// and each solve takes half as long again.
const BLOCKS_FROM: usize = 200_000;

/// Whether the columns of so many unknowns are factored in dense blocks.
const fn in_blocks(unknowns: usize) -> SupernodalThreshold {
    if unknowns >= BLOCKS_FROM {
        SupernodalThreshold::FORCE_SUPERNODAL
    } else {
        SupernodalThreshold::FORCE_SIMPLICIAL
    }
}

/// Unknowns from which on a factorisation runs beside: a mesh of so many
/// vertices takes some 50 ms.
const BESIDE_FROM: usize = 20_000;

/// Why a matrix could not be factored.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FactorError {
    /// A pivot is zero, negative or NaN.
    #[error(
        "the system is not positive definite at unknown {index}; some face is too thin to compute with"
    )]
    NotPositiveDefinite {
        /// The unknown, in the caller's numbering.
        index: usize,
    },
    /// The factor does not fit into memory.
    #[error("the factorisation does not fit into memory; use a coarser mesh")]
    OutOfMemory,
}

/// A factored matrix.
pub struct Cholesky {
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f64>,
    /// For each unknown its place in elimination order.
    place: Vec<u32>,
}

/// The memory that [`Cholesky::solve_ordered`] works in.
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
    /// Factors the matrix: the expensive step.
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

    /// As [`Self::factor`], and a cancel is answered while it goes on.
    ///
    /// # Errors
    /// [`Cancelled`] if nobody wants the result any more; what
    /// [`Self::factor`] finds is within.
    pub fn factor_if_wanted(
        matrix: &SymmetricMatrix,
        progress: &dyn Progress,
    ) -> Result<Result<Self, FactorError>, Cancelled> {
        still_wanted(progress)?;
        if matrix.size() < BESIDE_FROM {
            return Ok(Self::factor(matrix));
        }
        let matrix = matrix.clone();
        beside(progress, move || Self::factor(&matrix))
    }

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
        // The ways back, from unknowns to places; no permutation is the identity.
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

    fn factor_values(&mut self, lower: &SparseColMat<u32, f64>) -> Result<(), FactorError> {
        let request = self
            .symbolic
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(request).map_err(|_| FactorError::OutOfMemory)?;
        let result = self.symbolic.factorize_numeric_llt(
            &mut self.values,
            lower.as_ref(),
            Side::Lower,
            // None: who asks is told, and may stiffen the matrix.
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

    /// How many unknowns there are.
    #[must_use]
    pub fn size(&self) -> usize {
        self.place.len()
    }

    /// For each unknown its place in elimination order, as
    /// [`Self::solve_ordered`] wants right-hand sides and leaves solutions.
    #[must_use]
    pub fn place_in_order(&self) -> &[u32] {
        &self.place
    }

    /// Memory for [`Self::solve_ordered`] with so many right-hand sides.
    #[must_use]
    pub fn workspace(&self, columns: usize) -> CholeskyWorkspace {
        let request = self
            .symbolic
            .solve_in_place_scratch::<f64>(columns, Par::Seq);
        CholeskyWorkspace(MemBuffer::new(request))
    }

    /// Solves in place for as many right-hand sides as fit into `rhs`, which
    /// holds them one after the other, each in elimination order.
    ///
    /// # Panics
    /// If the length of `rhs` is no multiple of [`Self::size`], or if the
    /// workspace was made for fewer columns or for another matrix.
    pub fn solve_ordered(&self, rhs: &mut [f64], workspace: &mut CholeskyWorkspace) {
        let Some(rhs) = self.columns(rhs) else {
            return;
        };
        let stack = MemStack::new(&mut workspace.0);
        // The library's own solve would permute there and back.
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

    /// As [`Self::solve_ordered`], but right-hand sides and solutions are in
    /// the caller's numbering.
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

    /// Right-hand sides beside each other; none where there are no unknowns.
    fn columns<'a>(&self, rhs: &'a mut [f64]) -> Option<MatMut<'a, f64>> {
        let n = self.size();
        let columns = rhs.len().checked_div(n)?;
        assert_eq!(rhs.len() % n, 0, "right-hand sides have the matrix's size");
        Some(MatMut::from_column_major_slice_mut(rhs, n, columns))
    }

    /// Solves for one right-hand side in the caller's numbering; allocates.
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

    /// Gaussian elimination without any cleverness.
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

    /// A grounded Laplacian of a random graph.
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
