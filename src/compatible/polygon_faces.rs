//! Common triangles of meshes whose files list the same polygons.
//!
//! Each mesh divides its polygons into triangles on its own. Where these differ, or are not valid
//! in all meshes, the polygon is divided anew, as the panels of trusses are.

use super::truss::{MAX_PANEL_NODES, triangulate_panel};
use super::validation::CompatibleError;
use crate::geometry::{DVec2, orient2d, signed_area};
use crate::mesh::{PolygonFaces, TriangleMesh};
use crate::work::progress::Silent;
use std::sync::Arc;

/// Returns triangles that have the same orientation in all meshes, in the order of the polygons.
/// The polygons of a mesh without polygons are its triangles.
///
/// Polygons that are turned over in some of the meshes keep the triangles of the first mesh.
///
/// # Errors
/// [`CompatibleError::FaceCounts`] or [`CompatibleError::FacesDiffer`] if the polygons differ,
/// [`CompatibleError::NoTriangulation`] for a polygon without common triangles. The meshes other
/// than the first are called the target there.
pub(super) fn common_triangles(meshes: &[&TriangleMesh]) -> Result<Vec<[u32; 3]>, CompatibleError> {
    let Some((first, others)) = meshes.split_first() else {
        return Ok(Vec::new());
    };
    let polygons: Vec<Arc<PolygonFaces>> = meshes.iter().map(|mesh| mesh.listed_faces()).collect();
    for (other, faces) in others.iter().zip(&polygons[1..]) {
        check_same(&polygons[0], faces)?;
        if first.positions().len() != other.positions().len() {
            let counts = [first.positions().len(), other.positions().len()];
            return Err(CompatibleError::VertexCounts(counts));
        }
    }
    let embeddings: Vec<&[DVec2]> = meshes.iter().map(|mesh| mesh.positions()).collect();
    let mut triangles = Vec::with_capacity(first.faces().len());
    for k in 0..polygons[0].len() {
        let polygon = polygons[0].polygon(k);
        let from = polygons[0].first_triangle(k);
        let own = &first.faces()[from..from + polygon.len() - 2];
        if polygon.len() == 3 || is_turned_over(polygon, &embeddings) || are_valid(own, &embeddings)
        {
            triangles.extend_from_slice(own);
        } else {
            let anew = divide(polygon, &embeddings);
            triangles.extend(anew.ok_or(CompatibleError::NoTriangulation(k))?);
        }
    }
    Ok(triangles)
}

/// Checks that two lists have the same polygons in the same order. The direction in which a polygon
/// lists its vertices, and the vertex with which it begins, do not matter.
fn check_same(a: &PolygonFaces, b: &PolygonFaces) -> Result<(), CompatibleError> {
    if a.len() != b.len() {
        return Err(CompatibleError::FaceCounts([a.len(), b.len()]));
    }
    let is_same = |k: &usize| is_same_cycle(a.polygon(*k), b.polygon(*k));
    match (0..a.len()).find(|k| !is_same(k)) {
        Some(face) => Err(CompatibleError::FacesDiffer(face)),
        None => Ok(()),
    }
}

/// Returns whether two polygons have the same vertices in the same or in the opposite order.
fn is_same_cycle(a: &[u32], b: &[u32]) -> bool {
    let n = a.len();
    let Some(start) = b.iter().position(|v| Some(v) == a.first()) else {
        return false;
    };
    let is_same = |index: &dyn Fn(usize) -> usize| (0..n).all(|k| a[k] == b[index(k) % n]);
    b.len() == n && (is_same(&|k| start + k) || is_same(&|k| start + n - k))
}

/// Returns whether a polygon runs counter-clockwise in some embeddings and clockwise in others.
fn is_turned_over(polygon: &[u32], embeddings: &[&[DVec2]]) -> bool {
    let is_counter_clockwise = |places: &[DVec2]| signed_area(&at(polygon, places)) > 0.0;
    let first = is_counter_clockwise(embeddings[0]);
    let mut others = embeddings.iter().skip(1);
    others.any(|places| is_counter_clockwise(places) != first)
}

/// Returns whether all triangles have an area and the same orientation in all embeddings.
fn are_valid(triangles: &[[u32; 3]], embeddings: &[&[DVec2]]) -> bool {
    let orientations = embeddings.iter().flat_map(|places| {
        triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|v| places[v as usize]);
            orient2d(a, b, c)
        })
    });
    let mut orientations = orientations.peekable();
    let sign = orientations.peek().copied().unwrap_or(0.0);
    orientations.all(|orientation| orientation * sign.signum() > 0.0)
}

/// Divides a polygon into triangles that are valid in all embeddings; `None` if none are found or
/// the polygon has too many vertices.
fn divide(polygon: &[u32], embeddings: &[&[DVec2]]) -> Option<Vec<[u32; 3]>> {
    if polygon.len() > MAX_PANEL_NODES {
        return None;
    }
    let mut cycle = polygon.to_vec();
    if signed_area(&at(polygon, embeddings[0])) < 0.0 {
        cycle.reverse();
    }
    // The work is short, so it cannot be cancelled.
    triangulate_panel(&cycle, embeddings, &Silent)
        .ok()
        .flatten()
}

/// Positions of the vertices of a polygon.
fn at(polygon: &[u32], places: &[DVec2]) -> Vec<DVec2> {
    polygon.iter().map(|&v| places[v as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compatible::{CompatibleFamily, CompatibleMesh, FamilyError};

    fn mesh(places: &[(f64, f64)], faces: &[&[u32]]) -> TriangleMesh {
        let mut polygons = PolygonFaces::default();
        for face in faces {
            polygons.push(face.iter().copied());
        }
        let places = places.iter().copied().map(DVec2::from);
        TriangleMesh::from_polygons(places.collect(), polygons).expect("a mesh")
    }

    const L: [(f64, f64); 6] = [(0., 0.), (4., 0.), (4., 1.), (1., 1.), (1., 3.), (0., 3.)];
    /// The same corners with the dent at the last corner.
    const OTHER: [(f64, f64); 6] = [(0., 0.), (4., 0.), (4., 2.), (2., 3.), (0., 4.), (1., 2.)];
    const CYCLE: &[u32] = &[1, 2, 3, 4, 5, 0];

    fn area(mesh: &CompatibleMesh, places: &[DVec2]) -> f64 {
        let corners = mesh.faces().iter();
        let areas = corners.map(|triangle| {
            let [a, b, c] = triangle.map(|v| places[v as usize]);
            0.5 * orient2d(a, b, c)
        });
        areas.sum()
    }

    #[test]
    fn a_polygon_gets_triangles_that_are_valid_in_both_meshes() {
        let (a, b) = (mesh(&L, &[CYCLE]), mesh(&OTHER, &[&[0, 1, 2, 3, 4, 5]]));
        let both = CompatibleMesh::from_meshes(&a, &b).expect("a common mesh");
        assert_eq!(both.faces().len(), 4);
        assert!((area(&both, both.source()) - 6.0).abs() < 1e-12);
        let target: Vec<DVec2> = OTHER.map(DVec2::from).to_vec();
        assert!((area(&both, both.target()) - signed_area(&target)).abs() < 1e-12);
        let convex = mesh(
            &[(0., 0.), (2., 0.), (3., 1.), (3., 2.), (1., 3.), (-1., 1.)],
            &[CYCLE],
        );
        let family = CompatibleFamily::from_meshes(&[&convex, &a, &b]).expect("a family");
        assert_eq!(family.pair(1, 2).faces().len(), 4);
    }

    /// A triangle, and a quadrilateral with these corners as the second face.
    fn with_triangle(corners: [(f64, f64); 4]) -> TriangleMesh {
        let triangle = [(9., 9.), (8., 9.), (9., 8.)];
        let places = [&corners[..], &triangle].concat();
        mesh(&places, &[&[4, 5, 6], &[0, 1, 2, 3]])
    }

    #[test]
    fn a_polygon_without_common_triangles_is_named_as_the_files_count_it() {
        // Arrowheads with one dent each, at corners whose diagonals differ.
        let first = with_triangle([(0., 0.), (2., 1.), (4., 0.), (2., 4.)]);
        let second = with_triangle([(2., 1.), (4., 0.), (2., 4.), (0., 0.)]);
        let error = CompatibleMesh::from_meshes(&first, &second).expect_err("no triangles");
        assert_eq!(error, CompatibleError::NoTriangulation(1));
        let words = error.to_string();
        assert!(words.starts_with("face 2 cannot be divided"), "{words}");
        assert_eq!(
            CompatibleFamily::from_meshes(&[&first, &second]).expect_err("no triangles"),
            FamilyError::Incompatible { design: 1, error }
        );
        // Turned over.
        let back = with_triangle([(2., 4.), (4., 0.), (2., 1.), (0., 0.)]);
        let error = CompatibleMesh::from_meshes(&first, &back).expect_err("turned over");
        assert_eq!(error, CompatibleError::Flipped(vec![1]));
    }

    #[test]
    fn other_polygons_are_named_in_the_error() {
        let square = [(0., 0.), (2., 0.), (2., 2.), (0., 2.)];
        let (whole, crossed) = (
            mesh(&square, &[&[0, 1, 2, 3]]),
            [&[0, 1, 2][..], &[0, 2, 3]],
        );
        let divided = mesh(&square, &crossed);
        assert_eq!(
            CompatibleMesh::from_meshes(&whole, &divided).expect_err("other faces"),
            CompatibleError::FaceCounts([1, 2])
        );
        let other = mesh(&square, &[&[1, 2, 3], &[0, 1, 3]]);
        assert_eq!(
            CompatibleMesh::from_meshes(&divided, &other).expect_err("other faces"),
            CompatibleError::FacesDiffer(0)
        );
    }
}
