//! How the parts of a solid are painted, over and under each other.

use crate::colour::{Gradient, Line, Paint};
use crate::geometry::{DVec2, Side, affine};

/// The coats that the rings of a solid are in.
#[derive(Clone, Debug, PartialEq)]
pub struct Coating {
    /// What there is of paint.
    pub coats: Vec<Coat>,
    /// For each boundary walk its coat.
    pub of_walks: Vec<usize>,
    /// For each hole its coat.
    pub of_holes: Vec<usize>,
    /// The t at which those change places that lie over each other otherwise in
    /// the target than in the source.
    pub reordered_at: f64,
}

/// Parts that are painted alike, in both designs.
#[derive(Clone, Debug, PartialEq)]
pub struct Coat {
    /// In source and target; none where the design has no colour of its own.
    pub paints: [Option<Paint>; 2],
    /// What is shaded.
    pub shading: Shading,
    /// The line along their outlines in source and target, where there is one.
    pub lines: [Option<Line>; 2],
    /// How many coats lie below, in source and target.
    pub heights: [usize; 2],
    /// The design that has it alone.
    pub alone: Option<Side>,
}

/// The gradients of a coat, which go with its vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shading {
    /// The vertices along its walks.
    pub vertices: Vec<u32>,
    /// In source and target, where the paint is the mean of one.
    pub ends: [Option<Anchored>; 2],
}

/// A gradient, and where the vertices are in its design.
#[derive(Clone, Debug, PartialEq)]
pub struct Anchored {
    /// As it is in its design.
    pub gradient: Gradient,
    /// As many as there are vertices.
    pub places: Vec<DVec2>,
}

impl Shading {
    /// Both gradients, carried to where the vertices are by the affine map that fits
    /// them best.
    ///
    /// # Panics
    /// Where a vertex has no place.
    #[must_use]
    pub fn at(&self, places: &[DVec2]) -> [Option<Gradient>; 2] {
        if self.ends == [None, None] {
            return [None, None];
        }
        let here: Vec<DVec2> = self.vertices.iter().map(|&v| places[v as usize]).collect();
        self.ends.each_ref().map(|end| {
            let end = end.as_ref()?;
            Some(end.gradient.moved(affine(&end.places, &here)))
        })
    }
}

impl Coat {
    /// Lets what one design has alone fade in or out, or keep its paint.
    pub(crate) fn fade(&mut self, fades: bool) {
        let Some(own) = self.alone else { return };
        let seen = |paint: Paint| Paint {
            opacity: if fades { 0.0 } else { paint.opacity },
            ..paint
        };
        let away = own.other();
        self.paints[away] = self.paints[own].map(seen);
        let shading = self.shading.ends[own].clone();
        self.shading.ends[away] = shading.map(|end| Anchored {
            gradient: end.gradient.repainted(seen),
            ..end
        });
    }
}

impl Coating {
    /// One coat in no colour of its own, over so many walks and holes.
    #[must_use]
    pub fn plain(walks: usize, holes: usize) -> Self {
        Self {
            coats: vec![Coat {
                paints: [None; 2],
                shading: Shading::default(),
                lines: [None; 2],
                heights: [0; 2],
                alone: None,
            }],
            of_walks: vec![0; walks],
            of_holes: vec![0; holes],
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
