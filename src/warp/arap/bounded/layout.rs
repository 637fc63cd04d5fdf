//! Places the faces of a sheet in the plane after the module `flat` has flattened the sheet, and
//! computes the linear map of each face from the source to its flattened shape. The flattened shape
//! of a face is the triangle with the side lengths that `flat` chose at the current t.

use super::flat::CornerProducts;
use super::sheet::FaceSheet;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2, PolarDecomposition, twice_signed_area};
use crate::warp::arap::assembly::FaceMap;

/// Properties of a face that do not depend on t.
#[derive(Clone, Copy, Debug)]
pub(in crate::warp::arap) struct BoundedFace {
    pub(super) corners: [u32; 3],
    /// Linear map from source to target, as a rotation and a stretch.
    pub(super) map: PolarDecomposition,
    /// Gradients of the hat functions of the second and third corner in the source.
    pub(super) gradients: DMat2,
    /// The gradients multiplied by the face's weight matrix W. The face's contribution to the
    /// right-hand sides is computed from them.
    weighted: DMat2,
    /// Linear map from target to source.
    pub(super) back: DMat2,
    /// Weight of the face in the mean rotation of its sheet: twice the geometric mean of its areas
    /// in the two designs.
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

    /// Returns the Jacobian, on the source face, of the linear function with the values `of` at the
    /// corners. For the deviations of the vertices, this is the deviation of the face's local map.
    pub(in crate::warp::arap) fn strayed(&self, of: impl Fn(u32) -> DVec2) -> DMat2 {
        let [first, second, third] = self.corners.map(of);
        DMat2::from_cols(second - first, third - first) * self.gradients.transpose()
    }

    /// Adds the contribution M W g of the face to the right-hand sides at its corners. M is `map`,
    /// W the face's weight matrix, and g are the gradients of its hat functions.
    pub(in crate::warp::arap) fn pull(&self, map: DMat2, forces: &mut [DVec2]) {
        let [first, second, third] = self.corners.map(|v| v as usize);
        let pulled = map * self.weighted;
        forces[first] -= pulled.x_axis + pulled.y_axis;
        forces[second] += pulled.x_axis;
        forces[third] += pulled.y_axis;
    }
}

/// Returns the sides of a face whose first side points along x; `length` is the length of that
/// side.
fn sides([first, ..]: &[CornerProducts; 3], length: f64) -> [DVec2; 3] {
    let along = DVec2::new(length, 0.0);
    let to_third = DVec2::new(first.dot, first.cross) / length;
    [along, to_third - along, -to_third]
}

/// Returns the length of the first side. Its square is the sum of the dot products at both ends.
fn first_length([first, second, _]: &[CornerProducts; 3]) -> f64 {
    (first.dot + second.dot).sqrt()
}

/// Computes the linear map of each face from the source to its flattened shape. The first face has
/// its first side along x.
pub(super) fn laid_out(
    sheet: &FaceSheet,
    faces: &[BoundedFace],
    corners: &[[CornerProducts; 3]],
    maps: &mut [DMat2],
) {
    // First, the vectors from the first corner of each face to the second and the third.
    for k in 0..faces.len() {
        let own = sides(&corners[k], first_length(&corners[k]));
        let turn = match k {
            0 => DVec2::X,
            _ => {
                let reached = sheet.reached[k];
                let before = maps[reached.from as usize];
                let there = [before.x_axis, before.y_axis - before.x_axis, -before.y_axis];
                // The side shared with the earlier face, traversed in the direction of this face.
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

/// Rotates the linear maps of all faces by one angle, such that on average they rotate as in the
/// polar homotopy.
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

/// Returns the rotation of a linear map, as a unit vector.
fn rotation(map: DMat2) -> DVec2 {
    let (x, y) = (map.x_axis, map.y_axis);
    DVec2::new(x.x + y.y, x.y - y.x).normalize_or(DVec2::X)
}

fn conjugate(z: DVec2) -> DVec2 {
    DVec2::new(z.x, -z.y)
}
