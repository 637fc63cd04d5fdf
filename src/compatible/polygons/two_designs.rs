//! Compatible triangulation of one piece in two designs: transfers the triangulation of each design
//! to the other, builds the base mesh if both transfers fail, and then improves the angles.

use super::boundary_rings;
use super::boundary_rings::BoundaryRings;
use super::error::PieceMeshError;
use super::options::{MIN_EDGE_LENGTH, PolygonOptions};
use super::pair_mesh::{PairMesh, unit_scale};
use super::transfer::{FIRST_ROUNDS, MAX_ROUNDS, Transfer};
use super::{bridges, coarsen, face_cost, mesh_energy, quality};
use crate::compatible::CompatibleMesh;
use crate::compatible::assembly::MeshAssembly;
use crate::geometry::{DVec2, Side, lexicographic};
use crate::work::progress::{Cancelled, Progress, ProgressShares, ProgressSpan, checkpoint};
use rayon::prelude::*;

/// Maximum number of boundary points for which the base mesh is built directly; larger pieces are
/// coarsened first (resource limit: 200 corners can cause 39,000 crossings, and each becomes a
/// vertex).
const MAX_BASE_POINTS: usize = 200;

/// Progress reported once the transfers are done, in [0, 1] (heuristic).
const PROGRESS_AFTER_TRANSFER: f64 = 0.5;
/// Progress reported once the base mesh is built, in [0, 1] (heuristic).
const PROGRESS_AFTER_BASE: f64 = 0.7;

impl CompatibleMesh {
    /// Triangulates one connected piece in two designs with the same faces.
    ///
    /// Ring 0 is the outer boundary, counter-clockwise; the other rings are holes, clockwise. Point
    /// i of a ring corresponds to point i of that ring in the other design. The first vertices of
    /// the mesh are the ring points, ring after ring; inner vertices follow.
    ///
    /// In one design or in both, a ring may run along a slit: there and back over points with the
    /// same coordinates, as in a letter D that is cut open. The two banks of the slit become
    /// separate vertices.
    ///
    /// # Errors
    /// [`PieceMeshError`] if the rings of the designs do not correspond or are not a valid
    /// boundary, if the piece is too thin for floating-point precision, or if the work is
    /// cancelled.
    ///
    /// ```
    /// use morphospace::compatible::{CompatibleMesh, PolygonOptions};
    /// use morphospace::{geometry::DVec2, work::progress::Silent};
    /// let square = |r: f64| [(-r, -r), (r, -r), (r, r), (-r, r)].map(DVec2::from).to_vec();
    /// let hole = |r: f64| square(r).into_iter().rev().collect();
    /// let (thin, thick) = ([square(2.0), hole(1.5)], [square(2.0), hole(0.5)]);
    /// let mesh = CompatibleMesh::from_piece(&thin, &thick, &PolygonOptions::default(), &Silent)?;
    /// assert_eq!(mesh.boundary_loops().len(), 2);
    /// # Ok::<(), morphospace::compatible::PieceMeshError>(())
    /// ```
    pub fn from_piece<R: AsRef<[DVec2]>>(
        source: &[R],
        target: &[R],
        options: &PolygonOptions,
        progress: &dyn Progress,
    ) -> Result<Self, PieceMeshError> {
        check(source, target, options)?;
        let design_rings = [source, target].map(BoundaryRings::of);
        // At a diameter near 1 no product overflows or underflows, as exact predicates require.
        let scales = [&design_rings[0], &design_rings[1]].map(|rings| unit_scale(&rings.points));
        let [p, q] = [0, 1].map(|d| design_rings[d].scaled(scales[d]));
        let enlarged = |error: PieceMeshError| error.scaled(scales.map(f64::recip));
        boundary_rings::validate_rings(&p, Side::Source).map_err(enlarged)?;
        boundary_rings::validate_rings(&q, Side::Target).map_err(enlarged)?;
        // A pair is always solved in the order of `precedes`. If the designs were exchanged for
        // this, the result is exchanged back.
        let mesh = if precedes(&p, &q) {
            triangulate_pair(&p, &q, options, progress)
        } else {
            let back = triangulate_pair(&q, &p, options, progress);
            back.map(PairMesh::swapped).map_err(PieceMeshError::swapped)
        };
        let mesh = mesh.map_err(enlarged)?;
        let design_rings = design_rings.each_ref().map(|rings| &rings.points[..]);
        mesh.to_compatible_mesh(scales, design_rings)
            .map_err(PieceMeshError::Mesh)
    }
}

/// Checks the options, and that both designs have the same numbers of rings and of points in each
/// ring.
fn check<R: AsRef<[DVec2]>>(
    source: &[R],
    target: &[R],
    options: &PolygonOptions,
) -> Result<(), PieceMeshError> {
    if source.len() != target.len() {
        return Err(PieceMeshError::RingCounts([source.len(), target.len()]));
    }
    let lengths = |rings: &[R]| rings.iter().map(|r| r.as_ref().len()).collect::<Vec<_>>();
    for (ring, (a, b)) in lengths(source).into_iter().zip(lengths(target)).enumerate() {
        if a != b {
            let points = [a, b];
            return Err(PieceMeshError::PointCounts { ring, points });
        }
    }
    match options.edge_length {
        Some(share) if share.is_nan() || share < MIN_EDGE_LENGTH => {
            Err(PieceMeshError::EdgeLength(share))
        }
        _ => Ok(()),
    }
}

/// Returns whether the design `a` comes before `b` in a fixed total order. Every pair is solved in
/// this order, so that exchanging its designs gives the same mesh.
pub(super) fn precedes(a: &BoundaryRings, b: &BoundaryRings) -> bool {
    // Adding zero turns -0 into 0, so that equal coordinates compare as equal.
    let coordinates = |rings: &BoundaryRings| -> Vec<f64> {
        let points = rings.points.iter();
        points.flat_map(|p| (*p + 0.0).to_array()).collect()
    };
    lexicographic(coordinates(a), coordinates(b)).is_le()
}

/// Triangulates a checked piece in two designs. Exchanging the designs may give another mesh; a
/// caller that needs symmetry orders them by [`precedes`].
pub(super) fn triangulate_pair(
    source: &BoundaryRings,
    target: &BoundaryRings,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<PairMesh, PieceMeshError> {
    checkpoint(progress, "triangulating", 0.0)?;
    let transfer_progress = ProgressSpan::new(progress, 0.0, PROGRESS_AFTER_TRANSFER);
    let best = best_transfer(source, target, options, &transfer_progress)?;
    let mut mesh = match best {
        Some(mesh) => mesh,
        None => from_base(
            source,
            target,
            &ProgressSpan::new(progress, PROGRESS_AFTER_TRANSFER, PROGRESS_AFTER_BASE),
        )?,
    };
    quality::improve(
        &mut mesh,
        options,
        &ProgressSpan::new(progress, PROGRESS_AFTER_BASE, 1.0),
    )?;
    Ok(mesh)
}

/// Returns the better of the transfers in both directions; `None` if both still have folds.
fn best_transfer(
    source: &BoundaryRings,
    target: &BoundaryRings,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<Option<PairMesh>, Cancelled> {
    let shares = ProgressShares::new(progress, 2);
    let shares = [shares.part(0), shares.part(1)];
    // The outlines do not show which direction of transfer is better, so both are tried.
    let directions = [(source, target), (target, source)].into_par_iter();
    let begun = directions
        .zip(&shares)
        .map(|((from, to), share)| Transfer::begin(from, to, options, share));
    let mut transfers: Vec<Option<Transfer>> = begun.collect::<Result<_, _>>()?;
    // The transfers in both directions get a few rounds of fold removal. They get more only if
    // neither is free of folds by then.
    for rounds in [FIRST_ROUNDS, MAX_ROUNDS] {
        let pending = transfers.par_iter_mut().zip(&shares);
        pending.try_for_each(|(transfer, share)| match transfer {
            Some(transfer) => transfer.unfold(rounds, share),
            None => Ok(()),
        })?;
        // If the transfer in one direction is free of folds by now, the other transfer is given up.
        // It would need many more rounds and would give a worse mesh, if any.
        if transfers.iter().flatten().any(Transfer::is_fold_free) {
            break;
        }
    }
    let improved = transfers
        .into_par_iter()
        .zip(&shares)
        .map(|(transfer, share)| {
            let mut mesh = transfer.and_then(Transfer::into_valid_mesh);
            if let Some(mesh) = &mut mesh {
                // A short improvement suffices to compare the two meshes.
                quality::relax_and_flip(mesh, share)?;
            }
            Ok(mesh)
        });
    let mut candidates = improved.collect::<Result<Vec<Option<PairMesh>>, Cancelled>>()?;
    let backwards = candidates.pop().flatten().map(PairMesh::swapped);
    let best = candidates.into_iter().flatten().chain(backwards);
    Ok(best.min_by(|a, b| mean_cost(a).total_cmp(&mean_cost(b))))
}

/// Builds the base mesh of a piece ([`bridges`]) and removes unneeded vertices from it.
pub(super) fn from_base(
    source: &BoundaryRings,
    target: &BoundaryRings,
    progress: &dyn Progress,
) -> Result<PairMesh, PieceMeshError> {
    let first = ProgressSpan::new(progress, 0.0, 0.5);
    let mut mesh = if source.points.len() > MAX_BASE_POINTS {
        coarse_base(source, target, &first)?
    } else {
        bridges::bridged_base(source, target, &first)?
    };
    // In exact arithmetic no face of the base mesh is folded. If rounding has folded one, no later
    // step repairs it.
    if let Some(error) = degenerate_faces_error(&mesh) {
        return Err(error);
    }
    quality::remove_unneeded_vertices(&mut mesh, &ProgressSpan::new(progress, 0.5, 1.0))?;
    Ok(mesh)
}

/// Returns the error for faces of the base mesh that are flat or folded because of rounding; `None`
/// if there are none.
fn degenerate_faces_error(mesh: &PairMesh) -> Option<PieceMeshError> {
    Side::BOTH.into_iter().find_map(|side| {
        let corners = mesh.faces().map(|face| mesh.corners(face)[side]);
        let mut folded = corners.filter(|corners| !face_cost::is_positive(*corners));
        let place = folded.next()?.iter().sum::<DVec2>() / 3.0;
        Some(PieceMeshError::Folded {
            side,
            faces: 1 + folded.count(),
            place,
        })
    })
}

/// Coarsens the boundary by an advancing front, builds the base mesh of the remaining region, and
/// joins it to the faces behind the front.
fn coarse_base(
    source: &BoundaryRings,
    target: &BoundaryRings,
    progress: &dyn Progress,
) -> Result<PairMesh, PieceMeshError> {
    // The front is coarsened to at most `MAX_BASE_POINTS` / 2 points, if possible, because bridges
    // to holes add corners again.
    checkpoint(progress, "simplifying", 0.0)?;
    let coarse = coarsen::coarsen(source, target, MAX_BASE_POINTS / 2, progress)?;
    let core = bridges::bridged_base(&coarse.front_rings(0), &coarse.front_rings(1), progress)?;
    let front: Vec<u32> = coarse.rings.concat();
    let mut whole = MeshAssembly {
        points: coarse.points,
        faces: coarse.faces,
    };
    whole.append(
        &front,
        core.points.each_ref().map(Vec::as_slice),
        core.faces(),
    );
    Ok(PairMesh::new(
        source.points.len(),
        whole.points,
        whole.faces,
    ))
}

/// Weighted mean of the face costs; the lower it is, the better the mesh.
pub(super) fn mean_cost(mesh: &PairMesh) -> f64 {
    let weighted = mesh_energy::weighted_faces(mesh);
    weighted
        .iter()
        .map(|&(face, weight)| weight * mesh.cost(face))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_base_with_flat_faces_names_their_place() {
        let square = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)].map(DVec2::from);
        let flat = square.map(|p| DVec2::new(p.x + p.y, p.y));
        let flat = [flat[0], flat[1], 2.0 * flat[1], flat[3]].to_vec();
        let faces = vec![[0, 1, 2], [0, 2, 3]];
        let mesh = PairMesh::new(4, [square.to_vec(), flat], faces);
        let error = degenerate_faces_error(&mesh).expect("a flat face");
        let reported = error.swapped().scaled([2.0, 1.0]);
        let (side, place) = (Side::Source, DVec2::new(6.0, 0.0));
        let faces = 1;
        assert_eq!(reported, PieceMeshError::Folded { side, faces, place });
        assert!(reported.to_string().contains("in the source, near (6, 0):"));
    }
}
