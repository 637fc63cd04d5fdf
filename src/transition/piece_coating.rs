//! Determines the paint layers of a transition: one for each pair of a source layer and a target
//! layer with parts that are matched to each other, and one for each layer without matched parts.

use super::drawing_pair::{DrawingPair, LayerInk};
use super::paint_layer_options::PaintLayerOptions;
use super::transients::holes::PieceHole;
use super::transients::layers::PieceLayers;
use super::transition::TransitionData;
use crate::compatible::CompatibleMesh;
use crate::content::{AnchoredGradient, LayerShading, PaintLayerStack, PlacedPaintLayer};
use crate::correspondence::{PartAppearances, PieceMatch, RegionMatch};
use crate::geometry::{DVec2, Side};
use std::sync::Arc;

impl TransitionData {
    /// Applies options to the paint layers of the content; without paint layers, changes nothing.
    pub(super) fn with_paint_layers(mut self, options: &PaintLayerOptions) -> Self {
        if let Some(layers) = self.content.paint_layers_mut() {
            layers.reorder_t = options.reorder_at;
            layers.fades_unmatched = options.fade;
        }
        self
    }
}

/// The boundary loops of a transition, each with the piece to which it belongs.
pub(super) struct PieceBoundaryLoops<'a> {
    /// Vertex indices of each loop.
    pub loops: Vec<Vec<u32>>,
    /// For each loop, the index of the piece to which it belongs.
    pub pieces: Vec<usize>,
    /// Positions of the vertices in source and target.
    pub places: [&'a [DVec2]; 2],
}

impl<'a> PieceBoundaryLoops<'a> {
    /// Returns the loops of a mesh whose connected components are the pieces.
    pub fn of_mesh(mesh: &'a CompatibleMesh) -> Self {
        let parts = mesh.components();
        let loops = mesh.boundary_loops();
        let piece =
            |vertices: &Vec<u32>| vertices.first().map_or(0, |&v| parts[v as usize] as usize);
        Self {
            pieces: loops.iter().map(piece).collect(),
            loops,
            places: [mesh.source(), mesh.target()],
        }
    }
}

/// Returns the paint layers of a transition; `None` for designs in one colour.
pub(super) fn paint_layer_stack(
    drawings: &DrawingPair,
    matched: &RegionMatch,
    loops: &PieceBoundaryLoops,
    holes: &[PieceHole],
) -> Option<PaintLayerStack> {
    if drawings.appearances == PartAppearances::default() {
        return None;
    }
    let layers = PieceLayers::of(matched, &drawings.appearances);
    let pieces = loops.pieces.iter();
    let of_loops: Vec<usize> = pieces.map(|&piece| layers.of_piece(piece)).collect();
    let loop_vertices = |layer: usize| {
        let all = loops.loops.iter().zip(&of_loops);
        let in_layer = all.filter(|&(_, layer_of_loop)| *layer_of_loop == layer);
        let vertices = in_layer.flat_map(|(boundary_loop, _)| boundary_loop.iter().copied());
        vertices.collect()
    };
    Some(PaintLayerStack {
        layers: placed_paint_layers(drawings, &layers, loop_vertices, loops.places),
        of_holes: holes
            .iter()
            .map(|(piece, _)| layers.of_piece(*piece))
            .collect(),
        unmatched_loops: loops
            .pieces
            .iter()
            .map(|&piece| unmatched_side(matched.pieces.get(piece)?))
            .collect(),
        of_loops,
        fades_unmatched: false,
        reorder_t: PaintLayerOptions::default().reorder_at,
    })
}

/// Returns the only design that contains a piece; `None` for a matched piece.
fn unmatched_side(piece: &PieceMatch) -> Option<Side> {
    match [piece.source_part, piece.target_part] {
        [Some(_), None] => Some(Side::Source),
        [None, Some(_)] => Some(Side::Target),
        _ => None,
    }
}

/// Returns the paint, gradients, stroke and stacking order of each layer. The gradients of a layer
/// move with the vertices that `vertices_along` returns for that layer; `places` are the positions
/// of all vertices in the designs.
pub(super) fn placed_paint_layers(
    drawings: &DrawingPair,
    layers: &PieceLayers,
    vertices_along: impl Fn(usize) -> Vec<u32>,
    places: [&[DVec2]; 2],
) -> Vec<PlacedPaintLayer> {
    let z_indices = Side::BOTH.map(|side| z_indices(&layers.layers, side));
    let layer_at = |layer: usize| {
        let ink = |side: Side| Some(&drawings.inks[side][layers.layers[layer][side]?]);
        let inks = Side::BOTH.map(ink);
        // An unmatched layer keeps its paint; its stroke exists only in its own design.
        let paint = |side: Side| inks[side].or(inks[side.other()])?.paint;
        PlacedPaintLayer {
            paints: Side::BOTH.map(paint),
            shading: shading(inks, vertices_along(layer), places),
            strokes: inks.map(|ink| ink?.line),
            names: inks.map(|ink| ink.map(|ink| Arc::clone(&ink.name)).unwrap_or_default()),
            z_indices: [z_indices[0][layer], z_indices[1][layer]],
            only_in: match layers.layers[layer] {
                [Some(_), None] => Some(Side::Source),
                [None, Some(_)] => Some(Side::Target),
                _ => None,
            },
        }
    };
    (0..layers.layers.len()).map(layer_at).collect()
}

/// Returns the gradients of a layer, anchored to `vertices`. An unmatched layer keeps the gradient
/// of its own design.
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
            vertex_positions: places.collect(),
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

/// Returns the height of each layer in the stack of one design, 0 for the lowest. A layer that
/// exists only in the other design is inserted directly above the next lower layer of that design.
fn z_indices(layers: &[[Option<usize>; 2]], side: Side) -> Vec<usize> {
    let other = side.other();
    let mut order: Vec<usize> = (0..layers.len())
        .filter(|&k| layers[k][side].is_some())
        .collect();
    order.sort_by_key(|&k| (layers[k][side], layers[k][other]));
    let mut unmatched: Vec<usize> = (0..layers.len())
        .filter(|&k| layers[k][side].is_none())
        .collect();
    unmatched.sort_by_key(|&k| layers[k][other]);
    for k in unmatched {
        let is_below = |&placed: &usize| {
            layers[placed][other].is_some() && layers[placed][other] < layers[k][other]
        };
        let index = order
            .iter()
            .rposition(is_below)
            .map_or(0, |below| below + 1);
        // In both designs, appearing layers lie above disappearing layers at the same place in the
        // stack.
        let is_disappearing =
            |&&placed: &&usize| side == Side::Source && layers[placed][other].is_none();
        let disappearing_count = order[index..].iter().take_while(is_disappearing).count();
        order.insert(index + disappearing_count, k);
    }
    let mut heights = vec![0; layers.len()];
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
    fn unmatched_layers_lie_above_their_neighbour_and_appearing_above_disappearing_ones() {
        // A sky and a sun exist in both designs. In front of them, a sea disappears and a word
        // appears.
        let layers = [
            [Some(0), Some(0)],
            [Some(1), Some(1)],
            [Some(2), None],
            [None, Some(2)],
        ];
        for side in Side::BOTH {
            assert_eq!(z_indices(&layers, side), [0, 1, 2, 3], "{side:?}");
        }
        // The first two layers exchange their order, and the topmost layer exists only in the
        // target.
        let layers = [[Some(0), Some(1)], [Some(1), Some(0)], [None, Some(2)]];
        assert_eq!(z_indices(&layers, Side::Source), [0, 1, 2]);
        assert_eq!(z_indices(&layers, Side::Target), [1, 0, 2]);
    }
}
