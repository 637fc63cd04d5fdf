//! Values of the properties of one element: presentation attributes overridden by declarations.

use super::inherited::{InheritedStyle, Overrides, view_box_size};
use crate::design::svg::css::math::{
    LengthContext, PercentageBasis, evaluate, font_dependent_unit, plain_lengths,
};
use crate::design::svg::css::properties::{
    Property, ValueContext, ValueType, has_geometry, is_presentation_attribute, longhands,
    plain_value, property,
};
use crate::design::svg::css::syntax::Declaration;
use crate::design::svg::css::tokens::components;
use crate::design::svg::css::variables::{
    Variables, computed_variables, has_references, substitute,
};
use crate::design::svg::lost_features::{LostFeatures, element_label};
use crate::geometry::DVec2;
use std::collections::BTreeMap;
use std::rc::Rc;
use usvg::roxmltree::Node;

/// Value of a property of an element.
#[derive(Clone, Debug)]
pub(super) struct PropertyValue {
    /// Value of the plain attribute.
    pub text: String,
    /// Whether the value was a presentation attribute of the source.
    pub is_attribute: bool,
}

/// Values of all properties that an element sets.
pub(super) struct ElementStyle {
    pub values: BTreeMap<&'static str, PropertyValue>,
    variables: Variables,
    pub lengths: LengthContext,
    /// Value of `color`.
    pub colour: String,
}

/// Properties that change a picture in browsers and are ignored here, with the values that have no
/// effect.
const IGNORED: [(&str, &[&str]); 15] = [
    ("animation", &["none"]),
    ("animation-name", &["none"]),
    ("clip", &["auto"]),
    ("color-interpolation", &["auto", "sRGB"]),
    ("direction", &["ltr"]),
    ("filter", &["none"]),
    ("font-feature-settings", &["normal"]),
    ("font-size-adjust", &["none"]),
    ("glyph-orientation-horizontal", &["auto", "0", "0deg"]),
    ("glyph-orientation-vertical", &["auto"]),
    ("offset-path", &["none"]),
    ("perspective", &["none"]),
    ("text-overflow", &["clip"]),
    ("text-shadow", &["none"]),
    ("unicode-bidi", &["normal", "embed", "isolate"]),
];

/// Keywords of all properties that stand for another value.
const INHERITING: [&str; 2] = ["inherit", "unset"];

impl ElementStyle {
    /// Computes the values of an element from the declarations that apply to it, in ascending
    /// precedence. Unsupported properties are added to `lost`.
    pub(super) fn of(
        declarations: &[Declaration],
        node: Node,
        inherited: &InheritedStyle,
        overrides: &Overrides,
        lost: &mut LostFeatures,
    ) -> Self {
        let variables = variables(declarations, &inherited.variables);
        let declared = declared_values(declarations, &variables);
        let mut style = Self {
            values: BTreeMap::new(),
            variables,
            lengths: inherited.lengths,
            colour: inherited.colour.clone(),
        };
        report_font_dependent_units(node, &declared, lost);
        style.set_font_size(node, &declared, inherited);
        style.set_colour(node, &declared);
        style.set_attributes(node, overrides);
        for (name, value) in &declared {
            style.declare(node, name, value.as_deref());
        }
        for (name, _) in &overrides.attributes {
            style.values.remove(name);
        }
        for (name, without_effect) in IGNORED {
            let value = style.values.remove(name);
            let has_effect = |value: &PropertyValue| {
                let mut plain = without_effect.iter();
                !value.text.is_empty()
                    && !plain.any(|plain| plain.eq_ignore_ascii_case(&value.text))
            };
            if value.as_ref().is_some_and(has_effect) {
                let feature = name.trim_end_matches("-name");
                lost.ignore(feature, &element_label(node));
            }
        }
        style
    }

    fn context(&self) -> ValueContext<'_> {
        ValueContext {
            lengths: self.lengths,
            current_colour: &self.colour,
        }
    }

    /// Adopts the presentation attributes.
    fn set_attributes(&mut self, node: Node, overrides: &Overrides) {
        let tag = node.tag_name().name();
        for attribute in node.attributes() {
            let name = attribute.name();
            let is_plain = attribute.namespace().is_none() && overrides.get(name).is_none();
            let Some(property) = property(name).filter(|_| is_plain) else {
                continue;
            };
            if is_presentation_attribute(name, tag) {
                self.set_attribute(property, attribute.value());
            }
        }
    }

    /// Adopts one presentation attribute. Its lengths need no units.
    fn set_attribute(&mut self, property: &'static Property, value: &str) {
        let Some(value) = substituted(value, &self.variables) else {
            return;
        };
        let value = value.as_str();
        let is_wide = INHERITING.contains(&value.trim()) || value.trim() == "initial";
        if is_wide {
            return self.set_wide_keyword(property, value.trim());
        }
        let text = match property.value_type {
            ValueType::Geometry(basis) => plain_lengths(value, &self.lengths, basis),
            ValueType::PathData => Some(value.to_owned()),
            _ => plain_value(property, value, &self.context()),
        };
        if let Some(text) = text {
            let is_attribute = true;
            let value = PropertyValue { text, is_attribute };
            self.values.insert(property.name, value);
        }
    }

    /// Applies one declaration; `None` stands for a value with an invalid variable, which makes the
    /// property `unset`.
    fn declare(&mut self, node: Node, name: &str, value: Option<&str>) {
        if name == "all" {
            return self.values.clear();
        }
        let tag = node.tag_name().name();
        let Some(property) = property(name).filter(|_| has_geometry(name, tag)) else {
            return;
        };
        let keyword = value.unwrap_or("unset").to_ascii_lowercase();
        if matches!(
            keyword.as_str(),
            "inherit" | "unset" | "initial" | "revert" | "revert-layer"
        ) {
            return self.set_wide_keyword(property, &keyword);
        }
        let Some(text) = value.and_then(|value| plain_value(property, value, &self.context()))
        else {
            return; // invalid declarations are ignored
        };
        if name == "font" {
            self.values.retain(|name, _| !name.starts_with("font"));
        }
        let is_attribute = false;
        let value = PropertyValue { text, is_attribute };
        self.values.insert(property.name, value);
    }

    /// Applies a keyword that all properties have.
    fn set_wide_keyword(&mut self, property: &'static Property, keyword: &str) {
        let text = match keyword {
            "inherit" if !property.is_inherited => "inherit",
            "initial" if property.is_inherited => property.initial,
            _ => "",
        };
        match text {
            "" => self.values.remove(property.name),
            text => {
                let (text, is_attribute) = (text.to_owned(), false);
                let value = PropertyValue { text, is_attribute };
                self.values.insert(property.name, value)
            }
        };
    }

    /// Computes the font size, to which other lengths refer.
    fn set_font_size(
        &mut self,
        node: Node,
        declared: &[DeclaredValue],
        inherited: &InheritedStyle,
    ) {
        let attribute = node.attribute("font-size").map(str::to_owned);
        let size = declared
            .iter()
            .rev()
            .find_map(|(name, value)| match name.as_str() {
                "font-size" => value.clone(),
                "font" => shorthand_size(value.as_deref()?),
                _ => None,
            });
        let size = size
            .or(attribute)
            .and_then(|text| font_size(&text, &inherited.lengths));
        if let Some(size) = size {
            self.lengths.font_size = size;
        }
        if node.parent_element().is_none() {
            self.lengths.root_font_size = self.lengths.font_size;
        }
    }

    /// Computes the value of `color`, to which other colours refer.
    fn set_colour(&mut self, node: Node, declared: &[DeclaredValue]) {
        let attribute = node.attribute("color");
        let attribute = attribute.and_then(|value| substituted(value, &self.variables));
        let declared = declared.iter().rev().filter(|(name, _)| name == "color");
        let values = declared
            .filter_map(|(_, value)| value.clone())
            .chain(attribute);
        let Some(property) = property("color") else {
            return;
        };
        let mut plain = values.filter_map(|value| plain_value(property, &value, &self.context()));
        if let Some(colour) = plain.next().filter(|colour| colour != "currentColor") {
            drop(plain);
            self.colour = colour;
        }
    }

    /// Returns the values that the content of the element inherits. `tag` is the name under which
    /// the element is written.
    pub(super) fn inherited_by_content(
        &self,
        node: Node,
        tag: &str,
        inherited: &InheritedStyle,
        overrides: &Overrides,
    ) -> InheritedStyle {
        let mut lengths = self.lengths;
        if tag == "svg" && node.parent_element().is_some() {
            let size = |name, basis| {
                let own = self.values.get(name).map(|value| value.text.as_str());
                let text = overrides.get(name).or(own).unwrap_or("100%");
                let found = evaluate(text, &self.lengths, basis);
                found.map_or(self.lengths.whole(basis), |found| found.value)
            };
            let width = size("width", PercentageBasis::Width);
            let height = size("height", PercentageBasis::Height);
            lengths.viewport = view_box_size(node).unwrap_or(DVec2::new(width, height));
        }
        let transform = self.values.get("text-transform");
        InheritedStyle {
            variables: Rc::clone(&self.variables),
            lengths,
            colour: self.colour.clone(),
            text_transform: match transform {
                Some(value) => value.text.clone(),
                None => inherited.text_transform.clone(),
            },
            is_in_clip_path: inherited.is_in_clip_path || tag == "clipPath",
            is_in_text: inherited.is_in_text || tag == "text",
            copy: inherited.copy,
        }
    }
}

/// Name of a property with its value after the substitution of variables; `None` if a variable is
/// invalid.
type DeclaredValue = (String, Option<String>);

/// Computes the custom properties of an element.
fn variables(declarations: &[Declaration], parent: &Variables) -> Variables {
    let custom = declarations.iter().filter(|d| d.name.starts_with("--"));
    let custom = custom
        .map(|d| (d.name.as_str(), d.value.as_str()))
        .collect();
    computed_variables(&custom, parent)
}

/// Substitutes the variables in a value; `None` if one of them has no value.
fn substituted(value: &str, variables: &Variables) -> Option<String> {
    match has_references(value) {
        true => substitute(value, &mut |name| variables.get(name).cloned()),
        false => Some(value.to_owned()),
    }
}

/// Substitutes variables and splits shorthands.
fn declared_values(declarations: &[Declaration], variables: &Variables) -> Vec<DeclaredValue> {
    let plain = declarations.iter().filter(|d| !d.name.starts_with("--"));
    let mut declared = Vec::new();
    for Declaration { name, value, .. } in plain {
        let value = substituted(value, variables);
        let text = value.as_deref().unwrap_or_default();
        let split = longhands(name, text).into_iter();
        declared.extend(split.map(|(name, text)| (name, value.is_some().then_some(text))));
    }
    declared
}

/// Reports lengths whose size depends on a font.
fn report_font_dependent_units(node: Node, declared: &[DeclaredValue], lost: &mut LostFeatures) {
    let attributes = node.attributes().map(|a| (a.name(), Some(a.value())));
    let declared = declared
        .iter()
        .map(|(name, value)| (name.as_str(), value.as_deref()));
    for (name, value) in attributes.chain(declared) {
        let is_length = property(name).is_some_and(|property| {
            use ValueType::{Geometry, Length, Transform};
            matches!(property.value_type, Length(_) | Geometry(_) | Transform)
        });
        if let Some(unit) = value.filter(|_| is_length).and_then(font_dependent_unit) {
            let done = "estimated from the font size";
            lost.replace(&format!("length in {unit}"), done, &element_label(node));
        }
    }
}

/// Returns the font size of a `font` shorthand.
fn shorthand_size(font: &str) -> Option<String> {
    let words = components(font);
    let sizes = words
        .iter()
        .map(|word| word.split('/').next().unwrap_or(word));
    let mut sizes = sizes.filter(|word| word.starts_with(|c: char| c.is_ascii_digit() || c == '.'));
    // A number without unit is a weight.
    let size = sizes.find(|word| word.ends_with(|c: char| c.is_ascii_alphabetic() || c == '%'));
    size.map(str::to_owned)
}

/// Computes a font size. `parent` holds the font size of the parent.
fn font_size(text: &str, parent: &LengthContext) -> Option<f64> {
    let ratio = match text.trim().to_ascii_lowercase().as_str() {
        // Sizes of browsers at the default size of 16.
        "xx-small" => return Some(9.0),
        "x-small" => return Some(10.0),
        "small" => return Some(13.0),
        "medium" | "initial" => return Some(16.0),
        "large" => return Some(18.0),
        "x-large" => return Some(24.0),
        "xx-large" => return Some(32.0),
        "larger" => Some(1.2),
        "smaller" => Some(1.0 / 1.2),
        _ => None,
    };
    match ratio {
        Some(ratio) => Some(ratio * parent.font_size),
        None => evaluate(text, parent, PercentageBasis::FontSize).map(|found| found.value),
    }
}
