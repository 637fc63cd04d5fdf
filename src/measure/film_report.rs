//! A transition sampled over t.
//!
//! Guaranteed: every sample is a frame as it is drawn. Not guaranteed:
//! anything between two samples. The cost is that of the frames, for rigid
//! parts some microseconds a face and sample, for fields a contour each.

use super::distortion::{Distortion, Distribution, distortion};
use super::motion;
use super::motion::MotionReport;
use super::overshoot;
use crate::compatible::CompatibleMesh;
use crate::content::{Content, SolidContent};
use crate::geometry::{
    DVec2, excess_variation, max_overshoot, perimeter, signed_area, total_turning,
};
use crate::transition::{Frame, Transition};
use crate::warp::ArapError;
use crate::work::progress::{
    Cancelled, Progress, ProgressSpan, WholeProgress, checkpoint, still_wanted,
};
use serde::Serialize;
use std::f64::consts::TAU;

/// What is measured at one t.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct FilmSample {
    /// Where.
    pub t: f64,
    /// Filled area, in squared units of the designs.
    pub area: f64,
    /// Length of all boundaries, in units of the designs.
    pub perimeter: f64,
    /// By how much all boundaries turn, in radians; 2π for each that is convex.
    pub turning: f64,
    /// The same of parts that both designs have.
    pub turning_of_both: f64,
    /// Separate pieces; of a solid as its boundary walks have them.
    pub pieces: Option<usize>,
    /// Holes in them, likewise.
    pub holes: Option<usize>,
    /// Crossings of the boundary with itself, different rings included;
    /// solids only.
    pub crossings: Option<usize>,
    /// Distortion against the source; meshes only.
    pub distortion: Option<Distortion>,
}

/// A whole film.
///
/// ```
/// use morphospace::measure::{Quantity, film};
/// use morphospace::{progress::Silent, project::gallery, transition::Transition};
///
/// let spec = gallery::load("triangle-polar")?.spec()?;
/// let transition = Transition::build(&spec, &Silent)?;
/// let report = film(&transition, 65, &Silent)?;
/// assert_eq!(report.worst_folds, Some(0));
/// assert_eq!(report.series(Quantity::Area).len(), 65);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct FilmReport {
    /// The samples, evenly spaced over [0, 1].
    pub samples: Vec<FilmSample>,
    /// Faces that are folded at any sample, counted at the worst one.
    pub worst_folds: Option<usize>,
    /// Where the first fold is seen.
    pub first_fold_t: Option<f64>,
    /// The least determinant of a face at any sample, against the source.
    pub min_det: Option<f64>,
    /// Most crossings of the boundary at any sample.
    pub worst_crossings: Option<usize>,
    /// Where the first crossing is seen.
    pub first_crossing_t: Option<f64>,
    /// The largest conformal distortion of a face at any sample, by the largest one at
    /// the worse end: 1 where it is bounded by the ends.
    pub conformal_by_end: Option<f64>,
    /// The same of what 95 % of the area is at or below.
    pub conformal_p95_by_end: Option<f64>,
    /// Largest excess of a face's conformal distortion over its worse end.
    pub conformal_excess: Option<f64>,
    /// Largest excess of a face's isometric distortion over its worse end.
    pub isometric_excess: Option<f64>,
    /// Largest excess of a face's area distortion over its worse end.
    pub area_distortion_excess: Option<f64>,
    /// max ‖X_AB(t) − X_BA(1−t)‖ / diameter.
    pub asymmetry: Option<f64>,
    /// Total variation of the area beyond |end − end|, as a fraction of the
    /// larger end.
    pub area_variation_excess: f64,
    /// The same of the perimeter.
    pub perimeter_variation_excess: f64,
    /// Largest excess of the boundaries' turning over what lies between the
    /// ends, as a share of that: jagged or wavy where neither end is.
    pub turning_excess: f64,
    /// The same of parts that both designs have, without holes that come and go: what is
    /// born as it is drawn turns as much as it ever does from the first moment.
    pub turning_of_both_excess: f64,
    /// Pieces beyond the larger end.
    pub pieces_excess: Option<usize>,
    /// Holes beyond the larger end.
    pub holes_excess: Option<usize>,
    /// Travel and acceleration with the rigid motion taken out.
    pub motion: Option<MotionReport>,
}

/// How much of the measuring is done once all samples are taken, as it is told.
const SAMPLED: f64 = 0.8;

/// Measures a transition at `samples` evenly spaced t, at least 2.
///
/// # Errors
/// [`Cancelled`] if nobody wants the result any more.
pub fn film(
    transition: &Transition,
    samples: usize,
    progress: &dyn Progress,
) -> Result<FilmReport, Cancelled> {
    let progress = &WholeProgress::new(progress);
    let mesh = transition.compatible();
    let sampler = FilmSampler::of(transition);
    let mut frame = transition.frame(0.0);
    let mut found = Vec::with_capacity(samples);
    let mut paths = Vec::new();
    for t in even_steps(samples) {
        checkpoint(progress, "measuring", SAMPLED * t)?;
        frame.seek(t);
        found.push(sampler.sample(&frame));
        // Only vertices of a mesh can be followed: a contour has others at each t.
        if mesh.is_some() {
            paths.push(frame.placement().in_frame.clone());
        }
    }
    let step = 1.0 / (paths.len().max(2) - 1) as f64;
    let motion = mesh.and_then(|mesh| motion::motion(&paths, step, mesh.diameter()));
    still_wanted(progress)?;
    let asymmetry = asymmetry(
        transition,
        &paths,
        &ProgressSpan::new(progress, SAMPLED, 1.0),
    )?;
    let excess = mesh.map(|mesh| overshoot::of_distortion(mesh, &paths));
    Ok(report(found, excess, asymmetry, motion))
}

/// Values of t, evenly from 0 to 1, both included: two at least.
pub(super) fn even_steps(count: usize) -> impl Iterator<Item = f64> + Clone {
    let last = count.max(2) - 1;
    (0..=last).map(move |i| i as f64 / last as f64)
}

/// What a sample needs and does not change with t.
struct FilmSampler<'a> {
    content: &'a Content,
    mesh: Option<&'a CompatibleMesh>,
    /// Pieces and holes of a solid.
    topology: Option<[usize; 2]>,
    /// Of the larger design.
    diameter: f64,
}

impl<'a> FilmSampler<'a> {
    fn of(transition: &'a Transition) -> Self {
        let content = transition.content();
        Self {
            content,
            mesh: transition.compatible(),
            // The walks are the same at every t, so that one count does.
            topology: match content {
                Content::Solid(solid) if !solid.loops.is_empty() => {
                    Some(topology(solid, &transition.frame(0.0)))
                }
                _ => None,
            },
            diameter: larger(transition),
        }
    }

    fn sample(&self, frame: &Frame) -> FilmSample {
        match self.content {
            Content::Solid(solid) => self.of_solid(frame.t(), solid, &frame.placement().in_frame),
            Content::Field(_) | Content::Colours(_) => {
                of_rings(frame.t(), &frame.figure().rings, self.diameter)
            }
        }
    }

    fn of_solid(&self, t: f64, solid: &SolidContent, places: &[DVec2]) -> FilmSample {
        let rings = solid.rings_at(places, t);
        let bars = solid.bars_at(places);
        let lengths: f64 = bars.iter().map(|[a, b]| a.distance(*b)).sum();
        FilmSample {
            t,
            area: rings.iter().map(|ring| signed_area(ring)).sum::<f64>()
                + lengths * solid.bar_width,
            perimeter: rings_perimeter(&rings) + 2.0 * lengths,
            turning: total_turning(&rings, self.diameter) + TAU * solid.gone_at(t) as f64,
            turning_of_both: total_turning(&solid.lasting_at(places), self.diameter),
            pieces: self.topology.map(|[pieces, _]| pieces),
            holes: self.topology.map(|[_, holes]| holes),
            crossings: (!rings.is_empty()).then(|| crossings_at(t, solid, places)),
            distortion: self.mesh.and_then(|mesh| distortion(mesh, places)),
        }
    }
}

/// How often the rings of a solid cross at `t`. At its ends a film is the designs: parts that
/// one of them was cut into share their seams there, to the last digit and no
/// further.
pub(super) fn crossings_at(t: f64, solid: &SolidContent, places: &[DVec2]) -> usize {
    if t == 0.0 || t == 1.0 {
        return 0;
    }
    solid.count_crossings(places, t)
}

/// The diameter of the larger design.
fn larger(transition: &Transition) -> f64 {
    let diameters = transition
        .designs()
        .iter()
        .map(|d| d.form.bounds().diameter());
    diameters.fold(0.0, f64::max)
}

/// Pieces and holes by the sense of each boundary walk; one that is born from
/// a point has it from its larger end.
fn topology(solid: &SolidContent, frame: &Frame) -> [usize; 2] {
    let placement = frame.placement();
    let at = |places: &Vec<DVec2>| {
        let walk = |walk: &Vec<u32>| walk.iter().map(|&v| places[v as usize]).collect();
        solid.loops.iter().map(walk).collect::<Vec<Vec<DVec2>>>()
    };
    let ends = [&placement.in_source, &placement.in_target].map(at);
    let is_hole = |(a, b): &(&Vec<DVec2>, &Vec<DVec2>)| {
        let areas = [signed_area(a), signed_area(b)];
        areas[usize::from(areas[1].abs() > areas[0].abs())] < 0.0
    };
    let holes = ends[0].iter().zip(&ends[1]).filter(is_hole).count();
    // One that comes or goes is a point where it is not, like one that closes.
    [ends[0].len() - holes, holes + solid.holes.len()]
}

fn of_rings(t: f64, rings: &[Vec<DVec2>], diameter: f64) -> FilmSample {
    let areas: Vec<f64> = rings.iter().map(|ring| signed_area(ring)).collect();
    let holes = areas.iter().filter(|area| **area < 0.0).count();
    FilmSample {
        t,
        area: areas.iter().sum(),
        perimeter: rings_perimeter(rings),
        turning: total_turning(rings, diameter),
        turning_of_both: total_turning(rings, diameter),
        pieces: Some(rings.len() - holes),
        holes: Some(holes),
        crossings: None,
        distortion: None,
    }
}

fn report(
    samples: Vec<FilmSample>,
    excess: Option<[f64; 3]>,
    asymmetry: Option<f64>,
    motion: Option<MotionReport>,
) -> FilmReport {
    let folds = |s: &FilmSample| s.distortion.map(|d| d.folds);
    let crossings = |s: &FilmSample| s.crossings;
    let worst = |of: &dyn Fn(&FilmSample) -> Option<usize>| samples.iter().filter_map(of).max();
    let first = |of: &dyn Fn(&FilmSample) -> Option<usize>| {
        let is_bad = |s: &&FilmSample| of(s).is_some_and(|n| n > 0);
        samples.iter().find(is_bad).map(|s| s.t)
    };
    let turning: Vec<_> = samples.iter().map(|s| [s.t, s.turning]).collect();
    let turning_of_both: Vec<_> = samples.iter().map(|s| [s.t, s.turning_of_both]).collect();
    let peak = |of: fn(Distribution) -> f64| {
        overshoot::of_peak(samples.iter().map(|s| Some(of(s.distortion?.conformal))))
    };
    let dets = samples.iter().filter_map(|s| Some(s.distortion?.min_det));
    FilmReport {
        worst_folds: worst(&folds),
        first_fold_t: first(&folds),
        min_det: dets.reduce(f64::min),
        worst_crossings: worst(&crossings),
        first_crossing_t: first(&crossings),
        conformal_by_end: peak(|conformal| conformal.worst),
        conformal_p95_by_end: peak(|conformal| conformal.p95),
        conformal_excess: excess.map(|e| e[0]),
        isometric_excess: excess.map(|e| e[1]),
        area_distortion_excess: excess.map(|e| e[2]),
        asymmetry,
        area_variation_excess: excess_variation(samples.iter().map(|s| s.area)),
        perimeter_variation_excess: excess_variation(samples.iter().map(|s| s.perimeter)),
        turning_excess: max_overshoot(&turning),
        turning_of_both_excess: max_overshoot(&turning_of_both),
        pieces_excess: overshoot::of_count(samples.iter().map(|s| s.pieces)),
        holes_excess: overshoot::of_count(samples.iter().map(|s| s.holes)),
        motion,
        samples,
    }
}

fn rings_perimeter(rings: &[Vec<DVec2>]) -> f64 {
    rings.iter().map(|ring| perimeter(ring)).sum()
}

/// The film against the one of the exchanged designs, played backwards.
fn asymmetry(
    transition: &Transition,
    paths: &[Vec<DVec2>],
    progress: &dyn Progress,
) -> Result<Option<f64>, Cancelled> {
    let (Some(arap), Some(mesh)) = (transition.arap(), transition.compatible()) else {
        return Ok(None);
    };
    // Turned back the same way, whole turns included: what is asked is whether
    // the energy is symmetric, not whether turns are chosen alike.
    let back = match arap.swapped(progress) {
        Ok(back) => back,
        Err(ArapError::Cancelled(cancelled)) => return Err(cancelled),
        Err(_) => return Ok(None),
    };
    let mut placer = transition.placer_backwards(&back);
    let mut worst = 0.0_f64;
    for (t, there) in even_steps(paths.len()).zip(paths) {
        still_wanted(progress)?;
        placer.place(1.0 - t);
        let here = &placer.placement().in_frame;
        let gaps = there.iter().zip(here).map(|(p, q)| p.distance(*q));
        worst = gaps.fold(worst, f64::max);
    }
    Ok(Some(worst / mesh.diameter()))
}
