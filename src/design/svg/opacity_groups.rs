//! Groups that cover only a share of what is below.

use super::ink_layers::difference;
use super::paint_layers::merge_shapes;
use super::shape::SvgShape;
use crate::colour::Paint;
use crate::geometry::{Bounds, DVec2};

/// Most shapes of a group that are taken from each other.
const MAX_SHAPES: usize = 4096;

/// Most points of them, each as often as it is in an operation: about a second.
const MAX_POINTS: usize = 1_000_000;

/// The shapes of a group of so much opacity, and whether they look as drawn: what
/// lies under another shape of the group is not seen through it. They do not where
/// that would take too long, or where a shape lets others of the group through.
pub(super) fn apply_group_opacity(
    shapes: Vec<SvgShape>,
    opacity: f64,
    page: DVec2,
) -> (Vec<SvgShape>, bool) {
    let shapes = shapes.into_iter().flat_map(SvgShape::apart).collect();
    // Those of one paint are one, or their seams would be seen.
    let mut shapes = merge_shapes(shapes, page);
    let boxes: Vec<Option<Bounds>> = shapes.iter().map(SvgShape::bounds).collect();
    let over =
        |k: usize, above: usize| boxes[k].zip(boxes[above]).is_some_and(|(a, b)| a.meets(&b));
    let mut points_left = MAX_POINTS;
    let mut is_as_drawn = shapes.len() <= MAX_SHAPES;
    let parted = if is_as_drawn { shapes.len() } else { 0 };
    for k in 0..parted {
        for above in (k + 1..parted).filter(|&above| over(k, above)) {
            let (lower, upper) = shapes.split_at_mut(above);
            let (shape, above) = (&mut lower[k], &upper[0]);
            let points = shape.points() + above.points();
            if points > points_left || !above.paint.is_opaque() {
                is_as_drawn = false;
                continue;
            }
            points_left -= points;
            shape.rings = difference(&shape.rings, &above.rings);
        }
    }
    let fade = |paint: Paint| Paint {
        opacity: opacity * paint.opacity,
        ..paint
    };
    for shape in &mut shapes {
        shape.paint = fade(shape.paint);
        shape.gradient = shape
            .gradient
            .take()
            .map(|gradient| gradient.repainted(fade));
    }
    (shapes, is_as_drawn)
}
