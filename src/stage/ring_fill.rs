//! Triangulates boundary loops filled by the non-zero rule, for transitions without faces or with
//! transient parts and holes.
//!
//! The loops may cross themselves and each other, so they are triangulated anew in each frame (by
//! the crate `i_triangle`, a sweep over a grid of 64-bit integers; a few microseconds per vertex).
//! Unlike other render parts, filled loops allocate memory in each frame.

use bevy::mesh::Indices;
use bevy::prelude::*;
use glam::DVec2;
use i_triangle::float::triangulatable::Triangulatable;

use crate::content::Content;
use crate::transition::Frame;

/// Maximum absolute coordinate, relative to the origin, of boundary loops that are filled (resource
/// limit: 32-bit floats end at 3e38, and `i_triangle` panics from 2^500 on).
const MAX_COORDINATE: f64 = 1e30;

/// Vertex positions of a triangle mesh, and the indices of its faces' corners.
type RingFill = (Vec<[f32; 3]>, Vec<u32>);

/// A triangle without area, which shows nothing. It replaces an empty mesh, which the graphics card
/// does not accept.
pub(super) fn degenerate_triangle() -> RingFill {
    (vec![[0.0; 3]; 3], vec![0, 1, 2])
}

/// Writes the triangulated boundary loops of a frame's solid content into `mesh`; positions are
/// relative to `origin`.
pub(super) fn write(frame: &Frame, origin: DVec2, mesh: &mut Mesh) {
    let Content::Solid(solid) = frame.transition().content() else {
        return;
    };
    let rings = solid.rings_at(&frame.placement().in_frame, frame.t());
    let (positions, indices) = triangulate(&rings, origin);
    // All vertices are replaced, because their number changes from frame to frame.
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    mesh.insert_indices(Indices::U32(indices));
}

/// Triangulates the area that boundary loops enclose; positions are relative to `origin`. The
/// result shows nothing if the loops have no area, or if a coordinate is not finite or exceeds
/// [`MAX_COORDINATE`]. Such coordinates can occur for t far outside [0, 1].
pub(super) fn triangulate(rings: &[Vec<DVec2>], origin: DVec2) -> RingFill {
    let to_contour = |ring: &Vec<DVec2>| -> Vec<[f64; 2]> {
        ring.iter().map(|&p| (p - origin).to_array()).collect()
    };
    let contours: Vec<Vec<[f64; 2]>> = rings.iter().map(to_contour).collect();
    // The comparison is false for NaN, so NaN is rejected too.
    let mut coordinates = contours.iter().flatten().flatten();
    if !coordinates.all(|x| x.abs() < MAX_COORDINATE) {
        return degenerate_triangle();
    }
    let triangulation = contours.triangulate_as::<i64>().to_triangulation::<u32>();
    if triangulation.indices.is_empty() {
        return degenerate_triangle();
    }
    let vertex = |[x, y]: [f64; 2]| [x as f32, y as f32, 0.0];
    (
        triangulation.points.into_iter().map(vertex).collect(),
        triangulation.indices,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(rings: &[Vec<DVec2>]) -> f32 {
        let (positions, indices) = triangulate(rings, DVec2::splat(1e6));
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
        for (rings, expected_area) in [
            (vec![square(0.0, 4.0), hole], 15.0),
            (vec![square(0.0, 2.0), square(1.0, 2.0)], 7.0),
            (vec![bow], 0.5),
            (vec![square(3.0, 0.0)], 0.0),
            (vec![], 0.0),
            (vec![vec![DVec2::NAN, DVec2::ONE, DVec2::X]], 0.0),
            (vec![vec![DVec2::MAX, DVec2::ONE, DVec2::X]], 0.0),
        ] {
            let filled_area = area(&rings);
            assert!(
                (filled_area - expected_area).abs() < 1e-4,
                "{filled_area} is not {expected_area}"
            );
        }
    }
}
