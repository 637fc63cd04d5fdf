//! Units of length that a drawing may declare.

/// Unit of length in which the coordinates of a design are given.
///
/// ```
/// use morphospace::design::LengthUnit;
/// assert_eq!(LengthUnit::Inch.millimetres(), 25.4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LengthUnit {
    /// 25.4 mm.
    Inch,
    /// 12 inches.
    Foot,
    /// 5,280 feet.
    Mile,
    /// A thousandth of a metre.
    Millimetre,
    /// A hundredth of a metre.
    Centimetre,
    /// Metre.
    Metre,
    /// A thousand metres.
    Kilometre,
    /// A millionth of an inch.
    Microinch,
    /// A thousandth of an inch.
    Mil,
    /// Three feet.
    Yard,
    /// 10⁻¹⁰ m.
    Angstrom,
    /// 10⁻⁹ m.
    Nanometre,
    /// A millionth of a metre.
    Micrometre,
    /// A tenth of a metre.
    Decimetre,
    /// Ten metres.
    Decametre,
    /// A hundred metres.
    Hectometre,
    /// 10⁹ m.
    Gigametre,
    /// Mean distance of the earth from the sun.
    AstronomicalUnit,
    /// Distance that light travels in a year.
    LightYear,
    /// Distance at which an astronomical unit subtends one second of arc.
    Parsec,
    /// US survey foot, 1200/3937 m.
    UsSurveyFoot,
    /// 36 US survey inches.
    UsSurveyYard,
    /// 5,280 US survey feet.
    UsSurveyMile,
    /// A twelfth of a US survey foot.
    UsSurveyInch,
}

/// Units in the order of their codes in the variable `$INSUNITS` of DXF, from 1 on.
const DXF_CODES: [LengthUnit; 24] = {
    use LengthUnit::*;
    [
        Inch,
        Foot,
        Mile,
        Millimetre,
        Centimetre,
        Metre,
        Kilometre,
        Microinch,
        Mil,
        Yard,
        Angstrom,
        Nanometre,
        Micrometre,
        Decimetre,
        Decametre,
        Hectometre,
        Gigametre,
        AstronomicalUnit,
        LightYear,
        Parsec,
        UsSurveyFoot,
        UsSurveyInch,
        UsSurveyYard,
        UsSurveyMile,
    ]
};

impl LengthUnit {
    /// Returns the length of the unit in millimetres.
    #[must_use]
    pub fn millimetres(self) -> f64 {
        const INCH: f64 = 25.4;
        const SURVEY_FOOT: f64 = 1000.0 * 1200.0 / 3937.0;
        match self {
            Self::Inch => INCH,
            Self::Foot => 12.0 * INCH,
            Self::Mile => 63_360.0 * INCH,
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1e3,
            Self::Kilometre => 1e6,
            Self::Microinch => 1e-6 * INCH,
            Self::Mil => 1e-3 * INCH,
            Self::Yard => 36.0 * INCH,
            Self::Angstrom => 1e-7,
            Self::Nanometre => 1e-6,
            Self::Micrometre => 1e-3,
            Self::Decimetre => 100.0,
            Self::Decametre => 1e4,
            Self::Hectometre => 1e5,
            Self::Gigametre => 1e12,
            Self::AstronomicalUnit => 149_597_870_700e3,
            Self::LightYear => 9.460_730_472_580_8e18,
            Self::Parsec => 3.085_677_581_491_367e19,
            Self::UsSurveyFoot => SURVEY_FOOT,
            Self::UsSurveyInch => SURVEY_FOOT / 12.0,
            Self::UsSurveyYard => 3.0 * SURVEY_FOOT,
            Self::UsSurveyMile => 5_280.0 * SURVEY_FOOT,
        }
    }

    /// Returns the unit with the given code of the variable `$INSUNITS` of DXF; `None` for 0
    /// (unitless) and unknown codes.
    pub(super) fn from_dxf_code(code: i64) -> Option<Self> {
        let index = usize::try_from(code).ok()?.checked_sub(1)?;
        DXF_CODES.get(index).copied()
    }

    /// Returns the code of the unit in the variable `$INSUNITS` of DXF.
    #[must_use]
    pub(crate) fn dxf_code(self) -> usize {
        let position = DXF_CODES.iter().position(|&unit| unit == self);
        position.map_or(0, |index| index + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_those_of_the_dxf_reference() {
        for (code, unit) in [
            (1, LengthUnit::Inch),
            (4, LengthUnit::Millimetre),
            (6, LengthUnit::Metre),
            (14, LengthUnit::Decimetre),
            (21, LengthUnit::UsSurveyFoot),
        ] {
            assert_eq!(LengthUnit::from_dxf_code(code), Some(unit));
            assert_eq!(i64::try_from(unit.dxf_code()), Ok(code));
        }
        for code in [-1, 0, 25, i64::MAX] {
            assert_eq!(LengthUnit::from_dxf_code(code), None);
        }
    }
}
