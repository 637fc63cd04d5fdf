//! How evenly a boundary is stretched from source to target.
//!
//! Lengths are shares of their loop, so that a larger or smaller design is
//! even. Single edges of a match may be nearly of no length in one design and
//! mean nothing; the stretch is taken over windows that are long in at least
//! one of the two.

use super::distortion::{self, Distribution};
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;

/// A window's share of the loop in the source and in the target together.
/// Some two samples of an outline of 120 points.
const WINDOW: f64 = 0.03;

/// The boundary about one of its vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EdgeStretch {
    pub vertex: u32,
    /// Share of the target by share of the source: 1 is even.
    pub ratio: f64,
    /// The length of boundary that the vertex stands for, in the source.
    pub weight: f64,
}

impl EdgeStretch {
    /// max(k, 1/k).
    pub fn unevenness(&self) -> f64 {
        self.ratio.max(1.0 / self.ratio)
    }
}

/// The stretch about each vertex of each boundary loop.
pub(super) fn boundary(mesh: &CompatibleMesh) -> Vec<EdgeStretch> {
    let loops = mesh.boundary_loops();
    let of_loop = |walk: &Vec<u32>| {
        let [source, target] = [mesh.source(), mesh.target()].map(|points| lengths(walk, points));
        stretches(walk, &source, &target)
    };
    loops.iter().flat_map(of_loop).collect()
}

/// By length in the source; `None` without a boundary.
pub(super) fn distribution(mesh: &CompatibleMesh) -> Option<Distribution> {
    let weighted = boundary(mesh).into_iter();
    distortion::distribution(weighted.map(|s| (s.unevenness(), s.weight)).collect())
}

/// The length of each edge of a loop.
fn lengths(walk: &[u32], points: &[DVec2]) -> Vec<f64> {
    let next = walk.iter().cycle().skip(1);
    let length = |(&a, &b): (&u32, &u32)| points[a as usize].distance(points[b as usize]);
    walk.iter().zip(next).map(length).collect()
}

fn stretches(walk: &[u32], source: &[f64], target: &[f64]) -> Vec<EdgeStretch> {
    let n = walk.len();
    let (whole_source, whole_target) = (source.iter().sum::<f64>(), target.iter().sum::<f64>());
    let about = |i: usize| {
        // Grows by an edge to either side until it is long enough.
        let (mut in_source, mut in_target) = (0.0, 0.0);
        for k in 0..n.div_ceil(2) {
            let (after, before) = ((i + k) % n, (i + 2 * n - 1 - k) % n);
            in_source += (source[after] + source[before]) / whole_source;
            in_target += (target[after] + target[before]) / whole_target;
            // Long in one of the two is enough: else a squeezed stretch would be
            // averaged away with its neighbours.
            if in_source + in_target >= WINDOW {
                break;
            }
        }
        EdgeStretch {
            vertex: walk[i],
            ratio: in_target / in_source,
            weight: 0.5 * (source[i] + source[(i + n - 1) % n]),
        }
    };
    (0..n).map(about).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 40 edges a side, its lower side squeezed or not.
    fn mesh_with(bottom: impl Fn(f64) -> f64) -> CompatibleMesh {
        const N: u32 = 40;
        let point = |i: u32, j: u32| DVec2::new(f64::from(i) / f64::from(N), f64::from(j));
        let source: Vec<_> = (0..=1)
            .flat_map(|j| (0..=N).map(move |i| point(i, j)))
            .collect();
        let squeezed = |p: &DVec2| {
            if p.y == 0.0 {
                DVec2::new(bottom(p.x), 0.0)
            } else {
                *p
            }
        };
        let target = source.iter().map(squeezed).collect();
        let quad = |i: u32| [[i, i + 1, i + N + 2], [i, i + N + 2, i + N + 1]];
        let faces = (0..N).flat_map(quad).collect();
        CompatibleMesh::new(faces, source, target, vec![]).expect("valid")
    }

    #[test]
    fn an_even_boundary_is_even_at_any_scale() {
        let mesh = mesh_with(|x| x);
        let found = distribution(&mesh).expect("a boundary");
        assert!((found.worst - 1.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_squeezed_stretch_is_found_where_it_is() {
        // The left half of the lower side takes an eighth of it.
        let squeeze = |x: f64| {
            if x < 0.5 {
                x / 4.0
            } else {
                0.125 + (x - 0.5) * 1.75
            }
        };
        let mesh = mesh_with(squeeze);
        let worst = boundary(&mesh)
            .into_iter()
            .max_by(|a, b| a.unevenness().total_cmp(&b.unevenness()))
            .expect("a boundary");
        let at = mesh.source()[worst.vertex as usize];
        assert!(at.y == 0.0 && at.x < 0.5, "{at}");
        assert!((worst.ratio - 0.25).abs() < 0.02, "{worst:?}");
    }
}
