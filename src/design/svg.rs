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
//! unfold into too much text or too many elements is refused before it is
//! unfolded.
//!
//! It is read twice: as the figure that it makes, in which strokes count unless
//! they are not wanted, and as coats of paint, with all strokes; both with their
//! dashes, joins and ends. A drawing that names no colour has no coats.
//! Of a drawing one element may be asked for by its id: what lies in it, cut by
//! the clip paths around it, where it stands on the page.
//!
//! Text is drawn with the fonts of the machine, or the bundled one where it has none.
//! Not read: markers, embedded pictures, filters, masks, letters that are pictures; of
//! patterns and strokes with gradients the mean colour is. What was left out is told.
//! Coordinates pass through `f32`, so that outlines are good to about 1e-7 of the page.

mod error;
mod expansion_limits;
mod fonts;
mod has_colours;
mod ink_layers;
mod notes;
mod opacity_groups;
mod paint_layers;
mod painter;
mod resolved_paint;
mod shape;
mod silhouette;
mod stroke;
mod xml_limits;
mod z_order;

pub use error::SvgError;

use super::flatten::MIN_TOLERANCE;
use super::form::ImportedOutlines;
use super::options::ImportOptions;
use crate::geometry::{Bounds, DVec2};
use fonts::FontLookup;
use notes::SvgReport;
use painter::SvgReadOptions;
use usvg::roxmltree::{self, Document, Node as Xml};

/// Ids that an error names: about a line of them.
const NAMED_IDS: usize = 8;

/// Reads the text of an SVG file: all of it, or the element with an id. The
/// tolerance is a fraction of the page's longer side.
pub(super) fn read(
    text: &str,
    element: Option<&str>,
    options: &ImportOptions,
) -> Result<ImportedOutlines, SvgError> {
    xml_limits::check_xml_text(text)?;
    let xml = roxmltree::ParsingOptions {
        allow_dtd: true, // drawing programs write a DOCTYPE; entities were counted
        nodes_limit: error::MAX_NODES,
        ..Default::default()
    };
    let document = roxmltree::Document::parse_with_options(text, xml).map_err(SvgError::Xml)?;
    let is_lettered = expansion_limits::check_expansion(&document)?;
    let top = match element {
        Some(id) => element_of(&document, id)?,
        None => document.root_element(),
    };
    let letters = FontLookup::default();
    let tree = tree_of(&document, is_lettered.then_some(&letters))?;
    let size = painter::page_of(&tree);
    let brush = SvgReadOptions {
        tolerance: options.tolerance.max(MIN_TOLERANCE) * size.max_element(),
        // The root asked for by its id is all of the drawing.
        element: element.filter(|_| top != document.root_element()),
    };
    let painted = painter::painted(&tree, &brush)?;
    let regions = silhouette::silhouette(&painted, size, options.strokes)?;
    let told = SvgReport {
        painted: &painted,
        strokes: options.strokes,
        absent: is_lettered.then(|| letters.into_absent()),
    };
    let notes = told.notes(top);
    let page = Bounds {
        min: DVec2::ZERO,
        max: size,
    };
    let mut coats = paint_layers::paint_layers(painted.shapes, size);
    if !has_colours::names_a_colour(&document) {
        coats.clear();
    }
    Ok(ImportedOutlines {
        notes,
        extent: match brush.element {
            Some(_) => regions.bounds(),
            None => page,
        },
        regions,
        coats,
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

/// Unfolds a drawing; text only with letters.
fn tree_of(document: &Document, letters: Option<&FontLookup>) -> Result<usvg::Tree, SvgError> {
    let has_text = || {
        document
            .descendants()
            .any(|node| node.tag_name().name() == "text")
    };
    let letters = letters.filter(|_| has_text());
    let options = usvg::Options {
        // Nothing outside the file is opened, and what is embedded fills nothing.
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        style_sheet: Some(expansion_limits::STYLE.to_owned()),
        font_family: fonts::UNNAMED.to_owned(),
        font_resolver: letters.map(FontLookup::resolver).unwrap_or_default(),
        fontdb: letters.map(|_| fonts::fonts()).unwrap_or_default(),
        ..Default::default()
    };
    usvg::Tree::from_xmltree(document, &options).map_err(SvgError::Svg)
}

#[cfg(test)]
mod tests;
