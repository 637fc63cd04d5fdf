//! Writes a vector animation as a Lottie animation (JSON): format 1.0 of the Lottie Animation
//! Community, in the form written by Bodymovin 5.7.
//!
//! Shapes are animated uniformly in t within a precomposition, whose time is remapped to that of
//! the film. Easing, pauses, stops and the way back therefore need no shape keyframes. Limits of
//! the format: repeating gradients are drawn once, and radial gradients that are not uniformly
//! scaled are drawn circular.

use serde_json::{Value, json};

use crate::colour::{Gradient, Paint, StrokeJoin};
use crate::geometry::DVec2;

use super::animation::VectorAnimation;
use super::shape::{PathVerb, PosedShape, ShapeForm};
use super::timeline::{FilmTimeline, TimelineCurve};
use super::tracks::{KeyedProperty, SceneLayer, layers};
use super::two_point_gradient::TwoPointGradient;

/// Number of uniform intervals of t at whose ends shape keyframes may lie (resource limit: bounds
/// the size of the file).
const KEYFRAME_INTERVALS: usize = 240;

/// Returns the Lottie animation with the given title, as JSON.
pub(super) fn lottie_json(animation: &VectorAnimation, title: &str) -> Value {
    let timeline = &animation.timeline;
    let frames = timeline.frames();
    let (width, height) = (animation.size.width(), animation.size.height());
    // The largest remapped time is the length of the precomposition. If it equals the number of
    // frames of the film, players take it for the end and show an earlier moment. The
    // precomposition is then made one frame longer; this happens only for a film of one frame.
    let length = if timeline.pass_frames == frames {
        frames + 1
    } else {
        timeline.pass_frames
    } as f64;
    let [from, to] = animation.time_range();
    let at = |t: f64| length * (t - from) / (to - from).max(f64::MIN_POSITIVE);
    let mut times: Vec<f64> = (0..=KEYFRAME_INTERVALS)
        .map(|k| k as f64 / KEYFRAME_INTERVALS as f64)
        .map(|s| from * (1.0 - s) + to * s)
        .chain(animation.pieces.iter().map(|piece| piece.from))
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let stations: Vec<(f64, f64)> = times.into_iter().map(|t| (at(t), t)).collect();
    let layers = layers(animation, &stations);
    let last = layers.len().saturating_sub(1);
    let scenes = layers.iter().enumerate().map(|(k, layer)| {
        // The first scene (consecutive animation pieces with the same shapes) begins at 0, and the
        // last one ends after the end of the film, so that rounding in a player never hides them.
        let from = if k == 0 { 0.0 } else { layer.from };
        let to = if k == last { length + 1.0 } else { layer.to };
        scene(layer, k, [from, to])
    });
    let film = json!({
        "ty": 0, "nm": title, "ind": 1, "refId": "film", "sr": 1, "ks": identity_transform(),
        "w": width, "h": height, "ip": 0, "op": frames, "st": 0, "bm": 0,
        "tm": time_remap(timeline, |t| at(t) / timeline.fps),
    });
    let ground = animation.ground.map(|ground| {
        json!({
            "ty": 1, "nm": "ground", "ind": 2, "sr": 1, "ks": identity_transform(), "sc": ground.to_string(),
            "sw": width, "sh": height, "ip": 0, "op": frames, "st": 0, "bm": 0,
        })
    });
    let film_on_ground: Vec<Value> = [Some(film), ground].into_iter().flatten().collect();
    json!({
        "v": "5.7.4", "nm": title, "fr": timeline.fps, "ip": 0, "op": frames,
        "w": width, "h": height, "ddd": 0,
        "assets": [{"id": "film", "nm": title, "fr": timeline.fps, "layers": scenes.collect::<Vec<_>>()}],
        "layers": film_on_ground,
    })
}

/// Returns the Lottie time remapping: for each frame of the film, the moment of the precomposition
/// that the frame shows, in seconds from the start of the precomposition.
fn time_remap(timeline: &FilmTimeline, secs_at: impl Fn(f64) -> f64) -> Value {
    let secs = |frame: usize| round_number(secs_at(timeline.times[frame]), 6);
    let key = |curve: TimelineCurve| {
        let [out, into] = curve.handles.map(|handle| round_number(handle, 5));
        json!({
            "t": curve.from, "s": [secs(curve.from)],
            "o": {"x": [0.33333], "y": [out]}, "i": {"x": [0.66667], "y": [into]},
        })
    };
    let mut keys: Vec<Value> = timeline.curves().into_iter().map(key).collect();
    let last = timeline.frames();
    keys.push(json!({"t": last, "s": [secs(last)]}));
    json!({"a": 1, "k": keys})
}

/// Returns the identity transform.
fn identity_transform() -> Value {
    let still = |value: Value| json!({"a": 0, "k": value});
    json!({
        "o": still(json!(100)), "r": still(json!(0)), "p": still(json!([0, 0, 0])),
        "a": still(json!([0, 0, 0])), "s": still(json!([100, 100, 100])),
    })
}

/// Returns the Lottie shape layer of one scene (consecutive animation pieces with the same shapes).
fn scene(layer: &SceneLayer, number: usize, [from, to]: [f64; 2]) -> Value {
    // Lottie lists the topmost shape first.
    let topmost_first = layer.shapes.iter().rev();
    let shapes: Vec<Value> = topmost_first.map(|poses| shape(layer, poses)).collect();
    json!({
        "ty": 4, "nm": format!("scene {}", number + 1), "ind": number + 1, "sr": 1,
        "ks": identity_transform(), "ip": round_number(from, 3), "op": round_number(to, 3), "st": 0, "bm": 0,
        "shapes": shapes,
    })
}

/// Returns the group of one shape: its paths, its fill or stroke, and its transform.
fn shape(layer: &SceneLayer, poses: &[PosedShape]) -> Value {
    let Some(first) = poses.first() else {
        return json!({"ty": "gr", "it": []});
    };
    let mut items = match &*first.form {
        ShapeForm::Fill { verbs, .. } | ShapeForm::Stroke { verbs, .. } => {
            outlines(layer, poses, verbs)
        }
        ShapeForm::Bars => (0..first.points.len() / 2)
            .map(|k| {
                outline(
                    layer,
                    poses,
                    2 * k,
                    &[PathVerb::Move, PathVerb::Line],
                    false,
                )
            })
            .collect(),
        ShapeForm::Discs => discs(layer, poses),
    };
    items.push(match &*first.form {
        ShapeForm::Fill { ramp: Some(_), .. } => gradient_fill(layer, poses),
        ShapeForm::Fill { .. } | ShapeForm::Discs => {
            let mut fill = colour_and_opacity(layer, poses);
            fill["ty"] = json!("fl");
            fill["r"] = json!(1);
            fill
        }
        ShapeForm::Stroke { join, .. } => stroke(layer, poses, *join, LineCap::Butt),
        ShapeForm::Bars => stroke(layer, poses, StrokeJoin::Round, LineCap::Round),
    });
    let mut still = identity_transform();
    still["ty"] = json!("tr");
    items.push(still);
    let mut group = json!({"ty": "gr", "it": items});
    if let ShapeForm::Fill {
        label: Some(words), ..
    } = &*first.form
    {
        group["nm"] = json!(words);
    }
    group
}

/// Cap at the ends of an open line. The values are those of Lottie's property `lc`.
#[derive(Clone, Copy)]
enum LineCap {
    Butt = 1,
    Round = 2,
}

/// Returns the stroke (`st`) of a shape, with its colour, opacity and width over time.
fn stroke(layer: &SceneLayer, poses: &[PosedShape], join: StrokeJoin, cap: LineCap) -> Value {
    let mut stroke = colour_and_opacity(layer, poses);
    stroke["ty"] = json!("st");
    let width = layer.width(poses, PosedShape::width);
    stroke["w"] = animated_property(&width, |w| vec![round_number(*w, 3)]);
    stroke["lc"] = json!(cap as u8);
    stroke["lj"] = json!(match join {
        StrokeJoin::Mitre(limit) => {
            stroke["ml"] = json!(limit);
            1
        }
        StrokeJoin::Round => 2,
        StrokeJoin::Bevel => 3,
    });
    stroke
}

/// Returns one path per contour of an outline.
fn outlines(layer: &SceneLayer, poses: &[PosedShape], verbs: &[PathVerb]) -> Vec<Value> {
    let mut first = 0;
    let rings = verbs.split_inclusive(|verb| *verb == PathVerb::Close);
    rings
        .map(|ring| {
            let path = outline(layer, poses, first, ring, true);
            first += ring.iter().map(|verb| verb.point_count()).sum::<usize>();
            path
        })
        .collect()
}

/// Returns the path of one contour. Its points are those of the shape from index `first` on, as
/// many as the commands `verbs` take.
fn outline(
    layer: &SceneLayer,
    poses: &[PosedShape],
    first: usize,
    verbs: &[PathVerb],
    closed: bool,
) -> Value {
    let count = verbs.iter().map(|verb| verb.point_count()).sum::<usize>();
    let range = first..first + count;
    let bezier = |posed: &PosedShape| bezier(verbs, &posed.points[range.clone()], closed);
    let keyed = layer.points(poses, range.clone(), bezier);
    let is_still = keyed.keys.len() == 1;
    let path = animated_property(&keyed, |bezier| vec![bezier.clone()]);
    let path = match path {
        Value::Object(mut path) if is_still => {
            // Lottie stores a constant path as an object, not as a list with one object.
            let still = path["k"][0].take();
            path.insert("k".to_owned(), still);
            Value::Object(path)
        }
        path => path,
    };
    json!({"ty": "sh", "ks": path})
}

/// Returns the vertices of a path, and the incoming and outgoing handle of each vertex relative to
/// the vertex.
fn bezier(verbs: &[PathVerb], points: &[DVec2], closed: bool) -> Value {
    let mut corners: Vec<[DVec2; 3]> = Vec::new();
    let mut rest = points;
    for verb in verbs {
        let (verb_points, after) = rest.split_at(verb.point_count());
        rest = after;
        let Some(&end) = verb_points.last() else {
            continue;
        };
        let start = corners.last().map_or(end, |corner| corner[0]);
        // Quadratic curves are converted to cubic curves, because Lottie has no others.
        let (out, into) = match *verb_points {
            [c, _] => ((c - start) * 2.0 / 3.0, (c - end) * 2.0 / 3.0),
            [c, d, _] => (c - start, d - end),
            _ => (DVec2::ZERO, DVec2::ZERO),
        };
        if let Some(corner) = corners.last_mut() {
            corner[2] = out;
        }
        corners.push([end, into, DVec2::ZERO]);
    }
    let part = |k: usize| -> Vec<Value> {
        let points = corners.iter().map(|corner| corner[k]);
        points
            .map(|p| json!([round_number(p.x, 2), round_number(p.y, 2)]))
            .collect()
    };
    json!({"v": part(0), "i": part(1), "o": part(2), "c": closed})
}

/// Returns one ellipse per disc.
fn discs(layer: &SceneLayer, poses: &[PosedShape]) -> Vec<Value> {
    let size = layer.width(poses, |posed| 2.0 * posed.width());
    let size = animated_property(&size, |d| vec![round_number(*d, 3), round_number(*d, 3)]);
    let disc = |k: usize| {
        let centre = layer.points(poses, k..k + 1, |posed| posed.points[k]);
        let centre = animated_property(&centre, |p| {
            vec![round_number(p.x, 2), round_number(p.y, 2)]
        });
        json!({"ty": "el", "d": 1, "p": centre, "s": size})
    };
    (0..poses[0].points.len()).map(disc).collect()
}

/// Returns the colour and the opacity of a shape as properties.
fn colour_and_opacity(layer: &SceneLayer, poses: &[PosedShape]) -> Value {
    let colour = layer.colour(poses, |posed| posed.paint());
    let opacity = layer.opacity(poses, |posed| posed.paint().opacity);
    json!({
        "c": animated_property(&colour, colour_of),
        "o": animated_property(&opacity, |share| vec![round_number(100.0 * share, 2)]),
    })
}

/// Returns the three colour channels, from 0 to 1, and alpha 1.
fn colour_of(paint: &Paint) -> Vec<Value> {
    let channels = paint
        .colour
        .0
        .map(|c| round_number(f64::from(c) / 255.0, 4));
    channels.into_iter().chain([json!(1)]).collect()
}

/// Returns the gradient fill of a shape.
fn gradient_fill(layer: &SceneLayer, poses: &[PosedShape]) -> Value {
    let gradient = |posed: &PosedShape| posed.gradient();
    let Some(first) = poses.first().and_then(gradient) else {
        return json!({});
    };
    let ends = |posed: &PosedShape| {
        posed
            .gradient()
            .map(|gradient| TwoPointGradient::of(&gradient))
    };
    let point = |which: fn(&TwoPointGradient) -> DVec2| {
        let of = move |posed: &PosedShape| ends(posed).map_or(DVec2::ZERO, |plain| which(&plain));
        let numbers = |posed: &PosedShape| of(posed).to_array().to_vec();
        let keyed = layer.keyed(poses, 0.2, numbers, of);
        animated_property(&keyed, |p| vec![round_number(p.x, 2), round_number(p.y, 2)])
    };
    let start = point(|plain| match *plain {
        TwoPointGradient::Linear { from, .. } => from,
        TwoPointGradient::Radial { middle, .. } => middle,
    });
    let end = point(|plain| match *plain {
        TwoPointGradient::Linear { to, .. } => to,
        TwoPointGradient::Radial { middle, radius, .. } => middle + DVec2::X * radius,
    });
    let stops = |posed: &PosedShape| posed.gradient().map(|g| stops(&g)).unwrap_or_default();
    let keyed = layer.keyed(poses, 0.004, stops, stops);
    let values = animated_property(&keyed, |stops| {
        stops.iter().map(|x| round_number(*x, 4)).collect()
    });
    let is_round = matches!(
        TwoPointGradient::of(&first),
        TwoPointGradient::Radial { .. }
    );
    json!({
        "ty": "gf", "t": if is_round { 2 } else { 1 }, "s": start, "e": end, "r": 1,
        "o": {"a": 0, "k": 100}, "g": {"p": first.stops.len(), "k": values},
        "h": {"a": 0, "k": 0}, "a": {"a": 0, "k": 0},
    })
}

/// Returns the stops of a gradient in the order of Lottie: all offsets with their colours, then all
/// offsets with their opacities.
fn stops(gradient: &Gradient) -> Vec<f64> {
    let colours = gradient.stops.iter().flat_map(|stop| {
        let [r, g, b] = stop.paint.colour.0.map(|c| f64::from(c) / 255.0);
        [stop.offset, r, g, b]
    });
    let opacities = gradient
        .stops
        .iter()
        .flat_map(|stop| [stop.offset, stop.paint.opacity]);
    colours.chain(opacities).collect()
}

/// Returns a property with a constant value, or with keyframes and linear interpolation.
fn animated_property<T>(keyed: &KeyedProperty<T>, value: impl Fn(&T) -> Vec<Value>) -> Value {
    if let [(_, only)] = keyed.keys.as_slice() {
        let mut numbers = value(only);
        let still = match numbers.len() {
            1 if !numbers[0].is_object() => numbers.remove(0),
            _ => Value::Array(numbers),
        };
        return json!({"a": 0, "k": still});
    }
    let last = keyed.keys.len().saturating_sub(1);
    let key = |(k, (x, at)): (usize, &(f64, T))| {
        let mut key = json!({"t": round_number(*x, 3), "s": value(at)});
        if k < last {
            key["o"] = json!({"x": [0], "y": [0]});
            key["i"] = json!({"x": [1], "y": [1]});
        }
        key
    };
    let keys: Vec<Value> = keyed.keys.iter().enumerate().map(key).collect();
    json!({"a": 1, "k": keys})
}

/// Rounds to the given number of decimals; whole numbers become integers.
fn round_number(x: f64, decimals: i32) -> Value {
    let scale = 10f64.powi(decimals);
    let x = (x * scale).round() / scale;
    if x.fract() == 0.0 && x.abs() < 1e15 {
        return json!(x as i64);
    }
    json!(x)
}
