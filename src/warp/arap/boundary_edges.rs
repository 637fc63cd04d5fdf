//! Boundary edges as additional elements of the energy.
//!
//! Faces along an outline that are sheared differently rotate its edges to incompatible directions,
//! so that an outline that is smooth in both designs becomes jagged in between. To prevent this,
//! each boundary edge is an element with the energy k |Δv − e(t)|², where Δv is the vector between
//! its ends and e(t) the vector that it should have. The vector e(t) rotates at constant speed from
//! the edge's vector in the source to its vector in the target. The possible rotation angles differ
//! by full turns; the one within 90° of the rotation angle of the edge's face is taken. The length
//! of e(t) comes from `edge_lengths`.
//!
//! The angle between the vectors e(t) of two edges thus changes linearly from source to target, so
//! that the total turning of the outline does not exceed that of the designs.
//!
//! The stiffness k is proportional to 1/length, so that the sum over all edges approximates an
//! integral along the outline, independent of its subdivision. The stiffness k is also proportional
//! to the diameter of the part, which makes the result independent of scale. In the symmetric
//! energy, k is averaged over both designs, so that the reversed motion is the same.

use super::assembly::{ElementMap, FaceMap, LocalMaps};
use super::options::ArapOptions;
use super::straight_sides::OutlineConstraints;
use super::time_window::TimeWindow;
use crate::compatible::CompatibleMesh;
use crate::geometry::{Bounds, DVec2};

/// Stiffness of a boundary edge that is as long as the diameter of its part (heuristic). The
/// stiffness is the factor, in the energy, of the squared difference between the edge's vector and
/// the vector that it should have.
const STIFFNESS: f64 = 0.12;

/// Maximum stiffness of a boundary edge. It limits the effect of extremely short edges, whose
/// directions are dominated by rounding (tolerance).
const MAX_STIFFNESS: f64 = 1e4;

impl LocalMaps {
    /// Appends the boundary edges to `elements`, which so far holds the bars, if `constraints` is
    /// `On` and the homotopy of `options` is not the one with bounded distortion.
    pub(super) fn with_boundary_edges(
        mut self,
        mesh: &CompatibleMesh,
        time_windows: &[Option<TimeWindow>],
        options: &ArapOptions,
        constraints: OutlineConstraints,
    ) -> Self {
        if constraints.for_homotopy(options.homotopy) == OutlineConstraints::On {
            let edges = edges(mesh, &self.faces, time_windows, options.symmetric);
            self.elements.extend(edges);
        }
        self
    }
}

/// Returns one energy term for each boundary edge of the mesh, except for the edges of parts that
/// exist in only one design. These are the parts for which `time_windows` holds a time window.
fn edges(
    mesh: &CompatibleMesh,
    faces: &[FaceMap],
    time_windows: &[Option<TimeWindow>],
    symmetric: bool,
) -> Vec<ElementMap> {
    let connectivity = mesh.connectivity();
    let parts = mesh.components();
    let diameters = diameters(mesh, &parts);
    let mut edges = Vec::new();
    for (face, &corners) in mesh.faces().iter().enumerate() {
        let part = parts[corners[0] as usize] as usize;
        if time_windows.get(part).is_some_and(Option::is_some) {
            continue;
        }
        let outer = (0..3).filter(|&k| connectivity.neighbour(face, k).is_none());
        edges.extend(outer.map(|k| {
            let ends = [corners[k], corners[(k + 1) % 3]];
            edge(mesh, ends, &faces[face], diameters[part], symmetric)
        }));
    }
    edges
}

/// Returns the energy term of one boundary edge of a face. `diameters` holds the diameters of the
/// face's part in source and target.
fn edge(
    mesh: &CompatibleMesh,
    ends: [u32; 2],
    face: &FaceMap,
    diameters: [f64; 2],
    symmetric: bool,
) -> ElementMap {
    let [p, q] = [mesh.source(), mesh.target()].map(|at| {
        let [a, b] = ends.map(|v| at[v as usize]);
        b - a
    });
    let stretched: DVec2 = face.map.stretch * p;
    let [source, target] = [(p, diameters[0]), (q, diameters[1])]
        .map(|(edge, diameter)| (STIFFNESS * diameter / edge.length()).min(MAX_STIFFNESS));
    ElementMap {
        ends,
        vector: p,
        angle: face.map.angle + p.perp_dot(stretched).atan2(p.dot(stretched)),
        stretch: (q.length_squared() / p.length_squared()).sqrt(),
        stiffness: match symmetric {
            true => 0.5 * (source + target),
            false => source,
        },
    }
}

/// Returns, for each connected part, the diameter of its bounding box in source and in target.
fn diameters(mesh: &CompatibleMesh, parts: &[u32]) -> Vec<[f64; 2]> {
    let count = parts.iter().max().map_or(0, |&last| last as usize + 1);
    let mut bounds = vec![[None; 2]; count];
    for (v, &part) in parts.iter().enumerate() {
        let positions = [mesh.source()[v], mesh.target()[v]];
        for (bounds, position) in bounds[part as usize].iter_mut().zip(positions) {
            let point = Bounds::at(position);
            *bounds = Some(bounds.map_or(point, |all: Bounds| all.union(&point)));
        }
    }
    let diameter = |bounds: Option<Bounds>| bounds.map_or(0.0, |bounds| bounds.diameter());
    let parts = bounds.into_iter();
    parts.map(|sides| sides.map(diameter)).collect()
}

#[cfg(test)]
mod tests {
    use crate::compatible::CompatibleMesh;
    use crate::geometry::{DVec2, max_overshoot, orient2d, total_turning};
    use crate::warp::{Arap, ArapOptions, Warp};
    use crate::work::progress::Silent;
    use std::f64::consts::TAU;

    /// Returns a compatible mesh whose source is a disc with a wavy upper half and whose target is
    /// a disc with a wavy lower half.
    ///
    /// The outline has `points` vertices and the interior a parallel ring and a centre.
    fn waves(points: u32) -> CompatibleMesh {
        let at = |k: u32, wavy: f64| {
            let angle = f64::from(k % points) * TAU / f64::from(points);
            let place = DVec2::from_angle(angle);
            place * (1.0 + 0.2 * (9.0 * angle).sin() * (wavy * place.y).max(0.0))
        };
        let vertices = |wavy: f64| {
            let ring = |size: f64| (0..points).map(move |k| at(k, wavy) * size);
            ring(0.8).chain(ring(1.0)).chain([DVec2::ZERO]).collect()
        };
        let faces = (0..points).flat_map(|k| {
            let next = (k + 1) % points;
            let [a, b, c, d] = [k, next, k + points, next + points];
            [[2 * points, a, b], [a, c, d], [a, d, b]]
        });
        let (source, target) = (vertices(1.0), vertices(-1.0));
        CompatibleMesh::new(faces.collect(), source, target, vec![]).expect("a mesh")
    }

    /// Builds the interpolation of outlines, whose energy has a term for each boundary edge.
    fn with_edges(mesh: &CompatibleMesh, subdivisions: u32) -> Arap {
        let options = ArapOptions {
            subdivisions,
            ..ArapOptions::default()
        };
        Arap::of_outlines(mesh, &options, &[], &Silent).expect("a solution")
    }

    fn positions(arap: &Arap, t: f64) -> Vec<DVec2> {
        let mut placer = arap.placer();
        placer.place(t);
        placer.placement().in_frame.clone()
    }

    /// Returns the largest fraction by which the outline's total turning exceeds the linear
    /// interpolation between its values at t = 0 and t = 1.
    fn overshoot(arap: &Arap) -> f64 {
        let outlines = arap.mesh().boundary_loops();
        let samples = (0..=16).map(|k| {
            let t = f64::from(k) / 16.0;
            let positions = positions(arap, t);
            let ring = |ring: &Vec<u32>| ring.iter().map(|&v| positions[v as usize]).collect();
            let rings: Vec<Vec<DVec2>> = outlines.iter().map(ring).collect();
            [t, total_turning(&rings, 2.4)]
        });
        max_overshoot(&samples.collect::<Vec<_>>())
    }

    #[test]
    fn boundary_edges_keep_a_circle_rounder_than_faces_alone() {
        // Every third vertex slides along the circle, which shears all faces.
        let mesh = waves(90);
        let round = |slid: f64| -> Vec<DVec2> {
            let at = |k: u32| {
                let offset = if k.is_multiple_of(3) { slid } else { 0.0 };
                DVec2::from_angle((f64::from(k) + offset) * TAU / 90.0)
            };
            let inner = (0..90).map(|k| at(k) * 0.95);
            let inner: Vec<DVec2> = inner.collect();
            let outer = (0..90).map(at);
            inner
                .into_iter()
                .chain(outer)
                .chain([DVec2::ZERO])
                .collect()
        };
        let still = round(0.0)[..90].to_vec();
        let slid = round(0.8)[90..].to_vec();
        let target = [still, slid].concat();
        let mesh = CompatibleMesh::new(mesh.faces().to_vec(), round(0.0), target, vec![]);
        let mesh = mesh.expect("a mesh");
        let plain = Arap::build(&mesh, &ArapOptions::default(), &Silent).expect("a solution");
        let [with_edges, plain] = [&with_edges(&mesh, 0), &plain].map(overshoot);
        assert!(with_edges < 0.5 * plain, "{with_edges} {plain}");
    }

    #[test]
    fn the_ends_are_exact_and_exchanged_designs_reverse_the_motion() {
        let mesh = waves(60);
        let arap = with_edges(&mesh, 0);
        let back = arap.swapped(&Silent).expect("a solution");
        assert_eq!(positions(&arap, 0.0), mesh.source());
        assert_eq!(positions(&arap, 1.0), mesh.target());
        for t in [-0.2, 0.1, 0.5, 0.9] {
            let [forward, backward] = [positions(&arap, t), positions(&back, 1.0 - t)];
            for (p, q) in forward.iter().zip(&backward) {
                assert!(p.distance(*q) < 1e-12, "{p} {q} at {t}");
            }
            let is_positive = |face: &[u32; 3]| {
                let [a, b, c] = face.map(|v| forward[v as usize]);
                orient2d(a, b, c) > 0.0
            };
            assert!(mesh.faces().iter().all(is_positive) || !(0.0..=1.0).contains(&t));
        }
    }

    #[test]
    fn the_motion_is_independent_of_scale_and_nearly_of_subdivision() {
        let mesh = waves(60);
        let arap = with_edges(&mesh, 0);
        let enlarged = |at: &[DVec2]| at.iter().map(|&p| p * 1000.0).collect();
        let large = CompatibleMesh::new(
            mesh.faces().to_vec(),
            enlarged(mesh.source()),
            enlarged(mesh.target()),
            vec![],
        );
        let [original, scaled, divided] = [
            &arap,
            &with_edges(&large.expect("a mesh"), 0),
            &with_edges(&mesh, 2),
        ]
        .map(|arap| positions(arap, 0.4));
        for (v, p) in original.iter().enumerate() {
            assert!(p.distance(scaled[v] / 1000.0) < 1e-9);
            // The tolerance is a fiftieth of the wave's height.
            assert!(p.distance(divided[v]) < 4e-3, "{p} {}", divided[v]);
        }
    }
}
