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
//! Strokes count where they are asked for, with their dashes, joins and ends.
//! Of a drawing one element may be asked for by its id: what lies in it, cut by
//! the clip paths around it, where it stands on the page.
//!
//! Not read: markers, text (convert it to paths), embedded pictures, filters,
//! translucency short of invisible. Masks are refused. What was left out is
//! told. Coordinates pass
//! through `f32`, so that outlines are good to about 1e-7 of the page.

mod error;
mod guard;
mod layers;
mod paint;
mod text;

pub use error::SvgError;

use super::flatten::MIN_TOLERANCE;
use super::form::Outlines;
use super::note::ImportNote;
use super::options::ImportOptions;
use crate::geometry::{Bounds, DVec2};
use paint::Brush;
use usvg::roxmltree::{self, Document, Node as Xml};

/// Ids that an error names: about a line of them.
const NAMED_IDS: usize = 8;

/// Reads the text of an SVG file: all of it, or the element with an id. The
/// tolerance is a fraction of the page's longer side.
pub(super) fn read(
    text: &str,
    element: Option<&str>,
    options: &ImportOptions,
) -> Result<Outlines, SvgError> {
    text::check(text)?;
    let xml = roxmltree::ParsingOptions {
        allow_dtd: true, // drawing programs write a DOCTYPE; entities were counted
        nodes_limit: error::MAX_NODES,
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
        // The root asked for by its id is all of the drawing.
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
        // Nothing outside the file is opened, and what is embedded fills nothing.
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
