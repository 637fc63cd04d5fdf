//! Boundary rings with corresponding points in all designs of a family.
//!
//! One of the designs is the *hub*; every other design is matched with it. Each match adds further
//! points to the hub's outline. The hub's outline is straight between two neighbouring corners, so
//! the points that the matches add on such an edge can be ordered along it. Where only some matches
//! have a point, the other designs get a corresponding one, interpolated between their neighbouring
//! points along the same edge. Points of different matches that lie at the same place on the hub
//! become one point.

use crate::correspondence::{PieceMatch, RegionMatch, RingKind, RingMatch};
use crate::geometry::{Bounds, DVec2};
use std::collections::HashMap;

/// Maximum distance, as a fraction of the hub's diameter, at which points of different matches are
/// merged (heuristic). Merging changes which points correspond, by no more than this distance, but
/// no outline. Without it the number of points grows with the number of designs.
const MERGE_DISTANCE: f64 = 0.002;

/// Boundary rings of one piece (a matched connected part) in all designs: `rings[ring][design]` is
/// a list of points. Point k of a ring corresponds to point k of that ring in every other design.
pub(super) type PieceRings = Vec<Vec<Vec<DVec2>>>;

/// Returns the boundary rings of all pieces, with corresponding points in all designs.
///
/// All designs are matched with the design of index `hub`. For each design, `matches` contains the
/// match with the hub as the source and this design as the target; at index `hub` it contains
/// `None`.
///
/// # Errors
/// Index of a design whose parts or holes differ from the hub's, so that no corresponding points
/// exist.
pub(super) fn shared_rings(
    hub: usize,
    matches: &[Option<&RegionMatch>],
) -> Result<Vec<PieceRings>, usize> {
    for (k, matched) in matches.iter().enumerate() {
        if matched.is_some_and(|matched| !is_one_to_one(matched)) {
            return Err(k);
        }
    }
    // The rings of any one match suffice to go through the rings of the hub, because the hub is the
    // source of every match.
    let Some((base, first)) = matches
        .iter()
        .enumerate()
        .find_map(|(k, m)| Some((k, (*m)?)))
    else {
        return Err(hub);
    };
    // Each match lists pieces and rings in its own order. A ring is therefore looked up by any of
    // the hub's points on it.
    let lookups: Vec<_> = matches.iter().map(|m| m.map(RingLookup::of)).collect();
    // Every match pairs all rings of the hub one to one, so all matches must list the same numbers
    // of rings per piece.
    let counts = |m: &RegionMatch| {
        let mut rings: Vec<usize> = m.pieces.iter().map(|piece| piece.rings.len()).collect();
        rings.sort_unstable();
        rings
    };
    let differs = |m: &Option<&RegionMatch>| m.is_some_and(|m| counts(m) != counts(first));
    if let Some(design) = matches.iter().position(differs) {
        return Err(design);
    }
    let all = first.pieces.iter().flat_map(|piece| &piece.rings);
    let size = Bounds::diameter_of(
        &all.flat_map(|r| r.source.iter().copied())
            .collect::<Vec<_>>(),
    );
    let mut pieces = Vec::new();
    for piece in &first.pieces {
        let mut rings: PieceRings = Vec::new();
        for ring in &piece.rings {
            let mut lists: Vec<Option<&RingMatch>> = Vec::new();
            for (k, lookup) in lookups.iter().enumerate() {
                lists.push(match lookup {
                    None => None,
                    Some(_) if k == base => Some(ring),
                    Some(lookup) => Some(lookup.ring_of(&ring.source).ok_or(k)?),
                });
            }
            rings.push(merged_rings(&lists, MERGE_DISTANCE * size)?);
        }
        pieces.push(rings);
    }
    Ok(pieces)
}

/// Returns whether the parts and holes of the two designs correspond one to one: none is split, cut
/// open or unmatched.
fn is_one_to_one(matched: &RegionMatch) -> bool {
    let are_distinct = |side: fn(&PieceMatch) -> Option<usize>| {
        let mut parts: Vec<_> = matched.pieces.iter().map(side).collect();
        let count = parts.len();
        parts.sort_unstable();
        parts.dedup();
        parts.len() == count
    };
    let is_matched = |piece: &PieceMatch| {
        let rings = &piece.rings;
        piece.is_matched()
            && piece.lone.is_empty()
            && piece.cuts.is_empty()
            && rings.iter().all(|ring| ring.kind == RingKind::Matched)
    };
    matched.pieces.iter().all(is_matched)
        && are_distinct(|piece| piece.source_part)
        && are_distinct(|piece| piece.target_part)
}

/// Hash key of a point: the bit patterns of its coordinates.
fn key(p: DVec2) -> [u64; 2] {
    // Adding zero turns -0 into 0, which has a different bit pattern.
    (p + 0.0).to_array().map(f64::to_bits)
}

/// Rings of a match, indexed by the points of the hub that lie on them.
struct RingLookup<'a> {
    rings: HashMap<[u64; 2], &'a RingMatch>,
}

impl<'a> RingLookup<'a> {
    /// Indexes the rings of a match by the points of their source, the hub.
    fn of(matched: &'a RegionMatch) -> Self {
        let rings = matched.pieces.iter().flat_map(|piece| &piece.rings);
        let points = rings.flat_map(|ring| ring.source.iter().map(move |&p| (key(p), ring)));
        Self {
            rings: points.collect(),
        }
    }

    /// Returns the ring of this match that contains one of the given points of the hub; `None` if
    /// no ring does.
    fn ring_of(&self, points: &[DVec2]) -> Option<&'a RingMatch> {
        points
            .iter()
            .find_map(|&p| self.rings.get(&key(p)).copied())
    }
}

/// Point that a match adds on an edge of the hub, the design with which all others are matched.
/// The ends of the edge are two corners that all matches share.
struct HubEdgePoint {
    /// Position along the hub's edge, from 0 at its first corner to 1 at its second.
    share: f64,
    /// Index of the design whose match adds the point.
    design: usize,
    /// Position of the corresponding point in that design.
    place: DVec2,
}

/// Merges the matches of one ring. Returns this ring in every design, as lists of corresponding
/// points that contain the points of all matches.
///
/// For each design, `lists` contains the match of the hub's ring with that design's ring; for the
/// hub it contains `None`.
///
/// # Errors
/// Index of a design whose match lists the shared corners in another order. Index of the first
/// matched design if all matches together share fewer than three points.
fn merged_rings(
    lists: &[Option<&RingMatch>],
    merge_distance: f64,
) -> Result<Vec<Vec<DVec2>>, usize> {
    let corners = shared_corners(lists)?;
    let mut rings = vec![Vec::new(); lists.len()];
    // Returns the index of a corner of the hub among the hub's points in a match.
    let index = |list: &RingMatch, corner: DVec2| {
        let is_it = |p: &DVec2| key(*p) == key(corner);
        list.source.iter().position(is_it)
    };
    // For each design: the index of the current corner in the `source` points of its match, which
    // lie on the hub's ring. The hub has no match; its entry is not used.
    let mut corner_index = Vec::new();
    for (k, list) in lists.iter().enumerate() {
        corner_index.push(match list {
            None => 0,
            Some(list) => index(list, corners[0]).ok_or(k)?,
        });
    }
    for (c, &corner) in corners.iter().enumerate() {
        let next = corners[(c + 1) % corners.len()];
        let length = corner.distance(next);
        let mut edge_points = Vec::new();
        let mut ends = Vec::new();
        for (k, list) in lists.iter().enumerate() {
            let Some(list) = list else {
                ends.push([corner, next]);
                continue;
            };
            let count = list.source.len();
            let first = corner_index[k];
            let mut cursor = first;
            // Between this corner and the next one, all points of the match lie on the hub's edge
            // between the two corners.
            loop {
                cursor = (cursor + 1) % count;
                if key(list.source[cursor]) == key(next) {
                    break;
                }
                // The search has gone all the way round the ring without meeting the next corner.
                if cursor == first {
                    return Err(k);
                }
                edge_points.push(HubEdgePoint {
                    share: (corner.distance(list.source[cursor]) / length).clamp(0.0, 1.0),
                    design: k,
                    place: list.target[cursor],
                });
            }
            ends.push([list.target[first], list.target[cursor]]);
            corner_index[k] = cursor;
        }
        append_edge(&mut rings, &ends, edge_points, merge_distance / length);
    }
    Ok(rings)
}

/// Returns the points of the hub that all matches share, in order along the ring. They include all
/// corners of the hub.
///
/// # Errors
/// Index of the first matched design if fewer than three points are shared.
fn shared_corners(lists: &[Option<&RingMatch>]) -> Result<Vec<DVec2>, usize> {
    let mut counts: HashMap<[u64; 2], usize> = HashMap::new();
    let present: Vec<_> = lists.iter().flatten().collect();
    for list in &present {
        list.source
            .iter()
            .for_each(|&p| *counts.entry(key(p)).or_default() += 1);
    }
    let base = present.first().map_or(&[][..], |list| &list.source[..]);
    let corners = base.iter().filter(|p| counts[&key(**p)] == present.len());
    let corners: Vec<DVec2> = corners.copied().collect();
    match corners.len() {
        0..3 => Err(lists.iter().position(Option::is_some).unwrap_or(0)),
        _ => Ok(corners),
    }
}

/// Appends the first corner of a hub edge and the points on that edge to the ring of every design.
/// The second corner is appended with the next edge.
///
/// For each design, `ends` contains the positions of both corners. Points of different designs are
/// merged if their distance is at most `merge_share` times the edge's length.
fn append_edge(
    rings: &mut [Vec<DVec2>],
    ends: &[[DVec2; 2]],
    mut edge_points: Vec<HubEdgePoint>,
    merge_share: f64,
) {
    // The sort is stable, so the points of each design keep their order.
    edge_points.sort_by(|a, b| a.share.total_cmp(&b.share));
    // A cluster contains points at about the same place, at most one of each design.
    let mut clusters: Vec<Vec<HubEdgePoint>> = Vec::new();
    for point in edge_points {
        let joins = clusters.last().is_some_and(|cluster| {
            point.share - cluster[0].share <= merge_share
                && cluster.iter().all(|other| other.design != point.design)
        });
        match clusters.last_mut() {
            Some(cluster) if joins => cluster.push(point),
            _ => clusters.push(vec![point]),
        }
    }
    let shares: Vec<f64> = clusters.iter().map(|cluster| cluster[0].share).collect();
    for (k, ring) in rings.iter_mut().enumerate() {
        let own = |cluster: &Vec<HubEdgePoint>| {
            let point = cluster.iter().find(|point| point.design == k);
            point.map(|point| point.place)
        };
        let own_places: Vec<Option<DVec2>> = clusters.iter().map(own).collect();
        let [begin, end] = ends[k];
        ring.push(begin);
        let mut last = (0.0, begin);
        for (i, &share) in shares.iter().enumerate() {
            let place = own_places[i].unwrap_or_else(|| {
                // This design has no point in the cluster. A position is interpolated between the
                // previous point of the ring and the next point that the design's own match adds on
                // this edge.
                let after = (i + 1..shares.len()).find_map(|j| Some((shares[j], own_places[j]?)));
                let (to, place) = after.unwrap_or((1.0, end));
                let span = to - last.0;
                let part = if span > 0.0 {
                    (share - last.0) / span
                } else {
                    0.5
                };
                last.1.lerp(place, part)
            });
            ring.push(place);
            last = (share, place);
        }
    }
}
