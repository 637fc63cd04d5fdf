//! Conversion between 8-bit sRGB pixels with straight alpha and linear light with premultiplied
//! alpha.
//!
//! Guaranteed: an 8-bit pixel that is converted to linear light and back is unchanged, except that
//! a fully transparent pixel loses its colour.

use crate::colour::{linear_from_srgb, srgb_from_linear};
use glam::Vec4;
use image::Rgba;
use std::sync::LazyLock;

/// Red, green and blue in linear light, each multiplied by alpha, then alpha; all in [0, 1].
pub(super) type LinearLight = Vec4;

/// Number of entries of the table from linear light to 8-bit sRGB (tolerance: near black, where
/// sRGB is steepest, two neighbouring entries differ by a twentieth of an 8-bit step).
const TABLE_SIZE: usize = 1 << 16;

/// Alpha from which a pixel counts as opaque (tolerance: sums of weights that should be 1 differ
/// from 1 by rounding).
const OPAQUE: f32 = 1.0 - 1e-6;

/// The number 2²³. If it is added to a smaller non-negative `f32`, the lowest bits of the sum
/// contain the smaller number, rounded to an integer.
const ROUNDING_OFFSET: f32 = 8_388_608.0;

/// Linear light of each 8-bit sRGB value.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|k| linear_from_srgb(k as f64 / 255.0) as f32));

/// Table of the 8-bit sRGB values of evenly spaced linear light from 0 to 1.
static ENCODED: LazyLock<Box<[u8; TABLE_SIZE]>> = LazyLock::new(|| {
    let step = |k: usize| srgb_from_linear(k as f64 / (TABLE_SIZE - 1) as f64);
    Box::new(std::array::from_fn(|k| (step(k) * 255.0).round() as u8))
});

/// Converts an sRGB pixel with straight alpha to premultiplied linear light.
pub(super) fn decode(pixel: Rgba<u8>) -> LinearLight {
    let [r, g, b, a] = pixel.0;
    let alpha = f32::from(a) / 255.0;
    let light = |channel: u8| LINEAR[usize::from(channel)] * alpha;
    Vec4::new(light(r), light(g), light(b), alpha)
}

/// Encoder of linear light to sRGB with straight alpha. It refers to the encoding table, so that no
/// pixel has to check whether the table is initialised.
#[derive(Clone, Copy)]
pub(super) struct SrgbEncoder(&'static [u8; TABLE_SIZE]);

impl SrgbEncoder {
    pub fn new() -> Self {
        Self(&ENCODED)
    }

    /// Converts linear light with premultiplied alpha to an sRGB pixel with straight alpha.
    #[inline]
    pub fn encode(self, light: LinearLight) -> Rgba<u8> {
        let alpha = light.w;
        if alpha <= 0.0 {
            return Rgba([0; 4]);
        }
        // For opaque pixels the division and its rounding error are avoided.
        let straight = if alpha < OPAQUE { light / alpha } else { light };
        let clamped = straight.with_w(alpha).max(Vec4::ZERO).min(Vec4::ONE);
        let last_entry = (TABLE_SIZE - 1) as f32;
        // Alpha is not encoded as sRGB but stored linearly, in 255 steps.
        let steps =
            clamped * Vec4::new(last_entry, last_entry, last_entry, 255.0) + ROUNDING_OFFSET;
        let [r, g, b, alpha] = steps.to_array().map(f32::to_bits);
        let channel = |step: u32| self.0[usize::from(step as u16)];
        Rgba([channel(r), channel(g), channel(b), alpha as u8])
    }
}

/// Converts linear light with premultiplied alpha to sRGB bytes without dividing by alpha, for
/// textures with premultiplied alpha.
pub(super) fn encode_premultiplied(light: LinearLight) -> [u8; 4] {
    // Encoded as if it were opaque, so that nothing is divided by alpha.
    let Rgba([r, g, b, _]) = SrgbEncoder::new().encode(light.with_w(1.0));
    [r, g, b, (light.w * 255.0 + 0.5) as u8]
}

/// Returns the mean of four pixels.
pub(super) fn mean(of: [LinearLight; 4]) -> LinearLight {
    0.25 * (of[0] + of[1] + of[2] + of[3])
}

/// Interpolates linearly from `a` to `b`; `share` is the fraction of `b`.
#[inline]
pub(super) fn mix(a: LinearLight, b: LinearLight, share: f32) -> LinearLight {
    a + share * (b - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(light: LinearLight) -> Rgba<u8> {
        SrgbEncoder::new().encode(light)
    }

    #[test]
    fn every_value_survives_the_round_trip() {
        for value in 0..=255 {
            for alpha in [1, 7, 128, 254, 255] {
                let pixel = Rgba([value, 255 - value, value / 2, alpha]);
                assert_eq!(encoded(decode(pixel)), pixel);
            }
        }
        assert_eq!(encoded(decode(Rgba([9, 9, 9, 0]))), Rgba([0; 4]));
    }

    #[test]
    fn black_and_white_mix_to_half_the_light() {
        let [black, white] = [0, 255].map(|v| decode(Rgba([v, v, v, 255])));
        assert_eq!(encoded(mix(black, white, 0.5)).0, [188, 188, 188, 255]);
    }
}
