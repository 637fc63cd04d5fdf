//! Paint layers of a content: which ring belongs to which layer, each layer's paints, gradients and
//! strokes, and the order in which layers are drawn.

use crate::colour::{Gradient, Paint, StrokeStyle};
use crate::geometry::{DVec2, Side, fit_affine};

/// Paint layers of a content, and the layer of each ring.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintLayerStack {
    /// All layers; their `z_indices` give the drawing order.
    pub layers: Vec<PlacedPaintLayer>,
    /// For each boundary loop, the index of its layer.
    pub of_loops: Vec<usize>,
    /// For each hole, the index of its layer.
    pub of_holes: Vec<usize>,
    /// For each boundary loop, the only design that has its part; `None` for parts of both designs.
    pub unmatched_loops: Vec<Option<Side>>,
    /// Whether parts that exist in only one design fade in or out.
    pub fades: bool,
    /// The t at which the drawing order changes from that of the source to that of the target.
    pub reorder_t: f64,
}

/// Rings that share paints, gradients and strokes, at one t.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InkedLayer {
    /// Index of their layer; 0 if there is only one colour.
    pub layer: usize,
    /// Time on the clock of their parts, by which paints are mixed.
    pub t: f64,
    /// Closed rings.
    pub rings: Vec<Vec<DVec2>>,
    /// Paints in source and target; `None` if there is only one colour.
    pub paints: [Option<Paint>; 2],
    /// Gradients in source and target, transformed to their place at `t`. The paints are the means
    /// of these gradients.
    pub gradients: [Option<Gradient>; 2],
    /// Strokes along the rings in source and target.
    pub strokes: [Option<StrokeStyle>; 2],
}

/// A paint layer: parts that share their paints, in both designs.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedPaintLayer {
    /// Paints in source and target; `None` if the design has no colour of its own.
    pub paints: [Option<Paint>; 2],
    /// Gradients, attached to vertices.
    pub shading: LayerShading,
    /// Strokes along the outlines in source and target, if any.
    pub strokes: [Option<StrokeStyle>; 2],
    /// Number of layers below this one, in source and target.
    pub z_indices: [usize; 2],
    /// The only design that has the layer; `None` if both have it.
    pub only_in: Option<Side>,
}

/// Gradients of a paint layer, which move with its vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerShading {
    /// Indices of the vertices on the layer's boundary loops.
    pub vertices: Vec<u32>,
    /// Gradients in source and target; `None` where the paint is flat.
    pub ends: [Option<AnchoredGradient>; 2],
}

/// A gradient with the positions of the layer's vertices in the gradient's design.
#[derive(Clone, Debug, PartialEq)]
pub struct AnchoredGradient {
    /// Gradient in its design.
    pub gradient: Gradient,
    /// Vertex positions in that design, parallel to [`LayerShading::vertices`].
    pub vertex_positions: Vec<DVec2>,
}

impl LayerShading {
    /// Returns both gradients, transformed by the affine map that best fits the motion of the
    /// vertices for which `is_counted` holds. `places` are the current positions of all vertices.
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
    /// Fills in the paints, gradients and strokes of rings in this layer. `gradients` are those at
    /// the time of the rings. If the rings fade, `fading` is the only design that has them; they
    /// become transparent in the other.
    pub(super) fn ink(
        &self,
        inked: InkedLayer,
        gradients: [Option<Gradient>; 2],
        fading: Option<Side>,
    ) -> InkedLayer {
        let mut inked = InkedLayer {
            paints: self.paints,
            strokes: self.strokes,
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
    /// Creates a single layer without a colour of its own for the given numbers of boundary loops
    /// and holes.
    #[must_use]
    pub fn single_layer(loops: usize, holes: usize) -> Self {
        Self {
            layers: vec![PlacedPaintLayer {
                paints: [None; 2],
                shading: LayerShading::default(),
                strokes: [None; 2],
                z_indices: [0; 2],
                only_in: None,
            }],
            of_loops: vec![0; loops],
            of_holes: vec![0; holes],
            unmatched_loops: vec![None; loops],
            fades: false,
            reorder_t: 0.0,
        }
    }

    /// Returns the indices of the layers at `t`, lowest first.
    #[must_use]
    pub fn draw_order(&self, t: f64) -> Vec<usize> {
        let end = usize::from(t >= self.reorder_t);
        let mut order: Vec<usize> = (0..self.layers.len()).collect();
        order.sort_by_key(|&layer| self.layers[layer].z_indices[end]);
        order
    }
}
