//! Which pieces of a film are in each other's way, and which of them to let
//! go so that the others are not.
//!
//! Looked at at a few steps: what is crossed between two is missed. The
//! pieces let go are a cover of the pairs in conflict, found by taking the one
//! with the most conflicts for its area first (the greedy cover of Chvátal
//! 1979): small, not the smallest.

use super::transients::boundary_loops::SharedPartLoops;
use super::transients::holes::PieceHole;
use super::transients::layers::PieceLayers;
use crate::correspondence::{PieceMatch, RegionMatch};
use crate::geometry::{Side, crossings, signed_area};
use crate::warp::{Arap, Warp};
use crate::work::progress::{Cancelled, Progress, still_wanted};
use std::collections::BTreeSet;

/// Steps of a film that is looked at.
const STEPS: u32 = 32;

/// The pieces to let go; none where no two parts of both designs meet that are on
/// one level.
pub(super) fn pieces_to_release(
    matched: &RegionMatch,
    film: &Arap,
    (holes, levels): (&[PieceHole], &PieceLayers),
    progress: &dyn Progress,
) -> Result<Vec<usize>, Cancelled> {
    let mut conflicts = conflicts(film, holes, progress)?;
    conflicts.retain(|pair| levels.of_piece(pair[0]) == levels.of_piece(pair[1]));
    Ok(cover(conflicts, &piece_weights(matched)))
}

/// The pairs of pieces that cross at any step, those that are born or die
/// left out: where these are is not settled yet.
fn conflicts(
    film: &Arap,
    holes: &[PieceHole],
    progress: &dyn Progress,
) -> Result<BTreeSet<[usize; 2]>, Cancelled> {
    let walks = SharedPartLoops::of(film);
    let mut placer = film.placer();
    let mut found = BTreeSet::new();
    for step in 1..STEPS {
        still_wanted(progress)?;
        let t = f64::from(step) / f64::from(STEPS);
        placer.place(t);
        let places = &placer.placement().in_frame;
        let (mut rings, mut pieces) = (walks.rings(places), walks.pieces().to_vec());
        for (piece, hole) in holes {
            if let Some(ring) = hole.at(places, t) {
                rings.push(ring);
                pieces.push(*piece);
            }
        }
        for crossing in crossings(&rings) {
            let [a, b] = crossing.edges.map(|edge| pieces[edge.ring]);
            if a != b {
                found.insert([a.min(b), a.max(b)]);
            }
        }
    }
    Ok(found)
}

/// What each piece is worth: the mean of both designs' shares of what the
/// outer rings enclose. A badge is worth as much as what it goes around, which
/// can grow in it while it cannot grow around that.
pub(super) fn piece_weights(matched: &RegionMatch) -> Vec<f64> {
    let shares = |side: Side| -> Vec<f64> {
        let outer = |piece: &PieceMatch| {
            let ring = piece.rings.first();
            ring.map_or(0.0, |r| signed_area([&r.source, &r.target][side]))
        };
        let areas: Vec<f64> = matched.pieces.iter().map(outer).collect();
        let total: f64 = areas.iter().sum();
        areas.into_iter().map(|area| area / total).collect()
    };
    let [a, b] = Side::BOTH.map(shares);
    a.iter().zip(&b).map(|(a, b)| 0.5 * (a + b)).collect()
}

/// Pieces without which no conflict is left, ascending.
fn cover(mut conflicts: BTreeSet<[usize; 2]>, worths: &[f64]) -> Vec<usize> {
    let mut gone = Vec::new();
    while !conflicts.is_empty() {
        let worth = |k: usize| {
            let count = conflicts.iter().filter(|pair| pair.contains(&k)).count();
            count as f64 / worths[k]
        };
        let members: BTreeSet<usize> = conflicts.iter().flatten().copied().collect();
        let Some(worst) = members
            .into_iter()
            .reduce(|a, b| if worth(b) > worth(a) { b } else { a })
        else {
            break;
        };
        conflicts.retain(|pair| !pair.contains(&worst));
        gone.push(worst);
    }
    gone.sort_unstable();
    gone
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_small_one_that_meets_many_goes_before_the_large_ones() {
        let conflicts = BTreeSet::from([[0, 2], [1, 2], [0, 3]]);
        assert_eq!(cover(conflicts, &[0.4, 0.4, 0.1, 0.1]), [2, 3]);
        assert_eq!(cover(BTreeSet::new(), &[]), Vec::<usize>::new());
    }
}
