//! Triangulates two polygons with n vertices each, without extra vertices. The triangulations
//! should cross as little as possible when both are drawn on one convex n-gon.
//!
//! The chords that lie inside a polygon are determined exactly. A triangulation with the least
//! total cost of its chords is found by dynamic programming (Gilbert 1979, Klincsek 1980). The two
//! polygons take turns: each minimises the crossings with the current triangulation of the other.
//! The result is a local optimum. The first triangulation of the source prefers chords that are
//! valid in both polygons, so two equal polygons end without crossings.

use super::error::PieceMeshError;
use crate::geometry::{DVec2, Side, orient2d, segments_touch};
use crate::mesh::sides;
use crate::mesh::triangulation::{TriangulationError, constrained_delaunay};
use crate::work::progress::{Cancelled, Progress, check_cancelled};

/// Maximum number of vertices of a polygon for which the crossings between the two triangulations
/// are minimised (resource limit: each turn is a search in O(n³), over 10 million triangles at this
/// size). Larger polygons use their Delaunay triangulations.
const MAX_SEARCHED: usize = 400;
/// Number of turns (heuristic). In each turn one polygon is triangulated again, so that its chords
/// cross fewer chords of the other polygon's triangulation.
const TURNS: usize = 4;
/// Cost of the shape of a flat triangle, if one crossing of two chords costs 1. All other shapes
/// cost less (derived: there are fewer than [`MAX_SEARCHED`] triangles, so their shape costs add up
/// to less than one crossing. Shape therefore decides only between triangulations with equally many
/// crossings).
const SHAPE_COST: f64 = 1e-3;
/// Additional cost of a triangle that is flat up to rounding, such as one with all corners on a
/// straight side, if one crossing of two chords costs 1 (derived: more than the 158,000 crossings
/// that are possible, so such triangles are used only if there is no other way).
const SLIVER_COST: f64 = 1e6;
/// A triangle counts as flat up to rounding if its [`flatness`] differs from 1 by less than this
/// (tolerance: it corresponds to a height of about 6e-8 of the base, the error of points on a side
/// whose coordinates were written in single precision).
const SLIVER: f64 = 1e-7;

/// Returns a triangulation of each polygon, with the vertices `0..n`.
///
/// # Errors
/// [`PieceMeshError`] if a polygon has no triangulation, or the work is cancelled.
pub(super) fn triangulations(
    source: &[DVec2],
    target: &[DVec2],
    progress: &dyn Progress,
) -> Result<[Vec<[u32; 3]>; 2], PieceMeshError> {
    let base_error = |side, error| PieceMeshError::Base { side, error };
    let has_slits = |points| !coincident_corners(points).is_empty();
    // The search needs distinct corners, but corners on the two banks of a slit coincide.
    if source.len() > MAX_SEARCHED || has_slits(source) || has_slits(target) {
        let delaunay = |side: Side, points| {
            constrained_delaunay(&[points]).map_err(|error| base_error(side, error))
        };
        return Ok([
            delaunay(Side::Source, source)?,
            delaunay(Side::Target, target)?,
        ]);
    }
    // The source starts with a triangulation that prefers chords inside both polygons. Then the
    // polygons take turns, the target first.
    let chords = [
        InteriorChords::of(source, progress)?,
        InteriorChords::of(target, progress)?,
    ];
    let points = [source, target];
    let not_shared = |i, j| f64::from(u8::from(!chords[1].inside(i, j)));
    let first = cheapest_triangulation(points[0], &chords[0], not_shared, progress)?;
    let mut faces = [first, Vec::new()];
    // Odd turns change the target's triangulation, even turns the source's.
    for turn in 1..=TURNS {
        let (mine, other) = (turn % 2, (turn + 1) % 2);
        let diagonals = diagonals(&faces[other], source.len());
        let crossings = |i, j| crossings(&diagonals, i, j) as f64;
        faces[mine] = cheapest_triangulation(points[mine], &chords[mine], crossings, progress)?;
    }
    // A simple polygon always has a triangulation. Too few faces mean that the polygon is not
    // simple.
    let lacks = |side: &Side| faces[*side].len() + 2 != source.len();
    match Side::BOTH.into_iter().find(lacks) {
        Some(side) => Err(base_error(side, TriangulationError::NotSimple)),
        None => Ok(faces),
    }
}

/// Returns the indices of the corners that coincide with another corner, as corners on slits do.
pub(super) fn coincident_corners(points: &[DVec2]) -> Vec<u32> {
    // Adding zero turns -0 into 0, so that equal points compare as equal.
    let at = |v: u32| points[v as usize] + 0.0;
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_by(|&a, &b| {
        let (p, q) = (at(a), at(b));
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
    });
    let pairs = order.windows(2).filter(|pair| at(pair[0]) == at(pair[1]));
    pairs.flatten().copied().collect()
}

/// Table of the chords of a polygon that lie inside it.
struct InteriorChords {
    n: usize,
    /// Whether the chord i–j lies inside or is an edge, at index i · n + j for i < j.
    inside: Vec<bool>,
}

impl InteriorChords {
    /// Tests all chords of a polygon, in O(n³).
    fn of(points: &[DVec2], progress: &dyn Progress) -> Result<Self, Cancelled> {
        let n = points.len();
        let mut inside = vec![false; n * n];
        for i in 0..n {
            check_cancelled(progress)?;
            for j in i + 1..n {
                inside[i * n + j] = j == i + 1 || (i == 0 && j == n - 1) || is_inside(points, i, j);
            }
        }
        Ok(Self { n, inside })
    }

    /// Returns whether the chord `i`–`j`, i < j, lies inside the polygon except for its ends, or is
    /// one of the polygon's edges.
    fn inside(&self, i: usize, j: usize) -> bool {
        self.inside[i * self.n + j]
    }
}

/// Returns whether the chord `i`–`j` lies inside the polygon except for its ends and touches no
/// edge.
fn is_inside(points: &[DVec2], i: usize, j: usize) -> bool {
    let n = points.len();
    let free_of = |k: usize| {
        let l = (k + 1) % n;
        [k, l].iter().any(|end| [i, j].contains(end))
            || !segments_touch([points[i], points[j]], [points[k], points[l]])
    };
    in_cone(points, i, j) && in_cone(points, j, i) && (0..n).all(free_of)
}

/// Returns whether the chord `i`–`j` starts at the corner `i` strictly towards the inside of the
/// polygon.
fn in_cone(points: &[DVec2], i: usize, j: usize) -> bool {
    let n = points.len();
    let (before, after) = (points[(i + n - 1) % n], points[(i + 1) % n]);
    let (a, b) = (points[i], points[j]);
    // At a convex corner the chord must run between both edges. At a reflex corner it must not lie
    // in the exterior angle.
    if orient2d(before, a, after) >= 0.0 {
        orient2d(a, b, before) > 0.0 && orient2d(b, a, after) > 0.0
    } else {
        !(orient2d(a, b, after) >= 0.0 && orient2d(b, a, before) >= 0.0)
    }
}

/// Returns the inner edges of a triangulation with the vertices `0..n`, sorted. Each lists its
/// smaller vertex first.
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

/// Returns the number of diagonals that cross the chord `i`–`j` if all are drawn on one convex
/// polygon.
fn crossings(diagonals: &[[u32; 2]], i: usize, j: usize) -> usize {
    let (i, j) = (i as u32, j as u32);
    diagonals.iter().filter(|d| interleave([i, j], **d)).count()
}

/// Returns whether two chords of a convex polygon cross. Each lists its vertex with the smaller
/// index first.
pub(super) fn interleave([a, b]: [u32; 2], [c, d]: [u32; 2]) -> bool {
    (a < c && c < b && b < d) || (c < a && a < d && d < b)
}

/// Returns the triangulation with the least total `cost` of its diagonals. Triangles that are flat
/// up to rounding are avoided, and shape decides between equally cheap triangulations. If no
/// triangulation exists, the result has fewer than n − 2 faces, where n is the number of points.
fn cheapest_triangulation(
    points: &[DVec2],
    chords: &InteriorChords,
    cost: impl Fn(usize, usize) -> f64,
    progress: &dyn Progress,
) -> Result<Vec<[u32; 3]>, Cancelled> {
    let n = points.len();
    // For each chord i–j: the least cost of the part of the polygon with the corners i to j, and
    // the third corner (apex) of the triangle at the chord.
    let mut best = vec![(f64::INFINITY, 0); n * n];
    for i in 0..n {
        if i + 1 < n {
            best[i * n + i + 1].0 = 0.0;
        }
    }
    // Short chords come before long ones, so that the costs of the two parts of the polygon on both
    // sides of a triangle are already known.
    for length in 2..n {
        check_cancelled(progress)?;
        for i in 0..n - length {
            let j = i + length;
            if chords.inside(i, j) {
                let (apex_cost, apex) = best_apex(points, &best, i, j);
                // The longest chord, from the first to the last vertex, is an edge of the polygon
                // and not a diagonal.
                let own = if length == n - 1 { 0.0 } else { cost(i, j) };
                best[i * n + j] = (apex_cost + own, apex);
            }
        }
    }
    Ok(collect(&best, n))
}

/// Returns the least cost of the part of the polygon with the corners `i` to `j`, and the apex of
/// the triangle at the chord `i`–`j`.
fn best_apex(points: &[DVec2], best: &[(f64, usize)], i: usize, j: usize) -> (f64, usize) {
    let n = points.len();
    let mut cheapest = (f64::INFINITY, 0);
    for k in i + 1..j {
        let parts = best[i * n + k].0 + best[k * n + j].0;
        // All three corners may be points on one straight side. Such a triangle is flat, although
        // each of its sides is an edge or an allowed chord.
        if parts < cheapest.0 && orient2d(points[i], points[k], points[j]) > 0.0 {
            let flatness = flatness(points[i], points[k], points[j]);
            let sliver = if flatness > 1.0 - SLIVER {
                SLIVER_COST
            } else {
                0.0
            };
            let total = parts + SHAPE_COST * flatness + sliver;
            if total < cheapest.0 {
                cheapest = (total, k);
            }
        }
    }
    cheapest
}

/// Flatness of a triangle: 0 for an equilateral triangle, 1 for a flat one.
fn flatness(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let squares = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
    1.0 - 2.0 * 3f64.sqrt() * (b - a).perp_dot(c - a).abs() / squares
}

/// Reads the triangles of the best triangulation from the table of the dynamic program.
fn collect(best: &[(f64, usize)], n: usize) -> Vec<[u32; 3]> {
    let mut faces = Vec::with_capacity(n - 2);
    let mut pending = vec![(0, n - 1)];
    while let Some((i, j)) = pending.pop() {
        // A part of the polygon without a triangulation is skipped. The caller detects this by the
        // number of faces.
        if j - i < 2 || best[i * n + j].0 == f64::INFINITY {
            continue;
        }
        let k = best[i * n + j].1;
        faces.push([i, k, j].map(|v| v as u32));
        pending.extend([(i, k), (k, j)]);
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
