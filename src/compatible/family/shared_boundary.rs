//! The boundary points of many designs, each of which is matched with one of them,
//! the *hub*.
//!
//! Every match puts points of its own on the hub's outline. Between two corners of the
//! hub its outline is straight, so that the points of all matches have an order there;
//! where a design has no point of its own, it gets one at the same share of the way
//! between the two beside it. Points of different matches in one place are one.

use crate::correspondence::{PieceMatch, RegionMatch, RingKind, RingMatch};
use crate::geometry::{Bounds, DVec2};
use std::collections::HashMap;

/// Points of different matches that are nearer to each other than this share of the
/// hub's diameter are one. A ten-thousandth of what is seen; without it two designs that
/// are alike make edges as short as rounding.
const ONE: f64 = 1e-6;

/// The rings of one piece, each for every design, in the designs' order.
pub(super) type PieceRings = Vec<Vec<Vec<DVec2>>>;

/// The rings of all pieces with the points of all designs, given the match of the hub
/// with each other design; none at the hub itself. The number of a design that has
/// other parts or holes than the hub where they cannot be found.
pub(super) fn shared_rings(
    hub: usize,
    matches: &[Option<&RegionMatch>],
) -> Result<Vec<PieceRings>, usize> {
    for (k, matched) in matches.iter().enumerate() {
        if matched.is_some_and(|matched| !is_whole(matched)) {
            return Err(k);
        }
    }
    let Some((base, first)) = matches
        .iter()
        .enumerate()
        .find_map(|(k, m)| Some((k, (*m)?)))
    else {
        return Err(hub);
    };
    // Of each other design its pieces and rings, by the points of the hub on them.
    let found: Vec<_> = matches.iter().map(|m| m.map(RingLookup::of)).collect();
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
            for (k, finder) in found.iter().enumerate() {
                lists.push(match finder {
                    None => None,
                    Some(_) if k == base => Some(ring),
                    Some(finder) => Some(finder.ring_of(&ring.source).ok_or(k)?),
                });
            }
            rings.push(merged(&lists, ONE * size)?);
        }
        pieces.push(rings);
    }
    Ok(pieces)
}

/// Whether each part of one is a part of the other, hole by hole.
fn is_whole(matched: &RegionMatch) -> bool {
    let are_apart = |side: fn(&PieceMatch) -> Option<usize>| {
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
        && are_apart(|piece| piece.source_part)
        && are_apart(|piece| piece.target_part)
}

/// A point by its bits.
fn key(p: DVec2) -> [u64; 2] {
    // Negative zero is zero.
    (p + 0.0).to_array().map(f64::to_bits)
}

/// The rings of a match by the points of the source on them.
struct RingLookup<'a> {
    rings: HashMap<[u64; 2], &'a RingMatch>,
}

impl<'a> RingLookup<'a> {
    fn of(matched: &'a RegionMatch) -> Self {
        let rings = matched.pieces.iter().flat_map(|piece| &piece.rings);
        let points = rings.flat_map(|ring| ring.source.iter().map(move |&p| (key(p), ring)));
        Self {
            rings: points.collect(),
        }
    }

    /// The ring on which the corners of another match's ring are.
    fn ring_of(&self, points: &[DVec2]) -> Option<&'a RingMatch> {
        points
            .iter()
            .find_map(|&p| self.rings.get(&key(p)).copied())
    }
}

/// A point of a match between two corners of the hub.
struct HubEdgePoint {
    /// How far it is between them.
    share: f64,
    design: usize,
    at: DVec2,
}

/// One ring for every design: `lists` has the hub's ring matched with that of each
/// other, and none for the hub itself. The number of a design that goes about the
/// corners another way.
fn merged(lists: &[Option<&RingMatch>], near: f64) -> Result<Vec<Vec<DVec2>>, usize> {
    let corners = corners(lists)?;
    let mut rings = vec![Vec::new(); lists.len()];
    // Where each corner is in each list.
    let index = |list: &RingMatch, corner: DVec2| {
        let is_it = |p: &DVec2| key(*p) == key(corner);
        list.source.iter().position(is_it)
    };
    let mut from = Vec::new();
    for (k, list) in lists.iter().enumerate() {
        from.push(match list {
            None => 0,
            Some(list) => index(list, corners[0]).ok_or(k)?,
        });
    }
    for (c, &corner) in corners.iter().enumerate() {
        let next = corners[(c + 1) % corners.len()];
        let length = corner.distance(next);
        let mut knots = Vec::new();
        let mut ends = Vec::new();
        for (k, list) in lists.iter().enumerate() {
            let Some(list) = list else {
                ends.push([corner, next]);
                continue;
            };
            let count = list.source.len();
            let first = from[k];
            let mut at = first;
            loop {
                at = (at + 1) % count;
                if key(list.source[at]) == key(next) {
                    break;
                }
                if at == first {
                    return Err(k);
                }
                knots.push(HubEdgePoint {
                    share: (corner.distance(list.source[at]) / length).clamp(0.0, 1.0),
                    design: k,
                    at: list.target[at],
                });
            }
            ends.push([list.target[first], list.target[at]]);
            from[k] = at;
        }
        between(&mut rings, &ends, knots, near / length);
    }
    Ok(rings)
}

/// The points of the hub that are on the rings of all others, in order: all its corners.
fn corners(lists: &[Option<&RingMatch>]) -> Result<Vec<DVec2>, usize> {
    let mut times: HashMap<[u64; 2], usize> = HashMap::new();
    let given: Vec<_> = lists.iter().flatten().collect();
    for list in &given {
        list.source
            .iter()
            .for_each(|&p| *times.entry(key(p)).or_default() += 1);
    }
    let base = given.first().map_or(&[][..], |list| &list.source[..]);
    let corners = base.iter().filter(|p| times[&key(**p)] == given.len());
    let corners: Vec<DVec2> = corners.copied().collect();
    match corners.len() {
        0..3 => Err(lists.iter().position(Option::is_some).unwrap_or(0)),
        _ => Ok(corners),
    }
}

/// Adds a corner and what follows up to the next one to the ring of every design.
fn between(rings: &mut [Vec<DVec2>], ends: &[[DVec2; 2]], mut knots: Vec<HubEdgePoint>, near: f64) {
    // Stable: points of one design stay in their order.
    knots.sort_by(|a, b| a.share.total_cmp(&b.share));
    let mut clusters: Vec<Vec<HubEdgePoint>> = Vec::new();
    for knot in knots {
        let joins = clusters.last().is_some_and(|cluster| {
            knot.share - cluster[0].share <= near
                && cluster.iter().all(|other| other.design != knot.design)
        });
        match clusters.last_mut() {
            Some(cluster) if joins => cluster.push(knot),
            _ => clusters.push(vec![knot]),
        }
    }
    let shares: Vec<f64> = clusters.iter().map(|cluster| cluster[0].share).collect();
    for (k, ring) in rings.iter_mut().enumerate() {
        let own = |cluster: &Vec<HubEdgePoint>| {
            cluster.iter().find(|knot| knot.design == k).map(|n| n.at)
        };
        let known: Vec<Option<DVec2>> = clusters.iter().map(own).collect();
        let [begin, end] = ends[k];
        ring.push(begin);
        let mut last = (0.0, begin);
        for (i, &share) in shares.iter().enumerate() {
            let place = known[i].unwrap_or_else(|| {
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
