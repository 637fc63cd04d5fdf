//! Makes the import notes of a drawing: repairs, ignored content and approximations.

use super::fonts::MissingFonts;
use super::lost_features::LostFeatures;
use super::painter::PaintedDrawing;
use crate::design::note::ImportNote;
use usvg::roxmltree::Node as Xml;

/// Tags of the elements whose content is not drawn where it is defined.
const HIDDEN: [&str; 6] = ["defs", "symbol", "clipPath", "mask", "pattern", "marker"];

/// Data from which the notes of a drawing are made.
pub(super) struct SvgReport {
    /// Whether the import option `strokes` is set: strokes are part of the silhouette.
    pub strokes: bool,
    /// Missing fonts and characters; `None` if the text was not laid out.
    pub absent: Option<MissingFonts>,
    /// Features lost before the drawing was painted.
    pub lost: LostFeatures,
}

impl SvgReport {
    /// Returns the notes on the imported element `top` and its descendants. Takes the record of
    /// lost features from `painted`.
    pub(super) fn notes(mut self, painted: &mut PaintedDrawing, top: Xml) -> Vec<ImportNote> {
        let repairs = painted.repairs.iter();
        let repairs = repairs.flat_map(|(rule, found)| ImportNote::from_repairs(found, *rule));
        let ignored_strokes = if self.strokes {
            0
        } else {
            painted.bare_strokes
        };
        let texts = self
            .absent
            .as_ref()
            .map_or_else(|| count_elements(top, "text"), |_| 0);
        let absent = self.absent.unwrap_or_default();
        let characters = painted.bitmap_glyphs + absent.characters.len();
        let counted = [
            counted_note(ignored_strokes, ImportNote::Strokes),
            counted_note(texts, ImportNote::Texts),
            counted_note(characters, ImportNote::Characters),
            counted_note(absent.replaced.len(), ImportNote::ReplacedCharacters),
        ];
        self.lost.extend(std::mem::take(&mut painted.lost));
        let nonzero = counted.into_iter().filter(|&(count, _)| count > 0);
        let fonts = absent.fonts.into_iter().map(ImportNote::Font);
        repairs
            .chain(fonts)
            .chain(nonzero.map(|(_, note)| note))
            .chain(self.lost.into_notes())
            .collect()
    }
}

/// Returns a count together with the note that reports it.
fn counted_note(count: usize, note: fn(usize) -> ImportNote) -> (usize, ImportNote) {
    (count, note(count))
}

/// Returns the number of drawn elements with the tag `name`.
fn count_elements(top: Xml, name: &str) -> usize {
    let nodes = top.descendants();
    let is_hidden = |node: Xml| HIDDEN.contains(&node.tag_name().name());
    let drawn = nodes.filter(move |node| !node.ancestors().any(is_hidden));
    drawn.filter(|node| node.tag_name().name() == name).count()
}
