//! Parsers for the values of flags.

use std::ops::Range;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::colour::{ColourError, Rgb};
use crate::correspondence::{LinePair, PointPair};
use crate::geometry::DVec2;
use crate::settings::Choice;
use crate::warp::FaceWeights;

/// Error for the value of a flag.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum ValueError {
    #[error("use area, uniform, or one number for each face, separated by commas")]
    Weights,
    #[error("separate the coordinates of the source from those of the target by a colon")]
    Halves,
    #[error("give a point of the source and one of the target, as in 10,20:12,24")]
    Pin,
    #[error("give both ends in the source and in the target, as in 0,0,9,0:1,2,9,3")]
    Line,
    #[error("`{0}` is not a range: use A..B with A less than B, for example 0..60")]
    Range(String),
    #[error("{0}, or transparent")]
    Ground(ColourError),
}

/// Background: a colour, or `None` for transparent.
// A separate type, because clap treats an `Option` as a flag that may be left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BackgroundColour(pub Option<Rgb>);

/// Parses an option value by its key; `--help` lists the keys, each with its help sentence.
pub(super) fn one_of<T: Choice + Send + Sync>() -> impl TypedValueParser<Value = T> {
    let values = T::CHOICES.iter().map(|choice| {
        let name = choice.name();
        PossibleValue::new(name.key).help(name.sentence)
    });
    PossibleValuesParser::new(values).try_map(|key| T::of_key(&key))
}

/// Assigns `value` to `place` if it is `Some`.
pub(super) fn set_if_given<T>(place: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *place = value;
    }
}

/// Parses face weights: a name that is valid in project files, or one number per face.
pub(super) fn weights(text: &str) -> Result<FaceWeights, ValueError> {
    // serde parses the names, so they are the same as in a project file.
    let by_name = serde_json::from_value(text.into()).ok();
    let each = || numbers(text).map(FaceWeights::PerFace);
    by_name.or_else(each).ok_or(ValueError::Weights)
}

/// Parses a pair of points, such as `10,20:12,24`.
pub(super) fn pin(text: &str) -> Result<PointPair, ValueError> {
    let [source, target] = halves(text, ValueError::Pin)?;
    Ok(PointPair {
        source: DVec2::from_array(source),
        target: DVec2::from_array(target),
    })
}

/// Parses a pair of lines, such as `0,0,9,0:1,2,9,3`.
pub(super) fn line(text: &str) -> Result<LinePair, ValueError> {
    let ends = |[a, b, c, d]: [f64; 4]| [DVec2::new(a, b), DVec2::new(c, d)];
    let [source, target] = halves(text, ValueError::Line)?.map(ends);
    Ok(LinePair { source, target })
}

/// Parses a background: `#rrggbb` or `transparent`.
pub(super) fn background(text: &str) -> Result<BackgroundColour, ValueError> {
    match text {
        "transparent" => Ok(BackgroundColour(None)),
        colour => {
            let colour = colour.parse().map_err(ValueError::Ground)?;
            Ok(BackgroundColour(Some(colour)))
        }
    }
}

/// Parses a range of frame numbers, such as `0..60`, with an exclusive end.
pub(super) fn range(text: &str) -> Result<Range<usize>, ValueError> {
    let ends = text.split_once("..");
    let range = ends.and_then(|(start, end)| Some(start.parse().ok()?..end.parse().ok()?));
    range
        // A reversed range counts as empty, too.
        .filter(|range| !range.is_empty())
        .ok_or_else(|| ValueError::Range(text.to_owned()))
}

/// Parses a number of columns and rows, such as `9x5`.
pub(super) fn grid(text: &str) -> Result<[usize; 2], String> {
    /// Maximum number of cells of a map (resource limit: with more, thumbnails are too small to be
    /// useful).
    const MAX_CELLS: usize = 2_500;
    let sides = text.split_once(['x', '×']);
    let grid = sides.and_then(|(columns, rows)| Some([columns.parse().ok()?, rows.parse().ok()?]));
    grid.filter(|[columns, rows]: &[usize; 2]| {
        let cells = columns.saturating_mul(*rows);
        (1..=MAX_CELLS).contains(&cells)
    })
    .ok_or_else(|| format!("give columns and rows, for example 9x9, at most {MAX_CELLS} cells"))
}

/// Parses N numbers for the source and N for the target, separated by a colon.
fn halves<const N: usize>(text: &str, error: ValueError) -> Result<[[f64; N]; 2], ValueError> {
    let (source, target) = text.split_once(':').ok_or(ValueError::Halves)?;
    let read = |half| numbers(half).and_then(|all| all.try_into().ok());
    read(source)
        .zip(read(target))
        .map(<[_; 2]>::from)
        .ok_or(error)
}

/// Parses finite numbers separated by commas.
fn numbers(text: &str) -> Option<Vec<f64>> {
    let each = text.split(',').map(|n| n.trim().parse().ok());
    // A single invalid number makes the whole list invalid.
    each.map(|n| n.filter(|n: &f64| n.is_finite())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_lines_are_parsed() {
        let pin_pair = pin("1,-2: 3.5,4").expect("a pin");
        assert_eq!(pin_pair.source, DVec2::new(1.0, -2.0));
        assert_eq!(pin_pair.target, DVec2::new(3.5, 4.0));
        let line_pair = line("0,0,1,0:0,0,0,2").expect("a line");
        assert_eq!(line_pair.target[1], DVec2::new(0.0, 2.0));
        for invalid in ["", "1,2", "1,2:3", "1,2:3,4,5", "1,nan:2,3", "a,b:c,d"] {
            assert!(pin(invalid).is_err(), "{invalid}");
            assert!(line(invalid).is_err(), "{invalid}");
        }
    }

    #[test]
    fn ranges_are_parsed() {
        assert_eq!(range("0..60"), Ok(0..60));
        for invalid in [
            "", "5", "5..", "..5", "5..5", "6..5", "-1..5", "0..=5", "a..b",
        ] {
            assert!(range(invalid).is_err(), "{invalid}");
        }
    }

    #[test]
    fn grids_are_parsed() {
        assert_eq!(grid("9x5"), Ok([9, 5]));
        for invalid in ["", "9", "x", "9x", "0x4", "51x50", "-1x3", "9x9x9"] {
            assert!(grid(invalid).is_err(), "{invalid}");
        }
    }

    #[test]
    fn background_colours_are_parsed() {
        assert_eq!(background("transparent"), Ok(BackgroundColour(None)));
        assert_eq!(
            background("#010203"),
            Ok(BackgroundColour(Some(Rgb([1, 2, 3]))))
        );
        assert!(background("white").is_err());
    }
}
