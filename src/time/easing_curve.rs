//! A way of running that somebody has drawn: a cubic curve with two handles.

use std::fmt;
use std::str::FromStr;

use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use super::easing::NamedEasing;
use crate::settings::choice::Choice;

/// A cubic Bézier curve from (0, 0) to (1, 1) with handles at (x₁, y₁) and
/// (x₂, y₂), as CSS has them, but that none of the four leaves [0, 1]: a share
/// never runs back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EasingBezier([f64; 4]);

/// Handles beyond [0, 1].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("a curve has four numbers from 0 to 1: two handles, x and y of each")]
pub struct EasingBezierError;

/// So often an interval is halved: as exact as numbers are.
const HALVINGS: u32 = 52;

impl EasingBezier {
    /// The curve with these handles: x₁, y₁, x₂, y₂.
    ///
    /// # Errors
    /// [`EasingBezierError`] where one is beyond [0, 1] or no number.
    pub fn new(handles: [f64; 4]) -> Result<Self, EasingBezierError> {
        let is_within = handles.iter().all(|h| (0.0..=1.0).contains(h));
        is_within.then_some(Self(handles)).ok_or(EasingBezierError)
    }

    /// The curve that comes nearest to one of the usual ways.
    #[must_use]
    pub fn like(easing: NamedEasing) -> Self {
        // Of a polynomial of the third degree in x exactly that.
        let third = 1.0 / 3.0;
        Self(match easing {
            NamedEasing::Linear => [third, third, 2.0 * third, 2.0 * third],
            NamedEasing::Smooth => [third, 0.0, 2.0 * third, 1.0],
            NamedEasing::EaseIn => [third, 0.0, 2.0 * third, third],
            NamedEasing::EaseOut => [third, 2.0 * third, 2.0 * third, 1.0],
        })
    }

    /// The same in what is run backwards: 1 − f(1 − x).
    #[must_use]
    pub fn backwards(self) -> Self {
        let [x1, y1, x2, y2] = self.0.map(|h| 1.0 - h);
        Self([x2, y2, x1, y1])
    }

    /// Its handles: x₁, y₁, x₂, y₂.
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

/// One coordinate at a parameter.
fn bernstein(a: f64, b: f64, s: f64) -> f64 {
    let r = 1.0 - s;
    s * (3.0 * r * (r * a + s * b) + s * s)
}

/// Where a coordinate has this value; it never falls.
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

/// How a share runs: in one of the usual ways, or along a curve.
///
/// ```
/// use morphospace::time::easing::{Ease, Easing};
/// let drawn: Ease = "0.3,0,0.1,1".parse()?;
/// assert!(drawn.apply(0.5) > 0.5);
/// assert_eq!("smooth".parse(), Ok(Ease::Named(Easing::Smooth)));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EasingFunction {
    /// In one of the usual ways.
    Named(NamedEasing),
    /// Along a curve.
    Drawn(EasingBezier),
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
    /// Maps [0, 1] onto itself, never falling.
    #[must_use]
    pub fn apply(self, x: f64) -> f64 {
        match self {
            Self::Named(easing) => easing.apply(x),
            Self::Drawn(curve) => curve.apply(x),
        }
    }

    /// The inverse of [`Self::apply`].
    #[must_use]
    pub fn inverse(self, y: f64) -> f64 {
        match self {
            Self::Named(easing) => easing.inverse(y),
            Self::Drawn(curve) => curve.inverse(y),
        }
    }

    /// The same in what is run backwards: 1 − f(1 − x).
    #[must_use]
    pub fn backwards(self) -> Self {
        match self {
            Self::Named(easing) => easing.backwards().into(),
            Self::Drawn(curve) => Self::Drawn(curve.backwards()),
        }
    }

    /// As a curve, to be changed by hand.
    #[must_use]
    pub fn curve(self) -> EasingBezier {
        match self {
            Self::Named(easing) => EasingBezier::like(easing),
            Self::Drawn(curve) => curve,
        }
    }
}

impl fmt::Display for EasingFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Named(easing) => easing.fmt(f),
            Self::Drawn(EasingBezier([a, b, c, d])) => write!(f, "{a},{b},{c},{d}"),
        }
    }
}

impl FromStr for EasingFunction {
    type Err = String;

    /// A name, or four numbers with commas between them.
    fn from_str(text: &str) -> Result<Self, String> {
        if !text.contains(',') {
            let named = NamedEasing::of_key(text).map(Self::Named);
            return named.map_err(|error| format!("{error}, or four numbers as 0.3,0,0.1,1"));
        }
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        let handles = numbers.ok().and_then(|all| all.try_into().ok());
        let curve = handles.ok_or(EasingBezierError).and_then(EasingBezier::new);
        curve.map(Self::Drawn).map_err(|error| error.to_string())
    }
}

impl Serialize for EasingFunction {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Named(easing) => easing.serialize(to),
            Self::Drawn(curve) => curve.0.serialize(to),
        }
    }
}

impl<'de> Deserialize<'de> for EasingFunction {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct EasingVisitor;

        impl<'de> Visitor<'de> for EasingVisitor {
            type Value = EasingFunction;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of an easing, or the four numbers of a curve")
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
                    .map(EasingFunction::Drawn)
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
    fn curves_like_the_usual_ways_run_as_they_do() {
        for easing in NamedEasing::ALL {
            let curve = EasingFunction::from(easing).curve();
            for k in 0..=20 {
                let x = f64::from(k) / 20.0;
                let (drawn, named) = (EasingFunction::Drawn(curve).apply(x), easing.apply(x));
                assert!((drawn - named).abs() < 1e-12, "{easing:?} at {x}");
            }
        }
    }

    #[test]
    fn backwards_is_the_same_way_from_the_other_end() {
        let drawn = EasingBezier::new([0.9, 0.0, 1.0, 0.2]).expect("a curve");
        let ways = NamedEasing::ALL.map(EasingFunction::from).into_iter();
        for ease in ways.chain([EasingFunction::Drawn(drawn)]) {
            for x in [0.0, 0.2, 0.5, 0.9, 1.0] {
                let gap = ease.backwards().apply(x) - (1.0 - ease.apply(1.0 - x));
                assert!(gap.abs() < 1e-12, "{ease} at {x}");
            }
        }
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        for text in ["0,0,1", "0,0,1,2", "0,0,1,x", "0,0,NaN,1", "quick", ""] {
            assert!(text.parse::<EasingFunction>().is_err(), "{text}");
        }
    }

    proptest! {
        #[test]
        fn a_curve_never_falls_and_can_be_run_back(
            handles in prop::array::uniform4(0.0f64..=1.0), x in 0.0f64..=1.0, more in 0.0f64..0.5,
        ) {
            let ease = EasingFunction::Drawn(EasingBezier::new(handles).expect("a curve"));
            let y = ease.apply(x);
            prop_assert!((0.0..=1.0).contains(&y));
            prop_assert!(ease.apply((x + more).min(1.0)) >= y - 1e-9);
            // Where it is flat many x have one y.
            prop_assert!((ease.apply(ease.inverse(y)) - y).abs() < 1e-6);
            let text = ease.to_string();
            prop_assert_eq!(text.parse::<EasingFunction>(), Ok(ease));
        }
    }
}
