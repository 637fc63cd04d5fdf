//! All parts of a design on intrinsic paths.
//!
//! The centroid of the design runs straight and its parts move with it
//! ([`crate::warp::part_path`]). Parts weigh by their area, the vertices of a part
//! by the edges that they end: fixed masses, since an area centroid is 0/0
//! where a ring collapses on its way.

use super::options::RingPair;
use super::part;
use super::part::IntrinsicPart;
use super::ring::IntrinsicRing;
use super::turning;
use crate::geometry::DVec2;
use crate::warp::part_path::{PartPath, centroid, rotation};

/// What intrinsic paths need.
#[derive(Debug)]
pub(super) struct IntrinsicPaths {
    /// Each with the path of its centroid.
    parts: Vec<(IntrinsicPart, PartPath)>,
    /// The design's centroid in source and target.
    centroid: [DVec2; 2],
    /// The rotation that fits the designs best, in radians in (−π, π].
    whole_angle: f64,
}

impl IntrinsicPaths {
    /// Takes parts apart, each an outer ring and its holes.
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
        let places = parts_with_masses.flat_map(|((pair, ring), mass)| {
            let places = pair.source.iter().zip(&pair.target).map(|(&p, &q)| [p, q]);
            places.zip(ring.masses().map(move |share| mass * share))
        });
        let whole_angle = rotation(places, whole);
        let paths = PartPath::all(&centres, &masses, whole_angle);
        let parts = parts.iter();
        let parts = parts.filter_map(|rings| IntrinsicPart::new(rings, whole_angle));
        Self {
            parts: parts.zip(paths).collect(),
            centroid: whole,
            whole_angle,
        }
    }

    /// Writes the vertices of all parts at t.
    pub(super) fn write(&self, t: f64, out: &mut [DVec2]) {
        let [from, to] = self.centroid;
        let mut rest = out;
        for (edges, path) in &self.parts {
            let at = from * (1.0 - t) + to * t + path.at(t, self.whole_angle);
            let (vertices, after) = rest.split_at_mut(edges.len());
            edges.write(t, vertices);
            vertices.iter_mut().for_each(|p| *p += at);
            rest = after;
        }
    }
}

/// The mean share of each part in the areas of both designs; even where there
/// is no area.
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
    // Rings without any area have no share of it: 0 / 0.
    if shares.iter().all(|share| share.is_finite()) {
        shares
    } else {
        vec![1.0; outer.len()]
    }
}
