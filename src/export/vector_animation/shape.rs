//! Splits a shape of a drawing into data that stays constant while the shape moves, the positions
//! of its points, and the numbers of its appearance (colour, opacity, width, gradient).

use crate::colour::{
    Gradient, GradientGeometry, GradientSpread, GradientStop, Paint, Rgb, StrokeJoin, StrokeStyle,
};
use crate::export::drawing::DrawingItem;
use crate::export::outline::{OutlinePath, PathCommand};
use crate::geometry::{DAffine2, DVec2};
use std::sync::Arc;

/// Data of a moving shape that is the same at every moment.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ShapeForm {
    /// A filled outline.
    Fill {
        verbs: Vec<PathVerb>,
        /// Text that the outline spells.
        label: Option<String>,
        /// Constant data of the gradient; `None` for a plain fill.
        ramp: Option<GradientForm>,
    },
    /// A stroke along closed outlines.
    Stroke {
        verbs: Vec<PathVerb>,
        join: StrokeJoin,
    },
    /// Bars with two points each.
    Bars,
    /// Discs with one point each.
    Discs,
}

/// Path command of an outline without its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathVerb {
    Move,
    Line,
    Quad,
    Cubic,
    Close,
}

impl PathVerb {
    /// Returns the number of points that the command takes.
    pub(super) fn point_count(self) -> usize {
        match self {
            Self::Move | Self::Line => 1,
            Self::Quad => 2,
            Self::Cubic => 3,
            Self::Close => 0,
        }
    }
}

/// Data of a gradient that is the same at every moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GradientForm {
    pub is_radial: bool,
    /// Number of colour stops.
    pub stops: usize,
    pub spread: GradientSpread,
}

/// Number of values of an appearance before those of its gradient (derived): red, green and blue
/// from 0 to 255, opacity from 0 to 1, and the width or radius in pixels. A gradient stop has as
/// many: its offset, colour and opacity.
const PLAIN_NUMBERS: usize = 5;

/// A shape at one moment.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PosedShape {
    pub form: Arc<ShapeForm>,
    /// Points of the shape in the order of its path commands, in pixels.
    pub points: Vec<DVec2>,
    /// Colour, opacity and width, followed by the numbers of the gradient, if any: its affine
    /// transform, its focus and inner radius if it is radial, and its stops.
    pub appearance: Vec<f64>,
}

impl PosedShape {
    /// Splits a shape of a drawing into its constant data, its points and its appearance. Returns
    /// `None` for a raster image, which has no points.
    pub(super) fn of(item: &DrawingItem) -> Option<Self> {
        Some(match item {
            DrawingItem::Fill {
                outline,
                paint,
                gradient,
                label,
            } => {
                let (verbs, points) = split_outline(outline);
                let mut look = plain_numbers(*paint, 0.0);
                look.extend(gradient.iter().flat_map(gradient_numbers));
                let (label, ramp) = (label.clone(), gradient.as_ref().map(gradient_form));
                let form = Arc::new(ShapeForm::Fill { verbs, label, ramp });
                Self {
                    form,
                    points,
                    appearance: look,
                }
            }
            DrawingItem::Stroke { outline, line } => {
                let (verbs, points) = split_outline(outline);
                let look = plain_numbers(line.paint, line.width);
                let join = line.join;
                let form = Arc::new(ShapeForm::Stroke { verbs, join });
                Self {
                    form,
                    points,
                    appearance: look,
                }
            }
            DrawingItem::Bars {
                segments,
                width_px,
                colour,
            } => Self {
                form: Arc::new(ShapeForm::Bars),
                points: segments.concat(),
                appearance: plain_numbers((*colour).into(), *width_px),
            },
            DrawingItem::Discs {
                centres,
                radius_px,
                colour,
            } => Self {
                form: Arc::new(ShapeForm::Discs),
                points: centres.clone(),
                appearance: plain_numbers((*colour).into(), *radius_px),
            },
            DrawingItem::Picture { .. } => return None,
        })
    }

    /// Returns the number of contours of an outline; for bars and discs, the number of points.
    pub(super) fn contour_count(&self) -> usize {
        match &*self.form {
            ShapeForm::Fill { verbs, .. } | ShapeForm::Stroke { verbs, .. } => {
                let starts = verbs.iter().filter(|&&verb| verb == PathVerb::Move);
                starts.count()
            }
            ShapeForm::Bars | ShapeForm::Discs => self.points.len(),
        }
    }

    /// Returns whether `other` can be the same shape at another moment.
    pub(super) fn has_form_of(&self, other: &Self) -> bool {
        self.form == other.form && self.points.len() == other.points.len()
    }

    /// Converts the shape back to an item of a drawing.
    pub(super) fn to_item(&self) -> DrawingItem {
        let (paint, width) = (self.paint(), self.width());
        match &*self.form {
            ShapeForm::Fill { verbs, label, .. } => DrawingItem::Fill {
                outline: join_outline(verbs, &self.points),
                paint,
                gradient: self.gradient(),
                label: label.clone(),
            },
            ShapeForm::Stroke { verbs, join } => DrawingItem::Stroke {
                outline: join_outline(verbs, &self.points),
                line: StrokeStyle {
                    paint,
                    width,
                    join: *join,
                    is_below_fill: false,
                },
            },
            ShapeForm::Bars => DrawingItem::Bars {
                segments: self.points.chunks_exact(2).map(|b| [b[0], b[1]]).collect(),
                width_px: width,
                colour: paint.colour,
            },
            ShapeForm::Discs => DrawingItem::Discs {
                centres: self.points.clone(),
                radius_px: width,
                colour: paint.colour,
            },
        }
    }

    /// Returns colour and opacity.
    pub(super) fn paint(&self) -> Paint {
        paint(&self.appearance)
    }

    /// Returns the width of a stroke or of bars, or the radius of discs, in pixels.
    pub(super) fn width(&self) -> f64 {
        self.appearance[PLAIN_NUMBERS - 1]
    }

    /// Returns the gradient of a fill, if it has one.
    pub(super) fn gradient(&self) -> Option<Gradient> {
        let ShapeForm::Fill {
            ramp: Some(ramp), ..
        } = *self.form
        else {
            return None;
        };
        let (frame, rest) = self.appearance[PLAIN_NUMBERS..].split_at(6);
        let (focus, stops) = rest.split_at(if ramp.is_radial { 3 } else { 0 });
        let stop = |stop: &[f64]| GradientStop {
            offset: stop[0],
            paint: paint(&stop[1..]),
        };
        Some(Gradient {
            geometry: match focus {
                [x, y, inner] => GradientGeometry::Radial {
                    focus: DVec2::new(*x, *y),
                    inner: *inner,
                },
                _ => GradientGeometry::Linear,
            },
            frame: DAffine2::from_cols_slice(frame),
            stops: stops.chunks_exact(PLAIN_NUMBERS).map(stop).collect(),
            spread: ramp.spread,
        })
    }
}

/// Returns the numbers of an appearance without gradient.
fn plain_numbers(paint: Paint, width: f64) -> Vec<f64> {
    let [r, g, b] = paint.colour.0.map(f64::from);
    vec![r, g, b, paint.opacity, width]
}

/// Returns colour and opacity from the numbers of an appearance.
fn paint(numbers: &[f64]) -> Paint {
    let channel = |k: usize| numbers[k].round().clamp(0.0, 255.0) as u8;
    Paint {
        colour: Rgb([channel(0), channel(1), channel(2)]),
        opacity: numbers[3],
    }
}

/// Returns the constant data of a gradient.
fn gradient_form(gradient: &Gradient) -> GradientForm {
    GradientForm {
        is_radial: gradient.geometry != GradientGeometry::Linear,
        stops: gradient.stops.len(),
        spread: gradient.spread,
    }
}

/// Returns the numbers of a gradient that may change over time.
fn gradient_numbers(gradient: &Gradient) -> Vec<f64> {
    let mut numbers = gradient.frame.to_cols_array().to_vec();
    if let GradientGeometry::Radial { focus, inner } = gradient.geometry {
        numbers.extend([focus.x, focus.y, inner]);
    }
    for stop in &gradient.stops {
        let [r, g, b] = stop.paint.colour.0.map(f64::from);
        numbers.extend([stop.offset, r, g, b, stop.paint.opacity]);
    }
    numbers
}

/// Splits an outline into commands and points.
fn split_outline(outline: &OutlinePath) -> (Vec<PathVerb>, Vec<DVec2>) {
    let mut points = Vec::new();
    let verb = |step: &PathCommand| match *step {
        PathCommand::Move(p) => {
            points.push(p);
            PathVerb::Move
        }
        PathCommand::Line(p) => {
            points.push(p);
            PathVerb::Line
        }
        PathCommand::Quad(c, p) => {
            points.extend([c, p]);
            PathVerb::Quad
        }
        PathCommand::Cubic(c, d, p) => {
            points.extend([c, d, p]);
            PathVerb::Cubic
        }
        PathCommand::Close => PathVerb::Close,
    };
    let verbs = outline.commands.iter().map(verb).collect();
    (verbs, points)
}

/// Combines commands and points to an outline.
fn join_outline(verbs: &[PathVerb], points: &[DVec2]) -> OutlinePath {
    let mut rest = points;
    let step = |verb: &PathVerb| {
        let (verb_points, after) = rest.split_at(verb.point_count());
        rest = after;
        match (verb, verb_points) {
            (PathVerb::Move, &[p]) => PathCommand::Move(p),
            (PathVerb::Line, &[p]) => PathCommand::Line(p),
            (PathVerb::Quad, &[c, p]) => PathCommand::Quad(c, p),
            (PathVerb::Cubic, &[c, d, p]) => PathCommand::Cubic(c, d, p),
            _ => PathCommand::Close,
        }
    };
    OutlinePath {
        commands: verbs.iter().map(step).collect(),
        ..OutlinePath::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64) -> DVec2 {
        DVec2::new(x, 2.0 * x)
    }

    fn outline() -> OutlinePath {
        let steps = vec![
            PathCommand::Move(p(0.0)),
            PathCommand::Line(p(1.0)),
            PathCommand::Quad(p(2.0), p(3.0)),
            PathCommand::Cubic(p(4.0), p(5.0), p(6.0)),
            PathCommand::Close,
        ];
        OutlinePath {
            commands: steps,
            ..OutlinePath::default()
        }
    }

    fn gradient(paint: Paint) -> Gradient {
        let stop = |at| GradientStop { offset: at, paint };
        Gradient {
            geometry: GradientGeometry::Radial {
                focus: p(0.25),
                inner: 0.125,
            },
            frame: DAffine2::from_scale_angle_translation(p(1.0), 0.5, p(3.0)),
            stops: vec![stop(0.0), stop(0.5), stop(1.0)],
            spread: GradientSpread::Reflect,
        }
    }

    #[test]
    fn split_shapes_are_restored_exactly() {
        let paint = Paint {
            colour: Rgb([1, 2, 3]),
            opacity: 0.5,
        };
        let line = StrokeStyle {
            paint,
            width: 3.5,
            join: StrokeJoin::Mitre(4.0),
            is_below_fill: false,
        };
        let colour = paint.colour;
        for item in [
            DrawingItem::Fill {
                outline: outline(),
                paint,
                gradient: Some(gradient(paint)),
                label: Some("words".to_owned()),
            },
            DrawingItem::Stroke {
                outline: outline(),
                line,
            },
            DrawingItem::Bars {
                segments: vec![[p(1.0), p(2.0)], [p(2.0), p(4.0)]],
                width_px: 2.0,
                colour,
            },
            DrawingItem::Discs {
                centres: vec![p(1.0), p(2.0)],
                radius_px: 2.0,
                colour,
            },
        ] {
            let posed = PosedShape::of(&item).expect("a shape");
            assert_eq!(posed.to_item(), item);
        }
    }
}
