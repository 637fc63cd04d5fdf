//! Pixels in linear light, alpha premultiplied, and back.
//!
//! Guarantees: a pixel of 8 bits a channel there and back is the same pixel,
//! except for the colour of what is wholly transparent.

use image::Rgba;
use std::sync::LazyLock;

/// Red, green, blue in linear light times alpha, and alpha, all in [0, 1].
pub(super) type Light = [f32; 4];

/// Steps of the way back: near black one step is a twentieth of an 8-bit
/// step.
const STEPS: usize = 1 << 16;

static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let encoded = k as f64 / 255.0;
        let linear = if encoded <= 0.04045 {
            encoded / 12.92
        } else {
            ((encoded + 0.055) / 1.055).powf(2.4)
        };
        linear as f32
    })
});

static ENCODED: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let encode = |k: usize| {
        let linear = k as f64 / (STEPS - 1) as f64;
        let encoded = if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * linear.powf(1.0 / 2.4) - 0.055
        };
        (encoded * 255.0).round() as u8
    };
    (0..STEPS).map(encode).collect()
});

/// The curve of IEC 61966-2-1 (sRGB), undone.
pub(super) fn decoded(pixel: Rgba<u8>) -> Light {
    let [r, g, b, a] = pixel.0;
    let alpha = f32::from(a) / 255.0;
    let light = |channel: u8| LINEAR[usize::from(channel)] * alpha;
    [light(r), light(g), light(b), alpha]
}

/// Straight alpha in sRGB.
pub(super) fn encoded(light: Light) -> Rgba<u8> {
    let alpha = light[3];
    if alpha <= 0.0 {
        return Rgba([0; 4]);
    }
    let channel = |k: usize| {
        let step = light[k] / alpha * (STEPS - 1) as f32 + 0.5;
        ENCODED[(step as usize).min(STEPS - 1)] // NaN and below zero go to 0
    };
    let opacity = (alpha * 255.0 + 0.5) as u8;
    Rgba([channel(0), channel(1), channel(2), opacity])
}

/// The bytes of premultiplied light, coded as it is.
pub(super) fn coded_premultiplied(light: Light) -> [u8; 4] {
    let Rgba([r, g, b, _]) = encoded([light[0], light[1], light[2], 1.0]);
    [r, g, b, (light[3] * 255.0 + 0.5) as u8]
}

/// The mean of four.
pub(super) fn mean(of: [Light; 4]) -> Light {
    std::array::from_fn(|k| 0.25 * (of[0][k] + of[1][k] + of[2][k] + of[3][k]))
}

/// From `a` to `b`.
#[inline]
pub(super) fn mixed(a: Light, b: Light, share: f32) -> Light {
    std::array::from_fn(|k| a[k] + share * (b[k] - a[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

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
