//! Colours, flat paints, gradients and strokes, and interpolation between them.
//!
//! A [`Paint`] is interpolated in OKLab (Ottosson 2020), a colour space in which equal distances
//! look equal. Its colour is multiplied by its opacity first, so a paint that fades in from full
//! transparency keeps its own colour. The colour of a design without paints is interpolated in
//! linear light instead ([`Rgb::mixed`]).

mod gradient;

pub use gradient::{Gradient, GradientGeometry, GradientSpread, GradientStop};

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Decodes an sRGB value to linear light (IEC 61966-2-1); both in [0, 1].
pub(crate) fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// Encodes linear light as an sRGB value (IEC 61966-2-1); both in [0, 1].
pub(crate) fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// Opaque sRGB colour: red, green and blue, 0 to 255 each. Its text form is `#rrggbb`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rgb(pub [u8; 3]);

/// Error of parsing a colour. Holds the text that is not a colour.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("\"{0}\" is not a colour; write it as #rrggbb, for example #3b78c2")]
pub struct ColourError(String);

impl std::str::FromStr for Rgb {
    type Err = ColourError;

    fn from_str(text: &str) -> Result<Self, ColourError> {
        let error = || ColourError(text.to_owned());
        let hex = text.strip_prefix('#').ok_or_else(error)?;
        // `from_str_radix` alone would accept "+f6fb3".
        if hex.len() != 6 || !hex.bytes().all(|b| b.is_ascii_hexdigit()) {
            return Err(error());
        }
        let value = u32::from_str_radix(hex, 16).map_err(|_| error())?;
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
    /// Interpolates towards `other` in linear light: `t` = 0 gives `self`, `t` = 1 gives `other`.
    /// `t` is clamped to [0, 1].
    ///
    /// ```
    /// use morphospace::colour::Rgb;
    /// let grey = Rgb([0, 0, 0]).mixed(Rgb([255, 255, 255]), 0.5);
    /// assert_eq!(grey, Rgb([188, 188, 188]));
    /// ```
    #[must_use]
    pub fn mixed(self, other: Self, t: f64) -> Self {
        let t = t.clamp(0.0, 1.0);
        Self(std::array::from_fn(|k| {
            let (a, b) = (decode_channel(self.0[k]), decode_channel(other.0[k]));
            encode_channel(a * (1.0 - t) + b * t)
        }))
    }

    /// Red, green and blue in linear light, in [0, 1].
    #[must_use]
    pub fn to_linear(self) -> [f32; 3] {
        self.0.map(|channel| decode_channel(channel) as f32)
    }
}

/// Decodes an 8-bit sRGB channel to linear light in [0, 1].
fn decode_channel(channel: u8) -> f64 {
    linear_from_srgb(f64::from(channel) / 255.0)
}

/// Encodes linear light as an 8-bit sRGB channel; light outside [0, 1] is clamped.
fn encode_channel(light: f64) -> u8 {
    (srgb_from_linear(light) * 255.0).round().clamp(0.0, 255.0) as u8
}

/// Flat paint: one colour with an opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paint {
    /// Colour of the paint.
    pub colour: Rgb,
    /// Opacity in [0, 1]: 1 hides everything below, 0 is invisible.
    pub opacity: f64,
}

impl From<Rgb> for Paint {
    fn from(colour: Rgb) -> Self {
        Self {
            colour,
            opacity: 1.0,
        }
    }
}

impl Paint {
    /// Interpolates towards `other` in OKLab with premultiplied opacity. `t` is clamped to [0, 1];
    /// `t` = 0 returns `self` and `t` = 1 returns `other` exactly.
    ///
    /// ```
    /// use morphospace::colour::{Paint, Rgb};
    /// let [red, none] = [1.0, 0.0].map(|opacity| Paint { colour: Rgb([255, 0, 0]), opacity });
    /// let half = red.mixed(none, 0.5);
    /// assert_eq!((half.colour, half.opacity), (red.colour, 0.5));
    /// ```
    #[must_use]
    pub fn mixed(self, other: Self, t: f64) -> Self {
        let t = t.clamp(0.0, 1.0);
        if t == 0.0 || self == other {
            return self;
        }
        if t == 1.0 {
            return other;
        }
        let opacity = self.opacity * (1.0 - t) + other.opacity * t;
        if opacity <= 0.0 {
            return Self { opacity, ..self };
        }
        let share = other.opacity * t / opacity;
        let [a, b] = [self, other].map(|paint| paint.colour.to_oklab());
        let lab = std::array::from_fn(|k| a[k] * (1.0 - share) + b[k] * share);
        Self {
            colour: Rgb::from_oklab(lab),
            opacity,
        }
    }

    /// Whether the paint hides everything below it.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.opacity >= 1.0
    }

    /// Returns how different two paints look: their distance in OKLab with premultiplied opacity,
    /// where opacity is the fourth coordinate. Opaque black and white have distance 1.
    #[must_use]
    pub fn difference(&self, other: &Self) -> f64 {
        let [a, b] = [self, other].map(|paint| {
            let [l, a, b] = paint.colour.to_oklab();
            [l, a, b, 1.0].map(|x| x * paint.opacity)
        });
        let square = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
        square.sum::<f64>().sqrt()
    }
}

/// Style of a stroke that is centred on an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeStyle {
    /// Paint of the stroke.
    pub paint: Paint,
    /// Full width of the stroke, in units of the design.
    pub width: f64,
    /// Shape of the corners of the stroke.
    pub join: StrokeJoin,
    /// Whether the fill is drawn over the stroke, so that only the outer half of the stroke is
    /// visible (`paint-order: stroke` in SVG).
    pub is_below_fill: bool,
}

/// Shape of the corners of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StrokeJoin {
    /// Pointed, if the distance from the corner of the outline to the tip is at most this many half
    /// widths of the stroke; otherwise bevelled.
    Mitre(f64),
    /// Rounded by a sector of a disc.
    Round,
    /// Cut off straight.
    Bevel,
}

impl StrokeStyle {
    /// Interpolates between the strokes at t = 0 and t = 1. The width changes linearly and the
    /// paint as in [`Paint::mixed`]; the corner shape and the order of stroke and fill switch at
    /// t = 0.5. If one of `ends` is
    /// `None`, it counts as the other stroke with width 0. Returns `None` if both are. `t` is
    /// clamped to [0, 1].
    #[must_use]
    pub fn interpolated(ends: [Option<Self>; 2], t: f64) -> Option<Self> {
        let without_width = |line: Self| Self { width: 0.0, ..line };
        let (a, b) = match ends {
            [None, None] => return None,
            [Some(a), Some(b)] => (a, b),
            [Some(a), None] => (a, without_width(a)),
            [None, Some(b)] => (without_width(b), b),
        };
        let t = t.clamp(0.0, 1.0);
        Some(Self {
            paint: a.paint.mixed(b.paint, t),
            width: a.width * (1.0 - t) + b.width * t,
            join: if t < 0.5 { a.join } else { b.join },
            is_below_fill: if t < 0.5 {
                a.is_below_fill
            } else {
                b.is_below_fill
            },
        })
    }
}

impl Rgb {
    /// Converts to OKLab: lightness in [0, 1], then the coordinates from green to red and from blue
    /// to yellow.
    fn to_oklab(self) -> [f64; 3] {
        let [r, g, b] = self.0.map(decode_channel);
        let cones = [
            0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b,
            0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b,
            0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b,
        ];
        let [l, m, s] = cones.map(f64::cbrt);
        [
            0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
            1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
            0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
        ]
    }

    /// Converts from OKLab and clamps each channel to the range of sRGB.
    fn from_oklab([light, a, b]: [f64; 3]) -> Self {
        let cones = [
            light + 0.396_337_777_4 * a + 0.215_803_757_3 * b,
            light - 0.105_561_345_8 * a - 0.063_854_172_8 * b,
            light - 0.089_484_177_5 * a - 1.291_485_548_0 * b,
        ];
        let [l, m, s] = cones.map(|cone| cone.powi(3));
        Self(
            [
                4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
                -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
                -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
            ]
            .map(encode_channel),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_read_and_written() {
        assert_eq!("#2f6fb3".parse(), Ok(Rgb([0x2f, 0x6f, 0xb3])));
        assert_eq!(Rgb([1, 2, 255]).to_string(), "#0102ff");
        for text in [
            "2f6fb3",
            "#2f6fb",
            "#2f6fb3ff",
            "#gg0000",
            "#+f6fb3",
            "#é0000",
            "",
        ] {
            assert!(text.parse::<Rgb>().is_err(), "{text}");
        }
    }

    #[test]
    fn linear_light_and_oklab_round_trip_every_channel() {
        for channel in 0..=255 {
            assert_eq!(encode_channel(decode_channel(channel)), channel);
            let colour = Rgb([channel, 255 - channel, channel / 3]);
            assert_eq!(Rgb::from_oklab(colour.to_oklab()), colour);
        }
    }

    /// Compares with the reference values of Ottosson for white and pure red.
    #[test]
    fn oklab_matches_the_reference_values() {
        let [l, a, b] = Rgb([255; 3]).to_oklab();
        assert!((l - 1.0).abs() < 1e-6 && a.abs() < 1e-6 && b.abs() < 1e-6);
        let red = Rgb([255, 0, 0]).to_oklab();
        for (actual, expected) in red.into_iter().zip([0.627_955, 0.224_863, 0.125_846]) {
            assert!(
                (actual - expected).abs() < 1e-5,
                "{actual} is not {expected}"
            );
        }
    }

    #[test]
    fn paints_are_exact_at_the_ends_and_keep_their_hue_while_fading() {
        let [red, blue] = [Rgb([200, 30, 20]), Rgb([10, 60, 220])].map(Paint::from);
        let transparent = Paint {
            opacity: 0.0,
            ..blue
        };
        for (from, to) in [(red, blue), (red, transparent), (transparent, red)] {
            assert_eq!(from.mixed(to, -1.0), from);
            assert_eq!(from.mixed(to, 1.0), to);
            let (there, back) = (from.mixed(to, 0.25), to.mixed(from, 0.75));
            assert_eq!(there.colour, back.colour);
        }
        let faint = transparent.mixed(red, 0.1);
        assert_eq!(faint.colour, red.colour);
        assert!((faint.opacity - 0.1).abs() < 1e-12);
        assert!(red.difference(&blue) > 0.3 && red.difference(&red) == 0.0);
    }

    #[test]
    fn a_stroke_of_only_one_end_grows_in_width() {
        let line = StrokeStyle {
            paint: Rgb([1, 2, 3]).into(),
            width: 4.0,
            join: StrokeJoin::Round,
            is_below_fill: false,
        };
        assert_eq!(StrokeStyle::interpolated([None, None], 0.5), None);
        assert_eq!(
            StrokeStyle::interpolated([None, Some(line)], 1.0),
            Some(line)
        );
        let quarter = StrokeStyle::interpolated([None, Some(line)], 0.25).expect("a line");
        assert_eq!((quarter.width, quarter.paint), (1.0, line.paint));
        let wide = StrokeStyle {
            width: 8.0,
            join: StrokeJoin::Bevel,
            ..line
        };
        let half = StrokeStyle::interpolated([Some(line), Some(wide)], 0.5).expect("a line");
        assert_eq!((half.width, half.join), (6.0, StrokeJoin::Bevel));
    }
}
