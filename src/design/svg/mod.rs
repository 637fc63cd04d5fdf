//! SVG drawings as regions, through `usvg`.
//!
//! All that is filled and visible counts, with its transforms, fill rules and
//! clip paths; curves become polygons within a stated tolerance. Shapes of
//! pure white are paper where anything else is filled: they take away what
//! lies under them, as they do for the eye. If all shapes are white they are
//! the figure.
//!
//! One user unit after the view box is applied is one unit; the page's lower
//! left corner is the origin and y points up. Shapes that leave the page are
//! kept.
//!
//! Guaranteed: nothing is loaded from outside the file, and a file that would
//! unfold into too many elements is refused before it is unfolded.
//!
//! Strokes count where they are asked for, with their dashes, joins and ends.
//! Of a drawing one element may be asked for by its id: what lies in it, cut by
//! the clip paths around it, where it stands on the page.
//!
//! Not read: markers, text (convert it to paths), embedded pictures, filters,
//! translucency short of invisible. Masks are refused. What was left out is
//! told. Coordinates pass
//! through `f32`, so that outlines are good to about 1e-7 of the page.

mod guard;
mod paint;

use super::flatten::TooManyPoints;
use super::{ImportNote, ImportOptions, Outlines};
use crate::geometry::{Bounds, DVec2, RegionsError};
use usvg::roxmltree::{self, Document, Node as Xml};

/// Why a drawing gives no outline.
#[derive(Debug, thiserror::Error)]
pub enum SvgError {
    /// Not well-formed XML.
    #[error("the drawing is not well-formed ({0}); save it again as plain SVG")]
    Xml(#[source] roxmltree::Error),
    /// Not SVG, or without a size.
    #[error("the drawing cannot be read ({0}); save it again as plain SVG")]
    Svg(#[source] usvg::Error),
    /// More bytes than a drawing should have.
    #[error(
        "the drawing has {} MiB of text, more than the {} MiB that are read; simplify its paths",
        bytes >> 20,
        guard::MAX_BYTES >> 20
    )]
    TooLarge {
        /// Its size.
        bytes: usize,
    },
    /// Elements, copies included, without end.
    #[error(
        "line {line}: with all copies (use, patterns, clip paths) the drawing unfolds into more than {} elements; expand fewer copies or remove them",
        guard::MAX_ELEMENTS
    )]
    TooManyElements {
        /// Where the element stands with which the count went over, from 1.
        line: u32,
    },
    /// Elements in elements without end.
    #[error(
        "line {line}: the drawing is nested more than {} levels deep, copies included; ungroup it",
        guard::MAX_DEPTH
    )]
    TooDeep {
        /// Where the deepest element stands, from 1.
        line: u32,
    },
    /// An element that is a copy of itself.
    #[error(
        "line {line}: an element refers to itself, over others or directly; remove the reference"
    )]
    Circular {
        /// Where the element stands, from 1.
        line: u32,
    },
    /// A style sheet that would be matched too often.
    #[error(
        "the drawing's style sheet is too long for its {elements} elements; save it with plain attributes"
    )]
    TooMuchStyle {
        /// How many elements there are.
        elements: usize,
    },
    /// A mask, which has no outline.
    #[error(
        "the drawing uses the mask \"{0}\", which has no outline; apply it as a clip path, or remove it"
    )]
    Mask(String),
    /// Nothing visible is filled.
    #[error(
        "nothing in the drawing is filled{}; fill shapes, and convert text to paths",
        if *strokes { ", there are only strokes (set strokes = true to read them as shapes)" } else { "" }
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

/// Smallest tolerance that is worked with, as a fraction of the page: that of
/// the `f32` coordinates.
const MIN_TOLERANCE: f64 = 1e-7;

/// Ids that an error names.
const NAMED_IDS: usize = 8;

fn known_ids(known: &[String]) -> String {
    match known {
        [] => "it has none; give the element one, or take all of the drawing".to_owned(),
        known => format!("it has {}", known.join(", ")),
    }
}

/// What of a drawing is read, and how.
struct Brush<'o> {
    /// In units of the page.
    tolerance: f64,
    strokes: bool,
    element: Option<&'o str>,
}

/// Reads the text of an SVG file: all of it, or the element with an id. The
/// tolerance is a fraction of the page's longer side.
pub(super) fn read(
    text: &str,
    element: Option<&str>,
    options: &ImportOptions,
) -> Result<Outlines, SvgError> {
    if text.len() > guard::MAX_BYTES {
        return Err(SvgError::TooLarge { bytes: text.len() });
    }
    let xml = roxmltree::ParsingOptions {
        allow_dtd: true, // drawing programs write a DOCTYPE; entities are limited
        nodes_limit: guard::MAX_NODES,
        ..Default::default()
    };
    let document = roxmltree::Document::parse_with_options(text, xml).map_err(SvgError::Xml)?;
    guard::check(&document)?;
    let top = match element {
        Some(id) => element_of(&document, id)?,
        None => document.root_element(),
    };
    let tree = tree_of(&document)?;
    let size = DVec2::new(tree.size().width().into(), tree.size().height().into());
    let brush = Brush {
        tolerance: options.tolerance.max(MIN_TOLERANCE) * size.max_element(),
        strokes: options.strokes,
        element: element.filter(|_| top != document.root_element()),
    };
    let painted = paint::painted(&tree, &brush)?;
    let page = Bounds {
        min: DVec2::ZERO,
        max: size,
    };
    Ok(Outlines {
        notes: notes(&painted, top),
        extent: match brush.element {
            Some(_) => painted.regions.bounds(),
            None => page,
        },
        regions: painted.regions,
    })
}

fn element_of<'d, 'a>(document: &'d Document<'a>, id: &str) -> Result<Xml<'d, 'a>, SvgError> {
    let ids = || {
        document
            .descendants()
            .filter_map(|node| node.attribute("id"))
    };
    document
        .descendants()
        .find(|node| node.attribute("id") == Some(id))
        .ok_or_else(|| SvgError::NoElement {
            id: id.to_owned(),
            known: ids().take(NAMED_IDS).map(str::to_owned).collect(),
        })
}

fn notes(painted: &paint::Painted, top: Xml) -> Vec<ImportNote> {
    let repairs = painted.repairs.iter();
    let mut notes: Vec<_> = repairs
        .flat_map(|(rule, found)| ImportNote::of_repairs(found, *rule))
        .collect();
    let named = |name: &str| {
        let is_drawn = |node: &Xml| {
            let hidden = ["defs", "symbol", "clipPath", "mask", "pattern", "marker"];
            !node
                .ancestors()
                .any(|n| hidden.contains(&n.tag_name().name()))
        };
        let nodes = top.descendants().filter(|n| n.tag_name().name() == name);
        nodes.filter(is_drawn).count()
    };
    let left_out = [
        (
            painted.strokes_left_out,
            ImportNote::Strokes as fn(usize) -> ImportNote,
        ),
        (named("text"), ImportNote::Texts),
        (named("image"), ImportNote::Pictures),
    ];
    let left_out = left_out.into_iter().filter(|&(count, _)| count > 0);
    notes.extend(left_out.map(|(count, note)| note(count)));
    notes
}

fn tree_of(document: &Document) -> Result<usvg::Tree, SvgError> {
    let options = usvg::Options {
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        style_sheet: Some(guard::STYLE.to_owned()),
        ..Default::default()
    };
    usvg::Tree::from_xmltree(document, &options).map_err(SvgError::Svg)
}

#[cfg(test)]
mod tests;
