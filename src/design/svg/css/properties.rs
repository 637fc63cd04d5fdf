//! Table of the properties that change a drawing, and the conversion of their values to those of
//! plain attributes.

use super::colours::plain_colour;
use super::math::{CssQuantityKind, LengthContext, PercentageBasis, evaluate, plain_lengths};
use super::tokens::{components, find_outside_brackets};

/// Type of the values of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::design::svg) enum ValueType {
    /// Colour, reference to a gradient or pattern, or a keyword.
    Paint,
    Colour,
    /// Number or percentage from 0 to 1.
    Opacity,
    Number,
    /// Length; numbers without unit are allowed.
    Length(PercentageBasis),
    /// Length in a geometry property, in which only 0 needs no unit.
    Geometry(PercentageBasis),
    /// Keywords in lower case.
    Keyword,
    /// Text that is not converted.
    Verbatim,
    /// Value that is read together with those of other properties.
    Transform,
    /// `path("…")`.
    PathData,
}

/// Property that changes a drawing.
#[derive(Debug)]
pub(in crate::design::svg) struct Property {
    pub name: &'static str,
    pub value_type: ValueType,
    /// Whether elements have the value of their parent by default.
    pub is_inherited: bool,
    /// Initial value, for inherited properties that are set to `initial`; empty if the attribute is
    /// removed instead.
    pub initial: &'static str,
}

const fn inherited(name: &'static str, value_type: ValueType, initial: &'static str) -> Property {
    Property {
        name,
        value_type,
        is_inherited: true,
        initial,
    }
}

const fn own(name: &'static str, value_type: ValueType) -> Property {
    Property {
        name,
        value_type,
        is_inherited: false,
        initial: "",
    }
}

use PercentageBasis::{Diagonal, FontSize, Height, Width};
use ValueType::{
    Colour, Geometry, Keyword, Length, Number, Opacity, Paint, PathData, Transform, Verbatim,
};

/// All properties that are written as attributes (SVG 2, appendix on properties, and the CSS
/// modules that it refers to).
const PROPERTIES: [Property; 90] = [
    inherited("fill", Paint, "black"),
    inherited("fill-opacity", Opacity, "1"),
    inherited("fill-rule", Keyword, "nonzero"),
    inherited("stroke", Paint, "none"),
    inherited("stroke-opacity", Opacity, "1"),
    inherited("stroke-width", Length(Diagonal), "1"),
    inherited("stroke-linecap", Keyword, "butt"),
    inherited("stroke-linejoin", Keyword, "miter"),
    inherited("stroke-miterlimit", Number, "4"),
    inherited("stroke-dasharray", Length(Diagonal), "none"),
    inherited("stroke-dashoffset", Length(Diagonal), "0"),
    inherited("paint-order", Keyword, "normal"),
    own("vector-effect", Keyword),
    inherited("color", Colour, "black"),
    own("opacity", Opacity),
    own("stop-color", Colour),
    own("stop-opacity", Opacity),
    own("flood-color", Colour),
    own("flood-opacity", Opacity),
    own("lighting-color", Colour),
    own("clip-path", Verbatim),
    inherited("clip-rule", Keyword, "nonzero"),
    own("mask", Verbatim),
    own("mask-type", Keyword),
    own("mask-mode", Keyword),
    own("filter", Verbatim),
    own("mix-blend-mode", Keyword),
    own("isolation", Keyword),
    inherited("marker-start", Verbatim, "none"),
    inherited("marker-mid", Verbatim, "none"),
    inherited("marker-end", Verbatim, "none"),
    own("display", Keyword),
    inherited("visibility", Keyword, "visible"),
    own("overflow", Keyword),
    inherited("color-interpolation", Keyword, "sRGB"),
    inherited("color-interpolation-filters", Keyword, "linearRGB"),
    inherited("shape-rendering", Keyword, "auto"),
    inherited("text-rendering", Keyword, "auto"),
    inherited("image-rendering", Keyword, "auto"),
    own("background-color", Colour),
    own("x", Geometry(Width)),
    own("y", Geometry(Height)),
    own("width", Geometry(Width)),
    own("height", Geometry(Height)),
    own("cx", Geometry(Width)),
    own("cy", Geometry(Height)),
    own("r", Geometry(Diagonal)),
    own("rx", Geometry(Width)),
    own("ry", Geometry(Height)),
    own("d", PathData),
    own("transform", Transform),
    own("transform-origin", Transform),
    own("transform-box", Transform),
    own("translate", Transform),
    own("rotate", Transform),
    own("scale", Transform),
    inherited("font", Verbatim, ""),
    inherited("font-family", Verbatim, "serif"),
    inherited("font-size", Length(FontSize), "medium"),
    inherited("font-size-adjust", Verbatim, "none"),
    inherited("font-style", Keyword, "normal"),
    inherited("font-weight", Keyword, "normal"),
    inherited("font-stretch", Keyword, "normal"),
    inherited("font-variant", Keyword, "normal"),
    inherited("font-kerning", Keyword, "auto"),
    inherited("font-variation-settings", Verbatim, "normal"),
    inherited("font-feature-settings", Verbatim, "normal"),
    inherited("font-optical-sizing", Keyword, "auto"),
    inherited("letter-spacing", Length(FontSize), "normal"),
    inherited("word-spacing", Length(FontSize), "normal"),
    inherited("text-anchor", Keyword, "start"),
    inherited("text-transform", Keyword, "none"),
    own("text-decoration", Verbatim),
    own("text-overflow", Keyword),
    inherited("direction", Keyword, "ltr"),
    own("unicode-bidi", Keyword),
    inherited("writing-mode", Keyword, "horizontal-tb"),
    inherited("glyph-orientation-vertical", Verbatim, "auto"),
    inherited("glyph-orientation-horizontal", Verbatim, "0deg"),
    own("alignment-baseline", Keyword),
    own("baseline-shift", Length(FontSize)),
    own("dominant-baseline", Keyword),
    inherited("white-space", Keyword, "normal"),
    inherited("kerning", Verbatim, "auto"),
    own("animation", Verbatim),
    own("animation-name", Verbatim),
    own("clip", Verbatim),
    own("offset-path", Verbatim),
    own("perspective", Verbatim),
    inherited("text-shadow", Verbatim, "none"),
];

/// Returns the description of a property, or `None` if it does not change a drawing.
pub(in crate::design::svg) fn property(name: &str) -> Option<&'static Property> {
    PROPERTIES.iter().find(|property| property.name == name)
}

/// Returns whether an attribute of this name is a presentation attribute of an element, which style
/// sheets override.
pub(in crate::design::svg) fn is_presentation_attribute(name: &str, tag: &str) -> bool {
    let Some(property) = property(name) else {
        return false;
    };
    match property.name {
        "font" | "translate" | "rotate" | "scale" | "animation" | "animation-name"
        | "offset-path" | "text-transform" | "mix-blend-mode" | "isolation"
        | "background-color" | "mask-mode" | "perspective" | "text-shadow" | "font-kerning" => {
            false
        }
        "d" => tag == "path",
        "x" | "y" | "width" | "height" | "cx" | "cy" | "r" | "rx" | "ry" => {
            has_geometry(property.name, tag)
        }
        _ => true,
    }
}

/// Returns whether style sheets can set a geometry property of an element (SVG 2, section 8.3).
pub(in crate::design::svg) fn has_geometry(name: &str, tag: &str) -> bool {
    match name {
        "x" | "y" | "width" | "height" => {
            matches!(
                tag,
                "svg" | "rect" | "image" | "foreignObject" | "use" | "symbol"
            )
        }
        "cx" | "cy" => matches!(tag, "circle" | "ellipse"),
        "r" => tag == "circle",
        "rx" | "ry" => matches!(tag, "rect" | "ellipse"),
        "d" => tag == "path",
        _ => true,
    }
}

/// Splits a shorthand into its longhand properties. Other declarations stay as they are.
pub(in crate::design::svg) fn longhands(name: &str, value: &str) -> Vec<(String, String)> {
    let one = |name: &str, value: &str| vec![(name.to_owned(), value.to_owned())];
    let name = name.strip_prefix("-webkit-").unwrap_or(name);
    match name {
        "marker" => ["marker-start", "marker-mid", "marker-end"]
            .map(|name| (name.to_owned(), value.to_owned()))
            .to_vec(),
        "mask" | "mask-image" => {
            let words = components(value);
            let reference = words.iter().find(|word| is_reference(word)).copied();
            let mut found = one("mask", reference.unwrap_or(value));
            for mode in ["alpha", "luminance"] {
                if words.iter().any(|word| word.eq_ignore_ascii_case(mode)) {
                    found.push(("mask-mode".to_owned(), mode.to_owned()));
                }
            }
            found
        }
        // Components that are no colours are invalid and thus ignored.
        "background" => components(value)
            .into_iter()
            .flat_map(|component| one("background-color", component))
            .collect(),
        "text-decoration-line" => one("text-decoration", value),
        "font-variant-caps" => one("font-variant", value),
        "overflow-x" | "overflow-y" => one("overflow", value),
        name => one(name, value),
    }
}

/// Returns whether a value is `url(…)`.
pub(in crate::design::svg) fn is_reference(value: &str) -> bool {
    value
        .get(..4)
        .is_some_and(|head| head.eq_ignore_ascii_case("url("))
}

/// Sizes and colours to which values refer.
#[derive(Clone, Copy, Debug)]
pub(in crate::design::svg) struct ValueContext<'v> {
    pub lengths: LengthContext,
    /// Value of `currentColor`.
    pub current_colour: &'v str,
}

/// Converts a declared value to the value of a plain attribute. Returns `None` if it is invalid, in
/// which case CSS ignores the declaration.
pub(in crate::design::svg) fn plain_value(
    property: &Property,
    value: &str,
    context: &ValueContext,
) -> Option<String> {
    let lower = || value.to_ascii_lowercase();
    let (current, lengths) = (context.current_colour, &context.lengths);
    match property.value_type {
        ValueType::Paint => plain_paint(value, context),
        ValueType::Colour => plain_colour(value, current, lengths),
        ValueType::Opacity => {
            let found = evaluate(value, lengths, PercentageBasis::One)?;
            let is_number = found.kind == CssQuantityKind::Number;
            is_number.then(|| found.value.clamp(0.0, 1.0).to_string())
        }
        ValueType::Number => {
            let found = evaluate(value, lengths, PercentageBasis::One)?;
            (found.kind == CssQuantityKind::Number).then(|| found.value.to_string())
        }
        ValueType::Length(basis) => {
            let lower = lower();
            let is_keyword =
                lower.starts_with(|c: char| c.is_ascii_alphabetic()) && !lower.contains('(');
            match is_keyword {
                true => Some(lower),
                false => plain_lengths(value, lengths, basis),
            }
        }
        ValueType::Geometry(basis) => {
            if lower() == "auto" {
                return Some(String::new());
            }
            let found = evaluate(value, lengths, basis)?;
            let has_unit = found.kind == CssQuantityKind::Length || found.value == 0.0;
            has_unit.then(|| found.value.to_string())
        }
        ValueType::Keyword => Some(plain_keyword(property.name, &lower())),
        ValueType::Verbatim | ValueType::Transform => Some(value.trim().to_owned()),
        ValueType::PathData => path_data(value),
    }
}

/// Restores the capital letters of keywords that have them in attributes.
fn plain_keyword(property: &str, lower: &str) -> String {
    match (property, lower) {
        ("color-interpolation" | "color-interpolation-filters", "srgb") => "sRGB".to_owned(),
        ("color-interpolation" | "color-interpolation-filters", "linearrgb") => {
            "linearRGB".to_owned()
        }
        ("shape-rendering", "optimizespeed") => "optimizeSpeed".to_owned(),
        ("shape-rendering", "crispedges") => "crispEdges".to_owned(),
        ("shape-rendering" | "text-rendering", "geometricprecision") => {
            "geometricPrecision".to_owned()
        }
        (_, lower) => lower.to_owned(),
    }
}

/// Converts a paint: a colour, a keyword, or a reference with an optional fallback.
fn plain_paint(value: &str, context: &ValueContext) -> Option<String> {
    let value = value.trim();
    if is_reference(value) {
        let end = find_outside_brackets(&value[4..], ")").map_or(value.len(), |end| end + 5);
        let (reference, fallback) = value.split_at(end);
        let fallback = match fallback.trim() {
            "" => String::new(),
            fallback if is_reference(fallback) => return None,
            fallback => plain_paint(fallback, context)?,
        };
        return Some(format!("{reference} {fallback}").trim_end().to_owned());
    }
    let lower = value.to_ascii_lowercase();
    match lower.as_str() {
        "none" | "context-fill" | "context-stroke" => Some(lower),
        _ => plain_colour(value, context.current_colour, &context.lengths),
    }
}

/// Returns the content of `path("…")`; an empty path for `none`.
fn path_data(value: &str) -> Option<String> {
    if value.trim().eq_ignore_ascii_case("none") {
        return Some(String::new());
    }
    let inner = value
        .trim()
        .strip_prefix("path(")?
        .strip_suffix(')')?
        .trim();
    // A fill rule before the string is allowed in clip paths only.
    quoted(inner).map(str::to_owned)
}

/// Returns the content of a string in quotation marks.
pub(super) fn quoted(text: &str) -> Option<&str> {
    let quote = text.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    text.strip_prefix(quote)?.strip_suffix(quote)
}

#[cfg(test)]
mod tests {
    use super::super::math::tests::CONTEXT;
    use super::*;

    fn plain(name: &str, value: &str) -> Option<String> {
        let context = ValueContext {
            lengths: CONTEXT,
            current_colour: "blue",
        };
        plain_value(property(name).expect("known"), value, &context)
    }

    #[test]
    fn values_become_those_of_attributes() {
        let cases = [
            ("fill", "URL(#a) hsl(0 100% 50%)", "URL(#a) #ff0000"),
            ("fill", "currentcolor", "currentColor"),
            ("fill", "NONE", "none"),
            ("stroke-width", "calc(1px + 1em)", "21"),
            ("stroke-width", "2", "2"),
            ("stroke-dasharray", "4 calc(2px * 3), 1rem", "4 6, 16"),
            ("stroke-dasharray", "None", "none"),
            ("opacity", "50%", "0.5"),
            ("opacity", "calc(1 / 4)", "0.25"),
            ("r", "10%", "35.35533905932737"),
            ("height", "25%", "100"),
            ("width", "auto", ""),
            ("d", "path('M0 0L1 1')", "M0 0L1 1"),
            ("fill-rule", "EvenOdd", "evenodd"),
            ("shape-rendering", "crispedges", "crispEdges"),
            ("font-size", "2rem", "32"),
            ("font-size", "Large", "large"),
        ];
        for (name, value, expected) in cases {
            assert_eq!(
                plain(name, value).as_deref(),
                Some(expected),
                "{name}: {value}"
            );
        }
    }

    #[test]
    fn invalid_values_are_refused() {
        for (name, value) in [
            ("fill", "rde"),
            ("width", "60"),
            ("opacity", "1px"),
            ("d", "M0 0"),
        ] {
            assert_eq!(plain(name, value), None, "{name}: {value}");
        }
    }

    #[test]
    fn shorthands_set_all_their_properties() {
        let names = |name, value| {
            let found = longhands(name, value).into_iter();
            found
                .map(|(name, value)| format!("{name}:{value}"))
                .collect::<Vec<_>>()
        };
        assert_eq!(names("marker", "none").len(), 3);
        let mask = names("mask", "url(#m) no-repeat luminance");
        assert_eq!(mask, ["mask:url(#m)", "mask-mode:luminance"]);
        assert_eq!(names("-webkit-mask-image", "url(#m)"), ["mask:url(#m)"]);
    }
}
