//! Detects whether a drawing specifies any colour.
//!
//! A drawing without colours is black by SVG's default, so black is not its author's choice. Such a
//! drawing is imported as a silhouette, without paint layers, and can take any colour.

use usvg::roxmltree::{Document, Node};

/// Names of the attributes and style properties that can specify a colour.
const PAINTS: [&str; 3] = ["fill", "stroke", "stop-color"];

/// Values of the attributes and properties in [`PAINTS`] that specify no colour.
const NOTHING: [&str; 6] = ["", "none", "currentColor", "inherit", "initial", "unset"];

/// Returns whether any fill, stroke or gradient stop of a drawing has a colour, or whether it has
/// pictures.
pub(super) fn names_a_colour(document: &Document) -> bool {
    document.descendants().any(|node| {
        let attributes = PAINTS.iter().filter_map(|name| node.attribute(*name));
        let styles = node.attribute("style").into_iter().chain(sheet(&node));
        let is_picture = node.tag_name().name() == "image";
        is_picture
            || attributes.into_iter().any(is_colour)
            || styles.into_iter().any(declares_colour)
    })
}

/// Returns whether a value of one of the properties in [`PAINTS`] specifies a colour.
fn is_colour(value: &str) -> bool {
    !NOTHING.contains(&value.trim())
}

/// Returns the text of a `style` element; `None` for other elements.
fn sheet<'d>(node: &Node<'d, '_>) -> Option<&'d str> {
    let is_sheet = node.tag_name().name() == "style";
    is_sheet.then(|| node.text()).flatten()
}

/// Returns whether any declaration of a style attribute or style sheet specifies a colour.
fn declares_colour(style: &str) -> bool {
    let declarations = style.split(['{', '}', ';']);
    declarations.into_iter().any(|declaration| {
        let name_and_value = declaration.split_once(':');
        name_and_value
            .is_some_and(|(name, value)| PAINTS.contains(&name.trim()) && is_colour(value))
    })
}
