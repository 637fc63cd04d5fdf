//! Intrinsic paths of all parts of a design.
//!
//! The design's centroid moves on a straight line and the parts move with the design
//! ([`crate::warp::part_path`]). The mass of a part is its area; within a part the mass of a vertex
//! is half the length of its two edges. Masses do not depend on t, because an area centroid would
//! be 0/0 where a ring collapses in between.

use super::options::RingPair;
use super::part;
use super::part::IntrinsicPart;
use super::ring::IntrinsicRing;
use super::turning;
use crate::geometry::DVec2;
use crate::warp::part_path::{PartPath, centroid, rotation};

/// The parts of a design with their edges and the paths of their centroids.
#[derive(Debug)]
pub(super) struct IntrinsicPaths {
    /// Each part with the path of its centroid.
    parts: Vec<(IntrinsicPart, PartPath)>,
    /// Centroid of the design in source and target.
    centroid: [DVec2; 2],
    /// Best-fit rotation of the design in radians, in [−π, π].
    whole_angle: f64,
}

impl IntrinsicPaths {
    /// Computes the intrinsic paths of `parts`; each part is an outer ring followed by its holes.
    pub(super) fn new(parts: &[Vec<RingPair>]) -> Self {
        let outer: Vec<&RingPair> = parts.iter().filter_map(|rings| rings.first()).collect();
        let rings: Vec<IntrinsicRing> = outer
            .iter()
            .map(|pair| IntrinsicRing::new(&pair.source, &pair.target, 0.0))
            .collect();
        let centres: Vec<[DVec2; 2]> = outer
            .iter()
            .zip(&rings)
            .map(|(pair, ring)| part::centres(pair, ring))
            .collect();
        let masses = masses(&outer);
        let whole = centroid(centres.iter().copied(), &masses);
        let parts_with_masses = outer.iter().zip(&rings).zip(&masses);
        let weighted_vertices = parts_with_masses.flat_map(|((pair, ring), mass)| {
            let vertices = pair.source.iter().zip(&pair.target).map(|(&p, &q)| [p, q]);
            vertices.zip(ring.masses().map(move |share| mass * share))
        });
        let whole_angle = rotation(weighted_vertices, whole);
        let paths = PartPath::all(&centres, &masses, whole_angle);
        let edge_parts = parts
            .iter()
            .filter_map(|rings| IntrinsicPart::new(rings, whole_angle));
        Self {
            parts: edge_parts.zip(paths).collect(),
            centroid: whole,
            whole_angle,
        }
    }

    /// Writes the vertices of all parts at t.
    pub(super) fn write(&self, t: f64, out: &mut [DVec2]) {
        let [from, to] = self.centroid;
        let mut rest = out;
        for (edges, path) in &self.parts {
            let centre = from * (1.0 - t) + to * t + path.offset(t, self.whole_angle);
            let (vertices, after) = rest.split_at_mut(edges.len());
            edges.write(t, vertices);
            vertices.iter_mut().for_each(|p| *p += centre);
            rest = after;
        }
    }
}

/// Returns the mass of each part: the sum of its fractions of the total area in source and target.
///
/// If a design has no area, all parts have the same mass.
fn masses(outer: &[&RingPair]) -> Vec<f64> {
    let area = |ring: &[DVec2]| -> f64 {
        let edges = turning::edges(ring).zip(ring);
        edges
            .map(|(edge, &p)| (p - ring[0]).perp_dot(edge))
            .sum::<f64>()
            .abs()
    };
    let areas: Vec<[f64; 2]> = outer
        .iter()
        .map(|pair| [area(&pair.source), area(&pair.target)])
        .collect();
    let totals = [0, 1].map(|side| areas.iter().map(|a| a[side]).sum::<f64>());
    let shares = areas.iter().map(|a| a[0] / totals[0] + a[1] / totals[1]);
    let shares: Vec<f64> = shares.collect();
    // A design without area gives 0 / 0.
    if shares.iter().all(|share| share.is_finite()) {
        shares
    } else {
        vec![1.0; outer.len()]
    }
}
