//! Faces that turn over.

use super::bernstein::{EPS, Known, Poly, Products};
use super::places::{Way, Ways};
use crate::geometry::{DVec2, orient2d};
use rayon::prelude::*;

/// How often a reel is halved: to a thousand-millionth.
pub(super) const HALVINGS: u32 = 30;

/// The first place in the reel at which a face is not proved to be positive, and the
/// face.
pub(super) fn first(ways: &Ways, faces: &[[u32; 3]]) -> Option<(f64, usize)> {
    let products = Products::of_degree(ways.degree());
    let of_face = |(face, corners): (usize, &[u32; 3])| {
        let corners = corners.map(|v| ways.way(v as usize));
        let ends = [0, ways.degree()].map(|k| {
            let [a, b, c] = corners.each_ref().map(|way| way.at[k]);
            Known::of(orient2d(a, b, c))
        });
        let area = twice_area(&products, corners.each_ref());
        let s = not_positive(&area, ends, [0.0, 1.0], HALVINGS)?;
        Some((s, face))
    };
    let found = faces.par_iter().enumerate().filter_map(of_face);
    found.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
}

/// Twice the area of three vertices.
pub(super) fn twice_area(products: &Products, [a, b, c]: [&Way; 3]) -> Poly {
    product(products, [a, b], [a, c], DVec2::perp_dot)
}

/// A product, component by component, of the ways from one vertex to another.
pub(super) fn product(
    products: &Products,
    first: [&Way; 2],
    second: [&Way; 2],
    of: impl Fn(DVec2, DVec2) -> f64,
) -> Poly {
    let between = |[from, to]: [&Way; 2]| -> (Vec<DVec2>, f64, f64) {
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
    of: &Poly,
    ends: [Known; 2],
    [from, to]: [f64; 2],
    halvings: u32,
) -> Option<f64> {
    if of.is_positive(ends) {
        return None;
    }
    if ends[0] == Known::Not || halvings == 0 {
        return Some(from);
    }
    let middle = from.midpoint(to);
    let [left, right] = of.halves();
    not_positive(&left, [ends[0], Known::No], [from, middle], halvings - 1)
        .or_else(|| not_positive(&right, [Known::No, ends[1]], [middle, to], halvings - 1))
}
