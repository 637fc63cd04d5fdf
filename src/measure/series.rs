//! What runs along t, for plots.

use super::film::{FilmReport, FilmSample};
use serde::Serialize;

/// A quantity that a film has at every t.
///
/// ```
/// use morphospace::measure::Quantity;
/// assert_eq!(Quantity::WorstConformal.label(), "conformal distortion, worst face");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Quantity {
    /// Filled area, in squared units of the designs.
    Area,
    /// Length of all boundaries, in units of the designs.
    Perimeter,
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

impl Quantity {
    /// All of them, in the order in which they are listed.
    pub const ALL: [Self; 9] = [
        Self::Area,
        Self::Perimeter,
        Self::WorstConformal,
        Self::WorstIsometric,
        Self::MinDet,
        Self::Folds,
        Self::Crossings,
        Self::Pieces,
        Self::Holes,
    ];

    /// What it is called beside a plot.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Area => "area",
            Self::Perimeter => "perimeter",
            Self::WorstConformal => "conformal distortion, worst face",
            Self::WorstIsometric => "isometric distortion, worst face",
            Self::MinDet => "least determinant",
            Self::Folds => "folded faces",
            Self::Crossings => "boundary crossings",
            Self::Pieces => "pieces",
            Self::Holes => "holes",
        }
    }

    /// At one sample; `None` where this kind of transition has none of it.
    #[must_use]
    pub fn at(self, sample: &FilmSample) -> Option<f64> {
        let count = |n: Option<usize>| n.map(|n| n as f64);
        let distortion = sample.distortion;
        match self {
            Self::Area => Some(sample.area),
            Self::Perimeter => Some(sample.perimeter),
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
