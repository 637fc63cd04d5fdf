//! What is filled in a drawing, as regions: a painter who knows two colours,
//! ink and paper, and paints in the drawing's order.

use super::error::SvgError;
use super::layers::{Layers, Rings, within};
use crate::design::flatten::Flattener;
use crate::geometry::{DVec2, FillRule, Regions, RegionsError, Repairs};
use usvg::{ClipPath, Group, Node, Paint, PaintOrder, Path, Stroke, Transform, tiny_skia_path};

/// What of a drawing is read, and how.
pub(super) struct Brush<'o> {
    /// In units of the page.
    pub tolerance: f64,
    pub strokes: bool,
    pub element: Option<&'o str>,
}

/// What is filled with ink in the end, and what was wrong with it.
pub(super) struct Painted {
    pub regions: Regions,
    /// Faults within single shapes, by the rule that resolved them.
    pub repairs: [(FillRule, Repairs); 2],
    /// Visible strokes of shapes without a fill that were left out.
    pub strokes_left_out: usize,
}

/// Paints a drawing, or the element of it that is asked for.
pub(super) fn painted(tree: &usvg::Tree, brush: &Brush) -> Result<Painted, SvgError> {
    let mut subject = Vec::new();
    collect_paths(tree.root(), brush.element, &mut subject);
    let is_bare = |p: &&&Path| stroke_is_white(p).is_some() && fill_is_white(p).is_none();
    let strokes_left_out = match brush.strokes {
        true => 0,
        false => subject.iter().filter(is_bare).count(),
    };
    if let (Some(id), true) = (brush.element, subject.is_empty()) {
        return Err(SvgError::NotDrawn(id.to_owned()));
    }
    let has_colour = |path: &&Path| {
        let stroke = stroke_is_white(path).filter(|_| brush.strokes);
        [fill_is_white(path), stroke].contains(&Some(false))
    };
    let mut painter = Painter {
        height: tree.size().height().into(),
        flattener: Flattener::new(brush.tolerance),
        brush,
        white_is_paper: subject.iter().any(has_colour),
        layers: Layers::of_page(DVec2::new(
            tree.size().width().into(),
            tree.size().height().into(),
        )),
        repairs: [FillRule::NonZero, FillRule::EvenOdd].map(|rule| (rule, Repairs::default())),
    };
    painter.group(tree.root(), None, brush.element.is_none())?;
    if painter.layers.is_empty() {
        let strokes = strokes_left_out > 0;
        return Err(SvgError::NothingFilled { strokes });
    }
    let repairs = painter.repairs;
    let ink = painter.layers.composed();
    Ok(Painted {
        regions: Regions::from_rings(&ink, FillRule::NonZero)?,
        repairs,
        strokes_left_out,
    })
}

/// The paths of a group, or of the elements in it with an id.
fn collect_paths<'t>(group: &'t Group, id: Option<&str>, paths: &mut Vec<&'t Path>) {
    let wanted = |own: &str| id.is_none_or(|id| id == own);
    for node in group.children() {
        match node {
            Node::Group(inner) => {
                // All that lies in what is asked for belongs to it.
                let below = if wanted(inner.id()) { None } else { id };
                collect_paths(inner, below, paths);
            }
            Node::Path(path) if wanted(path.id()) => paths.push(path),
            _ => {}
        }
    }
}

struct Painter<'b> {
    height: f64,
    flattener: Flattener,
    brush: &'b Brush<'b>,
    white_is_paper: bool,
    layers: Layers,
    repairs: [(FillRule, Repairs); 2],
}

impl Painter<'_> {
    /// Paints a group's children, inside `clip` and the group's own; outside
    /// of the element that is asked for only what belongs to it.
    fn group(
        &mut self,
        group: &Group,
        clip: Option<&Rings>,
        is_within: bool,
    ) -> Result<(), SvgError> {
        if group.opacity().get() == 0.0 {
            return Ok(());
        }
        if let Some(mask) = group.mask() {
            return Err(SvgError::Mask(mask.id().to_owned()));
        }
        let own = match group.clip_path() {
            Some(path) => {
                let inside = self.clip(path, group.abs_transform())?;
                Some(within(inside, clip))
            }
            None => None,
        };
        let clip = own.as_ref().or(clip);
        for node in group.children() {
            let is_within = is_within || self.brush.element == Some(node.id());
            match node {
                Node::Group(inner) => self.group(inner, clip, is_within)?,
                Node::Path(path) if is_within => self.path(path, clip)?,
                Node::Path(_) | Node::Image(_) | Node::Text(_) => {}
            }
        }
        Ok(())
    }

    fn path(&mut self, path: &Path, clip: Option<&Rings>) -> Result<(), SvgError> {
        let fills_first = path.paint_order() == PaintOrder::FillAndStroke;
        let stroke = stroke_is_white(path).filter(|_| self.brush.strokes);
        for is_fill in [fills_first, !fills_first] {
            if is_fill && let Some(is_white) = fill_is_white(path) {
                let rings = self.filled(path, Transform::identity())?;
                self.lay(rings, is_white, clip);
            } else if !is_fill && let Some(is_white) = stroke {
                let rings = self.stroked(path)?;
                self.lay(rings, is_white, clip);
            }
        }
        Ok(())
    }

    fn lay(&mut self, rings: Rings, is_white: bool, clip: Option<&Rings>) {
        let rings = within(rings, clip);
        self.layers.lay(rings, self.white_is_paper && is_white);
    }

    /// What a clip path lets through.
    fn clip(&mut self, clip: &ClipPath, group: Transform) -> Result<Rings, SvgError> {
        let mut rings = Vec::new();
        let base = group.pre_concat(clip.transform());
        self.clip_group(clip.root(), base, &mut rings)?;
        let outer = clip.clip_path().map(|outer| self.clip(outer, group));
        Ok(within(rings, outer.transpose()?.as_ref()))
    }

    fn clip_group(
        &mut self,
        group: &Group,
        base: Transform,
        rings: &mut Rings,
    ) -> Result<(), SvgError> {
        for node in group.children() {
            match node {
                Node::Path(path) if fill_is_white(path).is_some() => {
                    rings.extend(self.filled(path, base)?)
                }
                Node::Group(inner) => {
                    let mut own = Vec::new();
                    self.clip_group(inner, base, &mut own)?;
                    let at = base.pre_concat(inner.abs_transform());
                    let inside = inner.clip_path().map(|clip| self.clip(clip, at));
                    rings.extend(within(own, inside.transpose()?.as_ref()));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The area that a path fills by its own rule, on the page, y up.
    fn filled(&mut self, path: &Path, base: Transform) -> Result<Rings, SvgError> {
        let rings = self.rings(path.data(), base.pre_concat(path.abs_transform()))?;
        let at = match path.fill().map(usvg::Fill::rule) {
            Some(usvg::FillRule::EvenOdd) => 1,
            _ => 0,
        };
        let (rule, repairs) = &mut self.repairs[at];
        // Counted here, where the rule is known: once united nothing crosses.
        let found = Repairs::between(&rings);
        repairs.crossings += found.crossings;
        repairs.at_least |= found.at_least;
        cleaned(&rings, *rule)
    }

    /// The area that a path's stroke covers, dashes, joins and ends included.
    fn stroked(&mut self, path: &Path) -> Result<Rings, SvgError> {
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
    fn rings(&mut self, path: &tiny_skia_path::Path, t: Transform) -> Result<Rings, SvgError> {
        let [sx, ky, kx, sy, tx, ty] = [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from);
        let height = self.height;
        Ok(self.flattener.rings(path, |p| {
            let (x, y) = (f64::from(p.x), f64::from(p.y));
            DVec2::new(sx * x + kx * y + tx, height - (ky * x + sy * y + ty))
        })?)
    }
}

/// Pixels to a unit beyond which the stroker gains nothing in `f32`.
const MAX_RESOLUTION: f64 = 1e6;

fn cleaned(rings: &Rings, rule: FillRule) -> Result<Rings, SvgError> {
    match Regions::from_rings(rings, rule) {
        Ok(regions) => Ok(regions.rings().map(|r| r.points().to_vec()).collect()),
        Err(RegionsError::Empty | RegionsError::Size(_)) => Ok(Vec::new()), // a filled line
        Err(error) => Err(error.into()),
    }
}

/// Whether a path's fill is white; `None` where it has none that is seen.
fn fill_is_white(path: &Path) -> Option<bool> {
    let fill = path.fill().filter(|fill| fill.opacity().get() > 0.0)?;
    path.is_visible().then(|| is_white(fill.paint()))
}

/// Whether a path's stroke is white; `None` where it has none that is seen.
fn stroke_is_white(path: &Path) -> Option<bool> {
    let stroke = path
        .stroke()
        .filter(|stroke| stroke.opacity().get() > 0.0)?;
    path.is_visible().then(|| is_white(stroke.paint()))
}

fn is_white(paint: &Paint) -> bool {
    matches!(paint, Paint::Color(c) if [c.red, c.green, c.blue] == [u8::MAX; 3])
}
