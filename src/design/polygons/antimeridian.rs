//! Makes outlines whole at the antimeridian, longitude 180°, where a map of longitudes has its cut
//! (Butler et al., RFC 7946, 2016, section 3.1.9).
//!
//! A ring with a step of more than 180° in longitude takes the shorter way, across the
//! antimeridian. Pieces that a file has split there, as the RFC asks, share an edge along it. In
//! both cases the map is cut elsewhere: in the middle of the widest range of longitudes without any
//! outline, so that all pieces of an island lie next to each other. Longitudes then continue beyond
//! ±180°. A map that reaches around the globe has no such range; only rings with a step are changed
//! there.
//!
//! A ring around a pole is not closed by its longitudes. If the file does not close it along the
//! pole, it is closed there. Rings without these features do not change.

use super::value::JsonRing;
use crate::design::note::ImportNote;
use crate::geometry::{DVec2, signed_area};

/// Longitudes of a full turn, in degrees.
const TURN: f64 = 360.0;

/// Largest step in longitude between two points of a ring that do not lie on opposite sides of the
/// antimeridian (derived: half a turn; every longer way has a shorter one around the other side).
const MAX_STEP: f64 = 180.0;

/// Latitude of the poles, in degrees.
const POLE: f64 = 90.0;

/// Part of a turn by which a ring may begin west of the edge of the map (tolerance: rounding of
/// longitudes to which full turns were added).
const ROUNDING: f64 = 1e-12;

/// Makes the outlines of all polygons whole at the antimeridian, and returns notes on the changes.
///
/// Coordinates that cannot be degrees of longitude and latitude are left as they are.
pub(super) fn join_at_antimeridian(polygons: &mut [Vec<JsonRing>]) -> Vec<ImportNote> {
    if !polygons.iter().flatten().flatten().all(is_geographic) {
        return Vec::new();
    }
    let polar = polygons.iter_mut().flatten().map(close_along_pole);
    let polar = polar.filter(|is_closed| *is_closed).count();
    let mut notes: Vec<ImportNote> = (polar > 0)
        .then_some(ImportNote::PolarOutlines(polar))
        .into_iter()
        .collect();
    let mut continued = 0;
    for polygon in polygons.iter_mut() {
        continued += unwrap_polygon(polygon);
    }
    let is_split = has_shared_cut(polygons);
    if continued > 0 || is_split {
        match western_edge(polygons) {
            Some(west) => continued += recut(polygons, west),
            None if is_split => notes.push(ImportNote::CutAtAntimeridian),
            None => {}
        }
    }
    if continued > 0 {
        notes.push(ImportNote::CrossesAntimeridian(continued));
    }
    notes
}

/// Returns whether a point can be a longitude and a latitude in degrees. Some programs continue
/// longitudes beyond 180°.
fn is_geographic(p: &DVec2) -> bool {
    p.x.abs() <= TURN && p.y.abs() <= POLE
}

/// Returns the indices of the points from which a ring steps across the antimeridian.
fn jumps(ring: &JsonRing) -> impl Iterator<Item = usize> {
    let next = |k: usize| ring[(k + 1) % ring.len()];
    (0..ring.len()).filter(move |&k| (next(k).x - ring[k].x).abs() > MAX_STEP)
}

/// Returns the multiple of a full turn that is nearest to a difference of longitudes.
fn nearest_turns(difference: f64) -> f64 {
    TURN * (difference / TURN).round()
}

/// Returns the ring with longitudes that continue across the antimeridian, and the change of
/// longitude in one turn along the ring: 0 unless the ring goes around a pole.
fn unwrapped(ring: &JsonRing) -> (JsonRing, f64) {
    let mut shift = 0.0;
    let mut points: JsonRing = Vec::with_capacity(ring.len());
    for (k, p) in ring.iter().enumerate() {
        if k > 0 {
            shift -= nearest_turns(p.x - ring[k - 1].x);
        }
        points.push(DVec2::new(p.x + shift, p.y));
    }
    let last_step = ring
        .first()
        .zip(ring.last())
        .map_or(0.0, |(a, b)| a.x - b.x);
    (points, shift - nearest_turns(last_step))
}

/// Closes a ring around a pole along this pole, if the file has not done so. Returns whether the
/// ring has changed.
fn close_along_pole(ring: &mut JsonRing) -> bool {
    let mut jumps_of_ring = jumps(ring);
    let (Some(k), None) = (jumps_of_ring.next(), jumps_of_ring.next()) else {
        return false;
    };
    drop(jumps_of_ring);
    let (from, to) = (ring[k], ring[(k + 1) % ring.len()]);
    if unwrapped(ring).1 == 0.0 || from.y.abs() == POLE || to.y.abs() == POLE {
        return false;
    }
    let mean = ring.iter().map(|p| p.y).sum::<f64>() / ring.len() as f64;
    let pole = POLE.copysign(mean);
    let side = MAX_STEP.copysign(from.x);
    // The latitude at which the step crosses the antimeridian.
    let whole = TURN - (from.x - to.x).abs();
    let share = match whole > 0.0 {
        true => (side - from.x).abs() / whole,
        false => 0.0,
    };
    let crossing = from.y + share.clamp(0.0, 1.0) * (to.y - from.y);
    let corners = [
        (side, crossing),
        (side, pole),
        (-side, pole),
        (-side, crossing),
    ];
    ring.splice(k + 1..k + 1, corners.map(DVec2::from));
    true
}

/// Continues the rings of a polygon across the antimeridian where they step over it, with the holes
/// in the longitudes of the outer ring. Returns the number of rings that have changed.
fn unwrap_polygon(polygon: &mut [JsonRing]) -> usize {
    let mut changed = 0;
    for ring in polygon.iter_mut() {
        if jumps(ring).next().is_none() || is_box(ring) {
            continue;
        }
        let (mut points, turns) = unwrapped(ring);
        if turns != 0.0 {
            continue;
        }
        // Most points keep the longitudes that the file gives them.
        let shifted = points
            .iter()
            .zip(ring.iter())
            .map(|(new, old)| new.x - old.x);
        let majority = majority(shifted);
        points.iter_mut().for_each(|p| p.x -= majority);
        *ring = points;
        changed += 1;
    }
    if changed > 0
        && let [outer, holes @ ..] = polygon
        && let Some([west, east]) = longitudes(outer)
    {
        for hole in holes {
            if let Some([from, to]) = longitudes(hole) {
                let shift = nearest_turns(0.5 * ((west + east) - (from + to)));
                hole.iter_mut().for_each(|p| p.x += shift);
            }
        }
    }
    changed
}

/// Returns whether a ring is an upright rectangle, counter-clockwise as the file draws it: then it
/// is the frame of a map and does not cross the antimeridian. RFC 7946 lists outer rings
/// counter-clockwise, so that the same rectangle across the antimeridian would be clockwise.
fn is_box(ring: &JsonRing) -> bool {
    let is_upright = |k: usize| {
        let (a, b) = (ring[k], ring[(k + 1) % ring.len()]);
        a.x == b.x || a.y == b.y
    };
    (0..ring.len()).all(is_upright) && ring.len() <= 5 && signed_area(ring) > 0.0
}

/// Returns the value that occurs most often, the smallest of several; 0 for no values.
fn majority(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let runs = sorted.chunk_by(|a, b| a == b);
    let longest = runs.fold(
        &[][..],
        |best: &[f64], run| {
            if run.len() > best.len() { run } else { best }
        },
    );
    longest.first().copied().unwrap_or(0.0)
}

/// Returns the smallest and the largest longitude of a ring.
fn longitudes(ring: &JsonRing) -> Option<[f64; 2]> {
    let range = |range: Option<[f64; 2]>, p: &DVec2| {
        let [west, east] = range.unwrap_or([p.x; 2]);
        Some([west.min(p.x), east.max(p.x)])
    };
    ring.iter().fold(None, range)
}

/// Returns whether an edge along longitude 180° and an edge along −180° share a range of latitudes,
/// as the pieces of an outline do that the file has split there. A ring with edges along both lines
/// goes around the globe and is not such a piece.
fn has_shared_cut(polygons: &[Vec<JsonRing>]) -> bool {
    let edges_along = |longitude: f64| {
        let is_piece = |ring: &&JsonRing| !is_along(ring, -longitude);
        let rings = polygons.iter().flatten().filter(is_piece);
        let along = rings.flat_map(|ring| edges(ring).filter(move |edge| lies_on(edge, longitude)));
        let mut ranges: Vec<[f64; 2]> = along.map(|[a, b]| [a.y.min(b.y), a.y.max(b.y)]).collect();
        ranges.sort_by(|a, b| a[0].total_cmp(&b[0]));
        ranges
    };
    let (east, west) = (edges_along(MAX_STEP), edges_along(-MAX_STEP));
    let (mut i, mut j) = (0, 0);
    while let (Some(a), Some(b)) = (east.get(i), west.get(j)) {
        if a[0] < b[1] && b[0] < a[1] {
            return true;
        }
        // The range that ends first cannot share latitudes with any later one.
        if a[1] < b[1] { i += 1 } else { j += 1 }
    }
    false
}

/// Returns the edges of a ring.
fn edges(ring: &JsonRing) -> impl Iterator<Item = [DVec2; 2]> {
    let ends = ring.iter().cycle().skip(1);
    ring.iter().zip(ends).map(|(&a, &b)| [a, b])
}

/// Returns whether an edge lies on a meridian and has a length.
fn lies_on([a, b]: &[DVec2; 2], longitude: f64) -> bool {
    a.x == longitude && b.x == longitude && a.y != b.y
}

/// Returns whether any edge of a ring lies on a meridian.
fn is_along(ring: &JsonRing, longitude: f64) -> bool {
    edges(ring).any(|edge| lies_on(&edge, longitude))
}

/// Returns the longitude, from −180° to 180°, at which the outlines begin east of the widest range
/// of longitudes without outlines; `None` if there is no such range.
fn western_edge(polygons: &[Vec<JsonRing>]) -> Option<f64> {
    let mut ranges: Vec<[f64; 2]> = polygons.iter().flatten().filter_map(longitudes).collect();
    for range in &mut ranges {
        let shift = TURN * ((range[0] + MAX_STEP) / TURN).floor();
        range.iter_mut().for_each(|x| *x -= shift);
    }
    ranges.sort_by(|a, b| a[0].total_cmp(&b[0]));
    // Two turns around the globe: in the second one, the outlines that continue from the first one
    // are known.
    let turns = [0.0, TURN].into_iter();
    let all = turns.flat_map(|turn| ranges.iter().map(move |range| (turn, range)));
    let (mut widest, mut edge, mut end) = (0.0, None, f64::NEG_INFINITY);
    for (turn, &[west, east]) in all {
        let gap = west + turn - end;
        if turn > 0.0 && gap > widest {
            (widest, edge) = (gap, Some(west));
        }
        end = end.max(east + turn);
    }
    edge
}

/// Moves rings by full turns so that all lie between the longitude `west` and one turn to the east
/// of it; most points keep their longitudes. Returns the number of rings that have moved.
fn recut(polygons: &mut [Vec<JsonRing>], west: f64) -> usize {
    let shift = |ring: &JsonRing| -> f64 {
        let from = longitudes(ring).map_or(west, |range| range[0]);
        -TURN * ((from - west) / TURN + ROUNDING).floor()
    };
    let rings = polygons.iter().flatten();
    let majority = majority(rings.flat_map(|ring| std::iter::repeat_n(shift(ring), ring.len())));
    let mut moved = 0;
    for ring in polygons.iter_mut().flatten() {
        let by = shift(ring) - majority;
        if by != 0.0 {
            ring.iter_mut().for_each(|p| p.x += by);
            moved += 1;
        }
    }
    moved
}
