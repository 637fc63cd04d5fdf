//! Rigid parts of many designs at once.
//!
//! For each face let A_j be its map from a reference to design j, and C the mean of all:
//! with A_j C⁻¹ = R(θ_j) S_j, the sums of θ_j and of log S_j over the designs are zero.
//! A blend with weights w that sum to one has the local maps
//!
//! A(w) = R(Σ w_j θ_j) exp(Σ w_j log S_j) C,
//!
//! and, as for two designs, the energy has one matrix, with the weights
//! W = (1/N) Σ a_j (A_jᵀ A_j)⁻¹, a_j the face's area in design j: a blend is one pass over
//! the faces and one back-substitution. After Alexa, Cohen-Or, Levin (2000) for two; the
//! mean is that of rotations and of logarithms of stretches, each by itself.
//!
//! Guaranteed: each design at its own corner, to the last bit; of two designs it is the
//! exponential homotopy with the symmetric energy, where no face folds; the order of the
//! designs has no influence but by rounding, where no face turns by more than half a turn
//! between two of them and `retreat` has nothing to do; between the designs no face folds.
//! Not guaranteed: that none folds beyond them.
//!
//! - `mend`: faces inside that are turned over, turned back
//! - `retreat`: from a blend that stays folded to one that is not
//! - `parts`: where the connected parts are as wholes; `along`: a way through the blends

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

/// A prefactored blend of many designs. Cloning is cheap.
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
    /// For each face and each design, faces first: θ, and log S by its entries xx, xy
    /// and yy.
    ways: Vec<[f64; 4]>,
    bars: Vec<BlendBar>,
    /// For each vertex and each design the pull of its faces there, vertices first.
    ends: Vec<DVec2>,
    parts: BlendParts,
    mender: Mender,
}

/// C W g of the second and third corner of a face.
#[derive(Clone, Copy, Debug)]
struct BlendFace(DMat2);

/// A bar in no face.
#[derive(Clone, Debug)]
struct BlendBar {
    ends: BarElement,
    stiffness: f64,
    /// For each design the direction, in radians, and the logarithm of the length.
    ways: Vec<[f64; 2]>,
}

impl ArapBlend {
    /// Decomposes the local maps, assembles the matrix and factors it.
    ///
    /// # Errors
    /// [`ArapError`] if angles wind around a hole, the matrix cannot be factored, or on a
    /// cancel.
    pub fn build(family: &CompatibleFamily, progress: &dyn Progress) -> Result<Self, ArapError> {
        checkpoint(progress, "decomposing", 0.0)?;
        let count = family.count();
        let options = ArapOptions {
            homotopy: Homotopy::Exponential,
            ..ArapOptions::default()
        };
        // From the first design, which is the reference, to each: their angles fit
        // together over the faces, and parts turn the short way.
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

    /// The connectivity and the designs.
    #[must_use]
    pub fn family(&self) -> &CompatibleFamily {
        &self.0.family
    }

    /// A placer with memory of its own.
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

/// A blend with the memory that it takes. Placing allocates nothing and cannot fail.
pub struct BlendPlacer {
    blend: Arc<ArapBlendData>,
    places: Vec<DVec2>,
    /// Of each vertex.
    pulls: Vec<DVec2>,
    /// Right-hand sides, then deviations: all x, all y, in elimination order.
    deviation: Vec<f64>,
    workspace: CholeskyWorkspace,
    /// Of each part.
    shifts: Vec<DVec2>,
    /// Weights that are tried.
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
    /// Where each vertex is in the blend with these weights, one for each design, that
    /// sum to one; outside [0, 1] it extrapolates.
    ///
    /// # Panics
    /// If there are not as many weights as designs.
    pub fn place(&mut self, weights: &[f64]) -> &[DVec2] {
        let count = self.blend.family.count();
        assert_eq!(weights.len(), count, "a weight for each design");
        let is_between = weights.iter().all(|&weight| weight >= 0.0);
        if !self.solve(weights) && is_between {
            self.retreat(weights);
        }
        &self.places
    }

    /// Places a blend as near as faces can be kept from folding, and says whether none is.
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
            // What is exactly 0 at a design is added last.
            *place = straight + (deviation(v) + self.shifts[blend.parts.of_vertex[v] as usize]);
        }
        blend.mender.mend(blend.family.faces(), &mut self.places)
    }

    /// Where the vertices were placed last.
    #[must_use]
    pub fn places(&self) -> &[DVec2] {
        &self.places
    }
}

impl ArapBlendData {
    /// Σ A(w) W g of each vertex.
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

    /// The pulls at each design, by the very operations of a blend: their difference to
    /// one there is exactly zero.
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

/// exp of a symmetric matrix: e^m (cosh r I + sinh r / r D) with its mean m and the rest
/// D of size r.
fn exponential(xx: f64, xy: f64, yy: f64) -> DMat2 {
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let radius = half.hypot(xy);
    let (grown, shrunk) = (radius.exp(), (-radius).exp());
    let cosh = 0.5 * (grown + shrunk);
    // Below this cosh and sinh r / r are one to the last digit.
    let sinc = if radius < 1e-8 {
        1.0
    } else {
        0.5 * (grown - shrunk) / radius
    };
    let (d, o) = (sinc * half, sinc * xy);
    DMat2::from_cols(DVec2::new(cosh + d, o), DVec2::new(o, cosh - d)) * mean.exp()
}

/// The mean C of some maps, and for each the angle and log stretch of A_j C⁻¹.
fn mean_of(maps: &[PolarDecomposition]) -> (DMat2, Vec<[f64; 4]>) {
    /// What is left of the mean is below rounding after some ten rounds; the bound is
    /// for maps that are none.
    const ROUNDS: usize = 100;
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

/// W: the mean over the designs of the face's area times the inverse of A_jᵀ A_j.
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
            // By length²/2 divided by the length's square, whatever the designs.
            stiffness: 0.5,
        }
    }
}

/// The matrix of the energy on its way.
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

    /// Made regular by grounding one vertex of each connected part, which moves nothing:
    /// pulls sum up to zero over a part.
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
