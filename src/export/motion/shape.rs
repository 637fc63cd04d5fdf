//! A shape of a drawing, taken apart: what stays the same while it moves, where its
//! points are, and numbers for its looks.

use crate::colour::{Course, Gradient, Join, Line, Paint, Rgb, Spread, Stop};
use crate::export::drawing::Item;
use crate::export::outline::{Outline, Step};
use crate::geometry::{DAffine2, DVec2};
use std::sync::Arc;

/// What of a shape stays the same while it moves.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Form {
    /// A filled outline.
    Fill {
        verbs: Vec<Verb>,
        label: Option<String>,
        ramp: Option<Ramp>,
    },
    /// A line along closed outlines.
    Line { verbs: Vec<Verb>, join: Join },
    /// Bars, of which each has two points.
    Bars,
    /// Discs, of which each has one.
    Discs,
}

/// A step of an outline without its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verb {
    Move,
    Line,
    Quad,
    Cubic,
    Close,
}

impl Verb {
    /// How many points it takes.
    pub(super) fn points(self) -> usize {
        match self {
            Self::Move | Self::Line => 1,
            Self::Quad => 2,
            Self::Cubic => 3,
            Self::Close => 0,
        }
    }
}

/// What of a gradient stays the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ramp {
    pub is_round: bool,
    pub stops: usize,
    pub spread: Spread,
}

/// Numbers of a look before those of its gradient: red, green and blue up to 255,
/// opacity, and the width or the radius.
const PLAIN: usize = 5;

/// A shape at one moment.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Posed {
    pub form: Arc<Form>,
    pub points: Vec<DVec2>,
    /// Colour, opacity, width, and what a gradient has: its frame, its focus if it is
    /// round, and its stops.
    pub look: Vec<f64>,
}

impl Posed {
    /// Takes a shape apart; pictures have no points to move.
    pub(super) fn of(item: &Item) -> Option<Self> {
        Some(match item {
            Item::Fill {
                outline,
                paint,
                gradient,
                label,
            } => {
                let (verbs, points) = taken(outline);
                let mut look = plain(*paint, 0.0);
                look.extend(gradient.iter().flat_map(shading));
                let (label, ramp) = (label.clone(), gradient.as_ref().map(ramp));
                let form = Arc::new(Form::Fill { verbs, label, ramp });
                Self { form, points, look }
            }
            Item::Line { outline, line } => {
                let (verbs, points) = taken(outline);
                let look = plain(line.paint, line.width);
                let join = line.join;
                let form = Arc::new(Form::Line { verbs, join });
                Self { form, points, look }
            }
            Item::Bars {
                segments,
                width_px,
                colour,
            } => Self {
                form: Arc::new(Form::Bars),
                points: segments.concat(),
                look: plain((*colour).into(), *width_px),
            },
            Item::Discs {
                centres,
                radius_px,
                colour,
            } => Self {
                form: Arc::new(Form::Discs),
                points: centres.clone(),
                look: plain((*colour).into(), *radius_px),
            },
            Item::Picture { .. } => return None,
        })
    }

    /// How many outlines it has.
    pub(super) fn outlines(&self) -> usize {
        match &*self.form {
            Form::Fill { verbs, .. } | Form::Line { verbs, .. } => {
                let starts = verbs.iter().filter(|&&verb| verb == Verb::Move);
                starts.count()
            }
            Form::Bars | Form::Discs => self.points.len(),
        }
    }

    /// Whether the other is the same at another moment.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.form == other.form && self.points.len() == other.points.len()
    }

    /// Puts it together again.
    pub(super) fn item(&self) -> Item {
        let (paint, width) = (self.paint(), self.width());
        match &*self.form {
            Form::Fill { verbs, label, .. } => Item::Fill {
                outline: put_together(verbs, &self.points),
                paint,
                gradient: self.gradient(),
                label: label.clone(),
            },
            Form::Line { verbs, join } => Item::Line {
                outline: put_together(verbs, &self.points),
                line: Line {
                    paint,
                    width,
                    join: *join,
                },
            },
            Form::Bars => Item::Bars {
                segments: self.points.chunks_exact(2).map(|b| [b[0], b[1]]).collect(),
                width_px: width,
                colour: paint.colour,
            },
            Form::Discs => Item::Discs {
                centres: self.points.clone(),
                radius_px: width,
                colour: paint.colour,
            },
        }
    }

    pub(super) fn paint(&self) -> Paint {
        paint(&self.look)
    }

    /// The width of a line or of bars, or the radius of discs.
    pub(super) fn width(&self) -> f64 {
        self.look[PLAIN - 1]
    }

    /// The gradient that it is filled with.
    pub(super) fn gradient(&self) -> Option<Gradient> {
        let Form::Fill {
            ramp: Some(ramp), ..
        } = *self.form
        else {
            return None;
        };
        let (frame, rest) = self.look[PLAIN..].split_at(6);
        let (focus, stops) = rest.split_at(if ramp.is_round { 3 } else { 0 });
        let stop = |stop: &[f64]| Stop {
            at: stop[0],
            paint: paint(&stop[1..]),
        };
        Some(Gradient {
            course: match focus {
                [x, y, inner] => Course::Round {
                    focus: DVec2::new(*x, *y),
                    inner: *inner,
                },
                _ => Course::Straight,
            },
            frame: DAffine2::from_cols_slice(frame),
            stops: stops.chunks_exact(PLAIN).map(stop).collect(),
            spread: ramp.spread,
        })
    }
}

fn plain(paint: Paint, width: f64) -> Vec<f64> {
    let [r, g, b] = paint.colour.0.map(f64::from);
    vec![r, g, b, paint.opacity, width]
}

fn paint(numbers: &[f64]) -> Paint {
    let channel = |k: usize| numbers[k].round().clamp(0.0, 255.0) as u8;
    Paint {
        colour: Rgb([channel(0), channel(1), channel(2)]),
        opacity: numbers[3],
    }
}

fn ramp(gradient: &Gradient) -> Ramp {
    Ramp {
        is_round: gradient.course != Course::Straight,
        stops: gradient.stops.len(),
        spread: gradient.spread,
    }
}

fn shading(gradient: &Gradient) -> Vec<f64> {
    let mut numbers = gradient.frame.to_cols_array().to_vec();
    if let Course::Round { focus, inner } = gradient.course {
        numbers.extend([focus.x, focus.y, inner]);
    }
    for stop in &gradient.stops {
        let [r, g, b] = stop.paint.colour.0.map(f64::from);
        numbers.extend([stop.at, r, g, b, stop.paint.opacity]);
    }
    numbers
}

fn taken(outline: &Outline) -> (Vec<Verb>, Vec<DVec2>) {
    let mut points = Vec::new();
    let verb = |step: &Step| match *step {
        Step::Move(p) => {
            points.push(p);
            Verb::Move
        }
        Step::Line(p) => {
            points.push(p);
            Verb::Line
        }
        Step::Quad(c, p) => {
            points.extend([c, p]);
            Verb::Quad
        }
        Step::Cubic(c, d, p) => {
            points.extend([c, d, p]);
            Verb::Cubic
        }
        Step::Close => Verb::Close,
    };
    let verbs = outline.steps.iter().map(verb).collect();
    (verbs, points)
}

/// The steps of an outline with their points.
fn put_together(verbs: &[Verb], points: &[DVec2]) -> Outline {
    let mut rest = points;
    let step = |verb: &Verb| {
        let (own, after) = rest.split_at(verb.points());
        rest = after;
        match (verb, own) {
            (Verb::Move, &[p]) => Step::Move(p),
            (Verb::Line, &[p]) => Step::Line(p),
            (Verb::Quad, &[c, p]) => Step::Quad(c, p),
            (Verb::Cubic, &[c, d, p]) => Step::Cubic(c, d, p),
            _ => Step::Close,
        }
    };
    Outline {
        steps: verbs.iter().map(step).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64) -> DVec2 {
        DVec2::new(x, 2.0 * x)
    }

    fn outline() -> Outline {
        let steps = vec![
            Step::Move(p(0.0)),
            Step::Line(p(1.0)),
            Step::Quad(p(2.0), p(3.0)),
            Step::Cubic(p(4.0), p(5.0), p(6.0)),
            Step::Close,
        ];
        Outline { steps }
    }

    fn gradient(paint: Paint) -> Gradient {
        let stop = |at| Stop { at, paint };
        Gradient {
            course: Course::Round {
                focus: p(0.25),
                inner: 0.125,
            },
            frame: DAffine2::from_scale_angle_translation(p(1.0), 0.5, p(3.0)),
            stops: vec![stop(0.0), stop(0.5), stop(1.0)],
            spread: Spread::Reflect,
        }
    }

    #[test]
    fn shapes_are_put_together_as_they_were() {
        let paint = Paint {
            colour: Rgb([1, 2, 3]),
            opacity: 0.5,
        };
        let line = Line {
            paint,
            width: 3.5,
            join: Join::Mitre(4.0),
        };
        let colour = paint.colour;
        for item in [
            Item::Fill {
                outline: outline(),
                paint,
                gradient: Some(gradient(paint)),
                label: Some("words".to_owned()),
            },
            Item::Line {
                outline: outline(),
                line,
            },
            Item::Bars {
                segments: vec![[p(1.0), p(2.0)], [p(2.0), p(4.0)]],
                width_px: 2.0,
                colour,
            },
            Item::Discs {
                centres: vec![p(1.0), p(2.0)],
                radius_px: 2.0,
                colour,
            },
        ] {
            let posed = Posed::of(&item).expect("a shape");
            assert_eq!(posed.item(), item);
        }
    }
}
