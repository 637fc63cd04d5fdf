//! The right-hand side of a frame: Σ (M(t) − M_linear(t)) W g.
//!
//! M_linear(t) is (1−t) M(0) + t M(1), so that its sum over the faces of a
//! vertex is on the straight line between the sums of M(0) and of M(1), which
//! are kept. They were computed by the operations of every other frame, so
//! that the difference is exactly zero at both ends.
//!
//! Many faces at a time, in the layout that the loop reads; what can be
//! computed from little is not stored, since a frame of a large mesh is bound
//! by memory. The loop is compiled for several widths of vectors and one is
//! chosen at run time; the results are the same for all of them.
//! [`crate::warp::homotopy::Homotopy::at`] is the plain form of the same formulas,
//! and the tests hold the two together. Maps that are not each on its own come from
//! [`Bounded`].

use super::assembly::{ElementMap, FaceMap, LocalMaps};
use super::bounded::{Bounded, Memory};
use super::evaluation_times::EvaluationTimes;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2, PolarDecomposition, SymmetricEigen};
use crate::warp::elementary::{exp, sin_cos};
use crate::warp::homotopy::Homotopy;
use pulp::{Arch, Simd, WithSimd};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// How many faces there are in a block: a row is a line of the cache, and
/// blocks are read from memory faster than those of 16.
const LANES: usize = 8;

/// What an element may be as a share of its even length. An edge of an outline that points
/// backwards opens a fan the other way: area runs up and down by 0.19 in a shoe that becomes
/// a fly.
const SHARES: RangeInclusive<f64> = 0.1..=2.0;

/// A number of each face of a block; zero where there is no face.
type FaceLanes = [f64; LANES];

/// Everything that a right-hand side needs, prepared.
#[derive(Clone, Debug)]
pub(super) struct ForceAssembly {
    homotopy: Homotopy,
    arch: Arch,
    faces: Arc<[[u32; 3]]>,
    blocks: Vec<FaceBlock>,
    /// Exponential only: the logarithms of both stretches of each block.
    logs: Vec<[FaceLanes; 2]>,
    elements: Vec<ElementMap>,
    /// How long each of them is halfway, as a share of its even length.
    halfway: Vec<f64>,
    /// Bounded only: what gives the maps of all faces together.
    bounded: Option<Arc<Bounded>>,
    /// Σ M(0) W g and Σ M(1) W g of each vertex.
    ends: Vec<[DVec2; 2]>,
}

/// The local maps of so many faces.
#[derive(Clone, Debug)]
struct FaceBlock {
    angle: FaceLanes,
    /// W g for the second and third corner, column by column.
    weighted: [FaceLanes; 4],
    /// A matrix that acts on W g, column by column. Polar: the stretch.
    /// Exponential: the projection onto its larger axis.
    middle: [FaceLanes; 4],
}

/// A map on its path: the rotation by its sine and cosine, and the stretch as
/// `one` I + `middle` times the middle matrix.
#[derive(Clone, Copy)]
struct MapCoefficients {
    sin: f64,
    cos: f64,
    one: f64,
    middle: f64,
}

impl MapCoefficients {
    /// R(tθ) ((1−t) I + t S).
    #[inline(always)]
    fn polar(t: f64, angle: f64) -> Self {
        let (sin, cos) = sin_cos(t * angle);
        Self {
            sin,
            cos,
            one: 1.0 - t,
            middle: t,
        }
    }

    /// ((1−t) I + t R(θ)) ((1−t) I + t S).
    #[inline(always)]
    fn linear_after_polar(t: f64, angle: f64) -> Self {
        let (sin, cos) = sin_cos(angle);
        Self {
            sin: t * sin,
            cos: (1.0 - t) + t * cos,
            one: 1.0 - t,
            middle: t,
        }
    }

    /// R(tθ) exp(t log S), which is λ₂ᵗ I + (λ₁ᵗ − λ₂ᵗ) u uᵀ with u the larger
    /// axis.
    #[inline(always)]
    fn exponential(t: f64, angle: f64, [large, small]: [f64; 2]) -> Self {
        let (sin, cos) = sin_cos(t * angle);
        let [large, small] = [exp(t * large), exp(t * small)];
        Self {
            sin,
            cos,
            one: small,
            middle: large - small,
        }
    }

    /// The map of a vector, given the middle matrix.
    #[inline(always)]
    fn apply(self, [xx, yx, xy, yy]: [f64; 4], x: f64, y: f64) -> DVec2 {
        let stretched_x = self.one * x + self.middle * (xx * x + xy * y);
        let stretched_y = self.one * y + self.middle * (yx * x + yy * y);
        DVec2::new(
            self.cos * stretched_x - self.sin * stretched_y,
            self.sin * stretched_x + self.cos * stretched_y,
        )
    }
}

impl ForceAssembly {
    pub(super) fn new(mesh: &CompatibleMesh, maps: &LocalMaps, homotopy: Homotopy) -> Self {
        let blocks = maps.faces.chunks(LANES);
        let logs = if homotopy == Homotopy::Exponential {
            let of = |face: &FaceMap| SymmetricEigen::of(face.map.stretch).values.map(f64::ln);
            blocks.clone().map(|faces| rows(faces, of)).collect()
        } else {
            Vec::new()
        };
        let mut stresses = Self {
            homotopy,
            arch: Arch::new(),
            faces: Arc::clone(mesh.faces()),
            blocks: blocks
                .map(|faces| FaceBlock::new(faces, homotopy))
                .collect(),
            logs,
            elements: maps.elements.clone(),
            halfway: vec![1.0; maps.elements.len()],
            bounded: (homotopy == Homotopy::Bounded).then(|| Arc::new(Bounded::new(mesh, maps))),
            ends: Vec::new(),
        };
        let mut memory = stresses.memory();
        // By the very operations of a frame: see above.
        let [begin, end] = [0.0, 1.0].map(|t| {
            let mut forces = vec![DVec2::ZERO; mesh.source().len()];
            stresses.forces(EvaluationTimes::Even(t), &mut memory, &mut forces);
            forces
        });
        stresses.ends = begin.into_iter().zip(end).map(<[DVec2; 2]>::from).collect();
        stresses
    }

    /// Bars, then edges of outlines.
    pub(super) fn elements(&self) -> &[ElementMap] {
        &self.elements
    }

    /// Makes an element so long halfway, as a share of its even length.
    pub(super) fn set_halfway(&mut self, element: usize, share: f64) {
        self.halfway[element] = share.clamp(*SHARES.start(), *SHARES.end());
    }

    /// What a frame takes to work in.
    pub(super) fn memory(&self) -> Memory {
        let bounded = self.bounded.as_deref();
        bounded.map_or_else(Memory::default, Bounded::memory)
    }

    /// What gives the maps of all faces together, where they are not each on its own.
    pub(super) fn bounded(&self) -> Option<&Bounded> {
        self.bounded.as_deref()
    }

    /// Writes both right-hand sides, all x and then all y, with vertex v at
    /// `place[v]`. `forces`, one for each vertex, is memory to work in.
    pub(super) fn right_hand_sides(
        &self,
        times: EvaluationTimes,
        place: &[u32],
        (memory, forces): (&mut Memory, &mut [DVec2]),
        rhs: &mut [f64],
    ) {
        self.forces(times, memory, forces);
        let (x, y) = rhs.split_at_mut(rhs.len() / 2);
        let ends = self.ends.iter().enumerate();
        for ((&force, (vertex, &[begin, end])), &at) in forces.iter().zip(ends).zip(place) {
            let t = times.of_vertex(vertex);
            let pull = force - (begin * (1.0 - t) + end * t);
            x[at as usize] = pull.x;
            y[at as usize] = pull.y;
        }
    }

    /// Σ M(t) W g of each vertex; zero for the linear path, which deviates
    /// from no straight line.
    fn forces(&self, times: EvaluationTimes, memory: &mut Memory, forces: &mut [DVec2]) {
        forces.fill(DVec2::ZERO);
        match &self.bounded {
            Some(bounded) => bounded.add(times, memory, forces),
            None => self.arch.dispatch(FacePass(self, times, &mut *forces)),
        }
        // Bars and edges are few beside faces, and take the plain form.
        if self.homotopy != Homotopy::Linear {
            for (element, &halfway) in self.elements.iter().zip(&self.halfway) {
                let t = times.of_vertex(element.ends[0] as usize);
                element.add(self.homotopy, (t, halfway), forces);
            }
        }
    }

    /// Adds the forces of all faces, with more of each block for its pose. `time`
    /// says when each lane of a block is.
    #[inline(always)]
    fn add<More>(
        &self,
        forces: &mut [DVec2],
        more: impl Iterator<Item = More>,
        time: impl Fn(&[[u32; 3]]) -> FaceLanes,
        pose: impl Fn(f64, f64, &More, usize) -> MapCoefficients,
    ) {
        let faces = self.faces.chunks(LANES);
        for ((block, more), faces) in self.blocks.iter().zip(more).zip(faces) {
            let times = time(faces);
            let posed = block.posed(|lane| pose(times[lane], block.angle[lane], &more, lane));
            scatter(&posed, faces, forces);
        }
    }

    #[inline(always)]
    fn pass(&self, forces: &mut [DVec2], time: impl Fn(&[[u32; 3]]) -> FaceLanes) {
        let none = std::iter::repeat(());
        match self.homotopy {
            Homotopy::Linear | Homotopy::Bounded => {}
            Homotopy::Polar => {
                self.add(forces, none, time, |t, angle, _, _| {
                    MapCoefficients::polar(t, angle)
                });
            }
            Homotopy::LinearAfterPolar => self.add(forces, none, time, |t, angle, _, _| {
                MapCoefficients::linear_after_polar(t, angle)
            }),
            Homotopy::Exponential => {
                self.add(forces, self.logs.iter(), time, |t, angle, logs, lane| {
                    MapCoefficients::exponential(t, angle, logs.each_ref().map(|row| row[lane]))
                });
            }
        }
    }
}

/// One pass over all faces that adds their forces, to be compiled for several
/// widths of vectors.
struct FacePass<'a>(&'a ForceAssembly, EvaluationTimes<'a>, &'a mut [DVec2]);

impl WithSimd for FacePass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(stresses, times, forces) = self;
        match times {
            EvaluationTimes::Even(t) => stresses.pass(forces, |_| [t; LANES]),
            // A face is all in one part.
            EvaluationTimes::OfParts { vertices, .. } => stresses.pass(forces, |faces| {
                let mut row = [0.0; LANES];
                for (t, face) in row.iter_mut().zip(faces) {
                    *t = vertices[face[0] as usize];
                }
                row
            }),
        }
    }
}

impl FaceBlock {
    fn new(faces: &[FaceMap], homotopy: Homotopy) -> Self {
        let [angle] = rows(faces, |face| [face.map.angle]);
        Self {
            angle,
            weighted: rows(faces, |face| face.weighted.to_cols_array()),
            middle: rows(faces, |face| {
                // u uᵀ of the larger axis u: exp(t log S) is a sum of it and I.
                let axis = SymmetricEigen::of(face.map.stretch).axis;
                match homotopy {
                    Homotopy::Exponential => DMat2::from_cols(axis * axis.x, axis * axis.y),
                    _ => face.map.stretch,
                }
                .to_cols_array()
            }),
        }
    }

    /// M(t) W g for the second and third corner, column by column.
    #[inline(always)]
    fn posed(&self, pose: impl Fn(usize) -> MapCoefficients) -> [FaceLanes; 4] {
        let mut posed = [[0.0; LANES]; 4];
        (0..LANES).for_each(|lane| {
            let pose = pose(lane);
            let middle = self.middle.each_ref().map(|row| row[lane]);
            let [x2, y2, x3, y3] = self.weighted.each_ref().map(|row| row[lane]);
            let second = pose.apply(middle, x2, y2);
            let third = pose.apply(middle, x3, y3);
            posed[0][lane] = second.x;
            posed[1][lane] = second.y;
            posed[2][lane] = third.x;
            posed[3][lane] = third.y;
        });
        posed
    }
}

/// Adds what was computed for the second and third corner to them, and takes
/// it from the first.
#[inline(always)]
fn scatter([x2, y2, x3, y3]: &[FaceLanes; 4], faces: &[[u32; 3]], forces: &mut [DVec2]) {
    for (lane, face) in (0..LANES).zip(faces) {
        let [first, second, third] = face.map(|v| v as usize);
        let to_second = DVec2::new(x2[lane], y2[lane]);
        let to_third = DVec2::new(x3[lane], y3[lane]);
        forces[first] -= to_second + to_third;
        forces[second] += to_second;
        forces[third] += to_third;
    }
}

/// Numbers of the faces of a block side by side.
fn rows<const N: usize>(faces: &[FaceMap], of: impl Fn(&FaceMap) -> [f64; N]) -> [FaceLanes; N] {
    let mut rows = [[0.0; LANES]; N];
    for (lane, face) in faces.iter().enumerate() {
        for (row, value) in rows.iter_mut().zip(of(face)) {
            row[lane] = value;
        }
    }
    rows
}

impl ElementMap {
    /// Its vector at t where it turns and grows evenly.
    pub(super) fn even(&self, homotopy: Homotopy, t: f64) -> DVec2 {
        let map = PolarDecomposition {
            angle: self.angle,
            stretch: DMat2::IDENTITY * self.stretch,
        };
        homotopy.at(&map, t) * self.vector
    }

    /// Adds the pull of its vector at t, given its length halfway.
    fn add(&self, homotopy: Homotopy, (t, halfway): (f64, f64), forces: &mut [DVec2]) {
        // By a parabola that is zero at both ends, and goes on beyond them.
        let share = 1.0 + (halfway - 1.0) * (4.0 * t * (1.0 - t));
        let share = share.clamp(*SHARES.start(), *SHARES.end());
        let pull = self.even(homotopy, t) * (self.stiffness * share);
        let [from, to] = self.ends.map(|v| v as usize);
        forces[from] -= pull;
        forces[to] += pull;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::ArapOptions;

    #[test]
    fn every_width_of_vectors_gives_the_same_bits() -> Result<(), Box<dyn std::error::Error>> {
        let source: Vec<_> = (0..30)
            .map(|i| DVec2::new(f64::from(i / 2), f64::from(i % 2)))
            .collect();
        let bent = |p: &DVec2| DVec2::from_angle(0.3 * p.x) * (7.0 - p.y - 0.01 * p.x * p.x);
        let target = source.iter().map(bent).collect();
        let faces = (0..14_u32).flat_map(|i| {
            let v = 2 * i;
            [[v, v + 2, v + 3], [v, v + 3, v + 1]] // 28: three blocks and a half
        });
        let mesh = CompatibleMesh::new(faces.collect(), source, target, vec![])?;
        let maps = LocalMaps::new(&mesh, &ArapOptions::default(), &[])?;
        for homotopy in Homotopy::ALL {
            let chosen = ForceAssembly::new(&mesh, &maps, homotopy);
            let plain = ForceAssembly {
                arch: Arch::Scalar,
                ..chosen.clone()
            };
            for t in [-0.3, 0.0, 0.31, 0.77, 1.0] {
                let [chosen, plain] = [&chosen, &plain].map(|stresses| {
                    let mut forces = vec![DVec2::ZERO; 30];
                    stresses.forces(
                        EvaluationTimes::Even(t),
                        &mut stresses.memory(),
                        &mut forces,
                    );
                    forces
                });
                assert_eq!(chosen, plain, "{homotopy:?} at {t}");
            }
        }
        Ok(())
    }
}
