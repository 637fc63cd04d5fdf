//! Shapes over time: who is seen from when to when, and where each point is.
//!
//! A scene is a row of pieces with the same shapes. Each time that a course comes
//! through one it is a layer.

use super::animation::VectorAnimation;
use super::keyframes::fewest_keys;
use super::shape::PosedShape;

/// How far straight lines between keys may be from a point, in each of the two
/// directions, in pixels: with what else is lost it stays below
/// [`VectorAnimation::TOLERANCE_PX`].
const STRAIGHT_PX: f64 = 0.088;

/// The same for colours, of 255; for opacity, and for widths in pixels.
const COLOUR: f64 = 1.0;
const OPACITY: f64 = 0.004;
const WIDTH_PX: f64 = 0.05;

/// A scene while it is seen.
#[derive(Clone, Debug)]
pub(super) struct SceneLayer {
    pub from: f64,
    pub to: f64,
    /// When the shapes were looked at, ascending.
    pub places: Vec<f64>,
    /// For each shape, the lowest first, how it is at each place.
    pub shapes: Vec<Vec<PosedShape>>,
}

/// Numbers that change over time, at as few places as will do.
#[derive(Clone, Debug)]
pub(super) struct KeyedProperty<T> {
    /// When, and what; one alone stays.
    pub keys: Vec<(f64, T)>,
}

impl SceneLayer {
    /// What is taken of a shape's poses, with keys such that the numbers lie within a
    /// tolerance of straight lines.
    pub(super) fn keyed<T>(
        &self,
        poses: &[PosedShape],
        tolerance: f64,
        numbers: impl Fn(&PosedShape) -> Vec<f64>,
        take: impl Fn(&PosedShape) -> T,
    ) -> KeyedProperty<T> {
        let rows: Vec<Vec<f64>> = poses.iter().map(numbers).collect();
        let stays = |row: &Vec<f64>| {
            let mut both = row.iter().zip(&rows[0]);
            both.all(|(a, b)| (a - b).abs() <= 0.25 * tolerance)
        };
        let keys = if rows.iter().all(stays) {
            vec![0]
        } else {
            fewest_keys(&self.places, &rows, tolerance)
        };
        let key = |k: usize| (self.places[k], take(&poses[k]));
        KeyedProperty {
            keys: keys.into_iter().map(key).collect(),
        }
    }

    /// Some of a shape's points.
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
        self.keyed(poses, STRAIGHT_PX, numbers, take)
    }

    /// A shape's colour.
    pub(super) fn colour<T>(
        &self,
        poses: &[PosedShape],
        take: impl Fn(&PosedShape) -> T,
    ) -> KeyedProperty<T> {
        self.keyed(poses, COLOUR, |posed| posed.look[..3].to_vec(), take)
    }

    /// How much it hides.
    pub(super) fn opacity<T>(
        &self,
        poses: &[PosedShape],
        take: impl Fn(&PosedShape) -> T,
    ) -> KeyedProperty<T> {
        self.keyed(poses, OPACITY, |posed| vec![posed.look[3]], take)
    }

    /// Its width or radius.
    pub(super) fn width<T>(
        &self,
        poses: &[PosedShape],
        take: impl Fn(&PosedShape) -> T,
    ) -> KeyedProperty<T> {
        self.keyed(poses, WIDTH_PX, |posed| vec![posed.look[4]], take)
    }
}

/// The layers along a course: places, ascending, with the t that is shown at each.
pub(super) fn layers(motion: &VectorAnimation, course: &[(f64, f64)]) -> Vec<SceneLayer> {
    let scenes = scenes(motion);
    let scene_at = |t: f64| {
        scenes
            .partition_point(|scene| scene.0 <= t)
            .saturating_sub(1)
    };
    let Some(&first) = course.first() else {
        return Vec::new();
    };
    let mut layers = Vec::new();
    let mut scene = scene_at(first.1);
    let mut stations = vec![first];
    for two in course.windows(2) {
        let [(x, t), (next_x, next_t)] = [two[0], two[1]];
        let wanted = scene_at(next_t);
        while scene != wanted {
            let is_forward = wanted > scene;
            let border = scenes[if is_forward { scene + 1 } else { scene }].0;
            let share = if next_t == t {
                0.0
            } else {
                (border - t) / (next_t - t)
            };
            let at = x + share.clamp(0.0, 1.0) * (next_x - x);
            stations.push((at, border));
            layers.push(layer(motion, &scenes, scene, &stations));
            scene = if is_forward { scene + 1 } else { scene - 1 };
            stations = vec![(at, border)];
        }
        stations.push((next_x, next_t));
    }
    layers.push(layer(motion, &scenes, scene, &stations));
    layers
}

/// For each scene where it begins, and its pieces.
fn scenes(motion: &VectorAnimation) -> Vec<(f64, std::ops::Range<usize>)> {
    let mut scenes: Vec<(f64, std::ops::Range<usize>)> = Vec::new();
    for (k, piece) in motion.pieces.iter().enumerate() {
        match scenes.last_mut() {
            Some((_, pieces)) if piece.goes_on => pieces.end = k + 1,
            _ => scenes.push((piece.from, k..k + 1)),
        }
    }
    scenes
}

fn layer(
    motion: &VectorAnimation,
    scenes: &[(f64, std::ops::Range<usize>)],
    scene: usize,
    stations: &[(f64, f64)],
) -> SceneLayer {
    let pieces = scenes[scene].1.clone();
    let mut places: Vec<f64> = Vec::new();
    let mut shapes: Vec<Vec<PosedShape>> =
        vec![Vec::new(); motion.pieces[pieces.start].shapes.len()];
    for &(x, t) in stations {
        if places.last() == Some(&x) {
            continue;
        }
        places.push(x);
        // At a border this scene's side of it.
        let piece = motion.piece_at(t).clamp(pieces.start, pieces.end - 1);
        let posed = motion.pieces[piece].at(t);
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
