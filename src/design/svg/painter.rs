//! The shapes of a drawing: what each fill and each stroke covers, in the order
//! in which they are painted, with their paint.

use super::error::SvgError;
use super::ink_layers::{WindingRings, clipped};
use super::opacity_groups::apply_group_opacity;
use super::resolved_paint::{ResolvedPaint, affine, resolve_paint};
use super::shape::SvgShape;
use super::stroke;
use super::stroke::ShapeStroke;
use crate::colour::Paint;
use crate::design::flatten::Flattener;
use crate::geometry::{DAffine2, DVec2, FillRule, Regions, RegionsError, Repairs};
use usvg::{ClipPath, Group, Node, PaintOrder, Path, Stroke, Text, Transform, tiny_skia_path};

/// What of a drawing is read, and how.
pub(super) struct SvgReadOptions<'o> {
    /// In units of the page.
    pub tolerance: f64,
    pub element: Option<&'o str>,
}

/// All shapes of a drawing, and what was otherwise in it.
pub(super) struct PaintedDrawing {
    /// The lowest first.
    pub shapes: Vec<SvgShape>,
    /// Faults within single shapes, by the rule that resolved them.
    pub repairs: [(FillRule, Repairs); 2],
    /// Shapes without a fill whose stroke is seen.
    pub bare_strokes: usize,
    pub left_out: ApproximationCounts,
}

/// How many of what is not shown as it was drawn.
#[derive(Default)]
pub(super) struct ApproximationCounts {
    /// Patterns, and gradients along lines, of which the mean is shown.
    pub shades: usize,
    pub masks: usize,
    /// Letters that are pictures.
    pub glyphs: usize,
    /// Groups that are mixed with what is below otherwise than as drawn.
    pub blends: usize,
}

/// Width and height of a drawing.
pub(super) fn page_of(tree: &usvg::Tree) -> DVec2 {
    DVec2::new(tree.size().width().into(), tree.size().height().into())
}

/// Paints a drawing, or the element of it that is asked for.
pub(super) fn painted(
    tree: &usvg::Tree,
    brush: &SvgReadOptions,
) -> Result<PaintedDrawing, SvgError> {
    let mut painter = SvgPainter {
        page: page_of(tree),
        flattener: Flattener::new(brush.tolerance),
        brush,
        painted: PaintedDrawing {
            shapes: Vec::new(),
            repairs: [FillRule::NonZero, FillRule::EvenOdd].map(|rule| (rule, Repairs::default())),
            bare_strokes: 0,
            left_out: ApproximationCounts::default(),
        },
        is_drawn: false,
        is_lettering: false,
    };
    painter.group(tree.root(), None, brush.element.is_none())?;
    match brush.element {
        Some(id) if !painter.is_drawn => Err(SvgError::NotDrawn(id.to_owned())),
        _ => Ok(painter.painted),
    }
}

struct SvgPainter<'b> {
    page: DVec2,
    flattener: Flattener,
    brush: &'b SvgReadOptions<'b>,
    painted: PaintedDrawing,
    /// Whether there is a path in what is asked for, seen or not.
    is_drawn: bool,
    /// Whether what is painted is text.
    is_lettering: bool,
}

impl SvgPainter<'_> {
    /// Paints a group's children, inside `clip` and the group's own; outside
    /// of the element that is asked for only what belongs to it.
    fn group(
        &mut self,
        group: &Group,
        clip: Option<&WindingRings>,
        is_within: bool,
    ) -> Result<(), SvgError> {
        if group.opacity().get() == 0.0 {
            return Ok(());
        }
        self.count_left_out(group);
        let own = match group.clip_path() {
            Some(path) => {
                let inside = self.clip(path, group.abs_transform())?;
                Some(clipped(inside, clip))
            }
            None => None,
        };
        let clip = own.as_ref().or(clip);
        let first = self.painted.shapes.len();
        for node in group.children() {
            let is_within = is_within || self.brush.element == Some(node.id());
            match node {
                Node::Group(inner) => self.group(inner, clip, is_within)?,
                Node::Path(path) if is_within => self.path(path, path.id(), clip)?,
                Node::Text(text) if is_within => self.text(text, clip)?,
                Node::Path(_) | Node::Image(_) | Node::Text(_) => {}
            }
        }
        let opacity = f64::from(group.opacity().get());
        if opacity < 1.0 {
            let shapes = self.painted.shapes.split_off(first);
            let (shapes, is_as_drawn) = apply_group_opacity(shapes, opacity, self.page);
            self.painted.left_out.blends += usize::from(!is_as_drawn);
            self.painted.shapes.extend(shapes);
        }
        Ok(())
    }

    fn count_left_out(&mut self, group: &Group) {
        let left_out = &mut self.painted.left_out;
        left_out.masks += usize::from(group.mask().is_some());
        left_out.blends += usize::from(group.blend_mode() != usvg::BlendMode::Normal);
    }

    fn text(&mut self, text: &Text, clip: Option<&WindingRings>) -> Result<(), SvgError> {
        self.is_lettering = true;
        for node in text.flattened().children() {
            match node {
                Node::Path(path) => self.path(path, text.id(), clip)?,
                _ => self.painted.left_out.glyphs += 1,
            }
        }
        self.is_lettering = false;
        Ok(())
    }

    fn path(
        &mut self,
        path: &Path,
        name: &str,
        clip: Option<&WindingRings>,
    ) -> Result<(), SvgError> {
        self.is_drawn = true;
        if !path.is_visible() {
            return Ok(());
        }
        let mut fill = path
            .fill()
            .and_then(|fill| resolve_paint(fill.paint(), fill.opacity()));
        let stroke = path.stroke();
        let stroke = stroke.and_then(|stroke| resolve_paint(stroke.paint(), stroke.opacity()));
        self.painted.bare_strokes += usize::from(fill.is_none() && stroke.is_some());
        let is_mean = |tone: &ResolvedPaint| tone.is_mean;
        // Lines have one paint.
        let is_lost = |tone: &ResolvedPaint| tone.is_mean || tone.gradient.is_some();
        self.painted.left_out.shades += usize::from(fill.as_ref().is_some_and(is_mean));
        self.painted.left_out.shades += usize::from(stroke.as_ref().is_some_and(is_lost));
        let gradient = fill.as_mut().and_then(|tone| tone.gradient.take());
        let gradient = gradient.map(|gradient| gradient.moved(self.on_page(path)));
        let [fill, stroke] = [fill, stroke].map(|tone| tone.map(|tone| tone.paint));
        let first = self.painted.shapes.len();
        self.inked(path, (name, clip), (fill, stroke))?;
        // The fill is the first of them, or the second.
        let laid = &mut self.painted.shapes[first..];
        if let Some(shape) = laid.iter_mut().find(|shape| !shape.is_stroke) {
            shape.gradient = gradient;
        }
        Ok(())
    }

    /// From the space of a path to the page, y up.
    fn on_page(&self, path: &Path) -> DAffine2 {
        let up = DAffine2::from_cols_array(&[1.0, 0.0, 0.0, -1.0, 0.0, self.page.y]);
        up * affine(path.abs_transform())
    }

    /// Fills and strokes a path, in its order.
    fn inked(
        &mut self,
        path: &Path,
        (name, clip): (&str, Option<&WindingRings>),
        (fill, stroke): (Option<Paint>, Option<Paint>),
    ) -> Result<(), SvgError> {
        let fills_first = path.paint_order() == PaintOrder::FillAndStroke;
        if let Some(stroke) = stroke
            && fills_first
            && clip.is_none()
            && self.edged(path, name, (fill, stroke))?
        {
            return Ok(());
        }
        for is_fill in [fills_first, !fills_first] {
            if is_fill && let Some(paint) = fill {
                let rings = self.filled(path, Transform::identity())?;
                self.lay(name, (rings, clip), paint, false);
            } else if !is_fill && let Some(paint) = stroke {
                let rings = self.stroked(path)?;
                self.lay(name, (rings, clip), paint, true);
            }
        }
        Ok(())
    }

    fn lay(
        &mut self,
        name: &str,
        (rings, clip): (WindingRings, Option<&WindingRings>),
        paint: Paint,
        is_stroke: bool,
    ) {
        self.painted.shapes.push(SvgShape {
            rings: clipped(rings, clip),
            paint,
            gradient: None,
            is_stroke,
            is_text: self.is_lettering,
            edge: None,
            name: name.to_owned(),
        });
    }

    /// Paints a path whose stroke goes along what it encloses, and whether it does: its
    /// outlines are closed, and none crosses itself or another.
    fn edged(
        &mut self,
        path: &Path,
        name: &str,
        (fill, stroke): (Option<Paint>, Paint),
    ) -> Result<bool, SvgError> {
        let Some(line) = stroke::uniform_stroke(path, stroke).filter(|_| stroke::is_closed(path))
        else {
            return Ok(false);
        };
        let before = self.flattener.clone();
        let rings = self.rings(path.data(), path.abs_transform())?;
        let rule = match path.fill().map(usvg::Fill::rule) {
            Some(usvg::FillRule::NonZero) => FillRule::NonZero,
            // Without a fill all outlines are to stay.
            Some(usvg::FillRule::EvenOdd) | None => FillRule::EvenOdd,
        };
        let crossings = Repairs::between(&rings).crossings;
        let cleaned = cleaned(&rings, rule)?;
        if crossings > 0 || cleaned.len() != rings.len() {
            self.flattener = before; // it is flattened again, as what it fills
            return Ok(false);
        }
        let unseen = Paint {
            opacity: 0.0,
            ..stroke
        };
        let edge = ShapeStroke {
            line,
            rings: self.stroked(path)?,
        };
        self.painted.shapes.push(SvgShape {
            rings: cleaned,
            paint: fill.unwrap_or(unseen),
            gradient: None,
            is_stroke: false,
            is_text: self.is_lettering,
            edge: Some(edge),
            name: name.to_owned(),
        });
        Ok(true)
    }

    /// What a clip path lets through.
    fn clip(&mut self, clip: &ClipPath, group: Transform) -> Result<WindingRings, SvgError> {
        let mut rings = Vec::new();
        let base = group.pre_concat(clip.transform());
        self.clip_group(clip.root(), base, &mut rings)?;
        let outer = clip.clip_path().map(|outer| self.clip(outer, group));
        Ok(clipped(rings, outer.transpose()?.as_ref()))
    }

    fn clip_group(
        &mut self,
        group: &Group,
        base: Transform,
        rings: &mut WindingRings,
    ) -> Result<(), SvgError> {
        for node in group.children() {
            match node {
                Node::Path(path) if is_filled(path) => rings.extend(self.filled(path, base)?),
                Node::Group(inner) => {
                    let mut own = Vec::new();
                    self.clip_group(inner, base, &mut own)?;
                    let at = base.pre_concat(inner.abs_transform());
                    let inside = inner.clip_path().map(|clip| self.clip(clip, at));
                    rings.extend(clipped(own, inside.transpose()?.as_ref()));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The area that a path fills by its own rule, on the page, y up.
    fn filled(&mut self, path: &Path, base: Transform) -> Result<WindingRings, SvgError> {
        let rings = self.rings(path.data(), base.pre_concat(path.abs_transform()))?;
        let at = match path.fill().map(usvg::Fill::rule) {
            Some(usvg::FillRule::EvenOdd) => 1,
            _ => 0,
        };
        let (rule, repairs) = &mut self.painted.repairs[at];
        // Letters may overlap as their font has it: that is no fault.
        if !self.is_lettering {
            // Counted here, where the rule is known: once united nothing crosses.
            let found = Repairs::between(&rings);
            repairs.crossings += found.crossings;
            repairs.at_least |= found.at_least;
        }
        cleaned(&rings, *rule)
    }

    /// The area that a path's stroke covers, dashes, joins and ends included.
    fn stroked(&mut self, path: &Path) -> Result<WindingRings, SvgError> {
        let Some(outline) = path.stroke().and_then(|stroke| self.outlined(path, stroke)) else {
            return Ok(Vec::new()); // of no width, or of no length
        };
        let rings = self.rings(&outline, path.abs_transform())?;
        cleaned(&rings, FillRule::NonZero)
    }

    /// The stroke's outline before the path's transform.
    fn outlined(&self, path: &Path, stroke: &Stroke) -> Option<tiny_skia_path::Path> {
        let stroke = stroke.to_tiny_skia();
        // The stroker's curves keep within a quarter of a pixel.
        let (sx, sy) = path.abs_transform().get_scale();
        let finest = 0.25 * f64::from(sx.max(sy)) / self.brush.tolerance;
        let resolution = finest.clamp(1.0, MAX_RESOLUTION) as f32;
        let dashed;
        let data = match &stroke.dash {
            Some(dash) => {
                dashed = path.data().dash(dash, resolution)?;
                &dashed
            }
            None => path.data(),
        };
        data.stroke(&stroke, resolution)
    }

    /// A path as polygons on the page, y up.
    fn rings(
        &mut self,
        path: &tiny_skia_path::Path,
        t: Transform,
    ) -> Result<WindingRings, SvgError> {
        let [sx, ky, kx, sy, tx, ty] = [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from);
        let height = self.page.y;
        Ok(self.flattener.rings(path, |p| {
            let (x, y) = (f64::from(p.x), f64::from(p.y));
            DVec2::new(sx * x + kx * y + tx, height - (ky * x + sy * y + ty))
        })?)
    }
}

/// Pixels to a unit beyond which the stroker gains nothing in `f32`.
const MAX_RESOLUTION: f64 = 1e6;

fn cleaned(rings: &WindingRings, rule: FillRule) -> Result<WindingRings, SvgError> {
    match Regions::from_rings(rings, rule) {
        Ok(regions) => Ok(regions.rings().map(|r| r.points().to_vec()).collect()),
        Err(RegionsError::Empty | RegionsError::Size(_)) => Ok(Vec::new()), // a filled line
        Err(error) => Err(error.into()),
    }
}

/// Whether a path has a fill that is seen.
fn is_filled(path: &Path) -> bool {
    let fill = path.fill().filter(|fill| fill.opacity().get() > 0.0);
    path.is_visible() && fill.is_some()
}
