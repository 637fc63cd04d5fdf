//! Records a film as animation pieces: intervals of t with polynomial motion. The film is drawn by
//! a [`Camera`], which holds the transitions, their style and the part of the plane to show.
//!
//! In each interval of t, the path of each point is fitted by a Chebyshev series, and the series
//! are tested at moments not used for the fit. If they are not accurate enough, the interval is
//! bisected. A moment at which shapes appear or disappear is located by bisection, and the interval
//! is split there.

use crate::content::Content;
use crate::geometry::DVec2;
use crate::transition::SequenceFrame;
use crate::work::progress::{Progress, checkpoint};

use super::super::camera::{Camera, DRAWING_STAGE};
use super::super::error::ExportError;
use super::super::film_spec::FilmSpec;
use super::chebyshev::{chebyshev_nodes, evaluate, interpolate, truncate_series};
use super::piece::{AnimationPiece, MovingShape};
use super::shape::PosedShape;

/// Maximum distance of a point of a series from the same point of the drawing, at the tested
/// moments, in pixels (tolerance: a tenth of `VectorAnimation::TOLERANCE_PX`).
const FIT_TOLERANCE_PX: f64 = 0.02;

/// Maximum displacement of a point by dropping the last terms of its series, in pixels (tolerance:
/// half of [`FIT_TOLERANCE_PX`]).
const TRUNCATION_PX: f64 = 0.01;

/// Largest jump of a point from one animation piece to the next, in pixels, with which the second
/// piece still counts as a continuation of the first (tolerance: half of
/// `VectorAnimation::TOLERANCE_PX`).
const JUMP_PX: f64 = 0.1;

/// Precision with which the t of an appearance or a disappearance of a shape is located, as a
/// fraction of the range of t of the film (tolerance: well below one frame).
const CHANGE_PRECISION: f64 = 1e-6;

/// Length below which an interval is not bisected any further, as a fraction of the range of t of
/// the film (resource limit: motion within such an interval becomes a jump).
const MIN_LENGTH: f64 = 1e-4;

/// Maximum number of animation pieces (resource limit: bounds the export time and the size of the
/// file). Films that would need more are stored frame by frame.
const MAX_PIECES: usize = 400;

/// Stride, in frames, at which contours are counted to estimate the number of animation pieces
/// (resource limit: each count draws a frame).
const PREVIEW_STRIDE: usize = 4;

/// Number of equal intervals into which an animation piece is divided. Colours, widths and
/// gradients are sampled at the ends of these intervals. If none of them changes within the piece,
/// there is only one sample (heuristic).
const LOOK_INTERVALS: usize = 16;

/// Maximum difference at which colours, widths and gradient numbers count as equal: relative for
/// values well above 1, absolute below (tolerance: half a step of an 8-bit colour).
const LOOK_TOLERANCE: f64 = 0.002;

/// Shapes of a drawing at one moment, the lowest first.
type ShapeSnapshot = Vec<PosedShape>;

/// Returns the animation pieces of a film, by ascending t.
pub(super) fn record(
    camera: &Camera,
    film: &FilmSpec,
    progress: &dyn Progress,
) -> Result<Vec<AnimationPiece>, ExportError> {
    let mut recorder = AnimationRecorder {
        camera,
        frame: camera.sequence.frame(0.0),
        progress,
        pieces: Vec::new(),
    };
    let mut has_correspondence = true;
    for transition in camera.sequence.segments() {
        match transition.content() {
            Content::Colours(_) => return Err(ExportError::NoOutlines),
            Content::Field(_) => has_correspondence = false,
            Content::Solid(_) => {}
        }
    }
    let mut times = film.times().to_vec();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let may_be_smooth = has_correspondence && recorder.min_changes(&times)? <= MAX_PIECES;
    let was_recorded = may_be_smooth && recorder.record_smooth(&times)?;
    if !was_recorded {
        recorder.record_frames(&times)?;
    }
    let mut pieces = recorder.pieces;
    for k in 1..pieces.len() {
        pieces[k].is_continuation = continues(&pieces[k - 1], &pieces[k]);
    }
    Ok(pieces)
}

/// Camera whose drawings are recorded, and the animation pieces recorded so far.
struct AnimationRecorder<'a> {
    camera: &'a Camera,
    frame: SequenceFrame,
    progress: &'a dyn Progress,
    pieces: Vec<AnimationPiece>,
}

impl AnimationRecorder<'_> {
    /// Returns the shapes of the drawing at `t`, split into constant data, points and appearance.
    fn moment(&mut self, t: f64) -> ShapeSnapshot {
        self.frame.seek(t);
        let items = self.camera.draw_frame(&self.frame).items;
        items.iter().filter_map(PosedShape::of).collect()
    }

    /// Stores each frame as an animation piece without motion. The piece extends halfway to the
    /// frames before and after it.
    fn record_frames(&mut self, times: &[f64]) -> Result<(), ExportError> {
        self.pieces.clear();
        for (k, &t) in times.iter().enumerate() {
            checkpoint(self.progress, DRAWING_STAGE, k as f64 / times.len() as f64)?;
            let before = times[k.saturating_sub(1)];
            let after = times[(k + 1).min(times.len() - 1)];
            let shapes = self.moment(t).into_iter().map(static_shape).collect();
            self.push(0.5 * (before + t), 0.5 * (t + after), shapes);
        }
        Ok(())
    }

    /// Returns a lower bound on the number of contours that appear or disappear. Each of these
    /// changes ends an animation piece, and dozens of frames must be evaluated to locate it.
    /// Locating thousands of changes would take minutes.
    fn min_changes(&mut self, times: &[f64]) -> Result<usize, ExportError> {
        let (mut changes, mut before) = (0, None);
        for &t in times.iter().step_by(PREVIEW_STRIDE) {
            checkpoint(self.progress, DRAWING_STAGE, 0.0)?;
            let outlines: usize = self.moment(t).iter().map(PosedShape::contour_count).sum();
            changes += before.map_or(0, |before| outlines.abs_diff(before));
            before = Some(outlines);
        }
        Ok(changes)
    }

    /// Records the whole range of t in smooth animation pieces. Returns `false` if there would be
    /// more than [`MAX_PIECES`].
    fn record_smooth(&mut self, times: &[f64]) -> Result<bool, ExportError> {
        let (Some(&from), Some(&to)) = (times.first(), times.last()) else {
            return Ok(true);
        };
        let mut cuts = self.camera.sequence.break_times();
        // Colours change only between the first and the last design. The range is split at both,
        // because colours have a kink there.
        cuts.extend([0.0, self.camera.sequence.end()]);
        cuts.retain(|&cut| from < cut && cut < to);
        cuts.extend([from, to]);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        let mut intervals: Vec<[f64; 2]> = cuts.windows(2).map(|two| [two[0], two[1]]).collect();
        if intervals.is_empty() {
            intervals.push([from, to]);
        }
        intervals.reverse();
        while let Some(interval) = intervals.pop() {
            if self.pieces.len() + intervals.len() > MAX_PIECES {
                return Ok(false);
            }
            let done = (interval[0] - from) / (to - from).max(f64::MIN_POSITIVE);
            checkpoint(self.progress, DRAWING_STAGE, done.clamp(0.0, 1.0))?;
            if let Some([first, second]) = self.fit_or_split(interval, to - from) {
                intervals.extend([second, first]);
            }
        }
        Ok(true)
    }

    /// Records an interval as one animation piece, or returns the two intervals into which it must
    /// be split. `range` is the length of the whole range of t.
    fn fit_or_split(&mut self, [from, to]: [f64; 2], range: f64) -> Option<[[f64; 2]; 2]> {
        if to <= from {
            let shapes = self.moment(from).into_iter().map(static_shape).collect();
            self.push(from, to, shapes);
            return None;
        }
        for n in [16, 32] {
            let times: Vec<f64> = chebyshev_nodes(n)
                .map(|s| from * (1.0 - s) + to * s)
                .collect();
            let moments: Vec<ShapeSnapshot> = times.iter().map(|&t| self.moment(t)).collect();
            let changed = moments
                .windows(2)
                .position(|two| !have_same_shapes(&two[0], &two[1]));
            if let Some(k) = changed {
                let [low, high] = self.locate_change([times[k], times[k + 1]], &moments[k], range);
                return Some([[from, low], [high, to]]);
            }
            let is_short = to - from <= MIN_LENGTH * range;
            if let Some(shapes) = fit_series(&moments, is_short) {
                let shapes = self.with_appearances([from, to], shapes, &moments);
                self.push(from, to, shapes);
                return None;
            }
        }
        let middle = 0.5 * (from + to);
        Some([[from, middle], [middle, to]])
    }

    /// Locates by bisection the moment at which shapes appear or disappear. Returns times just
    /// before and just after it.
    fn locate_change(
        &mut self,
        [mut low, mut high]: [f64; 2],
        first: &ShapeSnapshot,
        range: f64,
    ) -> [f64; 2] {
        while high - low > CHANGE_PRECISION * range {
            let middle = 0.5 * (low + high);
            if have_same_shapes(first, &self.moment(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        [low, high]
    }

    /// Samples the appearances of all shapes at uniform t, if any of them changes within the
    /// animation piece.
    fn with_appearances(
        &mut self,
        [from, to]: [f64; 2],
        mut shapes: Vec<MovingShape>,
        moments: &[ShapeSnapshot],
    ) -> Vec<MovingShape> {
        let changes = |k: usize| {
            moments
                .iter()
                .any(|m| !is_near(&m[k].appearance, &moments[0][k].appearance))
        };
        if !(0..shapes.len()).any(changes) {
            return shapes;
        }
        for shape in &mut shapes {
            shape.appearances.clear();
        }
        for k in 0..=LOOK_INTERVALS {
            let s = k as f64 / LOOK_INTERVALS as f64;
            let moment = self.moment(from * (1.0 - s) + to * s);
            // A shape that exists only between two Chebyshev nodes is missing in `moments`, but may
            // exist at this t. Then the appearances at the start of the animation piece are used.
            let sampled = if moment.len() == shapes.len() {
                &moment
            } else {
                &moments[0]
            };
            for (shape, posed) in shapes.iter_mut().zip(sampled) {
                shape.appearances.push(posed.appearance.clone());
            }
        }
        for shape in &mut shapes {
            shape.appearances = reduce_samples(std::mem::take(&mut shape.appearances));
        }
        shapes
    }

    /// Adds an animation piece at the end.
    fn push(&mut self, from: f64, to: f64, shapes: Vec<MovingShape>) {
        self.pieces.push(AnimationPiece {
            from,
            to,
            shapes,
            is_continuation: false,
        });
    }
}

/// Converts a shape to one that does not move.
fn static_shape(posed: PosedShape) -> MovingShape {
    MovingShape {
        terms: vec![posed.points.clone()],
        appearances: vec![posed.appearance.clone()],
        first: posed,
    }
}

/// Returns whether two snapshots have equally many shapes, and corresponding shapes are of the same
/// kind with the same path commands and number of points. Coordinates, colours and widths may
/// differ.
fn have_same_shapes(a: &ShapeSnapshot, b: &ShapeSnapshot) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.has_form_of(b))
}

/// Fits the Chebyshev series of all points through every second one of the `moments`. Returns
/// `None` if the series deviate too much from the other moments, unless `must_fit`.
fn fit_series(moments: &[ShapeSnapshot], must_fit: bool) -> Option<Vec<MovingShape>> {
    let fit = |k: usize| {
        let points = |m: usize| moments[m][k].points.as_slice();
        let through: Vec<&[DVec2]> = (0..moments.len()).step_by(2).map(points).collect();
        let mut terms = interpolate(&through);
        truncate_series(&mut terms, TRUNCATION_PX);
        let mut others = chebyshev_nodes(moments.len() - 1)
            .enumerate()
            .skip(1)
            .step_by(2);
        let is_near =
            others.all(|(m, s)| max_distance(&evaluate(&terms, s), points(m)) <= FIT_TOLERANCE_PX);
        (is_near || must_fit).then(|| MovingShape {
            first: moments[0][k].clone(),
            terms,
            appearances: vec![moments[0][k].appearance.clone()],
        })
    };
    (0..moments[0].len()).map(fit).collect()
}

/// Returns the largest distance between corresponding points, in pixels.
fn max_distance(a: &[DVec2], b: &[DVec2]) -> f64 {
    let far = a.iter().zip(b).map(|(a, b)| a.distance(*b));
    far.fold(0.0, f64::max)
}

/// Returns whether two appearances (colour, width and gradient numbers) are equal within
/// [`LOOK_TOLERANCE`].
fn is_near(a: &[f64], b: &[f64]) -> bool {
    let near =
        |(a, b): (&f64, &f64)| (a - b).abs() <= LOOK_TOLERANCE * (1.0 + a.abs().max(b.abs()));
    a.len() == b.len() && a.iter().zip(b).all(near)
}

/// Repeatedly drops every second sample of an appearance, as long as linear interpolation
/// reproduces the dropped samples. If nothing changes, a single sample remains.
fn reduce_samples(looks: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    if looks.iter().all(|look| is_near(look, &looks[0])) {
        return looks.into_iter().take(1).collect();
    }
    let mut looks = looks;
    while looks.len() > 2 {
        let is_between = |k: usize| {
            let ends = looks[k - 1].iter().zip(&looks[k + 1]);
            let mean: Vec<f64> = ends.map(|(a, b)| 0.5 * (a + b)).collect();
            is_near(&mean, &looks[k])
        };
        if !(1..looks.len()).step_by(2).all(is_between) {
            break;
        }
        looks = looks.into_iter().step_by(2).collect();
    }
    looks
}

/// Returns whether the shapes at the start of `piece` are those at the end of `before`, in the same
/// places.
fn continues(before: &AnimationPiece, piece: &AnimationPiece) -> bool {
    let (end, start) = (before.at(before.to), piece.at(piece.from));
    let is_near =
        |(a, b): (&PosedShape, &PosedShape)| max_distance(&a.points, &b.points) <= JUMP_PX;
    have_same_shapes(&end, &start) && end.iter().zip(&start).all(is_near)
}
