//! Contact sheet that compares methods on one pair of designs: one row per method, the same t in
//! each column.
//!
//! Guarantees: all rows show the plane at the same scale; names, frames and labels do not overlap;
//! a method that failed shows its error message instead of frames.

use crate::colour::Rgb;
use crate::content::ContentKind;
use crate::geometry::{Bounds, DVec2};
use crate::measure::FilmRating;
use crate::transition::{
    BuildError, Transition, TransitionMethod, TransitionSpec, TransitionStyle,
};
use crate::work::progress::{Cancelled, Progress};

use super::camera::framing;
use super::drawing::Drawing;
use super::labels::{ERROR_COLOUR, LabelBox, LabelStyle, text_colour_on, time_label};
use super::size::{MAX_SHEET_SIDE_PX, PixelSize, PixelSizeError};
use super::view::PlaneView;

/// Longer side of a frame in pixels, unless the sheet would become too large (heuristic).
const CELL_PX: f64 = 220.0;

/// Gap between frames and around them, in pixels (heuristic).
const GAP_PX: f64 = 16.0;

/// Width of the column of method names, in pixels (heuristic).
const NAMES_PX: f64 = 180.0;

/// Style of names, labels and error messages.
const LABEL_STYLE: LabelStyle = LabelStyle {
    font_px: 15.0,
    line_px: 20.0,
};

/// Line height of method names and of t labels, in pixels.
const LINE_PX: f64 = LABEL_STYLE.line_px;

/// Style of the rating below a method's name.
const REMARK_STYLE: LabelStyle = LabelStyle {
    font_px: 12.0,
    line_px: 15.0,
};

/// Text colour of the best rating (heuristic: readable on light and on dark backgrounds).
const BEST_COLOUR: Rgb = Rgb([0x2e, 0x8b, 0x57]);

/// One method on the sheet.
#[derive(Clone, Debug)]
pub struct MethodRow {
    /// Name of the method.
    pub name: String,
    /// The transition, or the error message if it could not be built.
    pub transition: Result<Transition, String>,
    /// Rating of the animation; `None` for raster images and for methods that failed.
    pub rating: Option<FilmRating>,
}

impl MethodRow {
    /// Builds and rates the transition between two designs with every applicable method. If the
    /// requested method is for raster images, only methods for raster images are compared;
    /// otherwise only methods for shapes: silhouettes of photographs are not meaningful.
    ///
    /// # Errors
    /// [`Cancelled`] if the work was cancelled. If a method fails, its row contains the error
    /// message.
    pub fn all(spec: &TransitionSpec, progress: &dyn Progress) -> Result<Vec<Self>, Cancelled> {
        let is_colours = |cell: TransitionMethod| cell.content() == ContentKind::Colours;
        let suits = |cell: &TransitionMethod| {
            is_colours(*cell) == is_colours(spec.method)
                && TransitionSpec::available(*cell, &spec.source, &spec.target).is_ok()
        };
        let row = |cell: TransitionMethod| {
            let spec = TransitionSpec {
                method: cell,
                ..spec.clone()
            };
            let transition = match Transition::build(&spec, progress) {
                Err(BuildError::Cancelled(cancelled)) => return Err(cancelled),
                built => built.map_err(|error| error.to_string()),
            };
            let rating = match &transition {
                Ok(transition) => FilmRating::of(transition, progress)?,
                Err(_) => None,
            };
            let name = cell.name().to_owned();
            Ok(Self {
                name,
                transition,
                rating,
            })
        };
        TransitionMethod::all().filter(suits).map(row).collect()
    }
}

/// Draws one row per method: its rating, and frames at the given t. The best rating is highlighted.
///
/// # Errors
/// [`PixelSizeError`] if there are more frames than fit on a sheet.
pub fn comparison_sheet(
    rows: &[MethodRow],
    style: &TransitionStyle,
    times: &[f64],
    ground: Option<Rgb>,
) -> Result<Drawing, PixelSizeError> {
    let built = rows.iter().filter_map(|row| row.transition.as_ref().ok());
    let all_bounds = built.map(|transition| framing(transition, times));
    // All methods share one framing so that they can be compared by eye.
    let bounds = all_bounds.reduce(|a, b| a.union(&b));
    let cell = cell(bounds, rows.len(), times.len());
    let step = cell + DVec2::splat(GAP_PX);
    let corner = DVec2::new(NAMES_PX + 2.0 * GAP_PX, GAP_PX);
    let count = DVec2::new(times.len() as f64, rows.len() as f64);
    let size = corner + count * step + DVec2::new(0.0, LINE_PX + GAP_PX);
    let mut drawing = Drawing::new(PixelSize::rounded_up(size)?, ground);
    let ink = text_colour_on(ground);
    let ratings: Vec<Option<FilmRating>> = rows.iter().map(|row| row.rating).collect();
    let best = FilmRating::index_of_best(&ratings);
    for (k, row) in rows.iter().enumerate() {
        let left = DVec2::new(corner.x, corner.y + k as f64 * step.y);
        let name_corner = DVec2::new(GAP_PX, left.y + 0.5 * cell.y - 2.0 * LINE_PX);
        push_name(&mut drawing, row, best == Some(k), name_corner);
        match (&row.transition, bounds) {
            (Ok(transition), Some(bounds)) => {
                let mut frame = transition.frame(0.0);
                for (i, &t) in times.iter().enumerate() {
                    frame.seek(t);
                    let at = left + DVec2::new(i as f64 * step.x, 0.0);
                    let view = PlaneView::fit_cell(bounds, drawing.size, at, cell);
                    drawing.push_frame(&frame, style, &view);
                }
            }
            (Err(reason), _) => {
                let area = LabelBox {
                    corner: DVec2::new(left.x, name_corner.y),
                    width_px: times.len() as f64 * step.x,
                    max_lines: 4,
                };
                LABEL_STYLE.push(&mut drawing, reason, area, ERROR_COLOUR);
            }
            // There are bounds if at least one transition was built, so this case does not occur.
            (Ok(_), None) => {}
        }
    }
    let middle = DVec2::new(0.5 * cell.x, count.y * step.y + LABEL_STYLE.font_px);
    for (i, &t) in times.iter().enumerate() {
        let base = corner + middle + DVec2::new(i as f64 * step.x, 0.0);
        drawing.push_label(&time_label(t), base, LABEL_STYLE.font_px, ink);
    }
    Ok(drawing)
}

/// Draws the name of a method, and below it the rating.
fn push_name(drawing: &mut Drawing, row: &MethodRow, is_best: bool, corner: DVec2) {
    let ink = text_colour_on(drawing.ground);
    let name_area = LabelBox {
        corner,
        width_px: NAMES_PX,
        max_lines: 2,
    };
    let name_lines = LABEL_STYLE.push(drawing, &row.name, name_area, ink);
    let Some(rating) = &row.rating else {
        return;
    };
    let (words, colour) = match is_best {
        true => (format!("Best: {rating}"), BEST_COLOUR),
        false => (rating.to_string(), ink),
    };
    let rating_area = LabelBox {
        corner: corner + DVec2::new(0.0, name_lines as f64 * LINE_PX),
        width_px: NAMES_PX,
        max_lines: 3,
    };
    REMARK_STYLE.push(drawing, &words, rating_area, colour);
}

/// Returns the width and height of a cell, which shows one frame, in pixels.
fn cell(bounds: Option<Bounds>, rows: usize, columns: usize) -> DVec2 {
    let size = bounds.map_or(DVec2::ONE, |bounds| bounds.size());
    // The sides of a cell have a ratio of at most 5:1, even for more elongated designs.
    let shape = (size / size.max_element()).max(DVec2::splat(0.2));
    let count = DVec2::new(columns.max(1) as f64, rows.max(1) as f64);
    let room = (DVec2::splat(MAX_SHEET_SIDE_PX - NAMES_PX - 8.0 * GAP_PX) / count - GAP_PX) / shape;
    // Rows are high enough for a two-line name and a three-line rating.
    let min_height = 2.0 * LINE_PX + 3.0 * REMARK_STYLE.line_px;
    (shape * CELL_PX.min(room.min_element()).max(16.0)).max(DVec2::new(16.0, min_height))
}
