//! What is told of a drawing: what was repaired, and what is not shown as it was
//! drawn.

use super::fonts::MissingFonts;
use super::painter::PaintedDrawing;
use crate::design::note::ImportNote;
use usvg::roxmltree::Node as Xml;

/// Elements in which nothing is drawn.
const HIDDEN: [&str; 6] = ["defs", "symbol", "clipPath", "mask", "pattern", "marker"];

/// What there is to tell of a drawing.
pub(super) struct SvgReport<'p> {
    pub painted: &'p PaintedDrawing,
    /// Whether strokes are in the figure.
    pub strokes: bool,
    /// What the machine does not have of what the text asks for; none if the text is
    /// left out.
    pub absent: Option<MissingFonts>,
}

impl SvgReport<'_> {
    /// The notes of what was painted from an element and all in it.
    pub(super) fn notes(self, top: Xml) -> Vec<ImportNote> {
        let repairs = self.painted.repairs.iter();
        let repairs = repairs.flat_map(|(rule, found)| ImportNote::of_repairs(found, *rule));
        let bare = if self.strokes {
            0
        } else {
            self.painted.bare_strokes
        };
        let left_out = &self.painted.left_out;
        let texts = self
            .absent
            .as_ref()
            .map_or_else(|| elements(top, "text"), |_| 0);
        let absent = self.absent.unwrap_or_default();
        let characters = left_out.glyphs + absent.characters.len();
        let counted = [
            noted(bare, ImportNote::Strokes),
            noted(texts, ImportNote::Texts),
            noted(characters, ImportNote::Characters),
            noted(elements(top, "image"), ImportNote::Pictures),
            noted(left_out.shades, ImportNote::Shades),
            noted(left_out.masks, ImportNote::Masks),
            noted(filtered(top), ImportNote::Filters),
            noted(left_out.blends, ImportNote::Blends),
        ];
        let told = counted.into_iter().filter(|&(count, _)| count > 0);
        let fonts = absent.fonts.into_iter().map(ImportNote::Font);
        repairs
            .chain(fonts)
            .chain(told.map(|(_, note)| note))
            .collect()
    }
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
