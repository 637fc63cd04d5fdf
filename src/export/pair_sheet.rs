//! Contact sheet of many pairs: one strip of frames per pair, next to its name and a remark.
//!
//! Guarantees: names, remarks and frames do not overlap, and text that does not fit ends in an
//! ellipsis. The sides of the sheet are at most [`MAX_SHEET_SIDE_PX`]: if there are many strips,
//! frames become smaller, and finally the last strips are omitted. Strips are stacked in blocks,
//! which stand next to each other so that the sheet is a little wider than high.

use crate::colour::Rgb;
use crate::geometry::{Bounds, DVec2};
use crate::transition::{Transition, TransitionStyle, VectorFigure};

use super::camera::framing;
use super::drawing::Drawing;
use super::labels::{ERROR_COLOUR, LabelBox, LabelStyle, text_colour_on};
use super::size::{MAX_SHEET_SIDE_PX, PixelSize, PixelSizeError};
use super::view::PlaneView;

/// Possible side lengths of a frame, in pixels, the largest first. The largest side with which all
/// strips fit on the sheet is used (heuristic).
const CELLS_PX: [f64; 4] = [104.0, 84.0, 64.0, 48.0];

/// Gap between frames and around a strip, in pixels (heuristic).
const GAP_PX: f64 = 8.0;

/// Width of the text column next to a strip, in pixels (heuristic).
const WORDS_PX: f64 = 230.0;

/// Style of names and remarks.
const LABEL_STYLE: LabelStyle = LabelStyle {
    font_px: 13.0,
    line_px: 16.0,
};

/// Line height of names and remarks, in pixels.
const LINE_PX: f64 = LABEL_STYLE.line_px;

/// Minimum number of frames for which each strip has room. The error message of a failed pair needs
/// the width of that many frames (heuristic).
const MIN_COLUMNS: usize = 5;

/// Preferred ratio of width to height of a sheet (heuristic).
const TARGET_RATIO: f64 = 1.4;

/// Strip of one pair on the sheet.
///
/// ```
/// use morphospace::export::{PairStrip, pair_sheet};
/// let strips = [PairStrip::failed("a to b", "a.svg cannot be read")];
/// let (drawing, shown) = pair_sheet(&strips, None)?;
/// assert_eq!(shown, 1);
/// # Ok::<(), morphospace::export::PixelSizeError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct PairStrip {
    name: String,
    /// Remark below the name, or the error message of a failed pair.
    remark: String,
    is_bad: bool,
    /// For each frame: its vector shapes, and its t.
    frames: Vec<(VectorFigure, f64)>,
    style: TransitionStyle,
    bounds: Option<Bounds>,
}

impl PairStrip {
    /// Creates a strip with frames of a transition at the given t.
    #[must_use]
    pub fn of(name: &str, transition: &Transition, style: &TransitionStyle, times: &[f64]) -> Self {
        let mut frame = transition.frame(0.0);
        let mut shoot = |&t: &f64| {
            frame.seek(t);
            (frame.figure(), t)
        };
        Self {
            name: name.to_owned(),
            frames: times.iter().map(&mut shoot).collect(),
            style: *style,
            bounds: Some(framing(transition, times)),
            ..Self::default()
        }
    }

    /// Creates a strip with an error message instead of frames.
    #[must_use]
    pub fn failed(name: &str, reason: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default().with_remark(reason, true)
        }
    }

    /// Sets the remark below the name; it is shown in the error colour if `is_bad`.
    #[must_use]
    pub fn with_remark(self, words: &str, is_bad: bool) -> Self {
        Self {
            remark: words.to_owned(),
            is_bad,
            ..self
        }
    }
}

/// Arrangement of the strips on the sheet. A strip is the row of frames of one pair. Strips are
/// stacked one below the other to form a block, and the blocks stand next to each other.
#[derive(Clone, Copy, Debug)]
struct PairSheetLayout {
    /// Side of a frame, in pixels.
    cell_px: f64,
    /// Number of frames for which each strip has room.
    columns: usize,
    /// Number of strips per block, one below the other.
    rows: usize,
    /// Number of blocks next to each other.
    blocks: usize,
}

impl PairSheetLayout {
    /// Returns the layout with the largest frames with which all `strips` fit. If they do not fit,
    /// returns the layout with the smallest frames and as many strips as fit.
    fn new(strips: usize, columns: usize) -> Self {
        let layouts = CELLS_PX.map(|cell_px| Self::balanced(strips.max(1), columns, cell_px));
        // `CELLS_PX` is in descending order, so the first layout that fits has the largest frames.
        let fits = |layout: &&Self| layout.size().max_element() <= MAX_SHEET_SIDE_PX;
        let fitting = layouts.iter().find(fits).copied();
        fitting.unwrap_or_else(|| Self::fullest(columns))
    }

    /// Returns the layout whose number of blocks brings the sheet closest to the preferred ratio of
    /// width to height.
    fn balanced(strips: usize, columns: usize, cell_px: f64) -> Self {
        let layout = |blocks: usize| Self {
            cell_px,
            columns,
            rows: strips.div_ceil(blocks),
            blocks,
        };
        let ratio_error = |layout: &Self| {
            let size = layout.size();
            // The logarithm makes a sheet twice too wide as bad as one twice too high.
            (size.x / size.y / TARGET_RATIO).ln().abs()
        };
        let better = |a: Self, b: Self| {
            if ratio_error(&b) < ratio_error(&a) {
                b
            } else {
                a
            }
        };
        // A sheet of more than 32 blocks would exceed the maximum width.
        let max_blocks = strips.min(32);
        (2..=max_blocks).map(layout).fold(layout(1), better)
    }

    /// Returns the layout with the smallest frames and as many strips as fit on a sheet.
    fn fullest(columns: usize) -> Self {
        let one = Self {
            cell_px: CELLS_PX[CELLS_PX.len() - 1],
            columns,
            rows: 1,
            blocks: 1,
        };
        let strip = one.strip();
        let max_count = |side: f64| ((MAX_SHEET_SIDE_PX - 2.0 * GAP_PX) / side).max(1.0) as usize;
        Self {
            rows: max_count(strip.y),
            blocks: max_count(strip.x),
            ..one
        }
    }

    /// Returns the width and height of a strip, including the gap to the next strip, in pixels.
    fn strip(&self) -> DVec2 {
        let frames = self.columns as f64 * (self.cell_px + GAP_PX);
        let lines = 4.0 * LINE_PX;
        DVec2::new(
            WORDS_PX + frames + 6.0 * GAP_PX,
            // Even next to the smallest frame there is room for four lines: two for the name and
            // two for the remark.
            self.cell_px.max(lines) + 1.5 * GAP_PX,
        )
    }

    fn size(&self) -> DVec2 {
        let counts = DVec2::new(self.blocks as f64, self.rows as f64);
        self.strip() * counts + DVec2::splat(2.0 * GAP_PX)
    }

    fn capacity(&self) -> usize {
        self.rows * self.blocks
    }

    /// Returns the upper left corner of a strip, in pixels.
    fn corner(&self, index: usize) -> DVec2 {
        let place = DVec2::new((index / self.rows) as f64, (index % self.rows) as f64);
        place * self.strip() + DVec2::splat(GAP_PX)
    }
}

/// Draws strips one below the other, in one or more blocks next to each other. Returns the drawing
/// and the number of strips that fit on it; only with thousands of strips, some do not fit.
///
/// # Errors
/// [`PixelSizeError`] if a single strip has more frames than fit on a sheet.
pub fn pair_sheet(
    strips: &[PairStrip],
    ground: Option<Rgb>,
) -> Result<(Drawing, usize), PixelSizeError> {
    let frames = strips.iter().map(|s| s.frames.len());
    let columns = frames.max().unwrap_or(0).max(MIN_COLUMNS);
    let layout = PairSheetLayout::new(strips.len(), columns);
    let mut drawing = Drawing::new(PixelSize::rounded_up(layout.size())?, ground);
    let shown = strips.len().min(layout.capacity());
    for (index, strip) in strips[..shown].iter().enumerate() {
        push_strip(&mut drawing, strip, &layout, layout.corner(index));
    }
    Ok((drawing, shown))
}

fn push_strip(drawing: &mut Drawing, strip: &PairStrip, layout: &PairSheetLayout, corner: DVec2) {
    let ink = text_colour_on(drawing.ground);
    let words_colour = if strip.is_bad { ERROR_COLOUR } else { ink };
    let lines = ((layout.strip().y - GAP_PX) / LINE_PX) as usize;
    let name_area = LabelBox {
        corner,
        width_px: WORDS_PX,
        max_lines: lines.min(2),
    };
    let name_lines = LABEL_STYLE.push(drawing, &strip.name, name_area, ink);
    let below = corner + DVec2::new(0.0, name_lines as f64 * LINE_PX);
    let frames = corner + DVec2::new(WORDS_PX + 2.0 * GAP_PX, 0.0);
    let step = layout.cell_px + GAP_PX;
    let Some(bounds) = strip.bounds else {
        let words_area = LabelBox {
            corner: frames,
            width_px: layout.columns as f64 * step,
            max_lines: lines,
        };
        LABEL_STYLE.push(drawing, &strip.remark, words_area, words_colour);
        return;
    };
    let words_area = LabelBox {
        corner: below,
        width_px: WORDS_PX,
        max_lines: lines - name_lines,
    };
    LABEL_STYLE.push(drawing, &strip.remark, words_area, words_colour);
    for (i, (figure, t)) in strip.frames.iter().enumerate() {
        let at = frames + DVec2::new(i as f64 * step, 0.0);
        let view = PlaneView::fit_cell(bounds, drawing.size, at, DVec2::splat(layout.cell_px));
        drawing.push_figure(figure, *t, &strip.style, &view);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_do_not_overlap_and_stay_on_the_sheet() {
        for count in [1, 2, 7, 60, 120, 600, 100_000] {
            let layout = PairSheetLayout::new(count, 7);
            let size = layout.size();
            assert!(size.max_element() <= MAX_SHEET_SIDE_PX, "{count}: {size}");
            let shown = count.min(layout.capacity());
            assert!(shown == count || shown > 1_000, "{count}: {shown}");
            for index in [0, shown / 2, shown - 1] {
                let corner = layout.corner(index);
                assert!((corner + layout.strip()).cmple(size).all(), "{count}");
                assert!(corner.min_element() >= 0.0);
            }
        }
    }

    #[test]
    fn sixty_pairs_make_a_sheet_of_ordinary_shape() {
        let size = PairSheetLayout::new(60, 7).size();
        let ratio = size.x / size.y;
        assert!(
            (0.8..2.2).contains(&ratio) && size.max_element() < 5_000.0,
            "{size}"
        );
    }
}
