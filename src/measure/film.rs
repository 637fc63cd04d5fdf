//! A transition sampled over t.

use super::{Distortion, Motion, count_crossings, distortion, motion};
use crate::compatible::CompatibleMesh;
use crate::content::{Content, Solid};
use crate::geometry::DVec2;
use crate::measure::distortion::singular_values;
use crate::progress::{Cancelled, Progress, checkpoint};
use crate::transition::Transition;
use crate::warp::{Placer, Warp};
use serde::Serialize;

/// What is measured at one t.
#[derive(Clone, Debug, Serialize)]
pub struct FilmSample {
    /// Where.
    pub t: f64,
    /// Filled area, in squared units of the designs.
    pub area: f64,
    /// Length of all boundaries.
    pub perimeter: f64,
    /// Separate pieces of the contour; fields only.
    pub pieces: Option<usize>,
    /// Holes in them; fields only.
    pub holes: Option<usize>,
    /// Crossings of the boundary with itself; solids only.
    pub crossings: Option<usize>,
    /// Distortion against the source; meshes only.
    pub distortion: Option<Distortion>,
}

/// A whole film.
#[derive(Clone, Debug, Serialize)]
pub struct FilmReport {
    /// The samples, evenly spaced over [0, 1].
    pub samples: Vec<FilmSample>,
    /// Faces that are folded at any sample, counted at the worst one.
    pub worst_folds: Option<usize>,
    /// Where the first fold is seen.
    pub first_fold_t: Option<f64>,
    /// Most crossings of the boundary at any sample.
    pub worst_crossings: Option<usize>,
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
    /// Pieces beyond the larger end.
    pub pieces_excess: Option<usize>,
    /// Holes beyond the larger end.
    pub holes_excess: Option<usize>,
    /// Travel and acceleration with the rigid motion taken out.
    pub motion: Option<Motion>,
}

/// Measures a transition at `samples` evenly spaced t, at least 2.
///
/// # Errors
/// [`Cancelled`] if nobody wants the result any more.
pub fn film(
    transition: &Transition,
    samples: usize,
    progress: &dyn Progress,
) -> Result<FilmReport, Cancelled> {
    let samples = samples.max(2);
    let mesh = transition.compatible();
    let mut frame = transition.frame(0.0);
    let mut found = Vec::with_capacity(samples);
    let mut paths = Vec::with_capacity(samples);
    for i in 0..samples {
        let t = i as f64 / (samples - 1) as f64;
        checkpoint(progress, "measuring", t)?;
        frame.seek(t);
        found.push(match transition.content() {
            Content::Solid(solid) => solid_sample(t, solid, mesh, &frame.placement().in_frame),
            Content::Field(pair) => field_sample(t, &pair.contour(t)),
        });
        if mesh.is_some() {
            paths.push(frame.placement().in_frame.clone());
        }
    }
    let motion =
        mesh.and_then(|mesh| motion::motion(&paths, 1.0 / (samples - 1) as f64, mesh.diameter()));
    let excess = mesh.map(|mesh| excesses(mesh, &paths));
    Ok(report(
        found,
        excess,
        asymmetry(transition, &paths, progress)?,
        motion,
    ))
}

fn report(
    samples: Vec<FilmSample>,
    excess: Option<[f64; 3]>,
    asymmetry: Option<f64>,
    motion: Option<Motion>,
) -> FilmReport {
    let folds = |s: &FilmSample| s.distortion.map(|d| d.folds);
    let worst = |of: &dyn Fn(&FilmSample) -> Option<usize>| samples.iter().filter_map(of).max();
    let beyond_ends = |of: &dyn Fn(&FilmSample) -> Option<usize>| {
        let ends = of(samples.first()?)?.max(of(samples.last()?)?);
        Some(worst(of)?.saturating_sub(ends))
    };
    FilmReport {
        worst_folds: worst(&folds),
        first_fold_t: samples
            .iter()
            .find(|s| folds(s).is_some_and(|n| n > 0))
            .map(|s| s.t),
        worst_crossings: worst(&|s| s.crossings),
        conformal_excess: excess.map(|e| e[0]),
        isometric_excess: excess.map(|e| e[1]),
        area_distortion_excess: excess.map(|e| e[2]),
        asymmetry,
        area_variation_excess: variation_excess(samples.iter().map(|s| s.area)),
        perimeter_variation_excess: variation_excess(samples.iter().map(|s| s.perimeter)),
        pieces_excess: beyond_ends(&|s| s.pieces),
        holes_excess: beyond_ends(&|s| s.holes),
        motion,
        samples,
    }
}

fn solid_sample(
    t: f64,
    solid: &Solid,
    mesh: Option<&CompatibleMesh>,
    places: &[DVec2],
) -> FilmSample {
    let rings = solid.rings_at(places);
    let bars = solid.bars_at(places);
    let lengths: f64 = bars.iter().map(|[a, b]| a.distance(*b)).sum();
    FilmSample {
        t,
        area: rings_area(&rings) + lengths * solid.bar_width,
        perimeter: rings_perimeter(&rings) + 2.0 * lengths,
        pieces: None,
        holes: None,
        crossings: (!rings.is_empty()).then(|| count_crossings(&rings)),
        distortion: mesh.and_then(|mesh| distortion(mesh, places)),
    }
}

fn field_sample(t: f64, rings: &[Vec<DVec2>]) -> FilmSample {
    let areas: Vec<f64> = rings.iter().map(|ring| ring_area(ring)).collect();
    let holes = areas.iter().filter(|area| **area < 0.0).count();
    FilmSample {
        t,
        area: areas.iter().sum(),
        perimeter: rings_perimeter(rings),
        pieces: Some(rings.len() - holes),
        holes: Some(holes),
        crossings: None,
        distortion: None,
    }
}

fn ring_area(ring: &[DVec2]) -> f64 {
    let next = ring.iter().skip(1).chain(ring.first());
    let origin = ring.first().copied().unwrap_or_default();
    let twice: f64 = ring
        .iter()
        .zip(next)
        .map(|(a, b)| (*a - origin).perp_dot(*b - origin))
        .sum();
    0.5 * twice
}

fn rings_area(rings: &[Vec<DVec2>]) -> f64 {
    rings.iter().map(|ring| ring_area(ring)).sum()
}

fn rings_perimeter(rings: &[Vec<DVec2>]) -> f64 {
    let of = |ring: &Vec<DVec2>| -> f64 {
        let next = ring.iter().skip(1).chain(ring.first());
        ring.iter().zip(next).map(|(a, b)| a.distance(*b)).sum()
    };
    rings.iter().map(of).sum()
}

/// How much a quantity runs up and down beyond what its ends need, as a
/// fraction of the larger end.
fn variation_excess(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return 0.0;
    };
    let variation: f64 = values.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    let scale = first.abs().max(last.abs());
    if scale > 0.0 {
        ((variation - (last - first).abs()) / scale).max(0.0)
    } else {
        0.0
    }
}

/// For each face, distortion in the film beyond the worse of its ends; the
/// largest over faces and samples, conformal, isometric, by area. Distortion
/// is relative to the source, which is 1, so that the worse end is the target.
fn excesses(mesh: &CompatibleMesh, paths: &[Vec<DVec2>]) -> [f64; 3] {
    use crate::geometry::DMat2;
    let edges = |points: &[DVec2], face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| points[v as usize]);
        DMat2::from_cols(b - a, c - a)
    };
    let measures = |m: DMat2| {
        let (large, small) = singular_values(m);
        if small <= 0.0 {
            return [f64::INFINITY; 3];
        }
        let det = large * small;
        [large / small, large.max(1.0 / small), det.max(1.0 / det)]
    };
    let mut worst = [0.0; 3];
    for face in mesh.faces().iter() {
        let inverse = edges(mesh.source(), face).inverse();
        let ends = measures(edges(mesh.target(), face) * inverse);
        for places in paths {
            let now = measures(edges(places, face) * inverse);
            for k in 0..3 {
                worst[k] = f64::max(worst[k], now[k] - ends[k]);
            }
        }
    }
    worst
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
    let back = match arap.swapped(progress) {
        Ok(back) => back,
        Err(crate::warp::ArapError::Cancelled(cancelled)) => return Err(cancelled),
        Err(_) => return Ok(None),
    };
    let mut placer: Box<dyn Placer> = back.placer();
    let mut worst = 0.0_f64;
    for (i, there) in paths.iter().enumerate() {
        placer.place(1.0 - i as f64 / (paths.len() - 1) as f64);
        let here = &placer.placement().in_frame;
        let gaps = there.iter().zip(here).map(|(p, q)| p.distance(*q));
        worst = gaps.fold(worst, f64::max);
    }
    Ok(Some(worst / mesh.diameter()))
}
