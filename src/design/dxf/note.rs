//! Notes of the DXF importer: entities that were left out or approximated, and how lines and text
//! were drawn.

use super::error::DxfPlace;
use crate::io::sanitize::SanitizedLine;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// Omission or approximation of a DXF drawing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DxfNote {
    /// Entities that were left out or approximated.
    Entities(DxfEntities),
    /// Curves that do not close were drawn as lines with a width.
    Lines {
        /// Number of curves.
        count: usize,
        /// Smallest and largest width in drawing units.
        widths: [f64; 2],
    },
    /// Number of closed outlines that were drawn as lines, because a fill would hide the lines,
    /// text or fills inside them.
    OutlinesAsLines(usize),
    /// Lines with dashes or symbols were drawn solid.
    SolidLines {
        /// Number of lines.
        count: usize,
        /// Names of the line types.
        types: Vec<String>,
    },
    /// Names of fonts that were replaced by the bundled font.
    Fonts(Vec<String>),
    /// The file uses a code page that is not supported; text beyond ASCII may be wrong.
    CodePage(String),
}

/// Entities of one type that were treated in the same way.
#[derive(Clone, Debug, PartialEq)]
pub struct DxfEntities {
    /// Type name as written in the file.
    pub kind: String,
    /// Number of entities; an entity of a block counts once for each copy of the block.
    pub count: usize,
    /// Treatment and reason, as worded in the message.
    pub what: String,
    /// Position of the first entity in the file.
    pub at: DxfPlace,
    /// Layer of the first entity.
    pub layer: String,
    /// Handle of the first entity; empty if it has none.
    pub handle: String,
}

impl fmt::Display for DxfEntities {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            count, what, at, ..
        } = self;
        let first = if *count == 1 { "" } else { "the first in " };
        let kind = SanitizedLine(&self.kind);
        let layer = SanitizedLine(&self.layer);
        write!(f, "{count} {kind} {what} ({first}{at}, layer {layer}")?;
        if !self.handle.is_empty() {
            write!(f, ", handle {}", SanitizedLine(&self.handle))?;
        }
        f.write_str(")")
    }
}

impl fmt::Display for DxfNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Entities(entities) => entities.fmt(f),
            Self::Lines { count, widths } => {
                let [low, high] = widths.map(|width| format!("{width:.3e}").parse().unwrap_or(width));
                let lines = if *count == 1 { "line" } else { "lines" };
                write!(f, "{count} open {lines} drawn as strokes, {low}")?;
                if high > low {
                    write!(f, " to {high}")?;
                }
                f.write_str(" drawing units wide; close them to fill their area")
            }
            Self::OutlinesAsLines(1) => f.write_str(
                "1 closed outline drawn as a line, because a fill would hide what is drawn inside it",
            ),
            Self::OutlinesAsLines(n) => write!(
                f,
                "{n} closed outlines drawn as lines, because fills would hide what is drawn inside them"
            ),
            Self::SolidLines { count, types } => write!(
                f,
                "{count} {} drawn solid instead of with the line type {}",
                if *count == 1 { "line" } else { "lines" },
                SanitizedLine(types.join(", "))
            ),
            Self::Fonts(names) => write!(
                f,
                "text in {} drawn in the bundled font; convert text to outlines to keep its shape",
                SanitizedLine(names.join(", "))
            ),
            Self::CodePage(name) => write!(
                f,
                "the code page {} is read as Western European; save the drawing as DXF 2007 or later",
                SanitizedLine(name)
            ),
        }
    }
}

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

/// Entities of a drawing of which nothing remains. Displayed as the continuation of an error
/// message.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeftOut(pub Vec<DxfEntities>);

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, entities) in self.0.iter().enumerate() {
            let before = if i == 0 { ": " } else { "; " };
            write!(f, "{before}{entities}")?;
        }
        Ok(())
    }
}
