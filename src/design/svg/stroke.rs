//! Strokes that stay attached to the outline of a shape instead of becoming shapes themselves.

use super::ink_layers::WindingRings;
use crate::colour::{Paint, StrokeJoin, StrokeStyle};
use crate::geometry::DVec2;
use usvg::{LineJoin, PaintOrder, Path, Transform, tiny_skia_path};

/// Stroke along the rings of a shape.
pub(super) struct ShapeStroke {
    /// Paint, width and join.
    pub line: StrokeStyle,
    /// Area of the stroke, filled by the non-zero rule.
    pub rings: WindingRings,
}

/// Returns whether every subpath of a path is closed.
pub(super) fn is_closed(path: &Path) -> bool {
    use tiny_skia_path::PathSegment::{Close, MoveTo};
    let mut is_open = false;
    for segment in path.data().segments() {
        match segment {
            MoveTo(_) if is_open => return false,
            MoveTo(_) | Close => is_open = false,
            _ => is_open = true,
        }
    }
    !is_open
}

/// Returns the stroke of a path in page units, where `t` maps the path to the page, or `None` if
/// the path has no stroke, the stroke has dashes, or the transform makes the width depend on the
/// direction.
pub(super) fn uniform_stroke(path: &Path, t: Transform, paint: Paint) -> Option<StrokeStyle> {
    let stroke = path
        .stroke()
        .filter(|stroke| stroke.dasharray().is_none())?;
    let [x, y] = [
        DVec2::new(t.sx.into(), t.ky.into()),
        DVec2::new(t.kx.into(), t.sy.into()),
    ];
    let scale = x.length();
    let is_similarity = (y.length() - scale).abs() < MAX_DISTORTION * scale
        && x.dot(y).abs() < MAX_DISTORTION * scale * scale;
    let limit = f64::from(stroke.miterlimit().get());
    let join = match stroke.linejoin() {
        LineJoin::Miter | LineJoin::MiterClip => StrokeJoin::Mitre(limit),
        LineJoin::Round => StrokeJoin::Round,
        LineJoin::Bevel => StrokeJoin::Bevel,
    };
    is_similarity.then(|| StrokeStyle {
        paint,
        width: scale * f64::from(stroke.width().get()),
        join,
        is_below_fill: path.paint_order() == PaintOrder::StrokeAndFill,
    })
}

/// Maximum distortion of a transform that counts as a similarity: relative difference between the
/// lengths of the transformed axes, and cosine of the angle between them (tolerance: transforms are
/// `f32`).
const MAX_DISTORTION: f64 = 1e-4;
