//! The render mesh of boundaries that bring no faces, or have holes in them that
//! come and go: their rings, filled together by the non-zero rule.
//!
//! The rings may cross themselves and each other, so each frame is triangulated
//! anew (`i_triangle`, a sweep over a grid of 64-bit integers; some
//! microseconds a vertex). Unlike the other parts this one allocates while it
//! moves.

use bevy::mesh::Indices;
use bevy::prelude::*;
use glam::DVec2;
use i_triangle::float::triangulatable::Triangulatable;

use crate::content::Content;
use crate::transition::Frame;

/// Farther from the origin nothing is filled: the GPU has 32-bit numbers, which
/// end at 3e38, and the grid of integers panics from 2^500 on.
const FARTHEST: f64 = 1e30;

/// Vertices and faces of a mesh.
type RingFill = (Vec<[f32; 3]>, Vec<u32>);

/// Vertices and faces of a mesh that shows nothing: an empty one would not be
/// taken by the GPU.
pub(super) fn nothing() -> RingFill {
    (vec![[0.0; 3]; 3], vec![0, 1, 2])
}

/// Fills the rings of a solid, relative to `origin`.
pub(super) fn write(frame: &Frame, origin: DVec2, mesh: &mut Mesh) {
    let Content::Solid(solid) = frame.transition().content() else {
        return;
    };
    let rings = solid.rings_at(&frame.placement().in_frame, frame.t());
    let (positions, indices) = filled(&rings, origin);
    // Other frames have other triangles: there is nothing to be written in
    // place.
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    mesh.insert_indices(Indices::U32(indices));
}

/// The triangles of rings; nothing where there is no area, or a point is [`FARTHEST`] or not finite, as
/// far outside [0, 1].
pub(super) fn filled(rings: &[Vec<DVec2>], origin: DVec2) -> RingFill {
    let of = |ring: &Vec<DVec2>| -> Vec<[f64; 2]> {
        ring.iter().map(|&p| (p - origin).to_array()).collect()
    };
    let contours: Vec<Vec<[f64; 2]>> = rings.iter().map(of).collect();
    // Asked this way round NaN is not near either.
    let mut numbers = contours.iter().flatten().flatten();
    if !numbers.all(|x| x.abs() < FARTHEST) {
        return nothing();
    }
    let found = contours.triangulate_as::<i64>().to_triangulation::<u32>();
    if found.indices.is_empty() {
        return nothing();
    }
    let vertex = |[x, y]: [f64; 2]| [x as f32, y as f32, 0.0];
    (
        found.points.into_iter().map(vertex).collect(),
        found.indices,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(rings: &[Vec<DVec2>]) -> f32 {
        let (positions, indices) = filled(rings, DVec2::splat(1e6));
        let at = |v: u32| Vec3::from(positions[v as usize]).truncate();
        let faces = indices.as_chunks::<3>().0.iter();
        let twice = faces.map(|&[a, b, c]| (at(b) - at(a)).perp_dot(at(c) - at(a)));
        0.5 * twice.sum::<f32>()
    }

    fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
        let far = |&p: &(f64, f64)| DVec2::from(p) + DVec2::splat(1e6);
        points.iter().map(far).collect()
    }

    #[test]
    fn rings_that_cross_are_filled_by_the_non_zero_rule() {
        let square = |at: f64, side: f64| {
            ring(&[
                (at, at),
                (at + side, at),
                (at + side, at + side),
                (at, at + side),
            ])
        };
        let hole: Vec<DVec2> = square(1.0, 1.0).into_iter().rev().collect();
        let bow = ring(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        for (rings, wanted) in [
            (vec![square(0.0, 4.0), hole], 15.0),
            (vec![square(0.0, 2.0), square(1.0, 2.0)], 7.0),
            (vec![bow], 0.5),
            (vec![square(3.0, 0.0)], 0.0),
            (vec![], 0.0),
            (vec![vec![DVec2::NAN, DVec2::ONE, DVec2::X]], 0.0),
            (vec![vec![DVec2::MAX, DVec2::ONE, DVec2::X]], 0.0),
        ] {
            let found = area(&rings);
            assert!((found - wanted).abs() < 1e-4, "{found} is not {wanted}");
        }
    }
}
