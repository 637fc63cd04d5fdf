//! Basic shapes (CSS Shapes 1 and 2): `circle(…)`, `inset(…)`, `polygon(…)` and the like, converted
//! to path data.

use super::math::{CssQuantityKind, LengthContext, PercentageBasis, evaluate};
use super::properties::quoted;
use super::tokens::{components, find_outside_brackets, split_outside_brackets};
use crate::geometry::DVec2;

/// Names of the boxes to which a shape may refer (CSS Box 4).
const BOXES: [&str; 7] = [
    "fill-box",
    "content-box",
    "padding-box",
    "stroke-box",
    "border-box",
    "margin-box",
    "view-box",
];

/// Value of `clip-path` that is not a reference to an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::design::svg) struct ShapeValue<'v> {
    /// Function with its arguments; `None` for the whole box.
    pub function: Option<(&'v str, &'v str)>,
    /// Name of the reference box, in lower case.
    pub reference: &'static str,
}

impl<'v> ShapeValue<'v> {
    /// Splits a value into its function and its reference box. Returns `None` if it is no shape.
    pub(in crate::design::svg) fn of(value: &'v str) -> Option<Self> {
        let (mut function, mut reference) = (None, None);
        for word in components(value) {
            let known = BOXES.iter().find(|name| name.eq_ignore_ascii_case(word));
            match (known, word.split_once('(')) {
                (Some(name), _) if reference.is_none() => reference = Some(*name),
                (None, Some((name, rest))) if function.is_none() => {
                    function = Some((name, rest.strip_suffix(')')?));
                }
                _ => return None,
            }
        }
        let is_shape = function.is_some() || reference.is_some();
        is_shape.then(|| Self {
            function,
            reference: reference.unwrap_or("border-box"),
        })
    }
}

/// Outline of a basic shape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::design::svg) struct ShapeOutline {
    /// Path data relative to the corner of the reference box.
    pub data: String,
    pub is_even_odd: bool,
}

/// Reader of the arguments of basic shapes.
pub(in crate::design::svg) struct ShapeReader {
    /// Context whose viewport is the reference box.
    pub context: LengthContext,
    /// Whether numbers without units are lengths.
    pub plain_numbers: bool,
}

impl ShapeReader {
    /// Returns the outline of a shape; `None` if its arguments are invalid or unknown.
    pub(in crate::design::svg) fn outline(&self, shape: &ShapeValue) -> Option<ShapeOutline> {
        let size = self.context.viewport;
        let Some((name, arguments)) = shape.function else {
            return Some(non_zero(rectangle([0.0, 0.0, size.x, size.y], None)));
        };
        match name.to_ascii_lowercase().as_str() {
            "circle" => self.circle(arguments).map(non_zero),
            "ellipse" => self.ellipse(arguments).map(non_zero),
            "inset" | "rect" | "xywh" => self.box_shape(name, arguments).map(non_zero),
            "polygon" => self.polygon(arguments),
            "path" => path(arguments),
            _ => None,
        }
    }

    fn circle(&self, arguments: &str) -> Option<String> {
        let (radii, centre) = self.radii_and_centre(arguments)?;
        let radius = match radii.as_slice() {
            [] => self.side("closest-side", centre, &[0, 1])?,
            [word] => self
                .side(word, centre, &[0, 1])
                .or_else(|| self.length(word, PercentageBasis::Diagonal))?,
            _ => return None,
        };
        (radius >= 0.0).then(|| ellipse_path(centre, DVec2::splat(radius)))
    }

    fn ellipse(&self, arguments: &str) -> Option<String> {
        let (radii, centre) = self.radii_and_centre(arguments)?;
        let [x, y] = match radii.as_slice() {
            [] => ["closest-side"; 2],
            &[x, y] => [x, y],
            _ => return None,
        };
        let radius = |word: &str, axis: usize, basis| {
            let side = self.side(word, centre, &[axis]);
            side.or_else(|| self.length(word, basis))
        };
        let radii = DVec2::new(
            radius(x, 0, PercentageBasis::Width)?,
            radius(y, 1, PercentageBasis::Height)?,
        );
        (radii.min_element() >= 0.0).then(|| ellipse_path(centre, radii))
    }

    /// Splits the arguments of circles and ellipses: words before `at`, and the centre after it.
    fn radii_and_centre<'t>(&self, arguments: &'t str) -> Option<(Vec<&'t str>, DVec2)> {
        let words = components(arguments);
        let at = words
            .iter()
            .position(|word| word.eq_ignore_ascii_case("at"));
        let (radii, place) = match at {
            Some(at) => (words[..at].to_vec(), self.position(&words[at + 1..])?),
            None => (words, self.context.viewport / 2.0),
        };
        Some((radii, place))
    }

    /// Returns the distance of a centre to the closest or farthest side along the given axes;
    /// `None` if the word is no such keyword.
    fn side(&self, word: &str, centre: DVec2, axes: &[usize]) -> Option<f64> {
        let far = self.context.viewport - centre;
        let distances = axes
            .iter()
            .flat_map(|&axis| [centre[axis].abs(), far[axis].abs()]);
        match word.to_ascii_lowercase().as_str() {
            "closest-side" => distances.reduce(f64::min),
            "farthest-side" => distances.reduce(f64::max),
            _ => None,
        }
    }

    /// Reads a position of one, two or four words (CSS Values 4, section 8.3).
    fn position(&self, words: &[&str]) -> Option<DVec2> {
        let lower: Vec<_> = words.iter().map(|word| word.to_ascii_lowercase()).collect();
        let words: Vec<&str> = lower.iter().map(String::as_str).collect();
        let is_vertical = |word: &str| matches!(word, "top" | "bottom");
        let is_horizontal = |word: &str| matches!(word, "left" | "right");
        let (x, y) = match words.as_slice() {
            [y] if is_vertical(y) => (["center", ""], [*y, ""]),
            [x] => ([*x, ""], ["center", ""]),
            [a, b] if is_vertical(a) || is_horizontal(b) => ([*b, ""], [*a, ""]),
            [a, b] => ([*a, ""], [*b, ""]),
            [a, p, b, q] if is_vertical(a) => ([*b, *q], [*a, *p]),
            [a, p, b, q] => ([*a, *p], [*b, *q]),
            _ => return None,
        };
        let along = |[edge, offset]: [&str; 2], basis| {
            let whole = self.context.whole(basis);
            let offset = match offset {
                "" => 0.0,
                offset => self.length(offset, basis)?,
            };
            Some(match edge {
                "left" | "top" => offset,
                "center" => whole / 2.0,
                "right" | "bottom" => whole - offset,
                edge => self.length(edge, basis)?,
            })
        };
        Some(DVec2::new(
            along(x, PercentageBasis::Width)?,
            along(y, PercentageBasis::Height)?,
        ))
    }

    /// Returns the rectangle of `inset`, `rect` or `xywh`.
    fn box_shape(&self, name: &str, arguments: &str) -> Option<String> {
        use PercentageBasis::{Height, Width};
        let words = components(arguments);
        let round = words.iter().position(|w| w.eq_ignore_ascii_case("round"));
        let (sides, radii) = match round {
            Some(at) => (&words[..at], Some(words[at + 1..].join(" "))),
            None => (words.as_slice(), None),
        };
        let size = self.context.viewport;
        let is_auto = |word: &str| word.eq_ignore_ascii_case("auto");
        let side = |word: &str, basis, auto: f64| match is_auto(word) {
            true => Some(auto),
            false => self.length(word, basis),
        };
        let [left, top, right, bottom] = match (name.to_ascii_lowercase().as_str(), sides) {
            ("xywh", &[x, y, w, h]) => {
                let [x, y] = [self.length(x, Width)?, self.length(y, Height)?];
                [
                    x,
                    y,
                    x + self.length(w, Width)?,
                    y + self.length(h, Height)?,
                ]
            }
            ("rect", &[top, right, bottom, left]) => [
                side(left, Width, 0.0)?,
                side(top, Height, 0.0)?,
                side(right, Width, size.x)?,
                side(bottom, Height, size.y)?,
            ],
            ("inset", sides) => {
                let [top, right, bottom, left] = four_sides(sides)?;
                [
                    self.length(left, Width)?,
                    self.length(top, Height)?,
                    size.x - self.length(right, Width)?,
                    size.y - self.length(bottom, Height)?,
                ]
            }
            _ => return None,
        };
        let [w, h] = [right - left, bottom - top].map(|side| side.max(0.0));
        let radii = match radii {
            Some(radii) => Some(self.corner_radii(&radii)?),
            None => None,
        };
        Some(rectangle([left, top, w, h], radii))
    }

    /// Reads `border-radius`: the radii of the corners, clockwise from the upper left one.
    fn corner_radii(&self, text: &str) -> Option<[DVec2; 4]> {
        let (x, y) = text.split_once('/').unwrap_or((text, text));
        let (x, y) = (components(x), components(y));
        let [x, y] = [four_sides(&x)?, four_sides(&y)?];
        let mut radii = [DVec2::ZERO; 4];
        for (radius, (x, y)) in radii.iter_mut().zip(x.into_iter().zip(y)) {
            *radius = DVec2::new(
                self.length(x, PercentageBasis::Width)?,
                self.length(y, PercentageBasis::Height)?,
            );
        }
        radii
            .iter()
            .all(|r| r.min_element() >= 0.0)
            .then_some(radii)
    }

    fn polygon(&self, arguments: &str) -> Option<ShapeOutline> {
        let (is_even_odd, points) = split_fill_rule(arguments);
        let mut data = String::new();
        for (i, point) in split_outside_brackets(points, ',').enumerate() {
            let [x, y] = components(point)[..] else {
                return None;
            };
            let x = self.length(x, PercentageBasis::Width)?;
            let y = self.length(y, PercentageBasis::Height)?;
            data += &format!("{}{x} {y}", if i == 0 { 'M' } else { 'L' });
        }
        data.push('Z');
        Some(ShapeOutline { data, is_even_odd })
    }

    fn length(&self, text: &str, basis: PercentageBasis) -> Option<f64> {
        let found = evaluate(text, &self.context, basis)?;
        match found.kind {
            CssQuantityKind::Length => Some(found.value),
            CssQuantityKind::Number if self.plain_numbers || found.value == 0.0 => {
                Some(found.value)
            }
            CssQuantityKind::Number | CssQuantityKind::Angle => None,
        }
    }
}

/// Returns an outline that is filled by the non-zero rule.
fn non_zero(data: String) -> ShapeOutline {
    ShapeOutline {
        data,
        is_even_odd: false,
    }
}

/// Splits a leading fill rule with its comma from arguments. Returns whether it is `evenodd`.
fn split_fill_rule(arguments: &str) -> (bool, &str) {
    let comma = find_outside_brackets(arguments, ",");
    let head = comma.map(|comma| arguments[..comma].trim().to_ascii_lowercase());
    match (head.as_deref(), comma) {
        (Some("evenodd"), Some(comma)) => (true, &arguments[comma + 1..]),
        (Some("nonzero"), Some(comma)) => (false, &arguments[comma + 1..]),
        _ => (false, arguments),
    }
}

/// Returns the outline of `path(…)`.
fn path(arguments: &str) -> Option<ShapeOutline> {
    let (is_even_odd, text) = split_fill_rule(arguments);
    Some(ShapeOutline {
        data: quoted(text.trim())?.to_owned(),
        is_even_odd,
    })
}

/// Completes one to four values to four, as for margins.
fn four_sides<'t>(words: &[&'t str]) -> Option<[&'t str; 4]> {
    match *words {
        [a] => Some([a; 4]),
        [a, b] => Some([a, b, a, b]),
        [a, b, c] => Some([a, b, c, b]),
        [a, b, c, d] => Some([a, b, c, d]),
        _ => None,
    }
}

fn ellipse_path(centre: DVec2, radii: DVec2) -> String {
    let (DVec2 { x, y }, DVec2 { x: rx, y: ry }) = (centre, radii);
    let (left, right) = (x - rx, x + rx);
    format!("M{left} {y}A{rx} {ry} 0 1 1 {right} {y}A{rx} {ry} 0 1 1 {left} {y}Z")
}

/// Returns the path of a rectangle (left, top, width, height) with round corners. Radii that do not
/// fit are reduced by the same factor (CSS Backgrounds 3, section 4.5).
fn rectangle([x, y, w, h]: [f64; 4], radii: Option<[DVec2; 4]>) -> String {
    let Some([a, b, c, d]) = radii else {
        return format!("M{x} {y}h{w}v{h}h{}Z", -w);
    };
    let sums = [
        (w, a.x + b.x),
        (w, c.x + d.x),
        (h, a.y + d.y),
        (h, b.y + c.y),
    ];
    let ratios = sums.into_iter().filter(|(_, sum)| *sum > 0.0);
    let factor = ratios.map(|(side, sum)| side / sum).fold(1.0, f64::min);
    let [a, b, c, d] = [a, b, c, d].map(|radius| factor * radius);
    let arc = |r: DVec2, x: f64, y: f64| format!("A{} {} 0 0 1 {x} {y}", r.x, r.y);
    let (right, bottom) = (x + w, y + h);
    [
        format!("M{} {y}H{}", x + a.x, right - b.x),
        arc(b, right, y + b.y),
        format!("V{}", bottom - c.y),
        arc(c, right - c.x, bottom),
        format!("H{}", x + d.x),
        arc(d, x, bottom - d.y),
        format!("V{}", y + a.y),
        arc(a, x + a.x, y),
    ]
    .concat()
        + "Z"
}

#[cfg(test)]
mod tests {
    use super::super::math::tests::CONTEXT;
    use super::*;

    fn data(value: &str) -> Option<String> {
        let reader = ShapeReader {
            context: LengthContext {
                viewport: DVec2::new(100.0, 50.0),
                ..CONTEXT
            },
            plain_numbers: false,
        };
        let outline = reader.outline(&ShapeValue::of(value)?)?;
        Some(outline.data)
    }

    #[test]
    fn shapes_become_paths_in_their_box() {
        let cases = [
            ("inset(10px 20px)", "M20 10h60v30h-60Z"),
            ("rect(5px auto 20px 10%)", "M10 5h90v15h-90Z"),
            ("xywh(10px 20% 50% 10px)", "M10 10h50v10h-50Z"),
            (
                "polygon(evenodd, 0 0, 100% 0, 50% calc(100% - 10px))",
                "M0 0L100 0L50 40Z",
            ),
            (
                "circle(10px at right 20px bottom 10px)",
                "M70 40A10 10 0 1 1 90 40A10 10 0 1 1 70 40Z",
            ),
            ("circle()", "M25 25A25 25 0 1 1 75 25A25 25 0 1 1 25 25Z"),
            (
                "ellipse(farthest-side 10px at 25% top)",
                "M-50 0A75 10 0 1 1 100 0A75 10 0 1 1 -50 0Z",
            ),
            ("path('M0 0H5V5Z') view-box", "M0 0H5V5Z"),
            ("fill-box", "M0 0h100v50h-100Z"),
        ];
        for (value, expected) in cases {
            assert_eq!(data(value).as_deref(), Some(expected), "{value}");
        }
    }

    #[test]
    fn radii_that_do_not_fit_are_reduced_together() {
        let round = data("inset(0 round 50px 0)").expect("valid");
        assert!(
            round.starts_with("M50 0H100A0 0 0 0 1 100 0V0A50 50"),
            "{round}"
        );
    }

    #[test]
    fn invalid_shapes_are_refused() {
        for value in [
            "circle(-1px)",
            "circle(10)",
            "inset()",
            "polygon(0 0 0)",
            "shape(from 0 0, line to 9px 9px)",
            "none",
            "fill-box view-box",
        ] {
            assert_eq!(data(value), None, "{value}");
        }
    }
}
