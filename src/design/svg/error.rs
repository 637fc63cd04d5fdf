//! Errors of the SVG importer and the limits that they mention.

use crate::design::flatten::TooManyPoints;
use crate::geometry::RegionsError;
use usvg::roxmltree;

/// Maximum number of elements after all copies are expanded (resource limit: importing them takes
/// about one second).
pub(super) const MAX_ELEMENTS: u64 = 200_000;

/// Maximum number of XML nodes, including text between elements (resource limit: ten times
/// [`MAX_ELEMENTS`], because files contain many nodes that are not drawn).
pub(super) const MAX_NODES: u32 = 2_000_000;

/// Maximum nesting depth of elements, including copies (resource limit: reading recurses, and the 2
/// MiB stack of a thread suffices for twice as many levels even in debug builds).
pub(super) const MAX_DEPTH: u32 = 96;

/// Error of importing an SVG drawing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SvgError {
    /// The file has too many XML nodes or attributes.
    #[error("the drawing has more than {MAX_NODES} elements or attributes; remove hidden content")]
    TooManyNodes,
    /// An element has too many attributes.
    #[error("line {line}: an element has {attributes} attributes; save the drawing as plain SVG")]
    TooManyAttributes {
        /// Line of the element, counted from 1.
        line: usize,
        /// Number of attributes.
        attributes: u64,
    },
    /// The file declares namespaces too often; holds the number of distinct prefixes.
    #[error("the drawing declares {0} namespaces too often; save it as plain SVG")]
    TooManyNamespaces(usize),
    /// Entities expand into too much text.
    #[error("the entities of the drawing expand into too much text; save it without entities")]
    TooMuchText,
    /// An entity contains elements; holds its line, counted from 1.
    #[error("line {0}: an entity contains elements; save the drawing without entities")]
    EntityOfElements(usize),
    /// The file is not well-formed XML.
    #[error("the drawing is not well-formed XML ({0}); save it as plain SVG")]
    Xml(#[source] roxmltree::Error),
    /// The file is not valid SVG or has no size.
    #[error("the drawing cannot be read ({0}); save it as plain SVG")]
    Svg(#[source] usvg::Error),
    /// The expanded drawing has too many elements; holds the line, counted from 1, of the element
    /// that exceeds the limit.
    #[error(
        "line {0}: the drawing expands into more than {MAX_ELEMENTS} elements because of copies (use, patterns, clip paths); remove some copies"
    )]
    TooManyElements(u32),
    /// Elements are nested too deeply; holds the line of the deepest one, counted from 1.
    #[error(
        "line {0}: the drawing is nested more than {MAX_DEPTH} levels deep, including copies; ungroup it"
    )]
    TooDeep(u32),
    /// Matching the style sheet would take too long; holds the number of elements.
    #[error(
        "the style sheet is too long for a drawing of {0} elements; save it with plain attributes"
    )]
    TooMuchStyle(usize),
    /// The drawing has no visible fills. It may have visible strokes, but only if the import
    /// options exclude strokes.
    #[error(
        "the drawing has no filled shapes{}; fill shapes",
        if *strokes { ", only strokes, and strokes = false" } else { "" }
    )]
    NothingFilled {
        /// Whether the drawing has strokes that the import options exclude.
        strokes: bool,
    },
    /// No element has the id.
    #[error(
        "the drawing has no element with the id \"{id}\"; {}",
        known_ids(known)
    )]
    NoElement {
        /// Requested id.
        id: String,
        /// First few ids that the drawing has.
        known: Vec<String>,
    },
    /// The selected element draws nothing; holds its id.
    #[error(
        "the element \"{0}\" draws nothing by itself; choose a shape, a group or a <use> outside of <defs>"
    )]
    NotDrawn(String),
    /// The outlines need too many points.
    #[error(transparent)]
    TooManyPoints(#[from] TooManyPoints),
    /// The shapes enclose no area.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// Returns the end of a message, which lists the known ids.
fn known_ids(known: &[String]) -> String {
    match known {
        [] => "it has no ids; give the element one or import the whole drawing".to_owned(),
        known => format!("it has {}", known.join(", ")),
    }
}
