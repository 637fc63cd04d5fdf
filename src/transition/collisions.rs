//! Finds the matched pieces that collide during the motion, and a small set of pieces whose removal
//! resolves all collisions.
//!
//! The motion is sampled at a few times; collisions between two samples are missed. The set is a
//! vertex cover of the colliding pairs. It is found greedily, starting with the piece that has the
//! most collisions per area (Chvátal 1979). The set is small, but not always the smallest possible.

use super::transients::boundary_loops::SharedPartLoops;
use super::transients::holes::PieceHole;
use super::transients::layers::PieceLayers;
use crate::correspondence::{PieceMatch, RegionMatch};
use crate::geometry::{Side, crossings, signed_area};
use crate::warp::{Arap, Warp};
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use std::collections::BTreeSet;

/// Number of equal steps of t into which the motion is divided to detect collisions (resource
/// limit).
const STEPS: u32 = 32;

/// Returns the indices of the pieces to unpair, in ascending order; empty if no matched pieces of
/// the same layer collide.
///
/// # Errors
/// [`Cancelled`] if the work is cancelled.
pub(super) fn pieces_to_release(
    matched: &RegionMatch,
    motion: &Arap,
    holes: &[PieceHole],
    layers: &PieceLayers,
    progress: &dyn Progress,
) -> Result<Vec<usize>, Cancelled> {
    let mut conflicts = conflicts(motion, holes, progress)?;
    conflicts.retain(|pair| layers.of_piece(pair[0]) == layers.of_piece(pair[1]));
    Ok(cover(conflicts, &piece_weights(matched)))
}

/// Returns the pairs of matched pieces whose outlines cross at a sampled time. Unmatched pieces are
/// not examined, because they are placed later.
///
/// # Errors
/// [`Cancelled`] if the work is cancelled.
fn conflicts(
    motion: &Arap,
    holes: &[PieceHole],
    progress: &dyn Progress,
) -> Result<BTreeSet<[usize; 2]>, Cancelled> {
    let loops = SharedPartLoops::of(motion);
    let mut placer = motion.placer();
    let mut pairs = BTreeSet::new();
    for step in 1..STEPS {
        check_cancelled(progress)?;
        let t = f64::from(step) / f64::from(STEPS);
        placer.place(t);
        let positions = &placer.placement().in_frame;
        let (mut rings, mut pieces) = (loops.rings(positions), loops.pieces().to_vec());
        for (piece, hole) in holes {
            if let Some(ring) = hole.ring_at(positions, t) {
                rings.push(ring);
                pieces.push(*piece);
            }
        }
        for crossing in crossings(&rings) {
            let [a, b] = crossing.edges.map(|edge| pieces[edge.ring]);
            if a != b {
                pairs.insert([a.min(b), a.max(b)]);
            }
        }
    }
    Ok(pairs)
}

/// Returns the weight of each piece: the area that its outer ring encloses, as a fraction of the
/// sum over all pieces, averaged over both designs. The area inside holes is included, so that
/// large rings stay matched: a piece can appear inside a ring, but a ring cannot appear around
/// other pieces.
pub(super) fn piece_weights(matched: &RegionMatch) -> Vec<f64> {
    let shares_in = |side: Side| -> Vec<f64> {
        let enclosed_area = |piece: &PieceMatch| {
            let ring = piece.rings.first();
            ring.map_or(0.0, |r| signed_area([&r.source, &r.target][side]))
        };
        let areas: Vec<f64> = matched.pieces.iter().map(enclosed_area).collect();
        let total: f64 = areas.iter().sum();
        areas.into_iter().map(|area| area / total).collect()
    };
    let [a, b] = Side::BOTH.map(shares_in);
    a.iter().zip(&b).map(|(a, b)| 0.5 * (a + b)).collect()
}

/// Returns the indices, in ascending order, of pieces whose removal resolves all `conflicts`, the
/// pairs of colliding pieces.
fn cover(mut conflicts: BTreeSet<[usize; 2]>, weights: &[f64]) -> Vec<usize> {
    let mut removed = Vec::new();
    while !conflicts.is_empty() {
        let conflicts_per_weight = |k: usize| {
            let count = conflicts.iter().filter(|pair| pair.contains(&k)).count();
            count as f64 / weights[k]
        };
        let pieces: BTreeSet<usize> = conflicts.iter().flatten().copied().collect();
        let Some(next_piece) = pieces.into_iter().reduce(|a, b| {
            if conflicts_per_weight(b) > conflicts_per_weight(a) {
                b
            } else {
                a
            }
        }) else {
            break;
        };
        conflicts.retain(|pair| !pair.contains(&next_piece));
        removed.push(next_piece);
    }
    removed.sort_unstable();
    removed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_piece_with_many_conflicts_is_removed_before_large_ones() {
        let conflicts = BTreeSet::from([[0, 2], [1, 2], [0, 3]]);
        assert_eq!(cover(conflicts, &[0.4, 0.4, 0.1, 0.1]), [2, 3]);
        assert_eq!(cover(BTreeSet::new(), &[]), Vec::<usize>::new());
    }
}
