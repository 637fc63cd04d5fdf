//! Boundary rings with one point for each matched place, in every design of a family.
//!
//! All designs are matched with one of them, the *hub*. Each match adds points of its own to the
//! hub's outline. Between two neighbouring corners of the hub the outline is straight, so the
//! points of all matches are ordered along that edge. A design without a point at such a place gets
//! one at the same fraction between its two neighbouring points. Points of different matches at the
//! same place become one.

use crate::correspondence::{PieceMatch, RegionMatch, RingKind, RingMatch};
use crate::geometry::{Bounds, DVec2};
use std::collections::HashMap;

/// Points of different matches closer than this fraction of the hub's diameter are merged
/// (tolerance: far below what is visible, and far above the rounding that separates the points of
/// two equal designs).
const MERGE_DISTANCE: f64 = 1e-6;

/// Rings of one piece in all designs: `rings[ring][design]` is a list of points.
pub(super) type PieceRings = Vec<Vec<Vec<DVec2>>>;

/// Returns the rings of all pieces with the points of all designs.
///
/// `matches` holds for each design its match with the hub as the source, and `None` for the hub.
///
/// # Errors
/// Index of a design whose parts or holes differ from the hub's, so that no shared points exist.
pub(super) fn shared_rings(
    hub: usize,
    matches: &[Option<&RegionMatch>],
) -> Result<Vec<PieceRings>, usize> {
    for (k, matched) in matches.iter().enumerate() {
        if matched.is_some_and(|matched| !is_one_to_one(matched)) {
            return Err(k);
        }
    }
    // Any match serves as the base, because all have the rings of the hub as their sources.
    let Some((base, first)) = matches
        .iter()
        .enumerate()
        .find_map(|(k, m)| Some((k, (*m)?)))
    else {
        return Err(hub);
    };
    // Each match lists pieces and rings in its own order, so rings are looked up by hub points.
    let lookups: Vec<_> = matches.iter().map(|m| m.map(RingLookup::of)).collect();
    // Matches that agree one to one must also agree in their numbers of rings.
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

/// Returns whether parts and holes correspond one to one: nothing is split, cut open or unmatched.
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
        piece.is_in_both()
            && piece.lone.is_empty()
            && piece.cuts.is_empty()
            && rings.iter().all(|ring| ring.kind == RingKind::Matched)
    };
    matched.pieces.iter().all(is_matched)
        && are_distinct(|piece| piece.source_part)
        && are_distinct(|piece| piece.target_part)
}

/// Hash key of a point: the bits of its coordinates.
fn key(p: DVec2) -> [u64; 2] {
    // Adding zero turns -0 into 0, which has other bits.
    (p + 0.0).to_array().map(f64::to_bits)
}

/// Rings of a match, looked up by the hub points on them.
struct RingLookup<'a> {
    rings: HashMap<[u64; 2], &'a RingMatch>,
}

impl<'a> RingLookup<'a> {
    /// Indexes the rings of a match by their source points.
    fn of(matched: &'a RegionMatch) -> Self {
        let rings = matched.pieces.iter().flat_map(|piece| &piece.rings);
        let points = rings.flat_map(|ring| ring.source.iter().map(move |&p| (key(p), ring)));
        Self {
            rings: points.collect(),
        }
    }

    /// Returns the ring of this match that contains one of the points.
    fn ring_of(&self, points: &[DVec2]) -> Option<&'a RingMatch> {
        points
            .iter()
            .find_map(|&p| self.rings.get(&key(p)).copied())
    }
}

/// Point that a match adds on an edge of the hub.
struct HubEdgePoint {
    /// Position along the edge, from 0 to 1.
    share: f64,
    /// Index of the matched design.
    design: usize,
    /// Position of the point in that design.
    place: DVec2,
}

/// Returns one ring for every design, with the points of all matches.
///
/// `lists` holds the match of the hub's ring with the ring of each other design, and `None` for the
/// hub.
///
/// # Errors
/// Index of a design that visits the corners in another order.
fn merged_rings(
    lists: &[Option<&RingMatch>],
    merge_distance: f64,
) -> Result<Vec<Vec<DVec2>>, usize> {
    let corners = shared_corners(lists)?;
    let mut rings = vec![Vec::new(); lists.len()];
    // Index of a corner in a list.
    let index = |list: &RingMatch, corner: DVec2| {
        let is_it = |p: &DVec2| key(*p) == key(corner);
        list.source.iter().position(is_it)
    };
    // Index of the current corner in each list.
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
            // Every point up to the next corner lies on this edge.
            loop {
                cursor = (cursor + 1) % count;
                if key(list.source[cursor]) == key(next) {
                    break;
                }
                // Once around without meeting the next corner.
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

/// Returns the hub points that all matches share, in order. These include all corners of the hub.
///
/// # Errors
/// Index of a design if fewer than three points are shared.
fn shared_corners(lists: &[Option<&RingMatch>]) -> Result<Vec<DVec2>, usize> {
    let mut counts: HashMap<[u64; 2], usize> = HashMap::new();
    let given: Vec<_> = lists.iter().flatten().collect();
    for list in &given {
        list.source
            .iter()
            .for_each(|&p| *counts.entry(key(p)).or_default() += 1);
    }
    let base = given.first().map_or(&[][..], |list| &list.source[..]);
    let corners = base.iter().filter(|p| counts[&key(**p)] == given.len());
    let corners: Vec<DVec2> = corners.copied().collect();
    match corners.len() {
        0..3 => Err(lists.iter().position(Option::is_some).unwrap_or(0)),
        _ => Ok(corners),
    }
}

/// Appends a corner and the points up to the next corner to the ring of every design.
///
/// `ends` holds the edge's ends in each design. Points closer than the fraction `merge_share` of
/// the edge are merged unless they belong to one design.
fn append_edge(
    rings: &mut [Vec<DVec2>],
    ends: &[[DVec2; 2]],
    mut edge_points: Vec<HubEdgePoint>,
    merge_share: f64,
) {
    // The sort is stable, so the points of one design stay in order.
    edge_points.sort_by(|a, b| a.share.total_cmp(&b.share));
    // A cluster holds points at about the same place, at most one for each design.
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
        let known: Vec<Option<DVec2>> = clusters.iter().map(own).collect();
        let [begin, end] = ends[k];
        ring.push(begin);
        let mut last = (0.0, begin);
        for (i, &share) in shares.iter().enumerate() {
            let place = known[i].unwrap_or_else(|| {
                // Interpolates between the previous point and this design's next own point.
                let after = (i + 1..shares.len()).find_map(|j| Some((shares[j], known[j]?)));
                let (to, place) = after.unwrap_or((1.0, end));
                let way = to - last.0;
                let part = if way > 0.0 {
                    (share - last.0) / way
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
