//! Measures of a film as functions of t, for graphs.

use super::film_report::{FilmReport, FilmSample};
use crate::settings::named;

/// Measure of a film that can be plotted against t.
///
/// ```
/// use morphospace::{measure::Quantity, settings::Choice};
/// assert_eq!(Quantity::WorstConformal.name().title, "Worst shear");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Quantity {
    /// Filled area, in squared design units.
    Area,
    /// Length of all boundaries, in design units.
    Perimeter,
    /// Total absolute turning of all boundaries, in radians.
    Turning,
    /// Conformal distortion σ₁/σ₂ of the worst face, at least 1.
    WorstConformal,
    /// Isometric distortion max(σ₁, 1/σ₂) of the worst face, at least 1.
    WorstIsometric,
    /// Smallest signed area of any face, divided by the area of the face in the source. It is 1 at
    /// t = 0, and 0 or less if a face is folded.
    MinDet,
    /// Number of faces that are folded or flat.
    Folds,
    /// Number of crossings of the boundary.
    Crossings,
    /// Number of separate pieces (connected regions).
    Pieces,
    /// Number of holes.
    Holes,
}

named! { Quantity {
    Area: "area", "Area", "Filled area.";
    Perimeter: "perimeter", "Perimeter", "Total length of the outlines.";
    Turning: "turning", "Turning",
        "Total turning of the outlines, left and right, in radians. Jagged shapes turn more.";
    WorstConformal: "worst-conformal", "Worst shear",
        "Conformal distortion of the worst triangle: its largest stretch divided by its smallest. \
         At 1 all angles are preserved.";
    WorstIsometric: "worst-isometric", "Worst stretch",
        "Isometric distortion of the worst triangle: the larger of its stretch and compression. \
         At 1 all lengths are preserved.";
    MinDet: "min-det", "Smallest area ratio",
        "Area of the most shrunken triangle, as a fraction of its area in the source. At 0 or \
         below, the triangle is folded.";
    Folds: "folds", "Folded triangles", "Number of triangles that are folded or flat.";
    Crossings: "crossings", "Crossings", "Number of times the outlines cross.";
    Pieces: "pieces", "Pieces", "Number of separate pieces.";
    Holes: "holes", "Holes", "Number of holes.";
} }

impl Quantity {
    /// Returns the value of this measure at one sample; `None` if this kind of transition has no
    /// such value.
    #[must_use]
    pub fn value_at(self, sample: &FilmSample) -> Option<f64> {
        let count = |n: Option<usize>| n.map(|n| n as f64);
        let distortion = sample.distortion;
        match self {
            Self::Area => Some(sample.area),
            Self::Perimeter => Some(sample.perimeter),
            Self::Turning => Some(sample.turning),
            Self::WorstConformal => distortion.map(|d| d.conformal.worst),
            Self::WorstIsometric => distortion.map(|d| d.isometric.worst),
            Self::MinDet => distortion.map(|d| d.min_det),
            Self::Folds => count(distortion.map(|d| d.folds)),
            Self::Crossings => count(sample.crossings),
            Self::Pieces => count(sample.pieces),
            Self::Holes => count(sample.holes),
        }
    }
}

impl FilmReport {
    /// Returns a measure as pairs `[t, value]` with t increasing from 0 to 1.
    ///
    /// Empty if this kind of transition does not have the measure. The distortion of a folded face
    /// is infinite, which a graph shows as a gap.
    #[must_use]
    pub fn series(&self, quantity: Quantity) -> Vec<[f64; 2]> {
        let samples = self.samples.iter();
        samples
            .filter_map(|sample| Some([sample.t, quantity.value_at(sample)?]))
            .collect()
    }
}
