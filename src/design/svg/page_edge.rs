//! Cuts the shapes of a drawing at the edge of its page, as browsers do.

use super::ink_layers::{WindingRings, clip_rings};
use super::painter::PaintedDrawing;
use super::shape::SvgShape;
use crate::geometry::{Bounds, DVec2};

/// Distance by which a shape may leave the page without being cut, as a fraction of the page's
/// longer side (tolerance: coordinates are `f32`).
const EDGE_TOLERANCE: f64 = 1e-6;

/// Cuts shapes at the edge of the page. If nothing lies on the page, all shapes stay, and this is
/// reported.
pub(super) fn cut_at_page(painted: &mut PaintedDrawing, page: DVec2) {
    let margin = DVec2::splat(EDGE_TOLERANCE * page.max_element());
    let inside = Bounds {
        min: -margin,
        max: page + margin,
    };
    let is_within =
        |bounds: Bounds| bounds.min.cmpge(inside.min).all() && bounds.max.cmple(inside.max).all();
    let meets = |shape: &SvgShape| shape.bounds().is_some_and(|bounds| bounds.meets(&inside));
    if !painted.shapes.iter().any(meets) {
        if !painted.shapes.is_empty() {
            let kept = "kept, although browsers show an empty page";
            painted
                .lost
                .replace("content outside of the page", kept, "<svg>");
        }
        return;
    }
    let corners = [
        DVec2::ZERO,
        DVec2::new(page.x, 0.0),
        page,
        DVec2::new(0.0, page.y),
    ];
    let edge: WindingRings = vec![corners.to_vec()];
    let shapes = std::mem::take(&mut painted.shapes);
    painted.shapes = shapes
        .into_iter()
        .flat_map(|shape| match shape.bounds() {
            None => vec![shape],
            Some(bounds) if is_within(bounds) => vec![shape],
            Some(bounds) if !bounds.meets(&inside) => Vec::new(),
            Some(_) => cut(shape, &edge),
        })
        .collect();
}

/// Cuts one shape; its attached stroke becomes a shape, since it does not follow the cut.
fn cut(shape: SvgShape, edge: &WindingRings) -> Vec<SvgShape> {
    let parts = shape.split_stroke().map(|part| SvgShape {
        rings: clip_rings(part.rings, Some(edge)),
        ..part
    });
    parts.filter(|part| !part.rings.is_empty()).collect()
}
