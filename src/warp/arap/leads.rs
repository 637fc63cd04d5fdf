//! Faces along the outline that turn as their edge does.
//!
//! The rotation of a face is that of its best fit, which an edge of it follows
//! only where the face is not sheared: where it is, an outline that is smooth in
//! both designs is jagged between them. A face may turn by any angle φ = θ + δ
//! instead, M = R(φ) U with U = R(−δ) S, on the path R(tφ) ((1−t) I + t U). With
//! the angle by which its edge turns, U keeps the direction of that edge, which
//! then turns and grows evenly.
//!
//! Guaranteed for |δ| < π/2: no face turns over along its own path, since
//! tr U = cos δ tr S and det U = det S are positive; the way back is the way.

use super::assembly::FaceMap;
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;

/// For each face the angle by which its edges on the outline turn further than
/// it does itself, the mean of two by their lengths; 0 within.
pub(super) fn along_edges(mesh: &CompatibleMesh, faces: &[FaceMap]) -> Vec<f64> {
    let connectivity = mesh.connectivity();
    let lead = |(face, of): (usize, &FaceMap)| {
        let corners = mesh.faces()[face];
        let outer = (0..3).filter(|&k| connectivity.neighbour(face, k).is_none());
        let (mut turned, mut lengths) = (0.0, 0.0);
        for k in outer {
            let [a, b] = [corners[k], corners[(k + 1) % 3]].map(|v| v as usize);
            let edge = mesh.source()[b] - mesh.source()[a];
            let stretched: DVec2 = of.map.stretch * edge;
            // The same from the target: lengths of both designs count.
            let length = (edge.length() * stretched.length()).sqrt();
            turned += length * edge.perp_dot(stretched).atan2(edge.dot(stretched));
            lengths += length;
        }
        if lengths > 0.0 { turned / lengths } else { 0.0 }
    };
    faces.iter().enumerate().map(lead).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compatible::CompatibleMesh;
    use crate::geometry::{orient2d, turning, turning_excess};
    use crate::progress::Silent;
    use crate::warp::{Arap, ArapOptions, Warp};

    /// A round plate of so many points, and one whose outline is the same but was
    /// turned about the middle by an angle: every face is sheared.
    fn wrung(points: u32, by: f64) -> CompatibleMesh {
        let at = |k: u32, by: f64| {
            DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / f64::from(points) + by)
        };
        let ring = |radius: f64, by: f64| (0..points).map(move |k| at(k, by) * radius);
        let of = |by: f64| ring(0.6, 0.0).chain(ring(1.0, by)).collect::<Vec<_>>();
        let next = |k: u32| (k + 1) % points;
        let ring = (0..points).flat_map(|k| {
            let (a, b) = (k, next(k));
            [[a, a + points, b + points], [a, b + points, b]]
        });
        CompatibleMesh::new(ring.collect(), of(0.0), of(by), vec![]).expect("a mesh")
    }

    fn led(mesh: &CompatibleMesh) -> [Arap; 2] {
        let plain = Arap::of_outlines(mesh, &ArapOptions::default(), &[], &Silent).expect("a film");
        let led = plain.led(&plain.leads_along_edges());
        [plain, led]
    }

    #[test]
    fn an_outline_that_slides_past_its_inside_turns_as_it_should() {
        let mesh = wrung(24, 0.3);
        let films = led(&mesh);
        let excess = films.each_ref().map(|film| {
            let mut placer = film.placer();
            let turned = (0..=16).map(|k| {
                let t = f64::from(k) / 16.0;
                placer.place(t);
                let rings: Vec<Vec<DVec2>> = (mesh.boundary_loops().iter())
                    .map(|ring| {
                        ring.iter()
                            .map(|&v| placer.placement().in_frame[v as usize])
                            .collect()
                    })
                    .collect();
                [t, turning(&rings, 2.0)]
            });
            turning_excess(&turned.collect::<Vec<_>>())
        });
        assert!(excess[1] <= excess[0] + 1e-12, "{excess:?}");
        // Each outer edge turns as far as the outline does.
        let outer = films[1]
            .leads()
            .into_iter()
            .zip(films[1].face_angles())
            .step_by(2);
        for (lead, angle) in outer {
            assert!((lead + angle - 0.3).abs() < 1e-9, "{lead} {angle}");
        }
    }

    #[test]
    fn the_designs_are_met_and_the_way_back_is_the_way() {
        let mesh = wrung(9, 0.4);
        let [_, film] = led(&mesh);
        let back = film.swapped(&Silent).expect("a film");
        let [mut there, mut back] = [film.placer(), back.placer()];
        for (t, ends) in [(0.0, mesh.source()), (1.0, mesh.target())] {
            there.place(t);
            assert_eq!(there.placement().in_frame, ends);
        }
        for t in [-0.2, 0.1, 0.5, 0.9] {
            there.place(t);
            back.place(1.0 - t);
            let places = [&there, &back].map(|placer| &placer.placement().in_frame);
            for (p, q) in places[0].iter().zip(places[1]) {
                assert!(p.distance(*q) < 1e-12, "{p} {q} at {t}");
            }
            let faces = mesh.faces().iter();
            let is_positive = |face: &[u32; 3]| {
                let [a, b, c] = face.map(|v| places[0][v as usize]);
                orient2d(a, b, c) > 0.0
            };
            assert!(faces.clone().all(is_positive) || !(0.0..=1.0).contains(&t));
        }
    }

    #[test]
    fn what_is_not_sheared_is_not_led() {
        let mesh = wrung(9, 0.4);
        let turned = mesh
            .source()
            .iter()
            .map(|&p| DVec2::from_angle(2.0).rotate(p) * 3.0);
        let mesh = CompatibleMesh::new(
            mesh.faces().to_vec(),
            mesh.source().to_vec(),
            turned.collect(),
            vec![],
        )
        .expect("a mesh");
        let [plain, _] = led(&mesh);
        assert!(plain.leads_along_edges().iter().all(|by| by.abs() < 1e-12));
    }
}
