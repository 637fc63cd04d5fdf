//! Merges the shapes of a drawing into as few paint layers as the painting order allows.
//!
//! Each shape goes into the lowest layer with the same paint that lies above everything of another
//! paint that the shape might cover. Translucent shapes and shapes with a stroke must not overlap
//! within a layer. All letters of a word thus share one layer.

use super::ink_layers::{WindingRings, union};
use super::shape::SvgShape;
use super::z_order::ZOrderGrid;
use crate::colour::{Gradient, GradientGeometry, Paint, StrokeJoin};
use crate::design::paint_layer::PaintLayer;
use crate::geometry::{DVec2, FillRule, Regions};
use std::collections::BTreeMap;

/// Merges shapes into paint layers, lowest first. `page` is the size of the drawing.
pub(super) fn paint_layers(shapes: Vec<SvgShape>, page: DVec2) -> Vec<PaintLayer> {
    let layer = |shape: SvgShape| {
        // Shapes without area are invisible.
        let regions = Regions::from_rings(&shape.rings, FillRule::NonZero).ok()?;
        Some(PaintLayer {
            regions,
            paint: Some(shape.paint),
            gradient: shape.gradient,
            line: shape.stroke.map(|edge| edge.line),
            name: shape.name,
            is_text: shape.is_text,
        })
    };
    merge_shapes(shapes, page)
        .into_iter()
        .filter_map(layer)
        .collect()
}

/// Merges shapes of a drawing without colours into layers without paint, by their names. Returns no
/// layers if no shape has a name.
pub(super) fn uncoloured_layers(shapes: Vec<SvgShape>, page: DVec2) -> Vec<PaintLayer> {
    if shapes.iter().all(|shape| shape.name.is_empty()) {
        return Vec::new();
    }
    let shapes = shapes.into_iter().flat_map(SvgShape::split_stroke);
    let layers = paint_layers(shapes.collect(), page).into_iter();
    let uncoloured = layers.map(|layer| PaintLayer {
        paint: None,
        gradient: None,
        ..layer
    });
    uncoloured.collect()
}

/// Merges shapes of equal paint and name into as few shapes as their order allows. `page` is the
/// size of the drawing.
pub(super) fn merge_shapes(shapes: Vec<SvgShape>, page: DVec2) -> Vec<SvgShape> {
    let mut stack = PaintStack {
        layers: Vec::new(),
        layers_by_key: BTreeMap::new(),
        z_order: ZOrderGrid::of_page(page),
    };
    shapes.into_iter().for_each(|shape| stack.push(shape));
    let unite = |(shape, more): (SvgShape, Vec<WindingRings>)| match more.is_empty() {
        true => shape,
        false => SvgShape {
            rings: union([vec![shape.rings], more].concat()),
            ..shape
        },
    };
    stack.layers.into_iter().map(unite).collect()
}

/// Attributes that all shapes of one layer share. Shapes with equal keys may be put into one layer.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct LayerKey {
    is_text: bool,
    name: String,
    paint: PaintKey,
    gradient: Option<Vec<u64>>,
    /// Stroke along the outlines.
    line: Option<StrokeKey>,
}

/// Colour and opacity of a paint, comparable bit by bit.
type PaintKey = ([u8; 3], u64);

/// Paint, width, join and order of a stroke, comparable bit by bit.
type StrokeKey = (PaintKey, u64, (u8, u64), bool);

impl LayerKey {
    fn of(shape: &SvgShape) -> Self {
        let bits = |paint: Paint| (paint.colour.0, paint.opacity.to_bits());
        let line = shape.stroke.as_ref().map(|edge| {
            let join = match edge.line.join {
                StrokeJoin::Mitre(limit) => (0, limit.to_bits()),
                StrokeJoin::Round => (1, 0),
                StrokeJoin::Bevel => (2, 0),
            };
            let width = edge.line.width.to_bits();
            (bits(edge.line.paint), width, join, edge.line.is_below_fill)
        });
        Self {
            is_text: shape.is_text,
            name: shape.name.clone(),
            paint: bits(shape.paint),
            gradient: shape.gradient.as_ref().map(gradient_bits),
            line,
        }
    }
}

/// Returns all parameters of a gradient as comparable bits.
fn gradient_bits(gradient: &Gradient) -> Vec<u64> {
    let course = match gradient.geometry {
        GradientGeometry::Linear => [0.0; 3],
        GradientGeometry::Radial { focus, inner } => [focus.x, focus.y, 1.0 + inner],
    };
    let stops = gradient.stops.iter().flat_map(|stop| {
        let [r, g, b] = stop.paint.colour.0.map(f64::from);
        [stop.offset, r, g, b, stop.paint.opacity]
    });
    let spread = [gradient.spread as u8].map(f64::from);
    let frame = gradient.frame.to_cols_array();
    let all = course.into_iter().chain(frame).chain(spread).chain(stops);
    all.map(f64::to_bits).collect()
}

/// Stack of paint layers under construction.
struct PaintStack {
    /// Layers from bottom to top: for each, its first shape and the rings of its other shapes.
    layers: Vec<(SvgShape, Vec<WindingRings>)>,
    /// For each key, the indices of its layers in ascending order.
    layers_by_key: BTreeMap<LayerKey, Vec<usize>>,
    /// For each grid cell of the page, one plus the index of its top layer; 0 if the cell is empty.
    z_order: ZOrderGrid,
}

impl PaintStack {
    /// Adds a shape on top of all earlier shapes.
    fn push(&mut self, shape: SvgShape) {
        let Some(bounds) = shape.bounds() else {
            return; // a shape without points
        };
        let above = self.z_order.highest(&bounds);
        // The shape may join the top layer even if it overlaps shapes of that layer, with two
        // exceptions: the overlap of translucent shapes would be darker, and the stroke of a shape
        // would be visible inside the union.
        let may_unite = shape.paint.is_opaque() && shape.stroke.is_none();
        let lowest = above.saturating_sub(usize::from(may_unite));
        let same_key = self.layers_by_key.entry(LayerKey::of(&shape)).or_default();
        let first_allowed = same_key.partition_point(|&layer| layer < lowest);
        let Some(&index) = same_key.get(first_allowed) else {
            same_key.push(self.layers.len());
            self.layers.push((shape, Vec::new()));
            return self.z_order.raise(&bounds, self.layers.len());
        };
        self.z_order.raise(&bounds, index + 1);
        let (first, others) = &mut self.layers[index];
        others.push(shape.rings);
        if let Some((all, more)) = first.stroke.as_mut().zip(shape.stroke) {
            all.rings.extend(more.rings);
        }
    }
}
