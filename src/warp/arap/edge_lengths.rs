//! Lengths of boundary-edge elements during the motion.
//!
//! A boundary-edge element rotates at constant speed. If its length also changed linearly, a limb
//! that grows out of a side would open like a fan: halfway, its edges have half of their rotation
//! and half of their final length. Instead, the length at t = ½ is free and minimises the energy.
//! Vertex positions and lengths are optimised alternately with the same matrix, like positions and
//! rotations in Sorkine and Alexa (2007). At other times [`ForceAssembly`] corrects the length by a
//! parabola in t that vanishes at t = 0 and t = 1, so that both designs are reproduced exactly and
//! the reversed motion is the same.

use super::evaluation_times::EvaluationTimes;
use super::forces::ForceAssembly;
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;
use crate::numerics::Cholesky;
use crate::warp::homotopy::Homotopy;
use crate::work::progress::{Cancelled, Progress, check_cancelled};

/// Number of times that first the vertex positions and then the lengths of the boundary edges are
/// optimised (heuristic).
const ROUNDS: u32 = 5;

/// Fits the lengths of all boundary edges at t = ½. The list of elements holds the bars of the mesh
/// first and then the boundary edges.
pub(super) fn fit_halfway_lengths(
    stresses: &mut ForceAssembly,
    mesh: &CompatibleMesh,
    cholesky: &Cholesky,
    homotopy: Homotopy,
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    /// Time at which the lengths are fitted.
    const HALFWAY: f64 = 0.5;
    let edges = mesh.elements().len()..stresses.elements().len();
    // The linear homotopy never deviates from straight paths, so lengths have no effect.
    if edges.is_empty() || homotopy == Homotopy::Linear {
        return Ok(());
    }
    let place = cholesky.elimination_places();
    let mut memory = stresses.memory();
    let mut forces = vec![DVec2::ZERO; place.len()];
    let mut deviation = vec![0.0; 2 * place.len()];
    let mut workspace = cholesky.workspace(2);
    for _ in 0..ROUNDS {
        check_cancelled(progress)?;
        let halfway = EvaluationTimes::Uniform(HALFWAY);
        stresses.right_hand_sides(halfway, place, &mut memory, &mut forces, &mut deviation);
        cholesky.solve_ordered(&mut deviation, &mut workspace);
        let (x, y) = deviation.split_at(place.len());
        let position = |v: u32| {
            let v = v as usize;
            let unknown = place[v] as usize;
            mesh.source()[v].midpoint(mesh.target()[v]) + DVec2::new(x[unknown], y[unknown])
        };
        for edge in edges.clone() {
            let element = &stresses.elements()[edge];
            let even = element.even_vector(homotopy, HALFWAY);
            let [from, to] = element.ends.map(position);
            // The optimal length is that of the current edge vector, projected onto the direction
            // that the edge should have.
            let ratio = (to - from).dot(even) / even.length_squared();
            // The ratio is NaN for an edge that vanishes halfway, whose length does not matter.
            let ratio = if ratio.is_nan() { 1.0 } else { ratio };
            stresses.set_halfway_length(edge, ratio);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compatible::PolygonOptions;
    use crate::geometry::{max_overshoot, signed_area, total_turning};
    use crate::warp::{Arap, ArapOptions, Warp};
    use crate::work::progress::Silent;

    /// Returns a compatible mesh whose source is a bar and whose target is a bar with a downward
    /// limb. In the source, the limb's outline lies along the bar's lower side.
    fn growing_limb() -> CompatibleMesh {
        let divided = |corners: &[DVec2]| -> Vec<DVec2> {
            let sides = corners.iter().zip(corners.iter().cycle().skip(1));
            let along =
                |(a, b): (&DVec2, &DVec2)| [0, 1, 2, 3].map(|k| a.lerp(*b, f64::from(k) / 4.0));
            sides.flat_map(along).collect()
        };
        let bar = |limb: [(f64, f64); 4]| {
            let corners = [
                &[(0.0, 0.0)][..],
                &limb,
                &[(6.0, 0.0), (6.0, 1.0), (0.0, 1.0)],
            ]
            .concat();
            divided(&corners.into_iter().map(DVec2::from).collect::<Vec<_>>())
        };
        let [a, b] = [
            bar([(2.0, 0.0), (2.9, 0.0), (3.1, 0.0), (4.0, 0.0)]),
            bar([(2.8, 0.0), (2.8, -3.0), (3.2, -3.0), (3.2, 0.0)]),
        ];
        CompatibleMesh::from_piece(&[a], &[b], &PolygonOptions::default(), &Silent).expect("a mesh")
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn a_limb_that_grows_out_of_a_side_does_not_open_like_a_fan() {
        let mesh = growing_limb();
        let arap =
            Arap::of_outlines(&mesh, &ArapOptions::default(), &[], &Silent).expect("a solution");
        let outline = mesh.boundary_loops().remove(0);
        let mut placer = arap.placer();
        let measured = (0..=16).map(|k| {
            let t = f64::from(k) / 16.0;
            placer.place(t);
            let places = &placer.placement().in_frame;
            let ring: Vec<DVec2> = outline.iter().map(|&v| places[v as usize]).collect();
            let area = signed_area(&ring);
            ([t, total_turning(&[ring], mesh.diameter())], [t, area])
        });
        let (turned, areas): (Vec<_>, Vec<_>) = measured.unzip();
        let [turning, swelling] = [turned, areas].map(|all| max_overshoot(&all));
        assert!(turning < 0.15 && swelling < 0.12, "{turning} {swelling}");
    }
}
