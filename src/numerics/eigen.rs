//! Eigenvalues and eigenvectors of small dense symmetric matrices.

use faer::{MatRef, Side};

/// Returns the eigenvalues of a symmetric n×n matrix in ascending order, each with its unit
/// eigenvector. Returns `None` if an entry is not finite. `entries` holds the matrix column by
/// column; only the lower triangle is read.
///
/// ```
/// use morphospace::numerics::symmetric_eigen;
/// let axes = symmetric_eigen(2, &[2.0, 1.0, 1.0, 2.0]).expect("numbers");
/// assert!((axes[0].0 - 1.0).abs() < 1e-12 && (axes[1].0 - 3.0).abs() < 1e-12);
/// ```
///
/// # Panics
/// If there are not exactly n² entries.
#[must_use]
pub fn symmetric_eigen(n: usize, entries: &[f64]) -> Option<Vec<(f64, Vec<f64>)>> {
    assert_eq!(entries.len(), n * n, "n² entries");
    if entries.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let matrix = MatRef::from_column_major_slice(entries, n, n);
    let decomposed = matrix.self_adjoint_eigen(Side::Lower).ok()?;
    let vectors = decomposed.U();
    let values = decomposed.S().column_vector();
    let axis = |k: usize| (values[k], (0..n).map(|row| vectors[(row, k)]).collect());
    Some((0..n).map(axis).collect())
}
