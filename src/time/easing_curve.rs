//! Cubic Bézier easing with two draggable handles, and the type for an easing that is either named
//! or such a curve.
//!
//! Guaranteed: every accepted curve is non-decreasing on [0, 1], so eased time never runs
//! backwards. In text and files, an easing is written as its name or as the four coordinates of its
//! handles.

use std::fmt;
use std::str::FromStr;

use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use super::easing::NamedEasing;
use crate::settings::Choice;

/// Cubic Bézier easing from (0, 0) to (1, 1) with handles (x₁, y₁) and (x₂, y₂), as in CSS
/// `cubic-bezier()`.
///
/// Unlike in CSS, all four numbers must lie in [0, 1]. This makes the curve non-decreasing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EasingBezier([f64; 4]);

/// Error for handles that are not four numbers in [0, 1].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("an easing curve needs four numbers from 0 to 1: x1,y1,x2,y2")]
pub struct EasingBezierError;

/// Number of bisection steps when a coordinate of the Bézier curve is inverted (tolerance: 52
/// halvings of [0, 1] reach the precision of f64).
const HALVINGS: u32 = 52;

impl EasingBezier {
    /// Creates the easing with the handle coordinates x₁, y₁, x₂, y₂.
    ///
    /// # Errors
    /// [`EasingBezierError`] if a number is NaN or outside [0, 1].
    pub fn new(handles: [f64; 4]) -> Result<Self, EasingBezierError> {
        let is_within = handles.iter().all(|h| (0.0..=1.0).contains(h));
        is_within.then_some(Self(handles)).ok_or(EasingBezierError)
    }

    /// Returns the Bézier easing that is identical to a named easing.
    #[must_use]
    pub fn from_named(easing: NamedEasing) -> Self {
        // Every named easing is a polynomial in x of degree at most three. With the handles at x =
        // 1/3 and x = 2/3 the Bézier parameter equals x, so the Bézier easing equals the named one.
        let third = 1.0 / 3.0;
        Self(match easing {
            NamedEasing::Linear => [third, third, 2.0 * third, 2.0 * third],
            NamedEasing::Smooth => [third, 0.0, 2.0 * third, 1.0],
            NamedEasing::EaseIn => [third, 0.0, 2.0 * third, third],
            NamedEasing::EaseOut => [third, 2.0 * third, 2.0 * third, 1.0],
        })
    }

    /// Returns the easing that gives the same motion when time runs backwards: x ↦ 1 − f(1 − x).
    #[must_use]
    pub fn reversed(self) -> Self {
        let [x1, y1, x2, y2] = self.0.map(|h| 1.0 - h);
        Self([x2, y2, x1, y1])
    }

    /// Coordinates of the handles as x₁, y₁, x₂, y₂.
    #[must_use]
    pub fn handles(self) -> [f64; 4] {
        self.0
    }

    fn apply(self, x: f64) -> f64 {
        let [x1, y1, x2, y2] = self.0;
        bernstein(y1, y2, parameter(x1, x2, x))
    }

    fn inverse(self, y: f64) -> f64 {
        let [x1, y1, x2, y2] = self.0;
        bernstein(x1, x2, parameter(y1, y2, y))
    }
}

/// Returns the value at parameter `s` of the cubic Bézier polynomial with the control values 0,
/// `a`, `b` and 1.
fn bernstein(a: f64, b: f64, s: f64) -> f64 {
    let r = 1.0 - s;
    s * (3.0 * r * (r * a + s * b) + s * s)
}

/// Returns the parameter at which the Bézier polynomial with the control values 0, `a`, `b` and 1
/// has the value `value`, by bisection. With `a` and `b` in [0, 1] the polynomial is
/// non-decreasing.
fn parameter(a: f64, b: f64, value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    if value >= 1.0 {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if bernstein(a, b, middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Easing function: a named one, or a cubic Bézier curve.
///
/// ```
/// use morphospace::time::{EasingFunction, NamedEasing};
/// let drawn: EasingFunction = "0.3,0,0.1,1".parse()?;
/// assert!(drawn.apply(0.5) > 0.5);
/// assert_eq!("smooth".parse(), Ok(EasingFunction::Named(NamedEasing::Smooth)));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EasingFunction {
    /// A named easing.
    Named(NamedEasing),
    /// A Bézier curve with its own handles.
    Bezier(EasingBezier),
}

impl Default for EasingFunction {
    fn default() -> Self {
        NamedEasing::default().into()
    }
}

impl From<NamedEasing> for EasingFunction {
    fn from(easing: NamedEasing) -> Self {
        Self::Named(easing)
    }
}

impl EasingFunction {
    /// Returns the value of the easing at `x` in [0, 1]. The easing maps [0, 1] onto itself and is
    /// non-decreasing.
    #[must_use]
    pub fn apply(self, x: f64) -> f64 {
        match self {
            Self::Named(easing) => easing.apply(x),
            Self::Bezier(curve) => curve.apply(x),
        }
    }

    /// Returns an `x` at which the easing has the value `y`: the inverse of [`Self::apply`]. Where
    /// the curve is flat, many `x` have the same value; any one of them is returned.
    #[must_use]
    pub fn inverse(self, y: f64) -> f64 {
        match self {
            Self::Named(easing) => easing.inverse(y),
            Self::Bezier(curve) => curve.inverse(y),
        }
    }

    /// Returns the easing that gives the same motion when time runs backwards: x ↦ 1 − f(1 − x).
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Named(easing) => easing.reversed().into(),
            Self::Bezier(curve) => Self::Bezier(curve.reversed()),
        }
    }

    /// Returns the easing as a Bézier curve, for editing its handles by hand.
    #[must_use]
    pub fn curve(self) -> EasingBezier {
        match self {
            Self::Named(easing) => EasingBezier::from_named(easing),
            Self::Bezier(curve) => curve,
        }
    }
}

impl fmt::Display for EasingFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Named(easing) => easing.fmt(f),
            Self::Bezier(EasingBezier([a, b, c, d])) => write!(f, "{a},{b},{c},{d}"),
        }
    }
}

impl FromStr for EasingFunction {
    type Err = String;

    /// Parses the name of an easing, or four handle coordinates separated by commas.
    fn from_str(text: &str) -> Result<Self, String> {
        if !text.contains(',') {
            let named = NamedEasing::of_key(text).map(Self::Named);
            return named.map_err(|error| format!("{error}, or four numbers like 0.3,0,0.1,1"));
        }
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        let handles = numbers.ok().and_then(|all| all.try_into().ok());
        let curve = handles.ok_or(EasingBezierError).and_then(EasingBezier::new);
        curve.map(Self::Bezier).map_err(|error| error.to_string())
    }
}

impl Serialize for EasingFunction {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Named(easing) => easing.serialize(to),
            Self::Bezier(curve) => curve.0.serialize(to),
        }
    }
}

impl<'de> Deserialize<'de> for EasingFunction {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct EasingVisitor;

        impl<'de> Visitor<'de> for EasingVisitor {
            type Value = EasingFunction;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of an easing, or the four numbers of an easing curve")
            }

            fn visit_str<E: Error>(self, key: &str) -> Result<EasingFunction, E> {
                NamedEasing::of_key(key)
                    .map(EasingFunction::Named)
                    .map_err(E::custom)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut all: A) -> Result<EasingFunction, A::Error> {
                let mut handles = Vec::new();
                while let Some(number) = all.next_element::<f64>()? {
                    handles.push(number);
                }
                let handles = handles
                    .try_into()
                    .map_err(|_| A::Error::custom(EasingBezierError))?;
                EasingBezier::new(handles)
                    .map(EasingFunction::Bezier)
                    .map_err(A::Error::custom)
            }
        }

        from.deserialize_any(EasingVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bezier_curves_of_named_easings_equal_them() {
        for easing in NamedEasing::ALL {
            let curve = EasingFunction::from(easing).curve();
            for k in 0..=20 {
                let x = f64::from(k) / 20.0;
                let (drawn, named) = (EasingFunction::Bezier(curve).apply(x), easing.apply(x));
                assert!((drawn - named).abs() < 1e-12, "{easing:?} at {x}");
            }
        }
    }

    #[test]
    fn backwards_mirrors_the_curve_about_its_centre() {
        let drawn = EasingBezier::new([0.9, 0.0, 1.0, 0.2]).expect("a curve");
        let named = NamedEasing::ALL.map(EasingFunction::from).into_iter();
        for ease in named.chain([EasingFunction::Bezier(drawn)]) {
            for x in [0.0, 0.2, 0.5, 0.9, 1.0] {
                let gap = ease.reversed().apply(x) - (1.0 - ease.apply(1.0 - x));
                assert!(gap.abs() < 1e-12, "{ease} at {x}");
            }
        }
    }

    #[test]
    fn invalid_easing_text_is_refused() {
        for text in ["0,0,1", "0,0,1,2", "0,0,1,x", "0,0,NaN,1", "quick", ""] {
            assert!(text.parse::<EasingFunction>().is_err(), "{text}");
        }
    }

    proptest! {
        #[test]
        fn a_curve_never_falls_and_its_inverse_inverts_it(
            handles in prop::array::uniform4(0.0f64..=1.0), x in 0.0f64..=1.0, more in 0.0f64..0.5,
        ) {
            let ease = EasingFunction::Bezier(EasingBezier::new(handles).expect("a curve"));
            let y = ease.apply(x);
            prop_assert!((0.0..=1.0).contains(&y));
            prop_assert!(ease.apply((x + more).min(1.0)) >= y - 1e-9);
            // On flat stretches many x have the same y, so only y is compared.
            prop_assert!((ease.apply(ease.inverse(y)) - y).abs() < 1e-6);
            let text = ease.to_string();
            prop_assert_eq!(text.parse::<EasingFunction>(), Ok(ease));
        }
    }
}
