//! Boundary paths: interpolation of matched closed polygons (rings), without their interior.
//!
//! Vertices move on straight lines or on intrinsic paths (Sederberg, Gao, Wang, Mu, "2-D shape
//! blending: an intrinsic solution to the vertex path problem", 1993, §3 and §4). Intrinsic paths
//! interpolate the lengths and directions of the edges, so that rotating limbs keep their length.
//! This leaves the position of each polygon free: the design's centroid moves on a straight line
//! and its parts move with the design ([`super::part_path`]). It also leaves whole turns free: the
//! ones nearest to the best-fit rotation of the designs are chosen.
//!
//! Guaranteed: at t = 0 and t = 1 the vertices are exactly those of the designs. Vertices are
//! finite for |t| up to 1e75 and any polygons. On intrinsic paths a rotated and translated copy
//! moves rigidly, and a scaled copy stays similar. Exchanging the designs reverses the motion. Not
//! guaranteed: that polygons do not cross themselves or each other. For a rotation by π two
//! directions are equally good, and rounding decides.
//!
//! - `options`: input types, options and validation
//! - `turning`: continuous edge angles along a ring
//! - `ring`: interpolation of one ring and closing of its gap
//! - `part`: an outer ring with its holes
//! - `intrinsic`: all parts and their positions

mod intrinsic;
mod options;
mod part;
mod ring;
#[cfg(test)]
mod tests;
mod turning;

pub use options::{PathOptions, PathsError, RingPair, VertexPath};

use super::{Placement, Placer, Warp};
use crate::geometry::DVec2;
use intrinsic::IntrinsicPaths;
use options::check;
use std::ops::Range;
use std::sync::Arc;

/// Boundary paths of matched polygons. Cloning is cheap.
///
/// ```
/// use morphospace::geometry::DVec2;
/// use morphospace::warp::{BoundaryPaths, PathOptions, RingPair, Warp};
///
/// let source = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
/// let turn = DVec2::from_angle(3.0);
/// let target = source.iter().map(|&p| turn.rotate(p)).collect();
/// let pair = RingPair { source, target };
/// let paths = BoundaryPaths::new(&[vec![pair]], PathOptions::default())?;
/// let mut placer = paths.placer();
/// placer.place(0.5);
/// let at = &placer.placement().in_frame;
/// assert!((at[0].distance(at[1]) - 1.0).abs() < 1e-12); // turned, not shrunk
/// # Ok::<(), morphospace::warp::PathsError>(())
/// ```
#[derive(Clone, Debug)]
pub struct BoundaryPaths(Arc<BoundaryPathData>);

#[derive(Debug)]
struct BoundaryPathData {
    source: Vec<DVec2>,
    target: Vec<DVec2>,
    /// For each ring (closed polygon), the range of its vertex indices.
    rings: Vec<Range<u32>>,
    /// Intrinsic paths, or `None` if the paths are straight.
    intrinsic: Option<IntrinsicPaths>,
}

impl BoundaryPaths {
    /// Creates the paths of parts, each an outer ring followed by its holes.
    ///
    /// The vertices of the placement are those of all rings in order. The cost is linear in the
    /// number of vertices, plus one pass over the outer ring for each hole.
    ///
    /// # Errors
    /// [`PathsError`] if there are no rings, or for the first ring that has no vertices, different
    /// numbers of vertices in the two designs, or a coordinate out of range.
    pub fn new(parts: &[Vec<RingPair>], options: PathOptions) -> Result<Self, PathsError> {
        check(parts)?;
        let all = |of: fn(&RingPair) -> &Vec<DVec2>| -> Vec<DVec2> {
            parts.iter().flatten().flat_map(of).copied().collect()
        };
        let mut end = 0;
        let rings = parts.iter().flatten().map(|ring| {
            let begin = end;
            end += ring.source.len() as u32;
            begin..end
        });
        Ok(Self(Arc::new(BoundaryPathData {
            rings: rings.collect(),
            source: all(|ring| &ring.source),
            target: all(|ring| &ring.target),
            intrinsic: match options.course {
                VertexPath::Straight => None,
                VertexPath::Intrinsic => Some(IntrinsicPaths::new(parts)),
            },
        })))
    }

    /// Returns the rings in input order, each as the indices of its vertices in a
    /// [`Placement`](crate::warp::Placement).
    #[must_use]
    pub fn loops(&self) -> Vec<Vec<u32>> {
        self.0
            .rings
            .iter()
            .map(|ring| ring.clone().collect())
            .collect()
    }
}

impl Warp for BoundaryPaths {
    fn placer(&self) -> Placer {
        let paths = Arc::clone(&self.0);
        let placement = Placement::of_source(Arc::new([]), &paths.source, &paths.target);
        Placer::new(placement, move |t, placement| {
            let BoundaryPathData { source, target, .. } = &*paths;
            let out = &mut placement.in_frame;
            match &paths.intrinsic {
                // At t = 0 and t = 1 the designs are copied, because summing the edges would
                // introduce rounding.
                _ if t == 0.0 => out.copy_from_slice(source),
                _ if t == 1.0 => out.copy_from_slice(target),
                Some(intrinsic) => intrinsic.write(t, out),
                None => {
                    for (out, (&p, &q)) in out.iter_mut().zip(source.iter().zip(target)) {
                        *out = p * (1.0 - t) + q * t;
                    }
                }
            }
        })
    }
}
