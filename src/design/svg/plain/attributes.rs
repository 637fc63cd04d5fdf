//! Writes the start tag of an element: its properties and its other attributes, with references by
//! the ids of the plain drawing.

use super::element_style::{ElementStyle, PropertyValue};
use super::inherited::{InheritedStyle, Overrides};
use super::{PlainWriter, plain_id, push_escaped};
use crate::design::svg::css::properties::is_presentation_attribute;
use crate::design::svg::css::syntax::find_outside_brackets;
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
        self.properties(node, style, is_root);
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
            Target::External if tag == "image" && is_drawing(href) => {
                return self.attribute("href", href);
            }
            Target::External if tag == "image" => "picture in the drawing",
            Target::External => "reference to another file",
        };
        self.lost.ignore(feature, &element_label(node));
    }

    /// Writes the properties, except those that make up the transform.
    fn properties(&mut self, node: Node<'d, 'a>, style: &ElementStyle, is_root: bool) {
        let has_font = style.values.contains_key("font");
        let mut declarations = String::new();
        for (&name, value) in &style.values {
            if TRANSFORMS.contains(&name) || name == "text-transform" {
                continue;
            }
            let Some(text) = self.property(node, name, value, is_root) else {
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
        is_root: bool,
    ) -> Option<String> {
        let label = || element_label(node);
        let text = value.text.as_str();
        match name {
            _ if text.is_empty() => return None, // `auto`
            "filter" if text == "none" => return None,
            "filter" => {
                self.lost.ignore("filter", &label());
                return None;
            }
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

    /// Returns the box that a transform refers to; `None` if it has not been measured.
    fn reference_box(
        &mut self,
        node: Node,
        kind: &str,
        style: &ElementStyle,
    ) -> Option<ReferenceBox> {
        let is_own = matches!(
            kind,
            "fill-box" | "content-box" | "stroke-box" | "border-box"
        );
        if !is_own {
            return Some(ReferenceBox {
                corner: DVec2::ZERO,
                size: style.lengths.viewport,
            });
        }
        let measured = self.sources.boxes.get(&node.id());
        self.drawing.lacks_boxes |= measured.is_none();
        measured.map(|bounds| ReferenceBox {
            corner: bounds.min,
            size: bounds.size(),
        })
    }
}

/// Returns whether a link holds a drawing as data.
fn is_drawing(href: &str) -> bool {
    let kinds = [
        "data:image/svg+xml",
        "data:text/xml",
        "data:text/plain",
        "data:,",
        "data:;",
    ];
    kinds.iter().any(|kind| href.trim_start().starts_with(kind))
}

/// Returns the link of an element; `href` overrides `xlink:href`.
pub(in crate::design::svg) fn href<'d>(node: Node<'d, '_>) -> Option<&'d str> {
    let of = |namespace| {
        let is_link = |a: &Attribute| a.name() == "href" && a.namespace() == namespace;
        node.attributes().find(is_link).map(|a| a.value())
    };
    of(None).or_else(|| of(Some(XLINK)))
}
