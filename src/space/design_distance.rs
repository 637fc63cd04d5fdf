//! How unlike designs are, two at a time.
//!
//! Of outlines it is what their match costs: how unlike the boundaries are as matched,
//! part by part and weighed by area, and 1 for all that has no partner. Of trusses and
//! meshes that share their connectivity, how far the nodes are from each other once one
//! is laid on the other.

use crate::correspondence::{MatchSettings, PieceMatch, RingMatch, match_regions};
use crate::geometry::{Bounds, DVec2, Regions, SimilarityFit, signed_area};
use crate::work::progress::{Cancelled, Progress, still_wanted};
use rayon::prelude::*;

/// A number for each two designs: 0 for one and itself, and the same both ways.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignDistances {
    count: usize,
    /// Row by row.
    costs: Vec<f64>,
}

impl DesignDistances {
    /// Of so many designs, by what each two cost; those two are in order. What is no
    /// number counts as 1.
    pub(super) fn of(count: usize, cost: impl Fn(usize, usize) -> f64 + Sync) -> Self {
        let two: Vec<[usize; 2]> = (0..count)
            .flat_map(|a| (a + 1..count).map(move |b| [a, b]))
            .collect();
        let each: Vec<f64> = two.par_iter().map(|&[a, b]| cost(a, b)).collect();
        let mut costs = vec![0.0; count * count];
        for ([a, b], cost) in two.into_iter().zip(each) {
            let cost = if cost.is_finite() { cost.max(0.0) } else { 1.0 };
            costs[a * count + b] = cost;
            costs[b * count + a] = cost;
        }
        Self { count, costs }
    }

    /// Of outlines.
    pub(super) fn of_outlines(
        outlines: &[Regions],
        wanted: &MatchSettings,
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        // Pins are of two designs, and mean nothing here.
        let wanted = MatchSettings {
            keep_up: wanted.keep_up,
            stretch: wanted.stretch,
            thickness: wanted.thickness,
            ..MatchSettings::default()
        };
        let cost = |a: usize, b: usize| {
            match_regions(&outlines[a], &outlines[b], &wanted, progress)
                .map_or(f64::NAN, |matched| mean_cost(&matched.pieces))
        };
        let likeness = Self::of(outlines.len(), cost);
        still_wanted(progress)?;
        Ok(likeness)
    }

    /// Where nobody knows: all are as unlike each other.
    pub(super) fn even(count: usize) -> Self {
        Self::of(count, |_, _| 1.0)
    }

    /// Of points that belong together, number by number.
    pub(super) fn of_points(places: &[Vec<DVec2>]) -> Self {
        Self::of(places.len(), |a, b| apart(&places[a], &places[b]))
    }

    /// How many designs there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// How unlike two designs are.
    ///
    /// # Panics
    /// If there are not so many.
    #[must_use]
    pub fn between(&self, a: usize, b: usize) -> f64 {
        self.costs[a * self.count + b]
    }

    /// The designs, those first that are less unlike all others.
    pub(super) fn by_nearness(&self) -> Vec<usize> {
        let sum = |k: usize| (0..self.count).map(|j| self.between(k, j)).sum::<f64>();
        let mut order: Vec<usize> = (0..self.count).collect();
        order.sort_by(|&a, &b| sum(a).total_cmp(&sum(b)));
        order
    }
}

/// What the pieces of a match cost, weighed by their area.
fn mean_cost(pieces: &[PieceMatch]) -> f64 {
    let area = |ring: &RingMatch| {
        signed_area(&ring.source)
            .abs()
            .max(signed_area(&ring.target).abs())
    };
    let (mut sum, mut total) = (0.0, 0.0);
    for piece in pieces {
        let weight: f64 = piece.rings.first().map_or(0.0, area);
        let holes = piece.rings.iter().skip(1).chain(&piece.lone);
        let alone: f64 = holes.filter(|ring| ring.whole().is_some()).map(area).sum();
        let cost = if piece.is_in_both() { piece.cost } else { 1.0 };
        sum += weight * cost + alone;
        total += weight;
    }
    sum / total
}

/// How far points are from each other once the ones are laid on the others by the
/// similarity that does it best, as a share of the larger diameter.
fn apart(a: &[DVec2], b: &[DVec2]) -> f64 {
    let Some(fit) = SimilarityFit::of(a, b) else {
        return f64::NAN;
    };
    let [from, to] = fit.means;
    let off = a.iter().zip(b);
    let off = off.map(|(&p, &q)| (fit.factor.rotate(p - from) + to).distance_squared(q));
    let size = Bounds::diameter_of(a).max(Bounds::diameter_of(b));
    (off.sum::<f64>() / a.len() as f64).sqrt() / size
}
