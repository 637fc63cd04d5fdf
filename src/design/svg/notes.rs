//! Collects the import notes of a drawing: repairs, ignored content and approximations.

use super::fonts::MissingFonts;
use super::painter::PaintedDrawing;
use crate::design::note::ImportNote;
use std::collections::BTreeMap;
use usvg::roxmltree::Node as Xml;

/// Tags of the elements whose content is not drawn where it is defined.
const HIDDEN: [&str; 6] = ["defs", "symbol", "clipPath", "mask", "pattern", "marker"];

/// Maximum number of elements that a note names (resource limit: about one line).
const NAMED_ELEMENTS: usize = 3;

/// Features of a drawing that were ignored or replaced, with the elements that use them.
#[derive(Debug, Default)]
pub(super) struct LostFeatures(BTreeMap<(String, Option<&'static str>), LosingElements>);

/// Elements that use a feature.
#[derive(Debug, Default)]
struct LosingElements {
    /// Descriptions of the first elements, each once.
    named: Vec<String>,
    count: usize,
}

impl LostFeatures {
    /// Records that a feature of an element was ignored.
    pub(super) fn ignore(&mut self, feature: &str, element: &str) {
        self.add(feature, None, element);
    }

    /// Records what was done instead of a feature of an element.
    pub(super) fn replace(&mut self, feature: &str, replacement: &'static str, element: &str) {
        self.add(feature, Some(replacement), element);
    }

    fn add(&mut self, feature: &str, replacement: Option<&'static str>, element: &str) {
        let elements = self.0.entry((feature.to_owned(), replacement)).or_default();
        if elements.named.iter().any(|named| named == element) {
            return; // copies of an element count once
        }
        elements.count += 1;
        if elements.named.len() < NAMED_ELEMENTS {
            elements.named.push(element.to_owned());
        }
    }

    /// Adds the features of another list.
    pub(super) fn extend(&mut self, other: Self) {
        for ((feature, replacement), elements) in other.0 {
            let known = self.0.entry((feature, replacement)).or_default();
            known.count += elements.count;
            let free = NAMED_ELEMENTS.saturating_sub(known.named.len());
            known.named.extend(elements.named.into_iter().take(free));
        }
    }

    fn into_notes(self) -> impl Iterator<Item = ImportNote> {
        self.0.into_iter().map(
            |((feature, replacement), elements)| ImportNote::LostFeature {
                feature,
                replacement: replacement.map(str::to_owned),
                elements: elements.named,
                count: elements.count,
            },
        )
    }
}

/// Returns the description of an element for notes: its id, or its tag and line.
pub(super) fn element_label(node: Xml) -> String {
    match node.attribute("id").filter(|id| !id.is_empty()) {
        Some(id) => format!("#{id}"),
        None => {
            let position = node.document().text_pos_at(node.range().start);
            format!("<{}> in line {}", node.tag_name().name(), position.row)
        }
    }
}

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
