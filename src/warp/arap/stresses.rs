//! The right-hand side of a frame: Σ (M(t) − M_linear(t)) W g.
//!
//! Four faces at a time, in the layout that the loop reads; what can be
//! computed from little is not stored, since a frame of a large mesh is bound
//! by memory. Where M_linear(1) is needed it is computed by the operations of
//! M(1) itself, so that the difference is exactly zero at both ends.
//! [`crate::homotopy::Homotopy::at`] is the plain form of the same formulas,
//! and the tests hold the two together.

use super::assembly::{ElementMap, FaceMap, LocalMaps};
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
    /// Exponential only: the logarithms of both stretches of each block.
    logs: Vec<[f64x4; 2]>,
    elements: Vec<Element>,
}

/// Four faces.
#[derive(Clone, Debug)]
struct Block {
    angle: f64x4,
    /// Sine and cosine of the angle.
    turn: [f64x4; 2],
    /// W g for the second and third corner.
    weighted: Mat4,
    /// A symmetric matrix that acts on W g, as xx, xy, yy. Polar: the stretch.
    /// Exponential: the projection onto its larger axis.
    middle: [f64x4; 3],
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

/// The path of the stretch is `one` I + `middle` times the middle matrix.
#[derive(Clone, Copy)]
struct Mix {
    one: f64x4,
    middle: f64x4,
}

impl Mix {
    /// (1−t) I + t S.
    fn linear(t: f64) -> Self {
        Self {
            one: f64x4::splat(1.0 - t),
            middle: f64x4::splat(t),
        }
    }

    /// exp(t log S) = λ₂ᵗ I + (λ₁ᵗ − λ₂ᵗ) u uᵀ with u the larger axis.
    fn exponential(t: f64, logs: &[f64x4; 2]) -> Self {
        let [large, small] = logs.map(|log| (f64x4::splat(t) * log).exp());
        Self {
            one: small,
            middle: large - small,
        }
    }
}

impl Stresses {
    pub(super) fn new(
        mesh: &CompatibleMesh,
        maps: &LocalMaps,
        place: &[u32],
        homotopy: Homotopy,
    ) -> Self {
        let mut blocks = Vec::with_capacity(maps.faces.len().div_ceil(4));
        let mut logs = Vec::new();
        for (i, four) in maps.faces.chunks(4).enumerate() {
            let corners = four.iter().enumerate().map(|(lane, _)| {
                let face = mesh.faces()[4 * i + lane];
                face.map(|v| place[v as usize])
            });
            blocks.push(Block::new(four, corners, homotopy));
            if homotopy == Homotopy::Exponential {
                logs.push(gather(four, |face| {
                    SymmetricEigen::of(face.map.stretch).values.map(f64::ln)
                }));
            }
        }
        let elements = maps.elements.iter().map(|&map| Element {
            places: map.ends.map(|v| place[v as usize]),
            map,
        });
        Self {
            homotopy,
            blocks,
            logs,
            elements: elements.collect(),
        }
    }

    /// Writes both right-hand sides, all x and then all y, in elimination
    /// order.
    pub(super) fn right_hand_sides(&self, t: f64, rhs: &mut [f64]) {
        rhs.fill(0.0);
        let (x, y) = rhs.split_at_mut(rhs.len() / 2);
        let (now, end) = (Mix::linear(t), Mix::linear(1.0));
        match self.homotopy {
            Homotopy::Linear => {}
            Homotopy::Polar => {
                for block in &self.blocks {
                    block.add(t, (f64x4::splat(t) * block.angle).sin_cos(), now, end, x, y);
                }
            }
            Homotopy::LinearAfterPolar => {
                for block in &self.blocks {
                    let [sin, cos] = block.turn;
                    let chord = (now.middle * sin, now.one + now.middle * cos);
                    block.add(t, chord, now, end, x, y);
                }
            }
            Homotopy::Exponential => {
                for (block, logs) in self.blocks.iter().zip(&self.logs) {
                    let [now, end] = [t, 1.0].map(|t| Mix::exponential(t, logs));
                    block.add(t, (f64x4::splat(t) * block.angle).sin_cos(), now, end, x, y);
                }
            }
        }
        for element in &self.elements {
            element.add(self.homotopy, t, x, y);
        }
    }
}

impl Block {
    fn new(faces: &[FaceMap], places: impl Iterator<Item = [u32; 3]>, homotopy: Homotopy) -> Self {
        // Lanes without a face keep zeros, which add nothing anywhere.
        let mut corners = [[0; 4]; 3];
        for (lane, place) in places.enumerate() {
            for (corner, at) in corners.iter_mut().zip(place) {
                corner[lane] = at;
            }
        }
        let [angle] = gather(faces, |face| [face.map.angle]);
        let (sin, cos) = angle.sin_cos();
        Self {
            angle,
            turn: [sin, cos],
            weighted: gather(faces, |face| face.weighted.to_cols_array()),
            middle: gather(faces, |face| {
                let axis = SymmetricEigen::of(face.map.stretch).axis;
                let [xx, xy, _, yy] = match homotopy {
                    Homotopy::Exponential => DMat2::from_cols(axis * axis.x, axis * axis.y),
                    _ => face.map.stretch,
                }
                .to_cols_array();
                [xx, xy, yy]
            }),
            corners,
        }
    }

    /// R S(t) W g, by the sine and cosine of R and the mix of the stretch.
    #[inline(always)]
    fn posed(&self, (sin, cos): (f64x4, f64x4), mix: Mix) -> Mat4 {
        let [x2, y2, x3, y3] = self.weighted;
        let [xx, xy, yy] = self.middle;
        let stretched = |x: f64x4, y: f64x4| {
            (
                mix.one * x + mix.middle * (xx * x + xy * y),
                mix.one * y + mix.middle * (xy * x + yy * y),
            )
        };
        let ((x2, y2), (x3, y3)) = (stretched(x2, y2), stretched(x3, y3));
        [
            cos * x2 - sin * y2,
            sin * x2 + cos * y2,
            cos * x3 - sin * y3,
            sin * x3 + cos * y3,
        ]
    }

    /// Adds (M(t) − M_linear(t)) W g at the corners.
    #[inline(always)]
    fn add(&self, t: f64, turn: (f64x4, f64x4), now: Mix, end: Mix, x: &mut [f64], y: &mut [f64]) {
        let (keep, t) = (f64x4::splat(1.0 - t), f64x4::splat(t));
        let posed = self.posed(turn, now);
        let [sin, cos] = self.turn;
        let whole = self.posed((sin, cos), end);
        let [x2, y2, x3, y3] = std::array::from_fn(|k| {
            (posed[k] - (keep * self.weighted[k] + t * whole[k])).to_array()
        });
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

/// Numbers of up to four faces side by side; zeros where there is no face.
fn gather<const N: usize>(faces: &[FaceMap], of: impl Fn(&FaceMap) -> [f64; N]) -> [f64x4; N] {
    let mut lanes = [[0.0; 4]; N];
    for (lane, face) in faces.iter().enumerate() {
        for (row, value) in lanes.iter_mut().zip(of(face)) {
            row[lane] = value;
        }
    }
    lanes.map(f64x4::from)
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
