//! Notes on DXF drawings: entities that were left out or approximated, and how lines and text were
//! drawn.

use crate::io::sanitize::SanitizedLine;
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
    /// Closed outlines were filled, which DXF programs draw as lines.
    FilledOutlines {
        /// Number of outlines.
        count: usize,
        /// Layer of the first outline.
        layer: String,
    },
    /// Number of closed outlines that were drawn as lines, because a fill would hide the lines,
    /// text or fills inside them.
    OutlinesAsLines(usize),
    /// Closed outlines were left out because equal outlines on other layers, or of other colours,
    /// that are drawn later hide them.
    HiddenOutlines {
        /// Number of outlines.
        count: usize,
        /// Layer of the first outline.
        below: String,
        /// Layer of the outline that hides it.
        above: String,
    },
    /// Number of fills, lines and texts that fills drawn later hide.
    Covered(usize),
    /// Some fills are stacked by containment instead of in the order of drawing, because too many
    /// overlap.
    OrderIgnored,
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
            Self::Lines { count, widths } => write_lines(f, *count, *widths),
            Self::FilledOutlines { count, layer } => write_filled_outlines(f, *count, layer),
            Self::OutlinesAsLines(1) => f.write_str(
                "1 closed outline drawn as a line, because a fill would hide what is drawn inside it",
            ),
            Self::OutlinesAsLines(n) => write!(
                f,
                "{n} closed outlines drawn as lines, because fills would hide what is drawn inside them"
            ),
            Self::HiddenOutlines {
                count,
                below,
                above,
            } => write!(
                f,
                "{count} closed {} hidden by equal ones drawn later, such as on layer {} by one on layer {}",
                if *count == 1 { "outline" } else { "outlines" },
                SanitizedLine(below),
                SanitizedLine(above)
            ),
            Self::Covered(1) => f.write_str("1 fill, line or text hidden by fills drawn later"),
            Self::Covered(n) => write!(f, "{n} fills, lines or texts hidden by fills drawn later"),
            Self::OrderIgnored => f.write_str(
                "too many fills overlap to draw all in their order; small ones lie on large ones",
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

fn write_lines(f: &mut fmt::Formatter<'_>, count: usize, widths: [f64; 2]) -> fmt::Result {
    let [low, high] = widths.map(|width| format!("{width:.3e}").parse().unwrap_or(width));
    let lines = if count == 1 { "line" } else { "lines" };
    write!(f, "{count} open {lines} drawn as strokes, {low}")?;
    if high > low {
        write!(f, " to {high}")?;
    }
    f.write_str(" drawing units wide; close them to fill their area")
}

fn write_filled_outlines(f: &mut fmt::Formatter<'_>, count: usize, layer: &str) -> fmt::Result {
    let layer = SanitizedLine(layer);
    match count {
        1 => write!(
            f,
            "1 closed outline on layer {layer} filled; DXF programs draw it as a line"
        ),
        count => write!(
            f,
            "{count} closed outlines filled, the first on layer {layer}; DXF programs draw them as lines"
        ),
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

/// Position in a DXF file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DxfPlace {
    /// Line of a text file, counted from 1.
    Line(usize),
    /// Byte offset in a binary file, counted from 0.
    Byte(usize),
}

impl fmt::Display for DxfPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}
