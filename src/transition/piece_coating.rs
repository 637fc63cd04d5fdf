//! The coats of a film.

use super::drawing_pair::{DrawingPair, LayerInk};
use super::paint_layer_options::PaintLayerOptions;
use super::transients::holes::PieceHole;
use super::transients::layers::PieceLayers;
use super::transition::TransitionData;
use crate::compatible::CompatibleMesh;
use crate::content::{AnchoredGradient, LayerShading, PaintLayerStack, PlacedPaintLayer};
use crate::correspondence::{PartLooks, PieceMatch, RegionMatch};
use crate::geometry::{DVec2, Side};

impl TransitionData {
    /// The same transition with its coats as these options ask for.
    pub(super) fn coated(mut self, options: &PaintLayerOptions) -> Self {
        if let Some(coating) = self.content.coating_mut() {
            coating.reordered_at = options.reorder_at;
            coating.fades = options.fade;
        }
        self
    }
}

/// The boundary walks of a film.
pub(super) struct PieceBoundaryLoops<'a> {
    /// As vertex indices.
    pub walks: Vec<Vec<u32>>,
    /// For each the piece that it goes around.
    pub pieces: Vec<usize>,
    /// Where the vertices are in the designs.
    pub places: [&'a [DVec2]; 2],
}

impl<'a> PieceBoundaryLoops<'a> {
    /// Of a mesh whose connected parts are the pieces.
    pub fn of_mesh(mesh: &'a CompatibleMesh) -> Self {
        let parts = mesh.components();
        let walks = mesh.boundary_loops();
        let piece = |walk: &Vec<u32>| walk.first().map_or(0, |&v| parts[v as usize] as usize);
        Self {
            pieces: walks.iter().map(piece).collect(),
            walks,
            places: [mesh.source(), mesh.target()],
        }
    }
}

/// How a film is painted: a coat for each level. None of designs in one colour.
pub(super) fn coating(
    drawings: &DrawingPair,
    matched: &RegionMatch,
    film: &PieceBoundaryLoops,
    holes: &[PieceHole],
) -> Option<PaintLayerStack> {
    if drawings.looks == PartLooks::default() {
        return None;
    }
    let levels = PieceLayers::of(matched, &drawings.looks);
    let pieces = film.pieces.iter();
    let of_walks: Vec<usize> = pieces.map(|&piece| levels.of_piece(piece)).collect();
    let along = |level: usize| {
        let own = film.walks.iter().zip(&of_walks);
        let own = own.filter(|&(_, of)| *of == level);
        own.flat_map(|(walk, _)| walk.iter().copied()).collect()
    };
    Some(PaintLayerStack {
        coats: coats(drawings, &levels, along, film.places),
        of_holes: holes
            .iter()
            .map(|(piece, _)| levels.of_piece(*piece))
            .collect(),
        lone_walks: film
            .pieces
            .iter()
            .map(|&piece| alone(matched.pieces.get(piece)?))
            .collect(),
        of_walks,
        fades: false,
        reordered_at: PaintLayerOptions::default().reorder_at,
    })
}

/// The design that has a piece alone.
fn alone(piece: &PieceMatch) -> Option<Side> {
    match [piece.source_part, piece.target_part] {
        [Some(_), None] => Some(Side::Source),
        [None, Some(_)] => Some(Side::Target),
        _ => None,
    }
}

/// The coats of levels. A gradient goes with the vertices along the level's walks, which
/// are in these places in the designs.
pub(super) fn coats(
    drawings: &DrawingPair,
    levels: &PieceLayers,
    along: impl Fn(usize) -> Vec<u32>,
    places: [&[DVec2]; 2],
) -> Vec<PlacedPaintLayer> {
    let heights = Side::BOTH.map(|side| heights(&levels.coats, side));
    let coat = |level: usize| {
        let ink = |side: Side| Some(&drawings.inks[side][levels.coats[level][side]?]);
        let inks = Side::BOTH.map(ink);
        // What one design has alone keeps its paint, while its line grows with it.
        let paint = |side: Side| inks[side].or(inks[side.other()])?.paint;
        PlacedPaintLayer {
            paints: Side::BOTH.map(paint),
            shading: shading(inks, along(level), places),
            lines: inks.map(|ink| ink?.line),
            heights: [heights[0][level], heights[1][level]],
            alone: match levels.coats[level] {
                [Some(_), None] => Some(Side::Source),
                [None, Some(_)] => Some(Side::Target),
                _ => None,
            },
        }
    };
    (0..levels.coats.len()).map(coat).collect()
}

/// The gradients of a coat that has these vertices; what one design has alone keeps its
/// own.
fn shading(
    inks: [Option<&LayerInk>; 2],
    vertices: Vec<u32>,
    places: [&[DVec2]; 2],
) -> LayerShading {
    let anchored = |side: Side| {
        let gradient = inks[side]?.gradient.clone()?;
        let places = vertices.iter().map(|&v| places[side][v as usize]);
        Some(AnchoredGradient {
            gradient,
            places: places.collect(),
        })
    };
    let ends = Side::BOTH.map(|side| {
        let side = if inks[side].is_some() {
            side
        } else {
            side.other()
        };
        anchored(side)
    });
    match ends {
        [None, None] => LayerShading::default(),
        ends => LayerShading { vertices, ends },
    }
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
        let is_below = |&placed: &usize| {
            levels[placed][other].is_some() && levels[placed][other] < levels[k][other]
        };
        let at = order.iter().rposition(is_below).map_or(0, |at| at + 1);
        // What is born lies over what dies there, in both designs.
        let is_dying = |&&placed: &&usize| side == Side::Source && levels[placed][other].is_none();
        let dying = order[at..].iter().take_while(is_dying).count();
        order.insert(at + dying, k);
    }
    let mut heights = vec![0; levels.len()];
    order
        .iter()
        .enumerate()
        .for_each(|(height, &k)| heights[k] = height);
    heights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_alone_lies_above_what_is_below_it_and_what_is_born_over_what_dies() {
        // A sky and a sun in both; a sea that dies over them, and a word that is born.
        let levels = [
            [Some(0), Some(0)],
            [Some(1), Some(1)],
            [Some(2), None],
            [None, Some(2)],
        ];
        for side in Side::BOTH {
            assert_eq!(heights(&levels, side), [0, 1, 2, 3], "{side:?}");
        }
        // A sun that sinks below its sky, with what only one has between them.
        let levels = [[Some(0), Some(1)], [Some(1), Some(0)], [None, Some(2)]];
        assert_eq!(heights(&levels, Side::Source), [0, 1, 2]);
        assert_eq!(heights(&levels, Side::Target), [1, 0, 2]);
    }
}
