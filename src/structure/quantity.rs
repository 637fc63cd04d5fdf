//! Measures of a structure as functions of t, for graphs.

use super::film::FilmStructure;
use super::sample::StructureSample;
use crate::settings::named;

/// Measure of a structure that can be plotted against t.
///
/// ```
/// use morphospace::{settings::Choice, structure::StructureQuantity};
/// assert_eq!(StructureQuantity::Mass.name().title, "Mass, kg");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StructureQuantity {
    /// Mass of all bars in kg.
    Mass,
    /// Largest displacement of a node in mm.
    Deflection,
    /// Largest ratio of stress to strength in percent.
    Strength,
    /// Largest ratio of compression to Euler's load in percent.
    Euler,
    /// Load factor at which a frame buckles.
    BucklingFactor,
    /// First natural frequency in Hz.
    Frequency,
    /// Work of the loads on the displacements in J.
    Compliance,
}

named! { StructureQuantity {
    Mass: "mass", "Mass, kg", "Mass of all bars.";
    Deflection: "deflection", "Deflection, mm", "Largest displacement of a node under the loads.";
    Strength: "strength", "Strength used, %", "Largest stress of a bar as a share of its strength.";
    Euler: "euler", "Buckling load used, %",
        "Largest compression of a pinned bar as a share of its buckling load.";
    BucklingFactor: "buckling-factor", "Buckling factor",
        "Factor on the loads at which the frame buckles.";
    Frequency: "frequency", "First frequency, Hz", "First natural frequency. At 0 it falls over.";
    Compliance: "compliance", "Compliance, J",
        "Work of the loads on the displacements: the smaller, the stiffer.";
} }

impl StructureQuantity {
    /// Returns the value of this measure at one sample; `None` if the structure has no such value.
    #[must_use]
    pub fn value_at(self, sample: &StructureSample) -> Option<f64> {
        let standing = |value: f64| sample.stands().then_some(value);
        match self {
            Self::Mass => Some(sample.mass),
            Self::Deflection => standing(1e3 * sample.deflection),
            Self::Strength => sample.strength.map(|found| 100.0 * found.value),
            Self::Euler => sample.euler.map(|found| 100.0 * found.value),
            Self::BucklingFactor => sample.critical_load_factor,
            Self::Frequency => match sample.stands() {
                true => sample.frequency,
                false => Some(0.0),
            },
            Self::Compliance => standing(sample.compliance),
        }
    }
}

impl FilmStructure {
    /// Returns a measure as pairs `[t, value]` with t increasing from 0 to 1; empty if the structure
    /// does not have the measure.
    #[must_use]
    pub fn series(&self, quantity: StructureQuantity) -> Vec<[f64; 2]> {
        let samples = self.samples.iter();
        samples
            .filter_map(|sample| Some([sample.t, quantity.value_at(sample)?]))
            .collect()
    }
}
