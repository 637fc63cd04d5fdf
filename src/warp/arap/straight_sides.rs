//! Straight sides: stretches of outline that are straight in both designs, and
//! stay so on the way.
//!
//! A vertex that lies at the same share between two others in both designs
//! lies there on the straight line between the designs too, so that only the
//! deviation U has to be held: |U_v − (1−s) U_a − s U_b|², at a price at which
//! nothing else has a say, is added to the energy. It is zero at both ends and
//! constant in t.

use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;
use crate::numerics::SymmetricMatrix;
use crate::warp::homotopy::Homotopy;

/// How much a vertex is held to its side, in units of what holds it to its
/// neighbours.
const STIFFNESS: f64 = 1e4;

/// The sine of a bend, and the difference of two shares, that are rounding.
/// Points are made along sides to the last digits; files have seven of them.
const STRAIGHT: f64 = 1e-6;

/// Whether a mesh is of drawn outlines, whose straight sides stay straight, or
/// is played as it was given: where it is stiff is said by weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum OutlineConstraints {
    Yes,
    #[default]
    No,
}

/// A vertex of a straight side.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SideVertex {
    vertex: u32,
    /// The ends of the side.
    ends: [u32; 2],
    /// How far it is from the first end, as a share of the side.
    share: f64,
}

impl OutlineConstraints {
    /// What is held along this homotopy: faces that are not to be sheared further
    /// fit together with sides that bend.
    pub(super) fn of(self, homotopy: Homotopy) -> Self {
        match homotopy {
            Homotopy::Bounded => Self::No,
            _ => self,
        }
    }

    /// Holds each vertex of a straight side to it, where that is asked for.
    pub(super) fn hold(
        self,
        mesh: &CompatibleMesh,
        diagonal: &[f64],
        matrix: &mut SymmetricMatrix,
    ) {
        if self == Self::Yes {
            hold(mesh, diagonal, matrix);
        }
    }
}

/// Holds each vertex of a straight side to it; `diagonal` is what holds each
/// to its neighbours.
fn hold(mesh: &CompatibleMesh, diagonal: &[f64], matrix: &mut SymmetricMatrix) {
    for SideVertex {
        vertex,
        ends: [a, b],
        share,
    } in on_sides(mesh)
    {
        let stiffness = STIFFNESS * diagonal[vertex as usize];
        let terms = [(vertex, 1.0), (a, share - 1.0), (b, -share)];
        for (k, &(i, by)) in terms.iter().enumerate() {
            for &(j, other) in &terms[..=k] {
                matrix.add(i, j, stiffness * by * other);
            }
        }
    }
}

fn on_sides(mesh: &CompatibleMesh) -> Vec<SideVertex> {
    let mut found = Vec::new();
    for walk in mesh.boundary_loops() {
        let n = walk.len();
        let is_end = |k: usize| !is_straight(mesh, [k + n - 1, k, k + 1].map(|k| walk[k % n]));
        let ends: Vec<usize> = (0..n).filter(|&k| is_end(k)).collect();
        for (k, &from) in ends.iter().enumerate() {
            let to = ends.get(k + 1).copied().unwrap_or(ends[0] + n);
            let [a, b] = [from, to].map(|k| walk[k % n]);
            found.extend((from + 1..to).map(|k| {
                let vertex = walk[k % n];
                let share = |points: &[DVec2]| {
                    let [p, a, b] = [vertex, a, b].map(|v| points[v as usize]);
                    p.distance(a) / b.distance(a)
                };
                SideVertex {
                    vertex,
                    ends: [a, b],
                    share: share(mesh.source()).midpoint(share(mesh.target())),
                }
            }));
        }
    }
    found
}

/// Whether the middle one of three vertices lies straight between the others,
/// at the same share in both designs.
fn is_straight(mesh: &CompatibleMesh, vertices: [u32; 3]) -> bool {
    let share = |points: &[DVec2]| {
        let [a, p, b] = vertices.map(|v| points[v as usize]);
        let (come, go) = (p - a, b - p);
        let (before, after) = (come.length(), go.length());
        let is_ahead = come.dot(go) > 0.0;
        let is_straight = is_ahead && come.perp_dot(go).abs() <= STRAIGHT * before * after;
        is_straight.then_some(before / (before + after))
    };
    match (share(mesh.source()), share(mesh.target())) {
        (Some(a), Some(b)) => (a - b).abs() <= STRAIGHT,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compatible::PolygonOptions;
    use crate::warp::{Arap, ArapOptions, Warp};
    use crate::work::progress::Silent;

    /// A bar whose upper side is divided in five, and one bent at its middle
    /// below that side.
    fn bent() -> CompatibleMesh {
        let upper = |from: DVec2, to: DVec2| (0..5).map(move |k| from.lerp(to, f64::from(k) / 5.0));
        let ring = |middle: DVec2, left: DVec2, right: DVec2| -> Vec<DVec2> {
            let below = [left - DVec2::Y, middle, right - DVec2::Y];
            below.into_iter().chain(upper(right, left)).collect()
        };
        let [a, b] = [
            ring(DVec2::new(3.0, -1.0), DVec2::ZERO, DVec2::new(6.0, 0.0)),
            ring(DVec2::new(1.0, -3.0), DVec2::ZERO, DVec2::new(4.0, 4.0)),
        ];
        CompatibleMesh::from_piece(&[a], &[b], &PolygonOptions::default(), &Silent).expect("a mesh")
    }

    /// How far the upper side, vertices 3 to 7, is from straight halfway, as a share of it.
    fn off(arap: &Arap) -> f64 {
        let mut placer = arap.placer();
        placer.place(0.5);
        let at = &placer.placement().in_frame;
        let along = at[7] - at[3];
        let off = |p: &DVec2| (along.perp_dot(*p - at[3]) / along.length_squared()).abs();
        at[4..7].iter().map(off).fold(0.0, f64::max)
    }

    #[test]
    fn the_vertices_of_a_side_are_found() {
        let found = on_sides(&bent());
        let vertices: Vec<u32> = found.iter().map(|on| on.vertex).collect();
        assert_eq!(vertices, [4, 5, 6], "{found:?}");
    }

    #[test]
    fn a_straight_side_stays_straight() {
        let (mesh, options) = (bent(), ArapOptions::default());
        let free = Arap::build(&mesh, &options, &Silent).expect("a film");
        let held = Arap::of_outlines(&mesh, &options, &[], &Silent).expect("a film");
        assert!(off(&held) < 1e-3, "{}", off(&held));
        assert!(off(&free) > 5.0 * off(&held), "{} free", off(&free));
    }
}
