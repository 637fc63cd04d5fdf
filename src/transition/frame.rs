//! A transition at one t, and its appearance as polygons and bars.

use super::lazy_placement::LazyPlacement;
use super::options::TransitionOptions;
use super::transition::Transition;
use crate::colour::{Gradient, Paint, StrokeStyle};
use crate::content::{Content, PictureRaster};
use crate::design::{Design, DesignForm};
use crate::geometry::DVec2;
use crate::warp::{Placement, Placer};
use image::RgbaImage;
use std::ops::Range;
use std::sync::Arc;

/// A transition at one t: the placement of its vertices, and the t at which contents are mixed.
/// Polygons and pixels are computed only on request.
#[derive(Debug)]
pub struct Frame {
    transition: Transition,
    places: LazyPlacement,
}

/// The appearance of a frame, evaluated on the CPU.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VectorFigure {
    /// Closed polygons, filled by the non-zero rule. All polygons are filled together; if there are
    /// paint layers, those of each layer are filled together.
    pub rings: Vec<Vec<DVec2>>,
    /// Paint layers, the lowest first, which together contain all rings. Empty if the figure has no
    /// paints.
    pub layers: Vec<FigureLayer>,
    /// End points of each bar.
    pub bars: Vec<[DVec2; 2]>,
    /// Paints of each bar in source and target; empty if the bars have no paints.
    pub bar_paints: Vec<[Option<Paint>; 2]>,
    /// Width of the bars in units of the designs.
    pub bar_width: f64,
}

/// A paint layer of a figure: rings that share paint, gradient and stroke.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureLayer {
    /// Indices of the layer's rings in [`VectorFigure::rings`].
    pub rings: Range<usize>,
    /// Paints in source and target; see [`TransitionStyle::paint_at`].
    ///
    /// [`TransitionStyle::paint_at`]: super::TransitionStyle::paint_at
    pub paints: [Option<Paint>; 2],
    /// Gradients in source and target, if any; `paints` then holds their mean colours. See
    /// [`TransitionStyle::gradient_at`].
    ///
    /// [`TransitionStyle::gradient_at`]: super::TransitionStyle::gradient_at
    pub gradients: [Option<Gradient>; 2],
    /// Stroke along the rings in source and target; see [`StrokeStyle::interpolated`].
    pub lines: [Option<StrokeStyle>; 2],
    /// Names of the layer in the files of source and target; empty where it has none. See
    /// [`FigureLayer::name`].
    pub names: [Arc<str>; 2],
    /// The t at which paints, gradients and strokes are mixed: that of the frame, unless the part
    /// has its own timing.
    pub t: f64,
}

impl Transition {
    /// Creates a frame at `t`, with its own memory. Outside [0, 1] the frame extrapolates; a `t`
    /// that is not finite counts as 0.
    #[must_use]
    pub fn frame(&self, t: f64) -> Frame {
        let mut frame = Frame {
            places: LazyPlacement::new(self.playing_placer(), 0.0),
            transition: self.clone(),
        };
        frame.seek(t);
        frame
    }

    /// Returns a placer that evaluates the recording if there is one, otherwise the warp.
    fn playing_placer(&self) -> Placer {
        let recording = Arc::clone(self.recording_slot());
        let play = move |t: f64, placement: &mut Placement| match recording.get() {
            Some(Ok(recording)) => recording.place(t, placement),
            _ => false,
        };
        self.warp().placer().with_override(play)
    }

    /// Returns the unchanged source and target as polygons and bars, to be drawn behind the frames.
    #[must_use]
    pub fn outlines(&self) -> [VectorFigure; 2] {
        let designs = self.designs().each_ref();
        designs.map(|design| design_figure(design, self.bar_width()))
    }
}

impl Frame {
    /// Moves to `t` without allocating. A `t` that is not finite counts as 0.
    pub fn seek(&mut self, t: f64) {
        self.set_time(t);
        self.places.placement(|| self.transition.playing_placer());
    }

    /// Moves to `t`; vertices are placed only when their positions are read.
    pub(crate) fn set_time(&mut self, t: f64) {
        self.places.set_time(if t.is_finite() { t } else { 0.0 });
    }

    /// Returns the blend parameter t of the frame.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.places.t()
    }

    /// Returns whether t lies outside [0, 1].
    #[must_use]
    pub fn is_extrapolated(&self) -> bool {
        !(0.0..=1.0).contains(&self.t())
    }

    /// Returns the positions of the vertices at the current t.
    #[must_use]
    pub fn placement(&self) -> &Placement {
        self.places.placement(|| self.transition.playing_placer())
    }

    /// Returns the transition to which the frame belongs.
    #[must_use]
    pub fn transition(&self) -> &Transition {
        &self.transition
    }

    /// Evaluates the frame as polygons and bars. For pictures, the result is the rectangle that
    /// they fill.
    #[must_use]
    pub fn figure(&self) -> VectorFigure {
        match self.transition.content() {
            Content::Solid(solid) => self.with_paint_layers(VectorFigure {
                bars: solid.bars_at(&self.placement().in_frame),
                bar_paints: solid.bar_paints.clone(),
                bar_width: solid.bar_width,
                ..VectorFigure::default()
            }),
            Content::Field(_) => self.with_paint_layers(VectorFigure::default()),
            Content::Colours(pair) => VectorFigure {
                rings: vec![pair.window(self.t()).corners().to_vec()],
                ..VectorFigure::default()
            },
        }
    }

    /// Returns `figure` with the rings of this frame added to it, the lowest paint layer first.
    fn with_paint_layers(&self, mut figure: VectorFigure) -> VectorFigure {
        let content = self.transition.content();
        for inked in content.layers_at(self.placement(), self.t()) {
            let first = figure.rings.len();
            figure.rings.extend(inked.rings);
            if content.paint_layers().is_some() {
                figure.layers.push(FigureLayer {
                    rings: first..figure.rings.len(),
                    paints: inked.paints,
                    gradients: inked.gradients,
                    lines: inked.strokes,
                    names: inked.names,
                    t: inked.t,
                });
            }
        }
        figure
    }

    /// Renders the frame as sRGB pixels with straight alpha; `None` unless the content is pictures.
    #[must_use]
    pub fn picture(&self, raster: &PictureRaster) -> Option<RgbaImage> {
        match self.transition.content() {
            Content::Colours(pair) => Some(pair.render(self.placement(), self.t(), raster)),
            Content::Solid(_) | Content::Field(_) => None,
        }
    }
}

impl FigureLayer {
    /// Returns the name of the layer: that of the source before t = ½, that of the target from
    /// there on. A side without a name has that of the other side.
    #[must_use]
    pub fn name(&self) -> &Arc<str> {
        let [source, target] = &self.names;
        let (own, other) = if self.t < 0.5 {
            (source, target)
        } else {
            (target, source)
        };
        if own.is_empty() { other } else { own }
    }
}

impl VectorFigure {
    /// Returns the appearance of a design in its own paint. Layers without paint get the fill
    /// colour of the [`TransitionStyle`](super::TransitionStyle) at `t`.
    #[must_use]
    pub fn of(design: &Design, t: f64) -> Self {
        if design.paint_layers.is_empty() {
            return design_figure(
                design,
                TransitionOptions::default().bar_width * design.extent.diameter(),
            );
        }
        let mut figure = Self::default();
        for coat in &design.paint_layers {
            let from = figure.rings.len();
            let rings = coat.regions.rings().map(|ring| ring.points().to_vec());
            figure.rings.extend(rings);
            figure.layers.push(FigureLayer {
                rings: from..figure.rings.len(),
                paints: [coat.paint; 2],
                gradients: [coat.gradient.clone(), coat.gradient.clone()],
                lines: [coat.line; 2],
                names: [coat.name.as_str().into(), Arc::default()],
                t,
            });
        }
        figure
    }
}

/// Returns the appearance of a design without paint layers.
fn design_figure(design: &Design, bar_width: f64) -> VectorFigure {
    let rings = |loops: Vec<&[DVec2]>| loops.into_iter().map(<[DVec2]>::to_vec).collect();
    match &design.form {
        DesignForm::Outline(regions) => VectorFigure {
            rings: rings(regions.rings().map(|ring| ring.points()).collect()),
            ..VectorFigure::default()
        },
        DesignForm::Mesh(mesh) => {
            let positions = |boundary_loop: Vec<u32>| {
                boundary_loop
                    .iter()
                    .map(|&v| mesh.positions()[v as usize])
                    .collect()
            };
            VectorFigure {
                rings: mesh.boundary_loops().into_iter().map(positions).collect(),
                ..VectorFigure::default()
            }
        }
        DesignForm::Truss(truss) => VectorFigure {
            bars: truss.segments().collect(),
            bar_paints: {
                let colours = truss.parts().colours.iter();
                colours.map(|&rgb| [Some(rgb.into()); 2]).collect()
            },
            bar_width,
            ..VectorFigure::default()
        },
    }
}
