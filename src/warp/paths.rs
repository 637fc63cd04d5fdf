//! Boundary paths: corresponding vertices of closed polygons move on paths of
//! their own, without anything inside.
//!
//! Either straight, or intrinsically (Sederberg, Gao, Wang, Mu, "2-D shape
//! blending: an intrinsic solution to the vertex path problem", 1993, §3 and
//! §4): lengths and directions of the edges are interpolated, so that what
//! turns is not shortened on the way. Where a polygon is and how it lies as a
//! whole is free then. Its centroid runs straight, several parts move with the
//! design ([`super::part_path`]), and of the whole turns that a match leaves open
//! those are taken that are nearest to the rotation that fits the designs
//! best.
//!
//! Guaranteed: at t = 0 and t = 1 the designs to the last bit; for |t| up to
//! 1e75 finite vertices, whatever the polygons are; by intrinsic paths a
//! rotated and moved copy moves rigidly, one of another size stays similar;
//! swapping the designs plays the film backwards. Not guaranteed: that the
//! polygons do not cross themselves or each other in between; a half turn has
//! two equal films.
//!
//! - `options`: what comes in, and what may be wrong with it
//! - `turning`: continuous angles along a ring
//! - `ring`: one ring by its edges, and how it is closed
//! - `part`: an outer ring with its holes
//! - `whole`: all parts, and where they are

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

/// Boundary paths, ready to be played.
///
/// ```
/// use morphospace::geometry::DVec2;
/// use morphospace::warp::{PathOptions, Paths, RingPair, Warp};
///
/// let source = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
/// let turn = DVec2::from_angle(3.0);
/// let target = source.iter().map(|&p| turn.rotate(p)).collect();
/// let paths = Paths::new(&[vec![RingPair { source, target }]], PathOptions::default())?;
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
    /// Each ring as a range of vertices.
    rings: Vec<Range<u32>>,
    /// Nothing where the paths are straight.
    intrinsic: Option<IntrinsicPaths>,
}

impl BoundaryPaths {
    /// Takes parts, each an outer ring and its holes. The vertices of the
    /// placement are those of all rings, in order. Cost: of the order of the
    /// number of vertices, and for each hole of those around it.
    ///
    /// # Errors
    /// [`PathsError`] names the ring that has no vertices, not as many in both
    /// designs, or a point out of range.
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

    /// The rings as walks over the vertices of the placement, in the order in
    /// which they were given.
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
                // The ends are the designs themselves, not sums of edges.
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
