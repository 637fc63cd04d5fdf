//! Paint layers of a content: the layer of each ring, the paints, gradients and strokes of each
//! layer, and the order in which layers are drawn.

use crate::colour::{Gradient, Paint, StrokeStyle};
use crate::geometry::{DVec2, Side, fit_affine};
use std::sync::Arc;

/// Paint layers of a content, and the layer to which each ring belongs.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintLayerStack {
    /// All layers, in no particular order; their `z_indices` give the drawing order.
    pub layers: Vec<PlacedPaintLayer>,
    /// For each boundary loop, the index of its layer in `layers`.
    pub of_loops: Vec<usize>,
    /// For each hole, the index of its layer in `layers`.
    pub of_holes: Vec<usize>,
    /// For each boundary loop, the only design that has the loop's part; `None` if both have it.
    pub unmatched_loops: Vec<Option<Side>>,
    /// Whether parts that exist in only one design fade in or out.
    pub fades_unmatched: bool,
    /// The t at which the drawing order changes from that of the source to that of the target.
    pub reorder_t: f64,
}

/// Group of rings that share their paints, gradients and strokes at one t.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InkedLayer {
    /// Index of the paint layer of the rings; 0 if the content has a single colour.
    pub layer: usize,
    /// Own time of the parts to which the rings belong: the transition's t, converted by the clock
    /// of these parts. The paints of source and target are mixed at this time.
    pub t: f64,
    /// The rings of the group: closed polygons in the plane, without a repeated end point.
    pub rings: Vec<Vec<DVec2>>,
    /// Paints in source and target; `None` if the content has a single colour.
    pub paints: [Option<Paint>; 2],
    /// Gradients in source and target, moved along to their place at `t`; `None` where the paint is
    /// flat. `paints` then contains the mean colour of each gradient.
    pub gradients: [Option<Gradient>; 2],
    /// Strokes along the rings in source and target; `None` without a stroke.
    pub strokes: [Option<StrokeStyle>; 2],
    /// Names of the layer in the files of source and target; empty where it has none.
    pub names: [Arc<str>; 2],
}

/// Paint layer: parts that have the same paint in the source and the same paint in the target.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedPaintLayer {
    /// Paints in source and target; `None` if the layer has no colour in that design.
    pub paints: [Option<Paint>; 2],
    /// Gradients of the layer, attached to its vertices.
    pub shading: LayerShading,
    /// Strokes along the outlines in source and target; `None` without a stroke.
    pub strokes: [Option<StrokeStyle>; 2],
    /// Names of the layer in the files of source and target; empty where it has none.
    pub names: [Arc<str>; 2],
    /// Number of layers below this one in the source and in the target.
    pub z_indices: [usize; 2],
    /// The only design that has the layer; `None` if both have it.
    pub only_in: Option<Side>,
}

/// Gradients of a paint layer, which move along with the layer's vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerShading {
    /// Indices of the vertices on the boundary loops of the layer.
    pub vertices: Vec<u32>,
    /// Gradients in source and target; `None` where the paint is flat.
    pub ends: [Option<AnchoredGradient>; 2],
}

/// Gradient of one design, with the positions that the layer's vertices have in that design.
#[derive(Clone, Debug, PartialEq)]
pub struct AnchoredGradient {
    /// The gradient as it is in its design.
    pub gradient: Gradient,
    /// Vertex positions in that design, in the order of [`LayerShading::vertices`].
    pub vertex_positions: Vec<DVec2>,
}

impl LayerShading {
    /// Returns the gradients of source and target, moved along with the layer. `places` contains
    /// the current positions of all vertices. The gradient of a design is transformed by the affine
    /// map that best fits the layer's vertices in this design onto their current positions. Only
    /// vertices for which `is_counted` holds are used.
    ///
    /// # Panics
    /// Panics if a vertex has no position.
    #[must_use]
    pub fn gradients_at(
        &self,
        places: &[DVec2],
        is_counted: impl Fn(u32) -> bool,
    ) -> [Option<Gradient>; 2] {
        if self.ends == [None, None] {
            return [None, None];
        }
        let counted: Vec<usize> = (0..self.vertices.len())
            .filter(|&k| is_counted(self.vertices[k]))
            .collect();
        let position = |&k: &usize| places[self.vertices[k] as usize];
        let current: Vec<DVec2> = counted.iter().map(position).collect();
        self.ends.each_ref().map(|end| {
            let end = end.as_ref()?;
            let original: Vec<DVec2> = counted.iter().map(|&k| end.vertex_positions[k]).collect();
            Some(end.gradient.transformed(fit_affine(&original, &current)))
        })
    }
}

impl PlacedPaintLayer {
    /// Fills in the paints, gradients and strokes of a group of rings in this layer. `gradients`
    /// are the layer's gradients at the time of the group. If the group fades, `fading` is the only
    /// design that has its parts; in the other design the group becomes transparent.
    pub(super) fn ink(
        &self,
        inked: InkedLayer,
        gradients: [Option<Gradient>; 2],
        fading: Option<Side>,
    ) -> InkedLayer {
        let mut inked = InkedLayer {
            paints: self.paints,
            strokes: self.strokes,
            names: self.names.clone(),
            gradients,
            ..inked
        };
        if let Some(own) = fading {
            let transparent = |paint: Paint| Paint {
                opacity: 0.0,
                ..paint
            };
            let other = own.other();
            inked.paints[other] = inked.paints[own].map(transparent);
            let gradient = inked.gradients[own].as_ref();
            inked.gradients[other] = gradient.map(|gradient| gradient.map_paints(transparent));
            inked.strokes[other] = None;
        }
        inked
    }
}

impl PaintLayerStack {
    /// Creates a stack of a single layer without a colour, for the given numbers of boundary loops
    /// and holes.
    #[must_use]
    pub fn single_layer(loops: usize, holes: usize) -> Self {
        Self {
            layers: vec![PlacedPaintLayer {
                paints: [None; 2],
                shading: LayerShading::default(),
                strokes: [None; 2],
                names: Default::default(),
                z_indices: [0; 2],
                only_in: None,
            }],
            of_loops: vec![0; loops],
            of_holes: vec![0; holes],
            unmatched_loops: vec![None; loops],
            fades_unmatched: false,
            reorder_t: 0.0,
        }
    }

    /// Returns the indices of the layers in the order in which they are drawn at `t`, the lowest
    /// first.
    #[must_use]
    pub fn draw_order(&self, t: f64) -> Vec<usize> {
        let end = usize::from(t >= self.reorder_t);
        let mut order: Vec<usize> = (0..self.layers.len()).collect();
        order.sort_by_key(|&layer| self.layers[layer].z_indices[end]);
        order
    }
}
