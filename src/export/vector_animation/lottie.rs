//! Writes a vector animation as a Lottie animation (JSON): format 1.0 of the Lottie Animation
//! Community, in the form written by Bodymovin 5.7.
//!
//! Shapes are animated within a precomposition that has one frame for each t that the film shows.
//! Its time is remapped to that of the film, so that pauses and the way back need no shape
//! keyframes. Limits of the format: repeating gradients are drawn once, and radial gradients that
//! are not uniformly scaled are drawn circular.
//!
//! Plays in lottie-web, rlottie and ThorVG, with the same pictures (`tests/motion`). rlottie shows
//! the precomposition at whole frames only, and each frame of the film is one of these.

mod format;
#[cfg(test)]
mod key_order;

use serde_json::Number;

use crate::colour::{Gradient, Rgb, StrokeJoin};
use crate::geometry::DVec2;

use super::super::size::PixelSize;
use super::animation::VectorAnimation;
use super::shape::{GradientForm, PathVerb, PosedShape, ShapeForm};
use super::timeline::FilmTimeline;
use super::tracks::{KeyedProperty, SceneLayer, layers};
use super::two_point_gradient::TwoPointGradient;
use format::{
    LayerContent, LottieColours, LottieComposition, LottieDocument, LottieHandle, LottieKeyframe,
    LottieLayer, LottiePath, LottieProperty, LottieShape, LottieTransform, LottieValue,
    round_number,
};

/// Maximum number of frames at which shape keyframes may lie (resource limit: bounds the size of
/// the file). Longer films have keyframes at every second frame, every third and so on.
const MAX_KEYED_FRAMES: usize = 480;

/// Delay of the remapped time, in frames (tolerance: players that round times down to whole frames
/// compute with 32 bits and must not show the frame before; no movement in this time is visible).
const FRAME_TOLERANCE: f64 = 0.01;

/// Identifier of the composition with the scenes of the film.
const FILM_ID: &str = "film";

/// Returns the Lottie animation with the given title, as JSON.
pub(super) fn lottie_json(animation: &VectorAnimation, title: &str) -> String {
    let timeline = &animation.timeline;
    let frames = timeline.frames();
    let shown = ShownTimes::of(timeline);
    let remap = time_remap(timeline, &shown);
    let (width, height) = (animation.size.width(), animation.size.height());
    LottieDocument {
        v: "5.7.4",
        fr: timeline.fps,
        ip: 0,
        op: frames,
        w: width,
        h: height,
        nm: title.to_owned(),
        ddd: 0,
        assets: vec![LottieComposition {
            id: FILM_ID,
            nm: title.to_owned(),
            fr: timeline.fps,
            layers: scenes(animation, &shown),
        }],
        layers: film_on_ground(title, animation.size, animation.ground, frames, remap),
    }
    .text()
}

/// The values of t that a film shows, in ascending order: one for each frame of its composition.
struct ShownTimes(Vec<f64>);

impl ShownTimes {
    fn of(timeline: &FilmTimeline) -> Self {
        let mut times = timeline.times.clone();
        times.sort_by(f64::total_cmp);
        times.dedup();
        Self(times)
    }

    /// Returns the last frame of the composition.
    fn last(&self) -> f64 {
        (self.0.len() - 1) as f64
    }

    /// Returns the time in frames at which the composition shows a t.
    fn frame_of(&self, t: f64) -> f64 {
        let after = self.0.partition_point(|&shown| shown < t);
        match (after.checked_sub(1), self.0.get(after)) {
            (Some(before), Some(&next)) if t < next => {
                let start = self.0[before];
                before as f64 + (t - start) / (next - start)
            }
            (_, Some(_)) => after as f64,
            (_, None) => self.last(),
        }
    }

    /// Returns the times in frames, each with its t, at which shapes are sampled: frames, and the
    /// starts of the pieces of the animation.
    fn stations(&self, animation: &VectorAnimation) -> Vec<(f64, f64)> {
        let step = self.0.len().div_ceil(MAX_KEYED_FRAMES);
        let [from, to] = [self.0[0], self.0[self.0.len() - 1]];
        let starts = animation.pieces.iter().map(|piece| piece.from);
        let starts = starts.filter(|&t| from < t && t < to);
        let mut times: Vec<f64> = self.0.iter().copied().step_by(step).collect();
        times.extend(starts.chain([to]));
        times.sort_by(f64::total_cmp);
        times.dedup();
        let stations = times.into_iter().map(|t| (self.frame_of(t), t));
        // A film of a single t lasts longer than the frame that shows it first.
        let end = (from == to).then_some((1.0, to));
        stations.chain(end).collect()
    }
}

/// Returns the layers of the composition of the film, which has one frame for each of the times
/// `shown`.
fn scenes(animation: &VectorAnimation, shown: &ShownTimes) -> Vec<LottieLayer> {
    let mut scenes = layers(animation, &shown.stations(animation));
    // Scenes (consecutive animation pieces with the same shapes) that are too short for the precision
    // of times are never visible.
    let time = |frames: f64| round_number(frames, 3);
    scenes.retain(|scene| time(scene.from) != time(scene.to));
    let last = scenes.len().saturating_sub(1);
    let scene = |(k, scene): (usize, &SceneLayer)| {
        let begin = (k > 0).then(|| time(scene.from));
        let end = (k < last).then(|| time(scene.to));
        // The first scene begins at 0, and the last one ends after the end of the film, so that
        // rounding in a player never hides them.
        let from = begin.clone().unwrap_or(0.into());
        let to = end.clone().unwrap_or_else(|| time(shown.last() + 1.0));
        // Lottie lists the topmost shape first.
        let topmost_first = scene.shapes.iter().rev();
        let shapes = topmost_first.map(|poses| shape(scene, poses)).collect();
        let content = LayerContent::Shapes { shapes };
        let mut layer = layer(format!("scene {}", k + 1), k + 1, content, [from, to]);
        layer.ks.o = visibility(begin, end);
        layer
    };
    scenes.iter().enumerate().map(scene).collect()
}

/// Returns the opacity of a layer that is visible from `begin` until shortly before `end`. Without
/// one of them, there is no limit.
///
/// The period of the layer alone would not suffice: rlottie rounds it to whole frames and includes
/// the last one, in which the layer would then be drawn in addition to the next.
fn visibility(begin: Option<Number>, end: Option<Number>) -> LottieProperty {
    let percent = |percent: u8| LottieValue::Number(percent.into());
    let (is_hidden_first, is_always) = (begin.is_some(), begin.is_none() && end.is_none());
    if is_always {
        return LottieProperty::still(percent(100));
    }
    let first = is_hidden_first.then(|| LottieKeyframe::hold(0.into(), percent(0)));
    let shown = LottieKeyframe::hold(begin.unwrap_or(0.into()), percent(100));
    let hidden = end.map(|end| LottieKeyframe::hold(end, percent(0)));
    LottieProperty::moving(first.into_iter().chain([shown]).chain(hidden).collect())
}

/// Returns the layers of the animation: the film with its time remapped, and below it the
/// background, if there is one.
fn film_on_ground(
    title: &str,
    size: PixelSize,
    ground: Option<Rgb>,
    frames: usize,
    remap: LottieProperty,
) -> Vec<LottieLayer> {
    let period = [Number::from(0), Number::from(frames)];
    let (width, height) = (size.width(), size.height());
    let content = LayerContent::Composition {
        ref_id: FILM_ID,
        tm: remap,
        w: width,
        h: height,
    };
    let film = layer(title.to_owned(), 1, content, period.clone());
    let ground = ground.map(|ground| {
        let content = LayerContent::Solid {
            sc: ground.to_string(),
            sw: width,
            sh: height,
        };
        layer("ground".to_owned(), 2, content, period)
    });
    [Some(film), ground].into_iter().flatten().collect()
}

/// Returns a layer that is not transformed. `period` are its first frame and the frame after its
/// last one.
fn layer(
    name: String,
    number: usize,
    content: LayerContent,
    [from, to]: [Number; 2],
) -> LottieLayer {
    LottieLayer {
        ddd: 0,
        ind: number,
        ty: content.layer_type(),
        nm: name,
        sr: 1,
        ks: identity_transform(),
        content,
        ip: from,
        op: to,
        st: 0,
        bm: 0,
    }
}

/// Returns the Lottie time remapping: for each frame of the film, the moment of the precomposition
/// that the frame shows, in seconds from the start of the precomposition.
fn time_remap(timeline: &FilmTimeline, shown: &ShownTimes) -> LottieProperty {
    let places: Vec<f64> = (timeline.times.iter().map(|&t| shown.frame_of(t))).collect();
    let last = timeline.frames();
    let is_key = |&k: &usize| {
        let is_end = k == 0 || k == last;
        is_end || places[k + 1] - places[k] != places[k] - places[k - 1]
    };
    let key = |k: usize| {
        let secs = round_number((places[k] + FRAME_TOLERANCE) / timeline.fps, 6);
        let handles = (k < last).then(linear_handles);
        LottieKeyframe::new(k.into(), LottieValue::Number(secs), handles)
    };
    LottieProperty::moving((0..=last).filter(is_key).map(key).collect())
}

/// Returns the handles of a keyframe after which a property changes linearly.
fn linear_handles() -> [LottieHandle; 2] {
    [0, 1].map(|end: i64| LottieHandle::new(end.into(), end.into()))
}

/// Returns the identity transform.
fn identity_transform() -> LottieTransform {
    let number = |x: i64| LottieProperty::still(LottieValue::Number(x.into()));
    let vector = |x: i64| LottieProperty::still(LottieValue::Numbers(vec![x.into(); 3]));
    LottieTransform {
        p: vector(0),
        a: vector(0),
        s: vector(100),
        r: number(0),
        o: number(100),
    }
}

/// Returns the group of one shape: its paths, its fill or stroke, and its transform.
fn shape(layer: &SceneLayer, poses: &[PosedShape]) -> LottieShape {
    let Some(first) = poses.first() else {
        return LottieShape::Group {
            it: Vec::new(),
            nm: None,
        };
    };
    let bar = [PathVerb::Move, PathVerb::Line];
    let mut items = match &*first.form {
        ShapeForm::Fill { verbs, .. } | ShapeForm::Stroke { verbs, .. } => {
            outlines(layer, poses, verbs)
        }
        ShapeForm::Bars => (0..first.points.len() / 2)
            .map(|k| outline(layer, poses, 2 * k, &bar, false))
            .collect(),
        ShapeForm::Discs => discs(layer, poses),
    };
    items.push(match &*first.form {
        ShapeForm::Fill {
            ramp: Some(ramp), ..
        } => gradient_fill(layer, poses, ramp),
        ShapeForm::Fill { .. } | ShapeForm::Discs => LottieShape::Fill {
            c: colour(layer, poses),
            o: opacity(layer, poses),
            r: NONZERO,
        },
        ShapeForm::Stroke { join, .. } => stroke(layer, poses, *join, LineCap::Butt),
        ShapeForm::Bars => stroke(layer, poses, StrokeJoin::Round, LineCap::Round),
    });
    items.push(LottieShape::Transform(identity_transform()));
    let name = match &*first.form {
        ShapeForm::Fill { label, .. } => label.clone(),
        _ => None,
    };
    LottieShape::Group {
        it: items,
        nm: name,
    }
}

/// Cap at the ends of an open line. The values are those of Lottie's property `lc`.
#[derive(Clone, Copy)]
enum LineCap {
    Butt = 1,
    Round = 2,
}

/// Nonzero fill rule: value of Lottie's property `r`.
const NONZERO: u8 = 1;

/// Returns the stroke of a shape, with its colour, opacity and width over time.
fn stroke(layer: &SceneLayer, poses: &[PosedShape], join: StrokeJoin, cap: LineCap) -> LottieShape {
    let width = layer.width(poses, PosedShape::width);
    let (join, limit) = match join {
        StrokeJoin::Mitre(limit) => (1, Some(limit)),
        StrokeJoin::Round => (2, None),
        StrokeJoin::Bevel => (3, None),
    };
    LottieShape::Stroke {
        c: colour(layer, poses),
        o: opacity(layer, poses),
        w: property(&width, |w| LottieValue::Number(round_number(*w, 3))),
        lc: cap as u8,
        lj: join,
        ml: limit,
    }
}

/// Returns one path per contour of an outline.
fn outlines(layer: &SceneLayer, poses: &[PosedShape], verbs: &[PathVerb]) -> Vec<LottieShape> {
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
) -> LottieShape {
    let count = verbs.iter().map(|verb| verb.point_count()).sum::<usize>();
    let range = first..first + count;
    let path = |posed: &PosedShape| path(verbs, &posed.points[range.clone()], closed);
    let keyed = layer.points(poses, range.clone(), path);
    LottieShape::Path {
        ks: property(&keyed, |path| LottieValue::Path(path.clone())),
    }
}

/// Returns the vertices of a path, and the incoming and outgoing handle of each vertex relative to
/// the vertex.
fn path(verbs: &[PathVerb], points: &[DVec2], closed: bool) -> LottiePath {
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
    let part = |k: usize| corners.iter().map(|corner| point(corner[k])).collect();
    LottiePath {
        i: part(1),
        o: part(2),
        v: part(0),
        c: closed,
    }
}

/// Rounds the coordinates of a point, in pixels.
fn point(p: DVec2) -> [Number; 2] {
    p.to_array().map(|x| round_number(x, 2))
}

/// Returns one ellipse per disc.
fn discs(layer: &SceneLayer, poses: &[PosedShape]) -> Vec<LottieShape> {
    let size = layer.width(poses, |posed| 2.0 * posed.width());
    let size = property(&size, |d| {
        LottieValue::Numbers(vec![round_number(*d, 3); 2])
    });
    let disc = |k: usize| {
        let centre = layer.points(poses, k..k + 1, |posed| posed.points[k]);
        LottieShape::Ellipse {
            d: 1,
            p: property(&centre, |p| LottieValue::Numbers(point(*p).to_vec())),
            s: size.clone(),
        }
    };
    (0..poses[0].points.len()).map(disc).collect()
}

/// Returns the colour of a shape: three channels from 0 to 1, and alpha 1.
fn colour(layer: &SceneLayer, poses: &[PosedShape]) -> LottieProperty {
    let colour = layer.colour(poses, |posed| posed.paint().colour);
    property(&colour, |Rgb(channels)| {
        let channels = channels.map(|c| round_number(f64::from(c) / 255.0, 4));
        LottieValue::Numbers(channels.into_iter().chain([Number::from(1)]).collect())
    })
}

/// Returns the opacity of a shape, in percent.
fn opacity(layer: &SceneLayer, poses: &[PosedShape]) -> LottieProperty {
    let opacity = layer.opacity(poses, |posed| posed.paint().opacity);
    property(&opacity, |share| {
        LottieValue::Number(round_number(100.0 * share, 2))
    })
}

/// Returns the gradient fill of a shape.
fn gradient_fill(layer: &SceneLayer, poses: &[PosedShape], ramp: &GradientForm) -> LottieShape {
    let ends = |posed: &PosedShape| {
        posed
            .gradient()
            .map(|gradient| TwoPointGradient::of(&gradient))
    };
    let place = |which: fn(&TwoPointGradient) -> DVec2| {
        let of = move |posed: &PosedShape| ends(posed).map_or(DVec2::ZERO, |plain| which(&plain));
        let numbers = |posed: &PosedShape| of(posed).to_array().to_vec();
        let keyed = layer.keyed(poses, 0.2, numbers, of);
        property(&keyed, |p| LottieValue::Numbers(point(*p).to_vec()))
    };
    let stops = |posed: &PosedShape| posed.gradient().map(|g| stops(&g)).unwrap_or_default();
    let keyed = layer.keyed(poses, 0.004, stops, stops);
    let colours = property(&keyed, |stops| {
        LottieValue::Numbers(stops.iter().map(|x| round_number(*x, 4)).collect())
    });
    let nought = || LottieProperty::still(LottieValue::Number(0.into()));
    LottieShape::GradientFill {
        o: LottieProperty::still(LottieValue::Number(100.into())),
        r: NONZERO,
        g: LottieColours {
            p: ramp.stops,
            k: colours,
        },
        s: place(|plain| match *plain {
            TwoPointGradient::Linear { from, .. } => from,
            TwoPointGradient::Radial { middle, .. } => middle,
        }),
        e: place(|plain| match *plain {
            TwoPointGradient::Linear { to, .. } => to,
            TwoPointGradient::Radial { middle, radius, .. } => middle + DVec2::X * radius,
        }),
        t: if ramp.is_radial { 2 } else { 1 },
        h: ramp.is_radial.then(nought),
        a: ramp.is_radial.then(nought),
    }
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
fn property<T>(keyed: &KeyedProperty<T>, value: impl Fn(&T) -> LottieValue) -> LottieProperty {
    if let [(_, only)] = keyed.keys.as_slice() {
        return LottieProperty::still(value(only));
    }
    let last = keyed.keys.len().saturating_sub(1);
    let key = |(k, (x, at)): (usize, &(f64, T))| {
        let handles = (k < last).then(linear_handles);
        LottieKeyframe::new(round_number(*x, 3), value(at), handles)
    };
    LottieProperty::moving(keyed.keys.iter().enumerate().map(key).collect())
}
