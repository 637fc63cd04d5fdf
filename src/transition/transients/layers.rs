//! Layers of pieces: pieces on the same layer must not collide, because they are painted alike.

use crate::correspondence::{PartAppearances, PieceMatch, RegionMatch};
use crate::geometry::Side;
use std::collections::BTreeMap;

/// Layers of the pieces of a match. A layer is a pair of paint layers, one of the source and one of
/// the target. Pieces on the same layer must not collide; pieces on different layers pass over or
/// under each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::transition) struct PieceLayers {
    /// For each piece, the index of its layer.
    of_pieces: Vec<usize>,
    /// For each layer, the indices of its paint layers in source and target; `None` if there is
    /// none.
    pub(in crate::transition) layers: Vec<[Option<usize>; 2]>,
}

impl PieceLayers {
    pub(in crate::transition) fn of(matched: &RegionMatch, looks: &PartAppearances) -> Self {
        let parts = |piece: &PieceMatch| [piece.source_part, piece.target_part];
        Self::of_parts(matched.pieces.iter().map(parts), looks)
    }

    /// Returns the layers of pieces. Each piece is given by its parts in source and target.
    pub(in crate::transition) fn of_parts(
        pieces: impl Iterator<Item = [Option<usize>; 2]>,
        looks: &PartAppearances,
    ) -> Self {
        let coats = |parts: [Option<usize>; 2]| -> [Option<usize>; 2] {
            Side::BOTH.map(|side| parts[side].map(|part| looks.paint_layer(side, part)))
        };
        let mut of_pieces: Vec<[Option<usize>; 2]> = pieces.map(coats).collect();
        // A piece that exists in only one design joins the layer to which most pieces of the same
        // paint layer belong.
        let both: Vec<[Option<usize>; 2]> = of_pieces.clone();
        for own in &mut of_pieces {
            for side in Side::BOTH {
                if own[side].is_none() {
                    own[side] = partner(&both, side.other(), own[side.other()]);
                }
            }
        }
        let mut levels = BTreeMap::new();
        for own in &of_pieces {
            let next = levels.len();
            levels.entry(*own).or_insert(next);
        }
        let mut coats = vec![[None; 2]; levels.len()];
        levels.iter().for_each(|(own, &level)| coats[level] = *own);
        Self {
            of_pieces: of_pieces.iter().map(|own| levels[own]).collect(),
            layers: coats,
        }
    }

    /// Returns the index of the layer of a piece.
    pub(in crate::transition) fn of_piece(&self, piece: usize) -> usize {
        self.of_pieces.get(piece).copied().unwrap_or(0)
    }
}

/// Returns the paint layer of the other design with which most pieces of the paint layer `coat` of
/// design `side` are matched; the lowest index if several are equally frequent.
fn partner(pieces: &[[Option<usize>; 2]], side: Side, coat: Option<usize>) -> Option<usize> {
    let mut counts = BTreeMap::new();
    for piece in pieces.iter().filter(|piece| piece[side] == coat) {
        if let Some(other) = piece[side.other()] {
            *counts.entry(other).or_insert(0) += 1;
        }
    }
    let most = counts
        .iter()
        .max_by_key(|(other, count)| (**count, usize::MAX - **other));
    most.map(|(other, _)| *other)
}
