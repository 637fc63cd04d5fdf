//! Conversion between 8-bit sRGB pixels with straight alpha and linear light with premultiplied
//! alpha.
//!
//! Guaranteed: an 8-bit pixel converted to linear light and back is unchanged, except that fully
//! transparent pixels lose their colour.

use crate::colour::{linear_from_srgb, srgb_from_linear};
use glam::Vec4;
use image::Rgba;
use std::sync::LazyLock;

/// Red, green and blue in linear light, multiplied by alpha, and alpha; all in [0, 1].
pub(super) type LinearLight = Vec4;

/// Number of entries of the encoding table (tolerance: near black one entry is a twentieth of an
/// 8-bit step).
const TABLE_SIZE: usize = 1 << 16;

/// Alpha from which a pixel counts as opaque (tolerance: sums of weights that should be 1 differ
/// from it by rounding).
const OPAQUE: f32 = 1.0 - 1e-6;

/// 2²³. Adding it to a smaller non-negative `f32` leaves that number, rounded to an integer, in the
/// lowest bits.
const ROUNDING_OFFSET: f32 = 8_388_608.0;

/// Linear light of each 8-bit sRGB value.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|k| linear_from_srgb(k as f64 / 255.0) as f32));

/// 8-bit sRGB value for evenly spaced linear light in [0, 1].
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

/// Encodes linear light as sRGB with straight alpha. Holds the table, so that a pixel does not
/// check whether it is initialised.
#[derive(Clone, Copy)]
pub(super) struct SrgbEncoder(&'static [u8; TABLE_SIZE]);

impl SrgbEncoder {
    pub fn new() -> Self {
        Self(&ENCODED)
    }

    /// Converts premultiplied linear light to an sRGB pixel with straight alpha.
    #[inline]
    pub fn encode(self, light: LinearLight) -> Rgba<u8> {
        let alpha = light.w;
        if alpha <= 0.0 {
            return Rgba([0; 4]);
        }
        // Opaque pixels skip the division and its rounding error.
        let straight = if alpha < OPAQUE { light / alpha } else { light };
        let clamped = straight.with_w(alpha).max(Vec4::ZERO).min(Vec4::ONE);
        let last_entry = (TABLE_SIZE - 1) as f32;
        // Alpha is stored linearly, with 255 steps.
        let steps =
            clamped * Vec4::new(last_entry, last_entry, last_entry, 255.0) + ROUNDING_OFFSET;
        let [r, g, b, alpha] = steps.to_array().map(f32::to_bits);
        let channel = |step: u32| self.0[usize::from(step as u16)];
        Rgba([channel(r), channel(g), channel(b), alpha as u8])
    }
}

/// Encodes light as sRGB bytes without dividing by alpha, for textures with premultiplied alpha.
pub(super) fn encode_premultiplied(light: LinearLight) -> [u8; 4] {
    // Treated as opaque, so that nothing is divided by alpha.
    let Rgba([r, g, b, _]) = SrgbEncoder::new().encode(light.with_w(1.0));
    [r, g, b, (light.w * 255.0 + 0.5) as u8]
}

/// Mean of four pixels.
pub(super) fn mean(of: [LinearLight; 4]) -> LinearLight {
    0.25 * (of[0] + of[1] + of[2] + of[3])
}

/// Linear interpolation from `a` to `b`.
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
