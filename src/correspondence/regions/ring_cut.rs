//! Finds the best place at which a part can be cut open to a hole.
//!
//! The search tries cuts that start at evenly spaced places on the boundary and end at the nearest
//! point of the hole. Each is rated by the cost of a match with few samples. A second round tries
//! places between the two neighbours of the best place.

use super::super::boundary::match_curves;
use super::super::curve::BoundaryCurve;
use super::super::options::MatchOptions;
use super::slit_boundary::{Slit, SlitBoundary};
use crate::geometry::Ring;
use crate::work::progress::{Progress, check_cancelled};
use rayon::prelude::*;

/// Number of places on the boundary at which the first round of the search tries a cut (resource
/// limit: each place needs a separate match).
const FIRST_PLACES: u32 = 28;
/// Number of samples of each trial match (resource limit: keeps all trials together about as fast
/// as one full match).
const SAMPLES: u32 = 56;

/// Number of places at which the second round of the search tries a cut. They lie between the two
/// neighbours of the best place of the first round (resource limit).
const SECOND_PLACES: u32 = 6;

/// Weight of the slit's length in the cost of a cut. The slit's length is taken as a fraction of
/// the length of the boundary loop after the cut. The weight decides between cuts that match
/// equally well (heuristic).
const LENGTH_WEIGHT: f64 = 0.25;

/// A cut, the boundary loop after it, and its cost.
#[derive(Clone, Debug)]
pub(super) struct CutCandidate {
    pub(super) boundary: SlitBoundary,
    pub(super) slit: Slit,
    /// Cost of a match with few samples, including the weighted length of the slit.
    pub(super) cost: f64,
}

/// Returns the best cut from the boundary loop to the hole `holes[cut]`, judged by a match with the
/// curve `other`. Returns `None` if no straight cut reaches the hole, or if the work is cancelled.
pub(super) fn best_cut(
    boundary: &SlitBoundary,
    holes: &[&Ring],
    cut: usize,
    other: &BoundaryCurve,
    options: &MatchOptions,
    progress: &dyn Progress,
) -> Option<CutCandidate> {
    let curve = boundary.curve().ok()?;
    let trials = |places: Vec<f64>| {
        let candidates = places.into_par_iter().filter_map(|place| {
            check_cancelled(progress).ok()?;
            let slit = boundary.slit_from(holes, cut, curve.point_at(place))?;
            let cost = cost(boundary, holes[cut], &slit, other, options)?;
            Some((cost, place, slit))
        });
        let candidates: Vec<(f64, f64, Slit)> = candidates.collect();
        candidates.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let spacing = 1.0 / f64::from(FIRST_PLACES);
    let coarse = trials((0..FIRST_PLACES).map(|k| f64::from(k) * spacing).collect())?;
    let offset = |k: u32| (f64::from(k) + 1.0) / f64::from(SECOND_PLACES + 1) * 2.0 - 1.0;
    let near = (0..SECOND_PLACES).map(|k| coarse.1 + offset(k) * spacing);
    let fine = trials(near.collect());
    let (cost, _, slit) = fine.filter(|fine| fine.0 < coarse.0).unwrap_or(coarse);
    let boundary = boundary.cut_open(holes[cut], &slit)?;
    Some(CutCandidate {
        boundary,
        slit,
        cost,
    })
}

/// Returns the cost of one cut, or `None` if the cut boundary cannot be matched.
fn cost(
    boundary: &SlitBoundary,
    hole: &Ring,
    slit: &Slit,
    other: &BoundaryCurve,
    options: &MatchOptions,
) -> Option<f64> {
    let open = boundary.cut_open(hole, slit)?;
    let matched = match_curves(&open.curve().ok()?, other, &[], &coarse_options(options)).ok()?;
    let length = slit.ends[0].distance(slit.ends[1]) / open.ring.perimeter();
    Some(matched.cost() + LENGTH_WEIGHT * length)
}

/// Returns the options with few samples, for trial matches whose costs are only compared with each
/// other.
pub(super) fn coarse_options(options: &MatchOptions) -> MatchOptions {
    MatchOptions {
        samples: SAMPLES.min(options.samples),
        ..options.clone()
    }
}
