//! The boundaries in a film of what both designs have.

use super::layered_outline::LayeredOutline;
use super::layers::PieceLayers;
use crate::geometry::DVec2;
use crate::warp::Arap;

/// The boundary walks of the parts of a film that both designs have, and the
/// piece that each belongs to.
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

    /// For each walk the piece that it belongs to.
    pub(in crate::transition) fn pieces(&self) -> &[usize] {
        &self.pieces
    }

    /// The walks as outlines on their levels.
    pub(in crate::transition) fn outlines(
        &self,
        places: &[DVec2],
        levels: &PieceLayers,
    ) -> Vec<LayeredOutline> {
        let rings = self.rings(places).into_iter().zip(&self.pieces);
        let outline = |(ring, &piece)| LayeredOutline::of(ring, levels.of_piece(piece));
        rings.map(outline).collect()
    }

    /// Where the walks are.
    pub(in crate::transition) fn rings(&self, places: &[DVec2]) -> Vec<Vec<DVec2>> {
        let ring = |walk: &Vec<u32>| walk.iter().map(|&v| places[v as usize]).collect();
        self.walks.iter().map(ring).collect()
    }
}
