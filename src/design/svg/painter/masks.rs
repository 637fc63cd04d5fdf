//! Masks (CSS Masking 1): the areas of a mask, each with the opacity that its luminance or alpha
//! gives, are cut out of the masked shapes.

use super::SvgPainter;
use crate::colour::Paint;
use crate::design::svg::error::SvgError;
use crate::design::svg::flat_areas::{FlatArea, flatten};
use crate::design::svg::ink_layers::{WindingRings, clip_rings};
use crate::design::svg::shape::SvgShape;
use crate::geometry::Bounds;
use usvg::{Mask, MaskType, Transform};

/// Lowest opacity that counts as visible, and distance to 1 that counts as opaque (tolerance: half
/// of a step of an 8-bit channel).
const MIN_OPACITY: f64 = 0.5 / 255.0;

impl SvgPainter<'_> {
    /// Applies a mask to shapes. `frame` maps the coordinates of the masked group to the page.
    pub(in crate::design::svg) fn masked(
        &mut self,
        shapes: Vec<SvgShape>,
        mask: &Mask,
        frame: Transform,
    ) -> Result<Vec<SvgShape>, SvgError> {
        let levels = self.mask_levels(mask, frame)?;
        let shapes = shapes.into_iter().flat_map(SvgShape::split_stroke);
        Ok(shapes
            .flat_map(|shape| masked_shape(&shape, &levels))
            .collect())
    }

    /// Returns the areas of a mask with their opacities.
    fn mask_levels(&mut self, mask: &Mask, frame: Transform) -> Result<Vec<MaskLevel>, SvgError> {
        let rect = mask.rect();
        let rect = [rect.x(), rect.y(), rect.width(), rect.height()].map(f64::from);
        let region = self.rectangle(rect, frame);
        let mut content =
            self.collect(|painter| painter.inner_tree(mask.root(), frame, Some(&region)))?;
        if let Some(outer) = mask.mask() {
            content = self.masked(content, outer, frame)?;
        }
        let flat = flatten(content.iter(), None);
        let is_soft = flat.areas.iter().any(|area| area.gradient.is_some());
        if is_soft {
            self.approximate("mask with a gradient", "replaced by its mean opacity");
        } else if !flat.is_exact {
            self.approximate("mask", "painted approximately");
        }
        let level = |area: FlatArea| MaskLevel {
            opacity: match mask.kind() {
                MaskType::Luminance => luminance(area.paint),
                MaskType::Alpha => area.paint.opacity,
            },
            bounds: Bounds::of(area.rings.iter().flatten().copied()),
            rings: area.rings,
        };
        let levels = flat.areas.into_iter().map(level);
        Ok(levels.filter(|level| level.opacity > MIN_OPACITY).collect())
    }
}

/// Area of a mask with the same opacity everywhere.
struct MaskLevel {
    rings: WindingRings,
    bounds: Option<Bounds>,
    opacity: f64,
}

/// Returns the luminance of a paint over black (CSS Masking 1, section 7.10.1).
fn luminance(paint: Paint) -> f64 {
    let [r, g, b] = paint.colour.0.map(|channel| f64::from(channel) / 255.0);
    (0.2125 * r + 0.7154 * g + 0.0721 * b) * paint.opacity
}

/// Returns the parts of a shape that a mask leaves visible.
fn masked_shape(shape: &SvgShape, levels: &[MaskLevel]) -> Vec<SvgShape> {
    let bounds = shape.bounds();
    let meets = |level: &&MaskLevel| level.bounds.zip(bounds).is_some_and(|(a, b)| a.meets(&b));
    let visible = levels.iter().filter(meets).map(|level| {
        let opacity = match level.opacity > 1.0 - MIN_OPACITY {
            true => 1.0,
            false => level.opacity,
        };
        let fade = |paint: Paint| Paint {
            opacity: opacity * paint.opacity,
            ..paint
        };
        SvgShape {
            rings: clip_rings(shape.rings.clone(), Some(&level.rings)),
            paint: fade(shape.paint),
            gradient: shape
                .gradient
                .as_ref()
                .map(|gradient| gradient.map_paints(fade)),
            is_stroke: shape.is_stroke,
            is_text: shape.is_text,
            stroke: None,
            name: shape.name.clone(),
        }
    });
    visible.filter(|part| !part.rings.is_empty()).collect()
}
