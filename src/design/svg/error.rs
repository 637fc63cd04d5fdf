//! Why a drawing gives no outline, and the limits that errors name.

use crate::design::flatten::TooManyPoints;
use crate::geometry::RegionsError;
use usvg::roxmltree;

/// Most elements with all copies; 200,000 paths take about a second.
pub(super) const MAX_ELEMENTS: u64 = 200_000;
/// Most XML nodes in the file, text between elements included: what is never
/// drawn may be ten times what is.
pub(super) const MAX_NODES: u32 = 2_000_000;
/// Most levels, copies included. Reading recurses: a stack of 2 MiB, as
/// threads have, holds more than twice as many, even unoptimised.
pub(super) const MAX_DEPTH: u32 = 96;

/// Why a drawing gives no outline.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SvgError {
    /// More elements or attributes than anything that is drawn has.
    #[error(
        "the drawing has more than {MAX_NODES} elements or attributes; save only what is to be seen"
    )]
    TooManyNodes,
    /// An element with attributes without end: its line, from 1.
    #[error("line {line}: an element has {attributes} attributes; save the drawing as plain SVG")]
    TooManyAttributes {
        /// The line at which it begins.
        line: usize,
        /// How many there are.
        attributes: u64,
    },
    /// Namespaces without end.
    #[error("the drawing declares {0} namespaces over and over; save it as plain SVG")]
    TooManyNamespaces(usize),
    /// Entities that stand for text without end.
    #[error("the drawing's entities stand for too much text; save it without entities")]
    TooMuchText,
    /// An entity that stands for elements: its line, from 1.
    #[error("line {0}: an entity stands for elements; save the drawing without entities")]
    EntityOfElements(usize),
    /// Not well-formed XML.
    #[error("the drawing is not well-formed ({0}); save it again as plain SVG")]
    Xml(#[source] roxmltree::Error),
    /// Not SVG, or without a size.
    #[error("the drawing cannot be read ({0}); save it again as plain SVG")]
    Svg(#[source] usvg::Error),
    /// Elements, copies included, without end: the line, from 1, of that with
    /// which the count went over.
    #[error(
        "line {0}: with all copies (use, patterns, clip paths) the drawing unfolds into more than {MAX_ELEMENTS} elements; expand fewer copies or remove them"
    )]
    TooManyElements(u32),
    /// Elements in elements without end: the line of the deepest, from 1.
    #[error(
        "line {0}: the drawing is nested more than {MAX_DEPTH} levels deep, copies included; ungroup it"
    )]
    TooDeep(u32),
    /// An element that is a copy of itself: its line, from 1.
    #[error("line {0}: an element refers to itself, over others or directly; remove the reference")]
    Circular(u32),
    /// A style sheet that would be matched too often, on so many elements.
    #[error(
        "the drawing's style sheet is too long for its {0} elements; save it with plain attributes"
    )]
    TooMuchStyle(usize),
    /// Nothing visible is filled.
    #[error(
        "nothing in the drawing is filled{}; fill shapes",
        if *strokes { ", there are only strokes, and strokes = false" } else { "" }
    )]
    NothingFilled {
        /// Whether there are strokes.
        strokes: bool,
    },
    /// No element has the id.
    #[error(
        "the drawing has no element with the id \"{id}\"; {}",
        known_ids(known)
    )]
    NoElement {
        /// The id that was asked for.
        id: String,
        /// The first ids that there are.
        known: Vec<String>,
    },
    /// The element is there and draws nothing.
    #[error(
        "the element \"{0}\" draws nothing by itself; choose a shape, a group or a <use>, not what lies in <defs>"
    )]
    NotDrawn(String),
    /// Curves into absurdly many points.
    #[error(transparent)]
    TooManyPoints(#[from] TooManyPoints),
    /// Nothing is enclosed.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

fn known_ids(known: &[String]) -> String {
    match known {
        [] => "it has none; give the element one, or take all of the drawing".to_owned(),
        known => format!("it has {}", known.join(", ")),
    }
}
