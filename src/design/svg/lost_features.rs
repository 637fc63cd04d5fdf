//! Collects the features of a drawing that were ignored or replaced.

use crate::design::note::ImportNote;
use std::collections::BTreeMap;
use usvg::roxmltree::Node as Xml;

/// Maximum number of elements that a note names (resource limit: about one line).
const NAMED_ELEMENTS: usize = 3;

/// Maximum number of features that are named (resource limit: one line each).
const MAX_FEATURES: usize = 64;

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
        let key = (feature.to_owned(), replacement);
        let is_known = self.0.contains_key(&key);
        let key = match is_known || self.0.len() < MAX_FEATURES {
            true => key,
            false => ("other features".to_owned(), None),
        };
        let elements = self.0.entry(key).or_default();
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

    /// Returns one note for each feature and replacement.
    pub(super) fn into_notes(self) -> impl Iterator<Item = ImportNote> {
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
