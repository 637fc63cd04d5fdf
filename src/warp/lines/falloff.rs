//! How weight falls with q = a + dist: strength / q^b.
//!
//! Places come in pairs of vectors: one division does for both weights, as
//! 1/q = (the other q) / (product of both).

use crate::warp::elementary::{exp, ln};
use pulp::{Simd, bytemuck};

/// How many vectors share a division. Four would share it as well, but more
/// of their numbers than there are registers for.
pub(super) const GROUP: usize = 2;

/// Vectors that are handled together.
pub(super) type Group<S> = [<S as Simd>::f64s; GROUP];

/// A b.
pub(super) trait Falloff: Copy {
    /// `strength` / q^b.
    fn weights<S: Simd>(self, simd: S, strength: S::f64s, q: Group<S>) -> Group<S>;
}

/// b = 1.
#[derive(Clone, Copy)]
pub(super) struct Inverse;

/// b = 2.
#[derive(Clone, Copy)]
pub(super) struct Square;

/// Any b.
#[derive(Clone, Copy)]
pub(super) struct Power(pub(super) f64);

impl Falloff for Inverse {
    #[inline(always)]
    fn weights<S: Simd>(self, simd: S, strength: S::f64s, [p, q]: Group<S>) -> Group<S> {
        let both = simd.div_f64s(strength, simd.mul_f64s(p, q));
        [simd.mul_f64s(both, q), simd.mul_f64s(both, p)]
    }
}

impl Falloff for Square {
    #[inline(always)]
    fn weights<S: Simd>(self, simd: S, strength: S::f64s, [p, q]: Group<S>) -> Group<S> {
        let squares = [simd.mul_f64s(p, p), simd.mul_f64s(q, q)];
        Inverse.weights(simd, strength, squares)
    }
}

impl Falloff for Power {
    #[inline(always)]
    fn weights<S: Simd>(self, simd: S, strength: S::f64s, mut q: Group<S>) -> Group<S> {
        for value in bytemuck::cast_slice_mut::<_, f64>(&mut q) {
            *value = exp(-self.0 * ln(*value));
        }
        [simd.mul_f64s(strength, q[0]), simd.mul_f64s(strength, q[1])]
    }
}
