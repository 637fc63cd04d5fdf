//! One moment of a transition.

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

/// A transition at one t, unevaluated: a placement and a place in the mix.
#[derive(Debug)]
pub struct Frame {
    transition: Transition,
    places: LazyPlacement,
}

/// What a frame looks like, evaluated on the CPU.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VectorFigure {
    /// Closed polygons, to be filled together by the non-zero rule; or coat by
    /// coat where there are coats.
    pub rings: Vec<Vec<DVec2>>,
    /// What is painted in colours of its own, the lowest first: all rings, or
    /// none.
    pub coats: Vec<FigureLayer>,
    /// Bars, from end to end.
    pub bars: Vec<[DVec2; 2]>,
    /// For each bar its paints in source and target, or empty.
    pub bar_paints: Vec<[Option<Paint>; 2]>,
    /// Width of the bars, in units of the designs.
    pub bar_width: f64,
}

/// Rings of a figure that are painted alike.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureLayer {
    /// Their indices.
    pub rings: Range<usize>,
    /// Their paint in source and target; see [`Style::paint_at`].
    ///
    /// [`Style::paint_at`]: super::Style::paint_at
    pub paints: [Option<Paint>; 2],
    /// Those that their paints are the means of, where they are here; see
    /// [`Style::gradient_at`].
    ///
    /// [`Style::gradient_at`]: super::Style::gradient_at
    pub gradients: [Option<Gradient>; 2],
    /// The line along them in source and target; see [`StrokeStyle::between`].
    pub lines: [Option<StrokeStyle>; 2],
    /// The time that they show, by which all that is mixed: that of the frame,
    /// unless parts have times of their own.
    pub t: f64,
}

impl Transition {
    /// A frame at `t`, with memory of its own. Outside [0, 1] it
    /// extrapolates; a `t` that is not finite counts as 0.
    #[must_use]
    pub fn frame(&self, t: f64) -> Frame {
        let mut frame = Frame {
            places: LazyPlacement::new(self.player(), 0.0),
            transition: self.clone(),
        };
        frame.seek(t);
        frame
    }

    /// Plays the film, where there is one, and else the warp.
    fn player(&self) -> Placer {
        let film = Arc::clone(self.slot());
        let play = move |t: f64, placement: &mut Placement| match film.get() {
            Some(Ok(film)) => film.place(t, placement),
            _ => false,
        };
        self.warp().placer().after(play)
    }

    /// Source and target as they were given, for ghosts behind the frames.
    #[must_use]
    pub fn outlines(&self) -> [VectorFigure; 2] {
        let designs = self.designs().each_ref();
        designs.map(|design| ghost(design, self.bar_width()))
    }
}

impl Frame {
    /// Moves to `t` without allocating. A `t` that is not finite counts as 0.
    pub fn seek(&mut self, t: f64) {
        self.turn(t);
        self.places.placement(|| self.transition.player());
    }

    /// The same, but that vertices are placed when somebody reads them, if anybody
    /// does.
    pub(crate) fn turn(&mut self, t: f64) {
        self.places.turn(if t.is_finite() { t } else { 0.0 });
    }

    /// The blend parameter.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.places.t()
    }

    /// Whether t lies outside [0, 1].
    #[must_use]
    pub fn is_extrapolated(&self) -> bool {
        !(0.0..=1.0).contains(&self.t())
    }

    /// Where the vertices are.
    #[must_use]
    pub fn placement(&self) -> &Placement {
        self.places.placement(|| self.transition.player())
    }

    /// What this is a frame of.
    #[must_use]
    pub fn transition(&self) -> &Transition {
        &self.transition
    }

    /// The frame as polygons and bars; of pictures the rectangle that they
    /// fill.
    #[must_use]
    pub fn figure(&self) -> VectorFigure {
        match self.transition.content() {
            Content::Solid(solid) => self.coated(VectorFigure {
                bars: solid.bars_at(&self.placement().in_frame),
                bar_paints: solid.bar_paints.clone(),
                bar_width: solid.bar_width,
                ..VectorFigure::default()
            }),
            Content::Field(_) => self.coated(VectorFigure::default()),
            Content::Colours(pair) => VectorFigure {
                rings: vec![pair.window(self.t()).corners().to_vec()],
                ..VectorFigure::default()
            },
        }
    }

    /// With the rings of this frame, coat by coat.
    fn coated(&self, mut figure: VectorFigure) -> VectorFigure {
        let content = self.transition.content();
        for inked in content.coated_at(self.placement(), self.t()) {
            let first = figure.rings.len();
            figure.rings.extend(inked.rings);
            if content.coating().is_some() {
                figure.coats.push(FigureLayer {
                    rings: first..figure.rings.len(),
                    paints: inked.paints,
                    gradients: inked.gradients,
                    lines: inked.lines,
                    t: inked.t,
                });
            }
        }
        figure
    }

    /// The frame as pixels, where pictures are what is seen: sRGB with
    /// straight alpha.
    #[must_use]
    pub fn picture(&self, raster: &PictureRaster) -> Option<RgbaImage> {
        match self.transition.content() {
            Content::Colours(pair) => Some(pair.render(self.placement(), self.t(), raster)),
            Content::Solid(_) | Content::Field(_) => None,
        }
    }
}

impl VectorFigure {
    /// A design on its own, in its own paint where it has some, and else in that
    /// of the style at `t`.
    #[must_use]
    pub fn of(design: &Design, t: f64) -> Self {
        if design.coats.is_empty() {
            return ghost(
                design,
                TransitionOptions::default().bar_width * design.extent.diameter(),
            );
        }
        let mut figure = Self::default();
        for coat in &design.coats {
            let from = figure.rings.len();
            let rings = coat.regions.rings().map(|ring| ring.points().to_vec());
            figure.rings.extend(rings);
            figure.coats.push(FigureLayer {
                rings: from..figure.rings.len(),
                paints: [coat.paint; 2],
                gradients: [coat.gradient.clone(), coat.gradient.clone()],
                lines: [coat.line; 2],
                t,
            });
        }
        figure
    }
}

/// A design on its own.
fn ghost(design: &Design, bar_width: f64) -> VectorFigure {
    let rings = |walks: Vec<&[DVec2]>| walks.into_iter().map(<[DVec2]>::to_vec).collect();
    match &design.form {
        DesignForm::Outline(regions) => VectorFigure {
            rings: rings(regions.rings().map(|ring| ring.points()).collect()),
            ..VectorFigure::default()
        },
        DesignForm::Mesh(mesh) => {
            let at = |walk: Vec<u32>| walk.iter().map(|&v| mesh.positions()[v as usize]).collect();
            VectorFigure {
                rings: mesh.boundary_loops().into_iter().map(at).collect(),
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
