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
//! exponential homotopy with the symmetric energy; the order of the designs has no
//! influence but by rounding, where no face turns by more than half a turn between two of
//! them. Not guaranteed: that no face folds between the designs.

use super::angles::nearest;
use super::assembly::{ElementMap, LocalMaps, with_first};
use super::options::{ArapError, ArapOptions};
use super::ridge::factored;
use crate::compatible::{BarElement, Family};
use crate::geometry::{DMat2, DVec2, Polar, SymmetricEigen, twice_signed_area};
use crate::homotopy::Homotopy;
use crate::linalg::{Cholesky, FactorError, SymmetricMatrix, Workspace};
use crate::progress::{Progress, checkpoint, still_wanted};
use std::sync::Arc;

/// A prefactored blend of many designs. Cloning is cheap.
///
/// ```
/// use morphospace::compatible::Family;
/// use morphospace::geometry::{DMat2, DVec2};
/// use morphospace::progress::Silent;
/// use morphospace::warp::ArapBlend;
///
/// let first = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
/// let turned = |by: f64| first.iter().map(|&p| DMat2::from_angle(by) * p).collect();
/// let places = vec![turned(0.0), turned(1.0), turned(2.0)];
/// let blend = ArapBlend::build(&Family::new(vec![[0, 1, 2]], places, vec![])?, &Silent)?;
/// let mut placer = blend.placer();
/// let at = placer.place(&[0.25, 0.5, 0.25]);
/// assert!((at[0].distance(at[1]) - 1.0).abs() < 1e-12); // turned, not shrunk
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ArapBlend(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    family: Family,
    cholesky: Cholesky,
    faces: Vec<Face>,
    /// For each face and each design, faces first: θ, and log S by its entries xx, xy
    /// and yy.
    ways: Vec<[f64; 4]>,
    bars: Vec<Bar>,
    /// For each vertex and each design the pull of its faces there, vertices first.
    ends: Vec<DVec2>,
    parts: Parts,
}

/// C W g of the second and third corner of a face.
#[derive(Clone, Copy, Debug)]
struct Face(DMat2);

/// A bar in no face.
#[derive(Clone, Debug)]
struct Bar {
    ends: BarElement,
    stiffness: f64,
    /// For each design the direction, in radians, and the logarithm of the length.
    ways: Vec<[f64; 2]>,
}

/// The connected parts and where they are as wholes.
#[derive(Debug)]
struct Parts {
    /// For each vertex its part.
    of_vertex: Vec<u32>,
    /// For each vertex its share of its part's mass.
    shares: Vec<f64>,
    /// For each design its rotation against what all have in common, in radians.
    angles: Vec<f64>,
    /// For each part and each design its offset from the whole's centroid, turned back;
    /// parts first.
    turned: Vec<DVec2>,
}

impl ArapBlend {
    /// Decomposes the local maps, assembles the matrix and factors it.
    ///
    /// # Errors
    /// [`ArapError`] if angles wind around a hole, the matrix cannot be factored, or on a
    /// cancel.
    pub fn build(family: &Family, progress: &dyn Progress) -> Result<Self, ArapError> {
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
            still_wanted(progress)?;
            maps.push(LocalMaps::new(&family.pair(0, design), &options, &[])?);
        }
        let masses = masses(family);
        let mut ways = Vec::with_capacity(family.faces().len() * count);
        let mut faces = Vec::with_capacity(family.faces().len());
        let mut matrix = Assembly::new(family);
        for f in 0..family.faces().len() {
            let each: Vec<Polar> = maps.iter().map(|maps| maps.faces[f].map).collect();
            let (mean, own) = mean_of(&each);
            ways.extend(own);
            let gradients = maps[0].faces[f].gradients;
            let weighted = weight(family, f, &each) * gradients;
            faces.push(Face(mean * weighted));
            matrix.add_face(family.faces()[f], gradients, weighted);
        }
        let bars = (0..family.elements().len()).map(|k| {
            let each: Vec<&ElementMap> = maps.iter().map(|maps| &maps.elements[k]).collect();
            Bar::of(family, &each)
        });
        let bars: Vec<Bar> = bars.collect();
        bars.iter().for_each(|bar| matrix.add_bar(bar));
        checkpoint(progress, "factoring", 0.5)?;
        let done = factored(matrix.grounded(family), progress)?;
        let (cholesky, _) = done.map_err(|error| match error {
            FactorError::NotPositiveDefinite { index } => {
                ArapError::Thin([0, count - 1].map(|k| family.places()[k][index]))
            }
            error => ArapError::Factor(error),
        })?;
        let parts = Parts::of(family, &masses);
        let mut inner = Inner {
            family: family.clone(),
            cholesky,
            faces,
            ways,
            bars,
            ends: Vec::new(),
            parts,
        };
        inner.ends = inner.pulls_of_designs();
        Ok(Self(Arc::new(inner)))
    }

    /// The connectivity and the designs.
    #[must_use]
    pub fn family(&self) -> &Family {
        &self.0.family
    }

    /// A placer with memory of its own.
    #[must_use]
    pub fn placer(&self) -> BlendPlacer {
        let inner = &self.0;
        let vertices = inner.parts.of_vertex.len();
        let parts = inner.parts.turned.len() / inner.family.count();
        BlendPlacer {
            blend: Arc::clone(inner),
            places: inner.family.places()[0].clone(),
            pulls: vec![DVec2::ZERO; vertices],
            deviation: vec![0.0; 2 * vertices],
            workspace: inner.cholesky.workspace(2),
            shifts: vec![DVec2::ZERO; parts],
        }
    }
}

/// A blend with the memory that it takes. Placing allocates nothing and cannot fail.
pub struct BlendPlacer {
    blend: Arc<Inner>,
    places: Vec<DVec2>,
    /// Of each vertex.
    pulls: Vec<DVec2>,
    /// Right-hand sides, then deviations: all x, all y, in elimination order.
    deviation: Vec<f64>,
    workspace: Workspace,
    /// Of each part.
    shifts: Vec<DVec2>,
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
        let blend = &*self.blend;
        let count = blend.family.count();
        assert_eq!(weights.len(), count, "a weight for each design");
        self.pulls.fill(DVec2::ZERO);
        blend.add_pulls(weights, &mut self.pulls);
        let order = blend.cholesky.place_in_order();
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
            let designs = blend.family.places().iter().zip(weights);
            let straight: DVec2 = designs.map(|(places, &w)| places[v] * w).sum();
            // What is exactly 0 at a design is added last.
            *place = straight + (deviation(v) + self.shifts[blend.parts.of_vertex[v] as usize]);
        }
        &self.places
    }

    /// Where the vertices were placed last.
    #[must_use]
    pub fn places(&self) -> &[DVec2] {
        &self.places
    }
}

/// Σ w_j p_j.
fn blended(weights: &[f64], places: &[DVec2]) -> DVec2 {
    weights.iter().zip(places).map(|(&w, &p)| p * w).sum()
}

impl Inner {
    /// Σ A(w) W g of each vertex.
    fn add_pulls(&self, weights: &[f64], pulls: &mut [DVec2]) {
        let ways = self.ways.chunks_exact(weights.len());
        for ((face, ways), Face(carried)) in self.family.faces().iter().zip(ways).zip(&self.faces) {
            let mut sum = [0.0; 4];
            for (way, &w) in ways.iter().zip(weights) {
                for (sum, of) in sum.iter_mut().zip(way) {
                    *sum += w * of;
                }
            }
            let [angle, xx, xy, yy] = sum;
            let map = DMat2::from_angle(angle) * exponential(xx, xy, yy) * *carried;
            for (&v, pull) in face.iter().zip(with_first(map)) {
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
fn mean_of(maps: &[Polar]) -> (DMat2, Vec<[f64; 4]>) {
    /// What is left of the mean is below rounding after some ten rounds; the bound is
    /// for maps that are none.
    const ROUNDS: usize = 100;
    const LEFT: f64 = 1e-15;
    let count = maps.len() as f64;
    let each: Vec<DMat2> = maps.iter().map(Polar::matrix).collect();
    let (mut mean, mut turned) = (DMat2::IDENTITY, 0.0);
    let mut own = Vec::new();
    for _ in 0..ROUNDS {
        let inverse = mean.inverse();
        own.clear();
        own.extend(each.iter().zip(maps).map(|(map, polar)| {
            let left = Polar::of(*map * inverse);
            let log = SymmetricEigen::of(left.stretch).map(f64::ln);
            let angle = nearest(left.angle, polar.angle - turned);
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
fn weight(family: &Family, face: usize, maps: &[Polar]) -> DMat2 {
    let corners = family.faces()[face];
    let mut sum = DMat2::ZERO;
    for (places, map) in family.places().iter().zip(maps) {
        let [a, b, c] = corners.map(|v| places[v as usize]);
        let inverse = map.matrix().inverse();
        sum += inverse * inverse.transpose() * (0.5 * twice_signed_area(a, b, c));
    }
    sum * (1.0 / maps.len() as f64)
}

impl Bar {
    fn of(family: &Family, maps: &[&ElementMap]) -> Self {
        let ends = maps[0].ends;
        let along = |places: &Vec<DVec2>| places[ends[1] as usize] - places[ends[0] as usize];
        let first = along(&family.places()[0]);
        let ways = family.places().iter().zip(maps).map(|(places, map)| {
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
    fn new(family: &Family) -> Self {
        let n = family.places()[0].len();
        let entries = 6 * family.faces().len() + 4 * family.elements().len();
        Self {
            matrix: SymmetricMatrix::zero(n, entries),
            diagonal: vec![0.0; n],
        }
    }

    fn add_face(&mut self, face: [u32; 3], gradients: DMat2, weighted: DMat2) {
        let (g, wg) = (with_first(gradients), with_first(weighted));
        for i in 0..3 {
            self.diagonal[face[i] as usize] += g[i].dot(wg[i]);
            for j in 0..=i {
                self.matrix.add(face[i], face[j], g[i].dot(wg[j]));
            }
        }
    }

    fn add_bar(&mut self, bar: &Bar) {
        let ([a, b], k) = (bar.ends, bar.stiffness);
        self.diagonal[a as usize] += k;
        self.diagonal[b as usize] += k;
        self.matrix.add(a, a, k);
        self.matrix.add(b, b, k);
        self.matrix.add(a, b, -k);
    }

    /// Made regular by grounding one vertex of each connected part, which moves nothing:
    /// pulls sum up to zero over a part.
    fn grounded(mut self, family: &Family) -> SymmetricMatrix {
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

/// Fixed masses of the vertices: the mean of the designs' normalised lumped areas.
fn masses(family: &Family) -> Vec<f64> {
    let mut masses = vec![0.0; family.places()[0].len()];
    for places in family.places() {
        let area = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| places[v as usize]);
            0.5 * twice_signed_area(a, b, c)
        };
        let square =
            |&[a, b]: &BarElement| 0.5 * places[a as usize].distance_squared(places[b as usize]);
        let faces = family.faces().iter();
        let total = faces.clone().map(area).sum::<f64>()
            + family.elements().iter().map(square).sum::<f64>();
        let share = 1.0 / (total * family.count() as f64);
        for face in faces {
            let mass = area(face) * share / 3.0;
            face.iter().for_each(|&v| masses[v as usize] += mass);
        }
        for bar in family.elements() {
            let mass = square(bar) * share / 2.0;
            bar.iter().for_each(|&v| masses[v as usize] += mass);
        }
    }
    masses
}

impl Parts {
    fn of(family: &Family, masses: &[f64]) -> Self {
        let of_vertex = family.pair(0, 0).components();
        let count = of_vertex.iter().max().map_or(0, |&last| last as usize + 1);
        let mut mass = vec![0.0; count];
        for (&part, &m) in of_vertex.iter().zip(masses) {
            mass[part as usize] += m;
        }
        let shares = of_vertex.iter().zip(masses);
        let shares: Vec<f64> = shares.map(|(&part, &m)| m / mass[part as usize]).collect();
        let designs = family.count();
        let angles = common_angles(family, masses);
        let mut turned = vec![DVec2::ZERO; count * designs];
        // The only part is the whole.
        if count > 1 {
            for (design, places) in family.places().iter().enumerate() {
                let mut centres = vec![DVec2::ZERO; count];
                for ((&part, &share), &p) in of_vertex.iter().zip(&shares).zip(places) {
                    centres[part as usize] += p * share;
                }
                let total: f64 = mass.iter().sum();
                let whole: DVec2 = centres
                    .iter()
                    .zip(&mass)
                    .map(|(&c, &m)| c * (m / total))
                    .sum();
                let back = DMat2::from_angle(-angles[design]);
                for (part, &centre) in centres.iter().enumerate() {
                    turned[part * designs + design] = back * (centre - whole);
                }
            }
        }
        Self {
            of_vertex,
            shares,
            angles,
            turned,
        }
    }

    /// What has to be added to the deviation of each part: its mean is taken out, and
    /// parts are carried about the whole as it turns.
    fn shifts(&self, weights: &[f64], deviation: impl Fn(usize) -> DVec2, shifts: &mut [DVec2]) {
        let angle: f64 = self.angles.iter().zip(weights).map(|(a, w)| a * w).sum();
        let turn = DMat2::from_angle(angle);
        for (shift, turned) in shifts
            .iter_mut()
            .zip(self.turned.chunks_exact(weights.len()))
        {
            // By the operations of the other side, so that both are equal at a design.
            let ends = turned.iter().zip(&self.angles).zip(weights);
            let straight: DVec2 = ends
                .map(|((&end, &angle), &w)| DMat2::from_angle(angle) * end * w)
                .sum();
            *shift = turn * blended(weights, turned) - straight;
        }
        for (v, (&part, &share)) in self.of_vertex.iter().zip(&self.shares).enumerate() {
            shifts[part as usize] -= deviation(v) * share;
        }
    }
}

/// For each design the rotation about its centroid that lays it on all others best, least
/// squares over all pairs of designs (generalised Procrustes analysis, Gower 1975, of
/// rotations alone).
fn common_angles(family: &Family, masses: &[f64]) -> Vec<f64> {
    /// A power iteration, whose error falls by some digits a round unless designs agree on
    /// no rotation.
    const ROUNDS: usize = 200;
    let count = family.count();
    let total: f64 = masses.iter().sum();
    let centred: Vec<Vec<DVec2>> = family
        .places()
        .iter()
        .map(|places| {
            let centre: DVec2 = places
                .iter()
                .zip(masses)
                .map(|(&p, &m)| p * (m / total))
                .sum();
            places.iter().map(|&p| p - centre).collect()
        })
        .collect();
    // As complex numbers: the argument turns design k onto design j.
    let onto = |j: usize, k: usize| -> DVec2 {
        let places = centred[j].iter().zip(&centred[k]).zip(masses);
        places
            .map(|((&p, &q), &m)| DVec2::new(q.dot(p), q.perp_dot(p)) * m)
            .sum()
    };
    let products: Vec<Vec<DVec2>> = (0..count)
        .map(|j| (0..count).map(|k| onto(j, k)).collect())
        .collect();
    let mut turns = vec![DVec2::X; count];
    for _ in 0..ROUNDS {
        let before = turns.clone();
        for (j, turn) in turns.iter_mut().enumerate() {
            let others = (0..count).filter(|&k| k != j);
            let sum: DVec2 = others.map(|k| before[k].rotate(products[j][k])).sum();
            // Half of the way, or two designs would change places for ever.
            *turn = (before[j] + sum.normalize_or(before[j])).normalize_or(before[j]);
        }
        let moved = turns.iter().zip(&before).map(|(a, b)| a.distance(*b));
        if moved.fold(0.0, f64::max) < 1e-15 {
            break;
        }
    }
    turns.iter().map(|turn| turn.to_angle()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compatible::CompatibleMesh;
    use crate::progress::Silent;
    use crate::warp::{Arap, Warp};
    use proptest::prelude::*;

    /// A strip of two rows, bent and stretched, and turned as a whole.
    fn bent(by: f64, stretch: f64, turn: f64) -> Vec<DVec2> {
        let place = |i: u32| {
            let (x, y) = (f64::from(i / 2), f64::from(i % 2));
            let p = DMat2::from_angle(by * x) * DVec2::new(x * stretch, 4.0 - y);
            DMat2::from_angle(turn) * p + DVec2::new(3.0 * turn, by)
        };
        (0..12).map(place).collect()
    }

    fn strip() -> Vec<[u32; 3]> {
        let cells = (0..5_u32).map(|i| 2 * i);
        cells
            .flat_map(|v| [[v, v + 1, v + 2], [v + 2, v + 1, v + 3]])
            .collect()
    }

    fn family(designs: &[[f64; 3]]) -> Family {
        let places = designs
            .iter()
            .map(|&[by, stretch, turn]| bent(by, stretch, turn));
        Family::new(strip(), places.collect(), vec![]).expect("positive faces")
    }

    const THREE: [[f64; 3]; 3] = [[0.0, 1.0, 0.0], [0.2, 1.3, 0.9], [-0.15, 0.8, -0.7]];

    #[test]
    fn each_design_is_met_to_the_last_bit() {
        let family = family(&THREE);
        let blend = ArapBlend::build(&family, &Silent).expect("a blend");
        let mut placer = blend.placer();
        for (k, places) in family.places().iter().enumerate() {
            let mut weights = [0.0; 3];
            weights[k] = 1.0;
            assert_eq!(placer.place(&weights), &places[..]);
        }
    }

    #[test]
    fn the_order_of_the_designs_has_no_influence() {
        let [a, b, c] = THREE;
        let place = |designs: [[f64; 3]; 3], weights: [f64; 3]| {
            let blend = ArapBlend::build(&family(&designs), &Silent).expect("a blend");
            blend.placer().place(&weights).to_vec()
        };
        let first = place([a, b, c], [0.5, 0.2, 0.3]);
        for (designs, weights) in [
            ([b, c, a], [0.2, 0.3, 0.5]),
            ([c, b, a], [0.3, 0.2, 0.5]),
            ([b, a, c], [0.2, 0.5, 0.3]),
        ] {
            let again = place(designs, weights);
            let off = first.iter().zip(&again).map(|(p, q)| p.distance(*q));
            assert!(off.fold(0.0, f64::max) < 1e-12);
        }
    }

    #[test]
    fn a_rigid_design_moves_rigidly() {
        let designs = [[0.1, 1.2, 0.0], [0.1, 1.2, 1.0], [0.1, 1.2, -1.3]];
        let family = family(&designs);
        let blend = ArapBlend::build(&family, &Silent).expect("a blend");
        let mut placer = blend.placer();
        let places = placer.place(&[0.3, 0.3, 0.4]);
        let lengths = |places: &[DVec2]| -> Vec<f64> {
            let first = places[0];
            places.iter().map(|p| p.distance(first)).collect()
        };
        for (a, b) in lengths(places).iter().zip(lengths(&family.places()[0])) {
            assert!((a - b).abs() < 1e-10);
        }
    }

    #[test]
    fn parts_are_carried_about_the_whole() {
        // Two strips apart from each other, turned by half a turn as a whole.
        let two = |turn: f64| -> Vec<DVec2> {
            let strip = bent(0.0, 1.0, 0.0);
            let other = strip.iter().map(|&p| p + DVec2::Y * 20.0);
            let all = strip.iter().copied().chain(other);
            all.map(|p| DMat2::from_angle(turn) * p).collect()
        };
        let faces = strip().into_iter();
        let again = strip().into_iter().map(|face| face.map(|v| v + 12));
        let places = vec![two(0.0), two(2.0), two(3.0)];
        let family = Family::new(faces.chain(again).collect(), places, vec![]).expect("positive");
        let blend = ArapBlend::build(&family, &Silent).expect("a blend");
        let at = blend.placer().place(&[0.25, 0.25, 0.5]).to_vec();
        assert!((at[0].distance(at[12]) - 20.0).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn two_designs_are_the_pair(
            bends in prop::array::uniform2(-0.1..0.1_f64),
            stretches in prop::array::uniform2(0.6..1.6_f64),
            turn in -2.5..2.5_f64,
            t in -0.5..1.5_f64,
        ) {
            let designs = [[bends[0], stretches[0], 0.0], [bends[1], stretches[1], turn]];
            let family = family(&designs);
            let blend = ArapBlend::build(&family, &Silent).expect("a blend");
            let options = ArapOptions { homotopy: Homotopy::Exponential, ..ArapOptions::default() };
            let mesh: CompatibleMesh = family.pair(0, 1);
            let mut pair = Arap::build(&mesh, &options, &Silent).expect("a pair").placer();
            pair.place(t);
            let mut placer = blend.placer();
            let many = placer.place(&[1.0 - t, t]);
            for (p, q) in many.iter().zip(&pair.placement().in_frame) {
                prop_assert!(p.distance(*q) < 1e-11, "{p} {q}");
            }
        }
    }
}
