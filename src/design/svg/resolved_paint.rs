//! Converts SVG paints: solid colours and gradients. Patterns are left to the painter.

use crate::colour::{Gradient, GradientGeometry, GradientSpread, GradientStop, Paint, Rgb};
use crate::geometry::{DAffine2, DMat2, DVec2};
use usvg::{BaseGradient, Color, Opacity, Pattern, SpreadMethod, Transform};

/// Converted paint of a fill or stroke.
pub(super) enum PaintSource<'t> {
    Solid(Paint),
    /// Gradient in the coordinates of the path, and its mean.
    Gradient(Gradient, Paint),
    /// Mean of a gradient that cannot be drawn, because its affine map is singular.
    DegenerateGradient(Paint),
    /// Pattern and its opacity.
    Pattern(&'t Pattern, Opacity),
}

/// Converts the paint of a fill or stroke; returns `None` if it is fully transparent.
pub(super) fn paint_source(paint: &usvg::Paint, opacity: Opacity) -> Option<PaintSource<'_>> {
    let factor = f64::from(opacity.get());
    let fade = |paint: Paint| Paint {
        opacity: factor * paint.opacity,
        ..paint
    };
    let gradient = match paint {
        usvg::Paint::Color(colour) => {
            let paint = fade(rgb(*colour).into());
            return (paint.opacity > 0.0).then_some(PaintSource::Solid(paint));
        }
        usvg::Paint::Pattern(pattern) => {
            return (factor > 0.0).then_some(PaintSource::Pattern(pattern, opacity));
        }
        usvg::Paint::LinearGradient(gradient) => {
            let from = point(gradient.x1(), gradient.y1());
            let along = point(gradient.x2(), gradient.y2()) - from;
            let frame =
                DAffine2::from_mat2_translation(DMat2::from_cols(along, along.perp()), from);
            convert_gradient(gradient, GradientGeometry::Linear, frame)
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
            convert_gradient(gradient, geometry, frame)
        }
    };
    let mean = fade(gradient.mean());
    let determinant = gradient.frame.matrix2.determinant();
    let is_drawable = determinant.is_finite() && determinant != 0.0;
    (mean.opacity > 0.0).then(|| match is_drawable {
        true => PaintSource::Gradient(gradient.map_paints(fade), mean),
        false => PaintSource::DegenerateGradient(mean),
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

/// Returns whether a path has a visible fill.
pub(super) fn is_filled(path: &usvg::Path) -> bool {
    let fill = path.fill().filter(|fill| fill.opacity().get() > 0.0);
    path.is_visible() && fill.is_some()
}
