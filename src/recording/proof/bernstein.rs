//! Polynomials in Bernstein's form, whose coefficients bound them.
//!
//! A polynomial on [0, 1] lies between the least and the largest of its Bernstein
//! coefficients, and begins and ends with the first and the last of them. De
//! Casteljau's scheme gives those of both halves.

use crate::recording::nodes::MAX_NODES;

/// The largest degree of a place, and of a product of two.
const PLACE: usize = MAX_NODES + 1;
pub(super) const MAX_PRODUCT_DEGREE: usize = 2 * PLACE;

/// Rounding of one operation.
pub(super) const EPS: f64 = f64::EPSILON;

/// Binomial coefficients; exact up to a row of 50.
fn binomial(n: usize, k: usize) -> f64 {
    (0..k.min(n - k)).fold(1.0, |c, i| (c * (n - i) as f64 / (i + 1) as f64).round())
}

/// For each k below `n` the coefficients of 4s(1 − s) T_k(2s − 1), in degree n + 1.
pub(super) fn bernstein_basis(n: usize) -> Vec<Vec<f64>> {
    let degree = n + 1;
    let of = |k: usize| -> Vec<f64> {
        // T_k(2s − 1) in degree k: (−1)^(k−i) C(2k, 2i) / C(k, i).
        let sign = |i: usize| if (k - i).is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut own: Vec<f64> = (0..=k)
            .map(|i| sign(i) * binomial(2 * k, 2 * i) / binomial(k, i))
            .collect();
        // Times 4s(1 − s), which is 0, 2, 0 in degree 2.
        let inner = own
            .iter()
            .enumerate()
            .map(|(i, c)| 2.0 * c * 2.0 * binomial(k, i) / binomial(k + 2, i + 1));
        own = [0.0].into_iter().chain(inner).chain([0.0]).collect();
        while own.len() <= degree {
            own = elevated(&own);
        }
        own
    };
    (0..n).map(of).collect()
}

/// The same polynomial in a degree more.
fn elevated(own: &[f64]) -> Vec<f64> {
    let degree = own.len();
    let at = |i: usize| own.get(i).copied().unwrap_or(0.0);
    let coefficient = |i: usize| {
        let share = i as f64 / degree as f64;
        let before = if i > 0 { at(i - 1) } else { 0.0 };
        share * before + (1.0 - share) * at(i)
    };
    (0..=degree).map(coefficient).collect()
}

/// What makes the coefficients of a product of two polynomials of a degree.
pub(super) struct BernsteinProducts {
    degree: usize,
    weights: Vec<f64>,
}

impl BernsteinProducts {
    pub(super) fn of_degree(degree: usize) -> Self {
        let weight = |i: usize, j: usize| {
            binomial(degree, i) * binomial(degree, j) / binomial(2 * degree, i + j)
        };
        let pairs = (0..=degree).flat_map(|i| (0..=degree).map(move |j| (i, j)));
        Self {
            degree,
            weights: pairs.map(|(i, j)| weight(i, j)).collect(),
        }
    }

    /// Σ of `of(i, j)`, each with its weight: the product where that is uᵢ vⱼ.
    pub(super) fn sum(&self, of: impl Fn(usize, usize) -> f64) -> BernsteinPolynomial {
        let mut sum = BernsteinPolynomial::zero(2 * self.degree);
        for i in 0..=self.degree {
            for j in 0..=self.degree {
                sum.c[i + j] += self.weights[i * (self.degree + 1) + j] * of(i, j);
            }
        }
        sum
    }
}

/// A polynomial whose coefficients are known but for an error.
#[derive(Clone, Copy)]
pub(super) struct BernsteinPolynomial {
    degree: usize,
    c: [f64; MAX_PRODUCT_DEGREE + 1],
    /// No coefficient is further off.
    pub(super) error: f64,
}

impl BernsteinPolynomial {
    fn zero(degree: usize) -> Self {
        Self {
            degree,
            c: [0.0; MAX_PRODUCT_DEGREE + 1],
            error: 0.0,
        }
    }

    pub(super) fn coefficients(&self) -> &[f64] {
        &self.c[..=self.degree]
    }

    pub(super) fn negated(mut self) -> Self {
        self.c.iter_mut().for_each(|c| *c = -*c);
        self
    }

    /// Both halves.
    pub(super) fn halves(&self) -> [Self; 2] {
        let (mut left, mut right) = (*self, *self);
        let largest = self
            .coefficients()
            .iter()
            .fold(0.0, |m: f64, c| m.max(c.abs()));
        let error = self.error + self.degree as f64 * EPS * largest;
        [left.error, right.error] = [error; 2];
        for k in 1..=self.degree {
            for i in 0..=self.degree - k {
                right.c[i] = 0.5 * (right.c[i] + right.c[i + 1]);
            }
            left.c[k] = right.c[0];
        }
        [left, right]
    }

    /// Whether it is positive all along; `ends` tells of its ends what is known
    /// better than its coefficients do.
    pub(super) fn is_positive(&self, ends: [EndSign; 2]) -> bool {
        let c = self.coefficients();
        let last = self.degree;
        let end = |known: EndSign, c: f64| match known {
            EndSign::Positive => true,
            EndSign::Not => false,
            EndSign::No => c > self.error,
        };
        // NaN is not.
        end(ends[0], c[0]) && end(ends[1], c[last]) && c[1..last].iter().all(|&c| c > self.error)
    }
}

/// What is known of the sign of a polynomial at an end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EndSign {
    /// Nothing but its coefficient.
    No,
    Positive,
    /// It is zero or negative.
    Not,
}

impl EndSign {
    pub(super) fn of(exact: f64) -> Self {
        if exact > 0.0 {
            Self::Positive
        } else {
            Self::Not
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::nodes::basis;

    fn value(c: &[f64], s: f64) -> f64 {
        let n = c.len() - 1;
        let term = |(i, c): (usize, &f64)| {
            c * binomial(n, i) * s.powi(i as i32) * (1.0 - s).powi((n - i) as i32)
        };
        c.iter().enumerate().map(term).sum()
    }

    #[test]
    fn the_basis_is_that_of_the_film() {
        for n in [1, 2, 7, MAX_NODES] {
            for (k, own) in bernstein_basis(n).iter().enumerate() {
                for i in 0..=20 {
                    let s = f64::from(i) / 20.0;
                    let off = value(own, s) - basis(n, s)[k];
                    assert!(off.abs() < 1e-7, "{n} {k} {s}: {off}");
                }
            }
        }
    }

    #[test]
    fn products_and_halves_are_the_polynomial() {
        let (u, v) = ([1.0, -2.0, 0.5, 3.0], [0.3, 0.7, -1.0, 2.0]);
        let product = BernsteinProducts::of_degree(3).sum(|i, j| u[i] * v[j]);
        let [left, right] = product.halves();
        for i in 0..=10 {
            let s = f64::from(i) / 10.0;
            let expected = value(&u, s) * value(&v, s);
            assert!((value(product.coefficients(), s) - expected).abs() < 1e-12);
            let (half, s) = if s < 0.5 {
                (left, 2.0 * s)
            } else {
                (right, 2.0 * s - 1.0)
            };
            assert!((value(half.coefficients(), s) - expected).abs() < 1e-12);
        }
    }
}
