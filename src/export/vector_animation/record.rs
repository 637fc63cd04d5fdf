//! From what a camera draws to pieces of polynomials.
//!
//! A piece is tried over a stretch of t with one series, tested where it was not made
//! from, and halved where that is not near enough. Where shapes come or go, the moment
//! is closed in on and the stretch divided there.

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

/// How far a series may be from what it was made from, in pixels: a tenth of what all
/// steps may be together.
const NEAR_PX: f64 = 0.02;

/// What the terms that are left out may sum up to, in pixels.
const LEFT_OUT_PX: f64 = 0.01;

/// Pieces that begin where the last one ends go on with it.
const JUMP_PX: f64 = 0.1;

/// Moments at which shapes come or go are found to this share of the way.
const SHARP: f64 = 1e-6;

/// A stretch that is no longer than this share of the way is not halved: what happens
/// there is a jump.
const SHORT: f64 = 1e-4;

/// A film that would take more pieces than this is a row of frames.
const MOST_PIECES: usize = 400;

/// Of so many frames one is looked at to know whether it would.
const STRIDE: usize = 4;

/// Times at which looks are taken in a piece.
const LOOKS: usize = 16;

/// A number of a look may be this share of itself off: half a step of a colour.
const LOOK_SHARE: f64 = 0.002;

/// Shapes at one moment.
type ShapeSnapshot = Vec<PosedShape>;

/// The pieces of a film's way, by ascending t.
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
    let mut has_ways = true;
    for leg in camera.sequence.legs() {
        match leg.content() {
            Content::Colours(_) => return Err(ExportError::NoOutlines),
            Content::Field(_) => has_ways = false,
            Content::Solid(_) => {}
        }
    }
    let mut times = film.times().to_vec();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let is_smooth = has_ways && recorder.least_changes(&times)? <= MOST_PIECES;
    let was_recorded = is_smooth && recorder.smooth(&times)?;
    if !was_recorded {
        recorder.frame_by_frame(&times)?;
    }
    let mut pieces = recorder.pieces;
    for k in 1..pieces.len() {
        pieces[k].goes_on = goes_on(&pieces[k - 1], &pieces[k]);
    }
    Ok(pieces)
}

struct AnimationRecorder<'a> {
    camera: &'a Camera,
    frame: SequenceFrame,
    progress: &'a dyn Progress,
    pieces: Vec<AnimationPiece>,
}

impl AnimationRecorder<'_> {
    fn moment(&mut self, t: f64) -> ShapeSnapshot {
        self.frame.seek(t);
        let items = self.camera.drawn(&self.frame).items;
        items.iter().filter_map(PosedShape::of).collect()
    }

    /// Each frame until halfway to the next.
    fn frame_by_frame(&mut self, times: &[f64]) -> Result<(), ExportError> {
        self.pieces.clear();
        for (k, &t) in times.iter().enumerate() {
            checkpoint(self.progress, DRAWING_STAGE, k as f64 / times.len() as f64)?;
            let before = times[k.saturating_sub(1)];
            let after = times[(k + 1).min(times.len() - 1)];
            let shapes = self.moment(t).into_iter().map(still).collect();
            self.push(0.5 * (before + t), 0.5 * (t + after), shapes);
        }
        Ok(())
    }

    /// How many outlines come or go, at least: each time that one does ends a piece, and
    /// is closed in on by dozens of moments, which for thousands of parts takes minutes.
    fn least_changes(&mut self, times: &[f64]) -> Result<usize, ExportError> {
        let (mut changes, mut before) = (0, None);
        for &t in times.iter().step_by(STRIDE) {
            checkpoint(self.progress, DRAWING_STAGE, 0.0)?;
            let outlines: usize = self.moment(t).iter().map(PosedShape::outlines).sum();
            changes += before.map_or(0, |before| outlines.abs_diff(before));
            before = Some(outlines);
        }
        Ok(changes)
    }

    /// The whole way in pieces; false if those are too many.
    fn smooth(&mut self, times: &[f64]) -> Result<bool, ExportError> {
        let (Some(&from), Some(&to)) = (times.first(), times.last()) else {
            return Ok(true);
        };
        let mut cuts = self.camera.sequence.breaks();
        // Colours stay what they are beyond these.
        cuts.extend([0.0, self.camera.sequence.end()]);
        cuts.retain(|&cut| from < cut && cut < to);
        cuts.extend([from, to]);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        let mut stretches: Vec<[f64; 2]> = cuts.windows(2).map(|two| [two[0], two[1]]).collect();
        if stretches.is_empty() {
            stretches.push([from, to]);
        }
        stretches.reverse();
        while let Some(stretch) = stretches.pop() {
            if self.pieces.len() + stretches.len() > MOST_PIECES {
                return Ok(false);
            }
            let done = (stretch[0] - from) / (to - from).max(f64::MIN_POSITIVE);
            checkpoint(self.progress, DRAWING_STAGE, done.clamp(0.0, 1.0))?;
            if let Some([first, second]) = self.tried(stretch, to - from) {
                stretches.extend([second, first]);
            }
        }
        Ok(true)
    }

    /// Makes a piece of a stretch, or tells into which two it is to be divided.
    fn tried(&mut self, [from, to]: [f64; 2], way: f64) -> Option<[[f64; 2]; 2]> {
        if to <= from {
            let shapes = self.moment(from).into_iter().map(still).collect();
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
                .position(|two| !are_alike(&two[0], &two[1]));
            if let Some(k) = changed {
                let [low, high] = self.change([times[k], times[k + 1]], &moments[k], way);
                return Some([[from, low], [high, to]]);
            }
            let is_short = to - from <= SHORT * way;
            if let Some(shapes) = fitted(&moments, is_short) {
                let shapes = self.with_looks([from, to], shapes, &moments);
                self.push(from, to, shapes);
                return None;
            }
        }
        let middle = 0.5 * (from + to);
        Some([[from, middle], [middle, to]])
    }

    /// Closes in on where shapes come or go.
    fn change(
        &mut self,
        [mut low, mut high]: [f64; 2],
        first: &ShapeSnapshot,
        way: f64,
    ) -> [f64; 2] {
        while high - low > SHARP * way {
            let middle = 0.5 * (low + high);
            if are_alike(first, &self.moment(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        [low, high]
    }

    /// With looks at even times where they change.
    fn with_looks(
        &mut self,
        [from, to]: [f64; 2],
        mut shapes: Vec<MovingShape>,
        moments: &[ShapeSnapshot],
    ) -> Vec<MovingShape> {
        let changes = |k: usize| {
            moments
                .iter()
                .any(|m| !is_near(&m[k].look, &moments[0][k].look))
        };
        if !(0..shapes.len()).any(changes) {
            return shapes;
        }
        for shape in &mut shapes {
            shape.looks.clear();
        }
        for k in 0..=LOOKS {
            let s = k as f64 / LOOKS as f64;
            let moment = self.moment(from * (1.0 - s) + to * s);
            // Shapes that come and go within less than a node's distance.
            let seen = if moment.len() == shapes.len() {
                &moment
            } else {
                &moments[0]
            };
            for (shape, posed) in shapes.iter_mut().zip(seen) {
                shape.looks.push(posed.look.clone());
            }
        }
        for shape in &mut shapes {
            shape.looks = fewer(std::mem::take(&mut shape.looks));
        }
        shapes
    }

    fn push(&mut self, from: f64, to: f64, shapes: Vec<MovingShape>) {
        self.pieces.push(AnimationPiece {
            from,
            to,
            shapes,
            goes_on: false,
        });
    }
}

fn still(posed: PosedShape) -> MovingShape {
    MovingShape {
        terms: vec![posed.points.clone()],
        looks: vec![posed.look.clone()],
        first: posed,
    }
}

fn are_alike(a: &ShapeSnapshot, b: &ShapeSnapshot) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.is_like(b))
}

/// Series through every second moment, if they pass the others near enough.
fn fitted(moments: &[ShapeSnapshot], must: bool) -> Option<Vec<MovingShape>> {
    let fitted = |k: usize| {
        let points = |m: usize| moments[m][k].points.as_slice();
        let through: Vec<&[DVec2]> = (0..moments.len()).step_by(2).map(points).collect();
        let mut terms = interpolate(&through);
        truncate_series(&mut terms, LEFT_OUT_PX);
        let mut others = chebyshev_nodes(moments.len() - 1)
            .enumerate()
            .skip(1)
            .step_by(2);
        let is_near = others.all(|(m, s)| farthest(&evaluate(&terms, s), points(m)) <= NEAR_PX);
        (is_near || must).then(|| MovingShape {
            first: moments[0][k].clone(),
            terms,
            looks: vec![moments[0][k].look.clone()],
        })
    };
    (0..moments[0].len()).map(fitted).collect()
}

fn farthest(a: &[DVec2], b: &[DVec2]) -> f64 {
    let far = a.iter().zip(b).map(|(a, b)| a.distance(*b));
    far.fold(0.0, f64::max)
}

fn is_near(a: &[f64], b: &[f64]) -> bool {
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= LOOK_SHARE * (1.0 + a.abs().max(b.abs()));
    a.len() == b.len() && a.iter().zip(b).all(near)
}

/// Every second look, as long as straight lines between those do.
fn fewer(looks: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
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

fn goes_on(before: &AnimationPiece, piece: &AnimationPiece) -> bool {
    let (end, start) = (before.at(before.to), piece.at(piece.from));
    let is_near = |(a, b): (&PosedShape, &PosedShape)| farthest(&a.points, &b.points) <= JUMP_PX;
    are_alike(&end, &start) && end.iter().zip(&start).all(is_near)
}
