//! Transient holes: holes that exist in only one design.
//!
//! The mesh covers such a hole with faces, and the warp ignores it. The hole is drawn on the faces
//! that cover it and moves with them. In the design that has the hole, the ring is that of the
//! design bit for bit. Towards the other design it shrinks about the mean of its points until it
//! disappears.

use crate::geometry::{DVec2, Side, signed_area};
use crate::warp::TimeWindow;

/// Hole of one design, attached to the faces of a placement.
#[derive(Clone, Debug, PartialEq)]
pub struct TransientHole {
    /// Ring of the hole in the design that has it, clockwise.
    ring: Vec<DVec2>,
    /// For each point of the ring, its position on the faces.
    hosts: Vec<HostFaces>,
    /// Time window in which the hole's size changes.
    pub(crate) window: TimeWindow,
}

/// Point on a face, given by barycentric coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HostFaces {
    /// Vertex indices of the face's corners.
    face: [u32; 3],
    /// Barycentric coordinates of the point, which sum to 1.
    weights: [f64; 3],
}

impl HostFaces {
    /// Attaches the point `p` to the first face that contains it. If no face contains it, it is
    /// attached to the face for which the smallest barycentric coordinate of `p` is largest. Faces
    /// without area are skipped; `None` if no face is left.
    fn of(p: DVec2, faces: &[[u32; 3]], places: &[DVec2]) -> Option<Self> {
        let mut best: Option<(f64, Self)> = None;
        for &face in faces {
            let [a, b, c] = face.map(|v| places[v as usize]);
            let area = (b - a).perp_dot(c - a);
            let weights = [
                (b - p).perp_dot(c - p) / area,
                (c - p).perp_dot(a - p) / area,
                (a - p).perp_dot(b - p) / area,
            ];
            // A face without area gives coordinates that are NaN or infinite. Neither may be
            // compared: the minimum ignores NaN.
            if !weights.iter().all(|weight| weight.is_finite()) {
                continue;
            }
            let min_weight = weights.into_iter().fold(f64::INFINITY, f64::min);
            if best.is_none_or(|(max_of_min, _)| min_weight > max_of_min) {
                best = Some((min_weight, Self { face, weights }));
            }
            if min_weight >= 0.0 {
                break;
            }
        }
        best.map(|(_, host)| host)
    }

    /// Position of the point when the vertices are at `places`.
    fn at(&self, places: &[DVec2]) -> DVec2 {
        let Self { face, weights } = self;
        let corners = face.map(|v| places[v as usize]);
        // The sum is relative to the first corner. Far from the origin, a sum of absolute positions
        // would lose digits.
        let [_, v, w] = *weights;
        corners[0] + v * (corners[1] - corners[0]) + w * (corners[2] - corners[0])
    }
}

impl TransientHole {
    /// Ring of the hole in the design that has it.
    pub(crate) fn design_ring(&self) -> &Vec<DVec2> {
        &self.ring
    }

    /// Creates a hole of the design `window.side`, drawn on `faces`. `ring` contains the hole's
    /// points in that design, `places` the vertex positions in that design. Returns `None` if no
    /// face has area.
    ///
    /// # Panics
    /// Panics if a face has a vertex without a position.
    #[must_use]
    pub fn new(
        ring: &[DVec2],
        faces: &[[u32; 3]],
        places: &[DVec2],
        window: TimeWindow,
    ) -> Option<Self> {
        let hosts = ring.iter().map(|&p| HostFaces::of(p, faces, places));
        Some(Self {
            hosts: hosts.collect::<Option<_>>()?,
            ring: ring.to_vec(),
            window,
        })
    }

    /// The design that has the hole.
    #[must_use]
    pub fn side(&self) -> Side {
        self.window.side
    }

    /// Returns the area that the hole covers on its faces at full size when the vertices are at
    /// `places`, as a multiple of the hole's area in its design.
    pub(crate) fn area_ratio(&self, places: &[DVec2]) -> f64 {
        let ring: Vec<DVec2> = self.hosts.iter().map(|host| host.at(places)).collect();
        signed_area(&ring) / signed_area(&self.ring)
    }

    /// Area of the hole in its design, positive.
    pub(crate) fn area(&self) -> f64 {
        signed_area(&self.ring).abs()
    }

    /// Returns the vertex indices of the face on which a point of the ring lies. `point` is the
    /// index of the point in the ring.
    pub(crate) fn host_face(&self, point: usize) -> [u32; 3] {
        self.hosts[point].face
    }

    /// Returns whether the hole is absent when the clock of its part shows the time `t`.
    pub(crate) fn is_absent(&self, t: f64) -> bool {
        self.window.is_absent(t)
    }

    /// Returns the ring of the hole when the clock of its part shows the time `t`, clockwise;
    /// `None` while the hole is absent. `places` contains the vertex positions at that moment.
    ///
    /// # Panics
    /// Panics if a face has a vertex without a position.
    #[must_use]
    pub fn ring_at(&self, places: &[DVec2], t: f64) -> Option<Vec<DVec2>> {
        if self.is_absent(t) {
            return None;
        }
        if t == [0.0, 1.0][self.side()] {
            return Some(self.ring.clone());
        }
        let ring = self.hosts.iter().map(|host| host.at(places));
        Some(scale_about_mean(ring.collect(), self.window.size(t)))
    }
}

/// Scales a ring by the factor `size` about the mean of its points.
fn scale_about_mean(mut ring: Vec<DVec2>, size: f64) -> Vec<DVec2> {
    let reference = ring[0];
    let sum: DVec2 = ring.iter().map(|&p| p - reference).sum();
    let middle = reference + sum / ring.len() as f64;
    ring.iter_mut()
        .for_each(|p| *p = middle + (*p - middle) * size);
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(r: f64) -> Vec<DVec2> {
        [(-r, -r), (-r, r), (r, r), (r, -r)]
            .map(DVec2::from)
            .to_vec()
    }

    /// A square hole in the middle of a square of two faces, and the vertex positions.
    fn hole(side: Side) -> (TransientHole, Vec<DVec2>) {
        let mut places = square(2.0);
        places.reverse();
        let faces = [[0, 1, 2], [0, 2, 3]];
        let hole = TransientHole::new(&square(1.0), &faces, &places, TimeWindow::whole(side));
        (hole.expect("faces with an area"), places)
    }

    #[test]
    fn a_hole_is_as_drawn_in_its_design_and_gone_in_the_other() {
        let (hole, places) = hole(Side::Source);
        assert_eq!(hole.ring_at(&places, 0.0), Some(square(1.0)));
        assert_eq!(hole.ring_at(&places, 1.0), None);
        let (hole, places) = self::hole(Side::Target);
        assert_eq!(hole.ring_at(&places, 0.0), None);
        assert_eq!(hole.ring_at(&places, 1.0), Some(square(1.0)));
    }

    #[test]
    fn a_hole_moves_with_its_faces_and_shrinks() {
        let (hole, places) = hole(Side::Source);
        let moved: Vec<DVec2> = places
            .iter()
            .map(|p| p.perp() * 3.0 + DVec2::X * 7.0)
            .collect();
        let at = hole.ring_at(&moved, 2.0 / 3.0).expect("half as large");
        for (p, q) in at.iter().zip(square(1.0)) {
            let expected = q.perp() * 1.5 + DVec2::X * 7.0;
            assert!(p.distance(expected) < 1e-12, "{p} {expected}");
        }
    }

    #[test]
    fn a_face_without_area_does_not_hide_later_faces() {
        let mut places = square(2.0);
        places.reverse();
        let faces = [[0, 1, 2], [0, 2, 3]];
        let hole = |faces: &[[u32; 3]]| {
            TransientHole::new(
                &square(1.0),
                faces,
                &places,
                TimeWindow::whole(Side::Source),
            )
        };
        // Lines that go through the hole, past it, and a point.
        for flat in [[0, 2, 0], [0, 1, 1], [3, 3, 3]] {
            let with_flat = [[flat].as_slice(), &faces].concat();
            assert_eq!(hole(&with_flat), hole(&faces), "{flat:?}");
        }
    }

    #[test]
    fn faces_without_area_give_no_hole() {
        let places = vec![DVec2::ZERO; 3];
        let none = TransientHole::new(
            &square(1.0),
            &[[0, 1, 2]],
            &places,
            TimeWindow::whole(Side::Source),
        );
        assert_eq!(none, None);
    }
}
