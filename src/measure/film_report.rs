//! Measures of a whole film (a transition from t = 0 to t = 1), sampled at evenly spaced t.
//!
//! Every sample is measured on the shape exactly as it is drawn; nothing is known between samples.
//! The cost is that of drawing the samples: a few microseconds per face and sample for rigid parts,
//! one contour per sample for fields.

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
    Cancelled, OverallProgress, Progress, ProgressSpan, check_cancelled, checkpoint,
};
use serde::Serialize;
use std::f64::consts::TAU;

/// Measures of a film at one t.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct FilmSample {
    /// Blend parameter of the sample.
    pub t: f64,
    /// Filled area, in squared design units.
    pub area: f64,
    /// Length of all boundaries, in design units. A truss bar counts as twice its length, once for
    /// each of its long sides.
    pub perimeter: f64,
    /// Total absolute turning of all boundaries, in radians; 2π for each convex ring. A ring that
    /// is absent at this t counts as 2π.
    pub turning: f64,
    /// Total absolute turning of the boundaries of parts that exist in both designs, in radians.
    /// For the contour of a distance field, the same as `turning`.
    pub turning_of_both: f64,
    /// Number of separate pieces (connected regions); for a solid, the number of outer boundary
    /// loops. `None` for bars.
    pub pieces: Option<usize>,
    /// Number of holes; for a solid, the number of inner boundary loops. `None` for bars.
    pub holes: Option<usize>,
    /// Number of crossings of the boundary, within rings and between rings; only for filled solids.
    pub crossings: Option<usize>,
    /// Distortion of the faces relative to the source; only for meshes.
    pub distortion: Option<Distortion>,
}

/// Measures of a whole film.
///
/// ```
/// use morphospace::measure::{Quantity, film_report};
/// use morphospace::{project::gallery, transition::Transition, work::progress::Silent};
///
/// let spec = gallery::load("triangle-polar")?.spec()?;
/// let transition = Transition::build(&spec, &Silent)?;
/// let report = film_report(&transition, 65, &Silent)?;
/// assert_eq!(report.worst_folds, Some(0));
/// assert_eq!(report.series(Quantity::Area).len(), 65);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct FilmReport {
    /// Samples, evenly spaced over [0, 1].
    pub samples: Vec<FilmSample>,
    /// Largest number of folded faces at any sample; `None` without a mesh.
    pub worst_folds: Option<usize>,
    /// First sampled t with a folded face; `None` if there is none.
    pub first_fold_t: Option<f64>,
    /// Smallest signed area of any face at any sample, divided by the area of the face in the
    /// source. A face whose value is 0 or less is folded.
    pub min_det: Option<f64>,
    /// Largest number of boundary crossings at any sample.
    pub worst_crossings: Option<usize>,
    /// First sampled t with a boundary crossing; `None` if there is none.
    pub first_crossing_t: Option<f64>,
    /// Largest conformal distortion of any face at any sample, divided by the largest at t = 0 or t
    /// = 1; 1 if no other sample has a larger value.
    pub conformal_by_end: Option<f64>,
    /// As `conformal_by_end`, for the 95th percentile by area instead of the worst face.
    pub conformal_p95_by_end: Option<f64>,
    /// Largest amount by which any face's conformal distortion at a sample exceeds that of the same
    /// face in the target. (In the source it is 1.)
    pub conformal_excess: Option<f64>,
    /// As `conformal_excess`, for the isometric distortion.
    pub isometric_excess: Option<f64>,
    /// As `conformal_excess`, for the area distortion.
    pub area_distortion_excess: Option<f64>,
    /// Asymmetry under exchange of the designs A and B: the largest distance ‖X_AB(t) − X_BA(1−t)‖
    /// of any vertex at any sample, in design diameters. X_AB is the position of the vertex in the
    /// film from A to B, X_BA that in the film from B to A. `None` without rigid parts.
    pub asymmetry: Option<f64>,
    /// Total variation of the area over t, minus the absolute difference between the areas at t = 0
    /// and t = 1, as a fraction of the larger of these two areas.
    pub area_variation_excess: f64,
    /// Total variation of the perimeter over t, minus the absolute difference between the
    /// perimeters at t = 0 and t = 1, as a fraction of the larger of these two perimeters.
    pub perimeter_variation_excess: f64,
    /// Largest relative amount by which `turning` at a sample exceeds the linear interpolation
    /// between its values at t = 0 and t = 1. It is large if the shape is jagged or wavy at some t,
    /// but neither at t = 0 nor at t = 1.
    pub turning_excess: f64,
    /// As `turning_excess`, for `turning_of_both`. It ignores parts that exist in one design only,
    /// whose turning would change abruptly when they appear.
    pub turning_of_both_excess: f64,
    /// Largest number of pieces at any sample, minus the number at t = 0 or t = 1, whichever is
    /// larger; at least 0.
    pub pieces_excess: Option<usize>,
    /// Largest number of holes at any sample, minus the number at t = 0 or t = 1, whichever is
    /// larger; at least 0.
    pub holes_excess: Option<usize>,
    /// Travel and acceleration of the vertices, after removing the rigid motion of the whole shape.
    pub motion: Option<MotionReport>,
}

/// Progress reported once all samples are taken, in [0, 1] (heuristic).
const SAMPLED_FRACTION: f64 = 0.8;

/// Measures a transition at `samples` evenly spaced t, at least 2.
///
/// # Errors
/// [`Cancelled`] if the work was cancelled.
pub fn film_report(
    transition: &Transition,
    samples: usize,
    progress: &dyn Progress,
) -> Result<FilmReport, Cancelled> {
    let progress = &OverallProgress::new(progress);
    let mesh = transition.compatible();
    let sampler = FilmSampler::of(transition);
    let mut frame = transition.frame(0.0);
    let mut measured = Vec::with_capacity(samples);
    let mut paths = Vec::new();
    for t in evenly_spaced_times(samples) {
        checkpoint(progress, "measuring", SAMPLED_FRACTION * t)?;
        frame.seek(t);
        measured.push(sampler.sample(&frame));
        // Only mesh vertices can be tracked; a contour has different points at each t.
        if mesh.is_some() {
            paths.push(frame.placement().in_frame.clone());
        }
    }
    let step = 1.0 / (paths.len().max(2) - 1) as f64;
    let motion = mesh.and_then(|mesh| motion::motion_report(&paths, step, mesh.diameter()));
    check_cancelled(progress)?;
    let asymmetry = asymmetry(
        transition,
        &paths,
        &ProgressSpan::new(progress, SAMPLED_FRACTION, 1.0),
    )?;
    let excess = mesh.map(|mesh| overshoot::distortion_over_ends(mesh, &paths));
    Ok(report(measured, excess, asymmetry, motion))
}

/// Returns evenly spaced t from 0 to 1, both included; at least two.
pub(super) fn evenly_spaced_times(count: usize) -> impl Iterator<Item = f64> + Clone {
    let last = count.max(2) - 1;
    (0..=last).map(move |i| i as f64 / last as f64)
}

/// Data that is the same for all samples of a film.
struct FilmSampler<'a> {
    content: &'a Content,
    mesh: Option<&'a CompatibleMesh>,
    /// Number of pieces and number of holes of a solid; `None` without boundary loops.
    topology: Option<[usize; 2]>,
    /// Diameter of the larger design, in design units.
    diameter: f64,
}

impl<'a> FilmSampler<'a> {
    fn of(transition: &'a Transition) -> Self {
        let content = transition.content();
        Self {
            content,
            mesh: transition.compatible(),
            // The boundary loops are the same at every t, so one count suffices.
            topology: match content {
                Content::Solid(solid) if !solid.loops.is_empty() => {
                    Some(topology(solid, &transition.frame(0.0)))
                }
                _ => None,
            },
            diameter: larger_diameter(transition),
        }
    }

    /// Measures the film at the t of `frame`.
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
            turning: total_turning(&rings, self.diameter) + TAU * solid.absent_ring_count(t) as f64,
            turning_of_both: total_turning(&solid.shared_loops_at(places), self.diameter),
            pieces: self.topology.map(|[pieces, _]| pieces),
            holes: self.topology.map(|[_, holes]| holes),
            crossings: (!rings.is_empty()).then(|| crossings_at(t, solid, places)),
            distortion: self.mesh.and_then(|mesh| distortion(mesh, places)),
        }
    }
}

/// Returns the number of crossings of a solid's rings at `t`.
///
/// Returns 0 at t = 0 and t = 1, where the film shows the designs themselves. If a part was split,
/// its pieces share the line of the cut there, and rounding may make their outlines cross.
pub(super) fn crossings_at(t: f64, solid: &SolidContent, places: &[DVec2]) -> usize {
    if t == 0.0 || t == 1.0 {
        return 0;
    }
    solid.count_crossings(places, t)
}

fn larger_diameter(transition: &Transition) -> f64 {
    let diameters = transition
        .designs()
        .iter()
        .map(|d| d.form.bounds().diameter());
    diameters.fold(0.0, f64::max)
}

/// Returns the numbers of pieces and holes, from the orientation of each boundary loop.
///
/// The orientation of a loop is taken in the design where the loop is larger. In the other design,
/// the loop of an unmatched part is only a point.
fn topology(solid: &SolidContent, frame: &Frame) -> [usize; 2] {
    let placement = frame.placement();
    let rings_at = |places: &Vec<DVec2>| {
        let ring = |vertices: &Vec<u32>| vertices.iter().map(|&v| places[v as usize]).collect();
        solid.loops.iter().map(ring).collect::<Vec<Vec<DVec2>>>()
    };
    let ends = [&placement.in_source, &placement.in_target].map(rings_at);
    let is_hole = |(a, b): &(&Vec<DVec2>, &Vec<DVec2>)| {
        let areas = [signed_area(a), signed_area(b)];
        areas[usize::from(areas[1].abs() > areas[0].abs())] < 0.0
    };
    let holes = ends[0].iter().zip(&ends[1]).filter(is_hole).count();
    // Holes that exist in only one design are not among the loops, but count like other holes.
    [ends[0].len() - holes, holes + solid.holes.len()]
}

/// Measures a contour with the given rings at `t`.
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

/// Summarises the samples of a film in a report.
fn report(
    samples: Vec<FilmSample>,
    excess: Option<[f64; 3]>,
    asymmetry: Option<f64>,
    motion: Option<MotionReport>,
) -> FilmReport {
    let folds = |s: &FilmSample| s.distortion.map(|d| d.folds);
    let crossings = |s: &FilmSample| s.crossings;
    let worst =
        |value: &dyn Fn(&FilmSample) -> Option<usize>| samples.iter().filter_map(value).max();
    let first = |value: &dyn Fn(&FilmSample) -> Option<usize>| {
        let has_defects = |s: &&FilmSample| value(s).is_some_and(|n| n > 0);
        samples.iter().find(has_defects).map(|s| s.t)
    };
    let turning: Vec<_> = samples.iter().map(|s| [s.t, s.turning]).collect();
    let turning_of_both: Vec<_> = samples.iter().map(|s| [s.t, s.turning_of_both]).collect();
    let peak = |value: fn(Distribution) -> f64| {
        overshoot::peak_over_ends(samples.iter().map(|s| Some(value(s.distortion?.conformal))))
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
        pieces_excess: overshoot::count_over_ends(samples.iter().map(|s| s.pieces)),
        holes_excess: overshoot::count_over_ends(samples.iter().map(|s| s.holes)),
        motion,
        samples,
    }
}

fn rings_perimeter(rings: &[Vec<DVec2>]) -> f64 {
    rings.iter().map(|ring| perimeter(ring)).sum()
}

/// Compares the film with the film of the exchanged designs, played backwards. Returns the largest
/// distance between the positions of a vertex in the two films, over all vertices and samples, in
/// design diameters. Returns `None` without rigid parts.
fn asymmetry(
    transition: &Transition,
    paths: &[Vec<DVec2>],
    progress: &dyn Progress,
) -> Result<Option<f64>, Cancelled> {
    let (Some(arap), Some(mesh)) = (transition.arap(), transition.compatible()) else {
        return Ok(None);
    };
    // The reversed film uses the same rotation angles, including whole turns. So the result
    // measures the asymmetry of the energy that rigid parts minimise, not of the choice of angles.
    let reversed = match arap.swapped(progress) {
        Ok(reversed) => reversed,
        Err(ArapError::Cancelled(cancelled)) => return Err(cancelled),
        Err(_) => return Ok(None),
    };
    let mut placer = transition.reversed_placer_for(&reversed);
    let mut worst = 0.0_f64;
    for (t, forwards) in evenly_spaced_times(paths.len()).zip(paths) {
        check_cancelled(progress)?;
        placer.place(1.0 - t);
        let backwards = &placer.placement().in_frame;
        let gaps = forwards.iter().zip(backwards).map(|(p, q)| p.distance(*q));
        worst = gaps.fold(worst, f64::max);
    }
    Ok(Some(worst / mesh.diameter()))
}
