//! Faces that turn over.

use super::bernstein::{BernsteinPolynomial, BernsteinProducts, EPS, EndSign};
use super::vertex_curve::{IntervalCurves, VertexCurve};
use crate::geometry::{DVec2, orient2d};
use crate::work::progress::{Cancelled, Progress, still_wanted};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// How often a reel is halved: to a thousand-millionth.
pub(super) const MAX_HALVINGS: u32 = 30;

/// The first place in the reel at which a face is not proved to be positive, and the
/// face.
pub(super) fn first_fold(
    ways: &IntervalCurves,
    faces: &[[u32; 3]],
    at_ends: [bool; 2],
    progress: &dyn Progress,
) -> Result<Option<(f64, usize)>, Cancelled> {
    let products = BernsteinProducts::of_degree(ways.degree());
    let earliest = EarliestFailure::default();
    let of_face = |(face, corners): (usize, &[u32; 3])| {
        let corners = corners.map(|v| ways.way(v as usize));
        let known = |end: usize, k: usize| {
            let [a, b, c] = corners.each_ref().map(|way| way.at[k]);
            match at_ends[end] {
                true => EndSign::of(orient2d(a, b, c)),
                false => EndSign::No,
            }
        };
        let ends = [known(0, 0), known(1, ways.degree())];
        let area = twice_area(&products, corners.each_ref());
        if progress.is_cancelled() {
            return None;
        }
        let s = not_positive(&area, ends, [0.0, 1.0], MAX_HALVINGS, &earliest)?;
        Some((s, face))
    };
    let found = faces.par_iter().enumerate().filter_map(of_face);
    let first = found.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    still_wanted(progress)?;
    Ok(first)
}

/// The earliest trouble of any so far: what comes later need not be looked at.
pub(super) struct EarliestFailure(AtomicU64);

impl Default for EarliestFailure {
    fn default() -> Self {
        Self(AtomicU64::new(f64::INFINITY.to_bits()))
    }
}

impl EarliestFailure {
    pub(super) fn is_before(&self, s: f64) -> bool {
        // Relaxed: it only saves work. What is not negative is in the order of its bits.
        self.0.load(Ordering::Relaxed) < s.to_bits()
    }

    /// What was found, told.
    pub(super) fn told(&self, s: f64) -> f64 {
        self.0.fetch_min(s.to_bits(), Ordering::Relaxed);
        s
    }
}

/// Twice the area of three vertices.
pub(super) fn twice_area(
    products: &BernsteinProducts,
    [a, b, c]: [&VertexCurve; 3],
) -> BernsteinPolynomial {
    product(products, [a, b], [a, c], DVec2::perp_dot)
}

/// A product, component by component, of the ways from one vertex to another.
pub(super) fn product(
    products: &BernsteinProducts,
    first: [&VertexCurve; 2],
    second: [&VertexCurve; 2],
    of: impl Fn(DVec2, DVec2) -> f64,
) -> BernsteinPolynomial {
    let between = |[from, to]: [&VertexCurve; 2]| -> (Vec<DVec2>, f64, f64) {
        let ways: Vec<DVec2> = (to.at.iter().zip(&from.at)).map(|(b, a)| *b - *a).collect();
        let largest = ways.iter().map(|d| d.abs().max_element());
        let largest = largest.fold(0.0, f64::max);
        let error = from.error + to.error + EPS * largest;
        (ways, largest, error)
    };
    let [(u, most_u, off_u), (v, most_v, off_v)] = [first, second].map(between);
    let mut sum = products.sum(|i, j| of(u[i], v[j]));
    // Two products of coordinates, each off by what its factors are off, and as many
    // roundings as there are terms.
    let off = off_u * most_v + off_v * most_u + off_u * off_v;
    let rounded = (2 * u.len() + 8) as f64 * EPS * most_u * most_v;
    sum.error = 2.0 * (off + rounded);
    sum
}

/// The first place at which a polynomial is not proved to be positive.
pub(super) fn not_positive(
    of: &BernsteinPolynomial,
    ends: [EndSign; 2],
    [from, to]: [f64; 2],
    halvings: u32,
    earliest: &EarliestFailure,
) -> Option<f64> {
    if earliest.is_before(from) || of.is_positive(ends) {
        return None;
    }
    if ends[0] == EndSign::Not || halvings == 0 {
        return Some(earliest.told(from));
    }
    let middle = from.midpoint(to);
    let [left, right] = of.halves();
    let in_half = |of: &BernsteinPolynomial, ends: [EndSign; 2], times: [f64; 2]| {
        not_positive(of, ends, times, halvings - 1, earliest)
    };
    in_half(&left, [ends[0], EndSign::No], [from, middle])
        .or_else(|| in_half(&right, [EndSign::No, ends[1]], [middle, to]))
}
