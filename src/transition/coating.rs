//! The coats of a film.

use super::drawings::Drawings;
use super::holes::HoleOf;
use super::levels::Levels;
use crate::content::{Coat, Coating};
use crate::correspondence::{Looks, RegionMatch};
use crate::geometry::Side;
use crate::warp::Arap;

/// The t at which parts change places that lie over each other otherwise at the
/// ends.
const REORDERED_AT: f64 = 0.5;

/// How a film is painted: a coat for each level. None of designs in one colour.
pub(super) fn coating(
    drawings: &Drawings,
    matched: &RegionMatch,
    film: &Arap,
    holes: &[HoleOf],
) -> Option<Coating> {
    if drawings.looks == Looks::default() {
        return None;
    }
    let levels = Levels::of(matched, &drawings.looks);
    let ink = |side: Side, coat: Option<usize>| coat.map(|coat| drawings.inks[side][coat]);
    let heights = Side::BOTH.map(|side| heights(&levels.coats, side));
    let coat = |level: usize| {
        let own = levels.coats[level];
        let inks = Side::BOTH.map(|side| ink(side, own[side]));
        // What one design has alone keeps its paint, while its line grows with it.
        let paints = [inks[0].or(inks[1]), inks[1].or(inks[0])];
        Coat {
            paints: paints.map(|ink| ink.and_then(|ink| ink.paint)),
            lines: inks.map(|ink| ink.and_then(|ink| ink.line)),
            heights: [heights[0][level], heights[1][level]],
        }
    };
    let parts = film.mesh().components();
    let walks = film.mesh().boundary_loops();
    let piece = |walk: &Vec<u32>| walk.first().map_or(0, |&v| parts[v as usize] as usize);
    Some(Coating {
        coats: (0..levels.coats.len()).map(coat).collect(),
        of_walks: walks
            .iter()
            .map(|walk| levels.of_piece(piece(walk)))
            .collect(),
        of_holes: holes
            .iter()
            .map(|(piece, _)| levels.of_piece(*piece))
            .collect(),
        reordered_at: REORDERED_AT,
    })
}

/// How many levels lie below each, in one design; one that it does not have lies
/// right above the one that is next below it in the other design.
fn heights(levels: &[[Option<usize>; 2]], side: Side) -> Vec<usize> {
    let other = side.other();
    let mut order: Vec<usize> = (0..levels.len())
        .filter(|&k| levels[k][side].is_some())
        .collect();
    order.sort_by_key(|&k| (levels[k][side], levels[k][other]));
    let mut alone: Vec<usize> = (0..levels.len())
        .filter(|&k| levels[k][side].is_none())
        .collect();
    alone.sort_by_key(|&k| levels[k][other]);
    for k in alone {
        let is_below = |&placed: &usize| levels[placed][other] < levels[k][other];
        let at = order.iter().rposition(is_below).map_or(0, |at| at + 1);
        order.insert(at, k);
    }
    let mut heights = vec![0; levels.len()];
    order
        .iter()
        .enumerate()
        .for_each(|(height, &k)| heights[k] = height);
    heights
}
