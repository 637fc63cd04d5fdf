//! A mesh in two embeddings that can be edited and stays valid.
//!
//! Guaranteed: an edit is made only if every face it makes is positive in
//! both designs, exactly; the polygon's vertices, the first ones, never move
//! and its edges are never cut. A mesh that starts invalid stays as it is
//! there.

use super::face_cost;
use super::face_cost::FaceCorners;
use crate::compatible::{CompatibleError, CompatibleMesh};
use crate::geometry::{Bounds, DVec2};
use crate::mesh::sides;

/// A face that was removed.
const GONE: [u32; 3] = [u32::MAX; 3];

#[derive(Clone, Debug)]
pub(super) struct PairMesh {
    /// How many vertices, the first ones, are the polygon's.
    pub(super) fixed: usize,
    /// The vertices in source and target.
    pub(super) points: [Vec<DVec2>; 2],
    faces: Vec<[u32; 3]>,
    /// For each vertex its faces.
    around: Vec<Vec<u32>>,
}

/// Two faces beside an inner edge a → b: left (a, b, left), right (b, a, right).
struct EdgeFaces {
    faces: [u32; 2],
    left: u32,
    right: u32,
}

impl PairMesh {
    pub(super) fn new(fixed: usize, points: [Vec<DVec2>; 2], faces: Vec<[u32; 3]>) -> Self {
        let mut around = vec![Vec::new(); points[0].len()];
        for (f, face) in faces.iter().enumerate() {
            for &v in face {
                around[v as usize].push(f as u32);
            }
        }
        Self {
            fixed,
            points,
            faces,
            around,
        }
    }

    /// The faces that are there.
    pub(super) fn faces(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.faces.iter().copied().filter(|face| *face != GONE)
    }

    pub(super) fn corners(&self, face: [u32; 3]) -> [FaceCorners; 2] {
        [0, 1].map(|d| face.map(|v| self.points[d][v as usize]))
    }

    fn is_valid_face(&self, face: [u32; 3]) -> bool {
        self.corners(face).into_iter().all(face_cost::is_positive)
    }

    /// Whether every face is positive in both designs, exactly.
    pub(super) fn is_valid(&self) -> bool {
        self.faces().all(|face| self.is_valid_face(face))
    }

    /// How many faces are not positive in both.
    pub(super) fn folds(&self) -> usize {
        let folded = |face: &[u32; 3]| !self.is_valid_face(*face);
        self.faces().filter(folded).count()
    }

    /// What a face costs; infinite if it is not positive in both.
    pub(super) fn cost(&self, face: [u32; 3]) -> f64 {
        let [p, q] = self.corners(face);
        if face_cost::is_positive(p) && face_cost::is_positive(q) {
            face_cost::value(p, q)
        } else {
            f64::INFINITY
        }
    }

    /// Puts the vertices there, unless a face is then not positive; whether it
    /// was done. Costs know areas in plain floating point: a face that is flat
    /// but for rounding may be positive to them.
    pub(super) fn move_to(&mut self, points: [Vec<DVec2>; 2]) -> bool {
        let before = std::mem::replace(&mut self.points, points);
        let is_valid = self.is_valid();
        if !is_valid {
            self.points = before;
        }
        is_valid
    }

    /// The movable vertices that are there, in ascending order.
    pub(super) fn steiner(&self) -> Vec<u32> {
        (self.fixed as u32..self.around.len() as u32)
            .filter(|&v| !self.around[v as usize].is_empty())
            .collect()
    }

    /// The faces at a vertex.
    pub(super) fn faces_at(&self, v: u32) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.around[v as usize]
            .iter()
            .map(|&f| self.faces[f as usize])
    }

    /// The vertices joined to `v` by an edge, in ascending order.
    pub(super) fn neighbours(&self, v: u32) -> Vec<u32> {
        let mut found: Vec<u32> = self.faces_at(v).flatten().filter(|&u| u != v).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// All edges with a face on either side, smaller vertex first.
    pub(super) fn inner_edges(&self) -> Vec<[u32; 2]> {
        let mut edges: Vec<[u32; 2]> = self
            .faces()
            .flat_map(sides)
            // Once each, from the face that runs it upwards.
            .filter(|&[a, b]| a < b && self.opposite(b, a).is_some())
            .collect();
        edges.sort_unstable();
        edges
    }

    /// Whether an edge has a face on either side.
    pub(super) fn is_inner(&self, [a, b]: [u32; 2]) -> bool {
        self.opposite(a, b).is_some() && self.opposite(b, a).is_some()
    }

    /// The face that runs a → b, and its third vertex.
    fn opposite(&self, a: u32, b: u32) -> Option<(u32, u32)> {
        self.around[a as usize].iter().find_map(|&f| {
            let face = self.faces[f as usize];
            let k = (0..3).find(|&k| face[k] == a && face[(k + 1) % 3] == b)?;
            Some((f, face[(k + 2) % 3]))
        })
    }

    fn beside(&self, [a, b]: [u32; 2]) -> Option<EdgeFaces> {
        let (f, left) = self.opposite(a, b)?;
        let (g, right) = self.opposite(b, a)?;
        Some(EdgeFaces {
            faces: [f, g],
            left,
            right,
        })
    }

    fn worst(&self, faces: &[[u32; 3]]) -> f64 {
        faces
            .iter()
            .map(|&face| self.cost(face))
            .fold(0.0, f64::max)
    }

    /// Turns an inner edge if the worse of its two faces gets better.
    pub(super) fn flip_if_better(&mut self, edge: [u32; 2]) -> bool {
        let [a, b] = edge;
        let Some(at) = self.beside(edge) else {
            return false;
        };
        // The turned edge may be there already, beyond a vertex of three faces.
        if self.opposite(at.left, at.right).is_some() || self.opposite(at.right, at.left).is_some()
        {
            return false;
        }
        let new = [[a, at.right, at.left], [at.right, b, at.left]];
        let old = at.faces.map(|f| self.faces[f as usize]);
        // By more than rounding: else an edge could turn to and fro.
        let better = self.worst(&new) < self.worst(&old) * (1.0 - 1e-9);
        if better {
            self.replace(at.faces.to_vec(), &new);
        }
        better
    }

    /// Puts a vertex into the middle of an inner edge, in both designs.
    pub(super) fn split(&mut self, edge: [u32; 2]) -> Option<u32> {
        let [a, b] = edge;
        let at = self.beside(edge)?;
        let middle = self.around.len() as u32;
        for points in &mut self.points {
            points.push(points[a as usize].midpoint(points[b as usize]));
        }
        self.around.push(Vec::new());
        let new = [
            [a, middle, at.left],
            [middle, b, at.left],
            [b, middle, at.right],
            [middle, a, at.right],
        ];
        // What was folded already may stay so; nothing else may fold.
        let was_valid = at
            .faces
            .iter()
            .all(|&f| self.is_valid_face(self.faces[f as usize]));
        if was_valid && !new.iter().all(|&face| self.is_valid_face(face)) {
            self.points
                .iter_mut()
                .for_each(|points| points.truncate(middle as usize));
            self.around.truncate(middle as usize);
            return None;
        }
        self.replace(at.faces.to_vec(), &new);
        Some(middle)
    }

    /// The worst cost there would be around `v` moved onto its neighbour
    /// `onto`; infinite if that is not allowed.
    pub(super) fn collapse_cost(&self, v: u32, onto: u32) -> f64 {
        let shared = self.neighbours(onto);
        let common = self
            .neighbours(v)
            .iter()
            .filter(|u| shared.contains(u))
            .count();
        // Else the collapse would pinch the mesh or close a hole (Dey,
        // Edelsbrunner, Guha, Nekhayev 1999, the link condition).
        if common != 2 {
            return f64::INFINITY;
        }
        self.collapsed(v, onto)
            .map(|face| self.cost(face))
            .fold(0.0, f64::max)
    }

    fn collapsed(&self, v: u32, onto: u32) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.faces_at(v)
            .filter(move |face| !face.contains(&onto))
            .map(move |face| face.map(|u| if u == v { onto } else { u }))
    }

    /// Moves `v` onto its neighbour; the caller has asked what it costs.
    pub(super) fn collapse(&mut self, v: u32, onto: u32) {
        let new: Vec<[u32; 3]> = self.collapsed(v, onto).collect();
        self.replace(self.around[v as usize].clone(), &new);
    }

    fn replace(&mut self, old: Vec<u32>, new: &[[u32; 3]]) {
        for &f in &old {
            for v in std::mem::replace(&mut self.faces[f as usize], GONE) {
                self.around[v as usize].retain(|&g| g != f);
            }
        }
        // Numbers are used again, so that they stay small; a split needs two more.
        let mut free = old.into_iter();
        for &face in new {
            let f = free.next().unwrap_or(self.faces.len() as u32);
            if f as usize == self.faces.len() {
                self.faces.push(face);
            } else {
                self.faces[f as usize] = face;
            }
            for v in face {
                self.around[v as usize].push(f);
            }
        }
    }

    /// The designs exchanged.
    pub(super) fn swapped(mut self) -> Self {
        self.points.swap(0, 1);
        self
    }

    /// Faces and vertices without gaps.
    pub(super) fn compacted(&self) -> (Vec<[u32; 3]>, [Vec<DVec2>; 2]) {
        let kept: Vec<u32> = (0..self.fixed as u32).chain(self.steiner()).collect();
        let mut new_number = vec![u32::MAX; self.around.len()];
        for (new, &old) in kept.iter().enumerate() {
            new_number[old as usize] = new as u32;
        }
        let faces = self
            .faces()
            .map(|face| face.map(|v| new_number[v as usize]));
        let points = [0, 1].map(|d| kept.iter().map(|&v| self.points[d][v as usize]).collect());
        (faces.collect(), points)
    }

    /// The mesh in the coordinates that were given, of which its own are so
    /// many times as large: the first vertices are met to the last bit.
    pub(super) fn finished(
        &self,
        scales: [f64; 2],
        given: [&[DVec2]; 2],
    ) -> Result<CompatibleMesh, CompatibleError> {
        let (faces, mut points) = self.compacted();
        for (d, given) in given.into_iter().enumerate() {
            points[d].iter_mut().for_each(|p| *p /= scales[d]);
            points[d][..given.len()].copy_from_slice(given);
        }
        let [source, target] = points;
        CompatibleMesh::new(faces, source, target, Vec::new())
    }
}

/// A power of two, so that scaling is exact, that brings the diameter near 1.
pub(super) fn unit_scale(points: &[DVec2]) -> f64 {
    let size = Bounds::diameter_of(points);
    if size.is_normal() {
        (-size.log2().round()).exp2()
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> PairMesh {
        let points = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)].map(DVec2::from);
        PairMesh::new(
            4,
            [points.to_vec(), points.to_vec()],
            vec![[0, 1, 2], [0, 2, 3]],
        )
    }

    #[test]
    fn split_then_collapse_is_where_it_began() {
        let mut mesh = square();
        let middle = mesh.split([0, 2]).expect("inner edge");
        assert_eq!((mesh.faces().count(), middle), (4, 4));
        assert!(mesh.is_valid());
        assert!(mesh.collapse_cost(middle, 0).is_finite());
        mesh.collapse(middle, 0);
        let (faces, points) = mesh.compacted();
        assert_eq!((faces.len(), points[0].len()), (2, 4));
        assert!(mesh.is_valid());
    }

    #[test]
    fn polygon_edges_are_never_cut_or_turned() {
        let mut mesh = square();
        assert_eq!(mesh.split([0, 1]), None);
        assert!(!mesh.flip_if_better([1, 2]));
        assert_eq!(mesh.inner_edges(), vec![[0, 2]]);
    }
}
