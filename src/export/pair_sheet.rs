//! A contact sheet of many pairs: a strip of frames for each, its name and a
//! few words beside it.
//!
//! Guarantees: names, words and frames do not overlap, whatever their length;
//! what does not fit ends in an ellipsis; the sheet keeps within
//! [`MAX_SHEET_SIDE_PX`] by smaller frames, then by leaving out the last strips,
//! which it says. Strips run down in blocks that make the sheet a little wider
//! than high.

use crate::colour::Rgb;
use crate::geometry::{Bounds, DVec2};
use crate::transition::{Transition, TransitionStyle, VectorFigure};

use super::camera::framing;
use super::drawing::Drawing;
use super::labels::{ERROR_COLOUR, LabelStyle, text_colour_on};
use super::size::{MAX_SHEET_SIDE_PX, PixelSize, PixelSizeError};
use super::view::PlaneView;

/// Sides of a frame, in pixels: the largest with which all strips fit.
const CELLS_PX: [f64; 4] = [104.0, 84.0, 64.0, 48.0];

/// Room between frames and around a strip, in pixels.
const GAP_PX: f64 = 8.0;

/// Width of the words beside a strip, in pixels.
const WORDS_PX: f64 = 230.0;

/// How the words are set.
const TYPE: LabelStyle = LabelStyle {
    letters_px: 13.0,
    line_px: 16.0,
};
const LINE_PX: f64 = TYPE.line_px;

/// Room for so many frames is there at least, for the words of pairs that
/// have none.
const FEWEST_COLUMNS: usize = 5;

/// Width by height that a sheet comes near to.
const SHAPE: f64 = 1.4;

/// One pair on the sheet.
///
/// ```
/// use morphospace::export::{Strip, pair_sheet};
/// let strips = [Strip::failed("a to b", "a.svg cannot be read")];
/// let (drawing, shown) = pair_sheet(&strips, None)?;
/// assert_eq!(shown, 1);
/// # Ok::<(), morphospace::export::SizeError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct PairStrip {
    name: String,
    words: String,
    is_bad: bool,
    frames: Vec<(VectorFigure, f64)>,
    style: TransitionStyle,
    bounds: Option<Bounds>,
}

impl PairStrip {
    /// Frames of a transition at the given t, with words under its name.
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

    /// A pair of which there are no frames, for the reason given.
    #[must_use]
    pub fn failed(name: &str, reason: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default().saying(reason, true)
        }
    }

    /// With words under the name, marked where they tell of something bad.
    #[must_use]
    pub fn saying(self, words: &str, is_bad: bool) -> Self {
        Self {
            words: words.to_owned(),
            is_bad,
            ..self
        }
    }
}

/// Where everything is.
#[derive(Clone, Copy, Debug)]
struct PairSheetLayout {
    cell_px: f64,
    columns: usize,
    rows: usize,
    blocks: usize,
}

impl PairSheetLayout {
    /// With the largest frames with which `strips` of them fit, or else the
    /// smallest ones.
    fn new(strips: usize, columns: usize) -> Self {
        let layouts = CELLS_PX.map(|cell_px| Self::balanced(strips.max(1), columns, cell_px));
        // Largest first: the first that fits is the one.
        let fits = |layout: &&Self| layout.size().max_element() <= MAX_SHEET_SIDE_PX;
        let fitting = layouts.iter().find(fits).copied();
        fitting.unwrap_or_else(|| Self::fullest(columns))
    }

    fn balanced(strips: usize, columns: usize, cell_px: f64) -> Self {
        let layout = |blocks: usize| Self {
            cell_px,
            columns,
            rows: strips.div_ceil(blocks),
            blocks,
        };
        let off = |layout: &Self| {
            let size = layout.size();
            // As a ratio: twice too wide is as bad as twice too high.
            (size.x / size.y / SHAPE).ln().abs()
        };
        let better = |a: Self, b: Self| if off(&b) < off(&a) { b } else { a };
        // More blocks than this are wider than the longest sheet.
        let most = strips.min(32);
        (2..=most).map(layout).fold(layout(1), better)
    }

    /// As many of the smallest frames as there is room for.
    fn fullest(columns: usize) -> Self {
        let one = Self {
            cell_px: CELLS_PX[CELLS_PX.len() - 1],
            columns,
            rows: 1,
            blocks: 1,
        };
        let strip = one.strip();
        let most = |side: f64| ((MAX_SHEET_SIDE_PX - 2.0 * GAP_PX) / side).max(1.0) as usize;
        Self {
            rows: most(strip.y),
            blocks: most(strip.x),
            ..one
        }
    }

    /// Width and height of a strip with its gap.
    fn strip(&self) -> DVec2 {
        let frames = self.columns as f64 * (self.cell_px + GAP_PX);
        let lines = 4.0 * LINE_PX;
        DVec2::new(
            WORDS_PX + frames + 6.0 * GAP_PX,
            // Four lines have room beside any frame: two of the name, two of
            // words.
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

    /// The upper left corner of a strip.
    fn corner(&self, index: usize) -> DVec2 {
        let place = DVec2::new((index / self.rows) as f64, (index % self.rows) as f64);
        place * self.strip() + DVec2::splat(GAP_PX)
    }
}

/// Draws strips one below the other in as many blocks as suit. Returns the
/// drawing and how many strips are on it: all, unless there are more than some
/// thousand.
///
/// # Errors
/// [`PixelSizeError`] if strips have so many frames that none fits.
pub fn pair_sheet(
    strips: &[PairStrip],
    ground: Option<Rgb>,
) -> Result<(Drawing, usize), PixelSizeError> {
    let frames = strips.iter().map(|s| s.frames.len());
    let columns = frames.max().unwrap_or(0).max(FEWEST_COLUMNS);
    let layout = PairSheetLayout::new(strips.len(), columns);
    let mut drawing = Drawing::new(PixelSize::holding(layout.size())?, ground);
    let shown = strips.len().min(layout.capacity());
    for (index, strip) in strips[..shown].iter().enumerate() {
        push_strip(&mut drawing, strip, &layout, layout.corner(index));
    }
    Ok((drawing, shown))
}

fn push_strip(drawing: &mut Drawing, strip: &PairStrip, layout: &PairSheetLayout, corner: DVec2) {
    let ink = text_colour_on(drawing.ground);
    let words = if strip.is_bad { ERROR_COLOUR } else { ink };
    let lines = ((layout.strip().y - GAP_PX) / LINE_PX) as usize;
    let named = TYPE.push(drawing, &strip.name, (WORDS_PX, lines.min(2)), corner, ink);
    let below = corner + DVec2::new(0.0, named as f64 * LINE_PX);
    let frames = corner + DVec2::new(WORDS_PX + 2.0 * GAP_PX, 0.0);
    let step = layout.cell_px + GAP_PX;
    let Some(bounds) = strip.bounds else {
        let room = (layout.columns as f64 * step, lines);
        TYPE.push(drawing, &strip.words, room, frames, words);
        return;
    };
    TYPE.push(
        drawing,
        &strip.words,
        (WORDS_PX, lines - named),
        below,
        words,
    );
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
    fn sixty_pairs_are_a_picture_of_a_picture_s_shape() {
        let size = PairSheetLayout::new(60, 7).size();
        let ratio = size.x / size.y;
        assert!(
            (0.8..2.2).contains(&ratio) && size.max_element() < 5_000.0,
            "{size}"
        );
    }
}
