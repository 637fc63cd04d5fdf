//! Faces of a mesh as its file lists them: polygons of three or more vertices, which a
//! [`TriangleMesh`](super::TriangleMesh) divides into triangles.
//!
//! A polygon of n vertices becomes n − 2 triangles without added vertices, and the triangles of
//! consecutive polygons are consecutive. A fan about the first vertex is used where it is valid,
//! because it does not depend on the positions: two files with the same faces then get the same
//! triangles. Otherwise the polygon gets its constrained Delaunay triangulation.

use super::triangulation::constrained_delaunay;
use crate::geometry::{DVec2, orient2d, signed_area};

/// List of polygons, each given by the indices of its vertices.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PolygonFaces {
    /// Vertex indices of all polygons in one list, because a list for each polygon would dominate
    /// the import time of large meshes.
    corners: Vec<u32>,
    /// For each polygon, the index in `corners` after its last vertex.
    ends: Vec<usize>,
}

impl PolygonFaces {
    /// Appends a polygon.
    pub fn push(&mut self, corners: impl IntoIterator<Item = u32>) {
        self.corners.extend(corners);
        self.ends.push(self.corners.len());
    }

    /// Returns the number of polygons.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Returns whether there are no polygons.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Returns the vertex indices of a polygon.
    ///
    /// # Panics
    /// If there is no polygon with this index.
    #[must_use]
    pub fn polygon(&self, index: usize) -> &[u32] {
        &self.corners[self.start(index)..self.ends[index]]
    }

    /// Returns the index of the first triangle of a polygon.
    #[must_use]
    pub fn first_triangle(&self, index: usize) -> usize {
        self.start(index) - 2 * index
    }

    /// Returns the index of the polygon to which a triangle belongs.
    #[must_use]
    pub fn polygon_of(&self, triangle: usize) -> usize {
        let (mut from, mut to) = (0, self.len());
        while to - from > 1 {
            let middle = from + (to - from) / 2;
            if self.first_triangle(middle) <= triangle {
                from = middle;
            } else {
                to = middle;
            }
        }
        from
    }

    /// Returns whether all polygons are triangles.
    pub(super) fn are_triangles(&self) -> bool {
        self.corners.len() == 3 * self.len()
    }

    /// Divides all polygons into triangles with their orientation. The vertices must exist.
    ///
    /// # Errors
    /// The index of the first polygon that touches or crosses itself, or has fewer than three
    /// vertices.
    pub(super) fn triangles(&self, positions: &[DVec2]) -> Result<Vec<[u32; 3]>, usize> {
        let mut triangles = Vec::with_capacity(self.corners.len().saturating_sub(2 * self.len()));
        for k in 0..self.len() {
            let polygon = self.polygon(k);
            if polygon.len() == 3 || is_fan_valid(polygon, positions) {
                triangles.extend(fan(polygon));
            } else {
                triangles.extend(delaunay(polygon, positions).ok_or(k)?);
            }
        }
        Ok(triangles)
    }

    /// Returns the index in `corners` of the first vertex of a polygon.
    fn start(&self, index: usize) -> usize {
        index.checked_sub(1).map_or(0, |before| self.ends[before])
    }
}

/// Returns the triangles between the first vertex and each edge that does not end in it.
fn fan(polygon: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    let edges = polygon.get(1..).unwrap_or_default().windows(2);
    edges.map(|edge| [polygon[0], edge[0], edge[1]])
}

/// Returns whether all triangles of the fan have an area and the same orientation.
fn is_fan_valid(polygon: &[u32], positions: &[DVec2]) -> bool {
    let orientation = |triangle: [u32; 3]| {
        let [a, b, c] = triangle.map(|v| positions[v as usize]);
        orient2d(a, b, c)
    };
    polygon.len() >= 3
        && (fan(polygon).all(|triangle| orientation(triangle) > 0.0)
            || fan(polygon).all(|triangle| orientation(triangle) < 0.0))
}

/// Returns the constrained Delaunay triangulation of a polygon, with its orientation; `None` if the
/// polygon touches or crosses itself.
fn delaunay(polygon: &[u32], positions: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let points: Vec<DVec2> = polygon.iter().map(|&v| positions[v as usize]).collect();
    let is_clockwise = signed_area(&points) < 0.0;
    let corner = |k: usize| match is_clockwise {
        true => points.len() - 1 - k,
        false => k,
    };
    let counter_clockwise: Vec<DVec2> = (0..points.len()).map(|k| points[corner(k)]).collect();
    let triangles = constrained_delaunay(&[counter_clockwise]).ok()?;
    let in_polygon = |triangle: [u32; 3]| {
        let [a, b, c] = triangle.map(|k| polygon[corner(k as usize)]);
        if is_clockwise { [a, c, b] } else { [a, b, c] }
    };
    (triangles.len() + 2 == polygon.len()).then(|| triangles.into_iter().map(in_polygon).collect())
}
