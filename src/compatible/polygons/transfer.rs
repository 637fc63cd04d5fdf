//! Transfers the refined triangulation of one polygon to another polygon with corresponding
//! vertices.
//!
//! The boundary vertices are placed on the other polygon, the inner vertices are placed by a
//! similarity or, if that causes folds, by a harmonic map (Tutte 1963), and remaining folds are
//! removed ([`super::untangle`]). This gives good angles at low cost. It is not guaranteed that all
//! folds can be removed; if some remain, the transfer has failed.

use super::boundary_rings::BoundaryRings;
use super::options::PolygonOptions;
use super::pair_mesh::PairMesh;
use super::untangle::untangle;
use crate::geometry::{Bounds, DVec2, SimilarityFit};
use crate::mesh::triangulation::{RefinementOptions, refined_delaunay};
use crate::numerics::{Cholesky, SymmetricMatrix};
use crate::work::progress::{Cancelled, Progress, check_cancelled, checkpoint};

/// Maximum number of rounds of fold removal (resource limit: [`PATIENCE`] usually ends the removal
/// earlier).
pub(super) const MAX_ROUNDS: usize = 60;
/// Number of rounds of fold removal after which the transfers, from source to target and from
/// target to source, stop if either is free of folds by then (heuristic).
pub(super) const FIRST_ROUNDS: usize = PATIENCE;
/// Number of rounds of fold removal in which the number of folds must decrease to the fraction
/// [`MAX_REMAINING`]; otherwise the transfer is given up (heuristic).
const PATIENCE: usize = 6;
/// Maximum fraction of the folds that may remain after [`PATIENCE`] rounds (heuristic).
const MAX_REMAINING: f64 = 0.75;

/// Refined triangulation of one polygon while it is transferred to another polygon.
pub(super) struct Transfer {
    mesh: PairMesh,
    folds: FoldHistory,
}

impl Transfer {
    /// Creates a refined triangulation of the polygon `from` and places it on the polygon `to`,
    /// where it may be folded. `None` if `from` cannot be triangulated or the positions of the
    /// inner vertices on `to` cannot be computed.
    pub(super) fn begin(
        from: &BoundaryRings,
        to: &BoundaryRings,
        options: &PolygonOptions,
        progress: &dyn Progress,
    ) -> Result<Option<Self>, Cancelled> {
        let refinement = RefinementOptions {
            max_edge: options
                .edge_length
                .map(|share| share * Bounds::diameter_of(&from.points)),
            max_points: options.max_inner_points(from.points.len()),
        };
        // No error is returned here: the base mesh, which is built next, uses the same rings and
        // reports any fault in them.
        let start = refined_delaunay(&from.loops(), &refinement, progress);
        check_cancelled(progress)?;
        let Ok(start) = start else {
            return Ok(None);
        };
        let (n, points) = (from.points.len(), start.points);
        let mut mesh = PairMesh::new(n, [points.clone(), points], start.faces);
        split_chords(&mut mesh);
        let is_possible = lay_onto(&mut mesh, &to.points, progress)?;
        let folds = FoldHistory::default();
        Ok(is_possible.then_some(Self { mesh, folds }))
    }

    /// Removes folds. Stops at the latest when all calls for this transfer together have used
    /// `rounds` rounds.
    pub(super) fn unfold(
        &mut self,
        rounds: usize,
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        self.folds.remove(&mut self.mesh, rounds, progress)
    }

    /// Returns whether no face is folded in either design.
    pub(super) fn is_fold_free(&self) -> bool {
        self.mesh.is_valid()
    }

    /// Returns the mesh; `None` if a face is folded.
    pub(super) fn into_valid_mesh(self) -> Option<PairMesh> {
        self.is_fold_free().then_some(self.mesh)
    }
}

/// Transfers a mesh to the second design, in which its polygon vertices have the positions `to`.
/// Folds may remain.
pub(super) fn transfer_onto(
    mesh: &mut PairMesh,
    to: &[DVec2],
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    if lay_onto(mesh, to, progress)? {
        FoldHistory::default().remove(mesh, MAX_ROUNDS, progress)?;
    }
    Ok(())
}

/// Places a mesh on the second design, in which its polygon vertices have the positions `to`. Folds
/// may result. Returns false if the positions of the inner vertices cannot be computed.
fn lay_onto(mesh: &mut PairMesh, to: &[DVec2], progress: &dyn Progress) -> Result<bool, Cancelled> {
    // A similarity is tried before the harmonic map. The harmonic map would distort the faces even
    // if the polygon has only been moved, turned or scaled.
    place_onto(mesh, to);
    if mesh.is_valid() {
        return Ok(true);
    }
    let Some(harmonic) = harmonic(mesh, to, progress) else {
        check_cancelled(progress)?;
        return Ok(false);
    };
    mesh.points[1] = harmonic;
    Ok(true)
}

/// Moves the polygon vertices of a valid mesh to the positions `to` in the second design and
/// removes the folds that result. Inner vertices start from their current positions. Folds may
/// remain.
pub(super) fn continue_transfer(
    mesh: &mut PairMesh,
    to: &[DVec2],
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    mesh.points[1][..mesh.fixed].copy_from_slice(&to[..mesh.fixed]);
    FoldHistory::default().remove(mesh, MAX_ROUNDS, progress)
}

/// Record of a fold removal.
#[derive(Default)]
struct FoldHistory {
    /// For each round done: the smallest number of folds counted before that round or before any
    /// earlier round.
    min_folds: Vec<usize>,
    /// Whether the removal was given up, because further rounds are not worthwhile.
    is_given_up: bool,
}

impl FoldHistory {
    /// Removes folds until none is left, until progress stalls, or until `rounds` rounds are done
    /// in total.
    fn remove(
        &mut self,
        mesh: &mut PairMesh,
        rounds: usize,
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        while !self.is_given_up && self.min_folds.len() < rounds {
            let folds = mesh.fold_count();
            if folds == 0 {
                break;
            }
            let round = self.min_folds.len();
            checkpoint(progress, "removing folds", round as f64 / MAX_ROUNDS as f64)?;
            let folds_so_far = self
                .min_folds
                .last()
                .map_or(folds, |&previous| previous.min(folds));
            self.min_folds.push(folds_so_far);
            self.is_given_up = self.is_stalled() || !untangle(mesh, progress);
        }
        check_cancelled(progress)
    }

    /// Returns whether the last [`PATIENCE`] rounds removed too few folds.
    fn is_stalled(&self) -> bool {
        let now = self.min_folds.len() - 1;
        now >= PATIENCE
            && self.min_folds[now] as f64 > MAX_REMAINING * self.min_folds[now - PATIENCE] as f64
    }
}

/// Splits every inner edge between two polygon vertices. Otherwise a face could have polygon
/// vertices only and could not move.
pub(super) fn split_chords(mesh: &mut PairMesh) {
    let n = mesh.fixed as u32;
    for edge in mesh.inner_edges() {
        if edge.iter().all(|&v| v < n) {
            // A chord that is too short to have a distinct midpoint is not split.
            mesh.split(edge);
        }
    }
}

/// Places the polygon vertices at `to` in the second design, and each inner vertex at its image
/// under the similarity that maps the first design's polygon onto `to` best. Similar polygons are
/// therefore not distorted.
fn place_onto(mesh: &mut PairMesh, to: &[DVec2]) {
    let n = mesh.fixed;
    let [points, placed] = &mut mesh.points;
    placed[..n].copy_from_slice(to);
    // Points that all coincide determine no similarity; no valid mesh exists for them either.
    let Some(fit) = SimilarityFit::of(&points[..n], to) else {
        return;
    };
    let [from, to] = fit.means;
    // The similarity is applied as a displacement of each point, so that equal polygons keep their
    // positions bit by bit.
    let turn = fit.factor - DVec2::X;
    for (place, &p) in placed[n..].iter_mut().zip(&points[n..]) {
        *place = p + turn.rotate(p - from) + (to - from);
    }
}

/// Returns the vertex positions in the second design: polygon vertices at `to`, each inner vertex
/// at the mean of its neighbours. `None` if the linear system cannot be solved, or on a cancel.
fn harmonic(mesh: &PairMesh, to: &[DVec2], progress: &dyn Progress) -> Option<Vec<DVec2>> {
    let n = mesh.fixed;
    let inner = mesh.points[0].len() - n;
    let mut matrix = SymmetricMatrix::zero(inner, 8 * inner);
    let mut rhs = vec![DVec2::ZERO; inner];
    for (i, sum) in rhs.iter_mut().enumerate() {
        for u in mesh.neighbours((i + n) as u32) {
            // Equal weights of all neighbours keep the matrix positive definite, whatever the
            // shapes of the faces.
            matrix.add(i as u32, i as u32, 1.0);
            match (u as usize).checked_sub(n) {
                // Each edge is visited from both ends, but its entry is added only once.
                Some(j) if j < i => matrix.add(i as u32, j as u32, -1.0),
                Some(_) => {}
                None => *sum += to[u as usize],
            }
        }
    }
    let factor = Cholesky::factor_cancellable(&matrix, progress).ok()?.ok()?;
    let solve = |side: fn(&DVec2) -> f64| factor.solve(&rhs.iter().map(side).collect::<Vec<_>>());
    let (x, y) = (solve(|p| p.x), solve(|p| p.y));
    let placed = x.into_iter().zip(y).map(|(x, y)| DVec2::new(x, y));
    Some(to.iter().copied().chain(placed).collect())
}
