//! Constraints that keep a side straight during the motion if it is straight in both designs.
//!
//! If a vertex v divides a side from vertex a to vertex b in the same ratio s in both designs, it
//! also does so while all three move on straight paths. It is therefore enough to constrain the
//! deviation U from these paths: the energy is augmented by |U_v − (1−s) U_a − s U_b|² with a large
//! stiffness. This term is zero at both ends of the motion, and its matrix does not depend on t.

use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;
use crate::numerics::SymmetricMatrix;
use crate::warp::homotopy::Homotopy;

/// Factor of the energy term that keeps a vertex on its straight side, relative to the vertex's
/// diagonal entry of the stiffness matrix K (tolerance: large enough to dominate, small enough for
/// an accurate factorisation).
const STIFFNESS: f64 = 1e4;

/// Maximum sine of the turning angle at a vertex inside a straight side. Also the maximum
/// difference between the two designs in the ratio in which the vertex divides the line segment
/// between its neighbours (tolerance: coordinates in files have about seven digits).
const STRAIGHT: f64 = 1e-6;

/// Whether a mesh has the constraints of drawn outlines.
///
/// With `On`, straight sides stay straight and the energy has a term for each boundary edge. With
/// `Off`, the mesh is interpolated as given and only its weights determine its stiffness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum OutlineConstraints {
    On,
    #[default]
    Off,
}

/// A vertex inside a straight side.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SideVertex {
    vertex: u32,
    /// Vertices at both ends of the side.
    ends: [u32; 2],
    /// Distance from the first end as a fraction of the side's length.
    share: f64,
}

impl OutlineConstraints {
    /// Returns the constraints for a homotopy.
    ///
    /// With bounded distortion there are no constraints, because faces whose shear is limited fit
    /// together only if the sides may bend.
    pub(super) fn for_homotopy(self, homotopy: Homotopy) -> Self {
        match homotopy {
            Homotopy::Bounded => Self::Off,
            _ => self,
        }
    }

    /// Adds the constraints to `matrix`, if they are enabled. `diagonal` is the diagonal of the
    /// stiffness matrix K of the energy.
    pub(super) fn add_to_matrix(
        self,
        mesh: &CompatibleMesh,
        diagonal: &[f64],
        matrix: &mut SymmetricMatrix,
    ) {
        if self == Self::On {
            add_constraints(mesh, diagonal, matrix);
        }
    }
}

/// Adds the constraint of each vertex inside a straight side, with a stiffness relative to the
/// vertex's diagonal entry.
fn add_constraints(mesh: &CompatibleMesh, diagonal: &[f64], matrix: &mut SymmetricMatrix) {
    for SideVertex {
        vertex,
        ends: [a, b],
        share,
    } in vertices_on_sides(mesh)
    {
        let stiffness = STIFFNESS * diagonal[vertex as usize];
        let terms = [(vertex, 1.0), (a, share - 1.0), (b, -share)];
        for (k, &(i, factor)) in terms.iter().enumerate() {
            for &(j, other) in &terms[..=k] {
                matrix.add(i, j, stiffness * factor * other);
            }
        }
    }
}

/// Returns all vertices inside straight sides of the boundary.
fn vertices_on_sides(mesh: &CompatibleMesh) -> Vec<SideVertex> {
    let mut side_vertices = Vec::new();
    for outline in mesh.boundary_loops() {
        let n = outline.len();
        let is_end = |k: usize| !is_straight(mesh, [k + n - 1, k, k + 1].map(|k| outline[k % n]));
        let ends: Vec<usize> = (0..n).filter(|&k| is_end(k)).collect();
        for (k, &from) in ends.iter().enumerate() {
            let to = ends.get(k + 1).copied().unwrap_or(ends[0] + n);
            let [a, b] = [from, to].map(|k| outline[k % n]);
            side_vertices.extend((from + 1..to).map(|k| {
                let vertex = outline[k % n];
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
    side_vertices
}

/// Returns whether the middle one of three vertices lies on the line segment between the other two,
/// in both designs, and divides that line segment in the same ratio.
fn is_straight(mesh: &CompatibleMesh, vertices: [u32; 3]) -> bool {
    let share = |points: &[DVec2]| {
        let [a, p, b] = vertices.map(|v| points[v as usize]);
        let (incoming, outgoing) = (p - a, b - p);
        let (before, after) = (incoming.length(), outgoing.length());
        let is_ahead = incoming.dot(outgoing) > 0.0;
        let is_straight =
            is_ahead && incoming.perp_dot(outgoing).abs() <= STRAIGHT * before * after;
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

    /// Returns a mesh from a straight bar to a bent one; the upper side stays straight and has five
    /// edges.
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

    /// Evaluates the motion at t = ½. Returns the largest distance of vertices 4 to 6 from the line
    /// through vertices 3 and 7, relative to the distance between those two.
    fn deviation(arap: &Arap) -> f64 {
        let mut placer = arap.placer();
        placer.place(0.5);
        let at = &placer.placement().in_frame;
        let along = at[7] - at[3];
        let distance = |p: &DVec2| (along.perp_dot(*p - at[3]) / along.length_squared()).abs();
        at[4..7].iter().map(distance).fold(0.0, f64::max)
    }

    #[test]
    fn the_inner_vertices_of_a_straight_side_are_detected() {
        let side_vertices = vertices_on_sides(&bent());
        let vertices: Vec<u32> = side_vertices.iter().map(|side| side.vertex).collect();
        assert_eq!(vertices, [4, 5, 6], "{side_vertices:?}");
    }

    #[test]
    fn a_straight_side_stays_straight() {
        let (mesh, options) = (bent(), ArapOptions::default());
        let free = Arap::build(&mesh, &options, &Silent).expect("a solution");
        let constrained = Arap::of_outlines(&mesh, &options, &[], &Silent).expect("a solution");
        let [free, constrained] = [&free, &constrained].map(deviation);
        assert!(constrained < 1e-3, "{constrained}");
        assert!(free > 5.0 * constrained, "{free} free");
    }
}
