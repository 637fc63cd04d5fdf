//! Display list of an image. The SVG, DXF and raster writers all draw this list, so that their
//! output shows the same image.
//!
//! A [`Drawing`] is a short list of shapes in pixels, y **down**: filled outlines, strokes,
//! round-ended bars, discs, glyph outlines and raster images. The flip from the core's upward y
//! happens in [`PlaneView::to_px`] and nowhere else.
//!
//! Guarantees: solids are closed outlines filled by the nonzero rule, never triangles with hairline
//! gaps between them; every coordinate is finite and at most
//! [`MAX_COORDINATE_PX`](crate::export::MAX_COORDINATE_PX) in magnitude, and shapes beyond that are
//! omitted. Shapes are not clipped to the image; the reader or rasteriser clips them.

use std::collections::HashSet;

use glam::UVec2;
use image::RgbaImage;

use crate::colour::{Gradient, Paint, Rgb, StrokeStyle};
use crate::content::{Content, InkedBars, PictureRaster};
use crate::design::LengthUnit;
use crate::geometry::{Bounds, DVec2};
use crate::space::SpaceFrame;
use crate::transition::{FigureLayer, Frame, TransitionStyle, VectorFigure};

use super::glyph_outlines;
use super::outline::{OutlinePath, is_drawable};
use super::size::PixelSize;
use super::view::PlaneView;

/// Radius of the disc at a joint, in bar widths (heuristic).
pub const JOINT_RADIUS: f64 = 0.9;

/// Radius of the lighter core of a joint, in bar widths (heuristic).
pub const JOINT_CORE_RADIUS: f64 = 0.5;

/// Fraction of white that is mixed into the bars' colour for the core of a joint, in linear light
/// (heuristic).
const JOINT_CORE_LIGHTNESS: f64 = 0.6;

/// One shape of a [`Drawing`]. Variants with a colour instead of a paint are opaque.
#[derive(Clone, Debug, PartialEq)]
pub enum DrawingItem {
    /// A filled outline. Text is a filled outline with a `label`.
    Fill {
        /// Contours, filled by the nonzero rule.
        outline: OutlinePath,
        /// Colour and opacity. If there is a gradient, they are its mean.
        paint: Paint,
        /// Gradient to fill with instead of the plain paint, in pixels, y down.
        gradient: Option<Gradient>,
        /// The text that the outline spells, for screen readers.
        label: Option<String>,
    },
    /// A stroke along closed outlines.
    Stroke {
        /// Contours that the stroke is centred on.
        outline: OutlinePath,
        /// Paint, corner joins, and width in pixels.
        line: StrokeStyle,
    },
    /// Straight bars with round ends.
    Bars {
        /// End points of each bar, in pixels.
        segments: Vec<[DVec2; 2]>,
        /// Width of each bar, in pixels.
        width_px: f64,
        /// Colour of all these bars.
        colour: Rgb,
    },
    /// Discs of equal radius.
    Discs {
        /// Centre of each disc, in pixels.
        centres: Vec<DVec2>,
        /// Radius of each disc, in pixels.
        radius_px: f64,
        /// Colour of all these discs.
        colour: Rgb,
    },
    /// A raster image, copied pixel for pixel.
    Picture {
        /// Pixels with straight (not premultiplied) alpha.
        image: RgbaImage,
        /// Pixel of the drawing at which the upper left corner of the image lies.
        corner: UVec2,
    },
}

/// An image as a list of shapes: [`to_svg`](crate::export::to_svg) writes it and
/// [`rasterise`](crate::export::rasterise) paints it.
///
/// ```
/// use morphospace::export::{Drawing, PixelSize, rasterise, to_svg};
///
/// let drawing = Drawing::new(PixelSize::new(8, 4)?, None);
/// assert_eq!(rasterise(&drawing).dimensions(), (8, 4));
/// assert!(to_svg(&drawing).starts_with("<svg "));
/// # Ok::<(), morphospace::export::PixelSizeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Size of the image.
    pub size: PixelSize,
    /// Background colour; `None` is transparent.
    pub ground: Option<Rgb>,
    /// Shapes in painting order, the lowest first.
    pub items: Vec<DrawingItem>,
    /// Mapping from the plane to pixels if the drawing shows one frame, `None` for sheets.
    pub view: Option<PlaneView>,
    /// Unit of length of the plane, if the designs declare one.
    pub unit: Option<LengthUnit>,
}

impl Drawing {
    /// Creates an empty drawing.
    pub fn new(size: PixelSize, ground: Option<Rgb>) -> Self {
        Self {
            size,
            ground,
            items: Vec::new(),
            view: None,
            unit: None,
        }
    }

    /// Creates the drawing of one frame seen through `view`, as large as the view.
    pub fn of_frame(
        frame: &Frame,
        style: &TransitionStyle,
        view: &PlaneView,
        ground: Option<Rgb>,
    ) -> Self {
        let mut drawing = Self::new(view.size(), ground);
        drawing.push_frame(frame, style, view);
        drawing.view = Some(*view);
        drawing.unit = unit_at(frame);
        drawing
    }

    /// Adds a frame seen through `view`.
    pub fn push_frame(&mut self, frame: &Frame, style: &TransitionStyle, view: &PlaneView) {
        if matches!(frame.transition().content(), Content::Colours(_)) {
            let places = frame.figure().rings.concat();
            return self.push_pixels(&places, view, |raster| frame.picture(raster));
        }
        self.push_figure(&frame.figure(), frame.t(), style, view);
    }

    /// Adds a blend of several designs seen through `view`.
    pub fn push_blend(&mut self, blend: &SpaceFrame, style: &TransitionStyle, view: &PlaneView) {
        match blend.window() {
            Some(window) => {
                self.push_pixels(&window.corners(), view, |raster| blend.picture(raster));
            }
            None => {
                let tint = blend.space().colour_fraction(blend.weights());
                self.push_figure(&blend.figure(), tint, style, view);
            }
        }
    }

    /// Adds a raster image that covers the bounding box of `places` (points of the plane), clipped
    /// to the drawing. `picture` renders the image, or returns `None` if nothing is visible.
    pub(super) fn push_pixels(
        &mut self,
        places: &[DVec2],
        view: &PlaneView,
        picture: impl FnOnce(&PictureRaster) -> Option<RgbaImage>,
    ) {
        let Some(covered) = Bounds::of(places.iter().map(|&p| view.to_px(p))) else {
            return;
        };
        // The rectangle is snapped to whole pixels, so that the image needs no second resampling.
        let (low, high) = (covered.min.floor(), covered.max.ceil());
        let low = low.clamp(DVec2::ZERO, self.size.as_dvec2());
        let high = high.clamp(low, self.size.as_dvec2());
        let size = (high - low).as_uvec2();
        if size.min_element() == 0 {
            return;
        }
        let raster = PictureRaster {
            size: size.to_array(),
            corner: view.to_plane(low),
            pixel_size: 1.0 / view.px_per_unit(),
        };
        if let Some(image) = picture(&raster) {
            let corner = low.as_uvec2();
            self.items.push(DrawingItem::Picture { image, corner });
        }
    }

    /// Adds a figure as it looks at `t`. Its paint layers are added in order; a figure without
    /// paint layers has the colour of the style. Bar joints are discs with a lighter core.
    pub fn push_figure(
        &mut self,
        figure: &VectorFigure,
        t: f64,
        style: &TransitionStyle,
        view: &PlaneView,
    ) {
        let colour = style.fill_at(t);
        match figure.layers.as_slice() {
            [] => self.push_rings(outline_of(&figure.rings, view), colour.into(), None, view),
            coats => self.push_layers(coats, figure, style, view),
        }
        let width_px = figure.bar_width * view.px_per_unit();
        let by_paint =
            InkedBars::grouped_by_paint(figure.bars.len(), &figure.bar_paints).into_iter();
        let inked = by_paint.map(|inked| {
            let bars = inked.bars.iter().map(|&bar| figure.bars[bar]);
            let segments: Vec<[DVec2; 2]> = bars
                .map(|bar| bar.map(|p| view.to_px(p)))
                // Bars far outside the image are omitted, as outlines are, because 32-bit
                // rasterisers lose all precision there.
                .filter(|bar| bar.iter().copied().all(is_drawable))
                .collect();
            (segments, style.paint_at(inked.paints, t).colour)
        });
        self.push_bars(inked.collect(), width_px, style.joints);
    }

    /// Adds a line of text centred on `base_px`, a point on its baseline.
    pub fn push_label(
        &mut self,
        words: &str,
        base_px: DVec2,
        height_px: f64,
        paint: impl Into<Paint>,
    ) {
        self.items.push(DrawingItem::Fill {
            outline: glyph_outlines::centred_text(words, base_px, height_px),
            paint: paint.into(),
            gradient: None,
            label: Some(words.to_owned()),
        });
    }

    /// Like [`Self::push_label`], but reduces the text height where needed to fit into `width_px`.
    pub(super) fn push_label_within(
        &mut self,
        words: &str,
        base_px: DVec2,
        [width_px, height_px]: [f64; 2],
        paint: impl Into<Paint>,
    ) {
        // Empty text has width 0, which must not become a divisor.
        let width = glyph_outlines::width(words, height_px).max(f64::MIN_POSITIVE);
        let height_px = height_px * (width_px / width).min(1.0);
        self.push_label(words, base_px, height_px, paint);
    }

    /// Adds paint layers. Consecutive layers of the same opaque paint are filled together;
    /// otherwise, the background would show through the anti-aliased edges of touching parts.
    fn push_layers(
        &mut self,
        layers: &[FigureLayer],
        figure: &VectorFigure,
        style: &TransitionStyle,
        view: &PlaneView,
    ) {
        let mut layers = layers.iter().map(|layer| {
            let gradients = layer.gradients.each_ref().map(Option::as_ref);
            let gradient = style.gradient_at(gradients, layer.paints, layer.t);
            let paint = style.paint_at(layer.paints, layer.t);
            let line = StrokeStyle::interpolated(layer.lines, layer.t);
            (layer, (paint, gradient), line)
        });
        let add = |outline: &mut OutlinePath, layer: &FigureLayer| {
            let rings = figure.rings[layer.rings.clone()].iter();
            let rings = rings.map(|ring| ring.iter().map(|&p| view.to_px(p)));
            outline.push_named_rings(rings, layer.name());
        };
        let mut next = layers.next();
        while let Some((layer, ink, line)) = next {
            next = layers.next();
            let mut outline = OutlinePath::default();
            add(&mut outline, layer);
            let is_plain = ink.0.is_opaque() && line.is_none();
            while let Some((more, ..)) =
                next.take_if(|(_, other, line)| is_plain && line.is_none() && *other == ink)
            {
                add(&mut outline, more);
                next = layers.next();
            }
            let (paint, gradient) = ink;
            match line {
                Some(line) if line.is_below_fill => {
                    self.push_line(outline.clone(), line, view);
                    self.push_rings(outline, paint, gradient, view);
                }
                Some(line) => {
                    self.push_rings(outline.clone(), paint, gradient, view);
                    self.push_line(outline, line, view);
                }
                None => self.push_rings(outline, paint, gradient, view),
            }
        }
    }

    fn push_rings(
        &mut self,
        outline: OutlinePath,
        paint: Paint,
        gradient: Option<Gradient>,
        view: &PlaneView,
    ) {
        if !outline.commands.is_empty() && paint.opacity > 0.0 {
            self.items.push(DrawingItem::Fill {
                outline,
                paint,
                gradient: gradient.map(|gradient| gradient.transformed(view.affine())),
                label: None,
            });
        }
    }

    fn push_line(&mut self, outline: OutlinePath, line: StrokeStyle, view: &PlaneView) {
        let line = StrokeStyle {
            width: line.width * view.px_per_unit(),
            ..line
        };
        if !outline.commands.is_empty() && line.paint.opacity > 0.0 && line.width > 0.0 {
            self.items.push(DrawingItem::Stroke { outline, line });
        }
    }

    /// Adds bars and their joints, one colour after the other. The joint cores are added last, so
    /// they lie over all bars.
    fn push_bars(&mut self, inked: Vec<(Vec<[DVec2; 2]>, Rgb)>, width_px: f64, joints: bool) {
        let mut cores = Vec::new();
        for (segments, colour) in inked {
            if segments.is_empty() {
                continue;
            }
            let centres = joints.then(|| joint_centres(&segments));
            self.items.push(DrawingItem::Bars {
                segments,
                width_px,
                colour,
            });
            let Some(centres) = centres else { continue };
            self.items.push(DrawingItem::Discs {
                centres: centres.clone(),
                radius_px: JOINT_RADIUS * width_px,
                colour,
            });
            cores.push(DrawingItem::Discs {
                centres,
                radius_px: JOINT_CORE_RADIUS * width_px,
                colour: joint_core(colour),
            });
        }
        self.items.extend(cores);
    }
}

/// Returns the unit of length of a frame: that of the source before t = ½, that of the target from
/// there on. A design without a unit has that of the other one.
fn unit_at(frame: &Frame) -> Option<LengthUnit> {
    let [source, target] = frame
        .transition()
        .designs()
        .each_ref()
        .map(|design| design.unit);
    if frame.t() < 0.5 {
        source.or(target)
    } else {
        target.or(source)
    }
}

/// Converts boundary loops in the plane to closed contours in pixels.
fn outline_of(rings: &[Vec<DVec2>], view: &PlaneView) -> OutlinePath {
    let mut outline = OutlinePath::default();
    for ring in rings {
        outline.push_ring(ring.iter().map(|&p| view.to_px(p)));
    }
    outline
}

/// Returns the lighter colour of a joint core, for bars of the given colour.
pub fn joint_core(colour: Rgb) -> Rgb {
    colour.mixed(Rgb([255; 3]), JOINT_CORE_LIGHTNESS)
}

/// Returns the distinct end points of the bars, in the order of the bars.
fn joint_centres(segments: &[[DVec2; 2]]) -> Vec<DVec2> {
    let mut seen = HashSet::new();
    // Bars that share a node have bit-identical end points.
    let is_new = |p: &DVec2| seen.insert([p.x.to_bits(), p.y.to_bits()]);
    segments.iter().flatten().copied().filter(is_new).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::StrokeJoin;

    const BLUE: Rgb = Rgb([59, 125, 216]);

    fn blue() -> TransitionStyle {
        TransitionStyle {
            source: BLUE,
            ..TransitionStyle::default()
        }
    }

    #[test]
    fn layers_are_filled_in_order_and_equal_neighbours_together() {
        let [red, _] = red_and_nothing();
        let figure = four_layers();
        let mut drawing = Drawing::new(PixelSize::new(4, 4).expect("a legal size"), None);
        drawing.push_figure(&figure, 0.0, &blue(), &view());
        let filled = |item: &DrawingItem| match item {
            DrawingItem::Fill { outline, paint, .. } => (outline.commands.len(), *paint),
            other => panic!("expected only fills: {other:?}"),
        };
        let fills: Vec<_> = drawing.items.iter().map(filled).collect();
        assert_eq!(fills, [(8, red), (4, BLUE.into())]);
    }

    #[test]
    fn the_stroke_of_a_layer_lies_between_its_fill_and_the_next_layer() {
        let [red, _] = red_and_nothing();
        let mut lined = four_layers();
        let mut drawing = Drawing::new(PixelSize::new(4, 4).expect("a legal size"), None);
        let line = StrokeStyle {
            paint: red,
            width: 0.02,
            join: StrokeJoin::Round,
            is_below_fill: false,
        };
        lined.layers[0].lines = [Some(line), None];
        drawing.push_figure(&lined, 0.0, &blue(), &view());
        let [
            DrawingItem::Fill { .. },
            DrawingItem::Stroke { line, .. },
            DrawingItem::Fill { .. },
            DrawingItem::Fill { .. },
        ] = drawing.items.as_slice()
        else {
            panic!(
                "expected a stroke over the first layer: {:?}",
                drawing.items
            );
        };
        assert!((line.width - 2.0).abs() < 1e-12);
    }

    /// An opaque red and a red of opacity 0.
    fn red_and_nothing() -> [Paint; 2] {
        [1.0, 0.0].map(|opacity| Paint {
            colour: Rgb([255, 0, 0]),
            opacity,
        })
    }

    /// Four triangles, each a layer: red, red, transparent, blue.
    fn four_layers() -> VectorFigure {
        let square = |x: f64| {
            [(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0)]
                .map(DVec2::from)
                .to_vec()
        };
        let [red, none] = red_and_nothing();
        let paints = [red, red, none, BLUE.into()];
        let layers = paints.iter().enumerate().map(|(k, &paint)| FigureLayer {
            rings: k..k + 1,
            paints: [Some(paint), None],
            gradients: [None, None],
            lines: [None; 2],
            names: Default::default(),
            t: 0.0,
        });
        VectorFigure {
            rings: [0.0, 1.0, 1.5, 2.0].map(square).to_vec(),
            layers: layers.collect(),
            ..VectorFigure::default()
        }
    }

    fn view() -> PlaneView {
        let bounds = Bounds {
            min: DVec2::new(-1.0, 0.0),
            max: DVec2::new(3.0, 2.0),
        };
        PlaneView::fit(bounds, PixelSize::new(400, 400).expect("a legal size"))
    }

    #[test]
    fn bars_share_one_joint_at_a_common_node() {
        let node = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let figure = VectorFigure {
            rings: vec![],
            bars: vec![[node[0], node[1]], [node[1], node[2]], [node[2], node[0]]],
            bar_width: 0.1,
            ..VectorFigure::default()
        };
        let size = PixelSize::new(400, 400).expect("a legal size");
        let mut drawing = Drawing::new(size, None);
        drawing.push_figure(&figure, 0.0, &blue(), &view());
        let [
            DrawingItem::Bars { width_px, .. },
            DrawingItem::Discs { centres, .. },
            DrawingItem::Discs { colour, .. },
        ] = drawing.items.as_slice()
        else {
            panic!("expected bars, joints and cores: {:?}", drawing.items);
        };
        assert!((width_px - 10.0).abs() < 1e-12);
        assert_eq!(centres.len(), 3);
        assert!((0..3).all(|k| colour.0[k] > BLUE.0[k]));
    }

    #[test]
    fn undrawable_shapes_are_omitted() {
        let far = DVec2::new(1e300, 0.0);
        let nan = DVec2::new(f64::NAN, 0.0);
        let figure = VectorFigure {
            rings: vec![
                vec![DVec2::ZERO, DVec2::X, far],
                vec![DVec2::ZERO, DVec2::X],
                vec![DVec2::ZERO, DVec2::X, nan],
            ],
            bars: vec![[DVec2::ZERO, far]],
            bar_width: 0.1,
            ..VectorFigure::default()
        };
        let mut drawing = Drawing::new(PixelSize::new(4, 4).expect("a legal size"), None);
        drawing.push_figure(&figure, 0.0, &blue(), &view());
        assert!(drawing.items.is_empty());
    }
}
