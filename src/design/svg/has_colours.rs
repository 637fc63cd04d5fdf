//! Whether a drawing has colours of its own.
//!
//! What names none is black by default, which says nothing: such a drawing is a
//! figure, in whatever colour it is wanted.

use usvg::roxmltree::{Document, Node};

const PAINTS: [&str; 3] = ["fill", "stroke", "stop-color"];

/// Values that name no colour.
const NOTHING: [&str; 6] = ["", "none", "currentColor", "inherit", "initial", "unset"];

/// Whether any fill or stroke of a drawing is given a colour.
pub(super) fn names_a_colour(document: &Document) -> bool {
    document.descendants().any(|node| {
        let own = PAINTS.iter().filter_map(|name| node.attribute(*name));
        let styles = node.attribute("style").into_iter().chain(sheet(&node));
        own.into_iter().any(is_colour) || styles.into_iter().any(declares)
    })
}

fn is_colour(value: &str) -> bool {
    !NOTHING.contains(&value.trim())
}

/// The text of a style sheet.
fn sheet<'d>(node: &Node<'d, '_>) -> Option<&'d str> {
    let is_sheet = node.tag_name().name() == "style";
    is_sheet.then(|| node.text()).flatten()
}

/// Whether declarations, between braces or not, give a paint.
fn declares(style: &str) -> bool {
    let declarations = style.split(['{', '}', ';']);
    declarations.into_iter().any(|declaration| {
        let named = declaration.split_once(':');
        named.is_some_and(|(name, value)| PAINTS.contains(&name.trim()) && is_colour(value))
    })
}
