//! Expands copies (`use`) into groups, and symbols into nested drawings (SVG 2, section 5.5).

use super::PlainWriter;
use super::attributes::href;
use super::element_style::ElementStyle;
use super::inherited::{InheritedStyle, Overrides};
use super::kinds::ElementKind;
use crate::design::svg::css::math::{PercentageBasis, evaluate};
use crate::design::svg::error::SvgError;
use crate::design::svg::lost_features::element_label;
use usvg::roxmltree::Node;

impl<'d, 'a> PlainWriter<'_, '_, 'd, 'a> {
    /// Writes a copy of the element that `node` refers to.
    pub(super) fn copy(
        &mut self,
        node: Node<'d, 'a>,
        inherited: &InheritedStyle,
    ) -> Result<(), SvgError> {
        let Some(target) = self.copy_target(node) else {
            return Ok(());
        };
        self.count(node)?;
        let style = self.style(node, inherited, &Overrides::default());
        // Copies of elements that take paints from the copy are left to `usvg`.
        if takes_context_paint(target) {
            self.open_tag(node, "use", &style, inherited, &Overrides::default());
            self.close_tag("use");
            return Ok(());
        }
        self.expanded_copy(node, target, style, inherited)
    }

    /// Returns the element that a copy shows. Reports references to other files and to the copy
    /// itself.
    fn copy_target(&mut self, node: Node<'d, 'a>) -> Option<Node<'d, 'a>> {
        let reference = href(node).unwrap_or_default().trim();
        let Some(id) = reference.strip_prefix('#') else {
            if !reference.is_empty() {
                self.lost
                    .ignore("use of another file", &element_label(node));
            }
            return None;
        };
        let target = *self.sources.ids.get(id)?;
        let is_circular = self.open_copies.contains(&target.id())
            || self.sources.broken.contains(&(node.id(), target.id()))
            || node.ancestors().any(|outer| outer == target);
        if is_circular {
            self.lost.ignore("use of itself", &element_label(node));
            return None;
        }
        let is_drawn = matches!(
            ElementKind::of(target),
            ElementKind::Drawn | ElementKind::Copy
        );
        is_drawn.then_some(target)
    }

    /// Writes a group with a copy of `target`.
    fn expanded_copy(
        &mut self,
        node: Node<'d, 'a>,
        target: Node<'d, 'a>,
        mut style: ElementStyle,
        inherited: &InheritedStyle,
    ) -> Result<(), SvgError> {
        let without_link = Overrides {
            tag: Some("g"),
            attributes: vec![("href", String::new())],
        };
        let mut removed = |name| style.values.remove(name).map(|value| value.text);
        let size = ["width", "height"].map(&mut removed);
        let [x, y] = ["x", "y"].map(|name| removed(name).unwrap_or_default());
        let place = [(x, PercentageBasis::Width), (y, PercentageBasis::Height)];
        let [x, y] = place.map(|(text, basis)| {
            evaluate(&text, &style.lengths, basis).map_or(0.0, |found| found.value)
        });
        self.open_tag(node, "g", &style, inherited, &without_link);
        let number = self.copies.entry(target.id()).or_default();
        *number += 1;
        let content = InheritedStyle {
            copy: *number,
            ..style.inherited_by_content(node, "g", inherited, &without_link)
        };
        let is_moved = [x, y] != [0.0; 2];
        if is_moved {
            self.drawing.text += &format!("<g transform=\"translate({x} {y})\">");
        }
        self.open_copies.push(target.id());
        let written = self.copied(target, &content, &size);
        self.open_copies.pop();
        written?;
        if is_moved {
            self.close_tag("g");
        }
        self.close_tag("g");
        Ok(())
    }

    /// Writes the copied element. `size` is the width and height of the copy, if given.
    fn copied(
        &mut self,
        target: Node<'d, 'a>,
        inherited: &InheritedStyle,
        size: &[Option<String>; 2],
    ) -> Result<(), SvgError> {
        let mut overrides = Overrides::default();
        for (name, value) in ["width", "height"].into_iter().zip(size) {
            if let Some(value) = value.as_ref().filter(|value| !value.is_empty()) {
                overrides.attributes.push((name, value.clone()));
            }
        }
        match target.tag_name().name() {
            "symbol" => self.symbol(target, inherited, overrides),
            "svg" => self.element(target, inherited, &overrides),
            _ => self.element(target, inherited, &Overrides::default()),
        }
    }

    /// Writes a symbol as a nested drawing.
    fn symbol(
        &mut self,
        symbol: Node<'d, 'a>,
        inherited: &InheritedStyle,
        mut overrides: Overrides,
    ) -> Result<(), SvgError> {
        self.count(symbol)?;
        let style = self.style(symbol, inherited, &overrides);
        for name in ["width", "height"] {
            let is_set = |name: &str| style.values.get(name).is_some_and(|v| !v.text.is_empty());
            if overrides.get(name).is_none() && !is_set(name) {
                overrides.attributes.push((name, "100%".to_owned()));
            }
        }
        self.open_tag(symbol, "svg", &style, inherited, &overrides);
        let content = style.inherited_by_content(symbol, "svg", inherited, &overrides);
        self.content(symbol, &content)?;
        self.close_tag("svg");
        Ok(())
    }
}

/// Returns whether an element or its content takes its paint from the copy or marker it is in.
fn takes_context_paint(target: Node) -> bool {
    let elements = target.descendants().flat_map(|node| node.attributes());
    let mut values = elements.map(|attribute| attribute.value());
    values.any(|value| value.contains("context-fill") || value.contains("context-stroke"))
}

#[cfg(test)]
mod tests {
    use super::super::{plain_id, source_element};

    #[test]
    fn ids_of_copies_lead_back_to_their_element() {
        let text = "<svg><rect id='a'/></svg>";
        let document = usvg::roxmltree::Document::parse(text).expect("well-formed");
        let rect = document
            .descendants()
            .find(|n| n.has_tag_name("rect"))
            .expect("a rectangle");
        for copy in [0, 1, 12] {
            let id = plain_id(rect.id(), copy);
            assert_eq!(source_element(&id), Some(rect.id()));
        }
    }
}
