//! A contact sheet: frames side by side with their t below, as the paper's
//! figures print them.
//!
//! Guarantees: one scale for all cells, frames left to right and top to bottom,
//! a last row that is not full starts at the left. It is a [`Drawing`] like any
//! other, so PNG and SVG show the same.

use crate::colour::Rgb;
use crate::geometry::{Bounds, DVec2};
use crate::transition::{Sequence, TransitionStyle};

use super::drawing::Drawing;
use super::labels::{text_colour_on, time_label};
use super::size::{MAX_SHEET_SIDE_PX, PixelSize};
use super::view::PlaneView;

/// The longer side of a cell where the sheet's size is free, in pixels.
const CELL_PX: u32 = 240;

/// The most cells in a row where the sheet's size is free.
const MAX_COLUMNS: usize = 6;

/// Height of a label's line, in longer sides of a cell: 17 pixels at 240, so
/// that labels of flat designs can be read as well as those of square ones.
const LABEL_SHARE: f64 = 0.07;

/// The most of a cell's height that a label takes.
const MAX_LABEL_SHARE: f64 = 0.3;

/// Height of a label's line in a grid, in longer sides of all its rows.
const OF_GRID: f64 = 0.013;

/// Gap between cells, in longer sides of a cell.
const GAP_SHARE: f64 = 0.06;

/// Cells in columns and rows, and how large each is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetLayout {
    /// Size of the whole sheet.
    pub size: PixelSize,
    /// Cells in a row.
    pub columns: usize,
    /// Rows.
    pub rows: usize,
    /// Height of a label's line, in pixels.
    label_px: f64,
    /// Gap between cells, in pixels.
    gap_px: f64,
}

impl SheetLayout {
    /// A layout for `count` cells that show `bounds` (both at least 1): in the
    /// given size with the cells as large as can be, or as large as it comes,
    /// with up to six in a row and rows of even length.
    pub fn new(count: usize, bounds: Bounds, size: Option<PixelSize>) -> Self {
        let count = count.max(1);
        let cell = PixelSize::of_shape(bounds, CELL_PX).as_dvec2();
        match size {
            Some(size) => largest_cells(count, cell, size),
            None => free(count, cell),
        }
    }

    /// So many columns and rows (both at least 1) of cells that show `bounds`, in the
    /// given size, or as large as it comes.
    pub fn grid([columns, rows]: [usize; 2], bounds: Bounds, size: Option<PixelSize>) -> Self {
        let (columns, rows) = (columns.max(1), rows.max(1));
        // A large grid is looked at as a whole: its words must be read from as far.
        let label = (OF_GRID * rows as f64).clamp(LABEL_SHARE, MAX_LABEL_SHARE);
        match size {
            Some(size) => Self::filling(size, [columns, rows], label),
            None => {
                let cell = PixelSize::of_shape(bounds, CELL_PX).as_dvec2();
                natural([columns, rows], cell, label)
            }
        }
    }

    /// Height of a label's letters, in pixels.
    pub(super) fn letters_px(&self) -> f64 {
        0.8 * self.label_px
    }

    /// So many columns and rows in a given size.
    fn filling(size: PixelSize, [columns, rows]: [usize; 2], label: f64) -> Self {
        let whole = size.as_dvec2() / DVec2::new(columns as f64, rows as f64);
        let unit = whole.max_element();
        Self {
            size,
            columns,
            rows,
            label_px: (label * unit).min(MAX_LABEL_SHARE * whole.y),
            gap_px: (GAP_SHARE * unit).min(MAX_LABEL_SHARE * whole.min_element()),
        }
    }

    /// Width and height of a label below a picture so large: nearly to the next one.
    pub(super) fn label_room(&self, picture: DVec2) -> [f64; 2] {
        [picture.x + 0.8 * self.gap_px, self.letters_px()]
    }

    /// Corner and size of a cell's picture, and where its label's base line
    /// has its middle.
    pub(super) fn cell(&self, index: usize) -> (DVec2, DVec2, DVec2) {
        let counts = DVec2::new(self.columns as f64, self.rows as f64);
        let whole = self.size.as_dvec2() / counts;
        let place = DVec2::new((index % self.columns) as f64, (index / self.columns) as f64);
        let corner = place * whole + DVec2::splat(0.5 * self.gap_px);
        let inner = whole - DVec2::new(self.gap_px, self.gap_px + self.label_px);
        let base = corner + DVec2::new(0.5 * inner.x, inner.y + 0.8 * self.label_px);
        // A sheet of a few pixels has no room left for pictures.
        (corner, inner.max(DVec2::ONE), base)
    }
}

/// Cells of their natural size in balanced rows, on a sheet that is not too
/// large.
fn free(count: usize, cell: DVec2) -> SheetLayout {
    let rows = count.div_ceil(MAX_COLUMNS);
    natural([count.div_ceil(rows), rows], cell, LABEL_SHARE)
}

/// So many cells of their natural size, on a sheet that is not too large.
fn natural([columns, rows]: [usize; 2], cell: DVec2, label: f64) -> SheetLayout {
    let unit = f64::from(CELL_PX);
    let (label_px, gap_px) = (label * unit, GAP_SHARE * unit);
    let whole = cell + DVec2::new(gap_px, gap_px + label_px);
    let wanted = whole * DVec2::new(columns as f64, rows as f64);
    // Scaled as a whole, with its labels and gaps.
    let fitting = (MAX_SHEET_SIDE_PX / wanted.max_element()).min(1.0);
    let sides = (wanted * fitting).round().max(DVec2::ONE);
    let size = PixelSize::holding(sides)
        .unwrap_or_else(|error| unreachable!("a sheet keeps within its longest side: {error}"));
    SheetLayout {
        size,
        columns,
        rows,
        label_px: label_px * fitting,
        gap_px: gap_px * fitting,
    }
}

/// The number of columns at which the pictures are largest.
fn largest_cells(count: usize, cell: DVec2, size: PixelSize) -> SheetLayout {
    let layout = |columns: usize| {
        SheetLayout::filling(size, [columns, count.div_ceil(columns)], LABEL_SHARE)
    };
    let scale = |layout: &SheetLayout| {
        let (_, inner, _) = layout.cell(0);
        (inner / cell).min_element()
    };
    // Of equals the first stays: fewer columns.
    let better = |a: SheetLayout, b: SheetLayout| if scale(&b) > scale(&a) { b } else { a };
    (2..=count).map(layout).fold(layout(1), better)
}

/// Draws the frames at the given values of t into one sheet.
///
/// `bounds` is what each cell shows, in the design's units.
pub fn contact_sheet(
    sequence: &Sequence,
    style: &TransitionStyle,
    times: &[f64],
    bounds: Bounds,
    size: Option<PixelSize>,
    ground: Option<Rgb>,
) -> Drawing {
    let layout = SheetLayout::new(times.len(), bounds, size);
    let mut drawing = Drawing::new(layout.size, ground);
    let ink = text_colour_on(ground);
    let mut frame = sequence.frame(times.first().copied().unwrap_or_default());
    for (index, &t) in times.iter().enumerate() {
        let (corner, inner, base) = layout.cell(index);
        frame.seek(t);
        let view = PlaneView::fit_cell(bounds, layout.size, corner, inner);
        drawing.push_frame(frame.now(), &frame.style(style), &view);
        drawing.push_label(&time_label(t), base, layout.letters_px(), ink);
    }
    drawing
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Bounds {
        Bounds {
            min: DVec2::ZERO,
            max: DVec2::ONE,
        }
    }

    fn counts(layout: SheetLayout) -> (usize, usize) {
        (layout.columns, layout.rows)
    }

    #[test]
    fn rows_wrap_and_are_balanced() {
        let free = |n| counts(SheetLayout::new(n, square(), None));
        assert_eq!(free(1), (1, 1));
        assert_eq!(free(5), (5, 1));
        assert_eq!(free(6), (6, 1));
        assert_eq!(free(7), (4, 2));
        assert_eq!(free(11), (6, 2));
        assert_eq!(free(13), (5, 3));
    }

    #[test]
    fn a_given_size_takes_the_largest_cells() {
        let given = |n, w, h| {
            let size = PixelSize::new(w, h).expect("a legal size");
            let layout = SheetLayout::new(n, square(), Some(size));
            assert_eq!(layout.size, size);
            counts(layout)
        };
        assert_eq!(given(5, 1000, 200), (5, 1));
        assert_eq!(given(4, 400, 400), (2, 2));
        assert_eq!(given(5, 100, 900), (1, 5));
        assert_eq!(given(500, 1, 1), given(500, 1, 1));
    }

    #[test]
    fn cells_do_not_overlap_and_stay_on_the_sheet() {
        let layout = SheetLayout::new(7, square(), None);
        let cells: Vec<_> = (0..7).map(|i| layout.cell(i)).collect();
        for (i, &(corner, inner, base)) in cells.iter().enumerate() {
            let end = corner + inner;
            assert!(corner.min_element() >= 0.0 && base.y > end.y);
            assert!(end.cmple(layout.size.as_dvec2()).all());
            for &(other, inner, _) in &cells[i + 1..] {
                assert!(end.x <= other.x || base.y <= other.y || other.x + inner.x <= corner.x);
            }
        }
    }

    #[test]
    fn labels_of_flat_designs_are_as_large_as_of_square_ones() {
        let flat = Bounds {
            min: DVec2::ZERO,
            max: DVec2::new(8.0, 1.0),
        };
        let label = |bounds| SheetLayout::new(5, bounds, None).label_px;
        assert_eq!(time_label(flat), time_label(square()));
    }
}
