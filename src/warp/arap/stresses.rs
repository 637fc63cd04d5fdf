//! The right-hand side of a frame: Σ (M(t) − M_linear(t)) W g.
//!
//! Four faces at a time, in the layout that the loop reads. Each face keeps
//! its angle θ and three 2×2 matrices, A and B of which W g is turned and
//! mixed, and C, where that ends at t = 1. C is computed by the very
//! operations of a frame, so that the difference is exactly zero at both
//! ends. [`crate::homotopy::Homotopy::at`] is the plain form of the same
//! formulas, and the tests hold the two together.

use super::assembly::{ElementMap, LocalMaps};
use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2, SymmetricEigen};
use crate::homotopy::{Homotopy, LocalMap};
use wide::f64x4;

/// 2×2 matrices of four faces, column by column.
type Mat4 = [f64x4; 4];

/// Everything that a right-hand side needs, prepared.
#[derive(Clone, Debug)]
pub(super) struct Stresses {
    homotopy: Homotopy,
    blocks: Vec<Block>,
    elements: Vec<Element>,
}

#[derive(Clone, Debug)]
struct Block {
    angle: f64x4,
    /// Polar: W g. Exponential: its part along the larger stretch.
    a: Mat4,
    /// Polar: S W g. Exponential: its part along the smaller stretch.
    b: Mat4,
    /// R(θ) S W g.
    c: Mat4,
    /// Exponential: the logarithms of both stretches.
    logs: [f64x4; 2],
    /// Places of the corners in elimination order, corner by corner.
    corners: [[u32; 4]; 3],
}

/// A bar in no face.
#[derive(Clone, Debug)]
struct Element {
    map: ElementMap,
    /// Places of its ends in elimination order.
    places: [u32; 2],
}

impl Stresses {
    pub(super) fn new(
        mesh: &CompatibleMesh,
        maps: &LocalMaps,
        place: &[u32],
        homotopy: Homotopy,
    ) -> Self {
        let faces: Vec<usize> = (0..maps.faces.len()).collect();
        let blocks = faces
            .chunks(4)
            .map(|four| Block::new(four, mesh, maps, place, homotopy))
            .collect();
        let elements = maps
            .elements
            .iter()
            .map(|&map| Element {
                places: map.ends.map(|v| place[v as usize]),
                map,
            })
            .collect();
        Self {
            homotopy,
            blocks,
            elements,
        }
    }

    /// Writes both right-hand sides, all x and then all y, in elimination
    /// order.
    pub(super) fn right_hand_sides(&self, t: f64, rhs: &mut [f64]) {
        rhs.fill(0.0);
        let (x, y) = rhs.split_at_mut(rhs.len() / 2);
        for block in &self.blocks {
            block.add(self.homotopy, t, x, y);
        }
        for element in &self.elements {
            element.add(self.homotopy, t, x, y);
        }
    }
}

impl Block {
    fn new(
        faces: &[usize],
        mesh: &CompatibleMesh,
        maps: &LocalMaps,
        place: &[u32],
        homotopy: Homotopy,
    ) -> Self {
        // Lanes without a face keep zeros, which add nothing anywhere.
        let mut lanes = [Lane::default(); 4];
        let mut corners = [[0; 4]; 3];
        for (lane, &f) in faces.iter().enumerate() {
            let face = &maps.faces[f];
            lanes[lane] = Lane::new(&face.map, face.weighted, homotopy);
            for (corner, &v) in corners.iter_mut().zip(&mesh.faces()[f]) {
                corner[lane] = place[v as usize];
            }
        }
        let gather = |of: fn(&Lane) -> f64| f64x4::from(lanes.each_ref().map(of));
        let mut block = Self {
            angle: gather(|l| l.angle),
            a: gather_matrix(&lanes, |l| l.a),
            b: gather_matrix(&lanes, |l| l.b),
            c: [f64x4::ZERO; 4],
            logs: [gather(|l| l.logs[0]), gather(|l| l.logs[1])],
            corners,
        };
        block.c = block.posed(homotopy, 1.0);
        block
    }

    /// M(t) W g.
    #[inline(always)]
    fn posed(&self, homotopy: Homotopy, t: f64) -> Mat4 {
        let (keep, t4) = (f64x4::splat(1.0 - t), f64x4::splat(t));
        let (sin, cos) = match homotopy {
            Homotopy::LinearAfterPolar => {
                let (sin, cos) = self.angle.sin_cos();
                (t4 * sin, keep + t4 * cos)
            }
            _ => (t4 * self.angle).sin_cos(),
        };
        let (from, to) = match homotopy {
            Homotopy::Exponential => ((t4 * self.logs[0]).exp(), (t4 * self.logs[1]).exp()),
            _ => (keep, t4),
        };
        let mixed: Mat4 = std::array::from_fn(|k| from * self.a[k] + to * self.b[k]);
        let [x2, y2, x3, y3] = mixed;
        [
            cos * x2 - sin * y2,
            sin * x2 + cos * y2,
            cos * x3 - sin * y3,
            sin * x3 + cos * y3,
        ]
    }

    /// M_linear(t) W g.
    #[inline(always)]
    fn straight(&self, homotopy: Homotopy, t: f64) -> Mat4 {
        let (keep, t4) = (f64x4::splat(1.0 - t), f64x4::splat(t));
        std::array::from_fn(|k| {
            let begin = match homotopy {
                Homotopy::Exponential => self.a[k] + self.b[k],
                _ => self.a[k],
            };
            keep * begin + t4 * self.c[k]
        })
    }

    #[inline(always)]
    fn add(&self, homotopy: Homotopy, t: f64, x: &mut [f64], y: &mut [f64]) {
        let posed = self.posed(homotopy, t);
        let straight = self.straight(homotopy, t);
        let [x2, y2, x3, y3] = std::array::from_fn(|k| (posed[k] - straight[k]).to_array());
        for lane in 0..4 {
            let [first, second, third] = self.corners.map(|corner| corner[lane] as usize);
            x[first] -= x2[lane] + x3[lane];
            y[first] -= y2[lane] + y3[lane];
            x[second] += x2[lane];
            y[second] += y2[lane];
            x[third] += x3[lane];
            y[third] += y3[lane];
        }
    }
}

/// One face's part of a block.
#[derive(Clone, Copy, Default)]
struct Lane {
    angle: f64,
    a: DMat2,
    b: DMat2,
    logs: [f64; 2],
}

impl Lane {
    fn new(map: &LocalMap, weighted: DMat2, homotopy: Homotopy) -> Self {
        let angle = map.angle;
        if homotopy != Homotopy::Exponential {
            return Self {
                angle,
                a: weighted,
                b: map.stretch * weighted,
                logs: [0.0; 2],
            };
        }
        let eigen = SymmetricEigen::of(map.stretch);
        let along = |axis: DVec2| DMat2::from_cols(axis * axis.x, axis * axis.y) * weighted;
        Self {
            angle,
            a: along(eigen.axis),
            b: along(eigen.axis.perp()),
            logs: eigen.values.map(f64::ln),
        }
    }
}

fn gather_matrix(lanes: &[Lane; 4], of: fn(&Lane) -> DMat2) -> Mat4 {
    let columns = lanes.each_ref().map(|lane| of(lane).to_cols_array());
    std::array::from_fn(|k| f64x4::from(columns.map(|c| c[k])))
}

impl Element {
    /// The bar's vector at t.
    fn posed(&self, homotopy: Homotopy, t: f64) -> DVec2 {
        let map = LocalMap {
            angle: self.map.angle,
            stretch: DMat2::IDENTITY * self.map.stretch,
        };
        homotopy.at(&map, t) * self.map.vector
    }

    fn add(&self, homotopy: Homotopy, t: f64, x: &mut [f64], y: &mut [f64]) {
        let straight = self.posed(homotopy, 0.0) * (1.0 - t) + self.posed(homotopy, 1.0) * t;
        let pull = (self.posed(homotopy, t) - straight) * self.map.stiffness;
        let [from, to] = self.places.map(|place| place as usize);
        x[from] -= pull.x;
        y[from] -= pull.y;
        x[to] += pull.x;
        y[to] += pull.y;
    }
}
