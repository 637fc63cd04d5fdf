//! Converts SVG paints: solid colours, gradients, and patterns, which are replaced by their mean
//! colour.

use crate::colour::{Gradient, GradientGeometry, GradientSpread, GradientStop, Paint, Rgb};
use crate::geometry::{DAffine2, DMat2, DVec2};
use usvg::{BaseGradient, Color, Group, Node, Opacity, Pattern, SpreadMethod, Transform};

/// Converted paint of a fill or stroke.
pub(super) struct ResolvedPaint {
    /// Colour and opacity; for a gradient, its mean.
    pub paint: Paint,
    /// Gradient in the coordinates of the path; `None` for other paints.
    pub gradient: Option<Gradient>,
    /// Whether the paint is only the mean of a pattern or of a degenerate gradient.
    pub is_mean: bool,
}

/// Converts the paint of a fill or stroke; returns `None` if it is fully transparent.
pub(super) fn resolve_paint(paint: &usvg::Paint, opacity: Opacity) -> Option<ResolvedPaint> {
    let (mean, gradient, is_mean) = match paint {
        usvg::Paint::Color(colour) => (rgb(*colour).into(), None, false),
        usvg::Paint::LinearGradient(gradient) => {
            let from = point(gradient.x1(), gradient.y1());
            let along = point(gradient.x2(), gradient.y2()) - from;
            let frame =
                DAffine2::from_mat2_translation(DMat2::from_cols(along, along.perp()), from);
            let gradient = convert_gradient(gradient, GradientGeometry::Linear, frame);
            (gradient.mean(), Some(gradient), false)
        }
        usvg::Paint::RadialGradient(gradient) => {
            let radius = f64::from(gradient.r().get());
            let centre = point(gradient.cx(), gradient.cy());
            let focus = (point(gradient.fx(), gradient.fy()) - centre) / radius;
            let geometry = GradientGeometry::Radial {
                focus,
                inner: f64::from(gradient.fr().get()) / radius,
            };
            let frame = DAffine2::from_scale_angle_translation(DVec2::splat(radius), 0.0, centre);
            let gradient = convert_gradient(gradient, geometry, frame);
            (gradient.mean(), Some(gradient), false)
        }
        usvg::Paint::Pattern(pattern) => (pattern_mean(pattern)?, None, true),
    };
    let factor = f64::from(opacity.get());
    let fade = |paint: Paint| Paint {
        opacity: factor * paint.opacity,
        ..paint
    };
    let paint = fade(mean);
    // A gradient whose affine map `frame` is singular cannot be drawn and is replaced by its mean.
    let is_invertible = |gradient: &Gradient| {
        let determinant = gradient.frame.matrix2.determinant();
        determinant.is_finite() && determinant != 0.0
    };
    let is_mean = is_mean
        || gradient
            .as_ref()
            .is_some_and(|gradient| !is_invertible(gradient));
    let gradient = gradient.filter(is_invertible);
    (paint.opacity > 0.0).then(|| ResolvedPaint {
        paint,
        gradient: gradient.map(|gradient| gradient.map_paints(fade)),
        is_mean,
    })
}

/// Converts the colour stops, spread and transform of a gradient. `frame` maps the coordinates of
/// `geometry` to the gradient's own coordinates; the transform of the gradient is applied after it.
fn convert_gradient(
    gradient: &BaseGradient,
    geometry: GradientGeometry,
    frame: DAffine2,
) -> Gradient {
    let stop = |stop: &usvg::Stop| GradientStop {
        offset: stop.offset().get().into(),
        paint: Paint {
            colour: rgb(stop.color()),
            opacity: stop.opacity().get().into(),
        },
    };
    Gradient {
        geometry,
        frame: affine(gradient.transform()) * frame,
        stops: gradient.stops().iter().map(stop).collect(),
        spread: match gradient.spread_method() {
            SpreadMethod::Pad => GradientSpread::Pad,
            SpreadMethod::Reflect => GradientSpread::Reflect,
            SpreadMethod::Repeat => GradientSpread::Repeat,
        },
    }
}

fn point(x: f32, y: f32) -> DVec2 {
    DVec2::new(x.into(), y.into())
}

/// Converts a `usvg` transform to double precision.
pub(super) fn affine(t: Transform) -> DAffine2 {
    let columns = [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from);
    DAffine2::from_cols_array(&columns)
}

fn rgb(colour: Color) -> Rgb {
    Rgb([colour.red, colour.green, colour.blue])
}

/// Returns the mean paint of the filled shapes in a pattern, all with the same weight; `None` if
/// nothing is visible.
fn pattern_mean(pattern: &Pattern) -> Option<Paint> {
    let mut paints = Vec::new();
    collect_fills(pattern.root(), &mut paints);
    let paints = paints.into_iter().map(|paint| (paint, 1.0));
    Some(Paint::mean(paints)).filter(|paint| paint.opacity > 0.0)
}

/// Appends the paints of all fills in a group.
fn collect_fills(group: &Group, paints: &mut Vec<Paint>) {
    for node in group.children() {
        match node {
            Node::Group(inner) => collect_fills(inner, paints),
            Node::Path(path) => {
                let fill = path.fill().and_then(|fill| match fill.paint() {
                    // Nested patterns are ignored because they could recurse endlessly.
                    usvg::Paint::Pattern(_) => None,
                    paint => resolve_paint(paint, fill.opacity()),
                });
                paints.extend(fill.map(|tone| tone.paint));
            }
            Node::Image(_) | Node::Text(_) => {}
        }
    }
}
