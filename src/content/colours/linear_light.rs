//! Pixels in linear light, alpha premultiplied, and back.
//!
//! Guarantees: a pixel of 8 bits a channel there and back is the same pixel,
//! except for the colour of what is wholly transparent.

use crate::colour::{linear_from_srgb, srgb_from_linear};
use glam::Vec4;
use image::Rgba;
use std::sync::LazyLock;

/// Red, green, blue in linear light times alpha, and alpha, all in [0, 1].
pub(super) type LinearLight = Vec4;

/// Steps of the way back: near black one step is a twentieth of an 8-bit
/// step.
const STEPS: usize = 1 << 16;

/// From here on alpha counts as 1: what is opaque stays so within rounding.
const OPAQUE: f32 = 1.0 - 1e-6;

/// Added to a number below it, it leaves that number, rounded to a whole one,
/// in the lowest bits: 2^23.
const WHOLE: f32 = 8_388_608.0;

static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|k| linear_from_srgb(k as f64 / 255.0) as f32));

static ENCODED: LazyLock<Box<[u8; STEPS]>> = LazyLock::new(|| {
    let step = |k: usize| srgb_from_linear(k as f64 / (STEPS - 1) as f64);
    Box::new(std::array::from_fn(|k| (step(k) * 255.0).round() as u8))
});

/// A pixel in linear light.
pub(super) fn decoded(pixel: Rgba<u8>) -> LinearLight {
    let [r, g, b, a] = pixel.0;
    let alpha = f32::from(a) / 255.0;
    let light = |channel: u8| LINEAR[usize::from(channel)] * alpha;
    Vec4::new(light(r), light(g), light(b), alpha)
}

/// The way from light to straight alpha in sRGB.
#[derive(Clone, Copy)]
pub(super) struct SrgbEncoder(&'static [u8; STEPS]);

impl SrgbEncoder {
    pub fn new() -> Self {
        Self(&ENCODED)
    }

    /// Straight alpha in sRGB.
    #[inline]
    pub fn encoded(self, light: LinearLight) -> Rgba<u8> {
        let alpha = light.w;
        if alpha <= 0.0 {
            return Rgba([0; 4]);
        }
        // What is opaque is spared the division, and its rounding.
        let straight = if alpha < OPAQUE { light / alpha } else { light };
        let shares = straight.with_w(alpha).max(Vec4::ZERO).min(Vec4::ONE);
        let most = (STEPS - 1) as f32;
        // Alpha is not light: it has 255 steps and no curve.
        let steps = shares * Vec4::new(most, most, most, 255.0) + WHOLE;
        let [r, g, b, alpha] = steps.to_array().map(f32::to_bits);
        let channel = |step: u32| self.0[usize::from(step as u16)];
        Rgba([channel(r), channel(g), channel(b), alpha as u8])
    }
}

/// The bytes of premultiplied light, coded as it is.
pub(super) fn coded_premultiplied(light: LinearLight) -> [u8; 4] {
    // As if opaque, so that nothing is divided out.
    let Rgba([r, g, b, _]) = SrgbEncoder::new().encoded(light.with_w(1.0));
    [r, g, b, (light.w * 255.0 + 0.5) as u8]
}

/// The mean of four.
pub(super) fn mean(of: [LinearLight; 4]) -> LinearLight {
    0.25 * (of[0] + of[1] + of[2] + of[3])
}

/// From `a` to `b`.
#[inline]
pub(super) fn mixed(a: LinearLight, b: LinearLight, share: f32) -> LinearLight {
    a + share * (b - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(light: LinearLight) -> Rgba<u8> {
        SrgbEncoder::new().encoded(light)
    }

    #[test]
    fn every_value_comes_back() {
        for value in 0..=255 {
            for alpha in [1, 7, 128, 254, 255] {
                let pixel = Rgba([value, 255 - value, value / 2, alpha]);
                assert_eq!(encoded(decoded(pixel)), pixel);
            }
        }
        assert_eq!(encoded(decoded(Rgba([9, 9, 9, 0]))), Rgba([0; 4]));
    }

    #[test]
    fn light_adds_up() {
        let [black, white] = [0, 255].map(|v| decoded(Rgba([v, v, v, 255])));
        assert_eq!(encoded(mixed(black, white, 0.5)).0, [188, 188, 188, 255]);
    }
}
