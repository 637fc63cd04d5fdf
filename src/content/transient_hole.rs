//! Holes that one design has alone, in a solid that moves as if it had none.
//!
//! A hole is drawn on the faces that cover it and goes where they go. Where its
//! design is it is as it was drawn, to the last bit; towards the other it
//! shrinks about its middle until it is gone. It does not bend what is around
//! it.

use crate::geometry::{DVec2, Side, signed_area};
use crate::warp::TimeWindow;

/// A hole of one design in the faces of a placement.
#[derive(Clone, Debug, PartialEq)]
pub struct TransientHole {
    /// As it is in the design that has it, clockwise.
    ring: Vec<DVec2>,
    /// For each of its points where it is in the faces.
    hosts: Vec<HostFaces>,
    /// When it changes its size.
    pub(crate) life: TimeWindow,
}

/// A place in a face.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HostFaces {
    face: [u32; 3],
    /// Barycentric: they sum to one.
    weights: [f64; 3],
}

impl HostFaces {
    /// In the face that holds `p`, or comes nearest to it by its weights.
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
            let least = weights.into_iter().fold(f64::INFINITY, f64::min);
            if best.is_none_or(|(most, _)| least > most) {
                best = Some((least, Self { face, weights }));
            }
            if least >= 0.0 {
                break;
            }
        }
        // Faces without area hold nothing.
        best.filter(|(least, _)| least.is_finite())
            .map(|(_, host)| host)
    }

    fn at(&self, places: &[DVec2]) -> DVec2 {
        let Self { face, weights } = self;
        let corners = face.map(|v| places[v as usize]);
        // As a way from the first corner: far from the origin sums of whole
        // places lose their digits.
        let [_, v, w] = *weights;
        corners[0] + v * (corners[1] - corners[0]) + w * (corners[2] - corners[0])
    }
}

impl TransientHole {
    /// As it is in its design.
    pub(crate) fn ring(&self) -> &Vec<DVec2> {
        &self.ring
    }

    /// A hole of the design that its `life` names, drawn on `faces`, whose vertices are at
    /// `places` in that design; `None` if they have no area.
    ///
    /// # Panics
    /// If a face has a vertex without a place.
    #[must_use]
    pub fn new(
        ring: &[DVec2],
        faces: &[[u32; 3]],
        places: &[DVec2],
        life: TimeWindow,
    ) -> Option<Self> {
        let hosts = ring.iter().map(|&p| HostFaces::of(p, faces, places));
        Some(Self {
            hosts: hosts.collect::<Option<_>>()?,
            ring: ring.to_vec(),
            life,
        })
    }

    /// The design that has it.
    #[must_use]
    pub fn side(&self) -> Side {
        self.life.side
    }

    /// The area that it would have were it whole, as a share of what it has in its design,
    /// when the vertices are at `places`.
    pub(crate) fn stretch(&self, places: &[DVec2]) -> f64 {
        let ring: Vec<DVec2> = self.hosts.iter().map(|host| host.at(places)).collect();
        signed_area(&ring) / signed_area(&self.ring)
    }

    /// What it encloses in its design, positive.
    pub(crate) fn area(&self) -> f64 {
        signed_area(&self.ring).abs()
    }

    /// The face that one of its points lies in.
    pub(crate) fn face(&self, point: usize) -> [u32; 3] {
        self.hosts[point].face
    }

    /// Whether there is nothing of it at `t`.
    pub(crate) fn is_gone(&self, t: f64) -> bool {
        self.life.is_gone(t)
    }

    /// Its outline at `t`, when the vertices are at `places`; `None` where it is
    /// gone.
    ///
    /// # Panics
    /// If a face has a vertex without a place.
    #[must_use]
    pub fn at(&self, places: &[DVec2], t: f64) -> Option<Vec<DVec2>> {
        if self.is_gone(t) {
            return None;
        }
        if t == [0.0, 1.0][self.side()] {
            return Some(self.ring.clone());
        }
        let ring = self.hosts.iter().map(|host| host.at(places));
        Some(shrunk(ring.collect(), self.life.size(t)))
    }
}

/// A ring made smaller about the middle of its points.
fn shrunk(mut ring: Vec<DVec2>, size: f64) -> Vec<DVec2> {
    let about = ring[0];
    let sum: DVec2 = ring.iter().map(|&p| p - about).sum();
    let middle = about + sum / ring.len() as f64;
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

    /// A square of two faces and a hole in its middle.
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
        assert_eq!(hole.at(&places, 0.0), Some(square(1.0)));
        assert_eq!(hole.at(&places, 1.0), None);
        let (hole, places) = self::hole(Side::Target);
        assert_eq!(hole.at(&places, 0.0), None);
        assert_eq!(hole.at(&places, 1.0), Some(square(1.0)));
    }

    #[test]
    fn a_hole_goes_with_its_faces_and_shrinks() {
        let (hole, places) = hole(Side::Source);
        let moved: Vec<DVec2> = places
            .iter()
            .map(|p| p.perp() * 3.0 + DVec2::X * 7.0)
            .collect();
        let at = hole.at(&moved, 2.0 / 3.0).expect("half as large");
        for (p, q) in at.iter().zip(square(1.0)) {
            let wanted = q.perp() * 1.5 + DVec2::X * 7.0;
            assert!(p.distance(wanted) < 1e-12, "{p} {wanted}");
        }
    }

    #[test]
    fn faces_without_area_hold_no_hole() {
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
