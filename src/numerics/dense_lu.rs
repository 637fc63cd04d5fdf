//! LU factorisation of small dense systems that change from one frame of an animation to the next.
//!
//! A [`DenseLu`] reuses its memory from one matrix to the next and never fails: a singular matrix
//! gives a solution with infinities or NaN, or a meaningless one, so the caller must check the
//! residual. It uses partial pivoting and a single thread.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Conj, MatMut, MatRef, Par};

/// LU factorisation of a square matrix with row exchanges.
///
/// ```
/// use morphospace::numerics::DenseLu;
/// let mut lu = DenseLu::new();
/// lu.factor(2, &[0.0, 2.0, 1.0, 0.0]); // columns
/// let mut x = [3.0, 8.0];
/// lu.solve(&mut x);
/// assert_eq!(x, [4.0, 3.0]);
/// ```
pub struct DenseLu {
    /// Number of unknowns.
    n: usize,
    /// Factors, column by column: L below the diagonal, U on and above it.
    values: Vec<f64>,
    /// Row permutation and its inverse.
    rows: [Vec<u32>; 2],
    memory: MemBuffer,
    /// Largest number of unknowns and largest number of right-hand sides for which `memory`
    /// suffices.
    room: [usize; 2],
}

impl std::fmt::Debug for DenseLu {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DenseLu").field("size", &self.n).finish()
    }
}

impl Default for DenseLu {
    fn default() -> Self {
        Self::new()
    }
}

impl DenseLu {
    /// Creates the factorisation of the empty matrix. Memory is allocated when the first larger
    /// matrix is factored.
    #[must_use]
    pub fn new() -> Self {
        Self {
            n: 0,
            values: Vec::new(),
            rows: [Vec::new(), Vec::new()],
            memory: MemBuffer::new(StackReq::EMPTY),
            room: [0, 0],
        }
    }

    /// Returns the number of unknowns.
    #[must_use]
    pub fn size(&self) -> usize {
        self.n
    }

    /// Factors an n×n matrix, given column by column, in about 2n³/3 operations. Allocates only if
    /// n exceeds the sizes of all earlier matrices.
    ///
    /// # Panics
    /// If the matrix does not have n² entries.
    pub fn factor(&mut self, n: usize, matrix: &[f64]) {
        assert_eq!(matrix.len(), n * n, "the matrix is square");
        self.n = n;
        self.values.clear();
        self.values.extend_from_slice(matrix);
        for rows in &mut self.rows {
            rows.resize(n, 0);
        }
        if n == 0 {
            return;
        }
        self.make_room(n, 1);
        let [perm, inverse] = &mut self.rows;
        factor::lu_in_place(
            MatMut::from_column_major_slice_mut(&mut self.values, n, n),
            perm,
            inverse,
            Par::Seq,
            MemStack::new(&mut self.memory),
            Default::default(),
        );
    }

    /// Solves in place for all right-hand sides in `rhs`, which are stored one after the other.
    /// Allocates only if there are more right-hand sides than in any earlier call.
    ///
    /// # Panics
    /// If the length of `rhs` is not a multiple of [`Self::size`].
    pub fn solve(&mut self, rhs: &mut [f64]) {
        let n = self.n;
        if n == 0 {
            return;
        }
        assert_eq!(rhs.len() % n, 0, "right-hand sides have the matrix's size");
        let columns = rhs.len() / n;
        self.make_room(n, columns);
        let factors = MatRef::from_column_major_slice(&self.values, n, n);
        let [perm, inverse] = &self.rows;
        solve::solve_in_place_with_conj(
            factors,
            factors,
            PermRef::new_checked(perm, inverse, n),
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, n, columns),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }

    /// Enlarges the memory if it does not suffice for `n` unknowns and `columns` right-hand sides.
    fn make_room(&mut self, n: usize, columns: usize) {
        if n <= self.room[0] && columns <= self.room[1] {
            return;
        }
        // Enlarge to the maximum of the old and the new sizes. Otherwise a small matrix with many
        // columns and a large one with few would each reallocate every time.
        let [n, columns] = [n.max(self.room[0]), columns.max(self.room[1])];
        let factoring = factor::lu_in_place_scratch::<u32, f64>(n, n, Par::Seq, Default::default());
        let solving = solve::solve_in_place_scratch::<u32, f64>(n, columns, Par::Seq);
        self.memory = MemBuffer::new(factoring.or(solving));
        self.room = [n, columns];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn solutions_satisfy_the_system(
            n in 1_usize..40,
            entries in prop::collection::vec(-1.0f64..1.0, 40 * 40),
            x in prop::collection::vec(-1.0f64..1.0, 3 * 40),
        ) {
            // A large entry in each row, off the diagonal, keeps the matrix far from singular.
            let mut a = entries[..n * n].to_vec();
            for i in 0..n {
                a[((i + 3) % n) * n + i] += 2.0 * n as f64;
            }
            let x = &x[..3 * n];
            let mut b: Vec<f64> = x
                .chunks(n)
                .flat_map(|x| (0..n).map(|i| (0..n).map(|j| a[j * n + i] * x[j]).sum()))
                .collect();
            let mut lu = DenseLu::new();
            lu.factor(1, &[2.0]);
            lu.factor(n, &a);
            lu.solve(&mut b);
            for (found, &expected) in b.iter().zip(x) {
                prop_assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        }
    }

    #[test]
    fn a_singular_matrix_does_not_panic() {
        let mut lu = DenseLu::new();
        for n in [1, 2, 30] {
            lu.factor(n, &vec![0.0; n * n]);
            lu.solve(&mut vec![1.0; n]);
            lu.factor(n, &vec![f64::NAN; n * n]);
            lu.solve(&mut vec![1.0; 2 * n]);
        }
    }
}
