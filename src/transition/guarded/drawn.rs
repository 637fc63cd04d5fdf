//! What is drawn of a film as its mesh has it, and when.

use crate::correspondence::PieceMatch;
use crate::film::proof::Walk;
use crate::geometry::Side;
use crate::transition::levels::Levels;
use crate::warp::Arap;

/// What is known of the pieces of a match.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    pieces: Vec<Piece>,
}

#[derive(Clone, Copy, Debug)]
struct Piece {
    level: usize,
    /// The design that has it, if one has it alone.
    alone: Option<Side>,
    swells: bool,
}

impl Drawn {
    /// `swelling` are the pieces that are not drawn as the mesh has them.
    pub(super) fn of(pieces: &[PieceMatch], swelling: &[usize], levels: &Levels) -> Self {
        let piece = |(k, piece): (usize, &PieceMatch)| Piece {
            level: levels.of_piece(k),
            alone: match (piece.source_part, piece.target_part) {
                (Some(_), Some(_)) => None,
                (Some(_), None) => Some(Side::Source),
                (None, _) => Some(Side::Target),
            },
            swells: swelling.contains(&k),
        };
        let pieces = pieces.iter().enumerate().map(piece).collect();
        Self { pieces }
    }

    /// Pieces on one level, of which some are of one design alone.
    #[cfg(test)]
    pub(super) fn alone_of(sides: &[Option<Side>]) -> Self {
        let piece = |&alone: &Option<Side>| Piece {
            level: 0,
            alone,
            swells: false,
        };
        Self {
            pieces: sides.iter().map(piece).collect(),
        }
    }

    /// The same in the film that is run backwards.
    pub(super) fn swapped(&self) -> Self {
        let piece = |piece: &Piece| Piece {
            alone: piece.alone.map(Side::other),
            ..*piece
        };
        Self {
            pieces: self.pieces.iter().map(piece).collect(),
        }
    }

    /// The design that has a piece alone.
    pub(super) fn alone(&self, piece: usize) -> Option<Side> {
        self.pieces.get(piece).and_then(|piece| piece.alone)
    }

    /// The boundaries that are drawn as the mesh has them.
    pub(super) fn walks(&self, film: &Arap) -> Vec<Walk> {
        let parts = film.mesh().components();
        let walks = film.mesh().boundary_loops().into_iter();
        let walk = |vertices: Vec<u32>| {
            let piece = vertices.first().map_or(0, |&v| parts[v as usize] as usize);
            let Piece { level, swells, .. } = *self.pieces.get(piece)?;
            let life = film.lives().get(piece).copied().flatten();
            let drawn = match (life, self.alone(piece)) {
                (Some(life), Some(Side::Source)) => [0.0, life.to],
                (Some(life), Some(Side::Target)) => [life.from, 1.0],
                _ => [0.0, 1.0],
            };
            (!swells).then_some(Walk {
                vertices,
                level,
                drawn,
            })
        };
        walks.filter_map(walk).collect()
    }
}
