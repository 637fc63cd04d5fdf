//! Numbers, lengths and angles with their units, and mathematical functions (CSS Values 4,
//! sections 5, 6 and 10).

use super::tokens::{components, find_outside_brackets};
use crate::geometry::DVec2;
use std::f64::consts::PI;

/// Maximum depth of nested brackets in an expression (resource limit: the parser recurses).
const MAX_DEPTH: usize = 32;

/// Height of a line, `normal`, relative to the font size (CSS 2.2, section 10.8.1, recommends 1.0
/// to 1.2; browsers use the font's metrics, which give about the upper end).
const LINE_HEIGHT: f64 = 1.2;

/// Sizes to which relative units refer, in user units.
#[derive(Clone, Copy, Debug)]
pub(in crate::design::svg) struct LengthContext {
    /// Font size of the element.
    pub font_size: f64,
    /// Font size of the root element.
    pub root_font_size: f64,
    /// Width and height of the nearest viewport, to which percentages refer.
    pub viewport: DVec2,
    /// Width and height of the page.
    pub page: DVec2,
}

/// Direction of a length, which decides to which size its percentages refer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::design::svg) enum PercentageBasis {
    Width,
    Height,
    /// Length of the diagonal divided by √2 (SVG 2, section 8.9).
    Diagonal,
    FontSize,
    /// Percentages are plain numbers.
    One,
}

impl LengthContext {
    /// Returns the size of 100 %.
    pub(in crate::design::svg) fn whole(&self, basis: PercentageBasis) -> f64 {
        match basis {
            PercentageBasis::Width => self.viewport.x,
            PercentageBasis::Height => self.viewport.y,
            PercentageBasis::Diagonal => self.viewport.length() / 2.0_f64.sqrt(),
            PercentageBasis::FontSize => self.font_size,
            PercentageBasis::One => 1.0,
        }
    }

    /// Returns the size of a unit: user units for lengths, radians for angles. Units that depend on
    /// a font have the fallback sizes of the specification.
    fn unit(&self, unit: &str, basis: PercentageBasis) -> Option<(f64, CssQuantityKind)> {
        const INCH: f64 = 96.0;
        let length = match unit {
            "" => return Some((1.0, CssQuantityKind::Number)),
            "deg" => return Some((PI / 180.0, CssQuantityKind::Angle)),
            "grad" => return Some((PI / 200.0, CssQuantityKind::Angle)),
            "rad" => return Some((1.0, CssQuantityKind::Angle)),
            "turn" => return Some((2.0 * PI, CssQuantityKind::Angle)),
            "px" => 1.0,
            "in" => INCH,
            "cm" => INCH / 2.54,
            "mm" => INCH / 25.4,
            "q" => INCH / 101.6,
            "pt" => INCH / 72.0,
            "pc" => INCH / 6.0,
            "em" => self.font_size,
            "ex" | "ch" => 0.5 * self.font_size,
            "rex" | "rch" => 0.5 * self.root_font_size,
            "cap" | "ic" => self.font_size,
            "rem" | "rcap" | "ric" => self.root_font_size,
            "lh" => LINE_HEIGHT * self.font_size,
            "rlh" => LINE_HEIGHT * self.root_font_size,
            "vw" | "svw" | "lvw" | "dvw" | "vi" | "cqw" | "cqi" => self.page.x / 100.0,
            "vh" | "svh" | "lvh" | "dvh" | "vb" | "cqh" | "cqb" => self.page.y / 100.0,
            "vmin" | "cqmin" => self.page.min_element() / 100.0,
            "vmax" | "cqmax" => self.page.max_element() / 100.0,
            "%" if basis == PercentageBasis::One => return Some((0.01, CssQuantityKind::Number)),
            "%" => self.whole(basis) / 100.0,
            _ => return None,
        };
        Some((length, CssQuantityKind::Length))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::design::svg) enum CssQuantityKind {
    Number,
    /// In user units.
    Length,
    /// In radians.
    Angle,
}

/// Number with its kind of unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::design::svg) struct CssQuantity {
    pub value: f64,
    pub kind: CssQuantityKind,
}

/// Evaluates a number with a unit or a mathematical function. `basis` is the size of 100 %. Returns
/// `None` if the text is no valid expression.
pub(in crate::design::svg) fn evaluate(
    text: &str,
    context: &LengthContext,
    basis: PercentageBasis,
) -> Option<CssQuantity> {
    let mut parser = ExpressionParser {
        rest: text.trim(),
        context,
        basis,
    };
    let found = parser.operand(0)?;
    let is_valid = parser.rest.trim().is_empty() && found.value.is_finite();
    is_valid.then_some(found)
}

/// Replaces the mathematical functions of a value, and all lengths in units that `usvg` does not
/// know, by numbers: user units for lengths, degrees for angles. Returns `None` if one is invalid.
pub(in crate::design::svg) fn plain_lengths(
    value: &str,
    context: &LengthContext,
    basis: PercentageBasis,
) -> Option<String> {
    let mut plain = Vec::new();
    let spaced = spaced_commas(value);
    for part in components(&spaced) {
        let is_function = part.ends_with(')');
        match is_function || has_foreign_unit(part) {
            true => plain.push(plain_number(evaluate(part, context, basis)?)),
            false => plain.push(part.to_owned()),
        }
    }
    Some(plain.join(" ").replace(" ,", ","))
}

/// Writes a quantity as a plain number: user units for lengths, degrees for angles.
fn plain_number(quantity: CssQuantity) -> String {
    match quantity.kind {
        CssQuantityKind::Angle => quantity.value.to_degrees().to_string(),
        CssQuantityKind::Number | CssQuantityKind::Length => quantity.value.to_string(),
    }
}

/// Inserts a space before and after each comma outside of brackets.
fn spaced_commas(value: &str) -> String {
    let mut spaced = String::new();
    let mut rest = value;
    while let Some(at) = find_outside_brackets(rest, ",") {
        spaced.push_str(&rest[..at]);
        spaced.push_str(" , ");
        rest = &rest[at + 1..];
    }
    spaced + rest
}

/// Returns whether a part of a value is a length in a unit that `usvg` does not know.
fn has_foreign_unit(part: &str) -> bool {
    let number = number_length(part);
    let unit = part[number..].to_ascii_lowercase();
    let known = ["", "%", "em", "ex", "px", "in", "cm", "mm", "pt", "pc"];
    // `usvg` reads units in lower case only.
    number > 0 && (!known.contains(&unit.as_str()) || unit != part[number..])
}

/// Returns the first unit in a value whose size depends on a font.
pub(in crate::design::svg) fn font_dependent_unit(value: &str) -> Option<&'static str> {
    const UNITS: [&str; 10] = [
        "ex", "rex", "ch", "rch", "cap", "rcap", "ic", "ric", "lh", "rlh",
    ];
    let is_separator = |c: char| !c.is_ascii_alphanumeric() && c != '.';
    let mut parts = value.split(is_separator);
    parts.find_map(|part| {
        let unit = &part[number_length(part)..];
        let has_number = unit.len() < part.len();
        let mut units = UNITS.into_iter().filter(|_| has_number);
        units.find(|known| known.eq_ignore_ascii_case(unit))
    })
}

/// Returns the number of bytes of the number at the beginning of a text; 0 if there is none.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        let digits = bytes[from.min(bytes.len())..].iter();
        digits.take_while(|byte| byte.is_ascii_digit()).count()
    };
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(sign);
    let mut end = sign + whole;
    if bytes.get(end) == Some(&b'.') && digits(end + 1) > 0 {
        end += 1 + digits(end + 1);
    } else if whole == 0 {
        return 0;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        end += if exponent > 0 { 1 + sign + exponent } else { 0 };
    }
    end
}

/// Recursive-descent parser and evaluator of expressions.
struct ExpressionParser<'e> {
    rest: &'e str,
    context: &'e LengthContext,
    basis: PercentageBasis,
}

impl ExpressionParser<'_> {
    /// Parses a sum of products.
    fn sum(&mut self, depth: usize) -> Option<CssQuantity> {
        let mut total = self.product(depth)?;
        loop {
            // The operators of sums have white space on both sides.
            let operator = self.rest.trim_start().chars().next();
            let is_spaced = self.rest.starts_with(char::is_whitespace);
            let sign = match operator {
                Some('+') if is_spaced => 1.0,
                Some('-') if is_spaced => -1.0,
                _ => return Some(total),
            };
            self.rest = &self.rest.trim_start()[1..];
            let term = self.product(depth)?;
            let kind = sum_kind(total, term)?;
            total = CssQuantity {
                value: total.value + sign * term.value,
                kind,
            };
        }
    }

    fn product(&mut self, depth: usize) -> Option<CssQuantity> {
        let mut total = self.operand(depth)?;
        loop {
            let rest = self.rest.trim_start();
            let Some(operator @ ('*' | '/')) = rest.chars().next() else {
                return Some(total);
            };
            self.rest = &rest[1..];
            let factor = self.operand(depth)?;
            let kind = match (total.kind, factor.kind) {
                (kind, CssQuantityKind::Number) => kind,
                (CssQuantityKind::Number, kind) if operator == '*' => kind,
                (a, b) if operator == '/' && a == b => CssQuantityKind::Number,
                _ => return None,
            };
            let value = match operator {
                '*' => total.value * factor.value,
                _ => total.value / factor.value,
            };
            total = CssQuantity { value, kind };
        }
    }

    /// Parses a number with its unit, a constant, a function or an expression in brackets.
    fn operand(&mut self, depth: usize) -> Option<CssQuantity> {
        if depth > MAX_DEPTH {
            return None;
        }
        self.rest = self.rest.trim_start();
        let number = number_length(self.rest);
        let is_name = |c: char| c.is_ascii_alphanumeric() || c == '-';
        let (value, after) = self.rest.split_at(number);
        let unit = match after.strip_prefix('%') {
            Some(_) => 1,
            None => after.find(|c| !is_name(c)).unwrap_or(after.len()),
        };
        let (unit, after) = after.split_at(unit);
        let unit = unit.to_ascii_lowercase();
        self.rest = after;
        if number > 0 {
            let (size, kind) = self.context.unit(&unit, self.basis)?;
            let value = value.parse::<f64>().ok()? * size;
            return Some(CssQuantity { value, kind });
        }
        if let Some(inner) = self.rest.strip_prefix('(') {
            self.rest = inner;
            return self.function(&unit, depth + 1);
        }
        let value = match unit.as_str() {
            "pi" => PI,
            "e" => std::f64::consts::E,
            "infinity" => f64::INFINITY,
            _ => return None,
        };
        let kind = CssQuantityKind::Number;
        Some(CssQuantity { value, kind })
    }

    /// Parses the arguments of a function and its closing bracket, and applies the function. The
    /// strategies of `round` are its first argument.
    fn function(&mut self, name: &str, depth: usize) -> Option<CssQuantity> {
        let mut strategy = "nearest";
        for known in ["nearest", "up", "down", "to-zero"] {
            let rest = self.rest.trim_start().strip_prefix(known);
            if let Some(rest) = rest.filter(|_| name == "round") {
                strategy = known;
                self.rest = rest.trim_start().strip_prefix(',')?;
            }
        }
        let mut arguments = vec![self.sum(depth)?];
        while let Some(rest) = self.rest.trim_start().strip_prefix(',') {
            self.rest = rest;
            arguments.push(self.sum(depth)?);
        }
        self.rest = self.rest.trim_start().strip_prefix(')')?;
        apply(name, strategy, &arguments)
    }
}

/// Returns the kind of a sum. Zero is a number and a length in SVG.
fn sum_kind(a: CssQuantity, b: CssQuantity) -> Option<CssQuantityKind> {
    match (a.kind, b.kind) {
        (a, b) if a == b => Some(a),
        _ => None,
    }
}

/// Applies a mathematical function to its arguments. `strategy` is the rounding strategy.
fn apply(name: &str, strategy: &str, arguments: &[CssQuantity]) -> Option<CssQuantity> {
    let first = *arguments.first()?;
    if arguments.iter().any(|argument| argument.kind != first.kind) && name != "pow" {
        return None;
    }
    let values: Vec<f64> = arguments.iter().map(|argument| argument.value).collect();
    let number = |value| (value, CssQuantityKind::Number);
    let angle = |value| (value, CssQuantityKind::Angle);
    let same = |value| (value, first.kind);
    let (value, kind) = match (name, values.as_slice()) {
        ("" | "calc" | "-webkit-calc", &[x]) => same(x),
        ("min", values) => same(values.iter().copied().fold(f64::INFINITY, f64::min)),
        ("max", values) => same(values.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
        ("clamp", &[low, x, high]) => same(x.min(high).max(low)),
        ("abs", &[x]) => same(x.abs()),
        ("sign", &[x]) => number(if x == 0.0 { 0.0 } else { x.signum() }),
        ("round", &[x]) => same(round(x, 1.0, strategy)),
        ("round", &[x, step]) => same(round(x, step, strategy)),
        ("mod", &[x, y]) => same(x - y * (x / y).floor()),
        ("rem", &[x, y]) => same(x % y),
        ("sin", &[x]) => number(x.sin()),
        ("cos", &[x]) => number(x.cos()),
        ("tan", &[x]) => number(x.tan()),
        ("asin", &[x]) => angle(x.asin()),
        ("acos", &[x]) => angle(x.acos()),
        ("atan", &[x]) => angle(x.atan()),
        ("atan2", &[y, x]) => angle(y.atan2(x)),
        ("pow", &[x, y]) => number(x.powf(y)),
        ("sqrt", &[x]) => number(x.sqrt()),
        ("hypot", values) => same(values.iter().map(|x| x * x).sum::<f64>().sqrt()),
        ("log", &[x]) => number(x.ln()),
        ("log", &[x, base]) => number(x.ln() / base.ln()),
        ("exp", &[x]) => number(x.exp()),
        _ => return None,
    };
    Some(CssQuantity { value, kind })
}

/// Rounds a number to a multiple of `step`.
fn round(x: f64, step: f64, strategy: &str) -> f64 {
    let ratio = x / step;
    let rounded = match strategy {
        "up" => ratio.ceil(),
        "down" => ratio.floor(),
        "to-zero" => ratio.trunc(),
        _ => (ratio + 0.5).floor(),
    };
    rounded * step
}

#[cfg(test)]
pub(in crate::design::svg) mod tests {
    use super::*;

    pub(in crate::design::svg) const CONTEXT: LengthContext = LengthContext {
        font_size: 20.0,
        root_font_size: 16.0,
        viewport: DVec2::new(300.0, 400.0),
        page: DVec2::new(600.0, 800.0),
    };

    #[test]
    fn expressions_have_the_values_of_the_specification() {
        let length = CssQuantityKind::Length;
        let number = CssQuantityKind::Number;
        let cases = [
            ("12", 12.0, number),
            ("-.5e1px", -5.0, length),
            ("1in", 96.0, length),
            ("25.4mm", 96.0, length),
            ("4Q", 96.0 / 25.4, length),
            ("2rem", 32.0, length),
            ("1.5em", 30.0, length),
            ("2lh", 2.0 * 1.2 * 20.0, length),
            ("2rlh", 2.0 * 1.2 * 16.0, length),
            ("10vmin", 60.0, length),
            ("50%", 150.0, length),
            ("calc(50% - 10px)", 140.0, length),
            ("calc( (1px + 2px) * 3 )", 9.0, length),
            ("calc(10px / 4)", 2.5, length),
            ("calc(10px / 4px)", 2.5, number),
            ("min(10px, 2em, 5%)", 10.0, length),
            ("clamp(1px, 50px, 20px)", 20.0, length),
            ("max(1, calc(2 + 3))", 5.0, number),
            ("round(up, 11px, 5px)", 15.0, length),
            ("mod(-1, 3)", 2.0, number),
            ("sin(30deg)", 0.5, number),
            ("hypot(3px, 4px)", 5.0, length),
            ("calc(pi * 0 + e * 0 + 1)", 1.0, number),
        ];
        for (text, value, kind) in cases {
            let found = evaluate(text, &CONTEXT, PercentageBasis::Width).expect(text);
            assert!((found.value - value).abs() < 1e-9, "{text}: {found:?}");
            assert_eq!(found.kind, kind, "{text}");
        }
        let diagonal = evaluate("100%", &CONTEXT, PercentageBasis::Diagonal);
        assert!((diagonal.expect("valid").value - 500.0 / 2.0_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn invalid_expressions_are_refused() {
        let deep = "(".repeat(100_000);
        let invalid = [
            "",
            "px",
            "1 2",
            "calc(1px + 2)",
            "calc(1px * 2px)",
            "calc(1px+2px)",
            "1foo",
            "calc(1/0)",
            "calc(1",
            "min()",
            "sin(1px, 2px)",
            "calc(infinity)",
            &deep,
        ];
        for text in invalid {
            assert_eq!(
                evaluate(text, &CONTEXT, PercentageBasis::Width),
                None,
                "{text}"
            );
        }
    }

    #[test]
    fn only_what_usvg_does_not_know_is_replaced() {
        let plain = |text| plain_lengths(text, &CONTEXT, PercentageBasis::Width);
        assert_eq!(
            plain("5px 2% , 1rem,calc(2px*2)").as_deref(),
            Some("5px 2%, 16, 4")
        );
        assert_eq!(plain("10PX").as_deref(), Some("10"));
        assert_eq!(plain("none").as_deref(), Some("none"));
        assert_eq!(plain("1foo"), None);
    }
}
