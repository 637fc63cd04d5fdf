//! Applies the opacity of a group to its shapes.

use super::ink_layers::difference;
use super::paint_layers::merge_shapes;
use super::shape::SvgShape;
use crate::colour::Paint;
use crate::geometry::{Bounds, DVec2};

/// Maximum number of shapes in a group. In a larger group, covered areas are not subtracted
/// (resource limit: the shapes are compared in pairs).
const MAX_SHAPES: usize = 4096;

/// Maximum total number of points in the Boolean operations on a group (resource limit: about
/// one second).
const MAX_POINTS: usize = 1_000_000;

/// Applies a group's opacity to its shapes; returns the shapes, and whether the result is exact.
///
/// SVG fades the group as a whole, so a shape must not show through another shape of the group.
/// Covered areas are therefore subtracted before each shape is faded separately. The result is
/// inexact if the subtraction would exceed a limit, or if a covering shape is itself translucent.
pub(super) fn apply_group_opacity(
    shapes: Vec<SvgShape>,
    opacity: f64,
    page: DVec2,
) -> (Vec<SvgShape>, bool) {
    let shapes = shapes
        .into_iter()
        .flat_map(SvgShape::split_stroke)
        .collect();
    // Shapes of equal paint are united; otherwise their overlaps and common edges would become
    // visible.
    let mut shapes = merge_shapes(shapes, page);
    let boxes: Vec<Option<Bounds>> = shapes.iter().map(SvgShape::bounds).collect();
    let may_overlap =
        |k: usize, above: usize| boxes[k].zip(boxes[above]).is_some_and(|(a, b)| a.meets(&b));
    let mut points_left = MAX_POINTS;
    let mut is_exact = shapes.len() <= MAX_SHAPES;
    let subtracted = if is_exact { shapes.len() } else { 0 };
    for k in 0..subtracted {
        for above in (k + 1..subtracted).filter(|&above| may_overlap(k, above)) {
            let (lower, upper) = shapes.split_at_mut(above);
            let (shape, above) = (&mut lower[k], &upper[0]);
            let points = shape.points() + above.points();
            if points > points_left || !above.paint.is_opaque() {
                is_exact = false;
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
            .map(|gradient| gradient.map_paints(fade));
    }
    (shapes, is_exact)
}
