//! How long edges of outlines are on their way.
//!
//! An edge of an outline wants to turn evenly. Were it to grow evenly as well, a limb that
//! grows out of a side would open like a fan: halfway its edges have turned half of what
//! they turn, and are half as long as they will be. So halfway an edge is as long as the
//! film leaves it in the direction that it wants. The energy is lowered by the places of all
//! vertices and by these lengths in turns, as Sorkine and Alexa (2007) do with rotations;
//! each time with the matrix as it is. At other times [`ForceAssembly`] goes by a parabola that
//! is zero at both ends: the designs are met, and the film backwards is the film.

use super::evaluation_times::EvaluationTimes;
use super::forces::ForceAssembly;
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;
use crate::numerics::Cholesky;
use crate::warp::homotopy::Homotopy;
use crate::work::progress::{Cancelled, Progress, still_wanted};

/// How often places and lengths are found in turns. Of 60 pairs of outlines, turning beyond
/// the ends and area up and down are 0.140 and 0.116 in the worst tenth with none, 0.070 and
/// 0.013 by 5; by 10 turning is 0.045, and area 0.023.
const ROUNDS: u32 = 5;

/// Gives the edges of outlines, which are the elements of the film after the bars of the
/// mesh, the lengths that the film leaves them halfway.
pub(super) fn fit_halfway_lengths(
    stresses: &mut ForceAssembly,
    mesh: &CompatibleMesh,
    (cholesky, homotopy): (&Cholesky, Homotopy),
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    const HALFWAY: f64 = 0.5;
    let edges = mesh.elements().len()..stresses.elements().len();
    // The linear path deviates from no straight line, whatever is asked for.
    if edges.is_empty() || homotopy == Homotopy::Linear {
        return Ok(());
    }
    let place = cholesky.place_in_order();
    let mut memory = stresses.memory();
    let mut forces = vec![DVec2::ZERO; place.len()];
    let mut deviation = vec![0.0; 2 * place.len()];
    let mut workspace = cholesky.workspace(2);
    for _ in 0..ROUNDS {
        still_wanted(progress)?;
        let working = (&mut memory, &mut forces[..]);
        stresses.right_hand_sides(
            EvaluationTimes::Even(HALFWAY),
            place,
            working,
            &mut deviation,
        );
        cholesky.solve_ordered(&mut deviation, &mut workspace);
        let (x, y) = deviation.split_at(place.len());
        let at = |v: u32| {
            let v = v as usize;
            let at = place[v] as usize;
            mesh.source()[v].midpoint(mesh.target()[v]) + DVec2::new(x[at], y[at])
        };
        for edge in edges.clone() {
            let element = &stresses.elements()[edge];
            let even = element.even(homotopy, HALFWAY);
            let [from, to] = element.ends.map(at);
            let share = (to - from).dot(even) / even.length_squared();
            // Of an edge that vanishes on its way nothing is asked.
            let share = if share.is_nan() { 1.0 } else { share };
            stresses.set_halfway(edge, share);
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

    /// A bar, and one with a leg below, whose sides and foot lie along the bar's side.
    fn growing_leg() -> CompatibleMesh {
        let divided = |corners: &[DVec2]| -> Vec<DVec2> {
            let sides = corners.iter().zip(corners.iter().cycle().skip(1));
            let along =
                |(a, b): (&DVec2, &DVec2)| [0, 1, 2, 3].map(|k| a.lerp(*b, f64::from(k) / 4.0));
            sides.flat_map(along).collect()
        };
        let bar = |leg: [(f64, f64); 4]| {
            let corners = [
                &[(0.0, 0.0)][..],
                &leg,
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
    fn a_limb_that_grows_out_of_a_side_does_not_open_like_a_fan() {
        let mesh = growing_leg();
        let film = Arap::of_outlines(&mesh, &ArapOptions::default(), &[], &Silent).expect("a film");
        let outline = mesh.boundary_loops().remove(0);
        let mut placer = film.placer();
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
