//! Names of elements, by which the parts of two drawings are paired.

use usvg::roxmltree::Node;

/// Namespace of Inkscape's own attributes.
const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// Returns the name that an author gave to an element: its label in Inkscape (layers have one),
/// its `title`, or its id. Empty if it has none; the root element has no name, because it names the
/// whole drawing.
pub(super) fn element_name(node: Node) -> String {
    if node.parent_element().is_none() {
        return String::new();
    }
    let title = node
        .children()
        .find(|child| child.tag_name().name() == "title");
    let title = title.and_then(|title| title.text());
    let candidates = [
        node.attribute((INKSCAPE, "label")),
        title,
        node.attribute("id"),
    ];
    let named = candidates.into_iter().flatten().map(str::trim);
    let mut named = named.filter(|name| !name.is_empty());
    named.next().unwrap_or_default().to_owned()
}
