//! Collects the notes of the DXF importer.

use crate::design::note::{DxfEntities, DxfNote, DxfPlace, LeftOut};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// Remark on one entity.
#[derive(Clone, Debug)]
pub(super) struct EntityRemark {
    /// Type name as written in the file.
    pub kind: String,
    /// Treatment and reason.
    pub what: Cow<'static, str>,
    /// Position in the file.
    pub at: DxfPlace,
    /// Handle; empty if the entity has none.
    pub handle: String,
}

/// Maximum number of different remarks (resource limit: a hostile file could give every entity a
/// new type).
const MAX_REMARKS: usize = 50;

/// Remarks on all entities of a drawing, grouped by type and treatment.
#[derive(Debug, Default)]
pub(super) struct EntityReport {
    entities: BTreeMap<(String, String), DxfEntities>,
    fonts: BTreeSet<String>,
}

impl EntityReport {
    /// Adds a remark on an entity on the given layer.
    pub fn add(&mut self, remark: &EntityRemark, layer: &str) {
        let mut key = (remark.kind.clone(), remark.what.clone().into_owned());
        if self.entities.len() >= MAX_REMARKS && !self.entities.contains_key(&key) {
            key = ("other entities".into(), "left out or approximated".into());
        }
        let first = || DxfEntities {
            kind: key.0.clone(),
            count: 0,
            what: key.1.clone(),
            at: remark.at,
            layer: layer.to_owned(),
            handle: remark.handle.clone(),
        };
        self.entities.entry(key.clone()).or_insert_with(first).count += 1;
    }

    /// Removes the remarks on entities of a type that turned out to be treated exactly.
    pub fn remove(&mut self, kind: &str, what: &str) {
        self.entities.remove(&(kind.to_owned(), what.to_owned()));
    }

    /// Adds the name of a font that was replaced by the bundled font.
    pub fn add_font(&mut self, name: &str) {
        if self.fonts.len() < MAX_REMARKS {
            self.fonts.insert(name.to_owned());
        }
    }

    /// Returns the notes on all entities.
    pub fn into_notes(self) -> impl Iterator<Item = DxfNote> {
        let fonts = (!self.fonts.is_empty()).then_some(self.fonts);
        let fonts = fonts.map(|names| DxfNote::Fonts(names.into_iter().collect()));
        let entities = self.entities.into_values().map(DxfNote::Entities);
        entities.chain(fonts)
    }

    /// Returns the remarks as the content of an error.
    pub fn into_left_out(self) -> LeftOut {
        LeftOut(self.entities.into_values().collect())
    }
}
