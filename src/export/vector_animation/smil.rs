//! Writes a vector animation as an animated SVG, with the `<animate>` elements of SVG 1.1, section
//! 19.
//!
//! Guarantees: self-contained and well-formed; linear interpolation between the fewest keyframes
//! that meet [`VectorAnimation::TOLERANCE_PX`]; a reader without animation support shows the first
//! frame. Radial gradients that are not uniformly scaled are drawn circular.

use crate::colour::{Gradient, GradientSpread, Rgb, StrokeJoin};
use crate::geometry::DVec2;
use crate::io::escape::XmlEscaped;

use super::super::labels::ShortNumber;
use super::animation::VectorAnimation;
use super::shape::{PathVerb, PosedShape, ShapeForm};
use super::tracks::{KeyedProperty, SceneLayer, layers};
use super::two_point_gradient::TwoPointGradient;

/// Number of equal steps of the film's duration to which times are rounded (tolerance: in a film of
/// a few hundred frames, one frame still takes several hundred steps).
const TIME_STEPS: f64 = 1e5;

/// Step to which coordinates are rounded, in pixels (tolerance: a twentieth of
/// [`VectorAnimation::TOLERANCE_PX`]).
const STEP_PX: f64 = 0.01;

/// Returns the animation as an animated SVG document.
pub(super) fn animated_svg(animation: &VectorAnimation) -> String {
    let (width, height) = (animation.size.width(), animation.size.height());
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    if let Some(ground) = animation.ground {
        svg += &format!("<rect width=\"{width}\" height=\"{height}\" fill=\"{ground}\"/>\n");
    }
    let timeline = &animation.timeline;
    let numbered = timeline.times.iter().enumerate();
    let stations: Vec<(f64, f64)> = numbered.map(|(k, &t)| (k as f64, t)).collect();
    let clock = SmilClock {
        frames: timeline.frames() as f64,
        secs: timeline.secs(),
        repeats: timeline.repeats,
    };
    let layers = layers(animation, &stations);
    for (k, layer) in layers.iter().enumerate() {
        let shapes = layer.shapes.iter().enumerate();
        let ids = |j: usize| format!("g{k}-{j}");
        let body: String = shapes
            .map(|(j, poses)| clock.shape(layer, poses, &ids(j)))
            .collect();
        if layers.len() == 1 {
            svg += &body;
        } else {
            let is_last = k + 1 == layers.len();
            svg += &clock.visible_group(layer, is_last, &body);
        }
    }
    svg + "</svg>\n"
}

/// Number of frames and duration of the film. The methods write SVG elements that are animated over
/// this time.
struct SmilClock {
    /// Number of frames of the film.
    frames: f64,
    /// Duration of the film in seconds.
    secs: f64,
    repeats: bool,
}

impl SmilClock {
    /// Returns an `<animate>` element for one attribute. `keys` are pairs of a frame number and a
    /// value. If `discrete`, the value jumps at each key instead of being interpolated.
    fn animate(&self, attribute: &str, keys: &[(f64, String)], discrete: bool) -> String {
        let mut times = String::new();
        let mut values = String::new();
        // SVG requires a key at time 0 and, for interpolation, at time 1. If there is none, the
        // first or the last value is repeated there.
        let ends = [(0.0, keys.first()), (self.frames, keys.last())];
        let before = ends[0].1.filter(|key| key.0 > 0.0).map(|key| (0.0, &key.1));
        let last = ends[1].1.filter(|key| key.0 < self.frames && !discrete);
        let after = last.map(|key| (self.frames, &key.1));
        let inner_keys = keys.iter().map(|(x, value)| (*x, value));
        for (k, (x, value)) in before
            .into_iter()
            .chain(inner_keys)
            .chain(after)
            .enumerate()
        {
            let between = if k > 0 { ";" } else { "" };
            let share = (x / self.frames * TIME_STEPS).round() / TIME_STEPS;
            times += &format!("{between}{share}");
            values += between;
            values += value;
        }
        let mode = if discrete {
            " calcMode=\"discrete\""
        } else {
            ""
        };
        let ending = if self.repeats {
            "repeatCount=\"indefinite\""
        } else {
            "fill=\"freeze\""
        };
        let secs = ShortNumber(self.secs);
        format!(
            "<animate attributeName=\"{attribute}\"{mode} dur=\"{secs}s\" {ending} keyTimes=\"{times}\" values=\"{values}\"/>"
        )
    }

    /// Returns an attribute with its first value, and the element that animates the attribute. The
    /// element is empty if the value is constant.
    fn attribute<T>(
        &self,
        name: &str,
        keyed: &KeyedProperty<T>,
        text: impl Fn(&T) -> String,
    ) -> (String, String) {
        let keys: Vec<(f64, String)> = (keyed.keys.iter())
            .map(|(x, value)| (*x, text(value)))
            .collect();
        let still = keys.first().map_or("", |key| key.1.as_str());
        let moving = match keys.len() {
            0 | 1 => String::new(),
            _ => self.animate(name, &keys, false),
        };
        (format!(" {name}=\"{still}\""), moving)
    }

    /// Returns a group with the content `body` that is visible only during the period of `layer`.
    fn visible_group(&self, layer: &SceneLayer, is_last: bool, body: &str) -> String {
        let display = |yes: bool| if yes { "inline" } else { "none" }.to_owned();
        let is_first = layer.from <= 0.0;
        let mut keys = vec![(0.0, display(is_first))];
        if !is_first {
            keys.push((layer.from, display(true)));
        }
        if !is_last {
            keys.push((layer.to, display(false)));
        }
        let still = display(is_first);
        let moving = self.animate("display", &keys, true);
        format!("<g display=\"{still}\">{moving}\n{body}</g>\n")
    }

    /// Returns the path element of a shape, including its animations and the definition of its
    /// gradient. `id` identifies the gradient.
    fn shape(&self, layer: &SceneLayer, poses: &[PosedShape], id: &str) -> String {
        let Some(first) = poses.first() else {
            return String::new();
        };
        let all = 0..first.points.len();
        let path = layer.points(poses, all, path);
        let mut parts = vec![self.attribute("d", &path, Clone::clone)];
        let paint_attribute = if matches!(*first.form, ShapeForm::Fill { .. }) {
            "fill"
        } else {
            "stroke"
        };
        let mut before = String::new();
        if first.gradient().is_some() {
            before = self.gradient(layer, poses, id);
            parts.push((format!(" fill=\"url(#{id})\""), String::new()));
        } else {
            let colour = layer.colour(poses, |posed| posed.paint().colour);
            parts.push(self.attribute(paint_attribute, &colour, Rgb::to_string));
            let opacity = layer.opacity(poses, |posed| posed.paint().opacity);
            let is_opaque = opacity.keys.iter().all(|key| key.1 >= 1.0);
            if !is_opaque {
                let name = format!("{paint_attribute}-opacity");
                parts.push(self.attribute(&name, &opacity, number));
            }
        }
        if paint_attribute == "stroke" {
            let is_disc = *first.form == ShapeForm::Discs;
            let times = if is_disc { 2.0 } else { 1.0 };
            let width = layer.width(poses, |posed| times * posed.width());
            parts.push(self.attribute("stroke-width", &width, number));
            parts.push((stroke_attributes(&first.form), String::new()));
        }
        let (attributes, moving): (String, String) = parts.into_iter().unzip();
        let label = match &*first.form {
            ShapeForm::Fill {
                label: Some(words), ..
            } => format!(" role=\"img\" aria-label=\"{}\"", XmlEscaped(words)),
            _ => String::new(),
        };
        if moving.is_empty() {
            return format!("{before}<path{label}{attributes}/>\n");
        }
        format!("{before}<path{label}{attributes}>{moving}</path>\n")
    }

    /// Returns the definition of a gradient with its animations.
    fn gradient(&self, layer: &SceneLayer, poses: &[PosedShape], id: &str) -> String {
        let Some(first) = poses.first().and_then(PosedShape::gradient) else {
            return String::new();
        };
        let part = |name: &str, value: &dyn Fn(&Gradient) -> f64, tolerance: f64| {
            let of = |posed: &PosedShape| posed.gradient().as_ref().map_or(0.0, value);
            let keyed = layer.keyed(poses, tolerance, |posed| vec![of(posed)], of);
            self.attribute(name, &keyed, number)
        };
        let coordinates: &[(&str, GradientCoordinate)] = match TwoPointGradient::of(&first) {
            TwoPointGradient::Linear { .. } => &LINEAR_ATTRIBUTES,
            TwoPointGradient::Radial { .. } => &RADIAL_ATTRIBUTES,
        };
        let geometry = coordinates.iter().map(|(name, value)| {
            let value = |gradient: &Gradient| value(&TwoPointGradient::of(gradient));
            part(name, &value, 0.2)
        });
        let (geometry, mut moving): (String, String) = geometry.unzip();
        for k in 0..first.stops.len() {
            let at = part("offset", &|g| g.stops[k].offset, 0.002);
            let colour = |posed: &PosedShape| {
                let gradient = posed.gradient();
                gradient.map_or(Rgb([0; 3]), |g| g.stops[k].paint.colour)
            };
            let numbers = |posed: &PosedShape| colour(posed).0.map(f64::from).to_vec();
            let keyed = layer.keyed(poses, 1.0, numbers, colour);
            let colour = self.attribute("stop-color", &keyed, Rgb::to_string);
            let opacity = part("stop-opacity", &|g| g.stops[k].paint.opacity, 0.004);
            moving += &format!(
                "<stop{}{}{}>{}{}{}</stop>",
                at.0, colour.0, opacity.0, at.1, colour.1, opacity.1
            );
        }
        let kind = match TwoPointGradient::of(&first) {
            TwoPointGradient::Linear { .. } => "linear",
            TwoPointGradient::Radial { .. } => "radial",
        };
        let spread = match first.spread {
            GradientSpread::Pad => "",
            GradientSpread::Reflect => " spreadMethod=\"reflect\"",
            GradientSpread::Repeat => " spreadMethod=\"repeat\"",
        };
        format!(
            "<{kind}Gradient id=\"{id}\" gradientUnits=\"userSpaceOnUse\"{spread}{geometry}>{moving}</{kind}Gradient>"
        )
    }
}

/// Function that returns a coordinate or a radius of a gradient.
type GradientCoordinate = fn(&TwoPointGradient) -> f64;

/// SVG attributes of a linear gradient, with the functions that return their values.
const LINEAR_ATTRIBUTES: [(&str, GradientCoordinate); 4] = [
    ("x1", |gradient| linear_coordinates(gradient)[0]),
    ("y1", |gradient| linear_coordinates(gradient)[1]),
    ("x2", |gradient| linear_coordinates(gradient)[2]),
    ("y2", |gradient| linear_coordinates(gradient)[3]),
];

/// SVG attributes of a radial gradient, with the functions that return their values.
const RADIAL_ATTRIBUTES: [(&str, GradientCoordinate); 6] = [
    ("cx", |gradient| radial_coordinates(gradient)[0]),
    ("cy", |gradient| radial_coordinates(gradient)[1]),
    ("r", |gradient| radial_coordinates(gradient)[2]),
    ("fx", |gradient| radial_coordinates(gradient)[3]),
    ("fy", |gradient| radial_coordinates(gradient)[4]),
    ("fr", |gradient| radial_coordinates(gradient)[5]),
];

/// Returns the coordinates of the start and the end of a linear gradient.
fn linear_coordinates(gradient: &TwoPointGradient) -> [f64; 4] {
    match *gradient {
        TwoPointGradient::Linear { from, to } => [from.x, from.y, to.x, to.y],
        TwoPointGradient::Radial { .. } => [0.0; 4],
    }
}

/// Returns centre, radius, focus and inner radius of a radial gradient.
fn radial_coordinates(gradient: &TwoPointGradient) -> [f64; 6] {
    match *gradient {
        TwoPointGradient::Linear { .. } => [0.0; 6],
        TwoPointGradient::Radial {
            middle,
            radius,
            focus,
            inner,
        } => [middle.x, middle.y, radius, focus.x, focus.y, inner],
    }
}

fn number(x: &f64) -> String {
    ShortNumber(*x).to_string()
}

/// Returns the path data of a shape, with relative commands.
fn path(posed: &PosedShape) -> String {
    let verbs = match &*posed.form {
        ShapeForm::Fill { verbs, .. } | ShapeForm::Stroke { verbs, .. } => verbs.clone(),
        ShapeForm::Bars => [PathVerb::Move, PathVerb::Line].repeat(posed.points.len() / 2),
        // A zero-length line with round caps draws a disc.
        ShapeForm::Discs => [PathVerb::Move, PathVerb::Close].repeat(posed.points.len()),
    };
    let mut rest = posed.points.as_slice();
    let mut text = String::new();
    // Coordinates are differences between rounded positions, which are short to write. Rounding
    // errors do not accumulate, because the positions themselves are rounded.
    let mut at = DVec2::ZERO;
    let mut start = at;
    for verb in verbs {
        let (verb_points, after) = rest.split_at(verb.point_count());
        rest = after;
        text.push(match verb {
            PathVerb::Move => 'm',
            PathVerb::Line => 'l',
            PathVerb::Quad => 'q',
            PathVerb::Cubic => 'c',
            PathVerb::Close => 'z',
        });
        let mut end = at;
        for (k, p) in verb_points.iter().enumerate() {
            end = (p / STEP_PX).round() * STEP_PX;
            text += &pair(end - at, k > 0);
        }
        at = end;
        match verb {
            PathVerb::Move => start = at,
            // After closing, relative commands continue from the start of the contour.
            PathVerb::Close => at = start,
            _ => {}
        }
    }
    text
}

/// Formats two numbers. A space is written between them, and before them if `is_next`, unless a
/// minus sign already separates them.
fn pair(p: DVec2, is_next: bool) -> String {
    let [x, y] = [p.x, p.y].map(|x| ShortNumber(x).to_string());
    let between = |text: &str| if text.starts_with('-') { "" } else { " " };
    let before = if is_next { between(&x) } else { "" };
    format!("{before}{x}{}{y}", between(&y))
}

/// Returns the constant stroke attributes of a shape.
fn stroke_attributes(form: &ShapeForm) -> String {
    let join = match form {
        ShapeForm::Stroke { join, .. } => match join {
            StrokeJoin::Mitre(limit) => {
                format!(
                    " stroke-linejoin=\"miter\" stroke-miterlimit=\"{}\"",
                    ShortNumber(*limit)
                )
            }
            StrokeJoin::Round => " stroke-linejoin=\"round\"".to_owned(),
            StrokeJoin::Bevel => " stroke-linejoin=\"bevel\"".to_owned(),
        },
        _ => " stroke-linecap=\"round\"".to_owned(),
    };
    format!(" fill=\"none\"{join}")
}
