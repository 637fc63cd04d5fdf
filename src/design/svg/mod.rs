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
//! Not read: strokes, markers, text (convert it to paths), embedded pictures, filters,
//! translucency short of invisible. Masks are refused. Coordinates pass
//! through `f32`, so that outlines are good to about 1e-7 of the page.

mod guard;
mod paint;

use super::flatten::TooManyPoints;
use crate::geometry::{Bounds, DVec2, Regions, RegionsError};
use usvg::roxmltree;

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
        "nothing in the drawing is filled{}; fill shapes, and convert strokes and text to paths",
        if *strokes { ", there are only strokes" } else { "" }
    )]
    NothingFilled {
        /// Whether there are strokes.
        strokes: bool,
    },
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

/// Reads the text of an SVG file. `tolerance` is a fraction of the page's
/// longer side.
pub(super) fn read(text: &str, tolerance: f64) -> Result<(Regions, Bounds), SvgError> {
    let tree = parse(text)?;
    let size = DVec2::new(tree.size().width().into(), tree.size().height().into());
    let page = Bounds {
        min: DVec2::ZERO,
        max: size,
    };
    let tolerance = tolerance.max(MIN_TOLERANCE) * size.max_element();
    let regions = paint::regions(&tree, tolerance)?;
    Ok((regions, page))
}

fn parse(text: &str) -> Result<usvg::Tree, SvgError> {
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
    let options = usvg::Options {
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        style_sheet: Some(guard::STYLE.to_owned()),
        ..Default::default()
    };
    usvg::Tree::from_xmltree(&document, &options).map_err(SvgError::Svg)
}

#[cfg(test)]
mod tests;
