//! How much is wrong at each t, as cheaply as it can be known.

use crate::content::{Content, SolidContent};
use crate::geometry::{DVec2, signed_area};
use crate::measure::distortion::is_folded;
use crate::measure::film_report::{FilmSample, crossings_at, even_steps};
use crate::transition::Transition;
use crate::warp::Arap;
use crate::work::progress::{Cancelled, Progress, checkpoint};

/// What is wrong at one t.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct MomentCounts {
    pub t: f64,
    pub folds: usize,
    pub crossings: usize,
    pub pieces: usize,
    pub holes: usize,
}

/// A count of a [`MomentCounts`].
pub(super) type DefectCounts = fn(&MomentCounts) -> usize;

impl MomentCounts {
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

/// A look at each of so many t.
fn looks(
    steps: usize,
    what: &'static str,
    progress: &dyn Progress,
    mut look: impl FnMut(f64) -> MomentCounts,
) -> Result<Vec<MomentCounts>, Cancelled> {
    let glance = |t| {
        checkpoint(progress, what, t)?;
        Ok(MomentCounts { t, ..look(t) })
    };
    even_steps(steps).map(glance).collect()
}

pub(super) fn transition(
    transition: &Transition,
    steps: usize,
    progress: &dyn Progress,
) -> Result<Vec<MomentCounts>, Cancelled> {
    match (transition.content(), transition.arap()) {
        (Content::Solid(solid), Some(arap)) => {
            rigid_parts(transition, arap, solid, steps, progress)
        }
        (Content::Field(_), _) => fields(transition, steps, progress),
        (Content::Solid(solid), None) => {
            let mut frame = transition.frame(0.0);
            looks(steps, "looking for crossings", progress, |t| {
                frame.seek(t);
                let placement = frame.placement();
                MomentCounts {
                    folds: folded(&placement.faces, &placement.in_frame).count(),
                    crossings: crossings_at(t, solid, &placement.in_frame),
                    ..MomentCounts::default()
                }
            })
        }
        (Content::Colours(_), _) => Ok(Vec::new()),
    }
}

/// Of a film of the mesh of `transition`, in whose times its parts move.
pub(super) fn rigid_parts(
    transition: &Transition,
    arap: &Arap,
    solid: &SolidContent,
    steps: usize,
    progress: &dyn Progress,
) -> Result<Vec<MomentCounts>, Cancelled> {
    let mut placer = transition.placer_of(arap);
    looks(steps, "looking for folds", progress, |t| {
        placer.place(t);
        let places = &placer.placement().in_frame;
        MomentCounts {
            folds: folded(arap.mesh().faces(), places).count(),
            crossings: crossings_at(t, solid, places),
            ..MomentCounts::default()
        }
    })
}

/// The faces that are folded at the given places.
pub(super) fn folded<'a>(
    faces: &'a [[u32; 3]],
    places: &'a [DVec2],
) -> impl Iterator<Item = usize> + 'a {
    let faces = faces.iter().enumerate();
    faces
        .filter(|(_, face)| is_folded(places, face))
        .map(|(f, _)| f)
}

pub(super) fn fields(
    transition: &Transition,
    steps: usize,
    progress: &dyn Progress,
) -> Result<Vec<MomentCounts>, Cancelled> {
    let mut frame = transition.frame(0.0);
    looks(steps, "looking for tears", progress, |t| {
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

/// The most of a count.
pub(super) fn most(glances: &[MomentCounts], of: DefectCounts) -> usize {
    glances.iter().map(of).max().unwrap_or(0)
}

/// Where a count is beyond `allowed`: the t at which it is largest, the middle
/// one of several, and the first and last at which it is beyond.
pub(super) fn worst(
    glances: &[MomentCounts],
    of: DefectCounts,
    allowed: usize,
) -> Option<(f64, [f64; 2])> {
    let top = most(glances, of);
    let beyond: Vec<f64> = times(glances, |g| of(g) > allowed);
    // Halfway through a trouble it is seen best.
    let at_top = times(glances, |g| of(g) == top);
    let span = [*beyond.first()?, *beyond.last()?];
    Some((at_top[at_top.len() / 2], span))
}

pub(super) fn times(glances: &[MomentCounts], is: impl Fn(&MomentCounts) -> bool) -> Vec<f64> {
    glances.iter().filter(|g| is(g)).map(|g| g.t).collect()
}
