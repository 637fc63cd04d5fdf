//! A coat of paint: what a drawing shows is several, one over the other.

use crate::colour::{Gradient, Paint, StrokeStyle};
use crate::geometry::{Bounds, Region, Regions, Similarity};
use std::collections::BTreeMap;

/// Regions in one paint. What is in one coat neither overlaps nor hides the
/// rest of it; what is in a later coat hides what lies under it.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintLayer {
    /// What it covers.
    pub regions: Regions,
    /// Its paint; none where the design has no colour of its own.
    pub paint: Option<Paint>,
    /// The gradient that the paint is the mean of, if it is of one.
    pub gradient: Option<Gradient>,
    /// The line along all its outlines, if there is one; it covers the paint.
    pub line: Option<StrokeStyle>,
    /// What the file calls it, if it is one shape; or empty.
    pub name: String,
    /// Whether it is text.
    pub is_text: bool,
}

impl PaintLayer {
    pub(super) fn transformed(&self, by: &Similarity) -> Self {
        Self {
            regions: self.regions.transformed(by),
            paint: self.paint,
            gradient: self
                .gradient
                .as_ref()
                .map(|gradient| gradient.moved(by.affine())),
            line: self.line.map(|line| StrokeStyle {
                width: by.scale * line.width,
                ..line
            }),
            name: self.name.clone(),
            is_text: self.is_text,
        }
    }
}

/// What a file has in one paint.
pub(super) struct PaintGroup {
    pub regions: Regions,
    pub paint: Option<Paint>,
    pub name: String,
}

/// Sheets without an order of their own as coats, so that nothing hides what lies within
/// it: as high as it is deep in pieces of other sheets, and what is smaller over what is
/// larger. None where none has a colour of its own.
pub(super) fn stack_by_containment(sheets: &[PaintGroup]) -> Vec<PaintLayer> {
    if sheets.iter().all(|sheet| sheet.paint.is_none()) {
        return Vec::new();
    }
    let mut of_heights: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for StackedPiece {
        sheet,
        number,
        height,
    } in placed(sheets)
    {
        let numbers = of_heights.entry((height, sheet)).or_default();
        numbers.push(number);
    }
    let coat = |((height, sheet), numbers): ((usize, usize), Vec<usize>)| {
        let sheet = &sheets[sheet];
        let coat = PaintLayer {
            regions: sheet.regions.only(&numbers)?,
            paint: sheet.paint,
            gradient: None,
            line: None,
            name: sheet.name.clone(),
            is_text: false,
        };
        Some((height, coat))
    };
    let mut coats: Vec<(usize, PaintLayer)> = of_heights.into_iter().filter_map(coat).collect();
    coats.sort_by(|(a, first), (b, second)| {
        let by_area = || second.regions.area().total_cmp(&first.regions.area());
        a.cmp(b).then_with(by_area)
    });
    coats.into_iter().map(|(_, coat)| coat).collect()
}

/// A piece of a sheet, and how deep it lies in pieces of others.
struct StackedPiece {
    sheet: usize,
    number: usize,
    height: usize,
}

/// More pieces are not compared with each other: all lie as high.
const MOST: usize = 20_000;

/// All pieces, the largest first.
fn placed(sheets: &[PaintGroup]) -> Vec<StackedPiece> {
    let of_sheet = |(sheet, of): (usize, &'_ PaintGroup)| -> Vec<(usize, usize)> {
        (0..of.regions.len())
            .map(|number| (sheet, number))
            .collect()
    };
    let numbers: Vec<(usize, usize)> = sheets.iter().enumerate().flat_map(of_sheet).collect();
    let regions = sheets.iter().flat_map(|sheet| sheet.regions.iter());
    let mut pieces: Vec<(Bounds, f64, &Region, (usize, usize))> = regions
        .zip(numbers)
        .map(|(region, number)| (region.outer.bounds(), region.area(), region, number))
        .collect();
    pieces.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut heights = vec![0; pieces.len()];
    if pieces.len() <= MOST {
        for inner in 0..pieces.len() {
            let (bounds, _, region, (sheet, _)) = pieces[inner];
            let hosts = pieces[..inner].iter().zip(&heights).filter(|(host, _)| {
                host.3.0 != sheet && host.0.union(&bounds) == host.0 && is_within(region, host.2)
            });
            heights[inner] = hosts.map(|(_, height)| height + 1).max().unwrap_or(0);
        }
    }
    let numbered = pieces.iter().zip(heights);
    let placed = numbered.map(|(&(.., (sheet, number)), height)| StackedPiece {
        sheet,
        number,
        height,
    });
    placed.collect()
}

/// Whether most of a piece's outline lies in another.
fn is_within(inner: &Region, outer: &Region) -> bool {
    let points = inner.outer.points();
    let some = points.iter().step_by(points.len().div_ceil(16).max(1));
    let (count, inside) = some.fold((0, 0), |(count, inside), &p| {
        (count + 1, inside + usize::from(outer.contains(p)))
    });
    2 * inside > count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::Rgb;
    use crate::geometry::{DVec2, FillRule};

    fn sheet(name: &str, squares: &[[f64; 3]]) -> PaintGroup {
        let square = |&[x, y, side]: &[f64; 3]| {
            let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
            corners.map(|(a, b)| DVec2::new(x + a, y + b)).to_vec()
        };
        let rings: Vec<Vec<DVec2>> = squares.iter().map(square).collect();
        PaintGroup {
            regions: Regions::from_rings(&rings, FillRule::NonZero).expect("squares"),
            paint: Some(Rgb([1, 2, 3]).into()),
            name: name.to_owned(),
        }
    }

    #[test]
    fn a_dot_is_not_hidden_for_what_its_colour_has_elsewhere() {
        // A pupil with a highlight, beside a large white wall; and a point in the wall.
        let sheets = [
            sheet("black", &[[0.0, 0.0, 10.0], [60.0, 0.0, 2.0]]),
            sheet("white", &[[4.0, 4.0, 1.0], [50.0, -20.0, 40.0]]),
        ];
        let coats = stack_by_containment(&sheets);
        let found: Vec<(&str, usize)> = coats
            .iter()
            .map(|coat| (coat.name.as_str(), coat.regions.len()))
            .collect();
        assert_eq!(
            found,
            [("white", 1), ("black", 1), ("black", 1), ("white", 1)]
        );
    }
}
