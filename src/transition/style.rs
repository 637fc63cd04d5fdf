//! How a transition is painted: the colours that window and export share.

use crate::content::{linear_from_srgb, srgb_from_linear};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An opaque sRGB colour, written as `#rrggbb`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rgb(pub [u8; 3]);

/// A text that is no colour.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("\"{0}\" is no colour; write it as #rrggbb, for example #3b78c2")]
pub struct NoColour(String);

impl std::str::FromStr for Rgb {
    type Err = NoColour;

    fn from_str(text: &str) -> Result<Self, NoColour> {
        let wrong = || NoColour(text.to_owned());
        let hex = text.strip_prefix('#').ok_or_else(wrong)?;
        // `from_str_radix` alone would take "+f6fb3".
        if hex.len() != 6 || !hex.bytes().all(|b| b.is_ascii_hexdigit()) {
            return Err(wrong());
        }
        let value = u32::from_str_radix(hex, 16).map_err(|_| wrong())?;
        let [_, r, g, b] = value.to_be_bytes();
        Ok(Self([r, g, b]))
    }
}

impl std::fmt::Display for Rgb {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

impl Serialize for Rgb {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Rgb {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        text.parse().map_err(serde::de::Error::custom)
    }
}

impl Rgb {
    /// The colour at `t` in [0, 1] on the way to `other`, mixed in linear
    /// light; beyond that range the nearer end.
    ///
    /// ```
    /// use morphospace::transition::Rgb;
    /// let grey = Rgb([0, 0, 0]).mixed(Rgb([255, 255, 255]), 0.5);
    /// assert_eq!(grey, Rgb([188, 188, 188]));
    /// ```
    #[must_use]
    pub fn mixed(self, other: Self, t: f64) -> Self {
        let t = t.clamp(0.0, 1.0);
        Self(std::array::from_fn(|k| {
            let (a, b) = (linear(self.0[k]), linear(other.0[k]));
            encoded(a * (1.0 - t) + b * t)
        }))
    }

    /// Red, green and blue in linear light, in [0, 1].
    #[must_use]
    pub fn to_linear(self) -> [f32; 3] {
        self.0.map(|channel| linear(channel) as f32)
    }
}

/// A channel in linear light, in [0, 1].
fn linear(channel: u8) -> f64 {
    linear_from_srgb(f64::from(channel) / 255.0)
}

/// A channel of linear light, from [0, 1].
fn encoded(light: f64) -> u8 {
    (srgb_from_linear(light) * 255.0).round().clamp(0.0, 255.0) as u8
}

/// Colours and marks of a transition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Style {
    /// Fill at t = 0.
    pub source: Rgb,
    /// Fill at t = 1.
    pub target: Rgb,
    /// What is behind.
    pub ground: Rgb,
    /// Whether the joints of a truss are marked.
    pub joints: bool,
}

impl Default for Style {
    /// Blue to orange on warm white: told apart in every common form of
    /// colour blindness.
    fn default() -> Self {
        Self {
            source: Rgb([0x2f, 0x6f, 0xb3]),
            target: Rgb([0xd9, 0x82, 0x2b]),
            ground: Rgb([0xf7, 0xf5, 0xf0]),
            joints: true,
        }
    }
}

impl Style {
    /// The fill at `t`.
    #[must_use]
    pub fn fill_at(&self, t: f64) -> Rgb {
        self.source.mixed(self.target, t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_read_and_written() {
        assert_eq!("#2f6fb3".parse(), Ok(Rgb([0x2f, 0x6f, 0xb3])));
        assert_eq!(Rgb([1, 2, 255]).to_string(), "#0102ff");
        for wrong in [
            "2f6fb3",
            "#2f6fb",
            "#2f6fb3ff",
            "#gg0000",
            "#+f6fb3",
            "#é0000",
            "",
        ] {
            assert!(wrong.parse::<Rgb>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn ends_are_exact_and_extrapolation_stays_at_them() {
        let style = Style::default();
        for (t, colour) in [
            (-1.0, style.source),
            (0.0, style.source),
            (1.0, style.target),
            (9.0, style.target),
        ] {
            assert_eq!(style.fill_at(t), colour);
        }
        for channel in 0..=255 {
            assert_eq!(encoded(linear(channel)), channel);
        }
    }
}
