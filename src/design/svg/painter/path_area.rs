//! Areas of paths on the page: fills, strokes and clip paths.

use super::SvgPainter;
use crate::design::svg::error::SvgError;
use crate::design::svg::ink_layers::{WindingRings, clip_rings, union};
use crate::design::svg::resolved_paint::is_filled;
use crate::geometry::{DVec2, FillRule, Regions, RegionsError, Repairs};
use usvg::{ClipPath, Group, Node, Path, Stroke, Transform, tiny_skia_path};

impl SvgPainter<'_> {
    /// Returns the area of a clip path on the page. `frame` maps the coordinates of the clipped
    /// group to the page.
    pub(in crate::design::svg) fn clip(
        &mut self,
        clip: &ClipPath,
        frame: Transform,
    ) -> Result<WindingRings, SvgError> {
        let mut parts = Vec::new();
        self.clip_group(clip.root(), frame.pre_concat(clip.transform()), &mut parts)?;
        let outer = clip.clip_path().map(|outer| self.clip(outer, frame));
        Ok(clip_rings(union(parts), outer.transpose()?.as_ref()))
    }

    /// Appends the areas of the filled paths in a group of a clip path. `frame` maps the coordinates
    /// around the group to the page.
    fn clip_group(
        &mut self,
        group: &Group,
        frame: Transform,
        parts: &mut Vec<WindingRings>,
    ) -> Result<(), SvgError> {
        let frame = frame.pre_concat(group.transform());
        for node in group.children() {
            match node {
                Node::Path(path) if is_filled(path) => parts.push(self.filled_area(path, frame)?),
                Node::Path(_) | Node::Image(_) => {}
                Node::Group(inner) => {
                    let mut own = Vec::new();
                    self.clip_group(inner, frame, &mut own)?;
                    let inner_frame = frame.pre_concat(inner.transform());
                    let inside = inner.clip_path().map(|clip| self.clip(clip, inner_frame));
                    parts.push(clip_rings(union(own), inside.transpose()?.as_ref()));
                }
                Node::Text(text) => {
                    let was_in_text = std::mem::replace(&mut self.is_in_text, true);
                    self.clip_group(text.flattened(), frame, parts)?;
                    self.is_in_text = was_in_text;
                }
            }
        }
        Ok(())
    }

    /// Returns the filled area of a path on the page, y up, by the path's own fill rule. `frame` maps
    /// the coordinates of the path to the page.
    pub(in crate::design::svg) fn filled_area(
        &mut self,
        path: &Path,
        frame: Transform,
    ) -> Result<WindingRings, SvgError> {
        let rings = self.rings(path.data(), frame)?;
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

    /// Returns the rings of a path if all of them bound its area and none cross; otherwise `None`.
    pub(in crate::design::svg) fn simple_rings(
        &mut self,
        path: &Path,
    ) -> Result<Option<WindingRings>, SvgError> {
        let before = self.flattener.clone();
        let rings = self.rings(path.data(), self.frame)?;
        let rule = match path.fill().map(usvg::Fill::rule) {
            Some(usvg::FillRule::NonZero) => FillRule::NonZero,
            // A path without a fill has no fill rule; the even-odd rule keeps all its rings, even
            // nested ones.
            Some(usvg::FillRule::EvenOdd) | None => FillRule::EvenOdd,
        };
        let crossings = Repairs::count_contacts(&rings).crossings;
        let cleaned = resolve_overlaps(&rings, rule)?;
        let is_simple = crossings == 0 && cleaned.len() == rings.len();
        if !is_simple {
            self.flattener = before; // the caller flattens the path again
        }
        Ok(is_simple.then_some(cleaned))
    }

    /// Returns the area of a path's stroke, including dashes, joins and caps.
    pub(in crate::design::svg) fn stroked_area(
        &mut self,
        path: &Path,
    ) -> Result<WindingRings, SvgError> {
        let transform = self.frame;
        let Some(stroke) = path.stroke() else {
            return Ok(Vec::new());
        };
        // A stroke that does not scale is drawn along the path on the page.
        let (data, transform) = match self.is_non_scaling(path) {
            true => (
                path.data().clone().transform(transform),
                Transform::identity(),
            ),
            false => (Some(path.data().clone()), transform),
        };
        let outline = data.and_then(|data| self.stroke_outline(path, &data, stroke, transform));
        let Some(outline) = outline else {
            return Ok(Vec::new()); // no width or no length
        };
        let rings = self.rings(&outline, transform)?;
        resolve_overlaps(&rings, FillRule::NonZero)
    }

    /// Returns whether the stroke of a path keeps its width when the drawing is scaled.
    pub(in crate::design::svg) fn is_non_scaling(&self, path: &Path) -> bool {
        let source = self.source(path.id());
        source.is_some_and(|id| self.options.non_scaling.contains(&id))
    }

    /// Returns the outline of a stroke along `data`. `transform` maps its coordinates to the page.
    fn stroke_outline(
        &mut self,
        path: &Path,
        data: &tiny_skia_path::Path,
        stroke: &Stroke,
        transform: Transform,
    ) -> Option<tiny_skia_path::Path> {
        // The stroker's error is a quarter of a pixel. A pixel is 1 / resolution in the coordinates
        // of the path. At the resolution `finest`, the error on the page equals the tolerance.
        let (sx, sy) = transform.get_scale();
        let finest = 0.25 * f64::from(sx.max(sy)) / self.options.tolerance;
        let resolution = finest.clamp(1.0, MAX_RESOLUTION) as f32;
        let style = stroke.to_tiny_skia();
        match self.dash(path, data, stroke) {
            Some(dash) => data.dash(&dash, resolution)?.stroke(&style, resolution),
            None => data.stroke(&style, resolution),
        }
    }

    /// Returns the dashes of a stroke along `data`, scaled if they refer to a length given by the
    /// author (`pathLength`); `None` for a solid stroke and for more than [`MAX_DASHES`] dashes.
    fn dash(
        &mut self,
        path: &Path,
        data: &tiny_skia_path::Path,
        stroke: &Stroke,
    ) -> Option<tiny_skia_path::StrokeDash> {
        let pattern = stroke.dasharray()?;
        let length = path_length(data);
        let given = (self.source(path.id())).and_then(|id| self.options.path_length(id));
        let ratio = given.map_or(1.0, |given| (length / given) as f32);
        let lengths: Vec<f32> = pattern.iter().map(|length| length * ratio).collect();
        let period: f64 = lengths.iter().copied().map(f64::from).sum();
        if length / period * lengths.len() as f64 / 2.0 > MAX_DASHES {
            self.approximate("stroke-dasharray of too many dashes", "drawn solid");
            return None;
        }
        tiny_skia_path::StrokeDash::new(lengths, stroke.dashoffset() * ratio)
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

    /// Returns a rectangle (left, top, width, height), transformed by `t`, on the page, y up.
    pub(in crate::design::svg) fn rectangle(
        &self,
        [x, y, w, h]: [f64; 4],
        t: Transform,
    ) -> WindingRings {
        let map = crate::design::svg::resolved_paint::affine(t);
        let corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)];
        let corners = corners.map(|(x, y)| {
            let p = map.transform_point2(DVec2::new(x, y));
            DVec2::new(p.x, self.page.y - p.y)
        });
        vec![corners.to_vec()]
    }
}

/// Maximum resolution of the stroker in pixels per unit (tolerance: a higher one exceeds the
/// precision of `f32`).
const MAX_RESOLUTION: f64 = 1e6;

/// Maximum number of dashes along a path (resource limit: overlaps of this many are resolved within
/// a second).
const MAX_DASHES: f64 = 10_000.0;

/// Number of chords that measure the length of a curve (tolerance: the error for a quarter of a
/// circle is below 1e-4).
const LENGTH_CHORDS: u16 = 32;

/// Returns the length of a path.
fn path_length(path: &tiny_skia_path::Path) -> f64 {
    use tiny_skia_path::PathSegment::{Close, CubicTo, LineTo, MoveTo, QuadTo};
    let point = |p: tiny_skia_path::Point| DVec2::new(p.x.into(), p.y.into());
    let chords = |curve: &dyn Fn(f64) -> DVec2| -> f64 {
        let at = |k: u16| curve(f64::from(k) / f64::from(LENGTH_CHORDS));
        (0..LENGTH_CHORDS).map(|k| at(k).distance(at(k + 1))).sum()
    };
    let (mut length, mut last, mut start) = (0.0, DVec2::ZERO, DVec2::ZERO);
    for segment in path.segments() {
        let (added, end) = match segment {
            MoveTo(p) => {
                start = point(p);
                (0.0, start)
            }
            LineTo(p) => (last.distance(point(p)), point(p)),
            QuadTo(b, c) => {
                let [a, b, c] = [last, point(b), point(c)];
                (chords(&|t| a.lerp(b, t).lerp(b.lerp(c, t), t)), c)
            }
            CubicTo(b, c, d) => {
                let [a, b, c, d] = [last, point(b), point(c), point(d)];
                let curve = |t: f64| {
                    let (p, q, r) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
                    p.lerp(q, t).lerp(q.lerp(r, t), t)
                };
                (chords(&curve), d)
            }
            Close => (last.distance(start), start),
        };
        length += added;
        last = end;
    }
    length
}

/// Resolves crossings and overlaps of rings by a fill rule; returns no rings if the area is empty.
pub(in crate::design::svg) fn resolve_overlaps(
    rings: &WindingRings,
    rule: FillRule,
) -> Result<WindingRings, SvgError> {
    match Regions::from_rings(rings, rule) {
        Ok(regions) => Ok(regions.rings().map(|r| r.points().to_vec()).collect()),
        Err(RegionsError::Empty | RegionsError::Size(_)) => Ok(Vec::new()), // no area
        Err(error) => Err(error.into()),
    }
}
