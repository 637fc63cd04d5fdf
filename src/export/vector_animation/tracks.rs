//! Arranges a vector animation into layers over time, and reduces each property of a shape to
//! keyframes.
//!
//! A scene is a maximal run of animation pieces with the same shapes. Each time the film passes
//! through a scene, the scene becomes a separate layer that is visible for that period only.

use super::animation::VectorAnimation;
use super::keyframes::fewest_keys;
use super::shape::PosedShape;

/// Maximum deviation of each coordinate of a keyframed point, in pixels (derived: the distance
/// 0.088 √2, plus 0.04 for removed points and 0.02 for the series, is below
/// [`VectorAnimation::TOLERANCE_PX`]).
const POINT_TOLERANCE_PX: f64 = 0.088;

/// Maximum deviation of a keyframed colour channel, on the scale from 0 to 255 (tolerance: one step
/// of an 8-bit colour).
const COLOUR_TOLERANCE: f64 = 1.0;

/// Maximum deviation of a keyframed opacity in [0, 1] (tolerance: one step of 8 bits).
const OPACITY_TOLERANCE: f64 = 0.004;

/// Maximum deviation of a keyframed width, in pixels (tolerance: not visible).
const WIDTH_TOLERANCE_PX: f64 = 0.05;

/// A scene (consecutive animation pieces with the same shapes) during one period in which it is
/// visible.
#[derive(Clone, Debug)]
pub(super) struct SceneLayer {
    /// Time at which the layer appears, in frames.
    pub from: f64,
    /// Time at which the layer disappears, in frames.
    pub to: f64,
    /// Times at which the shapes were sampled, in frames (not necessarily whole), ascending.
    pub places: Vec<f64>,
    /// For each shape, the lowest first: one sample for each of `places`.
    pub shapes: Vec<Vec<PosedShape>>,
}

/// A property of a shape over time, reduced to few keyframes.
#[derive(Clone, Debug)]
pub(super) struct KeyedProperty<T> {
    /// Keyframes: the time in frames, and the value at that time. There is only one keyframe if the
    /// property is constant.
    pub keys: Vec<(f64, T)>,
}

impl SceneLayer {
    /// Returns a property of a shape as keyframes. `numbers` returns the numbers of the property in
    /// a sample; linear interpolation between the keyframes reproduces them within `tolerance` in
    /// every sample. `take` returns the value of the property at a keyframe.
    pub(super) fn keyed<T>(
        &self,
        poses: &[PosedShape],
        tolerance: f64,
        numbers: impl Fn(&PosedShape) -> Vec<f64>,
        take: impl Fn(&PosedShape) -> T,
    ) -> KeyedProperty<T> {
        let rows: Vec<Vec<f64>> = poses.iter().map(numbers).collect();
        // A property that stays well within the tolerance of its first sample counts as constant.
        let is_constant = |row: &Vec<f64>| {
            let mut both = row.iter().zip(&rows[0]);
            both.all(|(a, b)| (a - b).abs() <= 0.25 * tolerance)
        };
        let keys = if rows.iter().all(is_constant) {
            vec![0]
        } else {
            fewest_keys(&self.places, &rows, tolerance)
        };
        let key = |k: usize| (self.places[k], take(&poses[k]));
        KeyedProperty {
            keys: keys.into_iter().map(key).collect(),
        }
    }

    /// Returns the keyframes of those points of a shape whose indices are in `range`.
    pub(super) fn points<T>(
        &self,
        poses: &[PosedShape],
        range: std::ops::Range<usize>,
        take: impl Fn(&PosedShape) -> T,
    ) -> KeyedProperty<T> {
        let numbers = |posed: &PosedShape| {
            let points = posed.points[range.clone()].iter();
            points.flat_map(|p| [p.x, p.y]).collect()
        };
        self.keyed(poses, POINT_TOLERANCE_PX, numbers, take)
    }

    /// Returns the keyframes of a shape's colour.
    pub(super) fn colour<T>(
        &self,
        poses: &[PosedShape],
        take: impl Fn(&PosedShape) -> T,
    ) -> KeyedProperty<T> {
        self.keyed(
            poses,
            COLOUR_TOLERANCE,
            |posed| posed.appearance[..3].to_vec(),
            take,
        )
    }

    /// Returns the keyframes of a shape's opacity.
    pub(super) fn opacity<T>(
        &self,
        poses: &[PosedShape],
        take: impl Fn(&PosedShape) -> T,
    ) -> KeyedProperty<T> {
        self.keyed(
            poses,
            OPACITY_TOLERANCE,
            |posed| vec![posed.appearance[3]],
            take,
        )
    }

    /// Returns the keyframes of a shape's width or radius.
    pub(super) fn width<T>(
        &self,
        poses: &[PosedShape],
        take: impl Fn(&PosedShape) -> T,
    ) -> KeyedProperty<T> {
        self.keyed(
            poses,
            WIDTH_TOLERANCE_PX,
            |posed| vec![posed.appearance[4]],
            take,
        )
    }
}

/// Returns the layers of an animation, one for each period in which a scene (consecutive animation
/// pieces with the same shapes) is visible. `timeline` lists times in frames, in ascending order,
/// each with the t shown at that time. A scene change between two of these times is located by
/// linear interpolation of t.
pub(super) fn layers(animation: &VectorAnimation, timeline: &[(f64, f64)]) -> Vec<SceneLayer> {
    let scenes = scenes(animation);
    let scene_at = |t: f64| {
        scenes
            .partition_point(|scene| scene.0 <= t)
            .saturating_sub(1)
    };
    let Some(&first) = timeline.first() else {
        return Vec::new();
    };
    let mut layers = Vec::new();
    let mut scene = scene_at(first.1);
    let mut stations = vec![first];
    for two in timeline.windows(2) {
        let [(x, t), (next_x, next_t)] = [two[0], two[1]];
        let target = scene_at(next_t);
        while scene != target {
            let is_forward = target > scene;
            let border = scenes[if is_forward { scene + 1 } else { scene }].0;
            let fraction = if next_t == t {
                0.0
            } else {
                (border - t) / (next_t - t)
            };
            let border_place = x + fraction.clamp(0.0, 1.0) * (next_x - x);
            stations.push((border_place, border));
            layers.push(layer(animation, &scenes, scene, &stations));
            scene = if is_forward { scene + 1 } else { scene - 1 };
            stations = vec![(border_place, border)];
        }
        stations.push((next_x, next_t));
    }
    layers.push(layer(animation, &scenes, scene, &stations));
    layers
}

/// For each scene (consecutive animation pieces with the same shapes): returns its first t and the
/// range of its pieces.
fn scenes(animation: &VectorAnimation) -> Vec<(f64, std::ops::Range<usize>)> {
    let mut scenes: Vec<(f64, std::ops::Range<usize>)> = Vec::new();
    for (k, piece) in animation.pieces.iter().enumerate() {
        match scenes.last_mut() {
            Some((_, pieces)) if piece.is_continuation => pieces.end = k + 1,
            _ => scenes.push((piece.from, k..k + 1)),
        }
    }
    scenes
}

/// Returns the layer of a scene, sampled at the given `stations`. A station is a time in frames and
/// the t shown at that time.
fn layer(
    animation: &VectorAnimation,
    scenes: &[(f64, std::ops::Range<usize>)],
    scene: usize,
    stations: &[(f64, f64)],
) -> SceneLayer {
    let pieces = scenes[scene].1.clone();
    let mut places: Vec<f64> = Vec::new();
    let mut shapes: Vec<Vec<PosedShape>> =
        vec![Vec::new(); animation.pieces[pieces.start].shapes.len()];
    for &(x, t) in stations {
        if places.last() == Some(&x) {
            continue;
        }
        places.push(x);
        // At a scene change two animation pieces share t; the one of this scene is used.
        let piece = animation.piece_at(t).clamp(pieces.start, pieces.end - 1);
        let posed = animation.pieces[piece].at(t);
        for (poses, posed) in shapes.iter_mut().zip(posed) {
            poses.push(posed);
        }
    }
    SceneLayer {
        from: stations[0].0,
        to: stations[stations.len() - 1].0,
        places,
        shapes,
    }
}
