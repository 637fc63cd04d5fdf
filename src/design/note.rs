//! Import notes: repairs, omissions and approximations made while a design was read,
//! with one sentence of plain text for each.

mod dxf;

pub use dxf::{DxfEntities, DxfNote, DxfPlace, LeftOut};

use super::options::PictureReading;
use crate::geometry::{FillRule, Repairs};
use crate::io::sanitize::SanitizedLine;
use std::collections::BTreeMap;
use std::fmt;

/// Repair, omission or approximation that the user should know about.
///
/// A note is not an error: the design is usable. A clean file has no notes.
///
/// ```
/// use morphospace::design::ImportNote;
/// let note = ImportNote::Strokes(2);
/// assert!(note.to_string().starts_with("2 strokes were ignored"));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ImportNote {
    /// Edges crossed each other.
    Crossings {
        /// Number of pairs of edges that crossed.
        count: usize,
        /// Whether `count` is only a lower bound.
        at_least: bool,
        /// Fill rule that decided what is inside.
        rule: FillRule,
    },
    /// Corners lay on another edge.
    Touches {
        /// Number of corners that lay on another edge.
        count: usize,
        /// Whether `count` is only a lower bound.
        at_least: bool,
    },
    /// Number of ignored outlines that duplicate another outline.
    Duplicates(usize),
    /// Number of ignored outlines that enclose no area.
    EmptyOutlines(usize),
    /// Number of ignored slivers: tiny areas that the repair of outlines leaves where edges touch
    /// or almost touch.
    Slivers(usize),
    /// Number of removed points that repeat the previous point or lie on a straight line
    /// between their neighbours.
    RedundantPoints(usize),
    /// Number of ignored strokes of a drawing.
    Strokes(usize),
    /// Number of ignored text elements of a drawing.
    Texts(usize),
    /// Name of a font that is not installed; another font was used in its place.
    Font(String),
    /// Number of ignored characters that have no outline in any font.
    Characters(usize),
    /// Number of characters that are drawn in another font, because theirs lacks them.
    ReplacedCharacters(usize),
    /// Feature of a drawing that was ignored or replaced by something simpler.
    LostFeature {
        /// Name of the feature: an element, a property or a few words.
        feature: String,
        /// Treatment instead, such as "replaced by its mean colour"; `None` if the feature was
        /// ignored.
        replacement: Option<String>,
        /// First elements that use the feature: their ids, or their tags and lines.
        elements: Vec<String>,
        /// Number of all elements that use the feature.
        count: usize,
    },
    /// The colours of a large picture were stored at a lower resolution.
    ReducedPicture {
        /// Original width and height in pixels.
        given: (u32, u32),
        /// Stored width and height in pixels.
        kept: (u32, u32),
    },
    /// Separate paint layers for flat colours were requested, but the picture has no flat colours.
    NoFlatColours,
    /// The silhouette of a picture can be read in two ways.
    Reading {
        /// Property of the pixels that was used.
        used: PictureReading,
        /// Property of the pixels that gives another silhouette.
        other: PictureReading,
    },
    /// Number of outlines whose longitudes were continued beyond ±180°, so that shapes at the
    /// antimeridian are whole.
    CrossesAntimeridian(usize),
    /// Pieces on both sides of the antimeridian stay apart, because the map reaches around the
    /// globe.
    CutAtAntimeridian,
    /// Number of outlines around a pole that the file does not close; they were closed along the
    /// pole.
    PolarOutlines(usize),
    /// Objects of a type that is not imported were ignored.
    SkippedObjects {
        /// Type name as written in the file.
        kind: String,
        /// Number of ignored objects of that type.
        count: usize,
    },
    /// Omission or approximation of a DXF drawing.
    Dxf(DxfNote),
    /// A truss with loads, areas, sections or materials does not say in which units they are.
    NoTrussUnits,
}

impl ImportNote {
    /// Returns one note for each kind of repair with a count above 0. `rule` is the fill rule that
    /// decided what is inside.
    pub(super) fn from_repairs(found: &Repairs, rule: FillRule) -> Vec<Self> {
        let at_least = found.at_least;
        let crossings = Self::Crossings {
            count: found.crossings,
            at_least,
            rule,
        };
        let touches = Self::Touches {
            count: found.touches,
            at_least,
        };
        // Repairs that changed the shape come before those that did not.
        let counted = [
            (found.crossings, crossings),
            (found.touches, touches),
            (found.duplicates, Self::Duplicates(found.duplicates)),
            (found.flat, Self::EmptyOutlines(found.flat)),
            (found.slivers, Self::Slivers(found.slivers)),
            (found.idle_points, Self::RedundantPoints(found.idle_points)),
        ];
        let nonzero = counted.into_iter().filter(|&(count, _)| count > 0);
        nonzero.map(|(_, note)| note).collect()
    }

    /// Returns one note for each type of ignored objects. `kinds` maps the type name to the number
    /// of objects.
    pub(super) fn from_skipped(kinds: BTreeMap<String, usize>) -> impl Iterator<Item = Self> {
        let kinds = kinds.into_iter();
        kinds.map(|(kind, count)| Self::SkippedObjects { kind, count })
    }
}

/// Objects of a file from which nothing can be imported: maps each type name to the number of
/// objects of that type.
///
/// Displayed as the continuation of an error message, such as `, only 2 TEXT`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OtherKinds(pub BTreeMap<String, usize>);

impl fmt::Display for OtherKinds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (kind, count)) in self.0.iter().enumerate() {
            let before = if i == 0 { ", only " } else { ", " };
            write!(f, "{before}{count} {kind}")?;
        }
        Ok(())
    }
}

impl fmt::Display for ImportNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Crossings {
                count,
                at_least,
                rule,
            } => write_crossings(f, *count, *at_least, *rule),
            Self::Touches { count, at_least } => write_touches(f, *count, *at_least),
            Self::Duplicates(n) => {
                write_ignored(f, *n, ["duplicate outline", "duplicate outlines"])
            }
            Self::EmptyOutlines(n) => {
                let one = "outline that encloses no area";
                write_ignored(f, *n, [one, "outlines that enclose no area"])
            }
            Self::Slivers(n) => {
                let one = "sliver between touching edges";
                write_ignored(f, *n, [one, "slivers between touching edges"])
            }
            Self::RedundantPoints(n) => {
                let one = "redundant point (repeated or on a straight edge)";
                let many = "redundant points (repeated or on a straight edge)";
                write_ignored(f, *n, [one, many])
            }
            Self::ReducedPicture { .. } | Self::NoFlatColours | Self::Reading { .. } => {
                self.write_picture_note(f)
            }
            Self::CrossesAntimeridian(_) | Self::CutAtAntimeridian | Self::PolarOutlines(_) => {
                self.write_map_note(f)
            }
            Self::SkippedObjects { kind, count } => {
                let kinds = ["object", "objects"]
                    .map(|what| format!("{what} of type {}", SanitizedLine(kind)));
                write_ignored(f, *count, kinds)
            }
            Self::Dxf(note) => note.fmt(f),
            Self::NoTrussUnits => f.write_str(
                "the truss has no \"units\"; it was read in metres, kilonewtons and pascals",
            ),
            Self::Strokes(_)
            | Self::Texts(_)
            | Self::Font(_)
            | Self::Characters(_)
            | Self::ReplacedCharacters(_)
            | Self::LostFeature { .. } => self.write_drawing_note(f),
        }
    }
}

impl ImportNote {
    /// Writes the notes that only SVG drawings have.
    fn write_drawing_note(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Strokes(n) => {
                write_ignored(f, *n, ["stroke", "strokes"])?;
                f.write_str(" because strokes = false")
            }
            Self::Texts(n) => {
                write_ignored(f, *n, ["text", "texts"])?;
                f.write_str(" because the text is too long to lay out; convert text to paths")
            }
            Self::Font(name) => write!(
                f,
                "the font {} is not installed, so another was used; install it or convert text to paths",
                SanitizedLine(name)
            ),
            Self::Characters(n) => {
                write_ignored(f, *n, ["character", "characters"])?;
                f.write_str(" because no installed font provides outlines; convert text to paths")
            }
            Self::ReplacedCharacters(n) => {
                let (words, them) = match n {
                    1 => ("character is", "it"),
                    _ => ("characters are", "them"),
                };
                write!(
                    f,
                    "{n} {words} drawn in another font, because the chosen one lacks {them}; convert text to paths",
                )
            }
            Self::LostFeature {
                feature,
                replacement,
                elements,
                count,
            } => {
                let done = replacement.as_deref().unwrap_or("ignored");
                write!(f, "{}: {done} (", SanitizedLine(feature))?;
                for (i, element) in elements.iter().enumerate() {
                    let comma = if i == 0 { "" } else { ", " };
                    write!(f, "{comma}{}", SanitizedLine(element))?;
                }
                match count.saturating_sub(elements.len()) {
                    0 => f.write_str(")"),
                    more => write!(f, " and {more} more)"),
                }
            }
            _ => Ok(()),
        }
    }
}

impl ImportNote {
    /// Writes the notes that only pictures have.
    fn write_picture_note(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ReducedPicture { given, kept } => write_reduced(f, *given, *kept),
            Self::NoFlatColours => f.write_str(
                "the picture has no flat colours; its silhouette was imported as one part",
            ),
            Self::Reading { used, other } => write!(
                f,
                "the silhouette was read by {used}, but could also be read by {other}; choose with reading = {other}"
            ),
            _ => Ok(()),
        }
    }

    /// Writes the notes that only maps in longitude and latitude have.
    fn write_map_note(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CrossesAntimeridian(n) => {
                let what = number(["outline was", "outlines were"], *n);
                write!(
                    f,
                    "{n} {what} continued across the antimeridian (longitude 180°), so that no shape is cut there"
                )
            }
            Self::CutAtAntimeridian => f.write_str(
                "pieces on both sides of the antimeridian (longitude 180°) stay apart, because the map reaches around the globe",
            ),
            Self::PolarOutlines(n) => {
                let what = number(["outline around a pole was", "outlines around a pole were"], *n);
                write!(f, "{n} {what} closed along the pole")
            }
            _ => Ok(()),
        }
    }
}

/// Writes how many corners lay on other edges.
fn write_touches(f: &mut fmt::Formatter<'_>, count: usize, at_least: bool) -> fmt::Result {
    let least = lower_bound(at_least);
    let one = "corner lies on another edge, which was split";
    let many = "corners lie on other edges, which were split";
    let what = number([one, many], count);
    write!(f, "{least}{count} {what}")
}

/// Writes the note on edge crossings.
fn write_crossings(
    f: &mut fmt::Formatter<'_>,
    count: usize,
    at_least: bool,
    rule: FillRule,
) -> fmt::Result {
    let (least, were) = (lower_bound(at_least), number(["was", "were"], count));
    let what = number(["edge crossing", "edge crossings"], count);
    let by = rule_name(rule);
    write!(f, "{least}{count} {what} {were} resolved by {by}")
}

/// Writes the note on a picture whose colours were stored at a lower resolution.
fn write_reduced(f: &mut fmt::Formatter<'_>, given: (u32, u32), kept: (u32, u32)) -> fmt::Result {
    let ((w, h), (x, y)) = (given, kept);
    write!(
        f,
        "the colours of the picture were reduced from {w} × {h} to {x} × {y} pixels"
    )
}

fn rule_name(rule: FillRule) -> &'static str {
    match rule {
        FillRule::NonZero => "the non-zero winding rule",
        FillRule::EvenOdd => "the even-odd rule",
    }
}

/// Writes that `n` things were ignored. `what` names them in the singular and in the plural.
fn write_ignored<W: fmt::Display>(
    f: &mut fmt::Formatter<'_>,
    n: usize,
    what: [W; 2],
) -> fmt::Result {
    let (what, were) = (number(what, n), number(["was", "were"], n));
    write!(f, "{n} {what} {were} ignored")
}

/// Returns the singular word if `n` is 1, otherwise the plural word.
fn number<W>([one, many]: [W; 2], n: usize) -> W {
    if n == 1 { one } else { many }
}

fn lower_bound(at_least: bool) -> &'static str {
    if at_least { "at least " } else { "" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_use_singular_and_plural() {
        let found = Repairs {
            crossings: 1,
            duplicates: 2,
            idle_points: 1,
            ..Repairs::default()
        };
        let words: Vec<_> = ImportNote::from_repairs(&found, FillRule::EvenOdd)
            .iter()
            .map(ToString::to_string)
            .collect();
        assert_eq!(
            words,
            [
                "1 edge crossing was resolved by the even-odd rule",
                "2 duplicate outlines were ignored",
                "1 redundant point (repeated or on a straight edge) was ignored",
            ]
        );
    }
}
