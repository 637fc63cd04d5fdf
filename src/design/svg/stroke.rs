//! Strokes that go along with what they go around.

use super::ink_layers::WindingRings;
use crate::colour::{Paint, StrokeJoin, StrokeStyle};
use crate::geometry::DVec2;
use usvg::{LineJoin, Path, tiny_skia_path};

/// A stroke along the rings of a shape.
pub(super) struct ShapeStroke {
    pub line: StrokeStyle,
    /// What it covers, to be filled by winding.
    pub rings: WindingRings,
}

/// Whether every outline of a path is closed.
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

/// The stroke of a path as a line along its outlines, if it is one: without dashes,
/// and as wide in all directions.
pub(super) fn uniform_stroke(path: &Path, paint: Paint) -> Option<StrokeStyle> {
    let stroke = path
        .stroke()
        .filter(|stroke| stroke.dasharray().is_none())?;
    let [x, y] = {
        let t = path.abs_transform();
        [
            DVec2::new(t.sx.into(), t.ky.into()),
            DVec2::new(t.kx.into(), t.sy.into()),
        ]
    };
    let scale = x.length();
    let is_even =
        (y.length() - scale).abs() < EVEN * scale && x.dot(y).abs() < EVEN * scale * scale;
    let limit = f64::from(stroke.miterlimit().get());
    let join = match stroke.linejoin() {
        LineJoin::Miter | LineJoin::MiterClip => StrokeJoin::Mitre(limit),
        LineJoin::Round => StrokeJoin::Round,
        LineJoin::Bevel => StrokeJoin::Bevel,
    };
    is_even.then(|| StrokeStyle {
        paint,
        width: scale * f64::from(stroke.width().get()),
        join,
    })
}

/// By what share the two axes of a transform may differ in length and from a right
/// angle: transforms are `f32`.
const EVEN: f64 = 1e-4;
