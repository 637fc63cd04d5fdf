//! Finds the cause of a fold or crossing in a film of rigid parts, from measurements at its place.

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

/// Unevenness of the boundary stretch above which the match is named as the cause (heuristic).
const MIN_UNEVENNESS: f64 = 3.0;

/// A face counts as flattened by its homotopy if its area is below this fraction of the area that
/// it would have with the polar homotopy (heuristic).
const FLATTENED_AREA_FRACTION: f64 = 0.1;

/// A transition of rigid parts, evaluated at the `t` at which a defect is worst.
pub(super) struct CauseSearch<'a> {
    pub transition: &'a Transition,
    pub arap: &'a Arap,
    pub solid: &'a SolidContent,
    pub t: f64,
    /// Vertex positions at `t`.
    pub places: Vec<DVec2>,
    /// Rotation of each face from source to target, in radians.
    pub angles: Vec<f64>,
    /// For each face, the index of its part (a set of faces connected across edges).
    pub part_of: Vec<u32>,
}

impl<'a> CauseSearch<'a> {
    /// Evaluates the transition at `t`.
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

    /// Returns the centroid of a face whose vertices are at `points`.
    pub fn centroid(&self, face: usize, points: &[DVec2]) -> DVec2 {
        let corners = self.arap.mesh().faces()[face].map(|v| points[v as usize]);
        corners.iter().sum::<DVec2>() / 3.0
    }

    /// Returns the signed area of a face at `t`, divided by its area in the source.
    pub fn det(&self, face: usize) -> f64 {
        let mesh = self.arap.mesh();
        let corners = &mesh.faces()[face];
        FaceStrain::of(edges(&self.places, corners) * edges(mesh.source(), corners).inverse()).det
    }

    /// Returns the index of the face at a boundary edge.
    pub fn face_at(&self, edge: RingEdge) -> Option<usize> {
        let corners = self.solid.face_vertices_at(edge, &self.places, self.t)?;
        let faces = self.arap.mesh().faces();
        faces
            .iter()
            .position(|face| corners.iter().all(|v| face.contains(v)))
    }

    /// Returns the mean rotation of the selected faces, weighted by area, in radians.
    pub fn mean_angle(&self, is_selected: impl Fn(usize) -> bool) -> Option<f64> {
        let mesh = self.arap.mesh();
        let (mut sum, mut total) = (0.0, 0.0);
        for (f, face) in mesh
            .faces()
            .iter()
            .enumerate()
            .filter(|(f, _)| is_selected(*f))
        {
            let [a, b, c] = face.map(|v| mesh.source()[v as usize]);
            let area = twice_signed_area(a, b, c);
            (sum, total) = (sum + area * self.angles[f], total + area);
        }
        (total > 0.0).then(|| sum / total)
    }

    /// Returns the indices of the other parts that share a vertex with `part`.
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

/// Returns the homotopy as the cause if it flattens the face by itself, regardless of the
/// neighbours of the face. Homotopies that cannot turn a face over are ruled out.
pub(super) fn straight_paths(
    search: &CauseSearch<'_>,
    face: usize,
    t: f64,
) -> Option<FindingCause> {
    let homotopy = search.arap.options().homotopy;
    if homotopy.keeps_orientation() {
        return None;
    }
    let map = search.arap.local_map(face);
    let t = search
        .transition
        .part_time_at(search.arap.mesh().faces()[face][0], t);
    // The area is compared with that of the polar homotopy, which never flattens a face.
    let area = homotopy.at(&map, t).determinant();
    let polar_area = Homotopy::Polar.at(&map, t).determinant();
    (area < FLATTENED_AREA_FRACTION * polar_area).then_some(FindingCause::StraightPaths {
        homotopy,
        turn: map.angle,
    })
}

/// Returns a rotation as the cause if the part of the face and a neighbouring part rotate by more
/// than half a turn relative to each other. The cause names the one of the two that rotates
/// further.
pub(super) fn large_rotation_of_part(
    search: &CauseSearch<'_>,
    face: usize,
) -> Option<FindingCause> {
    let part = search.part_of[face];
    let mean = |p: u32| search.mean_angle(|f| search.part_of[f] == p);
    let own_angle = mean(part)?;
    let others = search.neighbouring_parts(part).into_iter();
    let (other, angle) = others
        .filter_map(|other| Some((other, mean(other)?)))
        .max_by(|a, b| (a.1 - own_angle).abs().total_cmp(&(b.1 - own_angle).abs()))?;
    let (part, turn) = if angle.abs() > own_angle.abs() {
        (other, angle - own_angle)
    } else {
        (part, own_angle - angle)
    };
    (turn.abs() > PI).then_some(FindingCause::FarTurn {
        part: Some(part as usize),
        turn,
    })
}

/// Returns the rotation of a face as the cause if it exceeds half a turn relative to the whole
/// shape.
pub(super) fn large_rotation(search: &CauseSearch<'_>, face: usize) -> Option<FindingCause> {
    let turn = search.angles[face] - search.mean_angle(|_| true)?;
    (turn.abs() > PI).then_some(FindingCause::FarTurn { part: None, turn })
}

/// Returns an uneven match as the cause if the boundary near a face is stretched very unevenly.
pub(super) fn uneven_match(search: &CauseSearch<'_>, face: usize) -> Option<FindingCause> {
    /// Maximum distance of the boundary from the face, in design diameters (heuristic).
    const MAX_DISTANCE: f64 = 0.1;
    let mesh = search.arap.mesh();
    let (source, target) = (mesh.source(), mesh.target());
    // Distances are measured in the source, because at t the defect itself distorts the shape.
    let centre = search.centroid(face, source);
    let max_distance = MAX_DISTANCE * mesh.diameter();
    let worst = stretch::boundary_stretch(mesh)
        .into_iter()
        .filter(|s| source[s.vertex as usize].distance(centre) < max_distance)
        .max_by(|a, b| a.unevenness().total_cmp(&b.unevenness()))?;
    (worst.unevenness() > MIN_UNEVENNESS).then(|| FindingCause::UnevenMatch {
        ratio: worst.ratio,
        source: source[worst.vertex as usize],
        target: target[worst.vertex as usize],
    })
}

/// Returns the largest difference between the rotations of one of the given faces and an adjacent
/// face as the cause, if the difference exceeds 60°.
pub(super) fn differing_neighbours(
    search: &CauseSearch<'_>,
    faces: &[usize],
) -> Option<FindingCause> {
    let connectivity = search.arap.mesh().connectivity();
    let neighbour_pairs =
        |f: usize| (0..3).filter_map(move |k| Some((f, connectivity.neighbour(f, k)?)));
    let turn = faces
        .iter()
        .flat_map(|&f| neighbour_pairs(f))
        .map(|(a, b)| (search.angles[a] - search.angles[b]).abs())
        .reduce(f64::max)?;
    (turn > FRAC_PI_3).then_some(FindingCause::UnlikeNeighbours { turn })
}

/// Returns whether the two crossing edges lie on the same ring, with less than a tenth of the
/// ring's points between them.
pub(super) fn are_near_each_other(search: &CauseSearch<'_>, crossing: &EdgeCrossing) -> bool {
    let [a, b] = crossing.edges;
    let n = search.solid.loops.get(a.ring).map_or(0, Vec::len);
    let between = a.point.abs_diff(b.point);
    a.ring == b.ring && between < n && 10 * between.min(n - between) < n
}
