//! A drawing as coats of paint, as few as its order asks for.
//!
//! Shapes of one paint that lie on or beside each other are one coat: a word is
//! one, however many letters it has. A shape goes into the lowest coat of its
//! paint that is above all that it might hide.

use super::heights::Heights;
use super::layers::union;
use super::shape::Shape;
use crate::design::coat::Coat;
use crate::geometry::{DVec2, FillRule, Regions};
use std::collections::BTreeMap;

/// The coats of these shapes, the lowest first; of a drawing of this size.
pub(super) fn coats(shapes: Vec<Shape>, page: DVec2) -> Vec<Coat> {
    let coat = |shape: Shape| {
        // What encloses nothing is not seen.
        let regions = Regions::from_rings(&shape.rings, FillRule::NonZero).ok()?;
        Some(Coat {
            regions,
            paint: Some(shape.paint),
            name: shape.name,
        })
    };
    merged(shapes, page).into_iter().filter_map(coat).collect()
}

/// As few shapes as the order of these allows; what is one of several has no
/// name.
pub(super) fn merged(shapes: Vec<Shape>, page: DVec2) -> Vec<Shape> {
    let mut stack = Stack {
        coats: Vec::new(),
        of_paint: BTreeMap::new(),
        heights: Heights::of_page(page),
    };
    shapes.into_iter().for_each(|shape| stack.lay(shape));
    let united = |(shape, count): (Shape, usize)| match count {
        1 => shape,
        _ => Shape {
            rings: union(&shape.rings),
            name: String::new(),
            ..shape
        },
    };
    stack.coats.into_iter().map(united).collect()
}

struct Stack {
    /// With how many shapes each is of.
    coats: Vec<(Shape, usize)>,
    /// The coats of a paint, the lowest first.
    of_paint: BTreeMap<([u8; 3], u64), Vec<usize>>,
    /// One more than the highest coat.
    heights: Heights,
}

impl Stack {
    fn lay(&mut self, shape: Shape) {
        let Some(bounds) = shape.bounds() else {
            return; // a filled line
        };
        let above = self.heights.highest(&bounds);
        // On its own paint, unless what is below would be seen twice through it.
        let lowest = above.saturating_sub(usize::from(shape.paint.is_opaque()));
        let key = (shape.paint.colour.0, shape.paint.opacity.to_bits());
        let own = self.of_paint.entry(key).or_default();
        let Some(&at) = own.get(own.partition_point(|&coat| coat < lowest)) else {
            own.push(self.coats.len());
            self.coats.push((shape, 1));
            return self.heights.raise(&bounds, self.coats.len());
        };
        self.heights.raise(&bounds, at + 1);
        let (coat, count) = &mut self.coats[at];
        coat.rings.extend(shape.rings);
        *count += 1;
    }
}
