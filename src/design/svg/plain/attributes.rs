//! Writes the start tag of an element: its properties and its other attributes, with references by
//! the ids of the plain drawing.

use super::clip_shapes::is_clip_shape;
use super::element_style::{ElementStyle, PropertyValue};
use super::inherited::{InheritedStyle, Overrides};
use super::{PlainWriter, plain_id, push_escaped};
use crate::design::svg::css::properties::{is_presentation_attribute, is_reference};
use crate::design::svg::css::tokens::find_outside_brackets;
use crate::design::svg::css::transforms::{ReferenceBox, TransformProperties, affine_map};
use crate::design::svg::lost_features::element_label;
use crate::geometry::DVec2;
use usvg::roxmltree::{Attribute, Node, NodeId};

const XLINK: &str = "http://www.w3.org/1999/xlink";
const XML: &str = "http://www.w3.org/XML/1998/namespace";

/// Properties that `usvg` reads from style attributes only.
const STYLE_ONLY: [&str; 4] = ["font", "mix-blend-mode", "isolation", "font-kerning"];

/// Properties that are read together and written as one attribute.
const TRANSFORMS: [&str; 6] = [
    "transform",
    "transform-origin",
    "transform-box",
    "translate",
    "rotate",
    "scale",
];

/// Reference in a value.
enum Target {
    /// Element of the drawing.
    Element(NodeId),
    /// Id that no element has.
    Missing,
    /// Another file.
    External,
}

/// Returns whether browsers ignore an attribute that `usvg` would apply.
fn is_without_effect(name: &str, value: &str) -> bool {
    match name {
        "font-kerning" => true, // a property of style sheets only
        "textLength" => {
            let number = value
                .trim()
                .trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == '%');
            number.parse().is_ok_and(|length: f64| length == 0.0)
        }
        _ => false,
    }
}

impl<'d, 'a> PlainWriter<'_, '_, 'd, 'a> {
    /// Writes the start tag of an element under the name `tag`.
    pub(super) fn open_tag(
        &mut self,
        node: Node<'d, 'a>,
        tag: &str,
        style: &ElementStyle,
        inherited: &InheritedStyle,
        overrides: &Overrides,
    ) {
        let is_root = node.parent_element().is_none();
        self.drawing.text += &format!("<{tag}");
        if is_root {
            self.drawing.text += " xmlns=\"http://www.w3.org/2000/svg\"";
        }
        self.attribute("id", &plain_id(node.id(), inherited.copy));
        for (name, value) in &overrides.attributes {
            if !value.is_empty() {
                self.attribute(name, value);
            }
        }
        self.other_attributes(node, overrides);
        self.properties(node, style);
        self.white_space(node, style);
        self.report_turned_markers(node, style);
        if let Some((name, value)) = self.transform(node, style) {
            self.attribute(name, &value);
        }
        self.drawing.text.push('>');
    }

    fn attribute(&mut self, name: &str, value: &str) {
        let out = &mut self.drawing.text;
        *out += &format!(" {name}=\"");
        push_escaped(out, value);
        out.push('"');
    }

    /// Writes the attributes that are no properties.
    fn other_attributes(&mut self, node: Node<'d, 'a>, overrides: &Overrides) {
        let tag = node.tag_name().name();
        for attribute in node.attributes() {
            let name = attribute.name();
            let is_own = attribute.namespace().is_none();
            let is_dropped = matches!(
                name,
                "id" | "class"
                    | "style"
                    | "href"
                    | "path"
                    | "gradientTransform"
                    | "patternTransform"
            ) || is_presentation_attribute(name, tag)
                || is_without_effect(name, attribute.value())
                || overrides.get(name).is_some();
            match attribute.namespace() {
                Some(XML) => self.attribute(&format!("xml:{name}"), attribute.value()),
                _ if is_own && !is_dropped => self.attribute(name, attribute.value()),
                _ => {}
            }
        }
        if overrides.get("href").is_none() {
            self.link(node);
        }
    }

    /// Reports markers where an outline is closed: browsers turn them to the mean of the first and
    /// the last direction, `usvg` to one of them.
    fn report_turned_markers(&mut self, node: Node<'d, 'a>, style: &ElementStyle) {
        let value = |name| {
            style
                .values
                .get(name)
                .map_or("", |value| value.text.as_str())
        };
        let is_closed = match node.tag_name().name() {
            "polygon" => true,
            "path" => value("d").contains(['z', 'Z']),
            _ => false,
        };
        let ends = ["marker-start", "marker-end"].map(value);
        if is_closed && ends.iter().any(|end| is_reference(end)) {
            let done = "turned to one of both directions where the outline is closed";
            self.lost.replace("marker", done, &element_label(node));
        }
    }

    /// Writes `white-space` as `xml:space`, which `usvg` knows.
    fn white_space(&mut self, node: Node<'d, 'a>, style: &ElementStyle) {
        let Some(value) = style.values.get("white-space") else {
            return;
        };
        if !node.has_attribute((XML, "space")) {
            let keeps = matches!(value.text.as_str(), "pre" | "pre-wrap" | "break-spaces");
            self.attribute("xml:space", if keeps { "preserve" } else { "default" });
        }
    }

    /// Writes the link of an element to another one.
    fn link(&mut self, node: Node<'d, 'a>) {
        let tag = node.tag_name().name();
        if let Some(path) = node.attribute("path").filter(|_| tag == "textPath") {
            let id = format!("path-of-{}", plain_id(node.id(), 0));
            self.definitions += &format!("<path id=\"{id}\" d=\"");
            push_escaped(&mut self.definitions, path);
            self.definitions += "\"/>";
            return self.attribute("href", &format!("#{id}"));
        }
        let is_link = matches!(
            tag,
            "use" | "image" | "linearGradient" | "radialGradient" | "pattern" | "textPath" | "tref"
        );
        let Some(href) = href(node).filter(|_| is_link) else {
            return;
        };
        let broken = self.sources.broken;
        let feature = match self.target(href) {
            Target::Element(target) if broken.contains(&(node.id(), target)) => {
                "reference to itself"
            }
            Target::Element(target) => {
                return self.attribute("href", &format!("#{}", plain_id(target, 0)));
            }
            Target::Missing => return,
            Target::External if tag == "image" && href.trim_start().starts_with("data:") => {
                // The importer reads the data of this element.
                return self.attribute("href", &plain_id(node.id(), 0));
            }
            Target::External if tag == "image" => "picture in another file",
            Target::External => "reference to another file",
        };
        self.lost.ignore(feature, &element_label(node));
    }

    /// Writes the properties, except those that make up the transform.
    fn properties(&mut self, node: Node<'d, 'a>, style: &ElementStyle) {
        let has_font = style.values.contains_key("font");
        let mut declarations = String::new();
        for (&name, value) in &style.values {
            if TRANSFORMS.contains(&name) || name == "text-transform" {
                continue;
            }
            let text = match is_clip_shape(name, &value.text) {
                true => self.clip_shape(node, value, style),
                false => self.property(node, name, value, style),
            };
            let Some(text) = text else {
                continue;
            };
            // `font` comes first, because it resets the others.
            match STYLE_ONLY.contains(&name) || has_font && name.starts_with("font") {
                true => declarations += &format!("{name}:{text};"),
                false => self.attribute(name, &text),
            }
        }
        if !declarations.is_empty() {
            self.attribute("style", &declarations);
        }
    }

    /// Returns the text of a property; `None` if it is not written.
    fn property(
        &mut self,
        node: Node<'d, 'a>,
        name: &str,
        value: &PropertyValue,
        style: &ElementStyle,
    ) -> Option<String> {
        let label = || element_label(node);
        let is_root = node.parent_element().is_none();
        let text = value.text.as_str();
        match name {
            _ if text.is_empty() => return None, // `auto`
            "background-color" => {
                let colour = match text {
                    "currentColor" => style.colour.clone(),
                    text => text.to_owned(),
                };
                // Only the root element has a box that is painted.
                if is_root {
                    self.drawing.background = Some(colour);
                }
                return None;
            }
            "mask-mode" => {
                let is_plain = text == "match-source" || !style.values.contains_key("mask");
                if !is_plain {
                    self.lost.ignore(&format!("mask-mode {text}"), &label());
                }
                return None;
            }
            "mask" if text.contains('(') && !is_reference(text) => {
                self.lost.ignore(&format!("mask {text}"), &label());
                return None;
            }
            "font-variant" if text == "small-caps" => {
                let done = "drawn only if the font has small capitals";
                self.lost.replace("font-variant small-caps", done, &label());
            }
            "white-space" => return None, // written as `xml:space`
            "vector-effect" if text == "non-scaling-stroke" => {
                self.drawing.non_scaling.insert(node.id());
                return None;
            }
            "vector-effect" if text != "none" => {
                self.lost.ignore(&format!("vector-effect {text}"), &label());
                return None;
            }
            // Sizes relative to the window do not size a page.
            "width" | "height" if is_root && !value.is_attribute && text.contains('%') => {
                return None;
            }
            _ => {}
        }
        self.with_plain_references(node, name, text)
    }

    /// Replaces the ids in `url(#…)`. Returns `None` if the value refers to nothing.
    fn with_plain_references(
        &mut self,
        node: Node<'d, 'a>,
        name: &str,
        text: &str,
    ) -> Option<String> {
        let mut plain = String::new();
        let mut rest = text;
        while let Some(at) = rest.to_ascii_lowercase().find("url(") {
            let inner = &rest[at + 4..];
            let end = find_outside_brackets(inner, ")").unwrap_or(inner.len());
            let reference = inner[..end].trim().trim_matches(['"', '\'']);
            plain.push_str(&rest[..at]);
            rest = inner.get(end + 1..).unwrap_or_default();
            let feature = match self.target(reference) {
                Target::Element(target) if self.sources.broken.contains(&(node.id(), target)) => {
                    format!("{name} that refers to itself")
                }
                Target::Element(target) => {
                    plain += &format!("url(#{})", plain_id(target, 0));
                    continue;
                }
                // Browsers ignore it, too.
                Target::Missing => {
                    plain += "url(#missing)";
                    continue;
                }
                Target::External => format!("{name} from another file"),
            };
            self.lost.ignore(&feature, &element_label(node));
            if rest.trim().is_empty() {
                return matches!(name, "fill" | "stroke").then(|| "none".to_owned());
            }
        }
        plain.push_str(rest);
        Some(plain.trim().to_owned())
    }

    /// Finds the element that a reference names.
    fn target(&self, reference: &str) -> Target {
        match reference.trim().strip_prefix('#') {
            Some(id) => match self.sources.ids.get(id) {
                Some(node) => Target::Element(node.id()),
                None => Target::Missing,
            },
            None => Target::External,
        }
    }

    /// Returns the name and value of the attribute that transforms an element.
    fn transform(
        &mut self,
        node: Node<'d, 'a>,
        style: &ElementStyle,
    ) -> Option<(&'static str, String)> {
        let value = |name| {
            style
                .values
                .get(name)
                .map_or("", |value| value.text.as_str())
        };
        let name = match node.tag_name().name() {
            "linearGradient" | "radialGradient" => "gradientTransform",
            "pattern" => "patternTransform",
            _ => "transform",
        };
        let attribute = node.attribute(name).unwrap_or_default();
        let (transform, is_attribute) = match style.values.get("transform") {
            Some(value) => (value.text.as_str(), value.is_attribute),
            None => (attribute, true),
        };
        let properties = TransformProperties {
            transform,
            is_attribute,
            origin: value("transform-origin"),
            translate: value("translate"),
            rotate: value("rotate"),
            scale: value("scale"),
        };
        let individual = [properties.translate, properties.rotate, properties.scale];
        let is_moved_alone = individual.iter().all(|value| value.is_empty());
        if is_moved_alone && properties.transform.is_empty() {
            return None;
        }
        if is_moved_alone && is_attribute && properties.origin.is_empty() {
            return Some((name, transform.to_owned()));
        }
        let reference = self.reference_box(node, value("transform-box"), style)?;
        match affine_map(&properties, &reference, &style.lengths) {
            Some(map) => {
                let numbers = map.to_cols_array().map(|x| x.to_string()).join(" ");
                Some((name, format!("matrix({numbers})")))
            }
            None => {
                self.lost.ignore("transform", &element_label(node));
                None
            }
        }
    }

    /// Returns the box that a transform or a clip path refers to; `None` if it has not been
    /// measured.
    pub(super) fn reference_box(
        &mut self,
        node: Node,
        kind: &str,
        style: &ElementStyle,
    ) -> Option<ReferenceBox> {
        let measured = self.sources.boxes.get(&node.id());
        let bounds = match kind {
            "fill-box" | "content-box" | "padding-box" => measured.map(|boxes| boxes.fill),
            "stroke-box" | "border-box" | "margin-box" => measured.map(|boxes| boxes.stroke),
            _ => {
                return Some(ReferenceBox {
                    corner: DVec2::ZERO,
                    size: style.lengths.viewport,
                });
            }
        };
        if bounds.is_none() {
            // The note of the last pass counts.
            self.drawing.lacks_boxes = true;
            self.lost
                .ignore(&format!("{kind} that is unknown"), &element_label(node));
        }
        bounds.map(|bounds| ReferenceBox {
            corner: bounds.min,
            size: bounds.size(),
        })
    }
}

/// Returns the link of an element; `href` overrides `xlink:href`.
pub(in crate::design::svg) fn href<'d>(node: Node<'d, '_>) -> Option<&'d str> {
    let of = |namespace| {
        let is_link = |a: &Attribute| a.name() == "href" && a.namespace() == namespace;
        node.attributes().find(is_link).map(|a| a.value())
    };
    of(None).or_else(|| of(Some(XLINK)))
}
