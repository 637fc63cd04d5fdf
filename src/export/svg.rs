//! Writes a [`Drawing`] as a static SVG document.
//!
//! Guarantees: well-formed and self-contained (no fonts, style sheets or links); numbers have at
//! most three decimals; the same drawing gives the same bytes. Text is not preserved as text:
//! labels are outlines with an `aria-label`.

use std::fmt;

use glam::{DVec2, UVec2};
use image::codecs::png::PngEncoder;

use crate::colour::{
    Gradient, GradientGeometry, GradientSpread, GradientStop, Paint, Rgb, StrokeJoin, StrokeStyle,
};
use crate::io::escape::XmlEscaped;

use super::drawing::{Drawing, DrawingItem};
use super::labels::ShortNumber;
use super::outline::{OutlinePath, PathCommand};

/// Returns a drawing as an SVG document.
pub fn to_svg(drawing: &Drawing) -> String {
    let (width, height) = (drawing.size.width(), drawing.size.height());
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    if let Some(ground) = drawing.ground {
        svg += &format!("<rect width=\"{width}\" height=\"{height}\" fill=\"{ground}\"/>\n");
    }
    for (k, item) in drawing.items.iter().enumerate() {
        svg += &element(k, item);
        svg.push('\n');
    }
    svg + "</svg>\n"
}

/// Returns the SVG element of the shape with index `k`. If the shape has a gradient, the definition
/// of the gradient comes first, with the id `g{k}`.
fn element(k: usize, item: &DrawingItem) -> String {
    match item {
        DrawingItem::Fill {
            outline,
            paint,
            gradient: None,
            label,
        } => fill(outline, &fill_attributes(paint), label.as_deref()),
        DrawingItem::Fill {
            outline,
            gradient: Some(gradient),
            label,
            ..
        } => {
            let fill = fill(outline, &format!("fill=\"url(#g{k})\""), label.as_deref());
            format!("{}{fill}", gradient_definition(k, gradient))
        }
        DrawingItem::Stroke { outline, line } => drawn_line(outline, line),
        DrawingItem::Bars {
            segments,
            width_px,
            colour,
        } => format!(
            "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" d=\"{}\"/>",
            colour,
            ShortNumber(*width_px),
            segments
                .iter()
                .map(|[a, b]| format!("M{}L{}", SvgPoint(*a), SvgPoint(*b)))
                .collect::<String>()
        ),
        DrawingItem::Discs {
            centres,
            radius_px,
            colour,
        } => discs(centres, *radius_px, *colour),
        DrawingItem::Picture { image, corner } => picture(image, *corner),
    }
}

/// Returns a filled path with the given fill attributes and an optional label for screen readers.
fn fill(outline: &OutlinePath, ink: &str, label: Option<&str>) -> String {
    let label = label.map_or_else(String::new, |words| {
        format!(" role=\"img\" aria-label=\"{}\"", XmlEscaped(words))
    });
    let steps: String = outline.commands.iter().map(step).collect();
    format!("<path{label} {ink} d=\"{steps}\"/>")
}

/// Returns the fill attributes of a plain paint.
fn fill_attributes(paint: &Paint) -> String {
    match paint.is_opaque() {
        true => format!("fill=\"{}\"", paint.colour),
        false => format!(
            "fill=\"{}\" fill-opacity=\"{}\"",
            paint.colour,
            ShortNumber(paint.opacity)
        ),
    }
}

/// Returns the definition of a gradient with the id `g{k}`.
fn gradient_definition(k: usize, gradient: &Gradient) -> String {
    let stop = |stop: &GradientStop| {
        let Paint { colour, opacity } = stop.paint;
        let opacity = match stop.paint.is_opaque() {
            true => String::new(),
            false => format!(" stop-opacity=\"{}\"", ShortNumber(opacity)),
        };
        let at = ShortNumber(100.0 * stop.offset);
        format!("<stop offset=\"{at}%\" stop-color=\"{colour}\"{opacity}/>")
    };
    let stops: String = gradient.stops.iter().map(stop).collect();
    let (kind, geometry) = match gradient.geometry {
        GradientGeometry::Linear => ("linear", "x1=\"0\" y1=\"0\" x2=\"1\" y2=\"0\"".to_owned()),
        GradientGeometry::Radial { focus, inner } => {
            let geometry = format!(
                "cx=\"0\" cy=\"0\" r=\"1\" fx=\"{}\" fy=\"{}\" fr=\"{}\"",
                ShortNumber(focus.x),
                ShortNumber(focus.y),
                ShortNumber(inner)
            );
            ("radial", geometry)
        }
    };
    let spread = match gradient.spread {
        GradientSpread::Pad => "",
        GradientSpread::Reflect => " spreadMethod=\"reflect\"",
        GradientSpread::Repeat => " spreadMethod=\"repeat\"",
    };
    let frame = gradient
        .frame
        .to_cols_array()
        .map(|x| ShortNumber(x).to_string())
        .join(" ");
    format!(
        "<{kind}Gradient id=\"g{k}\" gradientUnits=\"userSpaceOnUse\" {geometry}{spread} gradientTransform=\"matrix({frame})\">{stops}</{kind}Gradient>"
    )
}

/// Returns a path with a stroke and no fill.
fn drawn_line(outline: &OutlinePath, line: &StrokeStyle) -> String {
    let StrokeStyle {
        paint, width, join, ..
    } = line;
    let join = match join {
        StrokeJoin::Mitre(limit) => format!("miter\" stroke-miterlimit=\"{}", ShortNumber(*limit)),
        StrokeJoin::Round => "round".to_owned(),
        StrokeJoin::Bevel => "bevel".to_owned(),
    };
    let opacity = match paint.is_opaque() {
        true => String::new(),
        false => format!(" stroke-opacity=\"{}\"", ShortNumber(paint.opacity)),
    };
    let steps: String = outline.commands.iter().map(step).collect();
    format!(
        "<path fill=\"none\" stroke=\"{}\"{opacity} stroke-width=\"{}\" stroke-linejoin=\"{join}\" d=\"{steps}\"/>",
        paint.colour,
        ShortNumber(*width)
    )
}

/// Returns the SVG path data of one path command.
fn step(step: &PathCommand) -> String {
    match *step {
        PathCommand::Move(p) => format!("M{}", SvgPoint(p)),
        PathCommand::Line(p) => format!("L{}", SvgPoint(p)),
        PathCommand::Quad(c, p) => format!("Q{} {}", SvgPoint(c), SvgPoint(p)),
        PathCommand::Cubic(c, d, p) => format!("C{} {} {}", SvgPoint(c), SvgPoint(d), SvgPoint(p)),
        PathCommand::Close => "Z".to_owned(),
    }
}

/// Returns a group of filled circles.
fn discs(centres: &[DVec2], radius_px: f64, colour: Rgb) -> String {
    let circle = |c: &DVec2| {
        format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>",
            ShortNumber(c.x),
            ShortNumber(c.y),
            ShortNumber(radius_px)
        )
    };
    let circles: String = centres.iter().map(circle).collect();
    format!("<g fill=\"{}\">{circles}</g>", colour)
}

/// Returns an image element with embedded pixels.
fn picture(image: &image::RgbaImage, UVec2 { x, y }: UVec2) -> String {
    let mut png = Vec::new();
    // The pixels are embedded as a data URL, so that the document needs no other files.
    let encoded = image.write_with_encoder(PngEncoder::new(&mut png));
    if encoded.is_err() {
        return String::new(); // encoding fails only for an image without pixels
    }
    let (width, height) = image.dimensions();
    format!(
        "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" href=\"data:image/png;base64,{}\"/>",
        base64(&png)
    )
}

/// Encodes bytes in Base64 with padding (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    /// Digits of the standard alphabet (RFC 4648, table 1).
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let octets = [0, 1, 2].map(|i| chunk.get(i).copied().map_or(0, u32::from));
        let bits = octets[0] << 16 | octets[1] << 8 | octets[2];
        for digit in 0..4 {
            let index = (bits >> (18 - 6 * digit)) & 63;
            let is_padding = digit > chunk.len();
            text.push(if is_padding {
                '='
            } else {
                char::from(DIGITS[index as usize])
            });
        }
    }
    text
}

/// Displays the coordinates of a point, separated by a space.
struct SvgPoint(DVec2);

impl fmt::Display for SvgPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", ShortNumber(self.0.x), ShortNumber(self.0.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::{PixelSize, PlaneView, rasterise};
    use crate::geometry::Bounds;
    use crate::transition::{TransitionStyle, VectorFigure};
    use tiny_skia::{FillRule, Paint, Pixmap};

    #[test]
    fn base64_matches_the_test_vectors_of_the_rfc() {
        let pairs = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (plain, coded) in pairs {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn hostile_labels_are_escaped() {
        let mut drawing = Drawing::new(PixelSize::new(9, 9).expect("a legal size"), None);
        let black = Rgb([0; 3]);
        drawing.push_label("\"/><x>&\u{1}\n", DVec2::ZERO, 4.0, black);
        let svg = to_svg(&drawing);
        assert!(svg.contains("aria-label=\"&quot;/&gt;&lt;x&gt;&amp;\u{fffd} \""));
        assert!(!svg.contains("<x>"));
    }

    /// Parses the SVG with usvg, an independent parser, and paints its paths.
    fn painted_by_usvg(svg: &str) -> image::RgbaImage {
        let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).expect("well-formed");
        let size = tree.size().to_int_size();
        let mut pixmap = Pixmap::new(size.width(), size.height()).expect("a legal size");
        paint_group(tree.root(), &mut pixmap);
        let pixels = pixmap.take_demultiplied();
        image::RgbaImage::from_vec(size.width(), size.height(), pixels).expect("all pixels")
    }

    fn paint_group(group: &usvg::Group, pixmap: &mut Pixmap) {
        for node in group.children() {
            match node {
                usvg::Node::Group(group) => paint_group(group, pixmap),
                usvg::Node::Path(path) => paint_path(path, pixmap),
                other => panic!("unexpected node: {other:?}"),
            }
        }
    }

    fn paint_path(path: &usvg::Path, pixmap: &mut Pixmap) {
        let place = path.abs_transform();
        let solid = |paint: &usvg::Paint| match paint {
            usvg::Paint::Color(c) => {
                let mut solid = Paint::default();
                solid.set_color_rgba8(c.red, c.green, c.blue, 255);
                solid
            }
            other => panic!("unexpected paint: {other:?}"),
        };
        if let Some(fill) = path.fill() {
            assert_eq!(fill.rule(), usvg::FillRule::NonZero);
            let paint = solid(fill.paint());
            pixmap.fill_path(path.data(), &paint, FillRule::Winding, place, None);
        }
        if let Some(stroke) = path.stroke() {
            assert_eq!(stroke.linecap(), usvg::LineCap::Round);
            let (paint, stroke) = (solid(stroke.paint()), stroke.to_tiny_skia());
            pixmap.stroke_path(path.data(), &paint, &stroke, place, None);
        }
    }

    /// Returns a drawing with a square that has a square hole, two bars with joints, and text.
    fn everything(ground: Option<Rgb>) -> Drawing {
        let ring = |a: f64, b: f64| vec![[a, a], [b, a], [b, b], [a, b]];
        let hole: Vec<_> = ring(2.0, 4.0).into_iter().rev().collect();
        let points = |ring: Vec<[f64; 2]>| ring.into_iter().map(DVec2::from_array).collect();
        let corner = DVec2::new(6.0, 1.0);
        let figure = VectorFigure {
            rings: vec![points(ring(1.0, 5.0)), points(hole)],
            bars: vec![
                [corner, DVec2::new(9.0, 5.0)],
                [corner, DVec2::new(9.5, 1.25)],
            ],
            bar_width: 0.4,
            ..VectorFigure::default()
        };
        let bounds = Bounds {
            min: DVec2::ZERO,
            max: DVec2::new(10.0, 6.0),
        };
        let view = PlaneView::fit(bounds, PixelSize::new(200, 120).expect("a legal size"));
        let mut drawing = Drawing::new(view.size(), ground);
        let style = TransitionStyle {
            source: Rgb([59, 125, 216]),
            ..TransitionStyle::default()
        };
        drawing.push_figure(&figure, 0.0, &style, &view);
        let black = Rgb([0; 3]);
        drawing.push_label("t = 0.25", DVec2::new(150.0, 20.0), 16.0, black);
        drawing
    }

    /// Premultiplies a pixel. Tests compare premultiplied colours, because the straight colour of a
    /// barely covered pixel is arbitrary.
    fn seen(pixel: &image::Rgba<u8>) -> [u8; 4] {
        let [r, g, b, a] = pixel.0;
        let times_alpha = |c: u8| (u16::from(c) * u16::from(a) / 255) as u8;
        [times_alpha(r), times_alpha(g), times_alpha(b), a]
    }

    #[test]
    fn svg_and_raster_agree() {
        for ground in [None, Some(Rgb([250, 248, 240]))] {
            let drawing = everything(ground);
            let painted = rasterise(&drawing);
            let read_back = painted_by_usvg(&to_svg(&drawing));
            assert_eq!(painted.dimensions(), read_back.dimensions());
            let differs = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| {
                seen(a).iter().zip(seen(b)).any(|(a, b)| a.abs_diff(b) > 20)
            };
            let different = painted
                .pixels()
                .zip(read_back.pixels())
                .filter(|&p| differs(p));
            assert_eq!(different.count(), 0, "ground {ground:?}");
        }
    }

    #[test]
    fn a_solid_covers_its_area_except_for_its_hole() {
        let image = rasterise(&everything(None));
        let left_half = image.enumerate_pixels().filter(|(x, ..)| *x < 110);
        let covered: f64 = left_half.map(|(_, _, p)| f64::from(p.0[3]) / 255.0).sum();
        let exact = (16.0 - 4.0) * 20.0 * 20.0;
        assert!((covered - exact).abs() < 1.0, "{covered} of {exact}");
        assert_eq!(image.get_pixel(60, 60).0[3], 0, "the hole is open");
        assert_eq!(image.get_pixel(30, 110).0[3], 0, "below the square");
        assert_eq!(
            image.get_pixel(30, 90).0,
            [59, 125, 216, 255],
            "y points up"
        );
    }
}
