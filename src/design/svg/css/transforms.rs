//! Transforms (CSS Transforms 2): lists of functions, individual properties and the origin,
//! reduced to one affine map of the plane. Rotations out of the plane are projected in parallel.

use super::math::{CssQuantity, CssQuantityKind, LengthContext, PercentageBasis, evaluate};
use super::tokens::components;
use crate::geometry::{DAffine2, DVec2};
use glam::{DMat4, DVec3, DVec4};

/// Box to which the percentages of a transform and its origin refer, in user units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::design::svg) struct ReferenceBox {
    pub corner: DVec2,
    pub size: DVec2,
}

/// Values of the properties that transform an element; empty for those that are not set.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::design::svg) struct TransformProperties<'v> {
    pub transform: &'v str,
    /// Whether `transform` comes from an attribute, in which numbers need no units.
    pub is_attribute: bool,
    pub origin: &'v str,
    pub translate: &'v str,
    pub rotate: &'v str,
    pub scale: &'v str,
}

/// Returns the affine map of an element. Returns `None` if a value is invalid or needs perspective.
pub(in crate::design::svg) fn affine_map(
    properties: &TransformProperties,
    reference: &ReferenceBox,
    context: &LengthContext,
) -> Option<DAffine2> {
    let reader = TransformReader {
        context: LengthContext {
            viewport: reference.size,
            ..*context
        },
        plain_numbers: properties.is_attribute,
    };
    let origin = reader.origin(properties.origin)? + reference.corner;
    let individual = TransformReader {
        plain_numbers: false,
        ..reader
    };
    let translation = individual.individual("translate", properties.translate)?;
    let rotation = individual.individual("rotate", properties.rotate)?;
    let scale = individual.individual("scale", properties.scale)?;
    let map = translation * rotation * scale * reader.list(properties.transform)?;
    let [x, y, z] = [map.x_axis, map.y_axis, map.w_axis].map(|axis| axis.truncate().truncate());
    let is_finite = [x, y, z].into_iter().all(DVec2::is_finite);
    let planar = DAffine2::from_cols(x, y, z);
    let about = DAffine2::from_translation(origin) * planar * DAffine2::from_translation(-origin);
    is_finite.then_some(about)
}

struct TransformReader {
    context: LengthContext,
    /// Whether numbers without units are lengths and angles in degrees.
    plain_numbers: bool,
}

impl TransformReader {
    /// Reads a list of functions.
    fn list(&self, text: &str) -> Option<DMat4> {
        let mut map = DMat4::IDENTITY;
        let mut rest = text.trim();
        while !rest.is_empty() && !rest.eq_ignore_ascii_case("none") {
            let (name, after) = rest.split_once('(')?;
            let end = super::tokens::find_outside_brackets(after, ")")?;
            let spaced = spaced_arguments(&after[..end]);
            map *= self.function(&name.trim().to_ascii_lowercase(), &components(&spaced))?;
            rest = after[end + 1..].trim_start_matches(|c: char| c.is_whitespace() || c == ',');
        }
        Some(map)
    }

    /// Reads one of the properties `translate`, `rotate` and `scale`.
    fn individual(&self, name: &str, text: &str) -> Option<DMat4> {
        let mut arguments = components(text);
        match (name, arguments.as_slice()) {
            (_, [] | ["none"]) => Some(DMat4::IDENTITY),
            ("rotate", [axis @ ("x" | "y" | "z"), angle] | [angle, axis @ ("x" | "y" | "z")]) => {
                self.function(&format!("rotate{axis}"), &[angle])
            }
            ("rotate", [_, _, _, _]) => self.function("rotate3d", &arguments),
            _ => {
                arguments.truncate(2); // depth does not show
                self.function(name, &arguments)
            }
        }
    }

    fn function(&self, name: &str, arguments: &[&str]) -> Option<DMat4> {
        if name.starts_with("matrix") {
            return self.matrix(arguments);
        }
        if name.starts_with("rotate") {
            return self.rotation(name, arguments);
        }
        Some(match (name, arguments) {
            ("translate" | "translatex", [x]) => translation(self.x(x)?, 0.0),
            ("translate", [x, y]) | ("translate3d", [x, y, _]) => {
                translation(self.x(x)?, self.y(y)?)
            }
            ("translatey", [y]) => translation(0.0, self.y(y)?),
            ("translatez" | "scalez", [_]) | ("perspective", ["none"]) => DMat4::IDENTITY,
            ("scale", [s]) => scale(self.number(s)?, self.number(s)?),
            ("scale", [x, y]) | ("scale3d", [x, y, _]) => scale(self.number(x)?, self.number(y)?),
            ("scalex", [x]) => scale(self.number(x)?, 1.0),
            ("scaley", [y]) => scale(1.0, self.number(y)?),
            ("skew" | "skewx", [x]) => skew(self.angle(x)?, 0.0),
            ("skew", [x, y]) => skew(self.angle(x)?, self.angle(y)?),
            ("skewy", [y]) => skew(0.0, self.angle(y)?),
            _ => return None,
        })
    }

    /// Reads the arguments of `matrix` and `matrix3d`. Returns `None` for a matrix with
    /// perspective.
    fn matrix(&self, arguments: &[&str]) -> Option<DMat4> {
        let numbers = arguments.iter().map(|text| self.number(text));
        match numbers.collect::<Option<Vec<f64>>>()?.as_slice() {
            &[a, b, c, d, e, f] => {
                let columns = [[a, b, 0.0], [c, d, 0.0], [0.0, 0.0, 1.0], [e, f, 0.0]];
                let [x, y, z, w] = columns.map(DVec3::from);
                Some(DMat4::from_cols(
                    x.extend(0.0),
                    y.extend(0.0),
                    z.extend(0.0),
                    w.extend(1.0),
                ))
            }
            numbers => {
                let columns: [f64; 16] = numbers.try_into().ok()?;
                let map = DMat4::from_cols_array(&columns);
                (map.row(3) == DVec4::W).then_some(map)
            }
        }
    }

    fn rotation(&self, name: &str, arguments: &[&str]) -> Option<DMat4> {
        Some(match (name, arguments) {
            ("rotate" | "rotatez", [angle]) => DMat4::from_rotation_z(self.angle(angle)?),
            ("rotate", [angle, x, y]) if self.plain_numbers => {
                let (x, y) = (self.x(x)?, self.y(y)?);
                let turn = DMat4::from_rotation_z(self.angle(angle)?);
                translation(x, y) * turn * translation(-x, -y)
            }
            ("rotatex", [angle]) => DMat4::from_rotation_x(self.angle(angle)?),
            ("rotatey", [angle]) => DMat4::from_rotation_y(self.angle(angle)?),
            ("rotate3d", [x, y, z, angle]) => {
                let axis = DVec3::new(self.number(x)?, self.number(y)?, self.number(z)?);
                DMat4::from_axis_angle(axis.try_normalize()?, self.angle(angle)?)
            }
            _ => return None,
        })
    }

    /// Reads the origin: one to three keywords or lengths, x before y unless keywords say
    /// otherwise.
    fn origin(&self, text: &str) -> Option<DVec2> {
        let lower = text.to_ascii_lowercase();
        let words = components(&lower);
        let is_vertical = |word: &str| matches!(word, "top" | "bottom");
        let is_horizontal = |word: &str| matches!(word, "left" | "right");
        let (x, y) = match words.as_slice() {
            [] => return Some(DVec2::ZERO),
            [y] if is_vertical(y) => ("center", *y),
            [x] => (*x, "center"),
            [a, b, ..] if is_vertical(a) || is_horizontal(b) => (*b, *a),
            [a, b, ..] => (*a, *b),
        };
        let keyword = |word| match word {
            "left" | "top" => "0%",
            "center" => "50%",
            "right" | "bottom" => "100%",
            word => word,
        };
        let reader = Self {
            plain_numbers: true,
            ..*self
        };
        Some(DVec2::new(reader.x(keyword(x))?, reader.y(keyword(y))?))
    }

    fn x(&self, text: &str) -> Option<f64> {
        self.length(evaluate(text, &self.context, PercentageBasis::Width)?)
    }

    fn y(&self, text: &str) -> Option<f64> {
        self.length(evaluate(text, &self.context, PercentageBasis::Height)?)
    }

    fn length(&self, found: CssQuantity) -> Option<f64> {
        match found.kind {
            CssQuantityKind::Length => Some(found.value),
            CssQuantityKind::Number if self.plain_numbers || found.value == 0.0 => {
                Some(found.value)
            }
            CssQuantityKind::Number | CssQuantityKind::Angle => None,
        }
    }

    fn angle(&self, text: &str) -> Option<f64> {
        let found = evaluate(text, &self.context, PercentageBasis::One)?;
        match found.kind {
            CssQuantityKind::Angle => Some(found.value),
            CssQuantityKind::Number if self.plain_numbers || found.value == 0.0 => {
                Some(found.value.to_radians())
            }
            CssQuantityKind::Number | CssQuantityKind::Length => None,
        }
    }

    fn number(&self, text: &str) -> Option<f64> {
        let found = evaluate(text, &self.context, PercentageBasis::One)?;
        (found.kind == CssQuantityKind::Number).then_some(found.value)
    }
}

fn translation(x: f64, y: f64) -> DMat4 {
    DMat4::from_translation(DVec3::new(x, y, 0.0))
}

fn scale(x: f64, y: f64) -> DMat4 {
    DMat4::from_scale(DVec3::new(x, y, 1.0))
}

/// Returns the map that leans the vertical axis by `x` and the horizontal axis by `y` radians.
fn skew(x: f64, y: f64) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(1.0, y.tan(), 0.0, 0.0),
        DVec4::new(x.tan(), 1.0, 0.0, 0.0),
        DVec4::Z,
        DVec4::W,
    )
}

/// Separates arguments by spaces instead of commas, and numbers that follow each other without a
/// separator, such as `1-2`.
fn spaced_arguments(text: &str) -> String {
    let mut spaced = String::with_capacity(text.len() + 8);
    let (mut depth, mut last) = (0_usize, ' ');
    let mut has_point = false;
    for c in text.chars() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        let is_sign = matches!(c, '-' | '+') && (last.is_ascii_digit() || last == '.');
        let is_second_point = c == '.' && has_point;
        if depth == 0 && (is_sign || is_second_point) {
            spaced.push(' ');
        }
        has_point = match c {
            '.' => true,
            c => has_point && c.is_ascii_digit(),
        };
        spaced.push(if c == ',' && depth == 0 { ' ' } else { c });
        last = c;
    }
    spaced
}

#[cfg(test)]
mod tests {
    use super::super::math::tests::CONTEXT;
    use super::*;

    const BOX: ReferenceBox = ReferenceBox {
        corner: DVec2::new(10.0, 20.0),
        size: DVec2::new(100.0, 50.0),
    };

    fn moved(properties: TransformProperties, p: [f64; 2]) -> Option<[f64; 2]> {
        let map = affine_map(&properties, &BOX, &CONTEXT)?;
        let p = map.transform_point2(DVec2::from(p));
        Some(p.to_array().map(|x| (x * 1e6).round() / 1e6))
    }

    #[test]
    fn css_transforms_turn_about_their_origin() {
        let css = |transform, origin| TransformProperties {
            transform,
            origin,
            ..TransformProperties::default()
        };
        let cases = [
            (css("rotate(90deg)", "center"), [60.0, 45.0], [60.0, 45.0]),
            (
                css("rotate(0.25turn)", "top left"),
                [11.0, 20.0],
                [10.0, 21.0],
            ),
            (
                css("rotate(100grad)", "left top"),
                [11.0, 20.0],
                [10.0, 21.0],
            ),
            (
                css("translate(50%, 10px) scale(2)", "10px 20px"),
                [21.0, 41.0],
                [72.0, 52.0],
            ),
            (css("scaleX(-1)", "right"), [100.0, 0.0], [120.0, 0.0]),
            (css("skewX(45deg)", "0 0"), [0.0, 21.0], [1.0, 21.0]),
            (css("matrix(1, 0, 0, 1, 5, 6)", ""), [0.0, 0.0], [5.0, 6.0]),
            (css("rotateY(180deg)", "center"), [10.0, 0.0], [110.0, 0.0]),
            (css("none", ""), [1.0, 2.0], [1.0, 2.0]),
        ];
        for (properties, from, to) in cases {
            assert_eq!(moved(properties, from), Some(to), "{properties:?}");
        }
    }

    #[test]
    fn individual_properties_come_before_the_list() {
        let properties = TransformProperties {
            transform: "translateX(1px)",
            origin: "0 0",
            translate: "10px",
            rotate: "90deg",
            scale: "2 3",
            ..TransformProperties::default()
        };
        // The corner of the box is the origin.
        assert_eq!(moved(properties, [10.0, 20.0]), Some([20.0, 22.0]));
    }

    #[test]
    fn attributes_need_no_units_and_css_does() {
        let attribute = TransformProperties {
            transform: "rotate(90,1-2)translate(1.5.5)",
            is_attribute: true,
            ..TransformProperties::default()
        };
        let p = moved(attribute, [10.0, 20.0]).expect("valid");
        let list = TransformReader {
            context: CONTEXT,
            plain_numbers: true,
        };
        assert!(list.list("rotate(90 1 -2) translate(1.5 .5)").is_some());
        assert!(p[0].is_finite());
        for invalid in [
            "rotate(45)",
            "translate(1 2)",
            "perspective(9px)",
            "spin(1deg)",
            "scale(1px)",
        ] {
            let css = TransformProperties {
                transform: invalid,
                ..TransformProperties::default()
            };
            assert_eq!(moved(css, [0.0, 0.0]), None, "{invalid}");
        }
    }
}
