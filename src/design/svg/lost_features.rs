//! Collects the features of a drawing that were ignored or replaced.

use crate::design::note::ImportNote;
use std::collections::{BTreeMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use usvg::roxmltree::Node as Xml;

/// Maximum number of elements that a note names (resource limit: about one line).
const NAMED_ELEMENTS: usize = 3;

/// Maximum number of features that are named (resource limit: one line each).
const MAX_FEATURES: usize = 64;

/// Feature, and what was done instead of it; `None` if it was ignored.
type FeatureTreatment = (String, Option<&'static str>);

/// Features of a drawing that were ignored or replaced, with the elements that use them.
///
/// There are at most [`MAX_FEATURES`] features; further ones are counted together. Each element
/// counts once for each feature, however often it is copied. Elements are distinguished by their
/// descriptions.
#[derive(Debug, Default)]
pub(super) struct LostFeatures {
    features: BTreeMap<FeatureTreatment, LosingElements>,
}

/// Elements that use a feature.
#[derive(Debug, Default)]
struct LosingElements {
    /// Descriptions of the first elements, each once.
    named: Vec<String>,
    /// Hashes of the descriptions of all elements.
    hashes: HashSet<u64>,
}

impl LostFeatures {
    /// Records that a feature of an element was ignored.
    pub(super) fn ignore(&mut self, feature: &str, element: &str) {
        self.add((feature.to_owned(), None), element);
    }

    /// Records what was done instead of a feature of an element.
    pub(super) fn replace(&mut self, feature: &str, replacement: &'static str, element: &str) {
        self.add((feature.to_owned(), Some(replacement)), element);
    }

    fn add(&mut self, treatment: FeatureTreatment, element: &str) {
        let elements = self.elements_of(treatment);
        let is_new = elements.hashes.insert(hash_of(element));
        if is_new && elements.named.len() < NAMED_ELEMENTS {
            elements.named.push(element.to_owned());
        }
    }

    /// Adds the features of another list.
    pub(super) fn extend(&mut self, other: Self) {
        for (treatment, lost) in other.features {
            let elements = self.elements_of(treatment);
            for name in lost.named {
                if elements.named.len() < NAMED_ELEMENTS && !elements.named.contains(&name) {
                    elements.named.push(name);
                }
            }
            elements.hashes.extend(lost.hashes);
        }
    }

    /// Returns the elements that use a feature. If the list is full, returns those of all features
    /// that are not in it.
    fn elements_of(&mut self, treatment: FeatureTreatment) -> &mut LosingElements {
        let has_room = self.features.len() < MAX_FEATURES;
        let treatment = match has_room || self.features.contains_key(&treatment) {
            true => treatment,
            false => ("other features".to_owned(), None),
        };
        self.features.entry(treatment).or_default()
    }

    /// Returns one note for each feature and replacement.
    pub(super) fn into_notes(self) -> impl Iterator<Item = ImportNote> {
        self.features
            .into_iter()
            .map(
                |((feature, replacement), elements)| ImportNote::LostFeature {
                    feature,
                    replacement: replacement.map(str::to_owned),
                    elements: elements.named,
                    count: elements.hashes.len(),
                },
            )
    }
}

fn hash_of(element: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    element.hash(&mut hasher);
    hasher.finish()
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

#[cfg(test)]
mod tests {
    use super::*;

    fn notes(lost: LostFeatures) -> Vec<(String, Vec<String>, usize)> {
        let fields = |note| match note {
            ImportNote::LostFeature {
                feature,
                elements,
                count,
                ..
            } => (feature, elements, count),
            other => panic!("{other}"),
        };
        lost.into_notes().map(fields).collect()
    }

    fn with_elements(feature: &str, elements: std::ops::Range<usize>) -> LostFeatures {
        let mut lost = LostFeatures::default();
        for element in elements {
            lost.ignore(feature, &format!("#{element}"));
        }
        lost
    }

    #[test]
    fn each_element_counts_once() {
        let mut lost = with_elements("filter", 0..5);
        lost.extend(with_elements("filter", 0..5));
        lost.extend(with_elements("filter", 2..7));
        // Elements beyond those that are named count once as well.
        lost.ignore("filter", "#4");
        let named = ["#0", "#1", "#2"].map(str::to_owned).to_vec();
        assert_eq!(notes(lost), [("filter".to_owned(), named, 7)]);
    }

    #[test]
    fn lists_that_are_put_together_name_a_limited_number_of_features() {
        let mut lost = LostFeatures::default();
        for k in 0..1000 {
            lost.extend(with_elements(&format!("feature {k:04}"), k..k + 2));
        }
        let found = notes(lost);
        assert_eq!(found.len(), MAX_FEATURES + 1);
        let (feature, named, count) = found.last().expect("others");
        assert_eq!((feature.as_str(), named.len()), ("other features", 3));
        assert_eq!(*count, 1001 - MAX_FEATURES);
    }
}
