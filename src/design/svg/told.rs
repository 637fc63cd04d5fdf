//! What is told of a drawing: what was repaired, and what is not shown as it was
//! drawn.

use super::paint::Painted;
use crate::design::note::ImportNote;
use usvg::roxmltree::Node as Xml;

/// Elements in which nothing is drawn.
const HIDDEN: [&str; 6] = ["defs", "symbol", "clipPath", "mask", "pattern", "marker"];

/// The notes of what was painted from an element and all in it; with its strokes
/// in the figure or without.
pub(super) fn notes(painted: &Painted, top: Xml, strokes: bool) -> Vec<ImportNote> {
    let repairs = painted.repairs.iter();
    let repairs = repairs.flat_map(|(rule, found)| ImportNote::of_repairs(found, *rule));
    let bare = if strokes { 0 } else { painted.bare_strokes };
    let left_out = &painted.left_out;
    let counted = [
        noted(bare, ImportNote::Strokes),
        noted(elements(top, "text"), ImportNote::Texts),
        noted(elements(top, "image"), ImportNote::Pictures),
        noted(left_out.shades, ImportNote::Shades),
        noted(left_out.masks, ImportNote::Masks),
        noted(filtered(top), ImportNote::Filters),
        noted(left_out.blends, ImportNote::Blends),
    ];
    let told = counted.into_iter().filter(|&(count, _)| count > 0);
    repairs.chain(told.map(|(_, note)| note)).collect()
}

fn noted(count: usize, note: fn(usize) -> ImportNote) -> (usize, ImportNote) {
    (count, note(count))
}

fn elements(top: Xml, name: &str) -> usize {
    let nodes = drawn(top);
    nodes.filter(|node| node.tag_name().name() == name).count()
}

fn filtered(top: Xml) -> usize {
    drawn(top)
        .filter(|node| node.has_attribute("filter"))
        .count()
}

/// What is drawn where it stands.
fn drawn<'d, 'a: 'd>(top: Xml<'d, 'a>) -> impl Iterator<Item = Xml<'d, 'a>> {
    let is_hidden = |node: Xml| HIDDEN.contains(&node.tag_name().name());
    let nodes = top.descendants();
    nodes.filter(move |node| !node.ancestors().any(is_hidden))
}
