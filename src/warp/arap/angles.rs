//! One consistent rotation angle for each face.
//!
//! A polar decomposition gives θ modulo 2π only. Across a shared edge the two
//! angles truly differ by less than π, since a stretch turns no vector by a
//! right angle; so walking from face to face and taking the representative
//! nearest to the neighbour's gives one answer, whatever the order. What
//! stays free is a whole number of turns for each part (a dual component).

use crate::mesh::Connectivity;
use std::collections::VecDeque;
use std::f64::consts::{PI, TAU};

/// Angles that do not fit together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AngleError {
    /// Around some hole the angles add up to whole turns, so that no
    /// continuous choice exists.
    #[error(
        "between faces {} and {} the rotation jumps: the target is wound around a hole of the source; cut the ring open there",
        .0[0] + 1, .0[1] + 1
    )]
    Winding([usize; 2]),
}

/// `angle` plus the whole turns that bring it nearest to `reference`.
pub(super) fn nearest_branch(angle: f64, reference: f64) -> f64 {
    angle + TAU * ((reference - angle) / TAU).round()
}

/// Adds whole turns to `angles`, one a face, until neighbours agree.
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
        // A new part starts with whatever turn it has; `choose_turns` decides.
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
    // The walk meets each edge of a tree; the edges that close a loop tell
    // whether the angles wind around it.
    match first_jump(connectivity, angles) {
        Some(faces) => Err(AngleError::Winding(faces)),
        None => Ok(()),
    }
}

fn first_jump(connectivity: &Connectivity, angles: &[f64]) -> Option<[usize; 2]> {
    (0..angles.len())
        .flat_map(|face| (0..3).map(move |k| (face, k)))
        .filter_map(|(face, k)| Some([face, connectivity.neighbour(face, k)?]))
        .find(|&[a, b]| (angles[a] - angles[b]).abs() > PI)
}

/// Chooses the turns of each part: the first with its mean angle in (−π, π],
/// the others nearest to the best-fit rotation `whole` of the design. Returns
/// `whole` on the branch that goes with the first part.
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
    // Faces are positive, so that no part has an area of 0.
    let means: Vec<f64> = sums.iter().map(|(sum, area)| sum / area).collect();
    let first = means.first().map_or(whole, |&mean| {
        let reduced = nearest_branch(mean, 0.0);
        // `round` may leave −π, whose film would go the other way than that of π.
        if reduced <= -PI {
            reduced + TAU
        } else {
            reduced
        }
    });
    // The first part is on its own branch; the others follow it by way of the
    // whole, or a part of ±170° would go around the other way than its fellow.
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
        // Whole turns exactly, so that equal angles stay equal.
        *angle += TAU * (offsets[part as usize] / TAU).round();
    }
    whole + TAU * extra(0)
}
