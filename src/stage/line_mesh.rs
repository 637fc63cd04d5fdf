//! Triangulates strokes along outlines: a quad along each edge, and a polygon that fills the outer
//! side of each corner.

use std::f64::consts::PI;

use glam::DVec2;

use crate::colour::{StrokeJoin, StrokeStyle};

/// Number of straight segments that approximate a full circle; a round join is an arc of this
/// circle (tolerance: the segments deviate from the circle by 0.2 % of the radius).
const CIRCLE_SEGMENTS: f64 = 48.0;

/// Appends the triangles of a stroke along boundary loops to a mesh. Positions are relative to
/// `origin`; overlapping triangles are not merged.
pub(super) fn push_stroke(
    rings: &[Vec<DVec2>],
    line: &StrokeStyle,
    origin: DVec2,
    positions: &mut Vec<[f32; 3]>,
    indices: &mut Vec<u32>,
) {
    let mut fan = |corners: &[DVec2]| {
        let first = positions.len() as u32;
        let vertex = |p: &DVec2| {
            let p = (*p - origin).as_vec2();
            [p.x, p.y, 0.0]
        };
        positions.extend(corners.iter().map(vertex));
        for k in 2..corners.len() as u32 {
            indices.extend([first, first + k - 1, first + k]);
        }
    };
    for ring in rings {
        push_ring(ring, line, &mut fan);
    }
}

/// Covers the stroke along one boundary loop by convex polygons and calls `fan` with each of them.
/// Loops with points that are not finite are skipped.
fn push_ring(ring: &[DVec2], line: &StrokeStyle, fan: &mut impl FnMut(&[DVec2])) {
    let mut points = ring.to_vec();
    points.dedup();
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let n = points.len();
    if n < 2 || !points.iter().all(|p| p.is_finite()) {
        return;
    }
    let half = 0.5 * line.width;
    let across = |k: usize| {
        (points[(k + 1) % n] - points[k % n])
            .normalize_or_zero()
            .perp()
            * half
    };
    for k in 0..n {
        let (a, b, side) = (points[k], points[(k + 1) % n], across(k));
        fan(&[a - side, b - side, b + side, a + side]);
        corner(b, [side, across(k + 1)], line.join, half, fan);
    }
}

/// Covers the outer side of a corner by a polygon. `at` is the corner; `left` holds, for each of
/// its two edges, the vector from the edge to the left border of the stroke.
fn corner(
    at: DVec2,
    left: [DVec2; 2],
    join: StrokeJoin,
    half: f64,
    fan: &mut impl FnMut(&[DVec2]),
) {
    // The outer side is on the right if the loop turns left at this corner.
    let turn = left[0].perp_dot(left[1]);
    let [a, b] = if turn > 0.0 { left.map(|p| -p) } else { left };
    let angle = a.angle_to(b).abs();
    if angle < 1e-6 {
        return;
    }
    let sum = a + b;
    // `reach` is the distance of the mitre point from the corner.
    let reach = 2.0 * half * half / sum.length();
    match join {
        StrokeJoin::Mitre(limit) if reach <= limit * half => {
            fan(&[at, at + a, at + sum.normalize_or_zero() * reach, at + b]);
        }
        StrokeJoin::Round => {
            let steps = (CIRCLE_SEGMENTS * angle / (2.0 * PI)).ceil().max(1.0);
            let sense = a.angle_to(b);
            let arc = (0..=steps as u32).map(|k| {
                let turned = DVec2::from_angle(sense * f64::from(k) / steps);
                at + turned.rotate(a)
            });
            fan(&std::iter::once(at).chain(arc).collect::<Vec<_>>());
        }
        StrokeJoin::Mitre(_) | StrokeJoin::Bevel => fan(&[at, at + a, at + b]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::Rgb;

    /// Sum of the areas of all triangles of a stroke; overlaps count several times.
    fn area(ring: &[(f64, f64)], join: StrokeJoin) -> f64 {
        let ring = ring.iter().map(|&p| DVec2::from(p)).collect();
        let line = StrokeStyle {
            paint: Rgb([0; 3]).into(),
            width: 2.0,
            join,
            is_below_fill: false,
        };
        let (mut positions, mut indices) = (Vec::new(), Vec::new());
        push_stroke(&[ring], &line, DVec2::ZERO, &mut positions, &mut indices);
        let at = |v: u32| {
            DVec2::new(
                positions[v as usize][0].into(),
                positions[v as usize][1].into(),
            )
        };
        let faces = indices.as_chunks::<3>().0.iter();
        let area = |&[a, b, c]: &[u32; 3]| (at(b) - at(a)).perp_dot(at(c) - at(a)).abs();
        0.5 * faces.map(area).sum::<f64>()
    }

    #[test]
    fn corners_have_the_shape_of_their_join() {
        let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
        let reversed: Vec<_> = square.iter().rev().copied().collect();
        for ring in [&square[..], &reversed] {
            // The quads of the four edges have the area 80; the rest is the area of the corners.
            assert!((area(ring, StrokeJoin::Mitre(4.0)) - 84.0).abs() < 1e-4);
            assert!((area(ring, StrokeJoin::Bevel) - 82.0).abs() < 1e-4);
            assert!((area(ring, StrokeJoin::Mitre(1.2)) - 82.0).abs() < 1e-4);
            assert!((area(ring, StrokeJoin::Round) - 80.0 - PI).abs() < 0.02);
        }
    }

    #[test]
    fn degenerate_rings_give_finite_positions() {
        for ring in [
            vec![],
            vec![(1.0, 1.0); 3],
            vec![(0.0, 0.0), (1.0, 0.0)],
            vec![(0.0, 0.0), (5.0, 0.0), (2.0, 0.0)],
            vec![(f64::NAN, 0.0), (5.0, 0.0), (2.0, 0.0)],
        ] {
            for join in [StrokeJoin::Mitre(4.0), StrokeJoin::Round, StrokeJoin::Bevel] {
                assert!(area(&ring, join).is_finite(), "{ring:?}");
            }
        }
    }
}
