//! Lines along outlines as triangles: a quad for each edge, and what fills the
//! corner on its outer side.

use std::f64::consts::PI;

use glam::DVec2;

use crate::colour::{StrokeJoin, StrokeStyle};

/// Corners of a disc that a round join is a part of.
const ROUND: f64 = 48.0;

/// Adds the triangles of a line along closed rings, relative to `origin`.
pub(super) fn push(
    rings: &[Vec<DVec2>],
    line: &StrokeStyle,
    origin: DVec2,
    (positions, indices): (&mut Vec<[f32; 3]>, &mut Vec<u32>),
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
        along(ring, line, &mut fan);
    }
}

/// Convex polygons that cover a line along a ring.
fn along(ring: &[DVec2], line: &StrokeStyle, fan: &mut impl FnMut(&[DVec2])) {
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

/// What is missing at a corner where an edge with one offset to its left meets
/// another.
fn corner(
    at: DVec2,
    left: [DVec2; 2],
    join: StrokeJoin,
    half: f64,
    fan: &mut impl FnMut(&[DVec2]),
) {
    // The outer side is the right one where the ring turns left.
    let turn = left[0].perp_dot(left[1]);
    let [a, b] = if turn > 0.0 { left.map(|p| -p) } else { left };
    let angle = a.angle_to(b).abs();
    if angle < 1e-6 {
        return;
    }
    let sum = a + b;
    // Half the angle between the edges has this cosine between its sides.
    let reach = 2.0 * half * half / sum.length();
    match join {
        StrokeJoin::Mitre(limit) if reach <= limit * half => {
            fan(&[at, at + a, at + sum.normalize_or_zero() * reach, at + b]);
        }
        StrokeJoin::Round => {
            let steps = (ROUND * angle / (2.0 * PI)).ceil().max(1.0);
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

    /// The area of all triangles, those that overlap as often as they do.
    fn area(ring: &[(f64, f64)], join: StrokeJoin) -> f64 {
        let ring = ring.iter().map(|&p| DVec2::from(p)).collect();
        let line = StrokeStyle {
            paint: Rgb([0; 3]).into(),
            width: 2.0,
            join,
        };
        let (mut positions, mut indices) = (Vec::new(), Vec::new());
        push(&[ring], &line, DVec2::ZERO, (&mut positions, &mut indices));
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
    fn corners_are_joined_as_the_line_says() {
        let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
        let back: Vec<_> = square.iter().rev().copied().collect();
        for ring in [&square[..], &back] {
            // Four edges, and a corner each.
            assert!((area(ring, StrokeJoin::Mitre(4.0)) - 84.0).abs() < 1e-4);
            assert!((area(ring, StrokeJoin::Bevel) - 82.0).abs() < 1e-4);
            assert!((area(ring, StrokeJoin::Mitre(1.2)) - 82.0).abs() < 1e-4);
            assert!((area(ring, StrokeJoin::Round) - 80.0 - PI).abs() < 0.02);
        }
    }

    #[test]
    fn whatever_the_ring_is_all_places_are_finite() {
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
