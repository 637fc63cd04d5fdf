//! Counts the folds, crossings, pieces and holes of a film at each sampled t, without the more
//! expensive measures of a film report.

use crate::content::{Content, SolidContent};
use crate::geometry::{DVec2, signed_area};
use crate::measure::distortion::is_folded;
use crate::measure::film_report::{FilmSample, crossings_at, evenly_spaced_times};
use crate::transition::Transition;
use crate::warp::Arap;
use crate::work::progress::{Cancelled, Progress, checkpoint};

/// Numbers of folded faces, crossings, pieces and holes at one t.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct MomentCounts {
    pub t: f64,
    pub folds: usize,
    pub crossings: usize,
    pub pieces: usize,
    pub holes: usize,
}

/// Function that selects one of the counts of a [`MomentCounts`].
pub(super) type DefectCounts = fn(&MomentCounts) -> usize;

impl MomentCounts {
    /// Takes the counts from a sample of a film that was measured before.
    pub fn of_sample(sample: &FilmSample) -> Self {
        Self {
            t: sample.t,
            folds: sample.distortion.map_or(0, |d| d.folds),
            crossings: sample.crossings.unwrap_or_default(),
            pieces: sample.pieces.unwrap_or_default(),
            holes: sample.holes.unwrap_or_default(),
        }
    }
}

/// Calls `count_at` at each of `steps` evenly spaced t, and reports progress with the text `stage`.
fn scan(
    steps: usize,
    stage: &'static str,
    progress: &dyn Progress,
    mut count_at: impl FnMut(f64) -> MomentCounts,
) -> Result<Vec<MomentCounts>, Cancelled> {
    let moment = |t| {
        checkpoint(progress, stage, t)?;
        Ok(MomentCounts { t, ..count_at(t) })
    };
    evenly_spaced_times(steps).map(moment).collect()
}

/// Counts defects at `steps` evenly spaced t of a transition; returns an empty list for pictures.
pub(super) fn scan_transition(
    transition: &Transition,
    steps: usize,
    progress: &dyn Progress,
) -> Result<Vec<MomentCounts>, Cancelled> {
    match (transition.content(), transition.arap()) {
        (Content::Solid(solid), Some(arap)) => {
            scan_rigid_parts(transition, arap, solid, steps, progress)
        }
        (Content::Field(_), _) => scan_fields(transition, steps, progress),
        (Content::Solid(solid), None) => {
            let mut frame = transition.frame(0.0);
            scan(steps, "looking for crossings", progress, |t| {
                frame.seek(t);
                let placement = frame.placement();
                MomentCounts {
                    folds: folded_faces(&placement.faces, &placement.in_frame).count(),
                    crossings: crossings_at(t, solid, &placement.in_frame),
                    ..MomentCounts::default()
                }
            })
        }
        (Content::Colours(_), _) => Ok(Vec::new()),
    }
}

/// Counts the defects when `arap` (the transition's own interpolation or a rebuilt one) moves the
/// transition's mesh, with the part timing of the transition.
pub(super) fn scan_rigid_parts(
    transition: &Transition,
    arap: &Arap,
    solid: &SolidContent,
    steps: usize,
    progress: &dyn Progress,
) -> Result<Vec<MomentCounts>, Cancelled> {
    let mut placer = transition.placer_for(arap);
    scan(steps, "looking for folds", progress, |t| {
        placer.place(t);
        let places = &placer.placement().in_frame;
        MomentCounts {
            folds: folded_faces(arap.mesh().faces(), places).count(),
            crossings: crossings_at(t, solid, places),
            ..MomentCounts::default()
        }
    })
}

/// Returns the indices of the faces that are folded at the given vertex positions.
pub(super) fn folded_faces<'a>(
    faces: &'a [[u32; 3]],
    places: &'a [DVec2],
) -> impl Iterator<Item = usize> + 'a {
    let faces = faces.iter().enumerate();
    faces
        .filter(|(_, face)| is_folded(places, face))
        .map(|(f, _)| f)
}

/// Counts the pieces and holes of the contours of a transition of distance fields.
pub(super) fn scan_fields(
    transition: &Transition,
    steps: usize,
    progress: &dyn Progress,
) -> Result<Vec<MomentCounts>, Cancelled> {
    let mut frame = transition.frame(0.0);
    scan(steps, "looking for tears", progress, |t| {
        frame.seek(t);
        let rings = frame.figure().rings;
        let holes = rings.iter().filter(|ring| signed_area(ring) < 0.0).count();
        MomentCounts {
            pieces: rings.len() - holes,
            holes,
            ..MomentCounts::default()
        }
    })
}

/// Returns the largest value of a count over all sampled t; 0 if there are none.
pub(super) fn max_count(moments: &[MomentCounts], count: DefectCounts) -> usize {
    moments.iter().map(count).max().unwrap_or(0)
}

/// Returns the t at which a count is largest (the middle one if several t share the maximum), and
/// the first and last t at which it exceeds `allowed`. Returns `None` if the count never exceeds
/// `allowed`.
pub(super) fn worst_moment(
    moments: &[MomentCounts],
    count: DefectCounts,
    allowed: usize,
) -> Option<(f64, [f64; 2])> {
    let max = max_count(moments, count);
    let exceeding: Vec<f64> = times_where(moments, |g| count(g) > allowed);
    let at_max = times_where(moments, |g| count(g) == max);
    let span = [*exceeding.first()?, *exceeding.last()?];
    // In the middle of its time span, a defect is most visible.
    Some((at_max[at_max.len() / 2], span))
}

/// Returns the sampled t at which the counts satisfy a condition.
pub(super) fn times_where(
    moments: &[MomentCounts],
    condition: impl Fn(&MomentCounts) -> bool,
) -> Vec<f64> {
    moments
        .iter()
        .filter(|g| condition(g))
        .map(|g| g.t)
        .collect()
}
