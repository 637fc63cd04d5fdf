//! Signed distance transforms of masks.
//!
//! Positive inside, negative outside, in cells. The boundary runs between
//! cells, so that each side loses half a cell and no value is 0. What lies
//! beyond the border of a mask counts as one ring of outside cells: a design
//! that fills or exceeds its frame is cut off at the frame, just as it is
//! drawn.
//!
//! Guarantees: equal to the brute-force minimum over all cells, for each
//! metric. Costs: linear in the number of cells; the Euclidean transform runs
//! over the threads of the caller's rayon pool, the others on one.

use super::{Mask, chamfer, euclidean};
use crate::settings::choice::named;
use crate::work::progress::{Cancelled, Progress, checkpoint};
use std::f64::consts::SQRT_2;

/// How far two cells are apart, `dx` columns and `dy` rows from each other
/// (Rosenfeld and Pfaltz 1968; the names are those of the paper's tool).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Metric {
    /// √(dx² + dy²), exact.
    #[default]
    Euclidean,
    /// dx + dy: steps along the axes.
    CityBlock,
    /// max(dx, dy): steps along axes and diagonals, all of length 1.
    Chessboard,
    /// max(dx, dy) + (√2 − 1) min(dx, dy): diagonal steps have length √2.
    QuasiEuclidean,
}

named! { Metric {
    Euclidean: "euclidean", "Euclidean", "True distance: offsets are round.";
    QuasiEuclidean: "quasi-euclidean", "Quasi-Euclidean",
        "Along axes and diagonals: offsets are octagons.";
    CityBlock: "city-block", "City block", "Along axes: offsets are diamonds.";
    Chessboard: "chessboard", "Chessboard", "The larger of the two: offsets are squares.";
} }

/// Signed distances of all cells of `mask`, row-major as its bits.
///
/// ```
/// use morphospace::field::{Mask, Metric, distance_transform};
/// use morphospace::work::progress::Silent;
///
/// let mask = Mask::new(5, 1, vec![false, true, true, true, false])?;
/// let found = distance_transform(&mask, Metric::Euclidean, &Silent)?;
/// assert_eq!(found, [-0.5, 0.5, 0.5, 0.5, -0.5]); // the ring is near
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Cancelled`] if nobody wants the result any more.
pub fn distance_transform(
    mask: &Mask,
    metric: Metric,
    progress: &dyn Progress,
) -> Result<Vec<f32>, Cancelled> {
    checkpoint(progress, "measuring distances", 0.0)?;
    let diagonal = match metric {
        Metric::Euclidean => return euclidean::distances(mask, progress),
        Metric::CityBlock => 2.0,
        Metric::Chessboard => 1.0,
        Metric::QuasiEuclidean => SQRT_2,
    };
    chamfer::distances(mask, diagonal, progress)
}

#[cfg(test)]
mod tests;
