//! The steps by which two polygons are triangulated together: transfer in
//! both directions, the guaranteed base where both fail, then quality.

use super::boundary_rings;
use super::boundary_rings::BoundaryRings;
use super::error::PieceMeshError;
use super::options::PolygonOptions;
use super::pair_mesh::{PairMesh, unit_scale};
use super::transfer::{FIRST_ROUNDS, MAX_ROUNDS, Transfer};
use super::{bridges, coarsen, face_cost, mesh_energy, quality};
use crate::compatible::CompatibleMesh;
use crate::compatible::assembly::MeshAssembly;
use crate::geometry::{DVec2, Side, lexicographic};
use crate::work::progress::{Cancelled, Progress, ProgressShares, ProgressSpan, checkpoint};
use rayon::prelude::*;

/// With more boundary points the base is made of what a front leaves: 200
/// corners already cross up to 39,000 times, in as many vertices.
const FEW: usize = 200;

/// How much of the work is done once the transfers are, and once the base is,
/// as it is told. Of some pairs' time; no harm is done where it is otherwise.
const CARRIED: f64 = 0.5;
const BASED: f64 = 0.7;

impl CompatibleMesh {
    /// Triangulates one connected piece in two designs together. Ring 0 is
    /// its outer boundary, counter-clockwise, the others are its holes,
    /// clockwise; point i of a ring is point i of that ring in the other
    /// design. The mesh's first vertices are the rings' points, ring after
    /// ring; inner ones follow.
    ///
    /// A ring may run along a slit in either design or in both, there and
    /// back over bit-equal points, as that of a letter D cut open: both banks
    /// are vertices of their own.
    ///
    /// # Errors
    /// [`PieceMeshError`] for what bounds no single piece, or if the work is
    /// cancelled.
    ///
    /// ```
    /// use morphospace::compatible::{CompatibleMesh, PolygonOptions};
    /// use morphospace::{geometry::DVec2, progress::Silent};
    /// let square = |r: f64| [(-r, -r), (r, -r), (r, r), (-r, r)].map(DVec2::from).to_vec();
    /// let hole = |r: f64| square(r).into_iter().rev().collect();
    /// let (thin, thick) = ([square(2.0), hole(1.5)], [square(2.0), hole(0.5)]);
    /// let mesh = CompatibleMesh::from_piece(&thin, &thick, &PolygonOptions::default(), &Silent)?;
    /// assert_eq!(mesh.boundary_loops().len(), 2);
    /// # Ok::<(), morphospace::compatible::PolygonsError>(())
    /// ```
    pub fn from_piece<R: AsRef<[DVec2]>>(
        source: &[R],
        target: &[R],
        options: &PolygonOptions,
        progress: &dyn Progress,
    ) -> Result<Self, PieceMeshError> {
        check(source, target, options)?;
        let given = [source, target].map(BoundaryRings::of);
        // Near 1 no product under- or overflows, which exact signs need.
        let scales = [&given[0], &given[1]].map(|rings| unit_scale(&rings.points));
        let [p, q] = [0, 1].map(|d| given[d].scaled(scales[d]));
        let enlarged = |error: PieceMeshError| error.enlarged(scales.map(f64::recip));
        boundary_rings::check(&p, Side::Source).map_err(enlarged)?;
        boundary_rings::check(&q, Side::Target).map_err(enlarged)?;
        let mesh = if precedes(&p, &q) {
            triangulate_pair(&p, &q, options, progress)
        } else {
            let back = triangulate_pair(&q, &p, options, progress);
            back.map(PairMesh::swapped).map_err(PieceMeshError::swapped)
        };
        let mesh = mesh.map_err(enlarged)?;
        let given = given.each_ref().map(|rings| &rings.points[..]);
        mesh.finished(scales, given).map_err(PieceMeshError::Mesh)
    }
}

fn check<R: AsRef<[DVec2]>>(
    source: &[R],
    target: &[R],
    options: &PolygonOptions,
) -> Result<(), PieceMeshError> {
    if source.len() != target.len() {
        return Err(PieceMeshError::Rings([source.len(), target.len()]));
    }
    let lengths = |rings: &[R]| rings.iter().map(|r| r.as_ref().len()).collect::<Vec<_>>();
    for (ring, (a, b)) in lengths(source).into_iter().zip(lengths(target)).enumerate() {
        if a != b {
            let points = [a, b];
            return Err(PieceMeshError::Counts { ring, points });
        }
    }
    match options.edge_length {
        Some(share) if share.is_nan() || share <= 0.0 => Err(PieceMeshError::EdgeLength(share)),
        _ => Ok(()),
    }
}

/// A total order, so that a pair is solved in one order whichever way it is
/// asked for.
pub(super) fn precedes(a: &BoundaryRings, b: &BoundaryRings) -> bool {
    // Negative zero is zero.
    let coordinates = |rings: &BoundaryRings| -> Vec<f64> {
        let points = rings.points.iter();
        points.flat_map(|p| (*p + 0.0).to_array()).collect()
    };
    lexicographic(coordinates(a), coordinates(b)).is_le()
}

pub(super) fn triangulate_pair(
    source: &BoundaryRings,
    target: &BoundaryRings,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<PairMesh, PieceMeshError> {
    checkpoint(progress, "triangulating", 0.0)?;
    let carrying = ProgressSpan::new(progress, 0.0, CARRIED);
    let best = transferred(source, target, options, &carrying)?;
    let mut mesh = match best {
        Some(mesh) => mesh,
        None => from_base(source, target, &ProgressSpan::new(progress, CARRIED, BASED))?,
    };
    quality::improve(&mut mesh, options, &ProgressSpan::new(progress, BASED, 1.0))?;
    Ok(mesh)
}

/// The better of the transfers in both directions; none where both stay folded.
fn transferred(
    source: &BoundaryRings,
    target: &BoundaryRings,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<Option<PairMesh>, Cancelled> {
    let shares = ProgressShares::new(progress, 2);
    let shares = [shares.part(0), shares.part(1)];
    // Which of both is the better one is not to be seen from the outlines.
    let ways = [(source, target), (target, source)].into_par_iter();
    let begun = ways
        .zip(&shares)
        .map(|((from, to), share)| Transfer::begin(from, to, options, share));
    let mut both: Vec<Option<Transfer>> = begun.collect::<Result<_, _>>()?;
    for rounds in [FIRST_ROUNDS, MAX_ROUNDS] {
        let ways = both.par_iter_mut().zip(&shares);
        ways.try_for_each(|(way, share)| match way {
            Some(way) => way.unfold(rounds, share),
            None => Ok(()),
        })?;
        // What takes much longer than the other comes out worse, if at all.
        if both.iter().flatten().any(Transfer::is_done) {
            break;
        }
    }
    let settled = both.into_par_iter().zip(&shares).map(|(way, share)| {
        let mut mesh = way.and_then(Transfer::done);
        if let Some(mesh) = &mut mesh {
            // Just so far that they can be compared.
            quality::settle(mesh, share)?;
        }
        Ok(mesh)
    });
    let mut settled = settled.collect::<Result<Vec<Option<PairMesh>>, Cancelled>>()?;
    let backwards = settled.pop().flatten().map(PairMesh::swapped);
    let best = settled.into_iter().flatten().chain(backwards);
    Ok(best.min_by(|a, b| mean_cost(a).total_cmp(&mean_cost(b))))
}

pub(super) fn from_base(
    source: &BoundaryRings,
    target: &BoundaryRings,
    progress: &dyn Progress,
) -> Result<PairMesh, PieceMeshError> {
    let first = ProgressSpan::new(progress, 0.0, 0.5);
    let mut mesh = if source.points.len() > FEW {
        coarse_base(source, target, &first)?
    } else {
        bridges::bridged_base(source, target, &first)?
    };
    // Over the reals there are none, and no later step mends one.
    if let Some(error) = folded(&mesh) {
        return Err(error);
    }
    quality::thin_out(&mut mesh, &ProgressSpan::new(progress, 0.5, 1.0))?;
    Ok(mesh)
}

/// Where rounding left faces of a base without area.
fn folded(mesh: &PairMesh) -> Option<PieceMeshError> {
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

/// The base of what a front leaves, and the faces behind the front.
fn coarse_base(
    source: &BoundaryRings,
    target: &BoundaryRings,
    progress: &dyn Progress,
) -> Result<PairMesh, PieceMeshError> {
    // Half of it, since bridges to holes add corners again.
    checkpoint(progress, "simplifying", 0.0)?;
    let coarse = coarsen::coarsen(source, target, FEW / 2, progress)?;
    let core = bridges::bridged_base(&coarse.core(0), &coarse.core(1), progress)?;
    let front: Vec<u32> = coarse.rings.concat();
    let mut whole = MeshAssembly {
        points: coarse.points,
        faces: coarse.faces,
    };
    whole.add(
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

/// Mean cost of the faces by their area in both designs: what one mesh is
/// preferred to another by.
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
    fn a_base_with_flat_faces_says_where_they_are() {
        let square = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)].map(DVec2::from);
        let flat = square.map(|p| DVec2::new(p.x + p.y, p.y));
        let flat = [flat[0], flat[1], 2.0 * flat[1], flat[3]].to_vec();
        let faces = vec![[0, 1, 2], [0, 2, 3]];
        let mesh = PairMesh::new(4, [square.to_vec(), flat], faces);
        let error = folded(&mesh).expect("a flat face");
        let told = error.swapped().enlarged([2.0, 1.0]);
        let (side, place) = (Side::Source, DVec2::new(6.0, 0.0));
        let faces = 1;
        assert_eq!(told, PieceMeshError::Folded { side, faces, place });
        assert!(told.to_string().contains("in the source, about (6, 0):"));
    }
}
