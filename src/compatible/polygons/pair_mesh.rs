//! Mesh with two embeddings that is edited by flips, splits and collapses and stays valid.
//!
//! Guaranteed: an edit of valid faces is made only if every face that it creates is positive in
//! both designs, by exact predicates; polygon vertices (the first ones) never move; polygon edges
//! are never split or flipped. Faces that are invalid from the start may stay invalid.

use super::face_cost;
use super::face_cost::FaceCorners;
use crate::compatible::{CompatibleError, CompatibleMesh};
use crate::geometry::{Bounds, DVec2};
use crate::mesh::sides;

/// Marks the slot of a removed face.
const REMOVED: [u32; 3] = [u32::MAX; 3];

/// Mesh with two embeddings that knows the faces at each vertex, for local edits.
#[derive(Clone, Debug)]
pub(super) struct PairMesh {
    /// Number of polygon (boundary) vertices; they come first and never move.
    pub(super) fixed: usize,
    /// Vertex positions in source and target.
    pub(super) points: [Vec<DVec2>; 2],
    /// Faces as triples of vertex indices, with [`REMOVED`] in unused slots.
    faces: Vec<[u32; 3]>,
    /// For each vertex, the indices of its faces.
    vertex_faces: Vec<Vec<u32>>,
}

/// The two faces at an inner edge a → b, which have the vertices (a, b, left) and (b, a, right).
/// `faces` holds their indices in this order.
struct EdgeFaces {
    faces: [u32; 2],
    left: u32,
    right: u32,
}

impl PairMesh {
    /// Creates a mesh without checking that it is valid.
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
            vertex_faces: around,
        }
    }

    /// All faces except removed ones.
    pub(super) fn faces(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.faces.iter().copied().filter(|face| *face != REMOVED)
    }

    /// Positions of a face's corners in source and target.
    pub(super) fn corners(&self, face: [u32; 3]) -> [FaceCorners; 2] {
        [0, 1].map(|d| face.map(|v| self.points[d][v as usize]))
    }

    /// Returns whether a face is positive in both designs, by exact predicates.
    fn is_valid_face(&self, face: [u32; 3]) -> bool {
        self.corners(face).into_iter().all(face_cost::is_positive)
    }

    /// Returns whether every face is positive in both designs, by exact predicates.
    pub(super) fn is_valid(&self) -> bool {
        self.faces().all(|face| self.is_valid_face(face))
    }

    /// Number of faces that are not positive in at least one of the designs.
    pub(super) fn fold_count(&self) -> usize {
        let is_folded = |face: &[u32; 3]| !self.is_valid_face(*face);
        self.faces().filter(is_folded).count()
    }

    /// Cost of a face; infinite if the face is not positive in both designs.
    pub(super) fn cost(&self, face: [u32; 3]) -> f64 {
        let [p, q] = self.corners(face);
        if face_cost::is_positive(p) && face_cost::is_positive(q) {
            face_cost::value(p, q)
        } else {
            f64::INFINITY
        }
    }

    /// Moves all vertices to `points` unless that makes a face invalid. Returns whether the
    /// vertices moved.
    ///
    /// The check uses exact predicates, because the new positions result from minimising a cost in
    /// floating point. This cost may be finite although a face is flat.
    pub(super) fn move_to(&mut self, points: [Vec<DVec2>; 2]) -> bool {
        let before = std::mem::replace(&mut self.points, points);
        let is_valid = self.is_valid();
        if !is_valid {
            self.points = before;
        }
        is_valid
    }

    /// Inner (movable) vertices that belong to at least one face, in ascending order.
    pub(super) fn steiner_vertices(&self) -> Vec<u32> {
        (self.fixed as u32..self.vertex_faces.len() as u32)
            .filter(|&v| !self.vertex_faces[v as usize].is_empty())
            .collect()
    }

    /// Faces that contain the vertex `v`.
    pub(super) fn faces_at(&self, v: u32) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.vertex_faces[v as usize]
            .iter()
            .map(|&f| self.faces[f as usize])
    }

    /// Vertices joined to `v` by an edge, in ascending order.
    pub(super) fn neighbours(&self, v: u32) -> Vec<u32> {
        let mut neighbours: Vec<u32> = self.faces_at(v).flatten().filter(|&u| u != v).collect();
        neighbours.sort_unstable();
        neighbours.dedup();
        neighbours
    }

    /// Edges with a face on both sides, sorted. Each lists its smaller vertex first.
    pub(super) fn inner_edges(&self) -> Vec<[u32; 2]> {
        let mut edges: Vec<[u32; 2]> = self
            .faces()
            .flat_map(sides)
            // Each inner edge is listed once: by the face that runs along it from the smaller to
            // the larger vertex.
            .filter(|&[a, b]| a < b && self.opposite(b, a).is_some())
            .collect();
        edges.sort_unstable();
        edges
    }

    /// Returns whether an edge has a face on both sides.
    pub(super) fn is_inner(&self, [a, b]: [u32; 2]) -> bool {
        self.opposite(a, b).is_some() && self.opposite(b, a).is_some()
    }

    /// Returns the index of the face that contains the directed edge a → b, and the face's third
    /// vertex.
    fn opposite(&self, a: u32, b: u32) -> Option<(u32, u32)> {
        self.vertex_faces[a as usize].iter().find_map(|&f| {
            let face = self.faces[f as usize];
            let k = (0..3).find(|&k| face[k] == a && face[(k + 1) % 3] == b)?;
            Some((f, face[(k + 2) % 3]))
        })
    }

    /// Returns the two faces at an edge; `None` if the edge is not an inner edge.
    fn edge_faces(&self, [a, b]: [u32; 2]) -> Option<EdgeFaces> {
        let (f, left) = self.opposite(a, b)?;
        let (g, right) = self.opposite(b, a)?;
        Some(EdgeFaces {
            faces: [f, g],
            left,
            right,
        })
    }

    /// Highest cost of any of the given faces.
    fn max_cost(&self, faces: &[[u32; 3]]) -> f64 {
        faces
            .iter()
            .map(|&face| self.cost(face))
            .fold(0.0, f64::max)
    }

    /// Flips an inner edge if that lowers the higher cost of the edge's two faces. Returns whether
    /// it was flipped.
    pub(super) fn flip_if_better(&mut self, edge: [u32; 2]) -> bool {
        let [a, b] = edge;
        let Some(edge_faces) = self.edge_faces(edge) else {
            return false;
        };
        // If one end of the edge has only three faces, `left` and `right` are already joined by an
        // edge. A flip would create that edge twice.
        let (left, right) = (edge_faces.left, edge_faces.right);
        if self.opposite(left, right).is_some() || self.opposite(right, left).is_some() {
            return false;
        }
        let new = [[a, right, left], [right, b, left]];
        let old = edge_faces.faces.map(|f| self.faces[f as usize]);
        // The improvement must exceed rounding. Otherwise an edge could flip back and forth.
        let is_better = self.max_cost(&new) < self.max_cost(&old) * (1.0 - 1e-9);
        if is_better {
            self.replace(edge_faces.faces.to_vec(), &new);
        }
        is_better
    }

    /// Inserts a vertex at the midpoint of an inner edge, in both designs, and returns its index.
    /// `None` if the edge is not an inner edge, or if rounding would make a valid face invalid.
    pub(super) fn split(&mut self, edge: [u32; 2]) -> Option<u32> {
        let [a, b] = edge;
        let edge_faces = self.edge_faces(edge)?;
        let middle = self.vertex_faces.len() as u32;
        for points in &mut self.points {
            points.push(points[a as usize].midpoint(points[b as usize]));
        }
        self.vertex_faces.push(Vec::new());
        let new = [
            [a, middle, edge_faces.left],
            [middle, b, edge_faces.left],
            [b, middle, edge_faces.right],
            [middle, a, edge_faces.right],
        ];
        // If both old faces are valid, the new faces must be valid too. If an old face is invalid,
        // new faces may be invalid.
        let was_valid = edge_faces
            .faces
            .iter()
            .all(|&f| self.is_valid_face(self.faces[f as usize]));
        if was_valid && !new.iter().all(|&face| self.is_valid_face(face)) {
            self.points
                .iter_mut()
                .for_each(|points| points.truncate(middle as usize));
            self.vertex_faces.truncate(middle as usize);
            return None;
        }
        self.replace(edge_faces.faces.to_vec(), &new);
        Some(middle)
    }

    /// Highest cost of the faces that remain at `v` after `v` is merged into its neighbour `onto`;
    /// infinite if the merge is not allowed.
    pub(super) fn collapse_cost(&self, v: u32, onto: u32) -> f64 {
        let shared = self.neighbours(onto);
        let common = self
            .neighbours(v)
            .iter()
            .filter(|u| shared.contains(u))
            .count();
        // With any other number of common neighbours the collapse would pinch the mesh or close a
        // hole (link condition; Dey, Edelsbrunner, Guha, Nekhayev 1999).
        if common != 2 {
            return f64::INFINITY;
        }
        self.faces_after_collapse(v, onto)
            .map(|face| self.cost(face))
            .fold(0.0, f64::max)
    }

    /// Faces that contain `v` and remain when `v` is moved onto its neighbour `onto`, with their
    /// new corners.
    fn faces_after_collapse(&self, v: u32, onto: u32) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.faces_at(v)
            .filter(move |face| !face.contains(&onto))
            .map(move |face| face.map(|u| if u == v { onto } else { u }))
    }

    /// Merges `v` into its neighbour `onto`. The caller must have checked that
    /// [`Self::collapse_cost`] is finite.
    pub(super) fn collapse(&mut self, v: u32, onto: u32) {
        let new: Vec<[u32; 3]> = self.faces_after_collapse(v, onto).collect();
        self.replace(self.vertex_faces[v as usize].clone(), &new);
    }

    /// Replaces the faces with the indices `old` by the faces `new`.
    fn replace(&mut self, old: Vec<u32>, new: &[[u32; 3]]) {
        for &f in &old {
            for v in std::mem::replace(&mut self.faces[f as usize], REMOVED) {
                self.vertex_faces[v as usize].retain(|&g| g != f);
            }
        }
        // Slots of removed faces are reused, so that indices stay small. A split needs two slots
        // more than it frees.
        let mut free = old.into_iter();
        for &face in new {
            let f = free.next().unwrap_or(self.faces.len() as u32);
            if f as usize == self.faces.len() {
                self.faces.push(face);
            } else {
                self.faces[f as usize] = face;
            }
            for v in face {
                self.vertex_faces[v as usize].push(f);
            }
        }
    }

    /// Returns the mesh with the designs exchanged.
    pub(super) fn swapped(mut self) -> Self {
        self.points.swap(0, 1);
        self
    }

    /// Faces and vertex positions, renumbered without gaps. Unused inner vertices are left out.
    pub(super) fn compacted(&self) -> (Vec<[u32; 3]>, [Vec<DVec2>; 2]) {
        let used: Vec<u32> = (0..self.fixed as u32)
            .chain(self.steiner_vertices())
            .collect();
        let mut new_number = vec![u32::MAX; self.vertex_faces.len()];
        for (new, &old) in used.iter().enumerate() {
            new_number[old as usize] = new as u32;
        }
        let faces = self
            .faces()
            .map(|face| face.map(|v| new_number[v as usize]));
        let points = [0, 1].map(|d| used.iter().map(|&v| self.points[d][v as usize]).collect());
        (faces.collect(), points)
    }

    /// Converts the mesh to the designs' own coordinates: divides the positions by `scales`, one
    /// number for each design. The polygon vertices are copied from `exact_points`, so they are
    /// exact to the last bit.
    ///
    /// # Errors
    /// [`CompatibleError`] if a face is invalid after rounding to these coordinates.
    pub(super) fn to_compatible_mesh(
        &self,
        scales: [f64; 2],
        exact_points: [&[DVec2]; 2],
    ) -> Result<CompatibleMesh, CompatibleError> {
        let (faces, mut points) = self.compacted();
        for (d, exact) in exact_points.into_iter().enumerate() {
            points[d].iter_mut().for_each(|p| *p /= scales[d]);
            points[d][..exact.len()].copy_from_slice(exact);
        }
        let [source, target] = points;
        CompatibleMesh::new(faces, source, target, Vec::new())
    }
}

/// Returns the power of two that scales the points to a diameter near 1. Scaling by a power of two
/// is exact.
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
    fn a_collapse_undoes_a_split() {
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
    fn polygon_edges_are_never_split_or_flipped() {
        let mut mesh = square();
        assert_eq!(mesh.split([0, 1]), None);
        assert!(!mesh.flip_if_better([1, 2]));
        assert_eq!(mesh.inner_edges(), vec![[0, 2]]);
    }
}
