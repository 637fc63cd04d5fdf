//! What runs along t, for plots.

use super::film_report::{FilmReport, FilmSample};
use crate::settings::choice::named;

/// A quantity that a film has at every t.
///
/// ```
/// use morphospace::{measure::Quantity, names::Choice};
/// assert_eq!(Quantity::WorstConformal.name().title, "Worst shear");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Quantity {
    /// Filled area, in squared units of the designs.
    Area,
    /// Length of all boundaries, in units of the designs.
    Perimeter,
    /// By how much all boundaries turn, in radians.
    Turning,
    /// σ₁/σ₂ of the worst face, at least 1.
    WorstConformal,
    /// max(σ₁, 1/σ₂) of the worst face, at least 1.
    WorstIsometric,
    /// The least determinant of a face, 1 at t = 0; a fold where it is not
    /// positive.
    MinDet,
    /// Faces that are turned over or flat.
    Folds,
    /// Crossings of the boundary.
    Crossings,
    /// Separate pieces.
    Pieces,
    /// Holes in them.
    Holes,
}

named! { Quantity {
    Area: "area", "Area", "The filled area.";
    Perimeter: "perimeter", "Perimeter", "The length of all boundaries.";
    Turning: "turning", "Turning",
        "By how much the boundaries turn, to and fro, in radians; a jagged form turns more.";
    WorstConformal: "worst-conformal", "Worst shear",
        "Conformal distortion of the worst triangle: its longer stretch by its shorter; 1 keeps \
         all angles.";
    WorstIsometric: "worst-isometric", "Worst stretch",
        "Isometric distortion of the worst triangle: the larger of its stretch and its squeeze; \
         1 keeps all lengths.";
    MinDet: "min-det", "Least area ratio",
        "The least determinant: the area of the triangle that has shrunk most, as a share of \
         what it was. At 0 and below it folds over.";
    Folds: "folds", "Folded faces", "Triangles that are turned over or flat.";
    Crossings: "crossings", "Crossings", "How often the boundary crosses itself.";
    Pieces: "pieces", "Pieces", "Separate pieces.";
    Holes: "holes", "Holes", "Holes in them.";
} }

impl Quantity {
    /// At one sample; `None` where this kind of transition has none of it.
    #[must_use]
    pub fn at(self, sample: &FilmSample) -> Option<f64> {
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
    /// A quantity against t as pairs `[t, value]`, t rising from 0 to 1;
    /// empty where this kind of transition has none of it. The distortion of
    /// a folded face is infinite: a gap in a plot.
    #[must_use]
    pub fn series(&self, quantity: Quantity) -> Vec<[f64; 2]> {
        let samples = self.samples.iter();
        samples
            .filter_map(|sample| Some([sample.t, quantity.at(sample)?]))
            .collect()
    }
}
