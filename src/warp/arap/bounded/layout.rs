//! Flat faces side by side, and the maps that take the source there.

use super::flat::CornerProducts;
use super::sheet::FaceSheet;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2, PolarDecomposition, twice_signed_area};
use crate::warp::arap::assembly::FaceMap;

/// What is known of a face at every t.
#[derive(Clone, Copy, Debug)]
pub(in crate::warp::arap) struct BoundedFace {
    pub(super) corners: [u32; 3],
    /// From source to target.
    pub(super) map: PolarDecomposition,
    /// Gradients of the hat functions of the second and third corner.
    pub(super) gradients: DMat2,
    /// W times them.
    weighted: DMat2,
    /// From target to source.
    pub(super) back: DMat2,
    /// How much it counts where the sheet turns: the same of both designs.
    mass: f64,
}

impl BoundedFace {
    pub(super) fn new(mesh: &CompatibleMesh, face: usize, of: &FaceMap) -> Self {
        let corners = mesh.faces()[face];
        let area = |points: &[DVec2]| {
            let [a, b, c] = corners.map(|v| points[v as usize]);
            twice_signed_area(a, b, c)
        };
        Self {
            corners,
            map: of.map,
            gradients: of.gradients,
            weighted: of.weighted,
            back: of.map.matrix().inverse(),
            mass: (area(mesh.source()) * area(mesh.target())).sqrt(),
        }
    }

    /// What the face's own map is beside the straight line, of what its corners are.
    pub(in crate::warp::arap) fn strayed(&self, of: impl Fn(u32) -> DVec2) -> DMat2 {
        let [first, second, third] = self.corners.map(of);
        DMat2::from_cols(second - first, third - first) * self.gradients.transpose()
    }

    /// Adds M W g to the corners.
    pub(in crate::warp::arap) fn pull(&self, map: DMat2, forces: &mut [DVec2]) {
        let [first, second, third] = self.corners.map(|v| v as usize);
        let pulled = map * self.weighted;
        forces[first] -= pulled.x_axis + pulled.y_axis;
        forces[second] += pulled.x_axis;
        forces[third] += pulled.y_axis;
    }
}

/// The sides of a face whose first runs along x.
fn sides([first, ..]: &[CornerProducts; 3], length: f64) -> [DVec2; 3] {
    let along = DVec2::new(length, 0.0);
    let to_third = DVec2::new(first.dot, first.cross) / length;
    [along, to_third - along, -to_third]
}

/// The squared length of the first side: its dot products at both ends add up to it.
fn first_length([first, second, _]: &[CornerProducts; 3]) -> f64 {
    (first.dot + second.dot).sqrt()
}

/// Writes the map of each face, the first with its first side along x.
pub(super) fn laid_out(
    sheet: &FaceSheet,
    faces: &[BoundedFace],
    corners: &[[CornerProducts; 3]],
    maps: &mut [DMat2],
) {
    // First each face as it lies: its second and third corner from the first.
    for k in 0..faces.len() {
        let own = sides(&corners[k], first_length(&corners[k]));
        let turn = match k {
            0 => DVec2::X,
            _ => {
                let reached = sheet.reached[k];
                let before = maps[reached.from as usize];
                let there = [before.x_axis, before.y_axis - before.x_axis, -before.y_axis];
                // The same side, run the other way.
                let side = -there[reached.there as usize];
                conjugate(own[reached.here as usize])
                    .rotate(side)
                    .normalize_or(DVec2::X)
            }
        };
        maps[k] = DMat2::from_cols(turn.rotate(own[0]), turn.rotate(-own[2]));
    }
    for (map, face) in maps.iter_mut().zip(faces) {
        *map *= face.gradients.transpose();
    }
}

/// Turns all maps together so that they turn in the mean as by the polar homotopy.
pub(super) fn turn_along(faces: &[BoundedFace], t: f64, maps: &mut [DMat2]) {
    let mut sum = DVec2::ZERO;
    for (face, &map) in faces.iter().zip(maps.iter()) {
        let from_source = DVec2::from_angle(t * face.map.angle);
        let from_target = DVec2::from_angle((t - 1.0) * face.map.angle);
        let lags = conjugate(rotation(map)).rotate(from_source)
            + conjugate(rotation(map * face.back)).rotate(from_target);
        sum += lags * face.mass;
    }
    let turn = sum.normalize_or(DVec2::X);
    let turn = DMat2::from_cols(turn, turn.perp());
    maps.iter_mut().for_each(|map| *map = turn * *map);
}

/// The rotation of a map, as a unit vector.
fn rotation(map: DMat2) -> DVec2 {
    let (x, y) = (map.x_axis, map.y_axis);
    DVec2::new(x.x + y.y, x.y - y.x).normalize_or(DVec2::X)
}

fn conjugate(z: DVec2) -> DVec2 {
    DVec2::new(z.x, -z.y)
}
