//! Where to cut a ring open: cuts all along it, and the one kept whose strip
//! matches best.
//!
//! From each of a number of places on the walk to the nearest point of the
//! hole, matched with few samples; the best place is sought again between its
//! neighbours.

use super::super::boundary::match_curves;
use super::super::curve::BoundaryCurve;
use super::super::options::MatchOptions;
use super::slit_boundary::{Slit, SlitBoundary};
use crate::geometry::Ring;
use crate::work::progress::{Progress, still_wanted};
use rayon::prelude::*;

/// Places of the first round, and samples of each match.
/// Few of both, since every place is a match of its own: so the time to cut a
/// ring stays near that of one full match. No data fixed the numbers.
const PLACES: u32 = 28;
const SAMPLES: u32 = 56;

/// Places of the second round, between the best one's neighbours.
/// Seven times as fine as the first round.
const FINE: u32 = 6;

/// What a long slit costs, as a share of the walk's length.
/// It only has to part cuts that match alike; no measure fixed it.
const LENGTH_PRICE: f64 = 0.25;

/// An opened walk and how well it matches.
#[derive(Clone, Debug)]
pub(super) struct CutCandidate {
    pub(super) walk: SlitBoundary,
    pub(super) slit: Slit,
    /// Of a coarse match, with the price of the slit.
    pub(super) cost: f64,
}

/// The best cut of hole `cut`, if there is any; none on a cancel.
pub(super) fn best_cut(
    walk: &SlitBoundary,
    holes: &[&Ring],
    cut: usize,
    other: &BoundaryCurve,
    options: &MatchOptions,
    progress: &dyn Progress,
) -> Option<CutCandidate> {
    let curve = walk.curve().ok()?;
    let trials = |places: Vec<f64>| {
        let tried = places.into_par_iter().filter_map(|place| {
            still_wanted(progress).ok()?;
            let slit = walk.slit_from(holes, cut, curve.point_at(place))?;
            let cost = cost(walk, holes[cut], &slit, other, options)?;
            Some((cost, place, slit))
        });
        let tried: Vec<(f64, f64, Slit)> = tried.collect();
        tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let spacing = 1.0 / f64::from(PLACES);
    let coarse = trials((0..PLACES).map(|k| f64::from(k) * spacing).collect())?;
    let between = |k: u32| (f64::from(k) + 1.0) / f64::from(FINE + 1) * 2.0 - 1.0;
    let near = (0..FINE).map(|k| coarse.1 + between(k) * spacing);
    let fine = trials(near.collect());
    let (cost, _, slit) = fine.filter(|fine| fine.0 < coarse.0).unwrap_or(coarse);
    let walk = walk.opened(holes[cut], &slit)?;
    Some(CutCandidate { walk, slit, cost })
}

fn cost(
    walk: &SlitBoundary,
    hole: &Ring,
    slit: &Slit,
    other: &BoundaryCurve,
    options: &MatchOptions,
) -> Option<f64> {
    let open = walk.opened(hole, slit)?;
    let matched = match_curves(&open.curve().ok()?, other, &[], &coarse_options(options)).ok()?;
    let length = slit.ends[0].distance(slit.ends[1]) / open.ring.perimeter();
    Some(matched.cost() + LENGTH_PRICE * length)
}

/// The same options with few samples: for trials, which compare with trials.
pub(super) fn coarse_options(options: &MatchOptions) -> MatchOptions {
    MatchOptions {
        samples: SAMPLES.min(options.samples),
        ..options.clone()
    }
}
