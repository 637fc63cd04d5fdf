//! A drawing as coats of paint, as few as its order asks for.
//!
//! Shapes of one paint that lie on or beside each other are one coat: a word is
//! one, however many letters it has. A shape goes into the lowest coat of its
//! paint that is above all that it might hide.

use super::ink_layers::{WindingRings, union};
use super::shape::SvgShape;
use super::z_order::ZOrderGrid;
use crate::colour::{Gradient, GradientGeometry, Paint, StrokeJoin};
use crate::design::paint_layer::PaintLayer;
use crate::geometry::{DVec2, FillRule, Regions};
use std::collections::BTreeMap;

/// The coats of these shapes, the lowest first; of a drawing of this size.
pub(super) fn paint_layers(shapes: Vec<SvgShape>, page: DVec2) -> Vec<PaintLayer> {
    let coat = |shape: SvgShape| {
        // What encloses nothing is not seen.
        let regions = Regions::from_rings(&shape.rings, FillRule::NonZero).ok()?;
        Some(PaintLayer {
            regions,
            paint: Some(shape.paint),
            gradient: shape.gradient,
            line: shape.edge.map(|edge| edge.line),
            name: shape.name,
            is_text: shape.is_text,
        })
    };
    merge_shapes(shapes, page)
        .into_iter()
        .filter_map(coat)
        .collect()
}

/// As few shapes as the order of these allows; what is one of several has no
/// name.
pub(super) fn merge_shapes(shapes: Vec<SvgShape>, page: DVec2) -> Vec<SvgShape> {
    let mut stack = PaintStack {
        coats: Vec::new(),
        of_paint: BTreeMap::new(),
        heights: ZOrderGrid::of_page(page),
    };
    shapes.into_iter().for_each(|shape| stack.lay(shape));
    let united = |(shape, more): (SvgShape, Vec<WindingRings>)| match more.is_empty() {
        true => shape,
        false => SvgShape {
            rings: union([vec![shape.rings], more].concat()),
            name: String::new(),
            ..shape
        },
    };
    stack.coats.into_iter().map(united).collect()
}

/// What shapes of one coat have in common.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct LayerKey {
    is_text: bool,
    paint: PaintKey,
    gradient: Option<Vec<u64>>,
    /// Paint, width and join of the line.
    line: Option<(PaintKey, u64, (u8, u64))>,
}

type PaintKey = ([u8; 3], u64);

impl LayerKey {
    fn of(shape: &SvgShape) -> Self {
        let bits = |paint: Paint| (paint.colour.0, paint.opacity.to_bits());
        let line = shape.edge.as_ref().map(|edge| {
            let join = match edge.line.join {
                StrokeJoin::Mitre(limit) => (0, limit.to_bits()),
                StrokeJoin::Round => (1, 0),
                StrokeJoin::Bevel => (2, 0),
            };
            (bits(edge.line.paint), edge.line.width.to_bits(), join)
        });
        Self {
            is_text: shape.is_text,
            paint: bits(shape.paint),
            gradient: shape.gradient.as_ref().map(numbers),
            line,
        }
    }
}

/// All that a gradient consists of.
fn numbers(gradient: &Gradient) -> Vec<u64> {
    let course = match gradient.course {
        GradientGeometry::Straight => [0.0; 3],
        GradientGeometry::Round { focus, inner } => [focus.x, focus.y, 1.0 + inner],
    };
    let stops = gradient.stops.iter().flat_map(|stop| {
        let [r, g, b] = stop.paint.colour.0.map(f64::from);
        [stop.at, r, g, b, stop.paint.opacity]
    });
    let spread = [gradient.spread as u8].map(f64::from);
    let frame = gradient.frame.to_cols_array();
    let all = course.into_iter().chain(frame).chain(spread).chain(stops);
    all.map(f64::to_bits).collect()
}

struct PaintStack {
    /// Each as its first shape and the rings of the others.
    coats: Vec<(SvgShape, Vec<WindingRings>)>,
    /// The coats of a paint, the lowest first.
    of_paint: BTreeMap<LayerKey, Vec<usize>>,
    /// One more than the highest coat.
    heights: ZOrderGrid,
}

impl PaintStack {
    fn lay(&mut self, shape: SvgShape) {
        let Some(bounds) = shape.bounds() else {
            return; // a filled line
        };
        let above = self.heights.highest(&bounds);
        // On its own paint, unless what is below would be seen twice through it, or a
        // line runs along it.
        let may_unite = shape.paint.is_opaque() && shape.edge.is_none();
        let lowest = above.saturating_sub(usize::from(may_unite));
        let own = self.of_paint.entry(LayerKey::of(&shape)).or_default();
        let Some(&at) = own.get(own.partition_point(|&coat| coat < lowest)) else {
            own.push(self.coats.len());
            self.coats.push((shape, Vec::new()));
            return self.heights.raise(&bounds, self.coats.len());
        };
        self.heights.raise(&bounds, at + 1);
        let (coat, others) = &mut self.coats[at];
        others.push(shape.rings);
        if let Some((all, more)) = coat.edge.as_mut().zip(shape.edge) {
            all.rings.extend(more.rings);
        }
    }
}
