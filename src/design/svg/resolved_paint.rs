//! What is filled or drawn with what: a paint, a gradient, and of patterns the mean.

use crate::colour::{Gradient, GradientGeometry, GradientSpread, GradientStop, Paint, Rgb};
use crate::geometry::{DAffine2, DMat2, DVec2};
use usvg::{BaseGradient, Color, Group, Node, Opacity, Pattern, SpreadMethod, Transform};

/// A paint; of a gradient, which goes with it, the mean.
pub(super) struct ResolvedPaint {
    pub paint: Paint,
    /// In the space of the path.
    pub gradient: Option<Gradient>,
    /// Whether more was drawn than this says.
    pub is_mean: bool,
}

/// What a fill or a stroke is painted with; none where nothing is seen of it.
pub(super) fn resolve_paint(paint: &usvg::Paint, opacity: Opacity) -> Option<ResolvedPaint> {
    let (mean, gradient, is_mean) = match paint {
        usvg::Paint::Color(colour) => (rgb(*colour).into(), None, false),
        usvg::Paint::LinearGradient(gradient) => {
            let [from, to] = [
                (gradient.x1(), gradient.y1()),
                (gradient.x2(), gradient.y2()),
            ];
            let along = point(to) - point(from);
            let frame =
                DAffine2::from_mat2_translation(DMat2::from_cols(along, along.perp()), point(from));
            let gradient = drawn(gradient, GradientGeometry::Straight, frame);
            (gradient.mean(), Some(gradient), false)
        }
        usvg::Paint::RadialGradient(gradient) => {
            let radius = f64::from(gradient.r().get());
            let centre = point((gradient.cx(), gradient.cy()));
            let focus = (point((gradient.fx(), gradient.fy())) - centre) / radius;
            let course = GradientGeometry::Round {
                focus,
                inner: f64::from(gradient.fr().get()) / radius,
            };
            let frame = DAffine2::from_scale_angle_translation(DVec2::splat(radius), 0.0, centre);
            let gradient = drawn(gradient, course, frame);
            (gradient.mean(), Some(gradient), false)
        }
        usvg::Paint::Pattern(pattern) => (of_pattern(pattern)?, None, true),
    };
    let covered = f64::from(opacity.get());
    let share = |paint: Paint| Paint {
        opacity: covered * paint.opacity,
        ..paint
    };
    let paint = share(mean);
    // What cannot be laid out is as wide as a line, and shows its mean.
    let is_laid_out = |gradient: &Gradient| {
        let determinant = gradient.frame.matrix2.determinant();
        determinant.is_finite() && determinant != 0.0
    };
    let is_mean = is_mean
        || gradient
            .as_ref()
            .is_some_and(|gradient| !is_laid_out(gradient));
    let gradient = gradient.filter(is_laid_out);
    (paint.opacity > 0.0).then(|| ResolvedPaint {
        paint,
        gradient: gradient.map(|gradient| gradient.repainted(share)),
        is_mean,
    })
}

/// A gradient of the drawing as one of ours.
fn drawn(gradient: &BaseGradient, course: GradientGeometry, frame: DAffine2) -> Gradient {
    let stop = |stop: &usvg::Stop| GradientStop {
        at: stop.offset().get().into(),
        paint: Paint {
            colour: rgb(stop.color()),
            opacity: stop.opacity().get().into(),
        },
    };
    Gradient {
        course,
        frame: affine(gradient.transform()) * frame,
        stops: gradient.stops().iter().map(stop).collect(),
        spread: match gradient.spread_method() {
            SpreadMethod::Pad => GradientSpread::Pad,
            SpreadMethod::Reflect => GradientSpread::Reflect,
            SpreadMethod::Repeat => GradientSpread::Repeat,
        },
    }
}

fn point((x, y): (f32, f32)) -> DVec2 {
    DVec2::new(x.into(), y.into())
}

/// A transform in double precision.
pub(super) fn affine(t: Transform) -> DAffine2 {
    let columns = [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from);
    DAffine2::from_cols_array(&columns)
}

fn rgb(colour: Color) -> Rgb {
    Rgb([colour.red, colour.green, colour.blue])
}

/// The mean of what is filled in a pattern, one shape as much as another.
fn of_pattern(pattern: &Pattern) -> Option<Paint> {
    let mut found = Vec::new();
    fills(pattern.root(), &mut found);
    let paints = found.into_iter().map(|paint| (paint, 1.0));
    Some(Paint::mean(paints)).filter(|paint| paint.opacity > 0.0)
}

fn fills(group: &Group, found: &mut Vec<Paint>) {
    for node in group.children() {
        match node {
            Node::Group(inner) => fills(inner, found),
            Node::Path(path) => {
                let fill = path.fill().and_then(|fill| match fill.paint() {
                    // A pattern in a pattern could go on without end.
                    usvg::Paint::Pattern(_) => None,
                    paint => resolve_paint(paint, fill.opacity()),
                });
                found.extend(fill.map(|tone| tone.paint));
            }
            Node::Image(_) | Node::Text(_) => {}
        }
    }
}
