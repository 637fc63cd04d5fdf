//! Vectorised right-hand sides at one t. The linear system for the deviations of the vertices has
//! the right-hand sides Σ (M(t) − M_linear(t)) W g, in the notation of the parent module. The
//! sum Σ M(t) W g at a vertex is called the force on the vertex.
//!
//! M_linear(t) = (1−t) M(0) + t M(1). The sum Σ M_linear(t) W g at a vertex is therefore
//! interpolated between Σ M(0) W g and Σ M(1) W g, which are precomputed. These two sums are
//! computed with the same operations as Σ M(t) W g for any other t, so that the right-hand sides
//! are exactly zero at t = 0 and t = 1.
//!
//! Faces are stored and processed in blocks, so that the loop reads memory in order. Quantities
//! that are cheap to compute are not stored, because evaluation is limited by memory bandwidth for
//! large meshes. The loop is compiled for several vector widths, with identical results, and one is
//! chosen at run time. [`crate::warp::homotopy::Homotopy::at`] evaluates the same formulas for a
//! single matrix; the tests compare the two. Local maps with bounded distortion depend on all faces
//! and are computed by [`Bounded`].

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

/// Number of faces in a block (derived: a row of eight numbers is one cache line).
const LANES: usize = 8;

/// Permitted length of a boundary edge relative to its linearly interpolated length (heuristic).
/// The lower bound is positive, because an edge of negative length would point backwards.
const LENGTH_RATIOS: RangeInclusive<f64> = 0.1..=2.0;

/// One number per face of a block; zero beyond the last face.
type FaceLanes = [f64; LANES];

/// Precomputed data of the right-hand sides of the linear system.
#[derive(Clone, Debug)]
pub(super) struct ForceAssembly {
    homotopy: Homotopy,
    arch: Arch,
    faces: Arc<[[u32; 3]]>,
    blocks: Vec<FaceBlock>,
    /// For each block, the logarithms of the larger and of the smaller eigenvalue of each face's
    /// stretch; empty unless the homotopy is exponential.
    logs: Vec<[FaceLanes; 2]>,
    elements: Vec<ElementMap>,
    /// Length of each bar or boundary edge at t = ½, relative to its linearly interpolated length.
    halfway_lengths: Vec<f64>,
    /// Computation of the local maps with bounded distortion, if the homotopy requires it.
    bounded: Option<Arc<Bounded>>,
    /// For each vertex, the sum Σ M(t) W g (in the notation of the module) at t = 0 and t = 1.
    ends: Vec<[DVec2; 2]>,
}

/// Local maps of [`LANES`] faces.
#[derive(Clone, Debug)]
struct FaceBlock {
    /// Rotation angle of each face, in radians.
    angle: FaceLanes,
    /// For each face, the hat-function gradients of the second and third corner, multiplied by the
    /// face's weight matrix; column by column. Multiplied by M(t), they give the face's share of
    /// the right-hand sides.
    weighted: [FaceLanes; 4],
    /// For each face, the matrix B from which [`MapCoefficients`] builds M(t), column by column. B
    /// is the projection onto the larger axis of the stretch for the exponential homotopy, and the
    /// stretch itself otherwise.
    middle: [FaceLanes; 4],
}

/// Coefficients of M(t), the product of a rotation and a stretch. The rotation is given by its sine
/// and cosine. The stretch is `one` · I + `middle` · B, with the matrix B of [`FaceBlock::middle`].
#[derive(Clone, Copy)]
struct MapCoefficients {
    sin: f64,
    cos: f64,
    one: f64,
    middle: f64,
}

impl MapCoefficients {
    /// Coefficients of the polar homotopy R(tθ) ((1−t) I + t S), with the rotation angle θ and the
    /// stretch S.
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

    /// Coefficients of the linear interpolation of both polar factors,
    /// ((1−t) I + t R(θ)) ((1−t) I + t S), with the rotation angle θ and the stretch S.
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

    /// Coefficients of the exponential homotopy R(tθ) exp(t log S), with the rotation angle θ and
    /// the stretch S. The third parameter holds log λ₁ and log λ₂, where λ₁ ≥ λ₂ are the
    /// eigenvalues of S.
    ///
    /// With the unit eigenvector u of λ₁, exp(t log S) = λ₂ᵗ I + (λ₁ᵗ − λ₂ᵗ) u uᵀ. The matrix I is
    /// multiplied by `one` = λ₂ᵗ, and the matrix u uᵀ by `middle` = λ₁ᵗ − λ₂ᵗ.
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

    /// Returns the product of the matrix M(t) and the vector (x, y). The array argument holds the
    /// matrix B of [`FaceBlock::middle`], column by column.
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
    /// Precomputes the blocks of faces and, for each vertex, the sum Σ M(t) W g at t = 0 and t = 1,
    /// in the notation of the module.
    pub(super) fn new(mesh: &CompatibleMesh, maps: &LocalMaps, homotopy: Homotopy) -> Self {
        let blocks = maps.faces.chunks(LANES);
        let logs = if homotopy == Homotopy::Exponential {
            let logs = |face: &FaceMap| SymmetricEigen::of(face.map.stretch).values.map(f64::ln);
            blocks.clone().map(|faces| rows(faces, logs)).collect()
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
            halfway_lengths: vec![1.0; maps.elements.len()],
            bounded: (homotopy == Homotopy::Bounded).then(|| Arc::new(Bounded::new(mesh, maps))),
            ends: Vec::new(),
        };
        let mut memory = stresses.memory();
        // The sums Σ M(t) W g at t = 0 and t = 1 are computed with the same operations as for any
        // other t, so that the right-hand sides are exactly zero at these two times.
        let [begin, end] = [0.0, 1.0].map(|t| {
            let mut forces = vec![DVec2::ZERO; mesh.source().len()];
            stresses.forces(EvaluationTimes::Uniform(t), &mut memory, &mut forces);
            forces
        });
        stresses.ends = begin.into_iter().zip(end).map(<[DVec2; 2]>::from).collect();
        stresses
    }

    /// Returns the elements: the bars, then the boundary edges.
    pub(super) fn elements(&self) -> &[ElementMap] {
        &self.elements
    }

    /// Sets the length of a bar or boundary edge at t = ½, relative to its linearly interpolated
    /// length. The ratio is clamped to [`LENGTH_RATIOS`].
    pub(super) fn set_halfway_length(&mut self, element: usize, ratio: f64) {
        self.halfway_lengths[element] = ratio.clamp(*LENGTH_RATIOS.start(), *LENGTH_RATIOS.end());
    }

    /// Allocates the working memory for the local maps with bounded distortion; it is empty for
    /// other homotopies.
    pub(super) fn memory(&self) -> Memory {
        let bounded = self.bounded.as_deref();
        bounded.map_or_else(Memory::default, Bounded::memory)
    }

    /// Returns the computation of local maps with bounded distortion, if the homotopy requires it.
    pub(super) fn bounded(&self) -> Option<&Bounded> {
        self.bounded.as_deref()
    }

    /// Writes the right-hand sides for x and for y to `rhs`: first all x, then all y, with the
    /// entry of vertex v at index `place[v]`.
    ///
    /// `forces` is working memory with one entry per vertex.
    pub(super) fn right_hand_sides(
        &self,
        times: EvaluationTimes,
        place: &[u32],
        memory: &mut Memory,
        forces: &mut [DVec2],
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

    /// Computes the sum Σ M(t) W g of each vertex, in the notation of the module.
    ///
    /// For the linear homotopy all sums are set to zero, because they would cancel in the
    /// right-hand sides at every t.
    fn forces(&self, times: EvaluationTimes, memory: &mut Memory, forces: &mut [DVec2]) {
        forces.fill(DVec2::ZERO);
        match &self.bounded {
            Some(bounded) => bounded.add(times, memory, forces),
            None => self.arch.dispatch(FacePass(self, times, &mut *forces)),
        }
        // There are few bars and boundary edges compared to faces, so this loop is not vectorised.
        if self.homotopy != Homotopy::Linear {
            for (element, &halfway) in self.elements.iter().zip(&self.halfway_lengths) {
                let t = times.of_vertex(element.ends[0] as usize);
                element.add(self.homotopy, t, halfway, forces);
            }
        }
    }

    /// Adds the term M(t) W g of each face to the sums `forces` at its corners.
    ///
    /// `time` returns the times of the faces in a block. `extra` yields the data of each block that
    /// only the chosen homotopy needs. `pose(t, angle, extra, lane)` returns the coefficients of
    /// M(t) for face `lane` of a block.
    #[inline(always)]
    fn add<Extra>(
        &self,
        forces: &mut [DVec2],
        extra: impl Iterator<Item = Extra>,
        time: impl Fn(&[[u32; 3]]) -> FaceLanes,
        pose: impl Fn(f64, f64, &Extra, usize) -> MapCoefficients,
    ) {
        let faces = self.faces.chunks(LANES);
        for ((block, extra), faces) in self.blocks.iter().zip(extra).zip(faces) {
            let times = time(faces);
            let mapped = block.mapped(|lane| pose(times[lane], block.angle[lane], &extra, lane));
            scatter(&mapped, faces, forces);
        }
    }

    /// Adds the term M(t) W g of each face to the sums `forces`, with the formula of the chosen
    /// homotopy.
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

/// One pass over all faces, compiled once for each vector width.
struct FacePass<'a>(&'a ForceAssembly, EvaluationTimes<'a>, &'a mut [DVec2]);

impl WithSimd for FacePass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(stresses, times, forces) = self;
        match times {
            EvaluationTimes::Uniform(t) => stresses.pass(forces, |_| [t; LANES]),
            // All corners of a face belong to one part and have the same time.
            EvaluationTimes::PerPart { vertices, .. } => stresses.pass(forces, |faces| {
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
                // With the stretch S, exp(t log S) is a linear combination of I and u uᵀ, where u
                // is the axis of the larger eigenvalue of S.
                let axis = SymmetricEigen::of(face.map.stretch).axis;
                match homotopy {
                    Homotopy::Exponential => DMat2::from_cols(axis * axis.x, axis * axis.y),
                    _ => face.map.stretch,
                }
                .to_cols_array()
            }),
        }
    }

    /// Returns, for each face, M(t) times the weighted gradients of the second and third corner,
    /// column by column. These are the face's terms of the sum Σ M(t) W g at the two corners.
    #[inline(always)]
    fn mapped(&self, pose: impl Fn(usize) -> MapCoefficients) -> [FaceLanes; 4] {
        let mut mapped = [[0.0; LANES]; 4];
        (0..LANES).for_each(|lane| {
            let pose = pose(lane);
            let middle = self.middle.each_ref().map(|row| row[lane]);
            let [x2, y2, x3, y3] = self.weighted.each_ref().map(|row| row[lane]);
            let second = pose.apply(middle, x2, y2);
            let third = pose.apply(middle, x3, y3);
            mapped[0][lane] = second.x;
            mapped[1][lane] = second.y;
            mapped[2][lane] = third.x;
            mapped[3][lane] = third.y;
        });
        mapped
    }
}

/// For each face of a block, adds its terms of the sum Σ M(t) W g at the second and third corner,
/// and minus their sum at the first corner.
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

/// Collects N numbers per face of a block into N rows, with one entry per face.
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
    /// Returns the vector e(t) that the bar or boundary edge should have at t according to the
    /// homotopy, without the length correction of `edge_lengths`.
    pub(super) fn even_vector(&self, homotopy: Homotopy, t: f64) -> DVec2 {
        let map = PolarDecomposition {
            angle: self.angle,
            stretch: DMat2::IDENTITY * self.stretch,
        };
        homotopy.at(&map, t) * self.vector
    }

    /// Adds the terms of the bar or boundary edge at t to the sums `forces`. `halfway` is its
    /// length at t = ½, relative to the linearly interpolated length.
    fn add(&self, homotopy: Homotopy, t: f64, halfway: f64, forces: &mut [DVec2]) {
        // The length correction is a parabola in t that vanishes at t = 0 and t = 1.
        let ratio = 1.0 + (halfway - 1.0) * (4.0 * t * (1.0 - t));
        let ratio = ratio.clamp(*LENGTH_RATIOS.start(), *LENGTH_RATIOS.end());
        let pull = self.even_vector(homotopy, t) * (self.stiffness * ratio);
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
    fn every_vector_width_gives_identical_bits() -> Result<(), Box<dyn std::error::Error>> {
        let source: Vec<_> = (0..30)
            .map(|i| DVec2::new(f64::from(i / 2), f64::from(i % 2)))
            .collect();
        let bent = |p: &DVec2| DVec2::from_angle(0.3 * p.x) * (7.0 - p.y - 0.01 * p.x * p.x);
        let target = source.iter().map(bent).collect();
        let faces = (0..14_u32).flat_map(|i| {
            let v = 2 * i;
            [[v, v + 2, v + 3], [v, v + 3, v + 1]] // 28 faces: three and a half blocks
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
                        EvaluationTimes::Uniform(t),
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
