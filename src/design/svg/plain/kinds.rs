//! Kinds of elements: which are written to the plain drawing, and which are reported as ignored.

use usvg::roxmltree::Node;

/// Namespace of SVG.
const SVG: &str = "http://www.w3.org/2000/svg";

/// Kind of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ElementKind {
    /// Drawn, or used by drawn elements.
    Drawn,
    /// `use`.
    Copy,
    /// Never visible in a still picture: descriptions, scripts, elements of other namespaces.
    Invisible,
    /// Changes another element over time.
    Animation,
    /// Visible in browsers, but ignored here.
    Unsupported,
}

/// Elements that are written.
const DRAWN: [&str; 23] = [
    "svg", "g", "defs", "symbol", "a", "switch", "path", "rect", "circle", "ellipse", "line",
    "polyline", "polygon", "text", "tspan", "textPath", "tref", "clipPath", "mask", "marker",
    "pattern", "image", "stop",
];

/// Elements without visible effect on a still picture. Filters are reported where they are used.
const INVISIBLE: [&str; 9] = [
    "style", "script", "title", "desc", "metadata", "filter", "view", "cursor", "discard",
];

/// Elements that change others over time.
const ANIMATIONS: [&str; 6] = [
    "animate",
    "set",
    "animateTransform",
    "animateMotion",
    "animateColor",
    "mpath",
];

impl ElementKind {
    pub(super) fn of(node: Node) -> Self {
        let name = node.tag_name();
        let is_svg = matches!(name.namespace(), None | Some(SVG));
        match name.name() {
            _ if !is_svg => Self::Invisible,
            "use" => Self::Copy,
            "linearGradient" | "radialGradient" => Self::Drawn,
            name if DRAWN.contains(&name) => Self::Drawn,
            name if INVISIBLE.contains(&name) => Self::Invisible,
            name if ANIMATIONS.contains(&name) => Self::Animation,
            _ => Self::Unsupported,
        }
    }
}

/// Returns whether a `switch` offers another element in place of an unsupported one.
pub(super) fn has_fallback(node: Node) -> bool {
    let is_choice = |parent: Node| parent.tag_name().name() == "switch";
    let next = std::iter::successors(node.next_sibling_element(), Node::next_sibling_element);
    let mut others = next.filter(|other| {
        matches!(
            ElementKind::of(*other),
            ElementKind::Drawn | ElementKind::Copy
        )
    });
    node.parent_element().is_some_and(is_choice) && others.next().is_some()
}
