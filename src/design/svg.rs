//! Importer of SVG drawings, based on `usvg`.
//!
//! Produces two results for a drawing. The silhouette is the union of all visible shapes, with
//! strokes if requested; pure white shapes count as paper and erase the shapes below, unless the
//! whole drawing is white. The paint layers keep colours, order, names and all strokes; a drawing
//! that specifies no colour has paint layers without paint if its elements have names.
//!
//! A drawing is read in three steps. [`css`] and [`plain`] resolve style sheets, copies, symbols
//! and everything else that `usvg` does not know into plain attributes. `usvg` resolves references
//! and units, and lays out text. [`painter`] computes the areas of fills, strokes and markers, and
//! applies clip paths, masks, patterns, blend modes and group opacity to them.
//!
//! One user unit (after the view box) is one unit, the origin is the lower left corner of the
//! page and y points up. Shapes are cut at the edge of the page, as in browsers, unless a single
//! element is selected by its id. Coordinates pass through `f32`, so outlines are accurate to about
//! 1e-7 of the page.
//!
//! Guarantees that nothing outside the file is loaded except installed fonts, and that a file that
//! would expand into too much text or too many elements is refused before the expansion. Whatever
//! browsers draw and this importer ignores or approximates is reported as a note with the element.

mod blending;
mod css;
mod error;
mod expansion_limits;
mod flat_areas;
mod fonts;
mod has_colours;
mod ink_layers;
mod lost_features;
mod names;
mod opacity_groups;
mod own_outlines;
mod page_edge;
mod paint_layers;
mod painter;
mod plain;
mod report;
mod resolved_paint;
mod shape;
mod silhouette;
mod stroke;
mod xml_entities;
mod xml_limits;
mod z_order;

pub use error::SvgError;
pub use fonts::{InstalledFont, installed_fonts};
pub(super) use ink_layers::{WindingRings, boolean, union};

use super::flatten::MIN_TOLERANCE;
use super::form::ImportedOutlines;
use super::options::ImportOptions;
use super::text_encoding::{plain_bytes, xml_text};
use crate::geometry::{Bounds, DVec2};
use css::cascade::{StyleCascade, read_sheets};
use css::colours::paint_of_plain;
use fonts::FontLookup;
use lost_features::{LostFeatures, element_label};
use painter::SvgReadOptions;
use plain::{ElementBox, ElementBoxes, PlainDrawing, PlainSources, plain_drawing, source_element};
use report::SvgReport;
use shape::SvgShape;
use std::collections::HashMap;
use std::sync::Mutex;
use usvg::roxmltree::{self, Document, Node as Xml};
use xml_entities::with_expanded_elements;

/// Maximum number of element ids listed in an error (resource limit: about one line).
const NAMED_IDS: usize = 8;

/// Maximum number of times that boxes of elements are measured: the box of a group depends on the
/// transforms of its content (resource limit: each pass reads the drawing).
const MAX_PASSES: usize = 4;

/// Maximum depth of drawings embedded in each other (resource limit: the reader recurses).
const MAX_EMBEDDED: usize = 3;

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
    let text = with_expanded_elements(text)?;
    let document = parse(&text)?;
    let top = match element {
        Some(id) => element_of(&document, id)?,
        None => document.root_element(),
    };
    let font_lookup = FontLookup::default();
    let read_tree = tree_of(&document, &font_lookup, 0)?;
    let (tree, plain, mut lost) = (read_tree.tree, read_tree.plain, read_tree.lost);
    lost.extend(read_tree.embedded);
    let size = painter::page_of(&tree);
    let read_options = SvgReadOptions {
        tolerance: options.tolerance.max(MIN_TOLERANCE) * size.max_element(),
        // The id of the root element selects the whole drawing.
        element: (top != document.root_element()).then(|| top.id()),
        non_scaling: &plain.non_scaling,
        document: &document,
    };
    let page = Bounds {
        min: DVec2::ZERO,
        max: size,
    };
    let mut painted = painter::paint_tree(&tree, &read_options)?;
    own_outlines::attach_outlines(&mut painted.shapes, read_options.tolerance);
    if read_options.element.is_none() {
        page_edge::cut_at_page(&mut painted, size);
        let background = plain.background.as_deref().and_then(paint_of_plain);
        let background = background.map(|paint| SvgShape::rectangle(page, paint));
        painted.shapes.splice(..0, background);
    }
    let regions = silhouette::silhouette(&painted, size, options.strokes)?;
    let report = SvgReport {
        strokes: options.strokes,
        absent: read_tree.has_short_text.then(|| font_lookup.into_absent()),
        lost,
    };
    let notes = report.notes(&mut painted, top);
    let names_a_colour = has_colours::names_a_colour(&document);
    let drawn = painted.shapes.first().map(|shape| shape.paint.colour);
    let layers = match names_a_colour {
        true => paint_layers::paint_layers(painted.shapes, size),
        false => paint_layers::uncoloured_layers(painted.shapes, size),
    };
    let extent = read_options.element.map_or(page, |_| regions.bounds());
    Ok(ImportedOutlines {
        notes,
        extent,
        regions,
        paint_layers: layers,
        drawn_colour: drawn.filter(|_| !names_a_colour),
    })
}

/// Parses the XML of a drawing.
fn parse(text: &str) -> Result<Document<'_>, SvgError> {
    xml_limits::check_xml_text(text)?;
    let xml = roxmltree::ParsingOptions {
        allow_dtd: true, // drawing programs write a DOCTYPE; `check_xml_text` limits entities
        nodes_limit: error::MAX_NODES,
        ..Default::default()
    };
    Document::parse_with_options(text, xml).map_err(SvgError::Xml)
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

/// Drawing in which references and styles are expanded.
struct SvgTree {
    tree: usvg::Tree,
    plain: PlainDrawing,
    lost: LostFeatures,
    /// Whether the text was short enough to be laid out.
    has_short_text: bool,
    /// Features lost in embedded drawings.
    embedded: LostFeatures,
}

/// Converts a document to a `usvg` tree. Very long text is not laid out. `depth` is the number of
/// drawings in which the document is embedded.
fn tree_of(
    document: &Document,
    font_lookup: &FontLookup,
    depth: usize,
) -> Result<SvgTree, SvgError> {
    let mut ids = HashMap::new();
    for node in document.descendants() {
        if let Some(id) = node.attribute("id") {
            ids.entry(id).or_insert(node);
        }
    }
    let mut lost_sheets = LostFeatures::default();
    let sheets = read_sheets(document, &mut lost_sheets);
    let cascade = StyleCascade::new(&sheets);
    let expansion = expansion_limits::check_expansion(document, &ids, &cascade)?;
    let font_lookup = Some(font_lookup).filter(|_| expansion.has_short_text);
    let mut boxes = ElementBoxes::new();
    for pass in 1.. {
        let mut lost = LostFeatures::default();
        let sources = PlainSources {
            document,
            ids: &ids,
            cascade: &cascade,
            broken: &expansion.broken,
            boxes: &boxes,
        };
        let plain = plain_drawing(&sources, &mut lost)?;
        let (tree, embedded) = usvg_tree(&plain, document, font_lookup, depth)?;
        if !plain.lacks_boxes || pass == MAX_PASSES {
            let has_short_text = expansion.has_short_text;
            lost.extend(lost_sheets);
            return Ok(SvgTree {
                tree,
                plain,
                lost,
                has_short_text,
                embedded,
            });
        }
        measure(tree.root(), &mut boxes);
    }
    unreachable!("the last pass returns")
}

/// Records the boxes of all elements in their own coordinates.
fn measure(group: &usvg::Group, boxes: &mut ElementBoxes) {
    for node in group.children() {
        let bounds = |found: usvg::Rect| Bounds {
            min: DVec2::new(found.left().into(), found.top().into()),
            max: DVec2::new(found.right().into(), found.bottom().into()),
        };
        if let Some(id) = source_element(node.id()) {
            let (fill, stroke) = (node.bounding_box(), node.stroke_bounding_box());
            // The group of a picture has the transform of its pixels.
            let pixels = picture_transform(node);
            let [fill, stroke] =
                [fill, stroke].map(|found| found.transform(pixels).unwrap_or(found));
            let (fill, stroke) = (bounds(fill), bounds(stroke));
            boxes.entry(id).or_insert(ElementBox { fill, stroke });
        }
        if let usvg::Node::Group(inner) = node {
            measure(inner, boxes);
        }
    }
}

/// Returns the transform of the pixels of a picture to user units; the identity for other nodes.
fn picture_transform(node: &usvg::Node) -> usvg::Transform {
    match node {
        usvg::Node::Group(group) if matches!(group.children(), [usvg::Node::Image(_)]) => {
            group.transform()
        }
        _ => usvg::Transform::identity(),
    }
}

/// Reads a plain drawing, whose pictures are those of `source`. Returns the tree and the features
/// lost in embedded drawings. Text is laid out only if `font_lookup` is given.
fn usvg_tree(
    plain: &PlainDrawing,
    source: &Document,
    font_lookup: Option<&FontLookup>,
    depth: usize,
) -> Result<(usvg::Tree, LostFeatures), SvgError> {
    let document = Document::parse(&plain.text).map_err(SvgError::Xml)?;
    let has_text = plain.text.contains("<text");
    let text_fonts = font_lookup.filter(|_| has_text);
    let lost = Mutex::new(LostFeatures::default());
    let options = usvg::Options {
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None), // plain drawings contain no data
            resolve_string: Box::new(|id, _| {
                let node = source.get_node(source_element(id)?)?;
                let (image, lost_inside) = embedded_image(node, font_lookup, depth);
                lost.lock().ok()?.extend(lost_inside);
                image
            }),
        },
        font_family: fonts::UNNAMED.to_owned(),
        font_resolver: text_fonts.map(FontLookup::resolver).unwrap_or_default(),
        fontdb: text_fonts.map(|_| fonts::fonts()).unwrap_or_default(),
        ..Default::default()
    };
    let tree = usvg::Tree::from_xmltree(&document, &options).map_err(SvgError::Svg)?;
    drop(options);
    let lost = lost.into_inner().unwrap_or_default();
    Ok((tree, lost))
}

/// Reads the picture or drawing that an image element contains as data. Also returns the features
/// that are lost in it; if it cannot be read, that is the image itself.
fn embedded_image(
    node: Xml,
    font_lookup: Option<&FontLookup>,
    depth: usize,
) -> (Option<usvg::ImageKind>, LostFeatures) {
    let url = plain::href(node).and_then(|href| data_url::DataUrl::process(href.trim()).ok());
    let data = url.and_then(|url| url.decode_to_vec().ok());
    let data = data.map(|(data, _)| data).unwrap_or_default();
    if image::guess_format(&data).is_ok() {
        // The painter recognises the format.
        let picture = usvg::ImageKind::PNG(data.into());
        return (Some(picture), LostFeatures::default());
    }
    let drawing = font_lookup.and_then(|lookup| embedded_drawing(&data, lookup, depth));
    match drawing {
        Some((tree, lost)) => (Some(usvg::ImageKind::SVG(tree)), lost),
        None => {
            let mut lost = LostFeatures::default();
            lost.ignore("embedded image that cannot be read", &element_label(node));
            (None, lost)
        }
    }
}

/// Reads a drawing that is embedded as data. Returns `None` for drawings that cannot be read.
fn embedded_drawing(
    data: &[u8],
    font_lookup: &FontLookup,
    depth: usize,
) -> Option<(usvg::Tree, LostFeatures)> {
    if depth == MAX_EMBEDDED {
        return None;
    }
    let plain = plain_bytes(data);
    let decoded = xml_text(&plain).ok()?;
    let text = with_expanded_elements(&decoded.text).ok()?;
    let document = parse(&text).ok()?;
    let inner = tree_of(&document, font_lookup, depth + 1).ok()?;
    let mut lost = inner.lost;
    lost.extend(inner.embedded);
    let plain = inner.plain;
    let unknown = [
        ("background-color", plain.background.is_some()),
        (
            "vector-effect non-scaling-stroke",
            !plain.non_scaling.is_empty(),
        ),
    ];
    for (feature, _) in unknown.iter().filter(|(_, is_used)| *is_used) {
        lost.ignore(feature, "<svg> of an embedded drawing");
    }
    Some((inner.tree, lost))
}

#[cfg(test)]
mod tests;
