//! How the parts of a solid are painted, over and under each other.

use crate::colour::{Gradient, Paint, StrokeStyle};
use crate::geometry::{DVec2, Side, fit_affine};

/// The coats that the rings of a solid are in.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintLayerStack {
    /// What there is of paint.
    pub coats: Vec<PlacedPaintLayer>,
    /// For each boundary walk its coat.
    pub of_walks: Vec<usize>,
    /// For each hole its coat.
    pub of_holes: Vec<usize>,
    /// For each boundary walk the design that has its part alone.
    pub lone_walks: Vec<Option<Side>>,
    /// What one design has alone fades in or out.
    pub fades: bool,
    /// The t at which those change places that lie over each other otherwise in
    /// the target than in the source.
    pub reordered_at: f64,
}

/// Rings that are painted alike.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InkedLayer {
    /// Their coat; 0 where there is one colour.
    pub coat: usize,
    /// The time that they show, by which their paint is mixed.
    pub t: f64,
    /// The rings.
    pub rings: Vec<Vec<DVec2>>,
    /// Their paint in source and target; none where there is one colour.
    pub paints: [Option<Paint>; 2],
    /// The gradients that their paints are the means of, as they are at `t`.
    pub gradients: [Option<Gradient>; 2],
    /// The lines along them in source and target.
    pub lines: [Option<StrokeStyle>; 2],
}

/// Parts that are painted alike, in both designs.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedPaintLayer {
    /// In source and target; none where the design has no colour of its own.
    pub paints: [Option<Paint>; 2],
    /// What is shaded.
    pub shading: LayerShading,
    /// The line along their outlines in source and target, where there is one.
    pub lines: [Option<StrokeStyle>; 2],
    /// How many coats lie below, in source and target.
    pub heights: [usize; 2],
    /// The design that has it alone.
    pub alone: Option<Side>,
}

/// The gradients of a coat, which go with its vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerShading {
    /// The vertices along its walks.
    pub vertices: Vec<u32>,
    /// In source and target, where the paint is the mean of one.
    pub ends: [Option<AnchoredGradient>; 2],
}

/// A gradient, and where the vertices are in its design.
#[derive(Clone, Debug, PartialEq)]
pub struct AnchoredGradient {
    /// As it is in its design.
    pub gradient: Gradient,
    /// As many as there are vertices.
    pub places: Vec<DVec2>,
}

impl LayerShading {
    /// Both gradients, carried to where those of the vertices are that count, by the
    /// affine map that fits them best.
    ///
    /// # Panics
    /// Where a vertex has no place.
    #[must_use]
    pub fn at(&self, places: &[DVec2], counts: impl Fn(u32) -> bool) -> [Option<Gradient>; 2] {
        if self.ends == [None, None] {
            return [None, None];
        }
        let own: Vec<usize> = (0..self.vertices.len())
            .filter(|&k| counts(self.vertices[k]))
            .collect();
        let place = |&k: &usize| places[self.vertices[k] as usize];
        let here: Vec<DVec2> = own.iter().map(place).collect();
        self.ends.each_ref().map(|end| {
            let end = end.as_ref()?;
            let there: Vec<DVec2> = own.iter().map(|&k| end.places[k]).collect();
            Some(end.gradient.moved(fit_affine(&there, &here)))
        })
    }
}

impl PlacedPaintLayer {
    /// Paints, gradients and lines into what is in this coat at `t`, the gradients being
    /// these there; of what fades the design that has it alone.
    pub(super) fn ink(
        &self,
        inked: InkedLayer,
        gradients: [Option<Gradient>; 2],
        fading: Option<Side>,
    ) -> InkedLayer {
        let mut inked = InkedLayer {
            paints: self.paints,
            lines: self.lines,
            gradients,
            ..inked
        };
        if let Some(own) = fading {
            let clear = |paint: Paint| Paint {
                opacity: 0.0,
                ..paint
            };
            let away = own.other();
            inked.paints[away] = inked.paints[own].map(clear);
            let gradient = inked.gradients[own].as_ref();
            inked.gradients[away] = gradient.map(|gradient| gradient.repainted(clear));
            inked.lines[away] = None;
        }
        inked
    }
}

impl PaintLayerStack {
    /// One coat in no colour of its own, over so many walks and holes.
    #[must_use]
    pub fn plain(walks: usize, holes: usize) -> Self {
        Self {
            coats: vec![PlacedPaintLayer {
                paints: [None; 2],
                shading: LayerShading::default(),
                lines: [None; 2],
                heights: [0; 2],
                alone: None,
            }],
            of_walks: vec![0; walks],
            of_holes: vec![0; holes],
            lone_walks: vec![None; walks],
            fades: false,
            reordered_at: 0.0,
        }
    }

    /// The coats as they lie at `t`, the lowest first.
    #[must_use]
    pub fn order(&self, t: f64) -> Vec<usize> {
        let end = usize::from(t >= self.reordered_at);
        let mut order: Vec<usize> = (0..self.coats.len()).collect();
        order.sort_by_key(|&coat| self.coats[coat].heights[end]);
        order
    }
}
