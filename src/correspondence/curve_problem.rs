//! The matching problem of two sampled curves: the data that every search needs, and the search for
//! the cheapest closed paths on the grid of sample pairs.
//!
//! [`super::boundary`] lists the guarantees. A node is a pair of sample indices `[source, target]`.
//! The indices continue from round to round: with n samples, index n is sample 0 one round later.

use super::curve::BoundaryCurve;
use super::cyclic::cheapest_path_per_start;
use super::features::BoundaryFeatures;
use super::inner_descriptors::InnerDescriptors;
use super::options::MatchOptions;
use super::path_grid::{GridPath, PathBuffers, PathGrid};
use super::samples::CurveSamples;
use crate::geometry::DVec2;

/// Minimum number of samples for which a coarse search pre-selects the poses (rotations of the
/// source onto the target) that get a full search (heuristic). The coarse search has half as many
/// samples, and no more than this number; it takes at most a quarter of the time.
const COARSE_SEARCH_SAMPLES: u32 = 96;

/// Two sampled curves with their features and pins, and the weights of the terms that make up the
/// cost of a path.
pub(super) struct CurveMatchProblem {
    pub(super) source: CurveSamples,
    pub(super) target: CurveSamples,
    pub(super) source_features: BoundaryFeatures,
    pub(super) target_features: BoundaryFeatures,
    /// Pairs of places `[source, target]` (fractions of arc length) that the user pinned, ascending
    /// in the source.
    pub(super) pins: Vec<[f64; 2]>,
    /// Weight of the stretching cost relative to the bending cost (see [`PathGrid`]).
    stretch: f64,
    /// Weight of the difference in thickness in the dissimilarity of two samples.
    pub(super) thickness: f64,
    /// Whether directions are compared as drawn, without a search for a rotation.
    pub(super) keep_up: bool,
    /// Weight of the difference in inner distances (lengths of shortest paths inside the shape) in
    /// the dissimilarity of two samples.
    pub(super) inner_weight: f64,
    /// Inner distances between the samples of the source, and of the target. `None` if the weight
    /// of inner distances is zero, or if a curve has no inside.
    pub(super) inner_descriptors: Option<[InnerDescriptors; 2]>,
    /// The same problem with fewer samples, which selects the poses that are worth a full search.
    /// `None` if the full search is small.
    pub(super) coarse: Option<Box<Self>>,
}

impl CurveMatchProblem {
    /// Samples both curves and computes their features. `pins` must be in the order in which
    /// [`super::pins::sort_pins`] returns them.
    pub fn new(
        source: &BoundaryCurve,
        target: &BoundaryCurve,
        pins: Vec<[f64; 2]>,
        options: &MatchOptions,
    ) -> Self {
        let all_pins = pins.clone();
        let fixed = |side: usize| pins.iter().map(|pin| pin[side]).collect::<Vec<_>>();
        let a = CurveSamples::of(source, options.samples, &fixed(0));
        let b = CurveSamples::of(target, options.samples, &fixed(1));
        let uses_inner_distances = options.inner > 0.0;
        let inner = |curve, samples| {
            let rows = uses_inner_distances.then(|| InnerDescriptors::of(curve, samples));
            rows.flatten()
        };
        Self {
            inner_weight: options.inner,
            inner_descriptors: inner(source, &a).zip(inner(target, &b)).map(<[_; 2]>::from),
            source_features: BoundaryFeatures::of(source, &a),
            target_features: BoundaryFeatures::of(target, &b),
            source: a,
            target: b,
            pins,
            stretch: options.stretch,
            thickness: options.thickness,
            keep_up: options.keep_up,
            coarse: (options.samples >= COARSE_SEARCH_SAMPLES).then(|| {
                let samples = options.samples.div_ceil(2).min(COARSE_SEARCH_SAMPLES);
                let fewer = MatchOptions {
                    samples,
                    ..options.clone()
                };
                Box::new(Self::new(source, target, all_pins, &fewer))
            }),
        }
    }

    /// Calls `visit` for the cheapest closed path from each starting sample, with its cost and a
    /// function that returns its nodes. With pins there is only one such path: the cheapest one
    /// through all pinned nodes.
    pub(super) fn visit_paths(
        &self,
        dissimilarities: &[f64],
        mut visit: impl FnMut(f64, &dyn Fn() -> Vec<[usize; 2]>),
    ) {
        let fixed = self.fixed_nodes();
        if let Some(&first) = fixed.first() {
            let mut nodes = vec![first];
            let mut cost = 0.0;
            for pair in fixed.windows(2) {
                let grid = self.grid(dissimilarities, pair[0], pair[1]);
                let width = grid.source.len() - 1;
                let route = (grid.step_costs()).cheapest_path(
                    [0, width],
                    |_| [0, width],
                    &mut PathBuffers::default(),
                );
                cost += route.cost;
                nodes.extend(translated_nodes(&route, pair[0]).skip(1));
            }
            return visit(cost, &|| nodes.clone());
        }
        let (n, m) = (self.source.places.len(), self.target.places.len());
        // The grid runs around the source twice, so that a path may begin at any of the source's
        // samples.
        let grid = self.grid(dissimilarities, [0, 0], [2 * n, m]);
        for route in cheapest_path_per_start(&grid.step_costs(), n) {
            visit(route.cost, &|| route.nodes());
        }
    }

    /// Returns the nodes (pairs of sample indices) of the pins in ascending order. The first of
    /// them is repeated at the end, with its indices one round later. The list is empty without
    /// pins.
    pub(super) fn fixed_nodes(&self) -> Vec<[usize; 2]> {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let node =
            |pin: &[f64; 2]| Some([self.source.index_of(pin[0])?, self.target.index_of(pin[1])?]);
        let mut nodes: Vec<[usize; 2]> = self.pins.iter().filter_map(node).collect();
        if let Some(&first) = nodes.first() {
            for node in &mut nodes {
                // A target index below that of the first node belongs to the next round. Add the
                // number of target samples, `m`, so that the nodes ascend.
                if node[1] < first[1] {
                    node[1] += m;
                }
            }
            nodes.push([first[0] + n, first[1] + m]);
        }
        nodes
    }

    /// Returns the section of the grid of sample pairs between the nodes `from` and `to`, both
    /// included. `dissimilarities` has one row for each target sample.
    pub(super) fn grid(
        &self,
        dissimilarities: &[f64],
        from: [usize; 2],
        to: [usize; 2],
    ) -> PathGrid {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let mut window = Vec::with_capacity((to[0] + 1 - from[0]) * (to[1] + 1 - from[1]));
        for j in from[1]..=to[1] {
            let row = &dissimilarities[(j % m) * n..][..n];
            window.extend((from[0]..=to[0]).map(|i| row[i % n]));
        }
        PathGrid {
            source: (from[0]..=to[0])
                .map(|i| self.source.unwrapped_place(i))
                .collect(),
            target: (from[1]..=to[1])
                .map(|j| self.target.unwrapped_place(j))
                .collect(),
            dissimilarity: window,
            stretch: self.stretch,
        }
    }

    /// Returns the rotation of the source about its centre that best aligns its matched points with
    /// the target's, in radians (least squares, weighted by arc length).
    pub(super) fn rotation(&self, nodes: &[[usize; 2]]) -> f64 {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let mut direction = DVec2::ZERO;
        for step in nodes.windows(2) {
            let [[a, b], [i, j]] = [step[0], step[1]];
            let length = self.source.unwrapped_place(i) - self.source.unwrapped_place(a)
                + self.target.unwrapped_place(j)
                - self.target.unwrapped_place(b);
            for [i, j] in [[a, b], [i, j]] {
                let p = self.source_features.position(i % n);
                let q = self.target_features.position(j % m);
                direction += length * DVec2::new(p.dot(q), p.perp_dot(q));
            }
        }
        // If the rotation is undefined, for example because all matched points coincide, do not
        // rotate.
        if direction.length() < 1e-9 {
            0.0
        } else {
            direction.to_angle()
        }
    }
}

/// Returns the nodes of a route through a section of the grid, with indices in the whole grid. The
/// section starts at the node `from` of the whole grid.
fn translated_nodes(route: &GridPath, from: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    let nodes = route.nodes().into_iter();
    nodes.map(move |[i, j]| [i + from[0], j + from[1]])
}
