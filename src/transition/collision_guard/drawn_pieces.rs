//! Pieces of a match, and the boundary loops of the mesh that are drawn for them. Each loop has a
//! layer and an interval of t in which it is visible. Pieces that swell have no such loops, because
//! their drawn outlines differ from the mesh boundary.

use crate::recording::proof::DrawnLoop;
use crate::transition::transients::layers::PieceLayers;
use crate::warp::Arap;

/// The pieces of a match: their layers, and which of them swell (grow in thickness within their
/// outline).
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
    /// Creates the list of the pieces 0 to `pieces` − 1. `swelling` contains the indices of the
    /// pieces that swell, whose drawn outlines differ from the mesh boundary.
    pub(super) fn of(pieces: usize, swelling: &[usize], levels: &PieceLayers) -> Self {
        let piece = |k: usize| DrawnPiece {
            level: levels.of_piece(k),
            swells: swelling.contains(&k),
        };
        Self {
            pieces: (0..pieces).map(piece).collect(),
        }
    }

    /// Returns the boundary loops of all pieces that do not swell.
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
