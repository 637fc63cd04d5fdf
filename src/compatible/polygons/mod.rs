//! Compatible triangulation of two simple polygons with corresponding
//! vertices.
//!
//! First the foldover-free transfer of either polygon's refined triangulation
//! to the other ([`transfer`]): good angles, no guarantee. Where it fails in
//! both directions, the guaranteed base ([`overlay`]), thinned out. Then
//! quality in both designs at once ([`quality`]).
//!
//! Guaranteed: every face is positive in both designs by exact predicates;
//! the polygons' vertices come first, in order and unmoved, and their edges
//! are edges of the mesh; the same input gives the same mesh. Not guaranteed:
//! any angle or any distortion, which the match between the two decides.
//! Polygons thinner than the last digits of their coordinates may leave no
//! room for the vertices that a common triangulation needs: an error, never a
//! wrong mesh.

mod chords;
mod face;
mod lbfgs;
mod overlay;
mod pair;
mod quality;
mod relax;
mod simple;
#[cfg(test)]
mod tests;
mod transfer;

use super::{CompatibleError, CompatibleMesh, Which};
use crate::geometry::{Bounds, DVec2};
use crate::mesh::triangulation::TriangulationError;
use crate::progress::{Cancelled, Progress, checkpoint};
use pair::PairMesh;
use serde::{Deserialize, Serialize};

/// How two polygons are triangulated together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct PolygonOptions {
    /// Longest edge wanted inside, as a share of each design's diameter;
    /// without one, faces grow from the boundary inwards, with at most two
    /// inner vertices for each of the boundary in all but hard cases.
    pub edge_length: Option<f64>,
}

/// Why two polygons were not triangulated together. Numbers in messages start
/// at 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PolygonsError {
    /// Different numbers of points.
    #[error("the source has {} boundary points and the target {}; match them one to one", .0[0], .0[1])]
    Counts([usize; 2]),
    /// Fewer than three points.
    #[error("the outline of the {which} has {points} points; it needs at least 3")]
    TooFewPoints {
        /// In which design.
        which: Which,
        /// How many there are.
        points: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("point {} on the outline of the {which} is not finite; correct its coordinates", vertex + 1)]
    NotFinite {
        /// In which design.
        which: Which,
        /// The point.
        vertex: usize,
    },
    /// Two edges touch, or two points coincide.
    #[error("edges {} and {} on the outline of the {which} touch; repair the outline", edges[0] + 1, edges[1] + 1)]
    NotSimple {
        /// In which design.
        which: Which,
        /// The edges, each named by its first point.
        edges: [usize; 2],
    },
    /// Clockwise points.
    #[error("the outline of the {0} runs clockwise; reverse its points")]
    Clockwise(Which),
    /// The edge length is no positive number.
    #[error("the edge length {0} is not a positive share of the diameter; use 0.05, say")]
    EdgeLength(f64),
    /// A polygon so thin that its inside holds no representable points.
    #[error(
        "an outline is thinner than its coordinates are exact; thicken it, or move the match of its thinnest part"
    )]
    TooThin,
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
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
    /// assert_eq!(mesh.boundary_loops(), vec![vec![0, 1, 2, 3]]);
    /// # Ok::<(), morphospace::compatible::PolygonsError>(())
    /// ```
    pub fn from_polygons(
        source: &[DVec2],
        target: &[DVec2],
        options: &PolygonOptions,
        progress: &dyn Progress,
    ) -> Result<Self, PolygonsError> {
        check(source, target, options)?;
        let scales = [source, target].map(to_unit);
        let [p, q] = [(source, scales[0]), (target, scales[1])]
            .map(|(points, scale)| points.iter().map(|&p| p * scale).collect::<Vec<_>>());
        let mesh = triangulated(&p, &q, options, progress)?;
        let (faces, [mut in_source, mut in_target]) = mesh.compacted();
        for (points, polygon, scale) in [
            (&mut in_source, source, scales[0]),
            (&mut in_target, target, scales[1]),
        ] {
            points.iter_mut().for_each(|p| *p /= scale);
            points[..polygon.len()].copy_from_slice(polygon);
        }
        Ok(Self::new(faces, in_source, in_target, Vec::new())?)
    }
}

fn check(
    source: &[DVec2],
    target: &[DVec2],
    options: &PolygonOptions,
) -> Result<(), PolygonsError> {
    if source.len() != target.len() {
        return Err(PolygonsError::Counts([source.len(), target.len()]));
    }
    if let Some(share) = options
        .edge_length
        .filter(|&share| share.is_nan() || share <= 0.0)
    {
        return Err(PolygonsError::EdgeLength(share));
    }
    simple::check(source, Which::Source)?;
    simple::check(target, Which::Target)
}

fn triangulated(
    source: &[DVec2],
    target: &[DVec2],
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<PairMesh, PolygonsError> {
    let forwards = transferred(source, target, options, progress)?;
    let backwards = transferred(target, source, options, progress)?.map(PairMesh::swapped);
    let best = [forwards, backwards]
        .into_iter()
        .flatten()
        .min_by(|a, b| badness(a).total_cmp(&badness(b)));
    match best {
        Some(mesh) => Ok(mesh),
        None => from_base(source, target, options, progress),
    }
}

fn transferred(
    from: &[DVec2],
    to: &[DVec2],
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<Option<PairMesh>, PolygonsError> {
    let mut mesh = transfer::transfer(from, to, options, progress)?;
    if let Some(mesh) = &mut mesh {
        quality::improve(mesh, options, progress)?;
    }
    Ok(mesh)
}

fn from_base(
    source: &[DVec2],
    target: &[DVec2],
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<PairMesh, PolygonsError> {
    let triangulations = chords::triangulations(source, target)?;
    let mut mesh = overlay::overlay(source, target, &triangulations);
    if !mesh.is_valid() {
        return Err(PolygonsError::TooThin);
    }
    quality::thin_out(&mut mesh, progress)?;
    quality::improve(&mut mesh, options, progress)?;
    Ok(mesh)
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
    let size = diameter(points);
    if size.is_normal() {
        (-size.log2().round()).exp2()
    } else {
        1.0
    }
}

fn diameter(points: &[DVec2]) -> f64 {
    Bounds::of(points.iter().copied()).map_or(0.0, |bounds| bounds.diameter())
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
