//! Groups that cover only a share of what is below.

use super::coats::merged;
use super::layers::minus;
use super::shape::Shape;
use crate::geometry::{Bounds, DVec2};

/// The shapes of a group of so much opacity: what lies under another shape of the
/// group is not seen through it.
pub(super) fn faded(shapes: Vec<Shape>, opacity: f64, page: DVec2) -> Vec<Shape> {
    let shapes = shapes.into_iter().flat_map(Shape::apart).collect();
    // Those of one paint are one, or their seams would be seen.
    let mut shapes = merged(shapes, page);
    for k in 0..shapes.len() {
        let (lower, upper) = shapes.split_at_mut(k + 1);
        let shape = &mut lower[k];
        for above in upper.iter().filter(|above| above.paint.is_opaque()) {
            let meet = |(a, b): (Bounds, Bounds)| a.meets(&b);
            if shape.bounds().zip(above.bounds()).is_some_and(meet) {
                shape.rings = minus(&shape.rings, &above.rings);
            }
        }
    }
    for shape in &mut shapes {
        shape.paint.opacity *= opacity;
    }
    shapes
}
