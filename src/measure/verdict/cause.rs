//! What is measured where the trouble of rigid parts is worst.

use super::finding::FindingCause;
use crate::content::SolidContent;
use crate::geometry::{DVec2, twice_signed_area};
use crate::geometry::{EdgeCrossing, RingEdge};
use crate::measure::distortion::{FaceStrain, edges};
use crate::measure::stretch;
use crate::transition::Transition;
use crate::warp::Arap;
use crate::warp::homotopy::Homotopy;
use std::f64::consts::{FRAC_PI_3, PI};

/// A stretch of the boundary that is longer or shorter than this many times
/// its mean is named as a cause. Good matches of animals of one kind stay
/// below 2 nearly everywhere.
const UNEVEN: f64 = 3.0;

/// A face of which less than this share of the area is left by its own path
/// is flattened by it, whatever its neighbours do.
const FLATTENED: f64 = 0.1;

/// A transition of rigid parts at the t of a trouble.
pub(super) struct CauseSearch<'a> {
    pub transition: &'a Transition,
    pub arap: &'a Arap,
    pub solid: &'a SolidContent,
    pub t: f64,
    pub places: Vec<DVec2>,
    pub angles: Vec<f64>,
    pub part_of: Vec<u32>,
}

impl<'a> CauseSearch<'a> {
    pub fn new(
        transition: &'a Transition,
        arap: &'a Arap,
        solid: &'a SolidContent,
        t: f64,
    ) -> Self {
        Self {
            transition,
            arap,
            solid,
            t,
            places: transition.frame(t).placement().in_frame.clone(),
            angles: arap.face_angles(),
            part_of: arap.mesh().connectivity().dual_components(),
        }
    }

    pub fn centroid(&self, face: usize, points: &[DVec2]) -> DVec2 {
        let corners = self.arap.mesh().faces()[face].map(|v| points[v as usize]);
        corners.iter().sum::<DVec2>() / 3.0
    }

    /// The determinant of a face against the source.
    pub fn det(&self, face: usize) -> f64 {
        let mesh = self.arap.mesh();
        let corners = &mesh.faces()[face];
        FaceStrain::of(edges(&self.places, corners) * edges(mesh.source(), corners).inverse()).det
    }

    /// The face at an edge of the boundary.
    pub fn face_at(&self, edge: RingEdge) -> Option<usize> {
        let corners = self.solid.corners_at(edge, &self.places, self.t)?;
        let faces = self.arap.mesh().faces();
        faces
            .iter()
            .position(|face| corners.iter().all(|v| face.contains(v)))
    }

    /// The area-weighted mean angle of the faces that are chosen.
    pub fn mean_angle(&self, is: impl Fn(usize) -> bool) -> Option<f64> {
        let mesh = self.arap.mesh();
        let (mut sum, mut total) = (0.0, 0.0);
        for (f, face) in mesh.faces().iter().enumerate().filter(|(f, _)| is(*f)) {
            let [a, b, c] = face.map(|v| mesh.source()[v as usize]);
            let area = twice_signed_area(a, b, c);
            (sum, total) = (sum + area * self.angles[f], total + area);
        }
        (total > 0.0).then(|| sum / total)
    }

    /// The parts that share a vertex with one.
    pub fn neighbouring_parts(&self, part: u32) -> Vec<u32> {
        let faces = self.arap.mesh().faces();
        let mut on_part = vec![false; self.arap.mesh().source().len()];
        for (face, _) in faces.iter().zip(&self.part_of).filter(|(_, p)| **p == part) {
            face.iter().for_each(|&v| on_part[v as usize] = true);
        }
        let touches = |face: &[u32; 3]| face.iter().any(|&v| on_part[v as usize]);
        let others = faces.iter().zip(&self.part_of);
        let mut parts: Vec<u32> = others
            .filter(|(face, p)| **p != part && touches(face))
            .map(|(_, p)| *p)
            .collect();
        parts.sort_unstable();
        parts.dedup();
        parts
    }
}

/// Its own path flattens a face, before any neighbour has its say.
pub(super) fn straight_paths(scene: &CauseSearch<'_>, face: usize, t: f64) -> Option<FindingCause> {
    let homotopy = scene.arap.options().homotopy;
    if homotopy.keeps_orientation() {
        return None;
    }
    let map = scene.arap.local_map(face);
    let t = scene
        .transition
        .time_of(scene.arap.mesh().faces()[face][0], t);
    // Against the polar path, whose area only runs from end to end.
    let left = homotopy.at(&map, t).determinant();
    let kept = Homotopy::Polar.at(&map, t).determinant();
    (left < FLATTENED * kept).then_some(FindingCause::StraightPaths {
        homotopy,
        turn: map.angle,
    })
}

/// The part of a face and one that it hangs on turn by more than half a turn
/// against each other; named is that which turns further.
pub(super) fn far_turn_of_part(scene: &CauseSearch<'_>, face: usize) -> Option<FindingCause> {
    let part = scene.part_of[face];
    let mean = |p: u32| scene.mean_angle(|f| scene.part_of[f] == p);
    let own = mean(part)?;
    let others = scene.neighbouring_parts(part).into_iter();
    let (other, angle) = others
        .filter_map(|other| Some((other, mean(other)?)))
        .max_by(|a, b| (a.1 - own).abs().total_cmp(&(b.1 - own).abs()))?;
    let (part, turn) = if angle.abs() > own.abs() {
        (other, angle - own)
    } else {
        (part, own - angle)
    };
    (turn.abs() > PI).then_some(FindingCause::FarTurn {
        part: Some(part as usize),
        turn,
    })
}

/// A face turns by more than half a turn against the whole.
pub(super) fn far_turn(scene: &CauseSearch<'_>, face: usize) -> Option<FindingCause> {
    let turn = scene.angles[face] - scene.mean_angle(|_| true)?;
    (turn.abs() > PI).then_some(FindingCause::FarTurn { part: None, turn })
}

/// The boundary near a face is stretched unevenly.
pub(super) fn uneven_match(scene: &CauseSearch<'_>, face: usize) -> Option<FindingCause> {
    /// How far from the face the boundary may be, by its diameter.
    const NEAR: f64 = 0.1;
    let mesh = scene.arap.mesh();
    let (source, target) = (mesh.source(), mesh.target());
    let about = scene.centroid(face, source);
    // In the source: at t the place is bent by the trouble itself.
    let near = NEAR * mesh.diameter();
    let worst = stretch::boundary(mesh)
        .into_iter()
        .filter(|s| source[s.vertex as usize].distance(about) < near)
        .max_by(|a, b| a.unevenness().total_cmp(&b.unevenness()))?;
    (worst.unevenness() > UNEVEN).then(|| FindingCause::UnevenMatch {
        ratio: worst.ratio,
        source: source[worst.vertex as usize],
        target: target[worst.vertex as usize],
    })
}

/// The largest difference of angles across an edge of one of the faces.
pub(super) fn unlike_neighbours(scene: &CauseSearch<'_>, faces: &[usize]) -> Option<FindingCause> {
    let connectivity = scene.arap.mesh().connectivity();
    let across = |f: usize| (0..3).filter_map(move |k| Some((f, connectivity.neighbour(f, k)?)));
    let turn = faces
        .iter()
        .flat_map(|&f| across(f))
        .map(|(a, b)| (scene.angles[a] - scene.angles[b]).abs())
        .reduce(f64::max)?;
    (turn > FRAC_PI_3).then_some(FindingCause::UnlikeNeighbours { turn })
}

/// Whether two edges of one ring are less than a tenth of it apart.
pub(super) fn near_each_other(scene: &CauseSearch<'_>, crossing: &EdgeCrossing) -> bool {
    let [a, b] = crossing.edges;
    let n = scene.solid.loops.get(a.ring).map_or(0, Vec::len);
    let between = a.point.abs_diff(b.point);
    a.ring == b.ring && between < n && 10 * between.min(n - between) < n
}
