//! Blend modes (Compositing and Blending 1): shapes are cut along the shapes below them, and each
//! piece gets the colour that normal painting turns into the blended one.

use super::flat_areas::{FlatArea, flatten};
use super::ink_layers::{clip_rings, difference};
use super::shape::SvgShape;
use crate::colour::{Gradient, GradientStop, Paint, Rgb};
use usvg::BlendMode;

/// Number of parts into which the stretch between two stops is divided where the blended colour is
/// no linear function of the colour (tolerance: as fine as 8-bit steps of 32).
const STOP_PARTS: u8 = 8;

/// Blends shapes with those below them. Returns the new shapes, lowest first, and whether they are
/// exact.
pub(super) fn blend_shapes(
    shapes: Vec<SvgShape>,
    below: &[SvgShape],
    mode: BlendMode,
) -> (Vec<SvgShape>, bool) {
    let mut blended = Vec::new();
    let mut is_exact = true;
    // Shapes of one group hide each other before the group is blended.
    for shape in shapes.into_iter().flat_map(SvgShape::split_stroke) {
        let ground = flatten(below.iter(), Some(&shape.rings));
        is_exact &= ground.is_exact;
        let mut rest = shape.rings.clone();
        let mut pieces = Vec::new();
        for area in &ground.areas {
            rest = difference(&rest, &area.rings);
            let (piece, is_piece_exact) = blend_piece(&shape, area, mode);
            is_exact &= is_piece_exact;
            pieces.push(piece);
        }
        let free = SvgShape {
            rings: rest,
            ..shape
        };
        let all = std::iter::once(free).chain(pieces);
        blended.extend(all.filter(|piece| !piece.rings.is_empty()));
    }
    (blended, is_exact)
}

/// Blends the part of a shape that lies on one area.
fn blend_piece(shape: &SvgShape, area: &FlatArea, mode: BlendMode) -> (SvgShape, bool) {
    let piece = |paint: Paint, gradient: Option<Gradient>| SvgShape {
        rings: clip_rings(shape.rings.clone(), Some(&area.rings)),
        paint,
        gradient,
        is_stroke: shape.is_stroke,
        is_text: shape.is_text,
        stroke: None,
        name: shape.name.clone(),
    };
    let is_exact = shape.gradient.is_none() || area.gradient.is_none();
    let gradient = match (&shape.gradient, &area.gradient) {
        (Some(own), _) => {
            let fine = with_more_stops(own);
            Some(fine.map_paints(|paint| blend(paint, area.paint, mode)))
        }
        (None, Some(ground)) => {
            let fine = with_more_stops(ground);
            Some(fine.map_paints(|ground| blend(shape.paint, ground, mode)))
        }
        (None, None) => None,
    };
    let paint = match &gradient {
        Some(gradient) => gradient.mean(),
        None => blend(shape.paint, area.paint, mode),
    };
    (piece(paint, gradient), is_exact)
}

/// Inserts stops, so that a nonlinear function of the colours can be interpolated between them.
fn with_more_stops(gradient: &Gradient) -> Gradient {
    let mut stops: Vec<GradientStop> = gradient.stops.iter().take(1).copied().collect();
    for pair in gradient.stops.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        stops.extend((1..=STOP_PARTS).map(|k| {
            let share = f64::from(k) / f64::from(STOP_PARTS);
            let mix = |a: f64, b: f64| a + (b - a) * share;
            let channel = |i: usize| {
                let [a, b] = [from, to].map(|stop| f64::from(stop.paint.colour.0[i]));
                mix(a, b).round() as u8
            };
            GradientStop {
                offset: mix(from.offset, to.offset),
                paint: Paint {
                    colour: Rgb(std::array::from_fn(channel)),
                    opacity: mix(from.paint.opacity, to.paint.opacity),
                },
            }
        }));
    }
    Gradient {
        stops,
        ..gradient.clone()
    }
}

/// Returns the paint that gives the blended colour when it is painted normally over `ground`
/// (Compositing and Blending 1, section 10.1).
fn blend(source: Paint, ground: Paint, mode: BlendMode) -> Paint {
    let [s, b] = [source, ground].map(|paint| paint.colour.0.map(|c| f64::from(c) / 255.0));
    let mixed = blended_colour(b, s, mode);
    let channel = |k: usize| {
        let value = (1.0 - ground.opacity) * s[k] + ground.opacity * mixed[k];
        (255.0 * value.clamp(0.0, 1.0)).round() as u8
    };
    Paint {
        colour: Rgb(std::array::from_fn(channel)),
        opacity: source.opacity,
    }
}

/// Blends two colours with channels from 0 to 1: `b` below, `s` above.
fn blended_colour(b: [f64; 3], s: [f64; 3], mode: BlendMode) -> [f64; 3] {
    let by_channel = |f: &dyn Fn(f64, f64) -> f64| std::array::from_fn(|k| f(b[k], s[k]));
    let hard_light = |b: f64, s: f64| match s <= 0.5 {
        true => b * 2.0 * s,
        false => screen(b, 2.0 * s - 1.0),
    };
    match mode {
        BlendMode::Normal => s,
        BlendMode::Multiply => by_channel(&|b, s| b * s),
        BlendMode::Screen => by_channel(&screen),
        BlendMode::Overlay => by_channel(&|b, s| hard_light(s, b)),
        BlendMode::Darken => by_channel(&f64::min),
        BlendMode::Lighten => by_channel(&f64::max),
        BlendMode::ColorDodge => by_channel(&|b, s| match (b, s) {
            (0.0, _) => 0.0,
            (_, 1.0) => 1.0,
            (b, s) => (b / (1.0 - s)).min(1.0),
        }),
        BlendMode::ColorBurn => by_channel(&|b, s| match (b, s) {
            (1.0, _) => 1.0,
            (_, 0.0) => 0.0,
            (b, s) => 1.0 - ((1.0 - b) / s).min(1.0),
        }),
        BlendMode::HardLight => by_channel(&hard_light),
        BlendMode::SoftLight => by_channel(&soft_light),
        BlendMode::Difference => by_channel(&|b, s| (b - s).abs()),
        BlendMode::Exclusion => by_channel(&|b, s| b + s - 2.0 * b * s),
        BlendMode::PlusLighter => by_channel(&|b, s| (b + s).min(1.0)),
        BlendMode::Hue => with_luminosity(with_saturation(s, saturation(b)), luminosity(b)),
        BlendMode::Saturation => with_luminosity(with_saturation(b, saturation(s)), luminosity(b)),
        BlendMode::Color => with_luminosity(s, luminosity(b)),
        BlendMode::Luminosity => with_luminosity(b, luminosity(s)),
    }
}

fn screen(b: f64, s: f64) -> f64 {
    b + s - b * s
}

fn soft_light(b: f64, s: f64) -> f64 {
    if s <= 0.5 {
        return b - (1.0 - 2.0 * s) * b * (1.0 - b);
    }
    let d = match b <= 0.25 {
        true => ((16.0 * b - 12.0) * b + 4.0) * b,
        false => b.sqrt(),
    };
    b + (2.0 * s - 1.0) * (d - b)
}

fn luminosity([r, g, b]: [f64; 3]) -> f64 {
    0.3 * r + 0.59 * g + 0.11 * b
}

fn saturation(c: [f64; 3]) -> f64 {
    c[0].max(c[1]).max(c[2]) - c[0].min(c[1]).min(c[2])
}

fn with_luminosity(c: [f64; 3], to: f64) -> [f64; 3] {
    let shift = to - luminosity(c);
    let c = c.map(|x| x + shift);
    let l = luminosity(c);
    let (low, high) = (c[0].min(c[1]).min(c[2]), c[0].max(c[1]).max(c[2]));
    let c = match low < 0.0 {
        true => c.map(|x| l + (x - l) * l / (l - low)),
        false => c,
    };
    match high > 1.0 {
        true => c.map(|x| l + (x - l) * (1.0 - l) / (high - l)),
        false => c,
    }
}

fn with_saturation(c: [f64; 3], to: f64) -> [f64; 3] {
    let low = c[0].min(c[1]).min(c[2]);
    let range = saturation(c);
    match range > 0.0 {
        true => c.map(|x| (x - low) * to / range),
        false => [0.0; 3],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paint(colour: [u8; 3], opacity: f64) -> Paint {
        Paint {
            colour: Rgb(colour),
            opacity,
        }
    }

    #[test]
    fn blended_colours_are_those_of_the_specification() {
        let (orange, blue) = (paint([255, 128, 0], 1.0), paint([0, 64, 255], 1.0));
        let cases = [
            (BlendMode::Multiply, [0, 32, 0]),
            (BlendMode::Screen, [255, 160, 255]),
            (BlendMode::Darken, [0, 64, 0]),
            (BlendMode::Lighten, [255, 128, 255]),
            (BlendMode::Difference, [255, 64, 255]),
            (BlendMode::Exclusion, [255, 128, 255]),
            (BlendMode::ColorDodge, [0, 129, 255]),
            (BlendMode::ColorBurn, [0, 0, 255]),
            (BlendMode::Luminosity, [116, 151, 255]),
        ];
        for (mode, expected) in cases {
            let found = blend(orange, blue, mode).colour.0;
            let near = found
                .iter()
                .zip(expected)
                .all(|(a, b): (&u8, u8)| a.abs_diff(b) <= 2);
            assert!(near, "{mode:?}: {found:?} for {expected:?}");
        }
    }

    #[test]
    fn a_transparent_ground_leaves_the_colour() {
        let source = paint([10, 20, 30], 0.5);
        let ground = paint([200, 100, 50], 0.0);
        assert_eq!(blend(source, ground, BlendMode::Multiply), source);
    }
}
