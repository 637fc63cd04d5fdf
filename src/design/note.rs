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

    /// How many of what were left out, for one and for many, and what can be
    /// done about it; `None` where something was repaired instead.
    fn left_out(&self) -> Option<(usize, [String; 2], String)> {
        let plain = |n: usize, one: &str, many: &str, way_out: &str| {
            Some((n, [one.to_owned(), many.to_owned()], way_out.to_owned()))
        };
        match self {
            Self::Crossings { .. } | Self::Touches { .. } => None,
            Self::Duplicates(n) => plain(*n, "outline drawn again", "outlines drawn again", ""),
            Self::Flat(n) => {
                let one = "outline that encloses nothing";
                plain(*n, one, "outlines that enclose nothing", "")
            }
            Self::Slivers(n) => {
                let one = "sliver between touching edges";
                plain(*n, one, "slivers between touching edges", "")
            }
            Self::IdlePoints(n) => {
                let one = "point that repeats another or lies on a straight edge";
                let many = "points that repeat another or lie on a straight edge";
                plain(*n, one, many, "")
            }
            Self::Strokes(n) => {
                let way_out = "; set strokes = true to read them as shapes";
                plain(*n, "stroke", "strokes", way_out)
            }
            Self::Texts(n) => plain(*n, "text", "texts", "; convert text to paths"),
            Self::Pictures(n) => plain(*n, "embedded picture", "embedded pictures", ""),
            Self::Open { count, at } => {
                let way_out = format!("; close the gap at ({}, {})", at.x, at.y);
                let (one, many) = ("curve that does not close", "curves that do not close");
                plain(*count, one, many, &way_out)
            }
            Self::Skipped { kind, count } => {
                let [one, many] = ["object", "objects"].map(|w| format!("{w} of the kind {kind}"));
                plain(*count, &one, &many, "")
            }
        }
    }
}

impl fmt::Display for ImportNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((n, [one, many], way_out)) = self.left_out() {
            let what = plural(n, &one, &many);
            let were = plural(n, "was", "were");
            return write!(f, "{n} {what} {were} left out{way_out}");
        }
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
                let what = plural(*count, "crossing of edges was", "crossings of edges were");
                write!(f, "{}{count} {what} resolved by {rule}", floor(*at_least))
            }
            Self::Touches { count, at_least } => {
                let what = plural(*count, "corner that lies", "corners that lie");
                write!(
                    f,
                    "{}{count} {what} on another edge divided it",
                    floor(*at_least)
                )
            }
            _ => Ok(()),
        }
    }
}

fn floor(at_least: bool) -> &'static str {
    if at_least { "at least " } else { "" }
}

fn plural<'w>(count: usize, one: &'w str, many: &'w str) -> &'w str {
    if count == 1 { one } else { many }
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
