//! Colours (CSS Color 5): all notations that browsers read, converted to `#rrggbb` or `rgba(…)`.

use super::math::{CssQuantityKind, LengthContext, PercentageBasis, evaluate};
use super::tokens::{components, split_outside_brackets};
use crate::colour::{Paint, Rgb};
use color::{AlphaColor, ColorSpaceTag, DynamicColor, HueDirection, Rgba8, Srgb, parse_color};
use std::str::FromStr;

/// Maximum depth of colours within colours (resource limit: the parser recurses).
const MAX_DEPTH: usize = 8;

/// System colours of a light page (CSS Color 4, section 6.2), as browsers draw them by default.
const SYSTEM: [(&str, [u8; 3]); 12] = [
    ("canvas", [255, 255, 255]),
    ("canvastext", [0, 0, 0]),
    ("linktext", [0, 0, 238]),
    ("visitedtext", [85, 26, 139]),
    ("activetext", [255, 0, 0]),
    ("buttonface", [239, 239, 239]),
    ("buttontext", [0, 0, 0]),
    ("field", [255, 255, 255]),
    ("fieldtext", [0, 0, 0]),
    ("graytext", [128, 128, 128]),
    ("windowtext", [0, 0, 0]),
    ("window", [255, 255, 255]),
];

/// Converts a colour to a notation that `usvg` reads. `current` is the value of `currentColor`.
/// Returns `None` if the text is no colour.
pub(in crate::design::svg) fn plain_colour(
    text: &str,
    current: &str,
    context: &LengthContext,
) -> Option<String> {
    let text = text.trim();
    if text.eq_ignore_ascii_case("currentcolor") {
        return Some("currentColor".to_owned());
    }
    let parser = ColourParser { current, context };
    parser.colour(text, 0).map(plain_notation)
}

/// Returns the paint of a colour in the notation of [`plain_colour`]; `None` if it is transparent.
pub(in crate::design::svg) fn paint_of_plain(text: &str) -> Option<Paint> {
    let colour: AlphaColor<Srgb> = parse_color(text).ok()?.to_alpha_color();
    let Rgba8 { r, g, b, .. } = colour.to_rgba8();
    let opacity = f64::from(colour.components[3]);
    (opacity > 0.0).then_some(Paint {
        colour: Rgb([r, g, b]),
        opacity,
    })
}

/// Writes a colour in sRGB; components outside of the gamut are clipped, as in browsers.
fn plain_notation(colour: DynamicColor) -> String {
    let colour: AlphaColor<Srgb> = colour.to_alpha_color();
    let alpha = f64::from(colour.components[3]).clamp(0.0, 1.0);
    let Rgba8 { r, g, b, .. } = colour.to_rgba8();
    match alpha {
        1.0 => format!("#{r:02x}{g:02x}{b:02x}"),
        alpha => format!("rgba({r}, {g}, {b}, {alpha})"),
    }
}

struct ColourParser<'c> {
    current: &'c str,
    context: &'c LengthContext,
}

impl ColourParser<'_> {
    fn colour(&self, text: &str, depth: usize) -> Option<DynamicColor> {
        if depth > MAX_DEPTH {
            return None;
        }
        let text = text.trim();
        // Both spellings of grey are valid.
        let lower = text.to_ascii_lowercase().replace("grey", "gray");
        if lower == "currentcolor" {
            return parse_color(self.current).ok();
        }
        if let Some((_, [r, g, b])) = SYSTEM.iter().find(|(name, _)| *name == lower) {
            let colour = AlphaColor::<Srgb>::from_rgba8(*r, *g, *b, 255);
            return Some(DynamicColor::from_alpha_color(colour));
        }
        if let Some((function, arguments)) = lower.split_once('(') {
            let arguments = arguments.strip_suffix(')')?;
            match function {
                "light-dark" => {
                    let light = split_outside_brackets(arguments, ',').next()?;
                    return self.colour(light, depth + 1);
                }
                "color-mix" => return self.mix(arguments, depth),
                _ => {}
            }
            return match arguments.trim_start().strip_prefix("from ") {
                Some(relative) => self.relative(function, relative, depth),
                None if mixes_units(function, arguments) => None,
                None => parse_color(&self.absolute(function, arguments)).ok(),
            };
        }
        parse_color(&lower).ok()
    }

    /// Replaces the mathematical functions of a colour, and a percentage of opacity after a comma,
    /// by their values.
    fn absolute(&self, function: &str, arguments: &str) -> String {
        if !arguments.contains('(') {
            let opacity = arguments.rsplit_once(',');
            let opacity = opacity.filter(|(before, _)| before.matches(',').count() == 2);
            let percent = opacity.and_then(|(before, last)| {
                let percent: f64 = last.trim().strip_suffix('%')?.parse().ok()?;
                Some(format!("{function}({before}, {})", percent / 100.0))
            });
            return percent.unwrap_or_else(|| format!("{function}({arguments})"));
        }
        let spaced = arguments.replace(',', " , ").replace('/', " / ");
        let plain = components(&spaced).into_iter().map(|part| {
            let is_function = part.ends_with(')');
            let value = is_function.then(|| evaluate(part, self.context, PercentageBasis::One));
            value
                .flatten()
                .map_or(part.to_owned(), |found| match found.kind {
                    CssQuantityKind::Angle => format!("{}deg", found.value.to_degrees()),
                    _ if part.contains('%') => format!("{}%", 100.0 * found.value),
                    _ => found.value.to_string(),
                })
        });
        let plain = plain.collect::<Vec<_>>().join(" ").replace(" , ", ", ");
        format!("{function}({plain})")
    }

    /// Mixes two colours: `in <space> [<hue> hue], <colour> [<percentage>], …`.
    fn mix(&self, arguments: &str, depth: usize) -> Option<DynamicColor> {
        let parts: Vec<_> = split_outside_brackets(arguments, ',').collect();
        let (method, colours) = match parts.as_slice() {
            [method, a, b] if method.starts_with("in ") => (*method, [*a, *b]),
            [a, b] => ("in oklab", [*a, *b]),
            _ => return None,
        };
        let words = components(method);
        let space = space(words.get(1)?)?;
        let direction = match words.get(2) {
            Some(&"longer") => HueDirection::Longer,
            Some(&"increasing") => HueDirection::Increasing,
            Some(&"decreasing") => HueDirection::Decreasing,
            _ => HueDirection::Shorter,
        };
        let [(first, p), (second, q)] = {
            let mut read = colours.iter().map(|text| self.weighted(text, depth));
            [read.next()??, read.next()??]
        };
        let (p, q) = match (p, q) {
            (None, None) => (0.5, 0.5),
            (Some(p), None) => (p, 1.0 - p),
            (None, Some(q)) => (1.0 - q, q),
            (Some(p), Some(q)) => (p, q),
        };
        let total = p + q;
        if !(total > 0.0 && p >= 0.0 && q >= 0.0) {
            return None;
        }
        let mixed = first.interpolate(second, space, direction);
        let mixed = mixed.eval((q / total) as f32);
        // Weights that do not add up to 1 make the mixture translucent.
        Some(mixed.multiply_alpha(total.min(1.0) as f32))
    }

    /// Parses a colour with an optional percentage before or after it.
    fn weighted(&self, text: &str, depth: usize) -> Option<(DynamicColor, Option<f64>)> {
        let words = components(text);
        let is_weight =
            |word: &&str| word.ends_with('%') || word.starts_with("calc(") && word.contains('%');
        let weight = words.iter().position(is_weight);
        let value = weight.map(|i| evaluate(words[i], self.context, PercentageBasis::One));
        let value = match value {
            Some(found) => Some(found?.value),
            None => None,
        };
        let rest = words.iter().enumerate().filter(|(i, _)| Some(*i) != weight);
        let rest: Vec<_> = rest.map(|(_, word)| *word).collect();
        Some((self.colour(&rest.join(" "), depth + 1)?, value))
    }

    /// Evaluates a colour relative to another one: `<colour> <channel> <channel> <channel>
    /// [/ <alpha>]`, in which the names of channels stand for those of the other colour.
    fn relative(&self, function: &str, text: &str, depth: usize) -> Option<DynamicColor> {
        let spaced = text.replace('/', " / ");
        let words = components(&spaced);
        let (&origin, mut channels) = words.split_first()?;
        let mut tag = relative_space(function);
        if function == "color" {
            tag = space(channels.first()?);
            channels = &channels[1..];
        }
        let tag = tag?;
        let origin = self.colour(origin, depth + 1)?.convert(tag);
        // The channels of `rgb` count to 255, and those of `hsl` and `hwb` in percent.
        let scale = if function.starts_with("rgb") {
            255.0
        } else {
            1.0
        };
        let names = channel_names(tag);
        let values = origin.components;
        let value = |word: &str| -> Option<f64> {
            let mut expression = word.to_owned();
            for (name, channel) in names.iter().zip(values) {
                expression = replace_word(&expression, name, f64::from(channel) * scale);
            }
            expression = replace_word(&expression, "alpha", f64::from(values[3]));
            evaluate(&expression, self.context, PercentageBasis::One).map(|found| {
                match found.kind {
                    CssQuantityKind::Angle => found.value.to_degrees(),
                    _ => found.value,
                }
            })
        };
        let (alpha, channels) = match channels {
            [a, b, c] => (f64::from(values[3]), [a, b, c]),
            [a, b, c, "/", alpha] => (value(alpha)?, [a, b, c]),
            _ => return None,
        };
        let mut components = [0.0_f32; 4];
        let whole = whole_channels(tag);
        for ((component, word), whole) in components.iter_mut().zip(channels).zip(whole) {
            *component = match *word {
                "none" => 0.0,
                word if word.contains('%') => (whole * value(word)?) as f32,
                word => (value(word)? / scale) as f32,
            };
        }
        components[3] = alpha.clamp(0.0, 1.0) as f32;
        Some(DynamicColor {
            cs: tag,
            components,
            ..origin
        })
    }
}

/// Replaces a name by a number wherever it stands as a whole word.
fn replace_word(text: &str, name: &str, value: f64) -> String {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_' || c == '.';
    let mut replaced = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(name) {
        let (before, after) = (&rest[..at], &rest[at + name.len()..]);
        let is_word = !before.ends_with(is_name) && !after.starts_with(is_name);
        replaced.push_str(before);
        match is_word {
            true => replaced.push_str(&value.to_string()),
            false => replaced.push_str(name),
        }
        rest = after;
    }
    replaced + rest
}

/// Returns whether the components of `rgb(…)`, separated by commas, are neither all numbers nor all
/// percentages.
fn mixes_units(function: &str, arguments: &str) -> bool {
    let parts: Vec<_> = split_outside_brackets(arguments, ',').collect();
    let percent = parts.iter().take(3).filter(|part| part.ends_with('%'));
    function.starts_with("rgb") && parts.len() >= 3 && !matches!(percent.count(), 0 | 3)
}

/// Returns the colour space of a function that gives a relative colour.
fn relative_space(function: &str) -> Option<ColorSpaceTag> {
    match function {
        "rgb" | "rgba" => Some(ColorSpaceTag::Srgb),
        "hsla" => Some(ColorSpaceTag::Hsl),
        name => space(name),
    }
}

fn space(name: &str) -> Option<ColorSpaceTag> {
    match name {
        "hsl" => Some(ColorSpaceTag::Hsl),
        "hwb" => Some(ColorSpaceTag::Hwb),
        name => ColorSpaceTag::from_str(name).ok(),
    }
}

/// Returns the values of the three channels of a colour space that count as 100 % (CSS Color 4,
/// section 4.1 and following). Hues have no percentages.
fn whole_channels(space: ColorSpaceTag) -> [f64; 3] {
    match space {
        ColorSpaceTag::Hsl | ColorSpaceTag::Hwb => [360.0, 100.0, 100.0],
        ColorSpaceTag::Lab => [100.0, 125.0, 125.0],
        ColorSpaceTag::Lch => [100.0, 150.0, 360.0],
        ColorSpaceTag::Oklab => [1.0, 0.4, 0.4],
        ColorSpaceTag::Oklch => [1.0, 0.4, 360.0],
        _ => [1.0; 3],
    }
}

/// Returns the names of the three channels of a colour space.
fn channel_names(space: ColorSpaceTag) -> [&'static str; 3] {
    match space {
        ColorSpaceTag::Hsl => ["h", "s", "l"],
        ColorSpaceTag::Hwb => ["h", "w", "b"],
        ColorSpaceTag::Lab | ColorSpaceTag::Oklab => ["l", "a", "b"],
        ColorSpaceTag::Lch | ColorSpaceTag::Oklch => ["l", "c", "h"],
        ColorSpaceTag::XyzD50 | ColorSpaceTag::XyzD65 => ["x", "y", "z"],
        _ => ["r", "g", "b"],
    }
}

#[cfg(test)]
mod tests {
    use super::super::math::tests::CONTEXT;
    use super::*;

    #[test]
    fn colours_equal_those_of_browsers() {
        let cases = [
            ("Red", "#ff0000"),
            ("#0F8", "#00ff88"),
            ("#ff000080", "rgba(255, 0, 0, 0.501"),
            ("rgb(10 20 30 / 50%)", "rgba(10, 20, 30, 0.5)"),
            ("rgba(10, 20, 30, .5)", "rgba(10, 20, 30, 0.5)"),
            ("rgba(10, 20, 30, 50%)", "rgba(10, 20, 30, 0.5)"),
            ("LightSlateGrey", "#778899"),
            ("rgb(10% 20% 30%)", "#1a334d"),
            ("hsl(120deg 100% 25%)", "#008000"),
            ("hwb(120 20% 20%)", "#33cc33"),
            ("lab(50% 40 59.5)", "#bf5700"),
            ("lch(50% 70 50)", "#c55218"),
            ("oklab(59% 0.1 0.1)", "#c05d2b"),
            ("oklch(60% 0.15 50)", "#c46016"),
            ("color(display-p3 0.5 0.5 0.5)", "#808080"),
            ("color(srgb 1 0.5 0)", "#ff8000"),
            ("color-mix(in srgb, red, blue)", "#800080"),
            ("color-mix(in srgb, red 25%, blue)", "#4000bf"),
            (
                "color-mix(in srgb, red 20%, blue 20%)",
                "rgba(128, 0, 128, 0.4",
            ),
            ("light-dark(red, blue)", "#ff0000"),
            ("rgb(from red calc(r - 55) g b)", "#c80000"),
            ("rgb(from currentColor r g b / 0.5)", "rgba(0, 0, 255, 0.5)"),
            ("hsl(from red calc(h + 120) s l)", "#00ff00"),
            ("rgb(calc(100 + 55) 0 0)", "#9b0000"),
            ("rgb(calc(25% + 25%) 0 0)", "#800000"),
            ("hsl(calc(2 * 60deg) 100% 25%)", "#008000"),
            ("hsl(120, calc(50% + 50%), 25%)", "#008000"),
            ("hsl(from red h 100% 25%)", "#800000"),
            ("rgb(from red 50% g none)", "#800000"),
            ("hwb(from red 120 w b)", "#00ff00"),
            ("color-mix(in srgb, red calc(10% + 15%), blue)", "#4000bf"),
            ("color-mix(in hsl, red, lime)", "#ffff00"),
            ("CanvasText", "#000000"),
            ("transparent", "rgba(0, 0, 0, 0)"),
        ];
        for (text, expected) in cases {
            let found = plain_colour(text, "blue", &CONTEXT).unwrap_or_else(|| panic!("{text}"));
            assert!(
                found.starts_with(expected),
                "{text}: {found} for {expected}"
            );
        }
    }

    #[test]
    fn invalid_colours_are_refused() {
        let deep = "light-dark(".repeat(1000) + &")".repeat(1000);
        for text in [
            "",
            "rde",
            "#12",
            "rgb(1 2)",
            "rgba(0, 50%, 0, 0.5)",
            "red icc-color(acmecmyk, 0.11, 0.48, 0.83, 0.00)",
            "color-mix(red)",
            "url(#a)",
            "none",
            &deep,
        ] {
            assert_eq!(plain_colour(text, "blue", &CONTEXT), None, "{text}");
        }
    }
}
