//! Connectivity of triangle meshes: half-edges and their opposites.
//!
//! Half-edge `3 f + k` runs from corner `k` of face `f` to the next corner. Guaranteed: every edge
//! has one or two faces, and two faces of an edge run along it in opposite directions. A vertex may
//! have several separate fans of faces.

use super::components::components;
use super::edges::{sides, undirected};

/// Opposites of the half-edges of a list of faces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Connectivity {
    /// Opposite of each half-edge, or [`NONE`] at the boundary.
    twins: Vec<u32>,
}

/// Error for faces that do not meet edge to edge. Indices start at 0 in fields and at 1 in
/// messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ConnectivityError {
    /// More than two faces meet at the edge between these two vertices.
    #[error("more than two faces meet at the edge between vertices {} and {}; remove the extra ones", u64::from(.0[0]) + 1, u64::from(.0[1]) + 1)]
    TooManyFaces([u32; 2]),
    /// The two faces with these indices run along their common edge in the same direction.
    #[error("faces {} and {} are wound in opposite directions; reverse the vertices of one", .0[0] + 1, .0[1] + 1)]
    Opposed([usize; 2]),
}

/// Marks a half-edge without an opposite: it lies on the boundary.
const NONE: u32 = u32::MAX;

/// Returns the next half-edge of the same face.
fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

impl Connectivity {
    /// Pairs the half-edges, in O(n log n).
    ///
    /// # Errors
    /// [`ConnectivityError`] if an edge has more than two faces, or two that
    /// are wound in opposite directions.
    pub fn new(faces: &[[u32; 3]]) -> Result<Self, ConnectivityError> {
        // Sorting brings the half-edges of one edge together.
        let mut edges = sorted_edges(faces);
        let mut twins = vec![NONE; 3 * faces.len()];
        for run in edges.chunk_by_mut(|a, b| a.0 == b.0) {
            match *run {
                [_] => {}
                [(_, forward_a, a), (_, forward_b, b)] if forward_a != forward_b => {
                    twins[a as usize] = b;
                    twins[b as usize] = a;
                }
                [(_, _, a), (_, _, b)] => {
                    return Err(ConnectivityError::Opposed([a as usize / 3, b as usize / 3]));
                }
                [(edge, ..), ..] => return Err(ConnectivityError::TooManyFaces(edge)),
                [] => unreachable!("runs are not empty"),
            }
        }
        Ok(Self { twins })
    }

    /// Returns the face across the edge from corner `k` of `face` to the next corner; `None` if the
    /// edge lies on the boundary.
    ///
    /// # Panics
    /// If `face` does not exist, or if `k` exceeds 2 in the last face.
    #[must_use]
    pub fn neighbour(&self, face: usize, k: usize) -> Option<usize> {
        Some(self.twin(face, k)? as usize / 3)
    }

    /// Returns the half-edge opposite to the one from corner `k` of `face`; `None` on the boundary.
    pub(crate) fn twin(&self, face: usize, k: usize) -> Option<u32> {
        match self.twins[3 * face + k] {
            NONE => None,
            twin => Some(twin),
        }
    }

    /// Returns for each face the index of its dual component, from 0. Faces of one component are
    /// connected across edges; a common vertex alone does not connect them.
    #[must_use]
    pub fn dual_components(&self) -> Vec<u32> {
        let pairs = self
            .twins
            .iter()
            .zip(0..)
            .filter(|(twin, _)| **twin != NONE);
        components(
            self.twins.len() / 3,
            pairs.map(|(twin, h)| [twin / 3, h / 3]),
        )
    }

    /// Returns the closed boundary loops as vertex indices, in the direction of the faces. A vertex
    /// with several separate fans of faces occurs once for each fan.
    ///
    /// # Panics
    /// If there are fewer faces than this connectivity was built from.
    #[must_use]
    pub fn boundary_loops(&self, faces: &[[u32; 3]]) -> Vec<Vec<u32>> {
        let from = |h: u32| faces[h as usize / 3][h as usize % 3];
        let mut seen = vec![false; self.twins.len()];
        let mut loops = Vec::new();
        for start in 0..self.twins.len() {
            if self.twins[start] != NONE || seen[start] {
                continue;
            }
            let mut boundary = Vec::new();
            let mut h = start as u32;
            while !seen[h as usize] {
                seen[h as usize] = true;
                boundary.push(from(h));
                h = self.next_on_boundary(h);
            }
            loops.push(boundary);
        }
        loops
    }

    /// Returns the boundary half-edge that follows the boundary half-edge `h`, by rotating about
    /// the end of `h` inside its fan of faces.
    fn next_on_boundary(&self, h: u32) -> u32 {
        // Terminates: a fan that begins at the boundary also ends there.
        let mut out = next(h);
        while self.twins[out as usize] != NONE {
            out = next(self.twins[out as usize]);
        }
        out
    }
}

/// Half-edge for sorting: (undirected edge, whether it runs from the smaller to the larger vertex,
/// index).
type SortedHalfEdge = ([u32; 2], bool, u32);

/// Returns all half-edges sorted by edge.
fn sorted_edges(faces: &[[u32; 3]]) -> Vec<SortedHalfEdge> {
    let mut edges = Vec::with_capacity(3 * faces.len());
    for (f, face) in faces.iter().enumerate() {
        for (k, [a, b]) in sides(*face).into_iter().enumerate() {
            edges.push((undirected([a, b]), a < b, (3 * f + k) as u32));
        }
    }
    sort(&mut edges);
    edges
}

/// Sorts half-edges by their smaller vertex in one counting pass, and then sorts the few half-edges
/// of each vertex among themselves. For six million edges this takes a fraction of the time of a
/// full sort.
fn sort(edges: &mut Vec<SortedHalfEdge>) {
    let vertices = edges.iter().map(|([a, _], ..)| *a as usize + 1).max();
    let Some(vertices) = vertices.filter(|count| *count <= edges.len()) else {
        // The largest vertex index is not below the number of half-edges, so a counting sort would
        // waste memory.
        return edges.sort_unstable();
    };
    let mut from = vec![0; vertices + 1];
    for ([a, _], ..) in edges.iter() {
        from[*a as usize + 1] += 1;
    }
    for v in 0..vertices {
        from[v + 1] += from[v];
    }
    let mut next = from.clone();
    let mut sorted = vec![([0; 2], false, 0); edges.len()];
    for edge in edges.iter() {
        let place: &mut usize = &mut next[edge.0[0] as usize];
        sorted[*place] = *edge;
        *place += 1;
    }
    for run in from.windows(2) {
        sorted[run[0]..run[1]].sort_unstable();
    }
    *edges = sorted;
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn edges_are_sorted_like_by_the_standard_sort(
            faces in prop::collection::vec(prop::array::uniform3(0_u32..12), 0..40),
            shift in prop::sample::select(vec![0, 1000]),
        ) {
            let faces: Vec<[u32; 3]> = faces.iter().map(|f| f.map(|v| v + shift)).collect();
            let sorted = sorted_edges(&faces);
            let mut expected = sorted.clone();
            expected.sort_unstable();
            prop_assert_eq!(sorted.len(), 3 * faces.len());
            prop_assert_eq!(sorted, expected);
        }
    }

    #[test]
    fn two_triangles_have_one_loop_of_four() {
        let faces = [[0, 1, 2], [0, 2, 3]];
        let c = Connectivity::new(&faces).expect("manifold");
        assert_eq!(c.boundary_loops(&faces), vec![vec![0, 1, 2, 3]]);
        assert_eq!(c.neighbour(0, 2), Some(1));
        assert_eq!(c.neighbour(0, 0), None);
        assert_eq!(c.dual_components(), vec![0, 0]);
    }

    #[test]
    fn a_pinch_separates_loops_and_dual_components() {
        let faces = [[0, 1, 2], [2, 3, 4]];
        let c = Connectivity::new(&faces).expect("manifold");
        assert_eq!(c.boundary_loops(&faces).len(), 2);
        assert_eq!(c.dual_components(), vec![0, 1]);
    }

    #[test]
    fn invalid_edges_are_named() {
        assert_eq!(
            Connectivity::new(&[[0, 1, 2], [0, 1, 3]]),
            Err(ConnectivityError::Opposed([0, 1]))
        );
        assert_eq!(
            Connectivity::new(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]]),
            Err(ConnectivityError::TooManyFaces([0, 1]))
        );
    }
}
