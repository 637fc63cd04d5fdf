//! Finds the earliest time in an interval at which a face may fold. A face may fold where its
//! signed area is not proved to be positive.

use super::bernstein::{BernsteinPolynomial, BernsteinProducts, EPS, EndSign};
use super::bisection::{Bisection, EarliestFailure, MAX_HALVINGS};
use super::vertex_curve::{IntervalCurves, VertexCurve};
use crate::geometry::{DVec2, orient2d};
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use rayon::prelude::*;

/// Returns the earliest time in the interval at which a face is not proved to be positively
/// oriented, as the fraction s of the interval, and the index of that face. `at_ends` marks the
/// ends of the interval that are t = 0 or t = 1; there the vertices have the exact positions of the
/// designs.
pub(super) fn first_fold(
    curves: &IntervalCurves,
    faces: &[[u32; 3]],
    at_ends: [bool; 2],
    progress: &dyn Progress,
) -> Result<Option<(f64, usize)>, Cancelled> {
    let products = BernsteinProducts::of_degree(curves.degree());
    let earliest = EarliestFailure::default();
    let of_face = |(face, corners): (usize, &[u32; 3])| {
        let corners = corners.map(|v| curves.curve(v as usize));
        let known = |end: usize, k: usize| {
            let [a, b, c] = corners.each_ref().map(|way| way.control_points[k]);
            match at_ends[end] {
                true => EndSign::of(orient2d(a, b, c)),
                false => EndSign::Unknown,
            }
        };
        let ends = [known(0, 0), known(1, curves.degree())];
        let area = twice_area(&products, corners.each_ref());
        if progress.is_cancelled() {
            return None;
        }
        let search = Bisection::new(&earliest);
        let s = first_not_positive(&area, ends, [0.0, 1.0], MAX_HALVINGS, &search)?;
        Some((s, face))
    };
    let failures = faces.par_iter().enumerate().filter_map(of_face);
    let first = failures.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    check_cancelled(progress)?;
    Ok(first)
}

/// Returns twice the signed area of the triangle of three vertices, as a polynomial.
pub(super) fn twice_area(
    products: &BernsteinProducts,
    [a, b, c]: [&VertexCurve; 3],
) -> BernsteinPolynomial {
    product(products, [a, b], [a, c], DVec2::perp_dot)
}

/// Returns the bilinear product `of` (such as the dot product) of two edge vectors, as a polynomial
/// with an error bound. Each edge vector runs from the first to the second curve of its pair.
pub(super) fn product(
    products: &BernsteinProducts,
    first: [&VertexCurve; 2],
    second: [&VertexCurve; 2],
    of: impl Fn(DVec2, DVec2) -> f64,
) -> BernsteinPolynomial {
    let between = |[from, to]: [&VertexCurve; 2]| -> (Vec<DVec2>, f64, f64) {
        let vectors: Vec<DVec2> = (to.control_points.iter().zip(&from.control_points))
            .map(|(b, a)| *b - *a)
            .collect();
        let largest = vectors.iter().map(|d| d.abs().max_element());
        let largest = largest.fold(0.0, f64::max);
        let error = from.error + to.error + EPS * largest;
        (vectors, largest, error)
    };
    let [(u, max_u, error_u), (v, max_v, error_v)] = [first, second].map(between);
    let mut sum = products.sum(|i, j| of(u[i], v[j]));
    // The result is the sum of two products of coordinates, hence the factor 2 below. The error of
    // each product consists of the errors of its factors, and of one rounding for each term of its
    // sum.
    let factor_error = error_u * max_v + error_v * max_u + error_u * error_v;
    let rounding = (2 * u.len() + 8) as f64 * EPS * max_u * max_v;
    sum.error = 2.0 * (factor_error + rounding);
    sum
}

/// Returns the smallest s in `[from, to]` at which a polynomial is not proved to be positive, by
/// bisection. The result is `None` if the polynomial is positive throughout, or if a failure before
/// `from` is already known. If too many parts are undecided, the first of those left counts as not
/// positive.
pub(super) fn first_not_positive(
    of: &BernsteinPolynomial,
    ends: [EndSign; 2],
    [from, to]: [f64; 2],
    halvings: u32,
    search: &Bisection,
) -> Option<f64> {
    if search.earliest.is_before(from) || of.is_positive(ends) {
        return None;
    }
    if ends[0] == EndSign::NotPositive || halvings == 0 || !search.try_use_part() {
        return Some(search.earliest.report(from));
    }
    let middle = from.midpoint(to);
    let [left, right] = of.halves();
    let in_half = |of: &BernsteinPolynomial, ends: [EndSign; 2], times: [f64; 2]| {
        first_not_positive(of, ends, times, halvings - 1, search)
    };
    in_half(&left, [ends[0], EndSign::Unknown], [from, middle])
        .or_else(|| in_half(&right, [EndSign::Unknown, ends[1]], [middle, to]))
}
