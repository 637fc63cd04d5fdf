//! Quality of a mesh and of a film, in numbers.
//!
//! - [`MeshReport`]: the two embeddings of a compatible mesh: angles, and the
//!   distortion of the map between them.
//! - [`FilmReport`]: a transition sampled over t: folds, distortion beyond
//!   the worse end, self-crossings, how area and perimeter run, pieces and
//!   holes, travel and acceleration with the rigid motion taken out.
//!
//! Measures are taken at samples: a fold between two samples is not seen.

mod crossings;
mod distortion;
mod film;
mod motion;

pub use crossings::count_crossings;
pub use distortion::{Distortion, Distribution, distortion};
pub use film::{FilmReport, FilmSample, film};
pub use motion::Motion;

use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;
use serde::Serialize;

/// The two embeddings of a compatible mesh.
#[derive(Clone, Debug, Serialize)]
pub struct MeshReport {
    /// How many vertices there are.
    pub vertices: usize,
    /// How many faces there are.
    pub faces: usize,
    /// How many boundary vertices there are.
    pub boundary_vertices: usize,
    /// The smallest angle of any face in the source, in degrees.
    pub min_angle_source_deg: f64,
    /// The smallest angle of any face in the target, in degrees.
    pub min_angle_target_deg: f64,
    /// Fraction of faces with an angle below 5° in either embedding.
    pub thin_faces: f64,
    /// Of the map from source to target.
    pub distortion: Distortion,
}

/// Measures a compatible mesh that has faces; `None` for bars alone.
#[must_use]
pub fn mesh(mesh: &CompatibleMesh) -> Option<MeshReport> {
    const THIN_DEG: f64 = 5.0;
    let angles = |points: &[DVec2]| -> Vec<f64> {
        let angle = |f: &[u32; 3]| smallest_angle(f.map(|v| points[v as usize])).to_degrees();
        mesh.faces().iter().map(angle).collect()
    };
    let (source, target) = (angles(mesh.source()), angles(mesh.target()));
    let pairs = source.iter().zip(&target);
    let thin = pairs.filter(|(a, b)| a.min(**b) < THIN_DEG).count();
    let least = |angles: &[f64]| angles.iter().copied().fold(f64::INFINITY, f64::min);
    Some(MeshReport {
        vertices: mesh.source().len(),
        faces: mesh.faces().len(),
        boundary_vertices: mesh.boundary_loops().iter().map(Vec::len).sum(),
        min_angle_source_deg: least(&source),
        min_angle_target_deg: least(&target),
        thin_faces: thin as f64 / mesh.faces().len() as f64,
        distortion: distortion(mesh, mesh.target())?,
    })
}

fn smallest_angle([a, b, c]: [DVec2; 3]) -> f64 {
    let at = |p: DVec2, q: DVec2, r: DVec2| {
        let (u, v) = (q - p, r - p);
        u.perp_dot(v).abs().atan2(u.dot(v))
    };
    at(a, b, c).min(at(b, c, a)).min(at(c, a, b))
}
