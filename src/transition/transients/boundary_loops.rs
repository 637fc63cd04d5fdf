//! Boundary loops of the matched parts, which exist in both designs.

use super::layered_outline::LayeredOutline;
use super::layers::PieceLayers;
use crate::geometry::DVec2;
use crate::warp::Arap;

/// Boundary loops of the matched parts of a motion, each with the index of its piece.
pub(in crate::transition) struct SharedPartLoops {
    walks: Vec<Vec<u32>>,
    pieces: Vec<usize>,
}

impl SharedPartLoops {
    pub(in crate::transition) fn of(film: &Arap) -> Self {
        let parts = film.mesh().components();
        let piece = |walk: &Vec<u32>| walk.first().map_or(0, |&v| parts[v as usize] as usize);
        let is_in_both = |piece: usize| film.time_windows().get(piece).is_none_or(Option::is_none);
        let (walks, pieces) = (film.mesh().boundary_loops().into_iter())
            .map(|walk| (piece(&walk), walk))
            .filter(|(piece, _)| is_in_both(*piece))
            .map(|(piece, walk)| (walk, piece))
            .unzip();
        Self { walks, pieces }
    }

    /// Returns the index of the piece of each loop.
    pub(in crate::transition) fn pieces(&self) -> &[usize] {
        &self.pieces
    }

    /// Returns the loops at the given vertex positions, as outlines on their layers.
    pub(in crate::transition) fn outlines(
        &self,
        places: &[DVec2],
        levels: &PieceLayers,
    ) -> Vec<LayeredOutline> {
        let rings = self.rings(places).into_iter().zip(&self.pieces);
        let outline = |(ring, &piece)| LayeredOutline::of(ring, levels.of_piece(piece));
        rings.map(outline).collect()
    }

    /// Returns the loops at the given vertex positions.
    pub(in crate::transition) fn rings(&self, places: &[DVec2]) -> Vec<Vec<DVec2>> {
        let ring = |walk: &Vec<u32>| walk.iter().map(|&v| places[v as usize]).collect();
        self.walks.iter().map(ring).collect()
    }
}
