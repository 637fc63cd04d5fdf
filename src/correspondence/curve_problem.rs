//! Two sampled curves and the cheapest closed paths through their pairs.
//!
//! [`super::boundary`] says what is guaranteed. Indices of nodes are counted
//! on over the seams: sample n is sample 0 one round on.

use super::curve::BoundaryCurve;
use super::cyclic::all_starts;
use super::features::BoundaryFeatures;
use super::inner_descriptors::InnerDescriptors;
use super::options::MatchOptions;
use super::path_grid::{GridPath, PathBuffers, PathGrid};
use super::samples::CurveSamples;
use crate::geometry::DVec2;

/// With so many samples the poses are chosen among by a match of fewer.
/// Below, a coarse search saves less than it costs; at 160 samples it is one
/// with 80, a quarter of the price.
const MANY: u32 = 96;

/// Two sampled curves.
pub(super) struct CurveMatchProblem {
    pub(super) source: CurveSamples,
    pub(super) target: CurveSamples,
    pub(super) source_features: BoundaryFeatures,
    pub(super) target_features: BoundaryFeatures,
    pub(super) pins: Vec<[f64; 2]>,
    stretch: f64,
    pub(super) thickness: f64,
    pub(super) keep_up: bool,
    pub(super) price_inside: f64,
    /// None where they have no price.
    pub(super) inner: Option<[InnerDescriptors; 2]>,
    /// The same with fewer samples, to tell which poses are worth a full
    /// search; none where the full one is small.
    pub(super) coarse: Option<Box<Self>>,
}

impl CurveMatchProblem {
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
        let is_priced = options.inner > 0.0;
        let inner = |curve, samples| {
            is_priced
                .then(|| InnerDescriptors::of(curve, samples))
                .flatten()
        };
        Self {
            price_inside: options.inner,
            inner: inner(source, &a).zip(inner(target, &b)).map(<[_; 2]>::from),
            source_features: BoundaryFeatures::of(source, &a),
            target_features: BoundaryFeatures::of(target, &b),
            source: a,
            target: b,
            pins,
            stretch: options.stretch,
            thickness: options.thickness,
            keep_up: options.keep_up,
            coarse: (options.samples >= MANY).then(|| {
                let samples = options.samples.div_ceil(2).min(MANY);
                let fewer = MatchOptions {
                    samples,
                    ..options.clone()
                };
                Box::new(Self::new(source, target, all_pins, &fewer))
            }),
        }
    }

    /// Visits cost and nodes of the cheapest path of each start; of the one
    /// path where pins leave no choice.
    pub(super) fn visit_paths(
        &self,
        unlike: &[f64],
        mut visit: impl FnMut(f64, &dyn Fn() -> Vec<[usize; 2]>),
    ) {
        let fixed = self.fixed_nodes();
        if let Some(&first) = fixed.first() {
            let mut nodes = vec![first];
            let mut cost = 0.0;
            for ends in fixed.windows(2) {
                let grid = self.grid(unlike, ends[0], ends[1]);
                let width = grid.source.len() - 1;
                let route = (grid.prices()).shortest(
                    [0, width],
                    |_| [0, width],
                    &mut PathBuffers::default(),
                );
                cost += route.cost;
                nodes.extend(moved(&route, ends[0]).skip(1));
            }
            return visit(cost, &|| nodes.clone());
        }
        let (n, m) = (self.source.places.len(), self.target.places.len());
        // The source twice round: a path may begin at any of its samples.
        let grid = self.grid(unlike, [0, 0], [2 * n, m]);
        for route in all_starts(&grid.prices(), n) {
            visit(route.cost, &|| route.nodes());
        }
    }

    /// Nodes that every path visits, ascending, from a first one to its like
    /// one round on; none without pins.
    pub(super) fn fixed_nodes(&self) -> Vec<[usize; 2]> {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let node =
            |pin: &[f64; 2]| Some([self.source.index_of(pin[0])?, self.target.index_of(pin[1])?]);
        let mut nodes: Vec<[usize; 2]> = self.pins.iter().filter_map(node).collect();
        if let Some(&first) = nodes.first() {
            for node in &mut nodes {
                // Counted on over the target's seam, so that they ascend.
                if node[1] < first[1] {
                    node[1] += m;
                }
            }
            nodes.push([first[0] + n, first[1] + m]);
        }
        nodes
    }

    /// The window of pairs from one node to another, both included.
    pub(super) fn grid(&self, unlike: &[f64], from: [usize; 2], to: [usize; 2]) -> PathGrid {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let mut window = Vec::with_capacity((to[0] + 1 - from[0]) * (to[1] + 1 - from[1]));
        for j in from[1]..=to[1] {
            let round = &unlike[(j % m) * n..][..n];
            window.extend((from[0]..=to[0]).map(|i| round[i % n]));
        }
        PathGrid {
            source: (from[0]..=to[0]).map(|i| self.source.unrolled(i)).collect(),
            target: (from[1]..=to[1]).map(|j| self.target.unrolled(j)).collect(),
            unlike: window,
            stretch: self.stretch,
        }
    }

    /// The rotation of the source's matched points onto the target's.
    pub(super) fn rotation(&self, nodes: &[[usize; 2]]) -> f64 {
        let (n, m) = (self.source.places.len(), self.target.places.len());
        let mut sum = DVec2::ZERO;
        for step in nodes.windows(2) {
            let [[a, b], [i, j]] = [step[0], step[1]];
            let walked = self.source.unrolled(i) - self.source.unrolled(a)
                + self.target.unrolled(j)
                - self.target.unrolled(b);
            for [i, j] in [[a, b], [i, j]] {
                let p = self.source_features.position(i % n);
                let q = self.target_features.position(j % m);
                sum += walked * DVec2::new(p.dot(q), p.perp_dot(q));
            }
        }
        // Shapes without a direction of their own are not turned.
        if sum.length() < 1e-9 {
            0.0
        } else {
            sum.to_angle()
        }
    }
}

/// The nodes of a route in a window that starts at `from`.
fn moved(route: &GridPath, from: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    let nodes = route.nodes().into_iter();
    nodes.map(move |[i, j]| [i + from[0], j + from[1]])
}
