//! Writes clip paths that are basic shapes (`clip-path: circle(…)`) as `clipPath` elements.

use super::element_style::{ElementStyle, PropertyValue};
use super::{PlainWriter, push_escaped};
use crate::design::svg::css::basic_shapes::{ShapeReader, ShapeValue};
use crate::design::svg::css::math::LengthContext;
use crate::design::svg::css::properties::is_reference;
use crate::design::svg::lost_features::element_label;
use usvg::roxmltree::Node;

impl<'d, 'a> PlainWriter<'_, '_, 'd, 'a> {
    /// Writes the definition of a clip path that is a basic shape, and returns the reference to it.
    /// Returns `None` for shapes that cannot be read, which are reported, and for boxes that are
    /// not known yet.
    pub(super) fn clip_shape(
        &mut self,
        node: Node<'d, 'a>,
        value: &PropertyValue,
        style: &ElementStyle,
    ) -> Option<String> {
        let text = value.text.as_str();
        let shape = ShapeValue::of(text)?;
        let reference = self.reference_box(node, shape.reference, style)?;
        let reader = ShapeReader {
            context: LengthContext {
                viewport: reference.size,
                ..style.lengths
            },
            plain_numbers: value.is_attribute,
        };
        let Some(outline) = reader.outline(&shape) else {
            self.lost
                .ignore(&format!("clip-path {text}"), &element_label(node));
            return None;
        };
        let id = format!("clip-{}", self.definitions.len());
        let rule = if outline.is_even_odd {
            "evenodd"
        } else {
            "nonzero"
        };
        let [x, y] = reference.corner.to_array();
        self.definitions += &format!(
            "<clipPath id=\"{id}\"><path transform=\"translate({x} {y})\" clip-rule=\"{rule}\" d=\""
        );
        push_escaped(&mut self.definitions, &outline.data);
        self.definitions += "\"/></clipPath>";
        Some(format!("url(#{id})"))
    }
}

/// Returns whether the value of a property is a clip path that is a basic shape.
pub(super) fn is_clip_shape(name: &str, text: &str) -> bool {
    name == "clip-path" && !is_reference(text) && ShapeValue::of(text).is_some()
}
