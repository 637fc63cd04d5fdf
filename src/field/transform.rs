//! Signed distance transforms of masks in four metrics.
//!
//! Values are positive inside and negative outside; their unit is the cell. The boundary runs
//! midway between inside and outside cells, so half a cell is subtracted on each side and no value
//! is 0. The cells around a mask count as outside: a design that reaches the border of the mask
//! ends there, as its traced contour does.
//!
//! Guaranteed: values equal the brute-force minimum over all cells in each metric. Cost: linear in
//! the number of cells. The Euclidean transform uses the threads of the current rayon pool, the
//! others one thread.

use super::{Mask, chamfer, euclidean};
use crate::settings::named;
use crate::work::progress::{Cancelled, Progress, checkpoint};
use std::f64::consts::SQRT_2;

/// Metric: distance between cells that are dx columns and dy rows apart (Rosenfeld and Pfaltz
/// 1968). The names are those of the tool used in the paper *Design-Space Representation through
/// Blended Transitions*.
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
    Euclidean: "euclidean", "Euclidean", "True distance: offset outlines have round corners.";
    QuasiEuclidean: "quasi-euclidean", "Quasi-Euclidean",
        "Steps along axes and diagonals: offset outlines are octagonal.";
    CityBlock: "city-block", "City block", "Steps along axes: offset outlines are diamond-shaped.";
    Chessboard: "chessboard", "Chessboard", "Larger of the two axis distances: offset outlines are square.";
} }

/// Computes the signed distances of all cells of `mask`, in cells and in the order of
/// [`Mask::bits`].
///
/// ```
/// use morphospace::field::{Mask, Metric, distance_transform};
/// use morphospace::work::progress::Silent;
///
/// let mask = Mask::new(5, 1, vec![false, true, true, true, false])?;
/// let found = distance_transform(&mask, Metric::Euclidean, &Silent)?;
/// assert_eq!(found, [-0.5, 0.5, 0.5, 0.5, -0.5]); // the cells around a mask count as outside
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns [`Cancelled`] if `progress` is cancelled.
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
