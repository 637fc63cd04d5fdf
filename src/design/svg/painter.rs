//! Converts a `usvg` tree to shapes: the area of each fill and stroke with its paint, in painting
//! order, with clip paths, transforms and group opacity applied.

use super::error::SvgError;
use super::ink_layers::{WindingRings, clip_rings};
use super::opacity_groups::apply_group_opacity;
use super::resolved_paint::{ResolvedPaint, affine, resolve_paint};
use super::shape::SvgShape;
use super::stroke;
use super::stroke::ShapeStroke;
use crate::colour::Paint;
use crate::design::flatten::Flattener;
use crate::geometry::{DAffine2, DVec2, FillRule, Regions, RegionsError, Repairs};
use usvg::{ClipPath, Group, Node, PaintOrder, Path, Stroke, Text, Transform, tiny_skia_path};

/// Settings for reading a drawing.
pub(super) struct SvgReadOptions<'o> {
    /// Flattening tolerance in page units.
    pub tolerance: f64,
    /// Id of the only element to read; `None` for the whole drawing.
    pub element: Option<&'o str>,
}

/// Shapes of a drawing, with counts for its import notes.
pub(super) struct PaintedDrawing {
    /// Shapes, lowest first.
    pub shapes: Vec<SvgShape>,
    /// For each fill rule: the repairs within single shapes that are filled by this rule.
    pub repairs: [(FillRule, Repairs); 2],
    /// Number of paths with a visible stroke but no fill.
    pub bare_strokes: usize,
    pub approximations: ApproximationCounts,
}

/// Numbers of features that were ignored or approximated.
#[derive(Default)]
pub(super) struct ApproximationCounts {
    /// Number of patterns and stroke gradients that were replaced by their mean colour.
    pub shades: usize,
    /// Number of ignored masks.
    pub masks: usize,
    /// Number of ignored bitmap glyphs.
    pub glyphs: usize,
    /// Number of groups whose opacity or blend mode is only approximated.
    pub blends: usize,
}

/// Returns the width and height of the page of a drawing.
pub(super) fn page_of(tree: &usvg::Tree) -> DVec2 {
    DVec2::new(tree.size().width().into(), tree.size().height().into())
}

/// Converts a drawing, or only its selected element, to shapes.
pub(super) fn paint_tree(
    tree: &usvg::Tree,
    options: &SvgReadOptions,
) -> Result<PaintedDrawing, SvgError> {
    let mut painter = SvgPainter {
        page: page_of(tree),
        flattener: Flattener::new(options.tolerance),
        options,
        painted: PaintedDrawing {
            shapes: Vec::new(),
            repairs: [FillRule::NonZero, FillRule::EvenOdd].map(|rule| (rule, Repairs::default())),
            bare_strokes: 0,
            approximations: ApproximationCounts::default(),
        },
        is_drawn: false,
        is_in_text: false,
    };
    painter.group(tree.root(), None, options.element.is_none())?;
    match options.element {
        Some(id) if !painter.is_drawn => Err(SvgError::NotDrawn(id.to_owned())),
        _ => Ok(painter.painted),
    }
}

/// Converter of a drawing to shapes, with the shapes made so far.
struct SvgPainter<'b> {
    /// Width and height of the page.
    page: DVec2,
    flattener: Flattener,
    options: &'b SvgReadOptions<'b>,
    painted: PaintedDrawing,
    /// Whether a path of the selected element has been found, visible or not.
    is_drawn: bool,
    /// Whether the traversal is inside a text element.
    is_in_text: bool,
}

impl SvgPainter<'_> {
    /// Converts the children of a group to shapes, clipped by `clip` and the group's own clip path.
    /// `is_within` says whether the group lies inside the selected element.
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
                Some(clip_rings(inside, clip))
            }
            None => None,
        };
        let clip = own.as_ref().or(clip);
        let first = self.painted.shapes.len();
        for node in group.children() {
            let is_within = is_within || self.options.element == Some(node.id());
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
            let (shapes, is_exact) = apply_group_opacity(shapes, opacity, self.page);
            self.painted.approximations.blends += usize::from(!is_exact);
            self.painted.shapes.extend(shapes);
        }
        Ok(())
    }

    /// Counts the mask and the blend mode of a group, if it has them, among the approximations.
    fn count_left_out(&mut self, group: &Group) {
        let left_out = &mut self.painted.approximations;
        left_out.masks += usize::from(group.mask().is_some());
        left_out.blends += usize::from(group.blend_mode() != usvg::BlendMode::Normal);
    }

    /// Converts the glyph outlines of a text element to shapes.
    fn text(&mut self, text: &Text, clip: Option<&WindingRings>) -> Result<(), SvgError> {
        self.is_in_text = true;
        for node in text.flattened().children() {
            match node {
                Node::Path(path) => self.path(path, text.id(), clip)?,
                _ => self.painted.approximations.glyphs += 1,
            }
        }
        self.is_in_text = false;
        Ok(())
    }

    /// Converts a path to shapes and counts its approximated paints.
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
        let is_mean = |resolved: &ResolvedPaint| resolved.is_mean;
        // Strokes support a single colour only.
        let is_approximated =
            |resolved: &ResolvedPaint| resolved.is_mean || resolved.gradient.is_some();
        self.painted.approximations.shades += usize::from(fill.as_ref().is_some_and(is_mean));
        self.painted.approximations.shades +=
            usize::from(stroke.as_ref().is_some_and(is_approximated));
        let gradient = fill.as_mut().and_then(|resolved| resolved.gradient.take());
        let gradient = gradient.map(|gradient| gradient.transformed(self.page_from_path(path)));
        let [fill, stroke] = [fill, stroke].map(|resolved| resolved.map(|resolved| resolved.paint));
        let first = self.painted.shapes.len();
        self.add_shapes(path, name, clip, fill, stroke)?;
        // The paint order decides whether the fill is the first or the second of the new shapes.
        let added = &mut self.painted.shapes[first..];
        if let Some(shape) = added.iter_mut().find(|shape| !shape.is_stroke) {
            shape.gradient = gradient;
        }
        Ok(())
    }

    /// Returns the affine map from the coordinates of a path to the page, y up.
    fn page_from_path(&self, path: &Path) -> DAffine2 {
        let flip_y = DAffine2::from_cols_array(&[1.0, 0.0, 0.0, -1.0, 0.0, self.page.y]);
        flip_y * affine(path.abs_transform())
    }

    /// Adds the fill and the stroke of a path in its paint order.
    fn add_shapes(
        &mut self,
        path: &Path,
        name: &str,
        clip: Option<&WindingRings>,
        fill: Option<Paint>,
        stroke: Option<Paint>,
    ) -> Result<(), SvgError> {
        let fills_first = path.paint_order() == PaintOrder::FillAndStroke;
        if let Some(stroke) = stroke
            && fills_first
            && clip.is_none()
            && self.add_stroked_fill(path, name, fill, stroke)?
        {
            return Ok(());
        }
        for is_fill in [fills_first, !fills_first] {
            if is_fill && let Some(paint) = fill {
                let rings = self.filled_area(path, Transform::identity())?;
                self.add_clipped(name, rings, clip, paint, false);
            } else if !is_fill && let Some(paint) = stroke {
                let rings = self.stroked_area(path)?;
                self.add_clipped(name, rings, clip, paint, true);
            }
        }
        Ok(())
    }

    /// Adds a shape with the area `rings`, clipped by `clip`.
    fn add_clipped(
        &mut self,
        name: &str,
        rings: WindingRings,
        clip: Option<&WindingRings>,
        paint: Paint,
        is_stroke: bool,
    ) {
        self.painted.shapes.push(SvgShape {
            rings: clip_rings(rings, clip),
            paint,
            gradient: None,
            is_stroke,
            is_text: self.is_in_text,
            stroke: None,
            name: name.to_owned(),
        });
    }

    /// Tries to add a path as one shape with an attached stroke; returns whether it was added. The
    /// stroke must have no dashes and a uniform width. The subpaths must be closed and cross
    /// neither themselves nor each other.
    fn add_stroked_fill(
        &mut self,
        path: &Path,
        name: &str,
        fill: Option<Paint>,
        stroke: Paint,
    ) -> Result<bool, SvgError> {
        let Some(line) = stroke::uniform_stroke(path, stroke).filter(|_| stroke::is_closed(path))
        else {
            return Ok(false);
        };
        let before = self.flattener.clone();
        let rings = self.rings(path.data(), path.abs_transform())?;
        let rule = match path.fill().map(usvg::Fill::rule) {
            Some(usvg::FillRule::NonZero) => FillRule::NonZero,
            // A path without a fill has no fill rule; the even-odd rule keeps all its rings, even
            // nested ones.
            Some(usvg::FillRule::EvenOdd) | None => FillRule::EvenOdd,
        };
        let crossings = Repairs::count_contacts(&rings).crossings;
        let cleaned = resolve_overlaps(&rings, rule)?;
        if crossings > 0 || cleaned.len() != rings.len() {
            self.flattener = before; // the caller flattens the path again
            return Ok(false);
        }
        let invisible = Paint {
            opacity: 0.0,
            ..stroke
        };
        let edge = ShapeStroke {
            line,
            rings: self.stroked_area(path)?,
        };
        self.painted.shapes.push(SvgShape {
            rings: cleaned,
            paint: fill.unwrap_or(invisible),
            gradient: None,
            is_stroke: false,
            is_text: self.is_in_text,
            stroke: Some(edge),
            name: name.to_owned(),
        });
        Ok(true)
    }

    /// Returns the area of a clip path on the page. `group` is the transform of the clipped group.
    fn clip(&mut self, clip: &ClipPath, group: Transform) -> Result<WindingRings, SvgError> {
        let mut rings = Vec::new();
        let base = group.pre_concat(clip.transform());
        self.clip_group(clip.root(), base, &mut rings)?;
        let outer = clip.clip_path().map(|outer| self.clip(outer, group));
        Ok(clip_rings(rings, outer.transpose()?.as_ref()))
    }

    /// Appends the areas of the filled paths in a group of a clip path. `base` maps the clip path
    /// to the page of the drawing.
    fn clip_group(
        &mut self,
        group: &Group,
        base: Transform,
        rings: &mut WindingRings,
    ) -> Result<(), SvgError> {
        for node in group.children() {
            match node {
                Node::Path(path) if is_filled(path) => rings.extend(self.filled_area(path, base)?),
                Node::Group(inner) => {
                    let mut own = Vec::new();
                    self.clip_group(inner, base, &mut own)?;
                    let inner_base = base.pre_concat(inner.abs_transform());
                    let inside = inner.clip_path().map(|clip| self.clip(clip, inner_base));
                    rings.extend(clip_rings(own, inside.transpose()?.as_ref()));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Returns the filled area of a path on the page, y up, by the path's own fill rule. `base` is
    /// applied after the path's transform.
    fn filled_area(&mut self, path: &Path, base: Transform) -> Result<WindingRings, SvgError> {
        let rings = self.rings(path.data(), base.pre_concat(path.abs_transform()))?;
        let index = match path.fill().map(usvg::Fill::rule) {
            Some(usvg::FillRule::EvenOdd) => 1,
            _ => 0,
        };
        let (rule, repairs) = &mut self.painted.repairs[index];
        // Overlapping contours are normal in fonts and are not reported.
        if !self.is_in_text {
            // Crossings are counted before the overlaps are resolved, which removes them.
            let found = Repairs::count_contacts(&rings);
            repairs.crossings += found.crossings;
            repairs.at_least |= found.at_least;
        }
        resolve_overlaps(&rings, *rule)
    }

    /// Returns the area of a path's stroke, including dashes, joins and caps.
    fn stroked_area(&mut self, path: &Path) -> Result<WindingRings, SvgError> {
        let Some(outline) = path
            .stroke()
            .and_then(|stroke| self.stroke_outline(path, stroke))
        else {
            return Ok(Vec::new()); // no width or no length
        };
        let rings = self.rings(&outline, path.abs_transform())?;
        resolve_overlaps(&rings, FillRule::NonZero)
    }

    /// Returns the outline of a stroke in the coordinates of the path.
    fn stroke_outline(&self, path: &Path, stroke: &Stroke) -> Option<tiny_skia_path::Path> {
        let stroke = stroke.to_tiny_skia();
        // The stroker's error is a quarter of a pixel. A pixel is 1 / resolution in the coordinates
        // of the path. At the resolution `finest`, the error on the page equals the tolerance.
        let (sx, sy) = path.abs_transform().get_scale();
        let finest = 0.25 * f64::from(sx.max(sy)) / self.options.tolerance;
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

    /// Flattens a path, transformed by `t`, to polygons on the page, y up.
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

/// Maximum resolution of the stroker in pixels per unit (tolerance: a higher one exceeds the
/// precision of `f32`).
const MAX_RESOLUTION: f64 = 1e6;

/// Resolves crossings and overlaps of rings by a fill rule; returns no rings if the area is empty.
fn resolve_overlaps(rings: &WindingRings, rule: FillRule) -> Result<WindingRings, SvgError> {
    match Regions::from_rings(rings, rule) {
        Ok(regions) => Ok(regions.rings().map(|r| r.points().to_vec()).collect()),
        Err(RegionsError::Empty | RegionsError::Size(_)) => Ok(Vec::new()), // no area
        Err(error) => Err(error.into()),
    }
}

/// Returns whether a path has a visible fill.
fn is_filled(path: &Path) -> bool {
    let fill = path.fill().filter(|fill| fill.opacity().get() > 0.0);
    path.is_visible() && fill.is_some()
}
