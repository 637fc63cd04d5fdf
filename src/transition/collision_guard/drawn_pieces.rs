//! What is drawn of a film as its mesh has it, and when.

use crate::recording::proof::DrawnLoop;
use crate::transition::transients::layers::PieceLayers;
use crate::warp::Arap;

/// What is known of the pieces of a match.
#[derive(Clone, Debug)]
pub(super) struct DrawnPieces {
    pieces: Vec<DrawnPiece>,
}

#[derive(Clone, Copy, Debug)]
struct DrawnPiece {
    level: usize,
    swells: bool,
}

impl DrawnPieces {
    /// `swelling` are the pieces that are not drawn as the mesh has them.
    pub(super) fn of(pieces: usize, swelling: &[usize], levels: &PieceLayers) -> Self {
        let piece = |k: usize| DrawnPiece {
            level: levels.of_piece(k),
            swells: swelling.contains(&k),
        };
        Self {
            pieces: (0..pieces).map(piece).collect(),
        }
    }

    /// The boundaries that are drawn as the mesh has them.
    pub(super) fn walks(&self, film: &Arap) -> Vec<DrawnLoop> {
        let parts = film.mesh().components();
        let walks = film.mesh().boundary_loops().into_iter();
        let walk = |vertices: Vec<u32>| {
            let piece = vertices.first().map_or(0, |&v| parts[v as usize] as usize);
            let DrawnPiece { level, swells, .. } = *self.pieces.get(piece)?;
            let life = film.time_windows().get(piece).copied().flatten();
            let drawn = life.map_or([0.0, 1.0], |life| life.visible_interval(|t| t));
            (!swells).then_some(DrawnLoop {
                vertices,
                layer: level,
                visible_interval: drawn,
            })
        };
        walks.filter_map(walk).collect()
    }
}
