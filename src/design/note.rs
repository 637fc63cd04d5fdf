//! What was repaired or left out while a design was read, in words.

use crate::geometry::{DVec2, FillRule, Repairs};
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
    /// Pictures in a drawing.
    Pictures(usize),
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
}

impl fmt::Display for ImportNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Crossings {
                count,
                at_least,
                rule,
            } => {
                let rule = match rule {
                    FillRule::NonZero => "the non-zero winding rule",
                    FillRule::EvenOdd => "the even-odd rule",
                };
                let some = number(*count, *at_least);
                let what = plural(*count, "crossing of edges was", "crossings of edges were");
                write!(f, "{some}{what} resolved by {rule}")
            }
            Self::Touches { count, at_least } => {
                let some = number(*count, *at_least);
                let what = plural(*count, "corner that lies", "corners that lie");
                write!(f, "{some}{what} on another edge divided it")
            }
            Self::Duplicates(n) => {
                let what = plural(*n, "outline", "outlines");
                write!(f, "{n} {what} drawn again {} left out", was(*n))
            }
            Self::Flat(n) => {
                let what = plural(*n, "outline that encloses", "outlines that enclose");
                write!(f, "{n} {what} nothing {} left out", was(*n))
            }
            Self::Slivers(n) => {
                let what = plural(*n, "sliver", "slivers");
                write!(f, "{n} {what} between touching edges {} left out", was(*n))
            }
            Self::IdlePoints(n) => {
                let what = plural(*n, "point that repeats", "points that repeat");
                let lies = plural(*n, "lies", "lie");
                write!(
                    f,
                    "{n} {what} another or {lies} on a straight edge {} left out",
                    was(*n)
                )
            }
            Self::Strokes(n) => {
                let what = plural(*n, "stroke", "strokes");
                write!(
                    f,
                    "{n} {what} {} left out; set strokes = true to read them as shapes",
                    was(*n)
                )
            }
            Self::Texts(n) => {
                let what = plural(*n, "text", "texts");
                write!(f, "{n} {what} {} left out; convert text to paths", was(*n))
            }
            Self::Pictures(n) => {
                let what = plural(*n, "picture", "pictures");
                write!(f, "{n} {what} in the drawing {} left out", was(*n))
            }
            Self::Open { count, at } => {
                let what = plural(*count, "curve that does", "curves that do");
                write!(
                    f,
                    "{count} {what} not close {} left out; close the gap at ({}, {})",
                    was(*count),
                    at.x,
                    at.y
                )
            }
            Self::Skipped { kind, count } => {
                let what = plural(*count, "object", "objects");
                write!(
                    f,
                    "{count} {what} of the kind {kind} {} left out",
                    was(*count)
                )
            }
        }
    }
}

fn number(count: usize, at_least: bool) -> String {
    let words = if at_least { "at least " } else { "" };
    format!("{words}{count} ")
}

fn plural<'w>(count: usize, one: &'w str, many: &'w str) -> &'w str {
    if count == 1 { one } else { many }
}

fn was(count: usize) -> &'static str {
    plural(count, "was", "were")
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
