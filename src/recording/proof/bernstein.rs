//! Polynomials in Bernstein form with error bounds: products, halving, and proofs of positivity.
//!
//! On [0, 1] a polynomial lies between the smallest and the largest of its Bernstein coefficients.
//! Its values at 0 and 1 are the first and the last coefficient. De Casteljau's algorithm computes
//! the coefficients of the two halves of the interval.

use crate::recording::nodes::MAX_NODES;

/// Largest degree of a vertex coordinate as a polynomial of s (derived: the polynomial is
/// determined by its values at the nodes and at both ends of the interval).
const MAX_DEGREE: usize = MAX_NODES + 1;
/// Largest degree of a product of two coordinates (derived).
pub(super) const MAX_PRODUCT_DEGREE: usize = 2 * MAX_DEGREE;

/// Bound on the relative rounding error of one floating-point operation.
pub(crate) const EPS: f64 = f64::EPSILON;

/// Returns the binomial coefficient of `n` over `k`; exact for n up to 50, and accurate to a few
/// roundings for larger ones.
fn binomial(n: usize, k: usize) -> f64 {
    (0..k.min(n - k)).fold(1.0, |c, i| (c * (n - i) as f64 / (i + 1) as f64).round())
}

/// Returns the Bernstein coefficients of the basis functions of a recording, 4s(1 − s) T_k(2s − 1)
/// for each k below `n`, all in degree n + 1.
pub(super) fn bernstein_basis(n: usize) -> Vec<Vec<f64>> {
    let degree = n + 1;
    let of = |k: usize| -> Vec<f64> {
        // In degree k, T_k(2s − 1) has the Bernstein coefficients (−1)^(k−i) C(2k, 2i) / C(k, i).
        let sign = |i: usize| if (k - i).is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut coefficients: Vec<f64> = (0..=k)
            .map(|i| sign(i) * binomial(2 * k, 2 * i) / binomial(k, i))
            .collect();
        // Multiplies by 4s(1 − s), whose Bernstein coefficients in degree 2 are 0, 2, 0.
        let inner = coefficients
            .iter()
            .enumerate()
            .map(|(i, c)| 2.0 * c * 2.0 * binomial(k, i) / binomial(k + 2, i + 1));
        coefficients = [0.0].into_iter().chain(inner).chain([0.0]).collect();
        while coefficients.len() <= degree {
            coefficients = degree_elevated(&coefficients);
        }
        coefficients
    };
    (0..n).map(of).collect()
}

/// Returns the Bernstein coefficients of the same polynomial in the next higher degree.
pub(crate) fn degree_elevated(coefficients: &[f64]) -> Vec<f64> {
    let degree = coefficients.len();
    let at = |i: usize| coefficients.get(i).copied().unwrap_or(0.0);
    let coefficient = |i: usize| {
        let share = i as f64 / degree as f64;
        let before = if i > 0 { at(i - 1) } else { 0.0 };
        share * before + (1.0 - share) * at(i)
    };
    (0..=degree).map(coefficient).collect()
}

/// Weights for multiplying two polynomials of the same degree in Bernstein form.
pub(crate) struct BernsteinProducts {
    degree: usize,
    weights: Vec<f64>,
}

impl BernsteinProducts {
    /// Computes the weights for factors of the given degree.
    pub(crate) fn of_degree(degree: usize) -> Self {
        let weight = |i: usize, j: usize| {
            binomial(degree, i) * binomial(degree, j) / binomial(2 * degree, i + j)
        };
        let pairs = (0..=degree).flat_map(|i| (0..=degree).map(move |j| (i, j)));
        Self {
            degree,
            weights: pairs.map(|(i, j)| weight(i, j)).collect(),
        }
    }

    /// Returns the weight of the product of the coefficients `i` and `j` in the coefficient i + j.
    pub(crate) fn weight(&self, i: usize, j: usize) -> f64 {
        self.weights[i * (self.degree + 1) + j]
    }

    /// Returns the polynomial whose coefficient with index k is the weighted sum of `of(i, j)` over
    /// all i + j = k. If `of(i, j)` is uᵢ vⱼ, this is the product of the polynomials with the
    /// coefficients u and v. The error bound of the result is left at 0.
    pub(super) fn sum(&self, of: impl Fn(usize, usize) -> f64) -> BernsteinPolynomial {
        let mut sum = BernsteinPolynomial::zero(2 * self.degree);
        for i in 0..=self.degree {
            for j in 0..=self.degree {
                sum.c[i + j] += self.weight(i, j) * of(i, j);
            }
        }
        sum
    }
}

/// Polynomial in Bernstein form with an error bound.
#[derive(Clone, Copy)]
pub(super) struct BernsteinPolynomial {
    degree: usize,
    c: [f64; MAX_PRODUCT_DEGREE + 1],
    /// Bound on the absolute error of each coefficient.
    pub(super) error: f64,
}

impl BernsteinPolynomial {
    /// Returns the zero polynomial of the given degree.
    fn zero(degree: usize) -> Self {
        Self {
            degree,
            c: [0.0; MAX_PRODUCT_DEGREE + 1],
            error: 0.0,
        }
    }

    /// Returns the Bernstein coefficients.
    pub(super) fn coefficients(&self) -> &[f64] {
        &self.c[..=self.degree]
    }

    /// Returns the polynomial multiplied by −1.
    pub(super) fn negated(mut self) -> Self {
        self.c.iter_mut().for_each(|c| *c = -*c);
        self
    }

    /// Returns the polynomial on the two halves of its interval, each rescaled to [0, 1].
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

    /// Returns whether the polynomial is proved to be positive on [0, 1]. `ends` contains the signs
    /// of the polynomial at 0 and at 1, as far as they are known exactly.
    pub(super) fn is_positive(&self, ends: [EndSign; 2]) -> bool {
        let c = self.coefficients();
        let last = self.degree;
        let end = |known: EndSign, c: f64| match known {
            EndSign::Positive => true,
            EndSign::NotPositive => false,
            EndSign::Unknown => c > self.error,
        };
        // Comparisons with NaN are false, so a polynomial with NaN is not proved.
        end(ends[0], c[0]) && end(ends[1], c[last]) && c[1..last].iter().all(|&c| c > self.error)
    }
}

/// Sign of a polynomial at an end of its interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EndSign {
    /// Not known exactly; the computed coefficient decides.
    Unknown,
    /// Known to be positive.
    Positive,
    /// Known to be zero or negative.
    NotPositive,
}

impl EndSign {
    /// Returns the sign of the polynomial, given the result `exact` of an exact predicate that has
    /// the same sign.
    pub(super) fn of(exact: f64) -> Self {
        if exact > 0.0 {
            Self::Positive
        } else {
            Self::NotPositive
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
    fn the_basis_equals_the_basis_of_a_recording() {
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
    fn products_and_halves_match_the_polynomial() {
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
