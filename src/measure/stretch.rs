//! Local stretch of the boundary from source to target, relative to the stretch of the whole
//! boundary loop.
//!
//! Lengths are fractions of the length of their boundary loop, so uniform scaling counts as even. A
//! single edge may have almost no length in one design, so the stretch is measured over sections of
//! several edges. Each section reaches a minimum length, counted in source and target together.

use super::distortion::{self, Distribution};
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;

/// Minimum length of the section over which stretch is measured: its fraction of the loop in the
/// source plus its fraction in the target. This is about two edges of an outline with 120 points
/// (heuristic).
const MIN_WINDOW_LENGTH: f64 = 0.03;

/// Stretch of the boundary around one vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EdgeStretch {
    /// Index of the vertex.
    pub vertex: u32,
    /// Fraction of the loop that a section around the vertex covers in the target, divided by the
    /// fraction that it covers in the source; 1 is even.
    pub ratio: f64,
    /// Length of the source boundary that the vertex represents, in design units: half of each of
    /// its two boundary edges.
    pub weight: f64,
}

impl EdgeStretch {
    /// Returns max(k, 1/k) for the stretch ratio k, at least 1.
    pub fn unevenness(&self) -> f64 {
        self.ratio.max(1.0 / self.ratio)
    }
}

/// Returns the stretch around each vertex of each boundary loop.
pub(super) fn boundary_stretch(mesh: &CompatibleMesh) -> Vec<EdgeStretch> {
    let loops = mesh.boundary_loops();
    let stretch_of_loop = |vertices: &Vec<u32>| {
        let [source, target] =
            [mesh.source(), mesh.target()].map(|points| edge_lengths(vertices, points));
        loop_stretch(vertices, &source, &target)
    };
    loops.iter().flat_map(stretch_of_loop).collect()
}

/// Returns the distribution of the unevenness over all boundary vertices, weighted by length in the
/// source; `None` without a boundary.
pub(super) fn stretch_distribution(mesh: &CompatibleMesh) -> Option<Distribution> {
    let weighted = boundary_stretch(mesh).into_iter();
    distortion::distribution(weighted.map(|s| (s.unevenness(), s.weight)).collect())
}

/// Returns the length of each edge of a boundary loop.
fn edge_lengths(vertices: &[u32], points: &[DVec2]) -> Vec<f64> {
    let next = vertices.iter().cycle().skip(1);
    let length = |(&a, &b): (&u32, &u32)| points[a as usize].distance(points[b as usize]);
    vertices.iter().zip(next).map(length).collect()
}

/// Returns the stretch around each vertex of a loop with the given edge lengths.
fn loop_stretch(vertices: &[u32], source: &[f64], target: &[f64]) -> Vec<EdgeStretch> {
    let n = vertices.len();
    let (source_length, target_length) = (source.iter().sum::<f64>(), target.iter().sum::<f64>());
    let stretch_at = |i: usize| {
        // The section grows by one edge on either side until it is long enough.
        let (mut in_source, mut in_target) = (0.0, 0.0);
        for k in 0..n.div_ceil(2) {
            let (after, before) = ((i + k) % n, (i + 2 * n - 1 - k) % n);
            in_source += (source[after] + source[before]) / source_length;
            in_target += (target[after] + target[before]) / target_length;
            // A section that is long in only one design is accepted. Otherwise, a squeezed section
            // would be averaged with its neighbours.
            if in_source + in_target >= MIN_WINDOW_LENGTH {
                break;
            }
        }
        EdgeStretch {
            vertex: vertices[i],
            ratio: in_target / in_source,
            weight: 0.5 * (source[i] + source[(i + n - 1) % n]),
        }
    };
    (0..n).map(stretch_at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mesh of the unit square with 40 edges on its lower and 40 on its upper side. In the target,
    /// `bottom` moves the vertices of the lower side along x.
    fn mesh_with(bottom: impl Fn(f64) -> f64) -> CompatibleMesh {
        /// Number of edges along the lower side.
        const COLUMNS: u32 = 40;
        let point = |i: u32, j: u32| DVec2::new(f64::from(i) / f64::from(COLUMNS), f64::from(j));
        let source: Vec<_> = (0..=1)
            .flat_map(|j| (0..=COLUMNS).map(move |i| point(i, j)))
            .collect();
        let squeezed = |p: &DVec2| {
            if p.y == 0.0 {
                DVec2::new(bottom(p.x), 0.0)
            } else {
                *p
            }
        };
        let target = source.iter().map(squeezed).collect();
        let quad = |i: u32| {
            [
                [i, i + 1, i + COLUMNS + 2],
                [i, i + COLUMNS + 2, i + COLUMNS + 1],
            ]
        };
        let faces = (0..COLUMNS).flat_map(quad).collect();
        CompatibleMesh::new(faces, source, target, vec![]).expect("valid")
    }

    #[test]
    fn an_even_boundary_has_unevenness_one() {
        let mesh = mesh_with(|x| x);
        let distribution = stretch_distribution(&mesh).expect("a boundary");
        assert!((distribution.worst - 1.0).abs() < 1e-9, "{distribution:?}");
    }

    #[test]
    fn a_squeezed_section_is_located() {
        // The left half of the lower side is squeezed into the left eighth of that side.
        let squeeze = |x: f64| {
            if x < 0.5 {
                x / 4.0
            } else {
                0.125 + (x - 0.5) * 1.75
            }
        };
        let mesh = mesh_with(squeeze);
        let worst = boundary_stretch(&mesh)
            .into_iter()
            .max_by(|a, b| a.unevenness().total_cmp(&b.unevenness()))
            .expect("a boundary");
        let at = mesh.source()[worst.vertex as usize];
        assert!(at.y == 0.0 && at.x < 0.5, "{at}");
        assert!((worst.ratio - 0.25).abs() < 0.02, "{worst:?}");
    }
}
