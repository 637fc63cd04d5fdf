//! What is added to a matrix that rounding has eaten at.
//!
//! The matrix of the energy is positive definite, but not to the last digits
//! where stiffnesses differ by more than a number has digits. Then the least
//! of a few shares of the diagonal is added with which it can be factored, and
//! that is told.

use crate::numerics::{Cholesky, FactorError, SymmetricMatrix};
use crate::work::progress::{Cancelled, Progress};

/// Shares of the diagonal that are added where rounding has eaten a pivot.
/// Faces a ten-thousandth as large as their neighbours, about a hole that
/// closes to a point, leave pivots of the size of the last digits; where a whole part is
/// as thin as that against another, as in two drawings of hairlines, so do sums of them.
const STIFFER: [f64; 5] = [1e-13, 1e-11, 1e-9, 1e-7, 1e-5];

/// A ridge: what was added to a matrix, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ridge {
    /// By which share of itself each entry of the diagonal was made larger.
    pub share: f64,
    /// The first vertex, from 0, whose pivot was not positive without it: of
    /// the mesh that is interpolated.
    pub vertex: usize,
}

/// Factors a matrix, with a ridge where it needs one.
///
/// # Errors
/// [`Cancelled`] if nobody wants the result any more; within, [`FactorError`]
/// if it cannot be factored with the largest ridge either.
pub(super) fn factor_with_ridge(
    mut matrix: SymmetricMatrix,
    progress: &dyn Progress,
) -> Result<Result<(Cholesky, Option<Ridge>), FactorError>, Cancelled> {
    let first = Cholesky::factor_if_wanted(&matrix, progress)?;
    let Err(FactorError::NotPositiveDefinite { index: vertex }) = first else {
        return Ok(first.map(|cholesky| (cholesky, None)));
    };
    for share in STIFFER {
        // What was added before is a hundredth of it.
        matrix.stiffen(share);
        match Cholesky::factor_if_wanted(&matrix, progress)? {
            Err(FactorError::NotPositiveDefinite { .. }) => {}
            done => return Ok(done.map(|cholesky| (cholesky, Some(Ridge { share, vertex })))),
        }
    }
    Ok(Err(FactorError::NotPositiveDefinite { index: vertex }))
}
