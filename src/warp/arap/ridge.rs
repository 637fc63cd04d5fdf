//! Cholesky factorisation with a ridge for numerically singular matrices.
//!
//! The matrix of the energy is positive definite, but rounding can destroy this if stiffnesses
//! differ by more orders of magnitude than a number has digits. In that case the smallest
//! sufficient fraction of the diagonal is added, and the caller is informed.

use crate::numerics::{Cholesky, FactorError, SymmetricMatrix};
use crate::work::progress::{Cancelled, Progress};

/// Ridges that are tried in turn, as fractions of each diagonal entry (tolerance: the smallest is
/// about the rounding error of a pivot).
///
/// Faces around a hole that closes to a point can be 10⁻⁴ times as large as their neighbours and
/// leave pivots of the size of the rounding error. If whole parts are that thin, the errors of
/// many pivots add up and need a larger ridge.
const RIDGES: [f64; 5] = [1e-13, 1e-11, 1e-9, 1e-7, 1e-5];

/// A ridge that was added to the diagonal of a matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ridge {
    /// Relative increase of each diagonal entry.
    pub share: f64,
    /// Index of the first vertex of the interpolated mesh whose pivot was not positive without a
    /// ridge.
    pub vertex: usize,
}

/// Factors a matrix, with the smallest ridge of [`RIDGES`] if necessary.
///
/// # Errors
/// [`Cancelled`] if the job is cancelled. The inner result is a [`FactorError`] if even the largest
/// ridge does not suffice.
pub(super) fn factor_with_ridge(
    mut matrix: SymmetricMatrix,
    progress: &dyn Progress,
) -> Result<Result<(Cholesky, Option<Ridge>), FactorError>, Cancelled> {
    let first = Cholesky::factor_cancellable(&matrix, progress)?;
    let Err(FactorError::NotPositiveDefinite { index: vertex }) = first else {
        return Ok(first.map(|cholesky| (cholesky, None)));
    };
    for share in RIDGES {
        // Ridges accumulate, but the previous one is only a hundredth of this one.
        matrix.stiffen(share);
        match Cholesky::factor_cancellable(&matrix, progress)? {
            Err(FactorError::NotPositiveDefinite { .. }) => {}
            result => return Ok(result.map(|cholesky| (cholesky, Some(Ridge { share, vertex })))),
        }
    }
    Ok(Err(FactorError::NotPositiveDefinite { index: vertex }))
}
