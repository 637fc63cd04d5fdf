//! Steiner-free triangulations of two polygons that cross as little as
//! possible when both are drawn on one convex polygon.
//!
//! Chords i–j that lie inside a polygon are found exactly; a triangulation of
//! least total cost is found by the classic dynamic program over chords
//! (Gilbert 1979, Klincsek 1980); the two polygons take turns, each
//! minimising its crossings with the other's present choice. A local optimum
//! is all that is promised; a chord valid in both costs nothing, so that two
//! equal polygons end without crossings.

use super::error::PieceMeshError;
use crate::geometry::{DVec2, Side, orient2d, segments_touch};
use crate::mesh::sides;
use crate::mesh::triangulation::{TriangulationError, constrained_delaunay};
use crate::work::progress::{Cancelled, Progress, still_wanted};

/// Up to so many vertices crossings are minimised, in O(n³): 10 million
/// triangles, each chord held against all diagonals, at every turn. Beyond,
/// both polygons take their Delaunay triangulations.
const SEARCHED: usize = 400;
/// Turns of the two polygons; more changed nothing on random polygons.
const TURNS: usize = 4;
/// What a flat triangle costs, in crossings: shape only breaks ties, as long
/// as there are fewer than a thousand triangles, and [`SEARCHED`] is 400.
const SHAPE_COST: f64 = 1e-3;
/// What a triangle costs that is flat but for rounding, as beside a point
/// on a straight side: crossings in it would find no room.
const SLIVER_COST: f64 = 1e6;
/// Flatness counts as rounding where what is missing to 1 is less than this:
/// a height of some 6e-8 of the base, by which points on a side are off it
/// that were once written in single precision.
const SLIVER: f64 = 1e-7;

/// Two triangulations of the vertices 0..n, one for each polygon.
pub(super) fn triangulations(
    source: &[DVec2],
    target: &[DVec2],
    progress: &dyn Progress,
) -> Result<[Vec<[u32; 3]>; 2], PieceMeshError> {
    let refused = |side, error| PieceMeshError::Base { side, error };
    let has_slits = |points| !coincident_corners(points).is_empty();
    if source.len() > SEARCHED || has_slits(source) || has_slits(target) {
        let alone = |side: Side, points| {
            constrained_delaunay(&[points]).map_err(|error| refused(side, error))
        };
        return Ok([alone(Side::Source, source)?, alone(Side::Target, target)?]);
    }
    // The source first takes what is a chord of both, and then they answer
    // each other, the target first.
    let chords = [
        InteriorChords::of(source, progress)?,
        InteriorChords::of(target, progress)?,
    ];
    let points = [source, target];
    let not_shared = |i, j| f64::from(u8::from(!chords[1].inside(i, j)));
    let first = cheapest(points[0], &chords[0], not_shared, progress)?;
    let mut faces = [first, Vec::new()];
    for turn in 1..=TURNS {
        let (mine, other) = (turn % 2, (turn + 1) % 2);
        let diagonals = diagonals(&faces[other], source.len());
        let crossings = |i, j| crossings(&diagonals, i, j) as f64;
        faces[mine] = cheapest(points[mine], &chords[mine], crossings, progress)?;
    }
    // Flat input beyond what the exact predicates see cannot occur: a simple
    // polygon has a triangulation.
    let lacks = |side: &Side| faces[*side].len() + 2 != source.len();
    match Side::BOTH.into_iter().find(lacks) {
        Some(side) => Err(refused(side, TriangulationError::NotSimple)),
        None => Ok(faces),
    }
}

/// The corners that share their place with another one: those of slits.
pub(super) fn coincident_corners(points: &[DVec2]) -> Vec<u32> {
    // Negative zero is zero.
    let at = |v: u32| points[v as usize] + 0.0;
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_by(|&a, &b| {
        let (p, q) = (at(a), at(b));
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
    });
    let pairs = order.windows(2).filter(|pair| at(pair[0]) == at(pair[1]));
    pairs.flatten().copied().collect()
}

/// Which chords lie inside a polygon.
struct InteriorChords {
    n: usize,
    inside: Vec<bool>,
}

impl InteriorChords {
    fn of(points: &[DVec2], progress: &dyn Progress) -> Result<Self, Cancelled> {
        let n = points.len();
        let mut inside = vec![false; n * n];
        for i in 0..n {
            still_wanted(progress)?;
            for j in i + 1..n {
                inside[i * n + j] = j == i + 1 || (i == 0 && j == n - 1) || is_inside(points, i, j);
            }
        }
        Ok(Self { n, inside })
    }

    /// For i < j: whether the open chord is inside, or is an edge.
    fn inside(&self, i: usize, j: usize) -> bool {
        self.inside[i * self.n + j]
    }
}

fn is_inside(points: &[DVec2], i: usize, j: usize) -> bool {
    let n = points.len();
    let free_of = |k: usize| {
        let l = (k + 1) % n;
        [k, l].iter().any(|end| [i, j].contains(end))
            || !segments_touch([points[i], points[j]], [points[k], points[l]])
    };
    in_cone(points, i, j) && in_cone(points, j, i) && (0..n).all(free_of)
}

/// Whether the chord leaves `i` strictly into the polygon.
fn in_cone(points: &[DVec2], i: usize, j: usize) -> bool {
    let n = points.len();
    let (before, after) = (points[(i + n - 1) % n], points[(i + 1) % n]);
    let (a, b) = (points[i], points[j]);
    // At a convex corner left of both edges, at another one not beyond both.
    if orient2d(before, a, after) >= 0.0 {
        orient2d(a, b, before) > 0.0 && orient2d(b, a, after) > 0.0
    } else {
        !(orient2d(a, b, after) >= 0.0 && orient2d(b, a, before) >= 0.0)
    }
}

/// The inner edges of a triangulation, smaller vertex first.
pub(super) fn diagonals(faces: &[[u32; 3]], n: usize) -> Vec<[u32; 2]> {
    let n = n as u32;
    let mut edges: Vec<[u32; 2]> = faces
        .iter()
        .flat_map(|&face| sides(face))
        .filter(|&[a, b]| a < b && b - a != 1 && b - a != n - 1)
        .collect();
    edges.sort_unstable();
    edges
}

fn crossings(diagonals: &[[u32; 2]], i: usize, j: usize) -> usize {
    let (i, j) = (i as u32, j as u32);
    diagonals.iter().filter(|d| interleave([i, j], **d)).count()
}

/// Whether two chords of a convex polygon cross, smaller ends first.
pub(super) fn interleave([a, b]: [u32; 2], [c, d]: [u32; 2]) -> bool {
    (a < c && c < b && b < d) || (c < a && a < d && d < b)
}

/// The triangulation of least total `cost` of its diagonals.
fn cheapest(
    points: &[DVec2],
    chords: &InteriorChords,
    cost: impl Fn(usize, usize) -> f64,
    progress: &dyn Progress,
) -> Result<Vec<[u32; 3]>, Cancelled> {
    let n = points.len();
    // For each chord the least cost of the part from i to j, and its apex.
    let mut best = vec![(f64::INFINITY, 0); n * n];
    for i in 0..n {
        if i + 1 < n {
            best[i * n + i + 1].0 = 0.0;
        }
    }
    for length in 2..n {
        still_wanted(progress)?;
        for i in 0..n - length {
            let j = i + length;
            if chords.inside(i, j) {
                let (apex_cost, apex) = best_apex(points, &best, i, j);
                // The last chord is the polygon's closing edge.
                let own = if length == n - 1 { 0.0 } else { cost(i, j) };
                best[i * n + j] = (apex_cost + own, apex);
            }
        }
    }
    Ok(collect(&best, n))
}

fn best_apex(points: &[DVec2], best: &[(f64, usize)], i: usize, j: usize) -> (f64, usize) {
    let n = points.len();
    let mut least = (f64::INFINITY, 0);
    for k in i + 1..j {
        let parts = best[i * n + k].0 + best[k * n + j].0;
        // Three chords inside need no area: points on a side are in line.
        if parts < least.0 && orient2d(points[i], points[k], points[j]) > 0.0 {
            let flatness = flatness(points[i], points[k], points[j]);
            let sliver = if flatness > 1.0 - SLIVER {
                SLIVER_COST
            } else {
                0.0
            };
            let whole = parts + SHAPE_COST * flatness + sliver;
            if whole < least.0 {
                least = (whole, k);
            }
        }
    }
    least
}

/// 0 for an equilateral triangle, towards 1 for a flat one.
fn flatness(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let squares = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
    1.0 - 2.0 * 3f64.sqrt() * (b - a).perp_dot(c - a).abs() / squares
}

fn collect(best: &[(f64, usize)], n: usize) -> Vec<[u32; 3]> {
    let mut faces = Vec::with_capacity(n - 2);
    let mut open = vec![(0, n - 1)];
    while let Some((i, j)) = open.pop() {
        // What has no triangulation is left open, and counted by the caller.
        if j - i < 2 || best[i * n + j].0 == f64::INFINITY {
            continue;
        }
        let k = best[i * n + j].1;
        faces.push([i, k, j].map(|v| v as u32));
        open.extend([(i, k), (k, j)]);
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::progress::Silent;

    #[test]
    fn equal_polygons_share_their_triangulation() {
        let arrow = [(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (1.0, 1.0)].map(DVec2::from);
        let [mut a, mut b] = triangulations(&arrow, &arrow, &Silent).expect("simple");
        a.sort_unstable();
        b.sort_unstable();
        assert_eq!(a, b);
    }

    #[test]
    fn a_chord_through_a_vertex_is_not_inside() {
        let points = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 1.0), (0.0, 2.0)].map(DVec2::from);
        let chords = InteriorChords::of(&points, &Silent).expect("not cancelled");
        assert!(!chords.inside(0, 2) && chords.inside(0, 3) && chords.inside(1, 3));
    }
}
