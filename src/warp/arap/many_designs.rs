//! As-rigid-as-possible interpolation of many designs.
//!
//! For each face, let A_j be the linear map from the first design, the reference, to design j, and
//! C the mean of these maps. In A_j C⁻¹ = R(θ_j) S_j, the sums of θ_j and of log S_j over all
//! designs are zero. A blend with weights w, which sum to 1, has the local maps
//!
//! A(w) = R(Σ w_j θ_j) exp(Σ w_j log S_j) C.
//!
//! As for two designs, the energy has one matrix for all blends, with the face weights W = (1/N) Σ
//! a_j (A_jᵀ A_j)⁻¹, where N is the number of designs and a_j the area of the face in design j. A
//! blend takes one pass over the faces and one back-substitution. The method extends Alexa,
//! Cohen-Or, Levin (2000) from two designs to many; the mean takes rotations and logarithms of
//! stretches separately.
//!
//! Guaranteed: with weight 1, a design is reproduced bit for bit; two designs give the exponential
//! homotopy with the symmetric energy as long as no face folds; with weights of at least 0, no face
//! folds. The order of the designs matters only by rounding, as long as no face rotates by more
//! than π between two designs and `retreat` is not needed. Not guaranteed: that no face folds with
//! negative weights.
//!
//! - `mend`: unfolds faces by moving interior vertices
//! - `retreat`: replaces a blend that stays folded by the nearest one that is not
//! - `parts`: positions of the connected parts as a whole; `along`: a path through the blends

mod along;
mod mend;
mod parts;
mod retreat;
#[cfg(test)]
mod tests;

pub use along::AlongBlend;

use super::angles::nearest_branch;
use super::assembly::{ElementMap, LocalMaps, all_gradients};
use super::options::{ArapError, ArapOptions};
use super::ridge::factor_with_ridge;
use crate::compatible::{BarElement, CompatibleFamily};
use crate::geometry::{DMat2, DVec2, PolarDecomposition, SymmetricEigen, twice_signed_area};
use crate::numerics::{Cholesky, CholeskyWorkspace, FactorError, SymmetricMatrix};
use crate::warp::homotopy::Homotopy;
use crate::work::progress::{Progress, check_cancelled, checkpoint};
use mend::Mender;
use parts::{BlendParts, blended};
use std::sync::Arc;

/// Blend of many designs, with its matrix factored in advance. Cloning is cheap.
///
/// ```
/// use morphospace::compatible::CompatibleFamily;
/// use morphospace::geometry::{DMat2, DVec2};
/// use morphospace::work::progress::Silent;
/// use morphospace::warp::ArapBlend;
///
/// let first = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
/// let turned = |by: f64| first.iter().map(|&p| DMat2::from_angle(by) * p).collect();
/// let places = vec![turned(0.0), turned(1.0), turned(2.0)];
/// let family = CompatibleFamily::new(vec![[0, 1, 2]], places, vec![])?;
/// let blend = ArapBlend::build(&family, &Silent)?;
/// let mut placer = blend.placer();
/// let at = placer.place(&[0.25, 0.5, 0.25]);
/// assert!((at[0].distance(at[1]) - 1.0).abs() < 1e-12); // turned, not shrunk
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ArapBlend(Arc<ArapBlendData>);

#[derive(Debug)]
struct ArapBlendData {
    family: CompatibleFamily,
    cholesky: Cholesky,
    faces: Vec<BlendFace>,
    /// For each face, one entry per design j: θ_j, and the entries xx, xy and yy of log S_j, in the
    /// notation of the module.
    ways: Vec<[f64; 4]>,
    bars: Vec<BlendBar>,
    /// For each vertex, one entry per design: the sum of the terms A_j W g of the adjacent faces,
    /// in the notation of the module, and of the terms of the adjacent bars.
    ends: Vec<DVec2>,
    parts: BlendParts,
    mender: Mender,
}

/// The matrix C W g of a face, in the notation of the module. The columns of g are the gradients of
/// the hat functions of the second and third corner. In a blend with weights w, the matrix is
/// multiplied from the left by R(Σ w_j θ_j) exp(Σ w_j log S_j). The columns of the product are the
/// face's terms of the right-hand sides at these two corners.
#[derive(Clone, Copy, Debug)]
struct BlendFace(DMat2);

/// A bar that belongs to no face.
#[derive(Clone, Debug)]
struct BlendBar {
    ends: BarElement,
    stiffness: f64,
    /// For each design, the direction of the bar in radians and the logarithm of its length.
    ways: Vec<[f64; 2]>,
}

impl ArapBlend {
    /// Builds the blend: computes the local maps of the faces in each design, assembles the matrix
    /// of the energy and factors it.
    ///
    /// # Errors
    /// [`ArapError`] if angles wind around a hole, the matrix cannot be factored, or the job is
    /// cancelled.
    pub fn build(family: &CompatibleFamily, progress: &dyn Progress) -> Result<Self, ArapError> {
        checkpoint(progress, "decomposing", 0.0)?;
        let count = family.count();
        let options = ArapOptions {
            homotopy: Homotopy::Exponential,
            ..ArapOptions::default()
        };
        // The local maps lead from the first design, the reference, to each design. Their angles
        // are consistent across shared edges, without extra turns.
        let mut maps = Vec::with_capacity(count);
        for design in 0..count {
            check_cancelled(progress)?;
            maps.push(LocalMaps::new(&family.pair(0, design), &options, &[])?);
        }
        let mut ways = Vec::with_capacity(family.faces().len() * count);
        let mut faces = Vec::with_capacity(family.faces().len());
        let mut matrix = Assembly::new(family);
        for f in 0..family.faces().len() {
            let each: Vec<PolarDecomposition> = maps.iter().map(|maps| maps.faces[f].map).collect();
            let (mean, own) = mean_of(&each);
            ways.extend(own);
            let gradients = maps[0].faces[f].gradients;
            let weighted = weight(family, f, &each) * gradients;
            faces.push(BlendFace(mean * weighted));
            matrix.add_face(family.faces()[f], gradients, weighted);
        }
        let bars = (0..family.elements().len()).map(|k| {
            let each: Vec<&ElementMap> = maps.iter().map(|maps| &maps.elements[k]).collect();
            BlendBar::of(family, &each)
        });
        let bars: Vec<BlendBar> = bars.collect();
        bars.iter().for_each(|bar| matrix.add_bar(bar));
        checkpoint(progress, "factoring", 0.5)?;
        let done = factor_with_ridge(matrix.grounded(family), progress)?;
        let (cholesky, _) = done.map_err(|error| match error {
            FactorError::NotPositiveDefinite { index } => {
                ArapError::Thin([0, count - 1].map(|k| family.embeddings()[k][index]))
            }
            error => ArapError::Factor(error),
        })?;
        let parts = BlendParts::of(family);
        let mut inner = ArapBlendData {
            family: family.clone(),
            cholesky,
            faces,
            ways,
            bars,
            ends: Vec::new(),
            parts,
            mender: Mender::of(family),
        };
        inner.ends = inner.pulls_of_designs();
        Ok(Self(Arc::new(inner)))
    }

    /// Returns the mesh: its faces and bars, and its vertex positions in each design.
    #[must_use]
    pub fn family(&self) -> &CompatibleFamily {
        &self.0.family
    }

    /// Returns a placer with its own memory.
    #[must_use]
    pub fn placer(&self) -> BlendPlacer {
        let inner = &self.0;
        let vertices = inner.parts.of_vertex.len();
        BlendPlacer {
            blend: Arc::clone(inner),
            places: inner.family.embeddings()[0].clone(),
            pulls: vec![DVec2::ZERO; vertices],
            deviation: vec![0.0; 2 * vertices],
            workspace: inner.cholesky.workspace(2),
            shifts: vec![DVec2::ZERO; inner.parts.count()],
            towards: vec![0.0; inner.family.count()],
        }
    }
}

/// Evaluates a blend in its own memory. Placing allocates nothing and cannot fail.
pub struct BlendPlacer {
    blend: Arc<ArapBlendData>,
    places: Vec<DVec2>,
    /// For each vertex, the sum of the terms A(w) W g of the adjacent faces, in the notation of the
    /// module, and of the terms of the adjacent bars.
    pulls: Vec<DVec2>,
    /// Holds the right-hand sides before the solve and the deviations of the vertices after it: all
    /// x, all y, in elimination order.
    deviation: Vec<f64>,
    workspace: CholeskyWorkspace,
    /// Translation that is added to the deviations of each connected part.
    shifts: Vec<DVec2>,
    /// Weights of the blends that are tried when a folded blend is moved towards a design.
    towards: Vec<f64>,
}

impl std::fmt::Debug for BlendPlacer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BlendPlacer")
            .field("places", &self.places)
            .finish_non_exhaustive()
    }
}

impl BlendPlacer {
    /// Returns the position of each vertex in the blend with the given weights, one per design,
    /// which sum to 1. Weights outside [0, 1] extrapolate.
    ///
    /// # Panics
    /// If the number of weights differs from the number of designs.
    pub fn place(&mut self, weights: &[f64]) -> &[DVec2] {
        let count = self.blend.family.count();
        assert_eq!(weights.len(), count, "a weight for each design");
        let is_between = weights.iter().all(|&weight| weight >= 0.0);
        if !self.solve(weights) && is_between {
            self.retreat(weights);
        }
        &self.places
    }

    /// Places a blend and unfolds its faces as far as possible. Returns whether no face is folded.
    fn solve(&mut self, weights: &[f64]) -> bool {
        let blend = &*self.blend;
        let count = weights.len();
        self.pulls.fill(DVec2::ZERO);
        blend.add_pulls(weights, &mut self.pulls);
        let order = blend.cholesky.elimination_places();
        let (x, y) = self.deviation.split_at_mut(order.len());
        let ends = blend.ends.chunks_exact(count);
        for ((&pull, ends), &at) in self.pulls.iter().zip(ends).zip(order) {
            let pull = pull - blended(weights, ends);
            x[at as usize] = pull.x;
            y[at as usize] = pull.y;
        }
        blend
            .cholesky
            .solve_ordered(&mut self.deviation, &mut self.workspace);
        let (x, y) = self.deviation.split_at(order.len());
        let deviation = |v: usize| DVec2::new(x[order[v] as usize], y[order[v] as usize]);
        blend.parts.shifts(weights, deviation, &mut self.shifts);
        for (v, place) in self.places.iter_mut().enumerate() {
            let designs = blend.family.embeddings().iter().zip(weights);
            let straight: DVec2 = designs.map(|(places, &w)| places[v] * w).sum();
            // The term in parentheses is exactly 0 if the blend is one of the designs, so that the
            // design is reproduced exactly.
            *place = straight + (deviation(v) + self.shifts[blend.parts.of_vertex[v] as usize]);
        }
        blend.mender.mend(blend.family.faces(), &mut self.places)
    }

    /// Returns the vertex positions of the last blend.
    #[must_use]
    pub fn places(&self) -> &[DVec2] {
        &self.places
    }
}

impl ArapBlendData {
    /// Adds the terms of each face and bar to the sums `pulls` at its vertices, for the blend with
    /// the given weights. The term of a face is A(w) W g, in the notation of the module, with the
    /// gradients g of its hat functions.
    fn add_pulls(&self, weights: &[f64], pulls: &mut [DVec2]) {
        let ways = self.ways.chunks_exact(weights.len());
        for ((face, ways), BlendFace(carried)) in
            self.family.faces().iter().zip(ways).zip(&self.faces)
        {
            let mut sum = [0.0; 4];
            for (way, &w) in ways.iter().zip(weights) {
                for (sum, of) in sum.iter_mut().zip(way) {
                    *sum += w * of;
                }
            }
            let [angle, xx, xy, yy] = sum;
            let map = DMat2::from_angle(angle) * exponential(xx, xy, yy) * *carried;
            for (&v, pull) in face.iter().zip(all_gradients(map)) {
                pulls[v as usize] += pull;
            }
        }
        for bar in &self.bars {
            let way = bar.ways.iter().zip(weights);
            let [angle, log] = way.fold([0.0; 2], |sum, (way, &w)| {
                [sum[0] + w * way[0], sum[1] + w * way[1]]
            });
            let pull = DVec2::from_angle(angle) * (log.exp() * bar.stiffness);
            pulls[bar.ends[0] as usize] -= pull;
            pulls[bar.ends[1] as usize] += pull;
        }
    }

    /// Returns, for each vertex, one entry per design: the sum that `add_pulls` computes at the
    /// vertex if this design has weight 1 and all others 0. A blend with these weights has exactly
    /// the same sums, because it uses `add_pulls` too.
    fn pulls_of_designs(&self) -> Vec<DVec2> {
        let (count, vertices) = (self.family.count(), self.parts.of_vertex.len());
        let mut ends = vec![DVec2::ZERO; count * vertices];
        for design in 0..count {
            let mut weights = vec![0.0; count];
            weights[design] = 1.0;
            let mut pulls = vec![DVec2::ZERO; vertices];
            self.add_pulls(&weights, &mut pulls);
            for (v, pull) in pulls.into_iter().enumerate() {
                ends[v * count + design] = pull;
            }
        }
        ends
    }
}

/// Returns the exponential of a symmetric matrix: e^m (cosh r I + (sinh r / r) D), with the mean m
/// of its eigenvalues, its traceless part D, and the eigenvalue r ≥ 0 of D.
fn exponential(xx: f64, xy: f64, yy: f64) -> DMat2 {
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let radius = half.hypot(xy);
    let (grown, shrunk) = (radius.exp(), (-radius).exp());
    let cosh = 0.5 * (grown + shrunk);
    // Below this, cosh r and sinh r / r equal 1 in floating point.
    let sinc = if radius < 1e-8 {
        1.0
    } else {
        0.5 * (grown - shrunk) / radius
    };
    let (d, o) = (sinc * half, sinc * xy);
    DMat2::from_cols(DVec2::new(cosh + d, o), DVec2::new(o, cosh - d)) * mean.exp()
}

/// Returns the mean C of the linear maps A_j given by `maps`. For each A_j, also returns the
/// rotation angle and the entries xx, xy and yy of the logarithm of the stretch of A_j C⁻¹.
fn mean_of(maps: &[PolarDecomposition]) -> (DMat2, Vec<[f64; 4]>) {
    /// Maximum number of iterations in the computation of C (resource limit: valid maps converge in
    /// about ten).
    const ROUNDS: usize = 100;
    /// Convergence threshold for the means of the angles and of the log stretches, which are zero
    /// for the exact C (tolerance: rounding).
    const LEFT: f64 = 1e-15;
    let count = maps.len() as f64;
    let each: Vec<DMat2> = maps.iter().map(PolarDecomposition::matrix).collect();
    let (mut mean, mut turned) = (DMat2::IDENTITY, 0.0);
    let mut own = Vec::new();
    for _ in 0..ROUNDS {
        let inverse = mean.inverse();
        own.clear();
        own.extend(each.iter().zip(maps).map(|(map, polar)| {
            let left = PolarDecomposition::of(*map * inverse);
            let log = SymmetricEigen::of(left.stretch).map(f64::ln);
            let angle = nearest_branch(left.angle, polar.angle - turned);
            [angle, log.x_axis.x, log.x_axis.y, log.y_axis.y]
        }));
        let left = own.iter().fold([0.0; 4], |sum: [f64; 4], way: &[f64; 4]| {
            [0, 1, 2, 3].map(|k| sum[k] + way[k] / count)
        });
        let [angle, xx, xy, yy] = left;
        if left.iter().all(|&part| part.abs() < LEFT) {
            break;
        }
        mean = DMat2::from_angle(angle) * exponential(xx, xy, yy) * mean;
        turned += angle;
    }
    (mean, own)
}

/// Returns the weight matrix W of a face in the energy: the mean, over the designs j, of the face's
/// area times (A_jᵀ A_j)⁻¹, where A_j is `maps[j]`.
fn weight(family: &CompatibleFamily, face: usize, maps: &[PolarDecomposition]) -> DMat2 {
    let corners = family.faces()[face];
    let mut sum = DMat2::ZERO;
    for (places, map) in family.embeddings().iter().zip(maps) {
        let [a, b, c] = corners.map(|v| places[v as usize]);
        let inverse = map.matrix().inverse();
        sum += inverse * inverse.transpose() * (0.5 * twice_signed_area(a, b, c));
    }
    sum * (1.0 / maps.len() as f64)
}

impl BlendBar {
    fn of(family: &CompatibleFamily, maps: &[&ElementMap]) -> Self {
        let ends = maps[0].ends;
        let along = |places: &Vec<DVec2>| places[ends[1] as usize] - places[ends[0] as usize];
        let first = along(&family.embeddings()[0]);
        let ways = family.embeddings().iter().zip(maps).map(|(places, map)| {
            let angle = first.to_angle() + map.angle;
            [angle, along(places).length().ln()]
        });
        Self {
            ends,
            ways: ways.collect(),
            // The stiffness is length²/2 divided by length², so it is the same for all designs.
            stiffness: 0.5,
        }
    }
}

/// The matrix of the energy while it is assembled.
struct Assembly {
    matrix: SymmetricMatrix,
    diagonal: Vec<f64>,
}

impl Assembly {
    fn new(family: &CompatibleFamily) -> Self {
        let n = family.embeddings()[0].len();
        let entries = 6 * family.faces().len() + 4 * family.elements().len();
        Self {
            matrix: SymmetricMatrix::zero(n, entries),
            diagonal: vec![0.0; n],
        }
    }

    fn add_face(&mut self, face: [u32; 3], gradients: DMat2, weighted: DMat2) {
        let (g, wg) = (all_gradients(gradients), all_gradients(weighted));
        for i in 0..3 {
            self.diagonal[face[i] as usize] += g[i].dot(wg[i]);
            for j in 0..=i {
                self.matrix.add(face[i], face[j], g[i].dot(wg[j]));
            }
        }
    }

    fn add_bar(&mut self, bar: &BlendBar) {
        let ([a, b], k) = (bar.ends, bar.stiffness);
        self.diagonal[a as usize] += k;
        self.diagonal[b as usize] += k;
        self.matrix.add(a, a, k);
        self.matrix.add(b, b, k);
        self.matrix.add(a, b, -k);
    }

    /// Makes the matrix regular by increasing the diagonal entry of one vertex of each connected
    /// part. This does not change the blend, because the right-hand sides sum to zero over each
    /// part and the part's translation is computed separately.
    fn grounded(mut self, family: &CompatibleFamily) -> SymmetricMatrix {
        let components = family.pair(0, 0).components();
        let mut grounded = vec![false; self.diagonal.len()];
        for (v, &component) in components.iter().enumerate() {
            if !std::mem::replace(&mut grounded[component as usize], true) {
                self.matrix.add(v as u32, v as u32, self.diagonal[v]);
            }
        }
        self.matrix
    }
}
