//! Converts a `usvg` tree to shapes: the area of each fill and stroke with its paint, in painting
//! order, with clip paths, masks, blend modes, transforms and group opacity applied.

mod masks;
mod path_area;
mod patterns;
mod pictures;

use super::blending::blend_shapes;
use super::error::SvgError;
use super::ink_layers::{WindingRings, clip_rings};
use super::lost_features::{LostFeatures, element_label};
use super::names::element_name;
use super::opacity_groups::apply_group_opacity;
use super::plain::source_element;
use super::resolved_paint::{PaintSource, affine, is_filled, paint_source};
use super::shape::SvgShape;
use super::stroke;
use super::stroke::ShapeStroke;
use crate::colour::{Gradient, Paint};
use crate::design::flatten::Flattener;
use crate::design::silhouette::MAX_PIXELS;
use crate::geometry::{DAffine2, DVec2, FillRule, Repairs};
use std::collections::HashSet;
use usvg::roxmltree::{Document, NodeId};
use usvg::{BlendMode, Group, ImageKind, Node, PaintOrder, Path, Text, Transform};

/// Settings for reading a drawing.
pub(super) struct SvgReadOptions<'o> {
    /// Flattening tolerance in page units.
    pub tolerance: f64,
    /// The only element to read; `None` for the whole drawing.
    pub element: Option<NodeId>,
    /// Elements whose strokes keep their width when the drawing is scaled.
    pub non_scaling: &'o HashSet<NodeId>,
    /// Source of the drawing.
    pub document: &'o Document<'o>,
}

impl SvgReadOptions<'_> {
    /// Returns the name of an element for the pairing of parts; empty if its author gave it none.
    fn name(&self, id: NodeId) -> String {
        let node = self.document.get_node(id);
        node.map(element_name).unwrap_or_default()
    }

    /// Returns the description of an element for notes.
    fn label(&self, id: NodeId) -> String {
        let node = self.document.get_node(id);
        node.map(element_label).unwrap_or_default()
    }

    /// Returns the length that the author gives to the outline of an element (`pathLength`).
    pub(super) fn path_length(&self, id: NodeId) -> Option<f64> {
        let given = self.document.get_node(id)?.attribute("pathLength")?;
        let length: f64 = given.trim().parse().ok()?;
        (length > 0.0 && length.is_finite()).then_some(length)
    }
}

/// Shapes of a drawing, with counts for its import notes.
pub(super) struct PaintedDrawing {
    /// Shapes, lowest first.
    pub shapes: Vec<SvgShape>,
    /// For each fill rule: the repairs within single shapes that are filled by this rule.
    pub repairs: [(FillRule, Repairs); 2],
    /// Number of paths with a visible stroke but no fill.
    pub bare_strokes: usize,
    /// Number of ignored bitmap glyphs.
    pub bitmap_glyphs: usize,
    pub lost: LostFeatures,
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
            bitmap_glyphs: 0,
            lost: LostFeatures::default(),
        },
        frame: Transform::identity(),
        group_name: String::new(),
        element: None,
        is_drawn: false,
        is_in_text: false,
        depth: 0,
        is_embedded: false,
        picture_pixels_left: MAX_PICTURE_PIXELS,
    };
    painter.group(tree.root(), None, options.element.is_none())?;
    match options.element {
        Some(id) if !painter.is_drawn => {
            let label = options.label(id);
            Err(SvgError::NotDrawn(label.trim_start_matches('#').to_owned()))
        }
        _ => Ok(painter.painted),
    }
}

/// Returns the source of the first element in a node that has one.
fn first_source(node: &Node) -> Option<NodeId> {
    let own = source_element(node.id());
    own.or_else(|| match node {
        Node::Group(group) => group.children().first().and_then(first_source),
        _ => None,
    })
}

/// Maximum number of pixels of all pictures in a drawing together (resource limit: as many as those
/// of one picture file).
const MAX_PICTURE_PIXELS: u64 = MAX_PIXELS;

/// Maximum depth of patterns and embedded drawings within each other (resource limit: each level
/// multiplies the number of shapes).
const MAX_DEPTH: usize = 4;

/// Converter of a drawing to shapes, with the shapes made so far.
pub(super) struct SvgPainter<'b> {
    /// Width and height of the page.
    pub(super) page: DVec2,
    pub(super) flattener: Flattener,
    pub(super) options: &'b SvgReadOptions<'b>,
    pub(super) painted: PaintedDrawing,
    /// Transform from the coordinates of the current group to the page, y down. The absolute
    /// transforms of `usvg` are not used: they are wrong in patterns and colour glyphs.
    pub(super) frame: Transform,
    /// Name of the innermost group that has one.
    group_name: String,
    /// Innermost element of the source document that is being painted.
    element: Option<NodeId>,
    /// Whether a path of the selected element has been found, visible or not.
    is_drawn: bool,
    /// Whether the traversal is inside a text element.
    pub(super) is_in_text: bool,
    /// Number of patterns and embedded drawings around the current tree.
    depth: usize,
    /// Whether the traversal is inside an embedded drawing.
    is_embedded: bool,
    /// Number of pixels of pictures that may still be decoded.
    picture_pixels_left: u64,
}

impl SvgPainter<'_> {
    /// Converts the children of a group to shapes, clipped by `clip` and the group's own clip path.
    /// `is_within` says whether the group lies inside the selected element.
    pub(super) fn group(
        &mut self,
        group: &Group,
        clip: Option<&WindingRings>,
        is_within: bool,
    ) -> Result<(), SvgError> {
        let opacity = f64::from(group.opacity().get());
        if opacity == 0.0 {
            return Ok(());
        }
        let outer = self.frame;
        self.frame = outer.pre_concat(group.transform());
        let painted = self.group_content(group, opacity, clip, is_within);
        self.frame = outer;
        painted
    }

    /// Converts the children of a group with a certain opacity to shapes.
    fn group_content(
        &mut self,
        group: &Group,
        opacity: f64,
        clip: Option<&WindingRings>,
        is_within: bool,
    ) -> Result<(), SvgError> {
        let frame = self.frame;
        let own = match group.clip_path() {
            Some(path) => {
                let inside = self.clip(path, frame)?;
                Some(clip_rings(inside, clip))
            }
            None => None,
        };
        let clip = own.as_ref().or(clip);
        // The content of such groups is painted on a sheet of its own.
        let is_isolated = opacity < 1.0
            || group.mask().is_some()
            || group.isolate()
            || group.blend_mode() != BlendMode::Normal;
        if !is_isolated {
            return self.children(group, clip, is_within);
        }
        let mut shapes = self.collect(|painter| painter.children(group, clip, is_within))?;
        // `usvg` puts a single element with a mask or the like into a group without id.
        let outer = self.element;
        if source_element(group.id()).is_none() && !self.is_embedded {
            self.element = group.children().first().and_then(first_source).or(outer);
        }
        if let Some(mask) = group.mask() {
            shapes = self.masked(shapes, mask, frame)?;
        }
        if opacity < 1.0 {
            let (faded, is_exact) = apply_group_opacity(shapes, opacity, self.page);
            shapes = faded;
            if !is_exact {
                self.approximate("group opacity", "painted approximately");
            }
        }
        if group.blend_mode() != BlendMode::Normal {
            let (blended, is_exact) =
                blend_shapes(shapes, &self.painted.shapes, group.blend_mode());
            shapes = blended;
            if !is_exact {
                self.approximate("mix-blend-mode", "painted approximately");
            }
        }
        self.element = outer;
        self.painted.shapes.extend(shapes);
        Ok(())
    }

    /// Converts the children of a group to shapes.
    fn children(
        &mut self,
        group: &Group,
        clip: Option<&WindingRings>,
        is_within: bool,
    ) -> Result<(), SvgError> {
        for node in group.children() {
            let source = self.source(node.id());
            // Copies are not selected: they have the id of their original.
            let is_original = source.is_some() && !node.id().contains('-');
            let is_selected = is_original && self.options.element == source;
            let is_within = is_within || is_selected;
            let outer = self.enter(source);
            match node {
                Node::Group(inner) => self.group(inner, clip, is_within)?,
                Node::Path(path) if is_within => self.path(path, clip)?,
                Node::Text(text) if is_within => self.text(text, clip)?,
                Node::Image(image) if is_within && image.is_visible() => match image.kind() {
                    ImageKind::SVG(tree) => self.embedded(tree, clip)?,
                    _ if self.is_in_text => self.painted.bitmap_glyphs += 1,
                    _ => self.picture(image, clip),
                },
                Node::Path(_) | Node::Image(_) | Node::Text(_) => {}
            }
            (self.element, self.group_name) = outer;
        }
        Ok(())
    }

    /// Returns the element of the drawing that an id of the plain drawing belongs to; `None` inside
    /// of an embedded drawing, whose ids are those of another document.
    pub(super) fn source(&self, id: &str) -> Option<NodeId> {
        source_element(id).filter(|_| !self.is_embedded)
    }

    /// Makes an element the current one. Returns the state to restore after its content.
    fn enter(&mut self, source: Option<NodeId>) -> (Option<NodeId>, String) {
        let outer = (self.element, self.group_name.clone());
        if let Some(id) = source {
            self.element = Some(id);
            let name = self.options.name(id);
            if !name.is_empty() {
                self.group_name = name;
            }
        }
        outer
    }

    /// Records that a feature of the current element is only approximated.
    pub(super) fn approximate(&mut self, feature: &str, replacement: &'static str) {
        let label = self.current_label();
        self.painted.lost.replace(feature, replacement, &label);
    }

    /// Returns the description of the current element for notes.
    fn current_label(&self) -> String {
        match self.element {
            Some(id) => self.options.label(id),
            None => "<svg>".to_owned(),
        }
    }

    /// Returns the shapes that `paint` adds, instead of adding them to the drawing.
    pub(super) fn collect(
        &mut self,
        paint: impl FnOnce(&mut Self) -> Result<(), SvgError>,
    ) -> Result<Vec<SvgShape>, SvgError> {
        let below = std::mem::take(&mut self.painted.shapes);
        paint(self)?;
        Ok(std::mem::replace(&mut self.painted.shapes, below))
    }

    /// Converts the content of a mask, a pattern or an embedded drawing to shapes. `frame` maps its
    /// coordinates to the page. Adds nothing if too many are inside each other.
    pub(super) fn inner_tree(
        &mut self,
        root: &Group,
        frame: Transform,
        clip: Option<&WindingRings>,
    ) -> Result<(), SvgError> {
        if self.depth == MAX_DEPTH {
            self.approximate("content nested in patterns or masks", "left out");
            return Ok(());
        }
        let outer = std::mem::replace(&mut self.frame, frame);
        let was_in_text = std::mem::take(&mut self.is_in_text);
        self.depth += 1;
        let painted = self.group(root, clip, true);
        self.depth -= 1;
        self.is_in_text = was_in_text;
        self.frame = outer;
        painted
    }

    /// Converts an embedded drawing to shapes.
    fn embedded(&mut self, tree: &usvg::Tree, clip: Option<&WindingRings>) -> Result<(), SvgError> {
        let frame = self.frame;
        let size = page_of(tree);
        let page = self.rectangle([0.0, 0.0, size.x, size.y], frame);
        let page = clip_rings(page, clip);
        let was_embedded = std::mem::replace(&mut self.is_embedded, true);
        let painted = self.inner_tree(tree.root(), frame, Some(&page));
        self.is_embedded = was_embedded;
        painted
    }

    /// Converts the glyph outlines of a text element to shapes.
    fn text(&mut self, text: &Text, clip: Option<&WindingRings>) -> Result<(), SvgError> {
        self.is_in_text = true;
        self.glyphs(text.flattened(), clip)?;
        self.is_in_text = false;
        Ok(())
    }

    fn glyphs(&mut self, group: &Group, clip: Option<&WindingRings>) -> Result<(), SvgError> {
        for node in group.children() {
            match node {
                Node::Path(path) => self.path(path, clip)?,
                // A glyph with colours of its own.
                Node::Group(glyph) => {
                    let was_embedded = std::mem::replace(&mut self.is_embedded, true);
                    let painted = self.group(glyph, clip, true);
                    self.is_embedded = was_embedded;
                    painted?;
                }
                Node::Image(_) | Node::Text(_) => {}
            }
        }
        Ok(())
    }

    /// Converts a path to shapes.
    fn path(&mut self, path: &Path, clip: Option<&WindingRings>) -> Result<(), SvgError> {
        self.is_drawn = true;
        if !path.is_visible() {
            return Ok(());
        }
        let fill = path.fill().filter(|_| is_filled(path));
        let fill = fill.and_then(|fill| paint_source(fill.paint(), fill.opacity()));
        let stroke = path.stroke();
        let stroke = stroke.and_then(|stroke| paint_source(stroke.paint(), stroke.opacity()));
        self.painted.bare_strokes += usize::from(fill.is_none() && stroke.is_some());
        let fills_first = path.paint_order() == PaintOrder::FillAndStroke;
        if clip.is_none()
            && let Some(PaintSource::Solid(stroke)) = &stroke
            && self.add_stroked_fill(path, fill.as_ref(), *stroke)?
        {
            return Ok(());
        }
        for is_fill in [fills_first, !fills_first] {
            let source = if is_fill { &fill } else { &stroke };
            let Some(source) = source else {
                continue;
            };
            let rings = match is_fill {
                true => self.filled_area(path, self.frame)?,
                false => self.stroked_area(path)?,
            };
            let first = self.painted.shapes.len();
            self.add_painted(clip_rings(rings, clip), source)?;
            for shape in &mut self.painted.shapes[first..] {
                shape.is_stroke = !is_fill;
            }
        }
        Ok(())
    }

    /// Adds the area `rings` of a path in the current group with a paint.
    fn add_painted(&mut self, rings: WindingRings, source: &PaintSource) -> Result<(), SvgError> {
        let (paint, gradient) = match source {
            PaintSource::Solid(paint) => (*paint, None),
            PaintSource::Gradient(gradient, mean) => {
                (*mean, Some(gradient.transformed(self.page_from_path())))
            }
            PaintSource::DegenerateGradient(mean) => {
                self.approximate("gradient without extent", "replaced by its mean colour");
                (*mean, None)
            }
            PaintSource::Pattern(pattern, opacity) => {
                return self.add_pattern(rings, pattern, *opacity);
            }
        };
        self.add_shape(rings, paint, gradient);
        Ok(())
    }

    /// Adds a shape with the name of the current element.
    pub(super) fn add_shape(
        &mut self,
        rings: WindingRings,
        paint: Paint,
        gradient: Option<Gradient>,
    ) {
        if paint.opacity > 0.0 {
            self.painted.shapes.push(SvgShape {
                rings,
                paint,
                gradient,
                is_stroke: false,
                is_text: self.is_in_text,
                stroke: None,
                name: self.group_name.clone(),
            });
        }
    }

    /// Returns the affine map from the coordinates of the current group to the page, y up.
    fn page_from_path(&self) -> DAffine2 {
        let flip_y = DAffine2::from_cols_array(&[1.0, 0.0, 0.0, -1.0, 0.0, self.page.y]);
        flip_y * affine(self.frame)
    }

    /// Tries to add a path as one shape with an attached stroke; returns whether it was added. The
    /// stroke must have no dashes and a uniform width. The subpaths must be closed and cross
    /// neither themselves nor each other. The fill must not be a pattern.
    fn add_stroked_fill(
        &mut self,
        path: &Path,
        fill: Option<&PaintSource>,
        stroke: Paint,
    ) -> Result<bool, SvgError> {
        let is_pattern = matches!(fill, Some(PaintSource::Pattern(..)));
        let is_plain = !is_pattern && !self.is_non_scaling(path) && stroke::is_closed(path);
        let line = stroke::uniform_stroke(path, self.frame, stroke).filter(|_| is_plain);
        let Some(line) = line else {
            return Ok(false);
        };
        let cleaned = self.simple_rings(path)?;
        // A stroke without area inside is a dot, which is a shape itself.
        let Some(cleaned) = cleaned.filter(|rings| !rings.is_empty()) else {
            return Ok(false);
        };
        let invisible = Paint {
            opacity: 0.0,
            ..stroke
        };
        let edge = ShapeStroke {
            line,
            rings: self.stroked_area(path)?,
        };
        let first = self.painted.shapes.len();
        match fill {
            Some(fill) => self.add_painted(cleaned, fill)?,
            None => self.painted.shapes.push(SvgShape {
                rings: cleaned,
                paint: invisible,
                gradient: None,
                is_stroke: false,
                is_text: self.is_in_text,
                stroke: None,
                name: self.group_name.clone(),
            }),
        }
        if let Some(shape) = self.painted.shapes.get_mut(first) {
            shape.stroke = Some(edge);
        }
        Ok(true)
    }
}
