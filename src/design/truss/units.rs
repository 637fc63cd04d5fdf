//! Units of the numbers in a truss file.

use serde::{Deserialize, Serialize};

/// Units of a truss file. Every other number of the file follows from them: areas are in squared
/// units of length, second moments in the fourth power, moments in force times length, densities in
/// mass per cubed unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussUnits {
    /// Unit of coordinates and of all other lengths.
    pub length: TrussLengthUnit,
    /// Unit of forces. It also decides the unit of mass: kilograms for newtons, pounds for pounds.
    pub force: TrussForceUnit,
    /// Unit of moduli and strengths; `None` for force per squared unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<TrussStressUnit>,
}

/// Unit of length of a truss.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TrussLengthUnit {
    /// Metre.
    #[serde(rename = "m")]
    Metre,
    /// Millimetre.
    #[serde(rename = "mm")]
    Millimetre,
    /// Foot.
    #[serde(rename = "ft")]
    Foot,
    /// Inch.
    #[serde(rename = "in")]
    Inch,
}

/// Unit of force of a truss.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TrussForceUnit {
    /// Newton.
    #[serde(rename = "N")]
    Newton,
    /// Kilonewton.
    #[serde(rename = "kN")]
    Kilonewton,
    /// Pound-force.
    #[serde(rename = "lb")]
    Pound,
    /// A thousand pounds-force.
    #[serde(rename = "kip")]
    Kip,
}

/// Unit of stress of a truss.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TrussStressUnit {
    /// Pascal.
    Pa,
    /// Kilopascal.
    #[serde(rename = "kPa")]
    Kilopascal,
    /// Megapascal, which is a newton per square millimetre.
    #[serde(rename = "MPa")]
    Megapascal,
    /// Gigapascal.
    #[serde(rename = "GPa")]
    Gigapascal,
    /// Pound-force per square inch.
    #[serde(rename = "psi")]
    Psi,
    /// A thousand pounds-force per square inch.
    #[serde(rename = "ksi")]
    Ksi,
}

/// Metres in an inch (exact by definition).
const INCH: f64 = 0.0254;
/// Kilograms in a pound (exact by definition).
const POUND: f64 = 0.453_592_37;
/// Standard acceleration of gravity in m/s² (exact by definition).
pub(crate) const GRAVITY: f64 = 9.80665;

impl TrussUnits {
    /// Units of a file that names none: metres, kilonewtons and pascals.
    pub const DEFAULT: Self = Self {
        length: TrussLengthUnit::Metre,
        force: TrussForceUnit::Kilonewton,
        stress: Some(TrussStressUnit::Pa),
    };

    /// Returns the unit of length in metres.
    #[must_use]
    pub fn metres(self) -> f64 {
        match self.length {
            TrussLengthUnit::Metre => 1.0,
            TrussLengthUnit::Millimetre => 1e-3,
            TrussLengthUnit::Foot => 12.0 * INCH,
            TrussLengthUnit::Inch => INCH,
        }
    }

    /// Returns the unit of force in newtons.
    #[must_use]
    pub fn newtons(self) -> f64 {
        match self.force {
            TrussForceUnit::Newton => 1.0,
            TrussForceUnit::Kilonewton => 1e3,
            TrussForceUnit::Pound => POUND * GRAVITY,
            TrussForceUnit::Kip => 1e3 * POUND * GRAVITY,
        }
    }

    /// Returns the unit of stress in pascals.
    #[must_use]
    pub fn pascals(self) -> f64 {
        match self.stress {
            None => self.newtons() / self.metres().powi(2),
            Some(TrussStressUnit::Pa) => 1.0,
            Some(TrussStressUnit::Kilopascal) => 1e3,
            Some(TrussStressUnit::Megapascal) => 1e6,
            Some(TrussStressUnit::Gigapascal) => 1e9,
            Some(TrussStressUnit::Psi) => POUND * GRAVITY / INCH.powi(2),
            Some(TrussStressUnit::Ksi) => 1e3 * POUND * GRAVITY / INCH.powi(2),
        }
    }

    /// Returns the unit of density in kilograms per cubic metre.
    #[must_use]
    pub fn density(self) -> f64 {
        let mass = match self.force {
            TrussForceUnit::Newton | TrussForceUnit::Kilonewton => 1.0,
            TrussForceUnit::Pound | TrussForceUnit::Kip => POUND,
        };
        mass / self.metres().powi(3)
    }
}
