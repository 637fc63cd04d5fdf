//! Measures of a compatible mesh: angles, Steiner points, boundary stretch and distortion.

use super::distortion::{Distortion, Distribution, distortion};
use super::stretch;
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;
use serde::Serialize;

/// Angle below which a face counts as thin, in degrees (heuristic).
const THIN_DEG: f64 = 5.0;

/// Measures of a compatible mesh, that is, of one triangulation with two embeddings: source and
/// target.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct MeshReport {
    /// Number of vertices of the mesh.
    pub vertices: usize,
    /// Number of faces of the mesh.
    pub faces: usize,
    /// Number of vertices on the boundary.
    pub boundary_vertices: usize,
    /// Number of vertices inside the boundary. In a triangulated outline, these are the Steiner
    /// points.
    pub inner_vertices: usize,
    /// Number of inner vertices per boundary vertex.
    pub steiner_per_boundary_point: f64,
    /// Smallest angle of any face in the source, in degrees.
    pub min_angle_source_deg: f64,
    /// Smallest angle of any face in the target, in degrees.
    pub min_angle_target_deg: f64,
    /// Fraction of faces with an angle below 5° in either embedding.
    pub thin_faces: f64,
    /// Unevenness of the boundary stretch, weighted by length in the source: max(k, 1/k), where k
    /// is the local stretch divided by the stretch of the whole loop. It is 1 where the boundary is
    /// stretched evenly.
    pub boundary_stretch: Distribution,
    /// Distortion of the faces from source to target.
    pub distortion: Distortion,
}

/// Measures a compatible mesh; returns `None` if it has only bars and no faces.
///
/// ```
/// use morphospace::{compatible::CompatibleMesh, geometry::DVec2, measure};
/// let points = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
/// let mesh = CompatibleMesh::new(vec![[0, 1, 2]], points.clone(), points, vec![])?;
/// let report = measure::mesh_report(&mesh).expect("there is a face");
/// assert!((report.min_angle_source_deg - 45.0).abs() < 1e-12);
/// # Ok::<(), morphospace::compatible::CompatibleError>(())
/// ```
#[must_use]
pub fn mesh_report(mesh: &CompatibleMesh) -> Option<MeshReport> {
    let angles = |points: &[DVec2]| -> Vec<f64> {
        let angle = |f: &[u32; 3]| smallest_angle(f.map(|v| points[v as usize])).to_degrees();
        mesh.faces().iter().map(angle).collect()
    };
    let (source, target) = (angles(mesh.source()), angles(mesh.target()));
    let pairs = source.iter().zip(&target);
    let thin = pairs.filter(|(a, b)| a.min(**b) < THIN_DEG).count();
    let smallest = |angles: &[f64]| angles.iter().copied().fold(f64::INFINITY, f64::min);
    let boundary = boundary_vertices(mesh);
    let inner = mesh.source().len() - boundary;
    Some(MeshReport {
        vertices: mesh.source().len(),
        faces: mesh.faces().len(),
        boundary_vertices: boundary,
        inner_vertices: inner,
        steiner_per_boundary_point: inner as f64 / boundary.max(1) as f64,
        min_angle_source_deg: smallest(&source),
        min_angle_target_deg: smallest(&target),
        thin_faces: thin as f64 / mesh.faces().len() as f64,
        boundary_stretch: stretch::stretch_distribution(mesh)?,
        distortion: distortion(mesh, mesh.target())?,
    })
}

/// Returns the number of boundary vertices, each counted once even where loops touch.
fn boundary_vertices(mesh: &CompatibleMesh) -> usize {
    let mut on_boundary = vec![false; mesh.source().len()];
    for v in mesh.boundary_loops().into_iter().flatten() {
        on_boundary[v as usize] = true;
    }
    on_boundary.iter().filter(|&&on| on).count()
}

/// Returns the smallest angle of a triangle, in radians.
pub(super) fn smallest_angle([a, b, c]: [DVec2; 3]) -> f64 {
    let angle_at = |p: DVec2, q: DVec2, r: DVec2| {
        let (u, v) = (q - p, r - p);
        u.perp_dot(v).abs().atan2(u.dot(v))
    };
    angle_at(a, b, c)
        .min(angle_at(b, c, a))
        .min(angle_at(c, a, b))
}
