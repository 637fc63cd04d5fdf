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

use super::Mask;
use super::chamfer::{Lengths, Steps};
use super::euclidean::Columns;
use crate::names::named;
use crate::progress::{Cancelled, Progress, checkpoint};
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
/// use morphospace::progress::Silent;
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
    let mut out = Vec::new();
    DistanceTransform::new().run(mask, metric, &mut out, progress)?;
    Ok(out)
}

/// [`distance_transform`] for many masks: keeps its buffers between runs.
///
/// ```
/// use morphospace::field::{DistanceTransform, Mask, Metric};
/// use morphospace::progress::Silent;
///
/// let mut transform = DistanceTransform::new();
/// let mut out = Vec::new();
/// for side in [1, 2, 3] {
///     let full = Mask::new(side, side, vec![true; (side * side) as usize])?;
///     transform.run(&full, Metric::Chessboard, &mut out, &Silent)?;
///     assert_eq!(out.len(), full.bits().len());
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct DistanceTransform {
    columns: Columns,
    lengths: Lengths,
}

impl DistanceTransform {
    /// A transform with empty buffers.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Puts the signed distances of all cells of `mask` into `out`, which is
    /// given the mask's length. Allocates nothing where the last mask was as
    /// large, apart from a row for each thread.
    ///
    /// # Errors
    /// [`Cancelled`] if nobody wants the result any more; what is in `out` then
    /// is of no use.
    pub fn run(
        &mut self,
        mask: &Mask,
        metric: Metric,
        out: &mut Vec<f32>,
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        checkpoint(progress, "measuring distances", 0.0)?;
        out.resize(mask.bits().len(), 0.0);
        let Some(steps) = steps(metric) else {
            self.columns.measure(mask);
            return self.columns.rows(mask, out, progress);
        };
        self.lengths.transform(mask, steps, out, progress)
    }
}

/// The steps whose shortest ways make a metric, if there are such.
fn steps(metric: Metric) -> Option<Steps> {
    let diagonal = match metric {
        Metric::Euclidean => return None,
        Metric::CityBlock => 2.0,
        Metric::Chessboard => 1.0,
        Metric::QuasiEuclidean => SQRT_2,
    };
    Some(Steps {
        straight: 1.0,
        diagonal,
    })
}

#[cfg(test)]
mod tests;
