//! Materials and cross sections of the bars of a truss.

use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Material of bars. Numbers that are not given come from the grade that the name contains, such as
/// "steel S235"; see [`MaterialGrade`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussMaterial {
    /// Display name.
    pub name: String,
    /// Young's modulus, positive, in units of stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub youngs_modulus: Option<f64>,
    /// Mass per volume, positive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Characteristic strength in tension and compression, positive, in units of stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength: Option<f64>,
}

/// Standard grade of a building material, in SI units. Values are characteristic; they contain no
/// partial factors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MaterialGrade {
    /// Name of the grade. A material whose name contains it has this grade.
    pub name: &'static str,
    /// Young's modulus in Pa; for timber, the mean along the grain.
    pub youngs_modulus: f64,
    /// Yield strength in Pa; for timber, the tensile strength along the grain; for aluminium, the
    /// 0.2 % proof stress.
    pub strength: f64,
    /// Mean density in kg/m³.
    pub density: f64,
}

impl MaterialGrade {
    /// All grades: steel (EN 1993-1-1, table 3.1), timber (EN 338:2016 and EN 14080:2013) and
    /// aluminium (EN 1999-1-1, table 3.2).
    pub const ALL: [Self; 5] = [
        Self::new("S235", 210e9, 235e6, 7850.0),
        Self::new("S355", 210e9, 355e6, 7850.0),
        Self::new("C24", 11e9, 14.5e6, 420.0),
        Self::new("GL24h", 11.5e9, 19.2e6, 420.0),
        Self::new("6082-T6", 70e9, 260e6, 2700.0),
    ];

    /// Grade of bars whose material does not say which it is: steel S235.
    pub const DEFAULT: Self = Self::ALL[0];

    const fn new(name: &'static str, youngs_modulus: f64, strength: f64, density: f64) -> Self {
        Self {
            name,
            youngs_modulus,
            strength,
            density,
        }
    }

    /// Returns the grade that a material's name contains, in upper or lower case.
    ///
    /// ```
    /// use morphospace::design::MaterialGrade;
    /// assert_eq!(MaterialGrade::named("steel s355").map(|grade| grade.strength), Some(355e6));
    /// assert_eq!(MaterialGrade::named("bronze"), None);
    /// ```
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let name = name.to_lowercase();
        let words = || name.split(|c: char| !(c.is_alphanumeric() || c == '-'));
        let is_named = |grade: &Self| words().any(|word| word == grade.name.to_lowercase());
        Self::ALL.into_iter().find(is_named)
    }
}

/// Cross section of bars. Bending is about the axis that is perpendicular to the plane.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrussSection {
    /// Display name.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Area, not negative; `None` if each bar gives its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<f64>,
    /// Shape, from which the radius of gyration follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<SectionShape>,
    /// Radius of gyration, positive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_of_gyration: Option<f64>,
    /// Second moment of area, positive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub second_moment: Option<f64>,
    /// Height of the section in the plane, positive; `None` for the height that is usual for the
    /// shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth: Option<f64>,
}

/// Shape of a cross section.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SectionShape {
    /// Solid round bar.
    Round,
    /// Round tube.
    Tube {
        /// Outer diameter divided by the thickness of the wall, above 2.
        ratio: f64,
    },
    /// Solid rectangle.
    Rectangle {
        /// Height in the plane divided by the width, positive.
        ratio: f64,
    },
    /// I section, whose second moment or radius of gyration must be given.
    I,
}

impl SectionShape {
    /// Shape of bars that give only their area: a tube with a wall of a twentieth of the diameter.
    pub const DEFAULT: Self = Self::Tube { ratio: 20.0 };

    /// Returns i²/A, the squared radius of gyration divided by the area; `None` for I sections, for
    /// which it varies.
    #[must_use]
    pub fn gyration_ratio(self) -> Option<f64> {
        match self {
            Self::Round => Some(1.0 / (4.0 * PI)),
            Self::Tube { ratio } => {
                // With D = 1 and d = 1 − 2/ratio: i² = (D² + d²)/16, A = π (D² − d²)/4.
                let inner = (1.0 - 2.0 / ratio).powi(2);
                Some((1.0 + inner) / (4.0 * PI * (1.0 - inner)))
            }
            Self::Rectangle { ratio } => Some(ratio / 12.0),
            Self::I => None,
        }
    }

    /// Returns the height of the section divided by its radius of gyration. For I sections, that of
    /// the European IPE profiles, which is 2.4 to 2.5.
    #[must_use]
    pub fn depth_ratio(self) -> f64 {
        match self {
            Self::Round => 4.0,
            Self::Tube { ratio } => 4.0 / (1.0 + (1.0 - 2.0 / ratio).powi(2)).sqrt(),
            Self::Rectangle { .. } => 12.0_f64.sqrt(),
            Self::I => 2.4,
        }
    }

    /// Returns whether the numbers of the shape are within their ranges.
    pub(super) fn is_valid(self) -> bool {
        match self {
            Self::Round | Self::I => true,
            Self::Tube { ratio } => ratio.is_finite() && ratio > 2.0,
            Self::Rectangle { ratio } => ratio.is_finite() && ratio > 0.0,
        }
    }
}

impl TrussSection {
    /// Returns the radius of gyration of a bar with this section and the given area.
    pub(crate) fn radius(&self, area: f64) -> f64 {
        let shape = self.shape.unwrap_or(SectionShape::DEFAULT);
        let of_shape = || (shape.gyration_ratio().unwrap_or_default() * area).sqrt();
        let of_moment = |moment: f64| match area {
            0.0 => 0.0,
            area => (moment / area).sqrt(),
        };
        self.radius_of_gyration
            .or_else(|| self.second_moment.map(of_moment))
            .unwrap_or_else(of_shape)
    }

    /// Returns the height of a bar with this section and the given radius of gyration.
    pub(crate) fn height(&self, radius: f64) -> f64 {
        // A rectangle has the least section modulus for a radius of gyration, so that a section of
        // unknown shape is not overrated.
        let stiffness_is_given = self.radius_of_gyration.or(self.second_moment).is_some();
        let shape = self.shape.unwrap_or(match stiffness_is_given {
            true => SectionShape::Rectangle { ratio: 1.0 },
            false => SectionShape::DEFAULT,
        });
        self.depth.unwrap_or_else(|| shape.depth_ratio() * radius)
    }
}
