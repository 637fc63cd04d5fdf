//! Importer of SVG drawings, based on `usvg`.
//!
//! Produces two results for a drawing. The silhouette is the union of all visible shapes, with
//! strokes if requested; pure white shapes count as paper and erase the shapes below, unless the
//! whole drawing is white. The paint layers keep colours, order and all strokes; a drawing that
//! specifies no colour has no paint layers. Transforms, fill rules, clip paths, dashes, joins and
//! caps are applied. A single element can be selected by its id; clip paths around it still apply.
//!
//! One user unit (after the view box) is one unit, the origin is the lower left corner of the
//! page and y points up. Shapes outside the page are kept. Coordinates pass through `f32`, so
//! outlines are accurate to about 1e-7 of the page.
//!
//! Guarantees that nothing outside the file is loaded except installed fonts, and that a file that
//! would expand into too much text or too many elements is refused before the expansion. Markers,
//! embedded pictures, filters, masks and bitmap glyphs are ignored; patterns and stroke gradients
//! are replaced by their mean colour. Missing fonts are substituted. All of this except markers is
//! reported as notes.

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

/// Maximum number of element ids listed in an error (resource limit: about one line).
const NAMED_IDS: usize = 8;

/// Imports the text of an SVG file, or only the element with the given id.
///
/// `options.tolerance` is the maximum deviation of flattened curves, as a fraction of the page's
/// longer side.
///
/// # Errors
/// Returns an [`SvgError`] if the drawing is malformed, exceeds a limit or is empty.
pub(super) fn read(
    text: &str,
    element: Option<&str>,
    options: &ImportOptions,
) -> Result<ImportedOutlines, SvgError> {
    xml_limits::check_xml_text(text)?;
    let xml = roxmltree::ParsingOptions {
        allow_dtd: true, // drawing programs write a DOCTYPE; `check_xml_text` limits entities
        nodes_limit: error::MAX_NODES,
        ..Default::default()
    };
    let document = roxmltree::Document::parse_with_options(text, xml).map_err(SvgError::Xml)?;
    let has_short_text = expansion_limits::check_expansion(&document)?;
    let top = match element {
        Some(id) => element_of(&document, id)?,
        None => document.root_element(),
    };
    let font_lookup = FontLookup::default();
    let tree = tree_of(&document, has_short_text.then_some(&font_lookup))?;
    let size = painter::page_of(&tree);
    let read_options = SvgReadOptions {
        tolerance: options.tolerance.max(MIN_TOLERANCE) * size.max_element(),
        // The id of the root element selects the whole drawing.
        element: element.filter(|_| top != document.root_element()),
    };
    let painted = painter::paint_tree(&tree, &read_options)?;
    let regions = silhouette::silhouette(&painted, size, options.strokes)?;
    let report = SvgReport {
        painted: &painted,
        strokes: options.strokes,
        absent: has_short_text.then(|| font_lookup.into_absent()),
    };
    let notes = report.notes(top);
    let page = Bounds {
        min: DVec2::ZERO,
        max: size,
    };
    let mut layers = paint_layers::paint_layers(painted.shapes, size);
    if !has_colours::names_a_colour(&document) {
        layers.clear();
    }
    Ok(ImportedOutlines {
        notes,
        extent: match read_options.element {
            Some(_) => regions.bounds(),
            None => page,
        },
        regions,
        paint_layers: layers,
    })
}

/// Finds the first element with the given id.
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

/// Converts a document to a `usvg` tree, in which references and styles are expanded. Text is
/// laid out only if `font_lookup` is given.
fn tree_of(document: &Document, font_lookup: Option<&FontLookup>) -> Result<usvg::Tree, SvgError> {
    let has_text = || {
        document
            .descendants()
            .any(|node| node.tag_name().name() == "text")
    };
    let font_lookup = font_lookup.filter(|_| has_text());
    let options = usvg::Options {
        // Pictures are never loaded, neither linked nor embedded ones.
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        style_sheet: Some(expansion_limits::STYLE.to_owned()),
        font_family: fonts::UNNAMED.to_owned(),
        font_resolver: font_lookup.map(FontLookup::resolver).unwrap_or_default(),
        fontdb: font_lookup.map(|_| fonts::fonts()).unwrap_or_default(),
        ..Default::default()
    };
    usvg::Tree::from_xmltree(document, &options).map_err(SvgError::Svg)
}

#[cfg(test)]
mod tests;
