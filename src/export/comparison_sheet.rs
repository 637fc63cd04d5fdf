//! A contact sheet of one pair by several methods: a row for each, the same t
//! in each column.
//!
//! Guarantees: all rows show the plane at one scale; names, frames and values
//! of t do not overlap; a method that failed has its reason in place of
//! frames.

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
use super::labels::{ERROR_COLOUR, LabelStyle, text_colour_on, time_label};
use super::size::{MAX_SHEET_SIDE_PX, PixelSize, PixelSizeError};
use super::view::PlaneView;

/// The longer side of a frame, in pixels, where there is room for it.
const CELL_PX: f64 = 220.0;

/// Room between frames and around them, in pixels.
const GAP_PX: f64 = 16.0;

/// Width of the names, in pixels.
const NAMES_PX: f64 = 180.0;

/// How the words are set.
const TYPE: LabelStyle = LabelStyle {
    letters_px: 15.0,
    line_px: 20.0,
};
const LINE_PX: f64 = TYPE.line_px;

/// How it is told how much trouble a film is.
const REMARK: LabelStyle = LabelStyle {
    letters_px: 12.0,
    line_px: 15.0,
};

/// The colour of the one with the least: readable on light and on dark.
const BEST: Rgb = Rgb([0x2e, 0x8b, 0x57]);

/// A method on the sheet.
#[derive(Clone, Debug)]
pub struct MethodRow {
    /// What it is called.
    pub name: String,
    /// The pair by this method, or why there is none, in words.
    pub transition: Result<Transition, String>,
    /// How much trouble its film is; none of pictures, and where there is none.
    pub rating: Option<FilmRating>,
}

impl MethodRow {
    /// A pair by every method that can show it: the specification by each cell
    /// of the table. Pictures are compared with pictures, shapes with shapes:
    /// silhouettes of photographs say little.
    ///
    /// # Errors
    /// [`Cancelled`]; a method that fails has its reason in its row.
    pub fn all(spec: &TransitionSpec, progress: &dyn Progress) -> Result<Vec<Self>, Cancelled> {
        let is_colours = |cell: TransitionMethod| cell.content() == ContentKind::Colours;
        let suits = |cell: &TransitionMethod| {
            is_colours(*cell) == is_colours(spec.cell)
                && TransitionSpec::available(*cell, &spec.source, &spec.target).is_ok()
        };
        let row = |cell: TransitionMethod| {
            let spec = TransitionSpec {
                cell,
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

/// Draws a row for each method at the given t, tells of each how much trouble its
/// film is, and marks the one with the least.
///
/// # Errors
/// [`PixelSizeError`] for more frames than a sheet can have.
pub fn comparison_sheet(
    rows: &[MethodRow],
    style: &TransitionStyle,
    times: &[f64],
    ground: Option<Rgb>,
) -> Result<Drawing, PixelSizeError> {
    let built = rows.iter().filter_map(|row| row.transition.as_ref().ok());
    let bounds = built.map(|transition| framing(transition, times));
    // One frame around all methods, so that they can be compared by eye.
    let bounds = bounds.reduce(|a, b| a.union(&b));
    let cell = cell(bounds, rows.len(), times.len());
    let step = cell + DVec2::splat(GAP_PX);
    let corner = DVec2::new(NAMES_PX + 2.0 * GAP_PX, GAP_PX);
    let count = DVec2::new(times.len() as f64, rows.len() as f64);
    let size = corner + count * step + DVec2::new(0.0, LINE_PX + GAP_PX);
    let mut drawing = Drawing::new(PixelSize::holding(size)?, ground);
    let ink = text_colour_on(ground);
    let ratings: Vec<Option<FilmRating>> = rows.iter().map(|row| row.rating).collect();
    let best = FilmRating::best(&ratings);
    for (k, row) in rows.iter().enumerate() {
        let left = DVec2::new(corner.x, corner.y + k as f64 * step.y);
        let name_at = DVec2::new(GAP_PX, left.y + 0.5 * cell.y - 2.0 * LINE_PX);
        let named = TYPE.push(&mut drawing, &row.name, (NAMES_PX, 2), name_at, ink);
        if let Some(rating) = &row.rating {
            let (words, colour) = match best == Some(k) {
                true => (format!("Least trouble: {rating}"), BEST),
                false => (rating.to_string(), ink),
            };
            let below = name_at + DVec2::new(0.0, named as f64 * LINE_PX);
            REMARK.push(&mut drawing, &words, (NAMES_PX, 3), below, colour);
        }
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
                let room = times.len() as f64 * step.x;
                let at = DVec2::new(left.x, name_at.y);
                TYPE.push(&mut drawing, reason, (room, 4), at, ERROR_COLOUR);
            }
            // Where one was built there are bounds.
            (Ok(_), None) => {}
        }
    }
    let middle = DVec2::new(0.5 * cell.x, count.y * step.y + TYPE.letters_px);
    for (i, &t) in times.iter().enumerate() {
        let base = corner + middle + DVec2::new(i as f64 * step.x, 0.0);
        drawing.push_label(&time_label(t), base, TYPE.letters_px, ink);
    }
    Ok(drawing)
}

/// Width and height of a frame.
fn cell(bounds: Option<Bounds>, rows: usize, columns: usize) -> DVec2 {
    let size = bounds.map_or(DVec2::ONE, |bounds| bounds.size());
    let shape = (size / size.max_element()).max(DVec2::splat(0.2));
    let count = DVec2::new(columns.max(1) as f64, rows.max(1) as f64);
    let room = (DVec2::splat(MAX_SHEET_SIDE_PX - NAMES_PX - 8.0 * GAP_PX) / count - GAP_PX) / shape;
    // Rows are high enough for a name and what is told of it.
    let words = 2.0 * LINE_PX + 3.0 * REMARK.line_px;
    (shape * CELL_PX.min(room.min_element()).max(16.0)).max(DVec2::new(16.0, words))
}
