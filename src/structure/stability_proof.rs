//! Proof that a recorded structure stands at every t.
//!
//! Whether a structure is a mechanism depends on the directions of its members, not on their
//! stiffnesses. With d = x_j − x_i for a member, G = Σ d dᵀ/ℓ², and similar terms for the bending of
//! members, has the rank of the stiffness matrix K. On an interval of a recording, x is a polynomial
//! of t, and G is one too, with Bernstein coefficients G_k that are matrices. If all G_k are
//! positive definite by more than the bound ε on all errors, G is positive definite on the whole
//! interval and the structure stands; else both halves of the interval are examined.
//!
//! Supports, members and fixities that not all designs have are left out: without them the
//! structure is the weaker one, so that the proof holds. Guaranteed: every reported proof is
//! true. Not guaranteed: that every structure that stands is proved, for example one that needs two
//! different supports in its two designs.

use super::blend::{LoadSelection, StructuralBlend};
use super::error::StructureError;
use super::node_axes::NodeAxes;
use super::pattern::NodeMatrix;
use super::sample::StructureSample;
use super::solver::StructureSolver;
use crate::geometry::DVec2;
use crate::recording::Recording;
use crate::recording::proof::{
    BernsteinProducts, EPS, MotionInterval, VertexCurve, degree_elevated,
};
use crate::work::progress::{Cancelled, Progress, check_cancelled, checkpoint};
use serde::Serialize;
use std::sync::Arc;

/// Maximum number of halvings of an interval of the recording (resource limit).
const MAX_DEPTH: u32 = 20;

/// Maximum number of examined intervals (resource limit).
const MAX_INTERVALS: usize = 2_000;

/// Result of examining whether a structure stands at every t, with the extent of the work.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StabilityProof {
    /// The first t at which the structure is not proved to stand; `None` if it stands at every t.
    pub fails_at: Option<f64>,
    /// Nodes that move at this t, in the first mode of the structure; empty if it stands.
    pub moving_nodes: Vec<u32>,
    /// Whether the structure is a mechanism at this t. If not, it is only not proved to stand.
    pub is_mechanism: bool,
    /// Number of intervals of t for which the structure was proved to stand.
    pub intervals: usize,
    /// Number of matrices that were factored.
    pub factorisations: usize,
}

impl StabilityProof {
    /// Returns whether the structure is proved to stand at every t.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.fails_at.is_none()
    }

    /// Returns the same result, or, if the structure is only not proved to stand, the first sample
    /// that is a mechanism.
    pub(super) fn confirmed_by(self, samples: &[StructureSample]) -> Self {
        let mechanism = samples.iter().find(|sample| !sample.stands());
        match mechanism {
            Some(sample) if !self.is_mechanism => Self {
                fails_at: Some(sample.t),
                moving_nodes: sample.moving_nodes.clone(),
                is_mechanism: true,
                ..self
            },
            _ => self,
        }
    }

    /// Examines a structure whose nodes are the first vertices of a recording of a pair of designs.
    ///
    /// # Errors
    /// [`StructureError`] if the system does not fit into memory, or if the work is cancelled.
    pub fn of(
        blend: &Arc<StructuralBlend>,
        recording: &Recording,
        progress: &dyn Progress,
    ) -> Result<Self, StructureError> {
        let mut prover = Prover::new(blend)?;
        let mut fails_at = None;
        for interval in recording.motion_intervals(blend.node_count()) {
            checkpoint(progress, "proving", interval.times[0])?;
            fails_at = prover.first_failure(&interval, 0, progress)?;
            if fails_at.is_some() {
                break;
            }
        }
        let mut proof = Self {
            fails_at,
            moving_nodes: Vec::new(),
            is_mechanism: false,
            intervals: prover.intervals,
            factorisations: prover.factorisations,
        };
        if let Some(t) = fails_at {
            let mut solver = StructureSolver::new(Arc::clone(blend))?;
            let mut places = vec![DVec2::ZERO; blend.node_count()];
            recording.write_places(t, &mut places);
            let weights = StructuralBlend::pair_weights(t);
            let state = solver.solve(&places, &weights, LoadSelection::All);
            proof.moving_nodes = state.moving_nodes();
            proof.is_mechanism = state.is_mechanism;
        }
        Ok(proof)
    }
}

/// Row of a member's deformation as a polynomial: for each Bernstein coefficient, the factors of
/// the six displacements of its nodes.
struct DeformationRow {
    coefficients: Vec<[f64; 6]>,
    /// Bound on the error of each factor.
    error: f64,
    /// Factor by which the square of the deformation is multiplied, positive.
    weight: f64,
}

/// Members that all designs have, the displacements that all fix, and the matrix of the system.
struct Prover<'a> {
    blend: &'a StructuralBlend,
    /// For each member, whether it has an area in all designs, and whether each end bends.
    is_counted: Vec<(bool, [bool; 2])>,
    is_frame: bool,
    axes: Vec<NodeAxes>,
    matrix: NodeMatrix,
    intervals: usize,
    examined: usize,
    factorisations: usize,
}

impl<'a> Prover<'a> {
    fn new(blend: &'a StructuralBlend) -> Result<Self, StructureError> {
        let mut axes = vec![NodeAxes::FREE; blend.node_count()];
        let equal = vec![1.0 / blend.design_count() as f64; blend.design_count()];
        for restraint in blend.restraints.iter().filter(|all| all.is_constant()) {
            let mut at = restraint.at(&equal);
            at.presence = 1.0;
            axes[at.node as usize].fix(&at);
        }
        let counted = |bar: usize| {
            let all = blend.properties_in_designs(bar);
            let has = |is: &dyn Fn(usize) -> bool| (0..all.len()).all(is);
            let has_area = has(&|design| all[design].area > 0.0);
            let bends = |end: usize| {
                has_area && has(&|design| all[design].fixity[end] > 0.0 && all[design].radius > 0.0)
            };
            (has_area, [bends(0), bends(1)])
        };
        let is_counted: Vec<_> = (0..blend.bars().len()).map(counted).collect();
        Ok(Self {
            matrix: NodeMatrix::new(blend.node_count(), blend.bars())?,
            is_frame: is_counted.iter().any(|(_, bends)| bends[0] || bends[1]),
            is_counted,
            axes,
            blend,
            intervals: 0,
            examined: 0,
            factorisations: 0,
        })
    }

    /// Returns the first t in the interval at which the structure is not proved to stand.
    fn first_failure(
        &mut self,
        interval: &MotionInterval,
        depth: u32,
        progress: &dyn Progress,
    ) -> Result<Option<f64>, Cancelled> {
        check_cancelled(progress)?;
        self.examined += 1;
        let [from, to] = interval.times;
        match self.examine(&interval.curves) {
            IntervalResult::Stands => {
                self.intervals += 1;
                return Ok(None);
            }
            IntervalResult::FailsAtStart => return Ok(Some(from)),
            IntervalResult::Unknown if depth == MAX_DEPTH || self.examined >= MAX_INTERVALS => {
                return Ok(Some(from));
            }
            IntervalResult::Unknown => {}
        }
        let [left, right] = interval.halves();
        if let Some(t) = self.first_failure(&left, depth + 1, progress)? {
            return Ok(Some(t));
        }
        let failure = self.first_failure(&right, depth + 1, progress)?;
        debug_assert!(failure.is_none_or(|t| (from..=to).contains(&t)));
        Ok(failure)
    }

    /// Examines whether all coefficients of G are positive definite for the given curves.
    fn examine(&mut self, curves: &[VertexCurve]) -> IntervalResult {
        // Rotations are multiplied by a typical length, so that all unknowns are lengths.
        let ends = self
            .blend
            .bars()
            .iter()
            .map(|bar| bar.map(|node| &curves[node as usize]));
        let lengths = ends.map(|[a, b]| a.control_points[0].distance(b.control_points[0]));
        let typical = lengths.sum::<f64>() / self.blend.bars().len() as f64;
        let degree = curves
            .first()
            .map_or(1, |curve| curve.control_points.len() - 1);
        let degree = if self.is_frame { 2 * degree } else { degree };
        let products = BernsteinProducts::of_degree(degree);
        let mut bounds = vec![0.0; self.axes.len()];
        let mut blocks = Vec::with_capacity(self.is_counted.len());
        for (bar, ends) in self.blend.bars().iter().enumerate() {
            let rows = self.rows(bar, curves, typical);
            let mut sums = vec![[[0.0; 6]; 6]; 2 * degree + 1];
            for row in &rows {
                let largest = row
                    .coefficients
                    .iter()
                    .flatten()
                    .fold(0.0, |m: f64, c| m.max(c.abs()));
                let rounding = (2 * degree + 8) as f64 * EPS * largest * largest;
                let entry = 2.0 * largest * row.error + row.error * row.error + rounding;
                for &node in ends {
                    bounds[node as usize] += 6.0 * row.weight * entry;
                }
                add_products(&mut sums, row, &products);
            }
            blocks.push(sums);
        }
        let bound = bounds.into_iter().fold(0.0, f64::max);
        let last = 2 * degree;
        // The first coefficient is G itself at the start of the interval.
        let order = std::iter::once(0).chain((1..=last).rev());
        for k in order {
            if !self.is_definite(&blocks, k, bound) {
                return match k {
                    0 => IntervalResult::FailsAtStart,
                    _ => IntervalResult::Unknown,
                };
            }
        }
        IntervalResult::Stands
    }

    /// Returns whether coefficient `k` of G is positive definite by more than `bound`.
    fn is_definite(&mut self, blocks: &[Vec<[[f64; 6]; 6]>], k: usize, bound: f64) -> bool {
        self.factorisations += 1;
        self.matrix.values.fill(0.0);
        for (member, block) in blocks.iter().enumerate() {
            self.matrix.add_element(member, |i, j| block[k][i][j]);
        }
        let unknowns = 3 * self.axes.len();
        // Backward error of the Cholesky factorisation (Higham 2002, theorem 10.3).
        let rounding = (unknowns + 1) as f64 * EPS * self.matrix.largest_diagonal();
        let shift = -(bound + 2.0 * rounding);
        let axes = &self.axes;
        let has_rotation: Vec<bool> = (0..axes.len())
            .map(|node| self.matrix.diagonal(3 * node + 2) > 0.0)
            .collect();
        let is_fixed = |unknown: usize| {
            let (node, kind) = (unknown / 3, unknown % 3);
            axes[node].is_fixed[kind] || (kind == 2 && !has_rotation[node])
        };
        self.matrix.factor(is_fixed, |_| shift)
    }

    /// Returns the deformations of a member that resist in all designs.
    fn rows(&self, bar: usize, curves: &[VertexCurve], typical: f64) -> Vec<DeformationRow> {
        let (has_area, bends) = self.is_counted[bar];
        if !has_area {
            return Vec::new();
        }
        let [a, b] = self.blend.bars()[bar].map(|node| &curves[node as usize]);
        let axes = self.blend.bars()[bar].map(|node| self.axes[node as usize].x);
        let span: Vec<DVec2> = (a.control_points.iter().zip(&b.control_points))
            .map(|(a, b)| *b - *a)
            .collect();
        let longest = span.iter().map(|d| d.length()).fold(0.0, f64::max);
        let error = 3.0 * (a.error + b.error) + 2.0 * EPS * longest;
        let weight = (longest * longest).recip();
        let vectors = if self.is_frame {
            elevated(&span)
        } else {
            span.clone()
        };
        let elevation = span.len() as f64 * EPS * longest;
        let mut rows = vec![DeformationRow {
            coefficients: vectors
                .iter()
                .map(|&d| coefficient(-d, axes, [0.0; 2]))
                .collect(),
            error: error + elevation,
            weight,
        }];
        let squares = squared(&span);
        for end in (0..2).filter(|&end| bends[end]) {
            let coefficients = vectors.iter().zip(&squares).map(|(d, square)| {
                let mut ends = [0.0; 2];
                ends[end] = square / typical;
                coefficient(d.perp(), axes, ends)
            });
            let of_square = 4.0 * longest * error
                + 2.0 * error * error
                + (2 * span.len() + 8) as f64 * EPS * longest * longest;
            rows.push(DeformationRow {
                coefficients: coefficients.collect(),
                error: (error + elevation).max(of_square / typical),
                weight,
            });
        }
        rows
    }
}

/// Returns the factors of the six displacements in a deformation: the dot product of `vector` with
/// the displacement of the first node minus that of the second, plus `ends` times the rotations.
fn coefficient(vector: DVec2, [x1, x2]: [DVec2; 2], ends: [f64; 2]) -> [f64; 6] {
    [
        vector.dot(x1),
        vector.dot(x1.perp()),
        ends[0],
        -vector.dot(x2),
        -vector.dot(x2.perp()),
        ends[1],
    ]
}

/// Result of examining one interval.
enum IntervalResult {
    Stands,
    /// The structure is not proved to stand at the start of the interval.
    FailsAtStart,
    Unknown,
}

/// Adds the products of a row with itself to the coefficients of G of its member.
fn add_products(sums: &mut [[[f64; 6]; 6]], row: &DeformationRow, products: &BernsteinProducts) {
    for (p, first) in row.coefficients.iter().enumerate() {
        for (q, second) in row.coefficients.iter().enumerate() {
            let weight = row.weight * products.weight(p, q);
            let sum = &mut sums[p + q];
            for (sum, a) in sum.iter_mut().zip(first) {
                for (sum, b) in sum.iter_mut().zip(second) {
                    *sum += weight * a * b;
                }
            }
        }
    }
}

/// Returns the Bernstein coefficients of the same vector in twice the degree.
fn elevated(vectors: &[DVec2]) -> Vec<DVec2> {
    let coordinate = |of: fn(&DVec2) -> f64| {
        let mut coefficients: Vec<f64> = vectors.iter().map(of).collect();
        while coefficients.len() < 2 * vectors.len() - 1 {
            coefficients = degree_elevated(&coefficients);
        }
        coefficients
    };
    let (x, y) = (coordinate(|d| d.x), coordinate(|d| d.y));
    x.into_iter()
        .zip(y)
        .map(|(x, y)| DVec2::new(x, y))
        .collect()
}

/// Returns the Bernstein coefficients of the squared length of a vector.
fn squared(vectors: &[DVec2]) -> Vec<f64> {
    let degree = vectors.len() - 1;
    let products = BernsteinProducts::of_degree(degree);
    let mut sums = vec![0.0; 2 * degree + 1];
    for (p, first) in vectors.iter().enumerate() {
        for (q, second) in vectors.iter().enumerate() {
            sums[p + q] += products.weight(p, q) * first.dot(*second);
        }
    }
    sums
}
