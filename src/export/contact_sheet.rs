//! Contact sheet: frames side by side with their t below, as printed in figures of papers.
//!
//! Guarantees: all cells have the same scale; frames run left to right and top to bottom, and an
//! incomplete last row is aligned left. The result is a [`Drawing`] like any other, so PNG and SVG
//! show the same.

use crate::colour::Rgb;
use crate::geometry::{Bounds, DVec2};
use crate::transition::{Sequence, TransitionStyle};

use super::drawing::Drawing;
use super::labels::{text_colour_on, time_label};
use super::size::{MAX_SHEET_SIDE_PX, PixelSize};
use super::view::PlaneView;

/// Longer side of a cell in pixels if the size of the sheet is not given (heuristic).
const CELL_PX: u32 = 240;

/// Maximum number of cells per row if the size of the sheet is not given (heuristic).
const MAX_COLUMNS: usize = 6;

/// Height of a label line, as a fraction of the longer side of a cell (heuristic: 17 pixels for a
/// side of 240). The longer side is used so that elongated designs have labels as large as those of
/// square designs.
const LABEL_SHARE: f64 = 0.07;

/// Maximum label height as a fraction of its cell's height, and maximum gap as a fraction of the
/// cell's shorter side (heuristic).
const MAX_LABEL_SHARE: f64 = 0.3;

/// In a grid, the height of a label line is the number of rows times this fraction of the longer
/// side of a cell, so that labels of large grids are larger (heuristic).
const GRID_LABEL_SHARE: f64 = 0.013;

/// Gap between cells, as a fraction of the longer side of a cell (heuristic).
const GAP_SHARE: f64 = 0.06;

/// Arrangement of the cells of a sheet, and their size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetLayout {
    /// Size of the whole sheet.
    pub size: PixelSize,
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Height of a label line, in pixels.
    label_px: f64,
    /// Gap between cells, in pixels.
    gap_px: f64,
}

impl SheetLayout {
    /// Arranges `count` cells (at least 1) that show `bounds`.
    ///
    /// If `size` is given, chooses the number of columns with which the images are largest.
    /// Otherwise, fills rows of at most six cells evenly and makes the sheet as large as the cells
    /// need.
    pub fn new(count: usize, bounds: Bounds, size: Option<PixelSize>) -> Self {
        let count = count.max(1);
        let cell = PixelSize::of_shape(bounds, CELL_PX).as_dvec2();
        match size {
            Some(size) => filling_layout(count, cell, size),
            None => balanced_layout(count, cell),
        }
    }

    /// Arranges a grid of `columns` × `rows` cells (both at least 1) that show `bounds`. The sheet
    /// has the given size; without one, it is as large as the cells need.
    pub fn grid([columns, rows]: [usize; 2], bounds: Bounds, size: Option<PixelSize>) -> Self {
        let (columns, rows) = (columns.max(1), rows.max(1));
        // A large grid is viewed as a whole, so its labels must be legible from farther away.
        let label = (GRID_LABEL_SHARE * rows as f64).clamp(LABEL_SHARE, MAX_LABEL_SHARE);
        match size {
            Some(size) => Self::filling(size, [columns, rows], label),
            None => {
                let cell = PixelSize::of_shape(bounds, CELL_PX).as_dvec2();
                natural_layout([columns, rows], cell, label)
            }
        }
    }

    /// Returns the font size of a label, in pixels.
    pub(super) fn letters_px(&self) -> f64 {
        0.8 * self.label_px
    }

    /// Returns the layout in which `columns` × `rows` cells fill a sheet of the given size. `label`
    /// is the label height as a fraction of the longer side of a cell.
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

    /// Returns the maximum width and the font size of a label below an image of the given size, in
    /// pixels. The label may extend almost to the label of the neighbouring cell.
    pub(super) fn label_room(&self, picture: DVec2) -> [f64; 2] {
        [picture.x + 0.8 * self.gap_px, self.letters_px()]
    }

    /// Returns the upper left corner and the size of the image in the cell with the given index,
    /// and the centre of the baseline of its label, all in pixels.
    pub(super) fn cell(&self, index: usize) -> (DVec2, DVec2, DVec2) {
        let counts = DVec2::new(self.columns as f64, self.rows as f64);
        let whole = self.size.as_dvec2() / counts;
        let place = DVec2::new((index % self.columns) as f64, (index / self.columns) as f64);
        let corner = place * whole + DVec2::splat(0.5 * self.gap_px);
        let inner = whole - DVec2::new(self.gap_px, self.gap_px + self.label_px);
        let base = corner + DVec2::new(0.5 * inner.x, inner.y + 0.8 * self.label_px);
        // On a sheet of a few pixels, the size of the image could be 0 or negative.
        (corner, inner.max(DVec2::ONE), base)
    }
}

/// Returns the layout of `count` cells in as few rows as possible, filled as evenly as possible.
/// Cells have the size `cell`, in pixels, or are scaled down if the sheet would exceed its size
/// limit.
fn balanced_layout(count: usize, cell: DVec2) -> SheetLayout {
    let rows = count.div_ceil(MAX_COLUMNS);
    natural_layout([count.div_ceil(rows), rows], cell, LABEL_SHARE)
}

/// Returns the layout of `columns` × `rows` cells. Cells have the size `cell`, in pixels, or are
/// scaled down if the sheet would exceed its size limit. `label` is the label height as a fraction
/// of [`CELL_PX`].
fn natural_layout([columns, rows]: [usize; 2], cell: DVec2, label: f64) -> SheetLayout {
    let unit = f64::from(CELL_PX);
    let (label_px, gap_px) = (label * unit, GAP_SHARE * unit);
    let cell_with_gap = cell + DVec2::new(gap_px, gap_px + label_px);
    let natural = cell_with_gap * DVec2::new(columns as f64, rows as f64);
    // Labels and gaps are scaled along with the cells.
    let scale = (MAX_SHEET_SIDE_PX / natural.max_element()).min(1.0);
    let sides = (natural * scale).round().max(DVec2::ONE);
    let size = PixelSize::rounded_up(sides)
        .unwrap_or_else(|error| unreachable!("the sheet was scaled to fit: {error}"));
    SheetLayout {
        size,
        columns,
        rows,
        label_px: label_px * scale,
        gap_px: gap_px * scale,
    }
}

/// Returns the layout on a sheet of the given size with the number of columns that makes the images
/// largest.
fn filling_layout(count: usize, cell: DVec2, size: PixelSize) -> SheetLayout {
    let layout = |columns: usize| {
        SheetLayout::filling(size, [columns, count.div_ceil(columns)], LABEL_SHARE)
    };
    let scale = |layout: &SheetLayout| {
        let (_, inner, _) = layout.cell(0);
        (inner / cell).min_element()
    };
    // Of several layouts with equally large images, the one with the fewest columns is used.
    let better = |a: SheetLayout, b: SheetLayout| if scale(&b) > scale(&a) { b } else { a };
    (2..=count).map(layout).fold(layout(1), better)
}

/// Draws the frames at the given values of t into one sheet.
///
/// `bounds` is the part of the plane that each cell shows, in the units of the designs.
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
        drawing.push_frame(frame.frame(), &frame.style(style), &view);
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
    fn a_given_size_is_filled_with_the_largest_cells() {
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
    fn labels_of_flat_designs_are_as_large_as_those_of_square_ones() {
        let flat = Bounds {
            min: DVec2::ZERO,
            max: DVec2::new(8.0, 1.0),
        };
        let label = |bounds| SheetLayout::new(5, bounds, None).label_px;
        assert_eq!(label(flat), label(square()));
    }
}
