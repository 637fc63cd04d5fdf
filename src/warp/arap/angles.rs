//! Consistent rotation angles of all faces.
//!
//! A polar decomposition determines the angle θ only modulo 2π. The angles of two faces with a
//! shared edge differ by less than π, because a stretch rotates no vector by a right angle or more.
//! The angles are therefore chosen face by face: among the angles that differ by multiples of 2π, a
//! face takes the one nearest to the angle of its neighbour. The result does not depend on the
//! order of the faces, except for a whole number of turns that all faces of an edge-connected
//! component have in common.

use crate::mesh::Connectivity;
use std::collections::VecDeque;
use std::f64::consts::{PI, TAU};

/// Reason why the rotation angles of the faces cannot be chosen consistently.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AngleError {
    /// The angle changes by whole turns around a hole, so that no continuous choice exists. Holds
    /// the indices of two adjacent faces between which the angle jumps.
    #[error(
        "the rotation jumps between faces {} and {}, because the target winds around a hole of the source; cut the ring open there",
        .0[0] + 1, .0[1] + 1
    )]
    Winding([usize; 2]),
}

/// Returns `angle` plus the whole turns that bring it nearest to `reference`.
pub(super) fn nearest_branch(angle: f64, reference: f64) -> f64 {
    angle + TAU * ((reference - angle) / TAU).round()
}

/// Adds whole turns to `angles`, one angle per face, such that neighbouring faces differ by less
/// than π.
///
/// # Errors
/// [`AngleError::Winding`] if the angles wind around a hole.
pub(super) fn make_consistent(
    connectivity: &Connectivity,
    angles: &mut [f64],
) -> Result<(), AngleError> {
    let mut done = vec![false; angles.len()];
    let mut queue = VecDeque::new();
    for seed in 0..angles.len() {
        if std::mem::replace(&mut done[seed], true) {
            continue;
        }
        // The first face of a component keeps its angle; `choose_turns` adjusts the component
        // later.
        queue.push_back(seed);
        while let Some(face) = queue.pop_front() {
            for other in (0..3).filter_map(|k| connectivity.neighbour(face, k)) {
                if !std::mem::replace(&mut done[other], true) {
                    angles[other] = nearest_branch(angles[other], angles[face]);
                    queue.push_back(other);
                }
            }
        }
    }
    // The traversal fixes the edges of a spanning tree. A jump at any other edge means that the
    // angles wind around a hole.
    match first_jump(connectivity, angles) {
        Some(faces) => Err(AngleError::Winding(faces)),
        None => Ok(()),
    }
}

/// Returns the first pair of neighbouring faces whose angles differ by more than π.
fn first_jump(connectivity: &Connectivity, angles: &[f64]) -> Option<[usize; 2]> {
    (0..angles.len())
        .flat_map(|face| (0..3).map(move |k| (face, k)))
        .filter_map(|(face, k)| Some([face, connectivity.neighbour(face, k)?]))
        .find(|&[a, b]| (angles[a] - angles[b]).abs() > PI)
}

/// Chooses the whole turns of each edge-connected component of the faces. `part_of` holds the index
/// of each face's component.
///
/// The angles of a component are shifted by whole turns. The mean angle of the first component is
/// then in (−π, π]. The mean angles of the other components are nearest to `whole`, the best-fit
/// rotation of the design. Finally the `extra_turns` are added: one number for all components, or
/// one for each. Returns `whole` plus the whole turns that bring it nearest to the final mean angle
/// of the first component.
pub(super) fn choose_turns(
    angles: &mut [f64],
    areas: &[f64],
    part_of: &[u32],
    whole: f64,
    extra_turns: &[i32],
) -> f64 {
    let parts = part_of.iter().max().map_or(0, |&last| last as usize + 1);
    let mut sums = vec![(0.0, 0.0); parts];
    for ((&angle, &area), &part) in angles.iter().zip(areas).zip(part_of) {
        let sum = &mut sums[part as usize];
        *sum = (sum.0 + area * angle, sum.1 + area);
    }
    // Faces have positive area, so no component has an area of 0.
    let means: Vec<f64> = sums.iter().map(|(sum, area)| sum / area).collect();
    let first = means.first().map_or(whole, |&mean| {
        let reduced = nearest_branch(mean, 0.0);
        // Rounding may give −π, which would rotate in the opposite direction to π.
        if reduced <= -PI {
            reduced + TAU
        } else {
            reduced
        }
    });
    // The other components follow the whole design, which follows the first component. Otherwise
    // two components at +170° and −170° would rotate in opposite directions.
    let whole = nearest_branch(whole, first);
    let extra = |part: usize| match extra_turns {
        [all] => f64::from(*all),
        each => each.get(part).map_or(0.0, |&turns| f64::from(turns)),
    };
    let offsets: Vec<f64> = means
        .iter()
        .enumerate()
        .map(|(part, &mean)| {
            let chosen = if part == 0 {
                first
            } else {
                nearest_branch(mean, whole)
            };
            chosen - mean + TAU * extra(part)
        })
        .collect();
    for (angle, &part) in angles.iter_mut().zip(part_of) {
        // The offset is rounded to a multiple of 2π, so that equal angles stay equal.
        *angle += TAU * (offsets[part as usize] / TAU).round();
    }
    whole + TAU * extra(0)
}
