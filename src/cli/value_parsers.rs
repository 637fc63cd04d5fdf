//! What stands behind a flag, read and put in its place.

use std::ops::Range;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::colour::{ColourError, Rgb};
use crate::correspondence::{LinePair, PointPair};
use crate::geometry::DVec2;
use crate::settings::choice::Choice;
use crate::warp::FaceWeights;

/// Why a value is none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum ValueError {
    #[error("write area, uniform, or numbers with commas, one for each face")]
    Weights,
    #[error("put a colon between the source's place and the target's")]
    Halves,
    #[error("write a point of the source and one of the target, as 10,20:12,24")]
    Pin,
    #[error("write both ends in the source and in the target, as 0,0,9,0:1,2,9,3")]
    Line,
    #[error("`{0}` is no range: write A..B with A less than B, for example 0..60")]
    Range(String),
    #[error("{0}, or transparent")]
    Ground(ColourError),
}

/// What is behind the shapes: a colour, or nothing.
// A type of its own, as the parser takes an `Option` for a flag that may be
// left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BackgroundColour(pub Option<Rgb>);

/// A choice by its key, with the sentence that is said of it in `--help`.
pub(super) fn one_of<T: Choice + Send + Sync>() -> impl TypedValueParser<Value = T> {
    let values = T::CHOICES.iter().map(|choice| {
        let name = choice.name();
        PossibleValue::new(name.key).help(name.sentence)
    });
    PossibleValuesParser::new(values).try_map(|key| T::of_key(&key))
}

/// Puts a value in its place, where one was given.
pub(super) fn set<T>(place: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *place = value;
    }
}

pub(super) fn weights(text: &str) -> Result<FaceWeights, ValueError> {
    // Names as files have them, from the same table.
    let by_name = serde_json::from_value(text.into()).ok();
    let each = || numbers(text).map(FaceWeights::PerFace);
    by_name.or_else(each).ok_or(ValueError::Weights)
}

pub(super) fn pin(text: &str) -> Result<PointPair, ValueError> {
    let [source, target] = halves(text, ValueError::Pin)?;
    Ok(PointPair {
        source: DVec2::from_array(source),
        target: DVec2::from_array(target),
    })
}

pub(super) fn line(text: &str) -> Result<LinePair, ValueError> {
    let ends = |[a, b, c, d]: [f64; 4]| [DVec2::new(a, b), DVec2::new(c, d)];
    let [source, target] = halves(text, ValueError::Line)?.map(ends);
    Ok(LinePair { source, target })
}

pub(super) fn ground(text: &str) -> Result<BackgroundColour, ValueError> {
    match text {
        "transparent" => Ok(BackgroundColour(None)),
        colour => {
            let colour = colour.parse().map_err(ValueError::Ground)?;
            Ok(BackgroundColour(Some(colour)))
        }
    }
}

pub(super) fn range(text: &str) -> Result<Range<usize>, ValueError> {
    let ends = text.split_once("..");
    let range = ends.and_then(|(start, end)| Some(start.parse().ok()?..end.parse().ok()?));
    range
        // A range that runs backwards is empty, too.
        .filter(|range| !range.is_empty())
        .ok_or_else(|| ValueError::Range(text.to_owned()))
}

/// Columns and rows.
pub(super) fn grid(text: &str) -> Result<[usize; 2], String> {
    /// More small pictures than this are none that one can look at.
    const MOST: usize = 2_500;
    let sides = text.split_once(['x', '×']);
    let grid = sides.and_then(|(columns, rows)| Some([columns.parse().ok()?, rows.parse().ok()?]));
    grid.filter(|[columns, rows]: &[usize; 2]| {
        let cells = columns.saturating_mul(*rows);
        (1..=MOST).contains(&cells)
    })
    .ok_or_else(|| format!("give columns and rows, for example 9x9, at most {MOST} cells"))
}

/// A place of the source and one of the target.
fn halves<const N: usize>(text: &str, wrong: ValueError) -> Result<[[f64; N]; 2], ValueError> {
    let (source, target) = text.split_once(':').ok_or(ValueError::Halves)?;
    let read = |half| numbers(half).and_then(|all| all.try_into().ok());
    read(source)
        .zip(read(target))
        .map(<[_; 2]>::from)
        .ok_or(wrong)
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    let each = text.split(',').map(|n| n.trim().parse().ok());
    // One that is none makes all of them none.
    each.map(|n| n.filter(|n: &f64| n.is_finite())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_lines_are_read() {
        let found = pin("1,-2: 3.5,4").expect("a pin");
        assert_eq!(found.source, DVec2::new(1.0, -2.0));
        assert_eq!(found.target, DVec2::new(3.5, 4.0));
        let found = line("0,0,1,0:0,0,0,2").expect("a line");
        assert_eq!(found.target[1], DVec2::new(0.0, 2.0));
        for wrong in ["", "1,2", "1,2:3", "1,2:3,4,5", "1,nan:2,3", "a,b:c,d"] {
            assert!(pin(wrong).is_err(), "{wrong}");
            assert!(line(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn ranges_are_read() {
        assert_eq!(range("0..60"), Ok(0..60));
        for wrong in [
            "", "5", "5..", "..5", "5..5", "6..5", "-1..5", "0..=5", "a..b",
        ] {
            assert!(range(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn grids_are_read() {
        assert_eq!(grid("9x5"), Ok([9, 5]));
        for wrong in ["", "9", "x", "9x", "0x4", "51x50", "-1x3", "9x9x9"] {
            assert!(grid(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn grounds_are_read() {
        assert_eq!(ground("transparent"), Ok(BackgroundColour(None)));
        assert_eq!(
            ground("#010203"),
            Ok(BackgroundColour(Some(Rgb([1, 2, 3]))))
        );
        assert!(ground("white").is_err());
    }
}
