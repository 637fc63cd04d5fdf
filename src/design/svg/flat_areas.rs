//! Flattens stacked shapes to areas that do not overlap, each with the paint that is visible there.

use super::ink_layers::{WindingRings, clip_rings, difference};
use super::shape::{SvgShape, in_drawing_order};
use crate::colour::{Gradient, Paint, Rgb};
use crate::geometry::Bounds;

/// Maximum number of areas (resource limit: each shape is cut by each area).
const MAX_AREAS: usize = 512;

/// Maximum total number of points in the Boolean operations (resource limit: about one second).
const MAX_POINTS: usize = 500_000;

/// Area with its visible paint.
pub(super) struct FlatArea {
    pub rings: WindingRings,
    pub paint: Paint,
    /// Gradient of the area, if the shape on top is opaque or nothing lies below it.
    pub gradient: Option<Gradient>,
}

/// Result of [`flatten`].
pub(super) struct FlatAreas {
    pub areas: Vec<FlatArea>,
    /// Whether the result is exact: no limit was reached, and no gradient lies in a stack of
    /// translucent shapes.
    pub is_exact: bool,
}

/// Flattens shapes, lowest first. If `within` is given, only what lies in it is returned.
pub(super) fn flatten<'s>(
    shapes: impl Iterator<Item = &'s SvgShape>,
    within: Option<&WindingRings>,
) -> FlatAreas {
    let mut flat = FlatAreas {
        areas: Vec::new(),
        is_exact: true,
    };
    let mut points_left = MAX_POINTS;
    for shape in shapes {
        for part in shape.parts() {
            flat.cover(part, within, &mut points_left);
        }
    }
    flat.areas.retain(|area| !area.rings.is_empty());
    flat
}

impl FlatAreas {
    /// Paints a shape on top of the areas.
    fn cover(&mut self, shape: FlatArea, within: Option<&WindingRings>, points_left: &mut usize) {
        let mut shape = FlatArea {
            rings: clip_rings(shape.rings, within),
            ..shape
        };
        let points = |rings: &WindingRings| rings.iter().map(Vec::len).sum::<usize>();
        let Some(bounds) = bounds(&shape.rings) else {
            return;
        };
        if self.areas.len() > MAX_AREAS || *points_left == 0 {
            self.is_exact = false;
            return;
        }
        let mut mixed = Vec::new();
        let mut rest = shape.rings.clone();
        for below in &mut self.areas {
            let meets = self::bounds(&below.rings).is_some_and(|other| other.meets(&bounds));
            if !meets {
                continue;
            }
            let cost = points(&below.rings) + points(&shape.rings);
            *points_left = points_left.saturating_sub(cost);
            if !shape.paint.is_opaque() {
                let common = clip_rings(below.rings.clone(), Some(&shape.rings));
                if common.is_empty() {
                    continue;
                }
                self.is_exact &= shape.gradient.is_none() && below.gradient.is_none();
                rest = difference(&rest, &common);
                mixed.push(FlatArea {
                    rings: common,
                    paint: over(shape.paint, below.paint),
                    gradient: None,
                });
            }
            below.rings = difference(&below.rings, &shape.rings);
        }
        self.areas.append(&mut mixed);
        shape.rings = rest;
        self.areas.push(shape);
    }
}

fn bounds(rings: &WindingRings) -> Option<Bounds> {
    Bounds::of(rings.iter().flatten().copied())
}

/// Composites a paint over another one (Porter and Duff 1984, source over).
fn over(above: Paint, below: Paint) -> Paint {
    let (a, b) = (above.opacity, below.opacity * (1.0 - above.opacity));
    let opacity = a + b;
    let channel = |k: usize| {
        let [c, d] = [above, below].map(|paint| f64::from(paint.colour.0[k]));
        ((a * c + b * d) / opacity).round() as u8
    };
    match opacity > 0.0 {
        true => Paint {
            colour: Rgb(std::array::from_fn(channel)),
            opacity,
        },
        false => above,
    }
}

impl SvgShape {
    /// Returns the fill, if visible, and the attached stroke, if any, as areas, the lower first.
    fn parts(&self) -> impl Iterator<Item = FlatArea> {
        let fill = (self.paint.opacity > 0.0).then(|| FlatArea {
            rings: self.rings.clone(),
            paint: self.paint,
            gradient: self.gradient.clone(),
        });
        let stroke = self.stroke.as_ref().map(|edge| FlatArea {
            rings: edge.rings.clone(),
            paint: edge.line.paint,
            gradient: None,
        });
        let edge = self.stroke.as_ref();
        in_drawing_order(
            fill,
            stroke,
            edge.is_some_and(|edge| edge.line.is_below_fill),
        )
    }
}
