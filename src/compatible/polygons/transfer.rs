//! The foldover-free transfer: one polygon's refined triangulation carried
//! to the other.
//!
//! The boundary goes where it must, the interior follows harmonically (Tutte
//! 1963), and fold-overs are removed ([`super::untangle`]). It gives good
//! angles cheaply and guarantees nothing: where folds remain there is no
//! result.

use super::boundary_rings::BoundaryRings;
use super::options::PolygonOptions;
use super::pair_mesh::PairMesh;
use super::untangle::untangle;
use crate::geometry::{Bounds, DVec2, SimilarityFit};
use crate::mesh::triangulation::{RefinementOptions, refined_delaunay};
use crate::numerics::{Cholesky, SymmetricMatrix};
use crate::work::progress::{Cancelled, Progress, checkpoint, still_wanted};

/// Rounds of shrinking ε: a bound for those that win a fold now and then; as a
/// rule [`PATIENCE`] ends it.
pub(super) const MAX_ROUNDS: usize = 60;
/// Rounds after which a transfer is not gone on with, if that in the other direction is
/// done by then.
pub(super) const FIRST_ROUNDS: usize = PATIENCE;
/// Rounds in which the folds become fewer by a quarter, or it is given up: a trade,
/// since the other direction and the base are left. Of 1404 transfers between icons 112
/// stay folded; to see it of them took 3.0 s, now 1.7 s, and three others are given up as
/// well, whose folds went away in 16 to 39 rounds.
const PATIENCE: usize = 6;
const LEFT: f64 = 0.75;

/// One polygon's refined triangulation on its way to the other.
pub(super) struct Transfer {
    mesh: PairMesh,
    folds: FoldHistory,
}

impl Transfer {
    /// Both polygons' common mesh, refined in the first and laid over the second, where
    /// it may fold; `None` where there is none.
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
            max_points: options.most_points(from.points.len()),
        };
        // The base is made of the same walks, and says what is wrong with them.
        let start = refined_delaunay(&from.walks(), &refinement, progress);
        still_wanted(progress)?;
        let Ok(start) = start else {
            return Ok(None);
        };
        let (n, points) = (from.points.len(), start.points);
        let mut mesh = PairMesh::new(n, [points.clone(), points], start.faces);
        split_chords(&mut mesh);
        let is_laid = laid_over(&mut mesh, &to.points, progress)?;
        let folds = FoldHistory::default();
        Ok(is_laid.then_some(Self { mesh, folds }))
    }

    /// As far as it gets in so many rounds in all.
    pub(super) fn unfold(
        &mut self,
        rounds: usize,
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        self.folds.remove(&mut self.mesh, rounds, progress)
    }

    /// No face is folded.
    pub(super) fn is_done(&self) -> bool {
        self.mesh.is_valid()
    }

    /// The mesh, if no face of it is folded.
    pub(super) fn done(self) -> Option<PairMesh> {
        self.is_done().then_some(self.mesh)
    }
}

/// Carries a mesh whose first vertices belong at `to` in the second design;
/// folds may remain.
pub(super) fn transfer_onto(
    mesh: &mut PairMesh,
    to: &[DVec2],
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    if laid_over(mesh, to, progress)? {
        FoldHistory::default().remove(mesh, MAX_ROUNDS, progress)?;
    }
    Ok(())
}

/// Lays a mesh whose first vertices belong at `to` over the second design; whether there
/// is a way to.
fn laid_over(
    mesh: &mut PairMesh,
    to: &[DVec2],
    progress: &dyn Progress,
) -> Result<bool, Cancelled> {
    // The harmonic map would distort even what is only laid elsewhere.
    lay(mesh, to);
    if mesh.is_valid() {
        return Ok(true);
    }
    let Some(harmonic) = harmonic(mesh, to, progress) else {
        still_wanted(progress)?;
        return Ok(false);
    };
    mesh.points[1] = harmonic;
    Ok(true)
}

/// Carries a valid mesh on: its first vertices move to `to` in the second
/// design, the others start from where they are; folds may remain.
pub(super) fn continue_transfer(
    mesh: &mut PairMesh,
    to: &[DVec2],
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    mesh.points[1][..mesh.fixed].copy_from_slice(&to[..mesh.fixed]);
    FoldHistory::default().remove(mesh, MAX_ROUNDS, progress)
}

/// The folds of a mesh, as they become fewer.
#[derive(Default)]
struct FoldHistory {
    /// The fewest before each round.
    fewest: Vec<usize>,
    is_given_up: bool,
}

impl FoldHistory {
    /// Goes on until there are none, it is of no use, or so many rounds are done in all.
    fn remove(
        &mut self,
        mesh: &mut PairMesh,
        rounds: usize,
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        while !self.is_given_up && self.fewest.len() < rounds {
            let folds = mesh.folds();
            if folds == 0 {
                break;
            }
            let round = self.fewest.len();
            checkpoint(progress, "removing folds", round as f64 / MAX_ROUNDS as f64)?;
            let fewest = self.fewest.last().map_or(folds, |&least| least.min(folds));
            self.fewest.push(fewest);
            self.is_given_up = self.is_of_no_use() || !untangle(mesh, progress);
        }
        still_wanted(progress)
    }

    fn is_of_no_use(&self) -> bool {
        let now = self.fewest.len() - 1;
        now >= PATIENCE && self.fewest[now] as f64 > LEFT * self.fewest[now - PATIENCE] as f64
    }
}

/// Splits every inner edge between two polygon vertices: the faces beside it
/// would have no freedom.
pub(super) fn split_chords(mesh: &mut PairMesh) {
    let n = mesh.fixed as u32;
    for edge in mesh.inner_edges() {
        if edge.iter().all(|&v| v < n) {
            // A chord too short to have a middle stays.
            mesh.split(edge);
        }
    }
}

/// Lays a mesh onto `to` in the second design, inner vertices by the
/// similarity that fits the polygons best: similar polygons stay undistorted.
fn lay(mesh: &mut PairMesh, to: &[DVec2]) {
    let n = mesh.fixed;
    let [points, placed] = &mut mesh.points;
    placed[..n].copy_from_slice(to);
    // What has no size has no similarity; it is no valid mesh either.
    let Some(fit) = SimilarityFit::of(&points[..n], to) else {
        return;
    };
    let [from, to] = fit.means;
    // As a change, so that equal polygons leave every bit as it is.
    let turn = fit.factor - DVec2::X;
    for (place, &p) in placed[n..].iter_mut().zip(&points[n..]) {
        *place = p + turn.rotate(p - from) + (to - from);
    }
}

/// All vertices in the second design, inner ones the mean of their
/// neighbours.
fn harmonic(mesh: &PairMesh, to: &[DVec2], progress: &dyn Progress) -> Option<Vec<DVec2>> {
    let n = mesh.fixed;
    let inner = mesh.points[0].len() - n;
    let mut matrix = SymmetricMatrix::zero(inner, 8 * inner);
    let mut rhs = vec![DVec2::ZERO; inner];
    for (i, sum) in rhs.iter_mut().enumerate() {
        for u in mesh.neighbours((i + n) as u32) {
            matrix.add(i as u32, i as u32, 1.0);
            match (u as usize).checked_sub(n) {
                // Each edge is met from both ends, and added once.
                Some(j) if j < i => matrix.add(i as u32, j as u32, -1.0),
                Some(_) => {}
                None => *sum += to[u as usize],
            }
        }
    }
    let factor = Cholesky::factor_if_wanted(&matrix, progress).ok()?.ok()?;
    let solve = |side: fn(&DVec2) -> f64| factor.solve(&rhs.iter().map(side).collect::<Vec<_>>());
    let (x, y) = (solve(|p| p.x), solve(|p| p.y));
    let placed = x.into_iter().zip(y).map(|(x, y)| DVec2::new(x, y));
    Some(to.iter().copied().chain(placed).collect())
}
