//! Rasterises a [`Drawing`] on the CPU, with the anti-aliased scan conversion of tiny-skia.
//!
//! Guarantees: straight (not premultiplied) alpha; a transparent background has alpha 0; the same
//! drawing gives the same pixels, on any number of threads. Colours are blended as sRGB values, as
//! browsers blend SVG.

use glam::{DVec2, UVec2};
use image::RgbaImage;
use tiny_skia::{
    Color, FillRule, GradientStop, LineCap, LineJoin, LinearGradient, Path, PathBuilder, PixmapMut,
    PixmapPaint, PixmapRef, Point, PremultipliedColorU8, RadialGradient, SpreadMode, Stroke,
    Transform,
};

use crate::colour::{
    Gradient, GradientGeometry, GradientSpread, Paint, Rgb, StrokeJoin, StrokeStyle,
};

use super::drawing::{Drawing, DrawingItem};
use super::outline::{OutlinePath, PathCommand};

/// Rasterises a drawing.
pub fn rasterise(drawing: &Drawing) -> RgbaImage {
    let (width, height) = (drawing.size.width(), drawing.size.height());
    let mut image = RgbaImage::new(width, height);
    // tiny-skia rejects only empty or huge sizes, which a `PixelSize` cannot be.
    if let Some(mut canvas) = PixmapMut::from_bytes(&mut image, width, height) {
        if let Some(ground) = drawing.ground {
            canvas.fill(color(ground));
        }
        for item in &drawing.items {
            paint(item, &mut canvas);
        }
    }
    image.pixels_mut().for_each(make_straight);
    image
}

/// Paints one shape over the canvas.
fn paint(item: &DrawingItem, canvas: &mut PixmapMut<'_>) {
    match item {
        DrawingItem::Fill {
            outline,
            paint,
            gradient,
            ..
        } => {
            let shaded = gradient.as_ref().and_then(gradient_paint);
            let paint = shaded.unwrap_or_else(|| solid_paint(*paint));
            fill(path_of(outline), &paint, canvas);
        }
        DrawingItem::Stroke { outline, line } => draw_line(path_of(outline), line, canvas),
        DrawingItem::Bars {
            segments,
            width_px,
            colour,
        } => stroke(segments, *width_px, *colour, canvas),
        DrawingItem::Discs {
            centres,
            radius_px,
            colour,
        } => {
            for c in centres {
                let disc = path_of(&disc(*c, *radius_px));
                fill(disc, &solid_paint((*colour).into()), canvas);
            }
        }
        DrawingItem::Picture { image, corner } => picture(image, *corner, canvas),
    }
}

/// Returns a circle made of four cubic Bézier curves, with a radial error of at most 0.03 %. The
/// circle of tiny-skia consists of quadratic curves and is visibly too small, by an eighth of a
/// pixel.
fn disc(centre: DVec2, radius: f64) -> OutlinePath {
    /// Distance of the control points from the end points of a quarter of the unit circle, 4/3 (√2
    /// − 1) (derived: the curve then also touches the circle at the middle of the quadrant).
    const HANDLE: f64 = 0.552_284_749_830_793_4;
    let quarter = |i: u8| {
        let from = DVec2::from_angle(f64::from(i) * std::f64::consts::FRAC_PI_2);
        let to = from.perp();
        let at = |p: DVec2| centre + radius * p;
        PathCommand::Cubic(at(from + HANDLE * to), at(to + HANDLE * from), at(to))
    };
    let start = PathCommand::Move(centre + DVec2::new(radius, 0.0));
    let steps = std::iter::once(start).chain((0..4).map(quarter));
    OutlinePath {
        commands: steps.chain([PathCommand::Close]).collect(),
        ..OutlinePath::default()
    }
}

/// Fills a path by the nonzero rule.
fn fill(path: Option<Path>, paint: &tiny_skia::Paint, canvas: &mut PixmapMut<'_>) {
    if let Some(path) = path {
        let rule = FillRule::Winding;
        canvas.fill_path(&path, paint, rule, Transform::identity(), None);
    }
}

/// Strokes bars with round ends.
fn stroke(segments: &[[DVec2; 2]], width_px: f64, colour: Rgb, canvas: &mut PixmapMut<'_>) {
    let mut builder = PathBuilder::new();
    for [a, b] in segments {
        builder.move_to(a.x as f32, a.y as f32);
        builder.line_to(b.x as f32, b.y as f32);
    }
    let stroke = Stroke {
        width: width_px as f32,
        line_cap: LineCap::Round,
        ..Stroke::default()
    };
    // tiny-skia draws a hairline for width 0, but SVG draws nothing.
    if let Some(path) = builder.finish().filter(|_| width_px > 0.0) {
        canvas.stroke_path(
            &path,
            &solid_paint(colour.into()),
            &stroke,
            Transform::identity(),
            None,
        );
    }
}

/// Strokes closed outlines with their joins.
fn draw_line(path: Option<Path>, line: &StrokeStyle, canvas: &mut PixmapMut<'_>) {
    let stroke = Stroke {
        width: line.width as f32,
        line_join: match line.join {
            StrokeJoin::Mitre(_) => LineJoin::Miter,
            StrokeJoin::Round => LineJoin::Round,
            StrokeJoin::Bevel => LineJoin::Bevel,
        },
        miter_limit: match line.join {
            StrokeJoin::Mitre(limit) => limit as f32,
            StrokeJoin::Round | StrokeJoin::Bevel => 1.0,
        },
        ..Stroke::default()
    };
    if let Some(path) = path {
        let paint = solid_paint(line.paint);
        canvas.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
    }
}

/// Converts an outline to a path of tiny-skia; `None` if it is empty.
fn path_of(outline: &OutlinePath) -> Option<Path> {
    let mut builder = PathBuilder::new();
    let xy = |p: DVec2| (p.x as f32, p.y as f32);
    for step in &outline.commands {
        match *step {
            PathCommand::Move(p) => builder.move_to(xy(p).0, xy(p).1),
            PathCommand::Line(p) => builder.line_to(xy(p).0, xy(p).1),
            PathCommand::Quad(c, p) => builder.quad_to(xy(c).0, xy(c).1, xy(p).0, xy(p).1),
            PathCommand::Cubic(c, d, p) => {
                builder.cubic_to(xy(c).0, xy(c).1, xy(d).0, xy(d).1, xy(p).0, xy(p).1);
            }
            PathCommand::Close => builder.close(),
        }
    }
    builder.finish()
}

/// Paints a raster image with its upper left corner at the given pixel.
fn picture(image: &RgbaImage, corner: UVec2, canvas: &mut PixmapMut<'_>) {
    let (width, height) = image.dimensions();
    let premultiplied = premultiplied(image);
    // tiny-skia rejects only an image without pixels, and then there is nothing to show.
    if let Some(pixmap) = PixmapRef::from_bytes(&premultiplied, width, height) {
        let ([x, y], paint) = (corner.as_ivec2().to_array(), PixmapPaint::default());
        canvas.draw_pixmap(x, y, pixmap, &paint, Transform::identity(), None);
    }
}

fn premultiplied(image: &RgbaImage) -> Vec<u8> {
    let times_alpha = |pixel: &image::Rgba<u8>| {
        let [r, g, b, a] = pixel.0;
        let p = tiny_skia::ColorU8::from_rgba(r, g, b, a).premultiply();
        [p.red(), p.green(), p.blue(), p.alpha()]
    };
    image.pixels().flat_map(times_alpha).collect()
}

/// Converts a pixel from premultiplied to straight alpha.
pub(crate) fn make_straight(pixel: &mut image::Rgba<u8>) {
    let [r, g, b, a] = pixel.0;
    // Rounding on a GPU can leave a colour above its alpha, which tiny-skia rejects.
    let [r, g, b] = [r, g, b].map(|c| c.min(a));
    pixel.0 = match (a, PremultipliedColorU8::from_rgba(r, g, b, a)) {
        (0, _) | (_, None) => [0; 4],
        (255, _) => return,
        (_, Some(premultiplied)) => {
            let straight = premultiplied.demultiply();
            [straight.red(), straight.green(), straight.blue(), a]
        }
    };
}

/// Converts a gradient; `None` if tiny-skia rejects it as degenerate.
fn gradient_paint(gradient: &Gradient) -> Option<tiny_skia::Paint<'static>> {
    let stops = gradient.stops.iter().map(|stop| {
        let mut colour = color(stop.paint.colour);
        colour.set_alpha(stop.paint.opacity as f32);
        GradientStop::new(stop.offset as f32, colour)
    });
    let mode = match gradient.spread {
        GradientSpread::Pad => SpreadMode::Pad,
        GradientSpread::Reflect => SpreadMode::Reflect,
        GradientSpread::Repeat => SpreadMode::Repeat,
    };
    let [sx, ky, kx, sy, tx, ty] = gradient.frame.to_cols_array().map(|x| x as f32);
    let frame = Transform::from_row(sx, ky, kx, sy, tx, ty);
    let (stops, zero) = (stops.collect(), Point::zero());
    let shader = match gradient.geometry {
        GradientGeometry::Linear => {
            LinearGradient::new(zero, Point::from_xy(1.0, 0.0), stops, mode, frame)
        }
        GradientGeometry::Radial { focus, inner } => {
            let focus = Point::from_xy(focus.x as f32, focus.y as f32);
            RadialGradient::new(focus, inner as f32, zero, 1.0, stops, mode, frame)
        }
    };
    Some(tiny_skia::Paint {
        shader: shader?,
        anti_alias: true,
        ..tiny_skia::Paint::default()
    })
}

fn solid_paint(paint: Paint) -> tiny_skia::Paint<'static> {
    let mut plain = tiny_skia::Paint::default();
    let mut colour = color(paint.colour);
    colour.set_alpha(paint.opacity as f32);
    plain.set_color(colour);
    plain
}

fn color(Rgb([r, g, b]): Rgb) -> Color {
    Color::from_rgba8(r, g, b, 255)
}

/// Returns the channels of all pixels, row by row: red, green, blue and alpha, or without alpha if
/// `is_opaque`. The caller sets `is_opaque` only if all pixels are opaque.
pub(super) fn samples(image: &RgbaImage, is_opaque: bool) -> Vec<u8> {
    if !is_opaque {
        return image.as_raw().clone();
    }
    // Each pixel is copied as a chunk of three bytes. Copying byte by byte took as long as
    // rasterising.
    let mut samples = Vec::with_capacity(image.as_raw().len() / 4 * 3);
    for pixel in image.pixels() {
        samples.extend_from_slice(&pixel.0[..3]);
    }
    samples
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::PixelSize;

    fn painted(items: Vec<DrawingItem>, ground: Option<Rgb>) -> RgbaImage {
        let size = PixelSize::new(40, 40).expect("a legal size");
        rasterise(&Drawing {
            size,
            ground,
            items,
            ..Drawing::new(size, None)
        })
    }

    fn coverage(image: &RgbaImage) -> f64 {
        image.pixels().map(|p| f64::from(p.0[3]) / 255.0).sum()
    }

    const RED: Rgb = Rgb([200, 0, 0]);

    #[test]
    fn discs_and_bars_cover_their_areas() {
        let middle = DVec2::splat(20.3);
        let disc = DrawingItem::Discs {
            centres: vec![middle],
            radius_px: 7.2,
            colour: RED,
        };
        let area = std::f64::consts::PI * 7.2 * 7.2;
        assert!((coverage(&painted(vec![disc], None)) - area).abs() < 0.02 * area);
        let bar = DrawingItem::Bars {
            segments: vec![[DVec2::new(8.0, 20.0), DVec2::new(32.0, 20.0)]],
            width_px: 6.0,
            colour: RED,
        };
        let area = 24.0 * 6.0 + std::f64::consts::PI * 9.0;
        assert!((coverage(&painted(vec![bar], None)) - area).abs() < 0.02 * area);
        let nothing = DrawingItem::Bars {
            segments: vec![[DVec2::ZERO, DVec2::splat(40.0)]],
            width_px: 0.0,
            colour: RED,
        };
        assert_eq!(coverage(&painted(vec![nothing], None)), 0.0);
    }

    #[test]
    fn alpha_is_straight_and_backgrounds_are_exact() {
        let half = DrawingItem::Fill {
            outline: disc(DVec2::splat(20.0), 10.0),
            paint: RED.into(),
            gradient: None,
            label: None,
        };
        let image = painted(vec![half], None);
        let edges = image.pixels().filter(|p| (64..192).contains(&p.0[3]));
        assert!(edges.clone().count() > 10);
        assert!(edges.map(|p| p.0[0]).all(|r| r.abs_diff(200) <= 4));
        let plain = painted(vec![], Some(Rgb([1, 2, 3])));
        assert!(plain.pixels().all(|p| p.0 == [1, 2, 3, 255]));
    }

    #[test]
    fn straight_alpha_restores_the_colour() {
        let straight = |pixel: [u8; 4]| {
            let mut pixel = image::Rgba(pixel);
            make_straight(&mut pixel);
            pixel.0
        };
        assert_eq!(straight([50, 25, 0, 128]), [100, 50, 0, 128]);
        assert_eq!(straight([3, 0, 0, 0]), [0; 4]);
        assert_eq!(straight([130, 64, 0, 128]), [255, 128, 0, 128]);
        assert_eq!(straight([3, 4, 5, 255]), [3, 4, 5, 255]);
    }

    #[test]
    fn raster_images_are_copied_pixel_for_pixel() {
        let mut image = RgbaImage::from_pixel(20, 30, image::Rgba([0, 200, 0, 255]));
        image.put_pixel(19, 29, image::Rgba([0, 0, 0, 0]));
        let corner = UVec2::new(10, 4);
        let painted = painted(vec![DrawingItem::Picture { image, corner }], None);
        assert_eq!(painted.get_pixel(10, 4).0, [0, 200, 0, 255]);
        assert_eq!(painted.get_pixel(28, 33).0, [0, 200, 0, 255]);
        assert_eq!(painted.get_pixel(29, 33).0[3], 0);
        assert_eq!(painted.get_pixel(9, 20).0[3], 0);
        assert_eq!(painted.get_pixel(30, 20).0[3], 0);
    }

    #[test]
    fn shapes_far_outside_do_not_panic() {
        let far = DrawingItem::Bars {
            segments: vec![[DVec2::splat(-1e7), DVec2::new(1e7, 9e6)]],
            width_px: 3e6,
            colour: RED,
        };
        assert_eq!(painted(vec![far], None).dimensions(), (40, 40));
    }
}
