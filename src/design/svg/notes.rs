//! Collects the import notes of a drawing: repairs, ignored content and approximations.

use super::fonts::MissingFonts;
use super::painter::PaintedDrawing;
use crate::design::note::ImportNote;
use usvg::roxmltree::Node as Xml;

/// Tags of the elements whose content is not drawn where it is defined.
const HIDDEN: [&str; 6] = ["defs", "symbol", "clipPath", "mask", "pattern", "marker"];

/// Data from which the notes of a drawing are made.
pub(super) struct SvgReport<'p> {
    /// Shapes of the drawing with the counts of repairs and omissions.
    pub painted: &'p PaintedDrawing,
    /// Whether the import option `strokes` is set: strokes are part of the silhouette.
    pub strokes: bool,
    /// Missing fonts and characters; `None` if the text was not laid out.
    pub absent: Option<MissingFonts>,
}

impl SvgReport<'_> {
    /// Returns the notes on the imported element `top` and its descendants.
    pub(super) fn notes(self, top: Xml) -> Vec<ImportNote> {
        let repairs = self.painted.repairs.iter();
        let repairs = repairs.flat_map(|(rule, found)| ImportNote::from_repairs(found, *rule));
        let ignored_strokes = if self.strokes {
            0
        } else {
            self.painted.bare_strokes
        };
        let left_out = &self.painted.approximations;
        let texts = self
            .absent
            .as_ref()
            .map_or_else(|| count_elements(top, "text"), |_| 0);
        let absent = self.absent.unwrap_or_default();
        let characters = left_out.glyphs + absent.characters.len();
        let counted = [
            counted_note(ignored_strokes, ImportNote::Strokes),
            counted_note(texts, ImportNote::Texts),
            counted_note(characters, ImportNote::Characters),
            counted_note(count_elements(top, "image"), ImportNote::Pictures),
            counted_note(left_out.shades, ImportNote::MeanColours),
            counted_note(left_out.masks, ImportNote::Masks),
            counted_note(count_filtered(top), ImportNote::Filters),
            counted_note(left_out.blends, ImportNote::GroupBlending),
        ];
        let nonzero = counted.into_iter().filter(|&(count, _)| count > 0);
        let fonts = absent.fonts.into_iter().map(ImportNote::Font);
        repairs
            .chain(fonts)
            .chain(nonzero.map(|(_, note)| note))
            .collect()
    }
}

/// Returns a count together with the note that reports it.
fn counted_note(count: usize, note: fn(usize) -> ImportNote) -> (usize, ImportNote) {
    (count, note(count))
}

/// Returns the number of drawn elements with the tag `name`.
fn count_elements(top: Xml, name: &str) -> usize {
    let nodes = drawn_elements(top);
    nodes.filter(|node| node.tag_name().name() == name).count()
}

/// Returns the number of drawn elements with a filter.
fn count_filtered(top: Xml) -> usize {
    drawn_elements(top)
        .filter(|node| node.has_attribute("filter"))
        .count()
}

/// Returns `top` and all its descendants that are drawn where they are defined.
fn drawn_elements<'d, 'a: 'd>(top: Xml<'d, 'a>) -> impl Iterator<Item = Xml<'d, 'a>> {
    let is_hidden = |node: Xml| HIDDEN.contains(&node.tag_name().name());
    let nodes = top.descendants();
    nodes.filter(move |node| !node.ancestors().any(is_hidden))
}
