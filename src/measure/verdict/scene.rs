//! Rigid parts at the t of a trouble, as its causes look at them.

use crate::content::Solid;
use crate::geometry::{DVec2, twice_signed_area};
use crate::homotopy::LocalMap;
use crate::measure::crossings::RingEdge;
use crate::measure::distortion::{Strain, edges};
use crate::transition::Transition;
use crate::warp::Arap;

/// A transition of rigid parts at the t of a trouble.
pub(super) struct Scene<'a> {
    pub arap: &'a Arap,
    pub solid: &'a Solid,
    pub places: Vec<DVec2>,
    pub angles: Vec<f64>,
    pub part_of: Vec<u32>,
}

impl<'a> Scene<'a> {
    pub fn new(transition: &Transition, arap: &'a Arap, solid: &'a Solid, t: f64) -> Self {
        Self {
            arap,
            solid,
            places: transition.frame(t).placement().in_frame.clone(),
            angles: arap.face_angles(),
            part_of: arap.mesh().connectivity().dual_components(),
        }
    }

    pub fn centroid(&self, face: usize, points: &[DVec2]) -> DVec2 {
        let corners = self.arap.mesh().faces()[face].map(|v| points[v as usize]);
        corners.iter().sum::<DVec2>() / 3.0
    }

    /// The determinant of a face against the source.
    pub fn det(&self, face: usize) -> f64 {
        let mesh = self.arap.mesh();
        let corners = &mesh.faces()[face];
        Strain::of(edges(&self.places, corners) * edges(mesh.source(), corners).inverse()).det
    }

    pub fn local_map(&self, face: usize) -> LocalMap {
        let mesh = self.arap.mesh();
        let corners = &mesh.faces()[face];
        let whole = edges(mesh.target(), corners) * edges(mesh.source(), corners).inverse();
        LocalMap {
            angle: self.angles[face],
            ..LocalMap::of(whole)
        }
    }

    /// The face at an edge of the boundary.
    pub fn face_at(&self, edge: RingEdge) -> Option<usize> {
        let walk = &self.solid.loops[edge.ring];
        let (a, b) = (walk[edge.point], walk[(edge.point + 1) % walk.len()]);
        let faces = self.arap.mesh().faces();
        faces.iter().position(|f| f.contains(&a) && f.contains(&b))
    }

    /// The area-weighted mean angle of the faces that are chosen.
    pub fn mean_angle(&self, is: impl Fn(usize) -> bool) -> Option<f64> {
        let mesh = self.arap.mesh();
        let (mut sum, mut total) = (0.0, 0.0);
        for (f, face) in mesh.faces().iter().enumerate().filter(|(f, _)| is(*f)) {
            let [a, b, c] = face.map(|v| mesh.source()[v as usize]);
            let area = twice_signed_area(a, b, c);
            (sum, total) = (sum + area * self.angles[f], total + area);
        }
        (total > 0.0).then(|| sum / total)
    }

    /// The parts that share a vertex with one.
    pub fn neighbouring_parts(&self, part: u32) -> Vec<u32> {
        let faces = self.arap.mesh().faces();
        let mut on_part = vec![false; self.arap.mesh().source().len()];
        for (face, _) in faces.iter().zip(&self.part_of).filter(|(_, p)| **p == part) {
            face.iter().for_each(|&v| on_part[v as usize] = true);
        }
        let touches = |face: &[u32; 3]| face.iter().any(|&v| on_part[v as usize]);
        let others = faces.iter().zip(&self.part_of);
        let mut parts: Vec<u32> = others
            .filter(|(face, p)| **p != part && touches(face))
            .map(|(_, p)| *p)
            .collect();
        parts.sort_unstable();
        parts.dedup();
        parts
    }
}
