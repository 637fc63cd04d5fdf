//! Branch-free sine, cosine, exponential and logarithm that the compiler can vectorise.
//!
//! The argument is reduced with π/2 or ln 2 split into several parts (Cody, Waite, "Software
//! Manual for the Elementary Functions", 1980), then a Taylor polynomial is evaluated; the
//! logarithm uses the series of the inverse hyperbolic tangent. Fused multiply-add is avoided,
//! so that results are identical on every machine and for every vector width.
//!
//! Guaranteed: errors of at most 2 units in the last place for sine and cosine with |x| ≤ 1e5,
//! for the exponential with |x| ≤ 708, and for the logarithm of positive normal x. Exact values:
//! sin 0 = 0, cos 0 = 1, exp 0 = 1, ln 1 = 0. For sine and cosine with |x| up to 1e9, and for
//! the logarithm of zero and subnormal x, only finite results are guaranteed. Nothing is
//! guaranteed for infinities and NaN.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_PI, FRAC_PI_2, LN_2, LOG2_E};

/// 1.5 · 2⁵². Adding and then subtracting it rounds a number to an integer; after the addition, the
/// low bits of the sum hold that integer.
const ROUNDING_OFFSET: f64 = 6_755_399_441_055_744.0;

/// 2⁵²; at this magnitude the last bit of an `f64` has the value 1.
const TWO_TO_52: f64 = 4_503_599_627_370_496.0;

/// π/2 as a sum of four numbers (Cody–Waite reduction).
///
/// The first three have at most 33 bits, so that their products with integers below 2²⁰ are
/// exact. Arguments near 1e5 that lie close to a multiple of π/2 need the fourth.
const HALF_PI: [f64; 4] = [
    leading_bits(FRAC_PI_2),
    FRAC_PI_2 - leading_bits(FRAC_PI_2),
    leading_bits(6.123233995736766e-17),
    3.5215598651832e-27,
];

/// ln 2 as a sum of two numbers, the first with 33 bits (Cody–Waite reduction).
const LN_2_PARTS: [f64; 2] = [leading_bits(LN_2), 7.440617110012397e-11];

/// Largest |x| for which eˣ is a normal number.
const MAX_EXPONENT: f64 = 708.0;

/// Coefficients 1/3!, −1/5!, 1/7!, … of P in the Taylor series sin x = x − x³ P(x²). The first
/// omitted term of the series is below 1e-19 at x = π/4.
const SINE: [f64; 8] = reciprocal_factorials(3, 2, -1.0);
/// Coefficients 1/4!, −1/6!, 1/8!, … of P in the Taylor series cos x = 1 − x²/2 + x⁴ P(x²). The
/// first omitted term of the series is below 1e-17 at x = π/4.
const COSINE: [f64; 7] = reciprocal_factorials(4, 2, -1.0);
/// Coefficients 1/2!, 1/3!, … of P in the Taylor series eˣ = 1 + x + x² P(x). The first omitted
/// term of the series is below 1e-17 at x = ln 2 / 2.
const EXPONENTIAL: [f64; 12] = reciprocal_factorials(2, 1, 1.0);

/// Coefficients 1/3, 1/5, 1/7, … of P in the series artanh s = s + s³ P(s²), from which [`ln`] is
/// computed. At the largest s² that occurs, 0.0295, the first omitted term of the series is below
/// 3e-17 of its sum.
const LOGARITHM: [f64; 9] = {
    let mut terms = [0.0; 9];
    let mut k = 0;
    while k < 9 {
        terms[k] = 1.0 / (2 * k + 3) as f64;
        k += 1;
    }
    terms
};

/// Mask of the fraction bits of an `f64`.
const FRACTION_BITS: u64 = (1 << 52) - 1;

/// Truncates a number to its leading 33 bits.
const fn leading_bits(x: f64) -> f64 {
    f64::from_bits(x.to_bits() >> 20 << 20)
}

/// Returns 1/n! for n = first, first + step, …, multiplied by increasing powers of `sign`.
const fn reciprocal_factorials<const N: usize>(first: u32, step: u32, sign: f64) -> [f64; N] {
    let mut terms = [0.0; N];
    let (mut k, mut n, mut factorial) = (0, 1, 1.0);
    while k < N {
        while n < first + step * k as u32 {
            n += 1;
            factorial *= n as f64; // exact up to 18!
        }
        terms[k] = if k % 2 == 1 { sign } else { 1.0 } / factorial;
        k += 1;
    }
    terms
}

/// Evaluates the polynomial Σ aₖ xᵏ by Horner's rule.
#[inline(always)]
fn polynomial<const N: usize>(x: f64, a: &[f64; N]) -> f64 {
    let mut sum = a[N - 1];
    for k in (0..N - 1).rev() {
        sum = sum * x + a[k];
    }
    sum
}

/// Returns the sine and cosine of `x` radians.
#[inline(always)]
pub(super) fn sin_cos(x: f64) -> (f64, f64) {
    let rounded = x * FRAC_2_PI + ROUNDING_OFFSET;
    let (n, quadrant) = (rounded - ROUNDING_OFFSET, rounded.to_bits());
    // The first two subtractions are exact.
    let x = ((x - n * HALF_PI[0]) - n * HALF_PI[1]) - n * HALF_PI[2] - n * HALF_PI[3];
    let square = x * x;
    let sin = x - x * square * polynomial(square, &SINE);
    let half = 0.5 * square;
    let one = 1.0 - half;
    // Restores the digits that rounding removed from 1 − x²/2.
    let lost = (1.0 - one) - half;
    let cos = one + (lost + square * square * polynomial(square, &COSINE));
    // Odd quadrants swap sine and cosine. Each of the two is negative in two of the four quadrants.
    let swap = 0_u64.wrapping_sub(quadrant & 1);
    let (sin, cos) = (sin.to_bits(), cos.to_bits());
    let exchange = (sin ^ cos) & swap;
    (
        f64::from_bits(sin ^ exchange ^ ((quadrant & 2) << 62)),
        f64::from_bits(cos ^ exchange ^ ((quadrant.wrapping_add(1) & 2) << 62)),
    )
}

/// Returns eˣ, with x clamped to ±708.
#[inline(always)]
pub(super) fn exp(x: f64) -> f64 {
    // The exponent field has 11 bits and would wrap around; a clamp needs no branch.
    let x = x.clamp(-MAX_EXPONENT, MAX_EXPONENT);
    let rounded = x * LOG2_E + ROUNDING_OFFSET;
    let n = rounded - ROUNDING_OFFSET;
    let x = (x - n * LN_2_PARTS[0]) - n * LN_2_PARTS[1];
    let power_of_two = f64::from_bits(rounded.to_bits().wrapping_add(1023) << 52);
    (1.0 + (x + x * x * polynomial(x, &EXPONENTIAL))) * power_of_two
}

/// Evaluates the polynomial with the coefficients [`LOGARITHM`] at x, combining its terms in pairs
/// (Estrin 1960).
///
/// With Horner's rule, each step would wait for the previous product. The additional rounding error
/// is a thirtieth of a unit in the last place.
#[inline(always)]
fn logarithm_series(x: f64) -> f64 {
    let a = &LOGARITHM;
    let x2 = x * x;
    let x4 = x2 * x2;
    let low = (a[0] + a[1] * x) + x2 * (a[2] + a[3] * x);
    let high = (a[4] + a[5] * x) + x2 * (a[6] + a[7] * x);
    low + x4 * (high + x4 * a[8])
}

/// Returns the natural logarithm of a positive normal number.
///
/// The number is split into 2ⁿ and a fraction 1 + f between √½ and √2, for which
/// ln(1 + f) = 2 artanh(f / (2 + f)).
#[inline(always)]
pub(super) fn ln(x: f64) -> f64 {
    let half_root = FRAC_1_SQRT_2.to_bits();
    let shifted = x.to_bits().wrapping_add(1.0_f64.to_bits() - half_root);
    // ORing the exponent into the low bits of 2⁵² converts it to a float.
    let n = f64::from_bits((shifted >> 52) | TWO_TO_52.to_bits()) - (TWO_TO_52 + 1023.0);
    let f = f64::from_bits((shifted & FRACTION_BITS) + half_root) - 1.0;
    let s = f / (2.0 + f);
    let square = s * s;
    let rest = 2.0 * square * logarithm_series(square);
    // 2s is written as f − s f because f is exact.
    n * LN_2_PARTS[0] + (f - (s * (f - rest) - n * LN_2_PARTS[1]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the distance of two numbers in units in the last place of the second.
    fn ulps(found: f64, expected: f64) -> f64 {
        let unit = f64::from_bits(expected.abs().to_bits() + 1) - expected.abs();
        ((found - expected) / unit).abs()
    }

    fn assert_close(x: f64) {
        let ((sin, cos), expected) = (sin_cos(x), x.sin_cos());
        assert!(ulps(sin, expected.0) <= 2.0, "sin {x:e}: {sin:e}");
        assert!(ulps(cos, expected.1) <= 2.0, "cos {x:e}: {cos:e}");
    }

    #[test]
    fn zero_is_exact() {
        for zero in [0.0, -0.0] {
            assert_eq!(sin_cos(zero), (0.0, 1.0));
            assert_eq!(exp(zero), 1.0);
            assert!(ln(zero.abs()).is_finite());
        }
        assert_eq!(ln(1.0), 0.0);
    }

    #[test]
    fn parts_add_up_to_their_constants() {
        assert_eq!(HALF_PI[0] + HALF_PI[1], FRAC_PI_2);
        assert_eq!(HALF_PI[2] + HALF_PI[3], FRAC_PI_2.cos()); // π/2 − FRAC_PI_2
        assert_eq!(LN_2_PARTS[0] + LN_2_PARTS[1], LN_2);
    }

    #[test]
    fn angles_next_to_quarter_turns_keep_their_last_bits() {
        for n in -63_661..=63_661 {
            let x = f64::from(n) * FRAC_PI_2;
            [x.next_down(), x, x.next_up()]
                .into_iter()
                .for_each(assert_close);
        }
    }

    #[test]
    fn exponents_are_bounded() {
        assert_eq!(exp(1e300), exp(708.0));
        assert_eq!(exp(-1e300), exp(-708.0));
        assert!(exp(-708.0) >= f64::MIN_POSITIVE && exp(708.0) <= f64::MAX);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn sine_and_cosine_are_close_to_the_standard_ones(
            large in -1e5f64..1e5, usual in -10.0f64..10.0, small in -1e-3f64..1e-3,
        ) {
            [large, usual, small].into_iter().for_each(assert_close);
        }

        #[test]
        fn exponential_is_close_to_the_standard_one(large in -708.0f64..708.0, usual in -2.0f64..2.0) {
            for x in [large, usual] {
                prop_assert!(ulps(exp(x), x.exp()) <= 2.0, "{x:e}");
            }
        }

        #[test]
        fn logarithm_is_close_to_the_standard_one(
            exponent in -708.0f64..708.0, usual in 0.01f64..10.0, near in -1e-3f64..1e-3,
        ) {
            for x in [exponent.exp(), usual, 1.0 + near, 1.0 + 1e-9 * near] {
                prop_assert!(ulps(ln(x), x.ln()) <= 2.0, "{x:e}");
            }
        }
    }
}
