//! Sparse Cholesky factorisation of matrices whose values change while the pattern of their nonzero
//! entries stays the same. The elimination order is computed once. Then any number of matrices with
//! this pattern can be factored and their systems solved.
//!
//! Guaranteed: a solve allocates nothing, and its solution depends only on the entries and the
//! right-hand side, not on earlier solves.

use super::{FactorError, in_blocks};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};

/// Pattern of the nonzero entries of a symmetric matrix, with its elimination order.
///
/// ```
/// use morphospace::numerics::PatternCholesky;
/// let (pattern, slots) = PatternCholesky::new(2, &[[0, 0], [1, 1], [1, 0]])?;
/// let mut memory = pattern.memory();
/// for (slot, value) in slots.iter().zip([4.0, 2.0, 1.0]) {
///     memory.entries()[*slot as usize] += value;
/// }
/// let mut x = [5.0, 3.0];
/// assert!(pattern.solve(&mut memory, &mut x));
/// assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 1.0).abs() < 1e-15);
/// # Ok::<(), morphospace::numerics::FactorError>(())
/// ```
#[derive(Debug)]
pub struct PatternCholesky {
    lower: SymbolicSparseColMat<u32>,
    symbolic: SymbolicCholesky<u32>,
}

/// Entries of a matrix with a given pattern, and the memory to factor it.
pub struct PatternWorkspace {
    entries: Vec<f64>,
    factor: Vec<f64>,
    work: MemBuffer,
}

impl std::fmt::Debug for PatternWorkspace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PatternMemory")
            .field("entries", &self.entries)
            .finish_non_exhaustive()
    }
}

impl PatternWorkspace {
    /// Returns the entries of the matrix, to be filled before each solve.
    /// [`PatternCholesky::new`] returns the index of each entry in this list.
    pub fn entries(&mut self) -> &mut [f64] {
        &mut self.entries
    }
}

impl PatternCholesky {
    /// Computes the elimination order for a symmetric matrix of `n` unknowns with nonzero entries
    /// at `places`. A place is a pair of row and column, in either order, and may occur several
    /// times. Also returns, for each place, its index in [`PatternWorkspace::entries`].
    ///
    /// # Errors
    /// [`FactorError::OutOfMemory`] if the factorisation does not fit into memory.
    pub fn new(n: usize, places: &[[u32; 2]]) -> Result<(Self, Vec<u32>), FactorError> {
        // Put the column first, so that the places sort in storage order.
        let stored = |&[i, j]: &[u32; 2]| [i.min(j), i.max(j)];
        let mut all: Vec<[u32; 2]> = places.iter().map(stored).collect();
        all.sort_unstable();
        all.dedup();
        // Compressed column storage needs the number of entries before each column.
        let before = |column: u32| all.partition_point(|&[c, _]| c < column) as u32;
        let columns: Vec<u32> = (0..=n as u32).map(before).collect();
        let rows: Vec<u32> = all.iter().map(|&[_, row]| row).collect();
        // The index of a place is its rank in the sorted list.
        let slot = |place: &[u32; 2]| all.partition_point(|other| *other < stored(place)) as u32;
        let slots = places.iter().map(slot).collect();
        let lower = SymbolicSparseColMat::new_checked(n, n, columns, None, rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: in_blocks(n),
            ..CholeskySymbolicParams::default()
        };
        let amd = SymmetricOrdering::Amd;
        let symbolic = factorize_symbolic_cholesky(lower.as_ref(), Side::Lower, amd, params)
            .map_err(|_| FactorError::OutOfMemory)?;
        Ok((Self { lower, symbolic }, slots))
    }

    /// Allocates the memory for [`Self::solve`], with all entries zero.
    #[must_use]
    pub fn memory(&self) -> PatternWorkspace {
        let factoring = self
            .symbolic
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let solving = self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        PatternWorkspace {
            entries: vec![0.0; self.lower.row_idx().len()],
            factor: vec![0.0; self.symbolic.len_val()],
            work: MemBuffer::new(factoring.or(solving)),
        }
    }

    /// Factors the matrix with the entries in `memory`. Returns whether it is positive definite; if
    /// not, [`Self::back_substitute`] must not be used.
    ///
    /// # Panics
    /// If the memory belongs to another pattern.
    pub fn factor(&self, memory: &mut PatternWorkspace) -> bool {
        let PatternWorkspace {
            entries,
            factor,
            work,
        } = memory;
        let factored = self.symbolic.factorize_numeric_llt(
            factor,
            SparseColMatRef::new(self.lower.as_ref(), entries),
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(work),
            Default::default(),
        );
        factored.is_ok()
    }

    /// Solves in place for `rhs` with the factors of the last [`Self::factor`].
    ///
    /// # Panics
    /// If the memory belongs to another pattern, or `rhs` does not have one number for each
    /// unknown.
    pub fn back_substitute(&self, memory: &mut PatternWorkspace, rhs: &mut [f64]) {
        let rows = rhs.len();
        LltRef::new(&self.symbolic, &memory.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, rows, 1),
            Par::Seq,
            MemStack::new(&mut memory.work),
        );
    }

    /// Factors the matrix with the entries in `memory`, and solves in place for `rhs`. Returns
    /// whether the matrix is positive definite; if not, `rhs` is unchanged.
    ///
    /// # Panics
    /// As [`Self::factor`] and [`Self::back_substitute`].
    pub fn solve(&self, memory: &mut PatternWorkspace, rhs: &mut [f64]) -> bool {
        let is_definite = self.factor(memory);
        if is_definite {
            self.back_substitute(memory, rhs);
        }
        is_definite
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::{Cholesky, SymmetricMatrix};

    #[test]
    fn it_solves_as_a_newly_factored_matrix_does() {
        let n = 12_u32;
        // Some places occur twice, or with row and column exchanged.
        let chain = (0..n).flat_map(|i| [[i, i], [i, (i + 1) % n], [(i + 5) % n, i], [i, i]]);
        let places: Vec<[u32; 2]> = chain.collect();
        let (pattern, slots) = PatternCholesky::new(n as usize, &places).expect("a pattern");
        let mut memory = pattern.memory();
        for round in 1..4 {
            let value = |k: usize| match places[k] {
                [i, j] if i == j => 3.0 + f64::from(i),
                [i, j] => 0.1 * f64::from(round * (i + 2 * j) % 7),
            };
            let mut matrix = SymmetricMatrix::zero(n as usize, places.len());
            memory.entries().fill(0.0);
            for (k, &[i, j]) in places.iter().enumerate() {
                matrix.add(i, j, value(k));
                memory.entries()[slots[k] as usize] += value(k);
            }
            let rhs: Vec<f64> = (0..n).map(|i| f64::from(i) - 3.5).collect();
            let expected = Cholesky::factor(&matrix).expect("definite").solve(&rhs);
            let mut found = rhs.clone();
            assert!(pattern.solve(&mut memory, &mut found));
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-14, "{a} {b}");
            }
        }
        memory.entries().fill(-1.0);
        assert!(!pattern.solve(&mut memory, &mut [1.0; 12]));
    }
}
