//! The two sides of a slit given the same vertices.
//!
//! A walk runs along its slit twice, and the other design's vertices fall on
//! either passage as they will. Both get all of them, in the same points bit
//! by bit: a mesh of the part before it was cut has those points once.

use super::super::curve::Curve;
use super::super::polygons::SharedPolygons;
use crate::geometry::{DVec2, Side};

/// Vertices of the two passages nearer than this share of the slit divided by
/// their number become one.
const NEAR: f64 = 0.35;

/// A vertex on one passage.
#[derive(Clone, Copy)]
struct Stop {
    /// From the slit's outer end, in (0, 1).
    along: f64,
    /// Its index among the shared vertices.
    vertex: usize,
}

/// One of the points that both passages get.
struct Rung {
    along: f64,
    /// The vertices that are there already: on the way there and back.
    there: [Option<usize>; 2],
}

/// Gives both passages of a slit the same vertices. `side` is the design that
/// was cut, with its walk's `curve`; `other` is the other design's curve.
pub(super) fn mirror(
    shared: &mut SharedPolygons,
    side: Side,
    curve: &Curve,
    slit: [DVec2; 2],
    other: &Curve,
) {
    let Some(passages) = passages(curve, slit) else {
        return;
    };
    let stops = [
        stops(shared, side, passages[0], false),
        stops(shared, side, passages[1], true),
    ];
    let rungs = spread(paired(&stops));
    let mut added = Vec::new();
    for (way, passage) in passages.iter().enumerate() {
        place_passage(
            shared, side, curve, slit, other, &rungs, way, *passage, &mut added,
        );
    }
    insert(shared, side, curve, added);
}

/// Places between which the curve runs along the slit: out, then back.
fn passages(curve: &Curve, [a, b]: [DVec2; 2]) -> Option<[[f64; 2]; 2]> {
    let points = curve.points();
    let n = points.len();
    let find = |p: DVec2, q: DVec2| {
        let k = (0..n).find(|&k| points[k] == p && points[(k + 1) % n] == q)?;
        let end = curve.places().get(k + 1).copied().unwrap_or(1.0);
        Some([curve.places()[k], end])
    };
    Some([find(a, b)?, find(b, a)?])
}

/// The vertices strictly inside a passage, from the slit's outer end on.
fn stops(shared: &SharedPolygons, side: Side, [from, to]: [f64; 2], is_back: bool) -> Vec<Stop> {
    let mut stops: Vec<Stop> = shared
        .places
        .iter()
        .enumerate()
        .filter(|(_, place)| from < place[side] && place[side] < to)
        .map(|(vertex, place)| {
            let along = (place[side] - from) / (to - from);
            let along = if is_back { 1.0 - along } else { along };
            Stop { along, vertex }
        })
        .collect();
    stops.sort_by(|a, b| a.along.total_cmp(&b.along));
    stops
}

/// Both passages' stops in one order, near ones together.
fn paired([there, back]: &[Vec<Stop>; 2]) -> Vec<Rung> {
    let near = NEAR / (there.len().max(back.len()) + 1) as f64;
    let (mut i, mut j) = (0, 0);
    let mut rungs = Vec::new();
    while i < there.len() || j < back.len() {
        let (a, b) = (there.get(i), back.get(j));
        let rung = match (a, b) {
            (Some(a), Some(b)) if (a.along - b.along).abs() <= near => Rung {
                along: a.along.midpoint(b.along),
                there: [Some(a.vertex), Some(b.vertex)],
            },
            (Some(a), b) if b.is_none_or(|b| a.along < b.along) => Rung {
                along: a.along,
                there: [Some(a.vertex), None],
            },
            (_, Some(b)) => Rung {
                along: b.along,
                there: [None, Some(b.vertex)],
            },
            _ => break,
        };
        i += usize::from(rung.there[0].is_some());
        j += usize::from(rung.there[1].is_some());
        rungs.push(rung);
    }
    rungs
}

/// Strictly ascending, with room between neighbours. Where a slit's inner
/// vertices lie is free: no outline runs there.
fn spread(mut rungs: Vec<Rung>) -> Vec<Rung> {
    let count = rungs.len() as f64 + 1.0;
    let mut alongs: Vec<f64> = rungs.iter().map(|rung| rung.along).collect();
    alongs.sort_by(f64::total_cmp);
    let ends = std::iter::once(0.0)
        .chain(alongs.iter().copied())
        .chain(std::iter::once(1.0))
        .collect::<Vec<_>>();
    let crowded = ends.windows(2).any(|w| w[1] - w[0] < 0.1 / count);
    for (k, rung) in rungs.iter_mut().enumerate() {
        rung.along = if crowded {
            (k + 1) as f64 / count
        } else {
            alongs[k]
        };
    }
    rungs
}

/// A vertex to come: its place on either side and its points.
struct Added {
    places: [f64; 2],
    points: [DVec2; 2],
}

/// Moves the vertices that a passage has to the rungs, and collects those
/// that it lacks.
#[expect(clippy::too_many_arguments, reason = "one step of `mirror`")]
fn place_passage(
    shared: &mut SharedPolygons,
    side: Side,
    curve: &Curve,
    [a, b]: [DVec2; 2],
    other: &Curve,
    rungs: &[Rung],
    way: usize,
    [from, to]: [f64; 2],
    added: &mut Vec<Added>,
) {
    let own_place = |along: f64| {
        let along = if way == 0 { along } else { 1.0 - along };
        from + along * (to - from)
    };
    let known = anchors(shared, side, curve, [from, to], rungs, way);
    for rung in rungs {
        let point = a.lerp(b, rung.along);
        let own = own_place(rung.along);
        if let Some(vertex) = rung.there[way] {
            points_of(shared, side)[vertex] = point;
            shared.places[vertex][side] = own;
        } else {
            let across = other.wrapped(interpolated(&known, rung.along));
            let mut places = [across; 2];
            places[side] = own;
            let mut points = [other.point_at(across); 2];
            points[side] = point;
            added.push(Added { places, points });
        }
    }
}

/// Share of the slit and the other side's place, unwrapped, of all vertices
/// that the passage has, its ends among them, by the share.
fn anchors(
    shared: &SharedPolygons,
    side: Side,
    curve: &Curve,
    [from, to]: [f64; 2],
    rungs: &[Rung],
    way: usize,
) -> Vec<[f64; 2]> {
    let at = |place: f64| {
        let wrapped = curve.wrapped(place);
        let apart = |k: &usize| (shared.places[*k][side] - wrapped).abs();
        (0..shared.places.len())
            .min_by(|j, k| apart(j).total_cmp(&apart(k)))
            .map_or(0.0, |k| shared.places[k][side.other()])
    };
    let inner = |rung: &Rung| {
        let vertex = rung.there[way]?;
        Some([rung.along, shared.places[vertex][side.other()]])
    };
    let ends = if way == 0 { [from, to] } else { [to, from] };
    let mut known = vec![[0.0, at(ends[0])]];
    known.extend(rungs.iter().filter_map(inner));
    known.push([1.0, at(ends[1])]);
    // In the walk's order the other side's places ascend.
    if way == 1 {
        known.reverse();
    }
    for k in 1..known.len() {
        if known[k][1] < known[k - 1][1] {
            known[k][1] += 1.0;
        }
    }
    if way == 1 {
        known.reverse();
    }
    known
}

fn interpolated(known: &[[f64; 2]], along: f64) -> f64 {
    let k = known
        .partition_point(|anchor| anchor[0] <= along)
        .clamp(1, known.len() - 1);
    let (from, to) = (known[k - 1], known[k]);
    from[1] + (along - from[0]) / (to[0] - from[0]) * (to[1] - from[1])
}

fn points_of(shared: &mut SharedPolygons, side: Side) -> &mut Vec<DVec2> {
    match side {
        Side::Source => &mut shared.source,
        Side::Target => &mut shared.target,
    }
}

/// Inserts the new vertices in the walk's order.
fn insert(shared: &mut SharedPolygons, side: Side, curve: &Curve, mut added: Vec<Added>) {
    let first = shared.places.first().map_or(0.0, |place| place[side]);
    let ahead = |place: f64| curve.wrapped(place - first);
    added.sort_by(|a, b| ahead(a.places[side]).total_cmp(&ahead(b.places[side])));
    for new in added.into_iter().rev() {
        let at = shared
            .places
            .iter()
            .position(|place| ahead(place[side]) > ahead(new.places[side]))
            .unwrap_or(shared.places.len());
        shared.places.insert(at, new.places);
        shared.source.insert(at, new.points[0]);
        shared.target.insert(at, new.points[1]);
    }
}
