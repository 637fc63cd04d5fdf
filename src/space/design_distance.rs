//! Dissimilarity of each pair of designs.
//!
//! For outlines, the dissimilarity is the cost of their match, averaged over the parts by area,
//! with cost 1 for unmatched parts. For trusses and meshes with common connectivity, it is the
//! distance between corresponding points after the best similarity fit. For pictures,
//! `picture_space` defines it.

use crate::correspondence::{
    MatchOptions, MatchPlan, MatchSettings, PartAppearances, PieceMatch, RingMatch,
};
use crate::geometry::{Bounds, DVec2, Regions, SimilarityFit, signed_area};
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use rayon::prelude::*;

/// Number of samples along each outline for the matches that measure the dissimilarity (heuristic:
/// with half the default, a match takes a quarter of the time; among ten outlines, no dissimilarity
/// changes by more than 0.025).
const SAMPLES: u32 = 80;

/// Symmetric matrix of the dissimilarities of all pairs of designs, with 0 on the diagonal.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignDistances {
    count: usize,
    /// Entries of the matrix, row by row.
    costs: Vec<f64>,
}

impl DesignDistances {
    /// Fills the matrix from `cost(a, b)` with a < b. Negative costs become 0; costs that are not
    /// finite become 1.
    pub(super) fn of(count: usize, cost: impl Fn(usize, usize) -> f64 + Sync) -> Self {
        let pairs: Vec<[usize; 2]> = (0..count)
            .flat_map(|a| (a + 1..count).map(move |b| [a, b]))
            .collect();
        let pair_costs: Vec<f64> = pairs.par_iter().map(|&[a, b]| cost(a, b)).collect();
        let mut costs = vec![0.0; count * count];
        for ([a, b], cost) in pairs.into_iter().zip(pair_costs) {
            let cost = if cost.is_finite() { cost.max(0.0) } else { 1.0 };
            costs[a * count + b] = cost;
            costs[b * count + a] = cost;
        }
        Self { count, costs }
    }

    /// Matches each pair of outlines and takes the cost of the match as the dissimilarity.
    pub(super) fn of_outlines(
        outlines: &[Regions],
        settings: &MatchSettings,
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        // Pins refer to two particular designs and are left out.
        let settings = MatchSettings {
            keep_up: settings.keep_up,
            stretch: settings.stretch,
            thickness: settings.thickness,
            ..MatchSettings::default()
        };
        let options = MatchOptions {
            samples: SAMPLES,
            ..settings.options()
        };
        let no_looks = PartAppearances::default();
        let cost = |a: usize, b: usize| {
            let pair = [&outlines[a], &outlines[b]];
            MatchPlan::new(pair, &no_looks, &settings, progress)
                .and_then(|plan| plan.match_all_groups(&options, progress))
                .map_or(f64::NAN, |matched| mean_cost(&matched.pieces))
        };
        let distances = Self::of(outlines.len(), cost);
        check_cancelled(progress)?;
        Ok(distances)
    }

    /// Sets the dissimilarity of all pairs to 1, for designs that are too large to be matched.
    pub(super) fn uniform(count: usize) -> Self {
        Self::of(count, |_, _| 1.0)
    }

    /// Compares lists of points; points with the same index correspond to each other.
    pub(super) fn of_corresponding_points(places: &[Vec<DVec2>]) -> Self {
        Self::of(places.len(), |a, b| fitted_distance(&places[a], &places[b]))
    }

    /// Returns the number of designs.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the dissimilarity of two designs, at least 0.
    ///
    /// # Panics
    /// If an index is out of range.
    #[must_use]
    pub fn between(&self, a: usize, b: usize) -> f64 {
        self.costs[a * self.count + b]
    }

    /// Returns the indices of the designs, sorted by the sum of their dissimilarities to all
    /// others, the smallest first.
    pub(super) fn most_central_first(&self) -> Vec<usize> {
        let sum = |k: usize| (0..self.count).map(|j| self.between(k, j)).sum::<f64>();
        let mut order: Vec<usize> = (0..self.count).collect();
        order.sort_by(|&a, &b| sum(a).total_cmp(&sum(b)));
        order
    }
}

/// Returns the mean cost of the pieces (matched or unmatched parts) of a match, weighted by area.
///
/// An unmatched piece has cost 1. An unmatched hole of any piece adds cost 1, weighted by its own
/// area.
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
        let unmatched_hole_area: f64 = holes
            .filter(|ring| ring.transient_side().is_some())
            .map(area)
            .sum();
        let cost = if piece.is_matched() { piece.cost } else { 1.0 };
        sum += weight * cost + unmatched_hole_area;
        total += weight;
    }
    sum / total
}

/// Returns the root mean square distance of corresponding points after the best similarity fit, as
/// a fraction of the larger diameter.
fn fitted_distance(a: &[DVec2], b: &[DVec2]) -> f64 {
    let Some(fit) = SimilarityFit::of(a, b) else {
        return f64::NAN;
    };
    let [from, to] = fit.means;
    let pairs = a.iter().zip(b);
    let squares = pairs.map(|(&p, &q)| (fit.factor.rotate(p - from) + to).distance_squared(q));
    let size = Bounds::diameter_of(a).max(Bounds::diameter_of(b));
    (squares.sum::<f64>() / a.len() as f64).sqrt() / size
}
