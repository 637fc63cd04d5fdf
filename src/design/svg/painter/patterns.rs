//! Paints areas with patterns: the content of a tile is painted once and repeated.

use super::SvgPainter;
use crate::colour::Paint;
use crate::design::svg::error::SvgError;
use crate::design::svg::ink_layers::{WindingRings, clip_rings, union};
use crate::design::svg::opacity_groups::apply_group_opacity;
use crate::design::svg::resolved_paint::affine;
use crate::design::svg::shape::SvgShape;
use crate::geometry::{Bounds, DAffine2, DVec2};
use usvg::{Opacity, Pattern};

/// Maximum number of tiles that are drawn (resource limit: fine hatchings would become thousands of
/// parts).
const MAX_TILES: usize = 1024;

/// Maximum number of points of all tiles together (resource limit: about one second).
const MAX_POINTS: usize = 200_000;

/// Maximum number of tiles with gradients, each of which is a shape of its own (resource limit: as
/// many parts as a drawing usually has).
const MAX_GRADIENT_TILES: usize = 64;

impl SvgPainter<'_> {
    /// Adds the area `rings` of a path in the current group, painted with a pattern. A pattern with
    /// too many tiles is replaced by its mean colour.
    pub(in crate::design::svg) fn add_pattern(
        &mut self,
        rings: WindingRings,
        pattern: &Pattern,
        opacity: Opacity,
    ) -> Result<(), SvgError> {
        let frame = self.frame.pre_concat(pattern.transform());
        let rect = pattern.rect();
        let [x, y, w, h] = [rect.x(), rect.y(), rect.width(), rect.height()].map(f64::from);
        // The content is placed relative to the corner of the tile.
        let content = frame.pre_translate(rect.x(), rect.y());
        let tile = self.rectangle([0.0, 0.0, w, h], content);
        let root = pattern.root();
        let shapes = self.collect(|painter| painter.inner_tree(root, content, Some(&tile)))?;
        let Some(bounds) = Bounds::of(rings.iter().flatten().copied()) else {
            return Ok(());
        };
        let flip_y = DAffine2::from_cols_array(&[1.0, 0.0, 0.0, -1.0, 0.0, self.page.y]);
        let offsets = tile_offsets(flip_y * affine(frame), [x, y, w, h], &bounds);
        let points: usize = shapes.iter().map(SvgShape::points).sum();
        let offsets = offsets.filter(|offsets| points * offsets.len() <= MAX_POINTS);
        let mut shapes: Vec<_> = shapes
            .into_iter()
            .flat_map(SvgShape::split_stroke)
            .collect();
        let Some(offsets) = offsets else {
            let tile_area = area(&tile);
            let mean = mean_paint(&shapes, tile_area);
            self.approximate("pattern with many tiles", "replaced by its mean colour");
            let opacity = mean.opacity * f64::from(opacity.get());
            self.add_shape(rings, Paint { opacity, ..mean }, None);
            return Ok(());
        };
        if offsets.len() > MAX_GRADIENT_TILES && shapes.iter().any(|s| s.gradient.is_some()) {
            self.approximate("gradient in a pattern", "replaced by its mean colour");
            shapes.iter_mut().for_each(|shape| shape.gradient = None);
        }
        let mut repeated: Vec<_> = shapes
            .into_iter()
            .flat_map(|shape| repeat_shape(&shape, &offsets, &rings))
            .collect();
        let opacity = f64::from(opacity.get());
        if opacity < 1.0 {
            (repeated, _) = apply_group_opacity(repeated, opacity, self.page);
        }
        for shape in repeated {
            self.add_shape(shape.rings, shape.paint, shape.gradient);
        }
        Ok(())
    }
}

/// Returns the offsets of the tiles that cover a box, on the page; `None` if there are too many.
/// `frame` maps the coordinates of the pattern to the page.
fn tile_offsets(frame: DAffine2, [x, y, w, h]: [f64; 4], bounds: &Bounds) -> Option<Vec<DVec2>> {
    let to_tiles = frame.inverse();
    let corners = [
        bounds.min,
        bounds.max,
        DVec2::new(bounds.min.x, bounds.max.y),
        DVec2::new(bounds.max.x, bounds.min.y),
    ];
    let corners =
        corners.map(|p| (to_tiles.transform_point2(p) - DVec2::new(x, y)) / DVec2::new(w, h));
    let covered = Bounds::of(corners).filter(|covered| covered.size().is_finite())?;
    let (first, last) = (covered.min.floor(), covered.max.floor());
    let count = last - first + DVec2::ONE;
    // The bounds are finite, so the count is a number.
    if count.x * count.y > MAX_TILES as f64 {
        return None;
    }
    let offset = |i: usize, j: usize| {
        let step = first + DVec2::new(i as f64, j as f64);
        frame.transform_vector2(step * DVec2::new(w, h))
    };
    let (columns, rows) = (count.x as usize, count.y as usize);
    let places = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    Some(places.map(|(i, j)| offset(i, j)).collect())
}

/// Repeats a shape at all offsets, cut to the painted area. The copies are one shape, except those
/// with gradients.
fn repeat_shape(shape: &SvgShape, offsets: &[DVec2], area: &WindingRings) -> Vec<SvgShape> {
    let moved = |offset: &DVec2| -> WindingRings {
        let rings = shape.rings.iter();
        rings
            .map(|ring| ring.iter().map(|p| *p + *offset).collect())
            .collect()
    };
    let copy = |rings: WindingRings, gradient| SvgShape {
        rings: clip_rings(rings, Some(area)),
        paint: shape.paint,
        gradient,
        is_stroke: false,
        is_text: shape.is_text,
        stroke: None,
        name: shape.name.clone(),
    };
    let copies = match &shape.gradient {
        None => vec![copy(union(offsets.iter().map(moved).collect()), None)],
        Some(gradient) => {
            let placed = |offset: &DVec2| gradient.transformed(DAffine2::from_translation(*offset));
            let copies = offsets
                .iter()
                .map(|offset| copy(moved(offset), Some(placed(offset))));
            copies.collect()
        }
    };
    copies
        .into_iter()
        .filter(|copy| !copy.rings.is_empty())
        .collect()
}

/// Returns the mean paint of a tile.
fn mean_paint(shapes: &[SvgShape], tile: f64) -> Paint {
    let weights = shapes.iter().map(|shape| (shape.paint, area(&shape.rings)));
    let covered: f64 = weights
        .clone()
        .map(|(paint, area)| paint.opacity * area)
        .sum();
    let mean = Paint::mean(weights);
    Paint {
        opacity: (covered / tile).clamp(0.0, 1.0),
        ..mean
    }
}

/// Returns the area that rings enclose.
fn area(rings: &WindingRings) -> f64 {
    let doubled = |ring: &Vec<DVec2>| -> f64 {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
    };
    rings.iter().map(doubled).sum::<f64>().abs() / 2.0
}
