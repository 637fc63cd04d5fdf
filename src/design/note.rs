//! What was repaired or left out while a design was read, in words.

use crate::geometry::{DVec2, FillRule, Repairs};
use crate::io::sanitize::SanitizedLine;
use std::collections::BTreeMap;
use std::fmt;

/// Something about a file that its owner may want to know. It is no error:
/// the design can be used as it is. A clean file has none.
///
/// ```
/// use morphospace::design::ImportNote;
/// let note = ImportNote::Strokes(2);
/// assert!(note.to_string().starts_with("2 strokes were left out"));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ImportNote {
    /// Edges that cross.
    Crossings {
        /// How many pairs.
        count: usize,
        /// Whether there may be more.
        at_least: bool,
        /// What decides what lies inside.
        rule: FillRule,
    },
    /// Corners that lie on another edge.
    Touches {
        /// How many.
        count: usize,
        /// Whether there may be more.
        at_least: bool,
    },
    /// Outlines that are there more than once.
    Duplicates(usize),
    /// Outlines that enclose nothing.
    Flat(usize),
    /// Pieces too small to count, left over from touching edges.
    Slivers(usize),
    /// Points that repeat the one before or lie straight between neighbours.
    IdlePoints(usize),
    /// Strokes of a drawing.
    Strokes(usize),
    /// Texts of a drawing.
    Texts(usize),
    /// A font that the machine does not have.
    Font(String),
    /// Characters of a drawing that no font has, or that are pictures.
    Characters(usize),
    /// Pictures in a drawing.
    Pictures(usize),
    /// Patterns, and gradients of strokes, of which the mean colour is shown.
    Shades(usize),
    /// Masks of a drawing.
    Masks(usize),
    /// Filters of a drawing.
    Filters(usize),
    /// Groups that are mixed with what is below otherwise than as drawn.
    Blends(usize),
    /// A large picture's colours, kept at a smaller size.
    Smaller {
        /// Its width and height.
        given: (u32, u32),
        /// Those that are kept.
        kept: (u32, u32),
    },
    /// Each flat colour was to be a part, and the picture is of shades.
    Shaded,
    /// Curves that do not close.
    Open {
        /// How many.
        count: usize,
        /// An end of one of them, where nothing goes on.
        at: DVec2,
    },
    /// Objects of a drawing that have no outline here.
    Skipped {
        /// Their kind, as the file calls it.
        kind: String,
        /// How many.
        count: usize,
    },
}

impl ImportNote {
    /// What the cleaning of outlines by a fill rule has to tell.
    pub(super) fn of_repairs(found: &Repairs, rule: FillRule) -> Vec<Self> {
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
        // Told in this order: what changed the form before what did not.
        let counted = [
            (found.crossings, crossings),
            (found.touches, touches),
            (found.duplicates, Self::Duplicates(found.duplicates)),
            (found.flat, Self::Flat(found.flat)),
            (found.slivers, Self::Slivers(found.slivers)),
            (found.idle_points, Self::IdlePoints(found.idle_points)),
        ];
        let told = counted.into_iter().filter(|&(count, _)| count > 0);
        told.map(|(_, note)| note).collect()
    }

    /// Of the kinds that were left out, and how many of each.
    pub(super) fn of_skipped(kinds: BTreeMap<String, usize>) -> impl Iterator<Item = Self> {
        let kinds = kinds.into_iter();
        kinds.map(|(kind, count)| Self::Skipped { kind, count })
    }
}

/// What there is in a file besides what is asked for, as the end of a clause:
/// `, only 2 TEXT`; how many of which kind.
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
            } => resolved(f, *count, *at_least, *rule),
            Self::Touches { count, at_least } => {
                let least = floor(*at_least);
                let what = number(["corner that lies", "corners that lie"], *count);
                write!(f, "{least}{count} {what} on another edge divided it")
            }
            Self::Duplicates(n) => left_out(f, *n, ["outline drawn again", "outlines drawn again"]),
            Self::Flat(n) => {
                let one = "outline that encloses nothing";
                left_out(f, *n, [one, "outlines that enclose nothing"])
            }
            Self::Slivers(n) => {
                let one = "sliver between touching edges";
                left_out(f, *n, [one, "slivers between touching edges"])
            }
            Self::IdlePoints(n) => {
                let one = "point that repeats another or lies on a straight edge";
                let many = "points that repeat another or lie on a straight edge";
                left_out(f, *n, [one, many])
            }
            Self::Smaller { given, kept } => smaller(f, *given, *kept),
            Self::Shaded => f.write_str(
                "the picture is of shades, not of a few flat colours; its figure is one part",
            ),
            Self::Open { count, at } => {
                let one = "curve that does not close";
                left_out(f, *count, [one, "curves that do not close"])?;
                write!(f, "; close the gap at ({}, {})", at.x, at.y)
            }
            Self::Skipped { kind, count } => {
                let kinds = ["object", "objects"]
                    .map(|what| format!("{what} of the kind {}", SanitizedLine(kind)));
                left_out(f, *count, kinds)
            }
            Self::Strokes(_)
            | Self::Texts(_)
            | Self::Font(_)
            | Self::Characters(_)
            | Self::Pictures(_)
            | Self::Shades(_)
            | Self::Masks(_)
            | Self::Filters(_)
            | Self::Blends(_) => self.of_drawing(f),
        }
    }
}

impl ImportNote {
    /// Writes what is not shown as it was drawn.
    fn of_drawing(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Strokes(n) => {
                left_out(f, *n, ["stroke", "strokes"])?;
                f.write_str(", as strokes = false asks for")
            }
            Self::Texts(n) => {
                left_out(f, *n, ["text", "texts"])?;
                f.write_str(", too long to be laid out; convert text to paths")
            }
            Self::Font(name) => write!(
                f,
                "the font {} is not on this machine, another one is shown; install it, or convert text to paths",
                SanitizedLine(name)
            ),
            Self::Characters(n) => {
                left_out(f, *n, ["character", "characters"])?;
                f.write_str(", of which no font has an outline; convert text to paths")
            }
            Self::Pictures(n) => left_out(f, *n, ["embedded picture", "embedded pictures"]),
            Self::Shades(n) => {
                let what = [
                    "pattern or stroke with a gradient",
                    "patterns and strokes with gradients",
                ];
                let (what, were) = (number(what, *n), number(["is", "are"], *n));
                write!(f, "{n} {what} {were} shown in the mean colour")
            }
            Self::Masks(n) => {
                left_out(f, *n, ["mask", "masks"])?;
                f.write_str("; apply masks as clip paths")
            }
            Self::Filters(n) => left_out(f, *n, ["filter", "filters"]),
            Self::Blends(n) => {
                let (what, were) = (number(["group", "groups"], *n), number(["is", "are"], *n));
                write!(
                    f,
                    "{n} {what} {were} not mixed with what lies below as drawn"
                )
            }
            _ => Ok(()),
        }
    }
}

/// Writes how many crossings there were.
fn resolved(
    f: &mut fmt::Formatter<'_>,
    count: usize,
    at_least: bool,
    rule: FillRule,
) -> fmt::Result {
    let (least, were) = (floor(at_least), number(["was", "were"], count));
    let what = number(["crossing", "crossings"], count);
    let by = named(rule);
    write!(f, "{least}{count} {what} of edges {were} resolved by {by}")
}

/// Writes that a picture of one size is kept at another.
fn smaller(f: &mut fmt::Formatter<'_>, given: (u32, u32), kept: (u32, u32)) -> fmt::Result {
    let ((w, h), (x, y)) = (given, kept);
    write!(
        f,
        "the colours of its {w} × {h} pixels are kept as {x} × {y}"
    )
}

fn named(rule: FillRule) -> &'static str {
    match rule {
        FillRule::NonZero => "the non-zero winding rule",
        FillRule::EvenOdd => "the even-odd rule",
    }
}

/// Writes how many of what are not there.
fn left_out<W: fmt::Display>(f: &mut fmt::Formatter<'_>, n: usize, what: [W; 2]) -> fmt::Result {
    let (what, were) = (number(what, n), number(["was", "were"], n));
    write!(f, "{n} {what} {were} left out")
}

/// The word for one, or for many.
fn number<W>([one, many]: [W; 2], n: usize) -> W {
    if n == 1 { one } else { many }
}

fn floor(at_least: bool) -> &'static str {
    if at_least { "at least " } else { "" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_are_sentences_about_one_and_many() {
        let found = Repairs {
            crossings: 1,
            duplicates: 2,
            idle_points: 1,
            ..Repairs::default()
        };
        let words: Vec<_> = ImportNote::of_repairs(&found, FillRule::EvenOdd)
            .iter()
            .map(ToString::to_string)
            .collect();
        assert_eq!(
            words,
            [
                "1 crossing of edges was resolved by the even-odd rule",
                "2 outlines drawn again were left out",
                "1 point that repeats another or lies on a straight edge was left out",
            ]
        );
        let open = ImportNote::Open {
            count: 2,
            at: DVec2::new(1.5, -2.0),
        };
        assert_eq!(
            open.to_string(),
            "2 curves that do not close were left out; close the gap at (1.5, -2)"
        );
    }
}
