//! Compatible triangulation of one connected piece with corresponding
//! boundary vertices in two designs: a simple polygon, maybe with holes, maybe
//! cut open along slits.
//!
//! First the foldover-free transfer of either polygon's refined triangulation
//! to the other ([`transfer`]): good angles, no guarantee. Where it fails in
//! both directions, the guaranteed base ([`overlay`] of discs, [`bridges`] for
//! holes), thinned out. Then quality in both designs at once ([`quality`]).
//!
//! Guaranteed: every face is positive in both designs by exact predicates;
//! the polygons' vertices come first, in order and unmoved, and their edges
//! are edges of the mesh; the same input gives the same mesh, and the designs
//! exchanged give the mesh with its embeddings exchanged, bit by bit. Not guaranteed:
//! any angle or any distortion, which the match between the two decides.
//! Polygons thinner than the last digits of their coordinates may leave no
//! room for the vertices that a common triangulation needs: an error, never a
//! wrong mesh.

mod bridges;
mod chords;
mod coarsen;
mod error;
mod face;
mod frame;
mod lbfgs;
mod overlay;
mod pair;
mod piece;
mod quality;
mod relax;
mod springs;
#[cfg(test)]
mod tests;
mod touching;
mod transfer;

use super::{CompatibleError, CompatibleMesh};
use crate::geometry::{Bounds, DVec2, Side};
use crate::mesh::triangulation::TriangulationError;
use crate::progress::{Progress, checkpoint};
pub use error::{PolygonsError, RingEdge};
pub use frame::FrameError;
use pair::PairMesh;
use piece::Rings;
use serde::{Deserialize, Serialize};

/// With more boundary points the base is made of what a front leaves.
const FEW: usize = 200;

/// How two polygons are triangulated together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct PolygonOptions {
    /// Longest edge wanted inside, as a share of each design's diameter;
    /// without one, faces grow from the boundary inwards, with at most two
    /// inner vertices for each of the boundary in all but hard cases.
    pub edge_length: Option<f64>,
}

impl From<TriangulationError> for PolygonsError {
    /// The polygons were found to be simple before.
    fn from(_: TriangulationError) -> Self {
        Self::TooThin
    }
}

impl From<CompatibleError> for PolygonsError {
    /// The mesh was found to be valid before.
    fn from(_: CompatibleError) -> Self {
        Self::TooThin
    }
}

impl CompatibleMesh {
    /// Triangulates two simple counter-clockwise polygons together; point i
    /// of one is point i of the other. The mesh's first vertices are the
    /// polygon's, in order; inner ones follow.
    ///
    /// # Errors
    /// [`PolygonsError`] for what are no simple polygons, or if the work is
    /// cancelled.
    ///
    /// ```
    /// use morphospace::compatible::{CompatibleMesh, PolygonOptions};
    /// use morphospace::{geometry::DVec2, progress::Silent};
    /// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    /// let dart = [(0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0)].map(DVec2::from);
    /// let mesh = CompatibleMesh::from_polygons(&square, &dart, &PolygonOptions::default(), &Silent)?;
    /// assert_eq!(mesh.source()[..4], square);
    /// # Ok::<(), morphospace::compatible::PolygonsError>(())
    /// ```
    pub fn from_polygons(
        source: &[DVec2],
        target: &[DVec2],
        options: &PolygonOptions,
        progress: &dyn Progress,
    ) -> Result<Self, PolygonsError> {
        Self::from_piece(&[source], &[target], options, progress)
    }

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
    /// [`PolygonsError`] for what bounds no single piece, or if the work is
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
    ) -> Result<Self, PolygonsError> {
        check(source, target, options)?;
        let given = [source, target].map(Rings::of);
        let scales = [&given[0], &given[1]].map(|rings| to_unit(&rings.points));
        let [p, q] = [0, 1].map(|d| given[d].scaled(scales[d]));
        piece::check(&p, Side::Source)?;
        piece::check(&q, Side::Target)?;
        let mesh = if goes_first(&p, &q) {
            triangulated(&p, &q, options, progress)?
        } else {
            triangulated(&q, &p, options, progress)?.swapped()
        };
        let (faces, mut points) = mesh.compacted();
        for d in 0..2 {
            points[d].iter_mut().for_each(|p| *p /= scales[d]);
            points[d][..given[d].points.len()].copy_from_slice(&given[d].points);
        }
        let [in_source, in_target] = points;
        Ok(Self::new(faces, in_source, in_target, Vec::new())?)
    }
}

fn check<R: AsRef<[DVec2]>>(
    source: &[R],
    target: &[R],
    options: &PolygonOptions,
) -> Result<(), PolygonsError> {
    if source.len() != target.len() {
        return Err(PolygonsError::Rings([source.len(), target.len()]));
    }
    let lengths = |rings: &[R]| rings.iter().map(|r| r.as_ref().len()).collect::<Vec<_>>();
    for (ring, (a, b)) in lengths(source).into_iter().zip(lengths(target)).enumerate() {
        if a != b {
            let points = [a, b];
            return Err(PolygonsError::Counts { ring, points });
        }
    }
    match options.edge_length {
        Some(share) if share.is_nan() || share <= 0.0 => Err(PolygonsError::EdgeLength(share)),
        _ => Ok(()),
    }
}

/// A total order, so that a pair is solved in one order whichever way it is
/// asked for.
fn goes_first(a: &Rings, b: &Rings) -> bool {
    let coordinates = |rings: &Rings| -> Vec<f64> {
        let points = rings.points.iter();
        points.flat_map(|p| (*p + 0.0).to_array()).collect()
    };
    let (a, b) = (coordinates(a), coordinates(b));
    let order = a.iter().zip(&b).map(|(a, b)| a.total_cmp(b));
    order
        .fold(std::cmp::Ordering::Equal, |so_far, next| so_far.then(next))
        .is_le()
}

fn triangulated(
    source: &Rings,
    target: &Rings,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<PairMesh, PolygonsError> {
    let (forwards, backwards) = rayon::join(
        || transferred(source, target, options, progress),
        || transferred(target, source, options, progress),
    );
    let best = [forwards?, backwards?.map(PairMesh::swapped)]
        .into_iter()
        .flatten()
        .min_by(|a, b| badness(a).total_cmp(&badness(b)));
    let mut mesh = match best {
        Some(mesh) => mesh,
        None => from_base(source, target, progress)?,
    };
    quality::improve(&mut mesh, options, progress)?;
    Ok(mesh)
}

/// Improved just so far that both directions can be compared.
fn transferred(
    from: &Rings,
    to: &Rings,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<Option<PairMesh>, PolygonsError> {
    let mut mesh = transfer::transfer(from, to, options, progress)?;
    if let Some(mesh) = &mut mesh {
        quality::settle(mesh);
    }
    Ok(mesh)
}

fn from_base(
    source: &Rings,
    target: &Rings,
    progress: &dyn Progress,
) -> Result<PairMesh, PolygonsError> {
    let mut mesh = if source.points.len() > FEW {
        coarse_base(source, target)?
    } else {
        bridges::base(source, target)?
    };
    if !mesh.is_valid() {
        return Err(PolygonsError::TooThin);
    }
    quality::thin_out(&mut mesh, progress)?;
    Ok(mesh)
}

/// The base of what a front leaves, and the faces behind the front.
fn coarse_base(source: &Rings, target: &Rings) -> Result<PairMesh, PolygonsError> {
    let coarse = coarsen::coarsened(source, target, FEW / 2);
    let mut core = bridges::base(&coarse.core(0), &coarse.core(1))?;
    let front: Vec<u32> = coarse.rings.concat();
    let inner = coarse.points[0].len();
    let number = |v: u32| match (v as usize).checked_sub(front.len()) {
        None => front[v as usize],
        Some(i) => (inner + i) as u32,
    };
    let mut faces = coarse.faces;
    faces.extend(core.faces().map(|face| face.map(number)));
    let [mut p, mut q] = coarse.points;
    p.extend(core.points[0].drain(front.len()..));
    q.extend(core.points[1].drain(front.len()..));
    Ok(PairMesh::new(source.points.len(), p, q, faces))
}

/// Mean cost of the faces by their area in both designs: what one mesh is
/// preferred to another by.
fn badness(mesh: &PairMesh) -> f64 {
    let weighted = relax::weighted(mesh);
    weighted
        .iter()
        .map(|&(face, weight)| weight * mesh.cost(face))
        .sum()
}

/// A power of two, so that scaling is exact, that brings the diameter near 1.
fn to_unit(points: &[DVec2]) -> f64 {
    let size = Bounds::diameter_of(points);
    if size.is_normal() {
        (-size.log2().round()).exp2()
    } else {
        1.0
    }
}

/// The most inner vertices that a refinement may make.
fn most_points(boundary: usize, options: &PolygonOptions) -> usize {
    const FINEST: f64 = 1e-3;
    match options.edge_length {
        None => 2 * boundary,
        Some(share) => 2 * boundary + (2.0 / share.max(FINEST).powi(2)) as usize,
    }
}

fn checked(
    progress: &dyn Progress,
    stage: &'static str,
    fraction: f64,
) -> Result<(), PolygonsError> {
    Ok(checkpoint(progress, stage, fraction)?)
}
