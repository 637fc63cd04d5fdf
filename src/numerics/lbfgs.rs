//! L-BFGS minimisation of a smooth function (Liu, Nocedal 1989) with a weak Wolfe line search by
//! bisection (Lewis, Overton 2013).
//!
//! The function may be infinite at some points: steps to such points are shortened, so a search
//! that starts at a finite value stays finite. Guaranteed: the function's value at the result is
//! never higher than at the start. Not guaranteed: that the result is close to a minimum. A cancel
//! ends the search early, at the best point so far.

use crate::work::progress::Progress;

/// Maximum number of earlier steps that are remembered, each with the change of the gradient along
/// it (cited: the literature uses 3 to 20; each remembered step adds two passes over all unknowns).
const MEMORY: usize = 12;
/// Minimum decrease of the function along a step, as a fraction of the decrease that the slope at
/// the start of the step predicts (Armijo condition; cited: Nocedal, Wright, "Numerical
/// Optimization").
const DECREASE: f64 = 1e-4;
/// Maximum steepness of the function at the end of a step, as a fraction of the steepness at the
/// start of the step (curvature condition; cited: Nocedal, Wright, "Numerical Optimization").
const CURVATURE: f64 = 0.9;
/// Maximum number of trials in one line search (resource limit: after 25 halvings, the length of a
/// step is 3e-8 of its first length).
const MAX_TRIALS: usize = 25;

/// Moves `x` downhill by at most `max_steps` steps and returns the value of `function` at the new
/// `x`.
///
/// `function` returns the value at a point and writes the gradient to its second argument;
/// `precondition` applies an approximate inverse of the second derivative in place. Stops early on
/// a cancel, or after a step that lowers the value by at most `min_decrease` times its magnitude.
pub(crate) fn minimise(
    x: &mut [f64],
    max_steps: usize,
    min_decrease: f64,
    mut precondition: impl FnMut(&mut [f64]),
    mut function: impl FnMut(&[f64], &mut [f64]) -> f64,
    progress: &dyn Progress,
) -> f64 {
    // After a cancel every evaluation returns infinity, so the line search rejects all further
    // trial points and ends.
    let mut function = |x: &[f64], gradient: &mut [f64]| {
        if progress.is_cancelled() {
            return f64::INFINITY;
        }
        function(x, gradient)
    };
    let mut gradient = vec![0.0; x.len()];
    let mut value = function(x, &mut gradient);
    let mut memory: Vec<CurvaturePair> = Vec::new();
    for _ in 0..max_steps {
        let direction = direction(&memory, &gradient, &mut precondition);
        let Some(accepted) = search(x, value, &gradient, &direction, &mut function) else {
            break;
        };
        let before = value;
        remember(&mut memory, x, &gradient, &accepted, &mut precondition);
        x.copy_from_slice(&accepted.x);
        gradient = accepted.gradient;
        value = accepted.value;
        if before - value <= min_decrease * before.abs() {
            break;
        }
    }
    value
}

/// Step of the minimisation, and the change of the gradient along it.
struct CurvaturePair {
    step: Vec<f64>,
    /// Change of the gradient along the step.
    change: Vec<f64>,
    /// Dot product of `step` and `change`.
    product: f64,
    /// Factor by which the preconditioner is multiplied. With it, the preconditioner applied to
    /// `change` has the same dot product with `change` as `step`.
    scale: f64,
}

/// Point tried by the line search.
struct LineSearchPoint {
    x: Vec<f64>,
    gradient: Vec<f64>,
    value: f64,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds `by` times `b` to `a`.
fn add_scaled(a: &mut [f64], by: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += by * b);
}

/// Returns the descent direction of L-BFGS, by the two-loop recursion over the remembered steps.
fn direction(
    memory: &[CurvaturePair],
    gradient: &[f64],
    precondition: &mut impl FnMut(&mut [f64]),
) -> Vec<f64> {
    let mut d: Vec<f64> = gradient.iter().map(|g| -g).collect();
    let mut shares = Vec::with_capacity(memory.len());
    // The first loop runs from the newest remembered step to the oldest.
    for pair in memory.iter().rev() {
        let share = dot(&pair.step, &d) / pair.product;
        add_scaled(&mut d, -share, &pair.change);
        shares.push(share);
    }
    // The preconditioner is the initial inverse Hessian, applied between the two loops.
    precondition(&mut d);
    let scale = memory.last().map_or(1.0, |last| last.scale);
    d.iter_mut().for_each(|d| *d *= scale);
    // The second loop runs from the oldest remembered step to the newest.
    for (pair, share) in memory.iter().zip(shares.iter().rev()) {
        let back = dot(&pair.change, &d) / pair.product;
        add_scaled(&mut d, share - back, &pair.step);
    }
    d
}

/// Searches along a direction for a step that meets the weak Wolfe conditions. If none is found,
/// returns the last trial point that is low enough but where the slope is still steep; `None` if
/// there is no such point.
fn search(
    x: &[f64],
    value: f64,
    gradient: &[f64],
    direction: &[f64],
    function: &mut impl FnMut(&[f64], &mut [f64]) -> f64,
) -> Option<LineSearchPoint> {
    // Stop if the direction does not descend: this is a minimum, or the remembered steps are spoilt
    // by rounding.
    let slope = dot(gradient, direction);
    if !value.is_finite() || slope.is_nan() || slope >= 0.0 {
        return None;
    }
    let (mut low, mut high, mut length) = (0.0, f64::INFINITY, 1.0);
    let mut best: Option<LineSearchPoint> = None;
    for _ in 0..MAX_TRIALS {
        let mut trial = LineSearchPoint {
            x: x.to_vec(),
            gradient: vec![0.0; x.len()],
            value: 0.0,
        };
        add_scaled(&mut trial.x, length, direction);
        trial.value = function(&trial.x, &mut trial.gradient);
        // If the value is +∞ or NaN, this comparison is false, and a shorter step is tried next.
        let descends = trial.value <= value + DECREASE * length * slope;
        if !descends {
            high = length;
        } else if dot(&trial.gradient, direction) < CURVATURE * slope {
            // The value is lower, but the slope is still steep: keep this step in case all longer
            // ones are rejected.
            low = length;
            best = Some(trial);
        } else {
            return Some(trial);
        }
        // Double the step until an upper limit is known, and bisect from then on.
        length = if high.is_finite() {
            0.5 * (low + high)
        } else {
            2.0 * low
        };
    }
    best
}

/// Adds a step to the memory; if the memory is full, drops the oldest step first. Ignores a step
/// along which the slope does not rise.
fn remember(
    memory: &mut Vec<CurvaturePair>,
    x: &[f64],
    gradient: &[f64],
    accepted: &LineSearchPoint,
    precondition: &mut impl FnMut(&mut [f64]),
) {
    let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
    let (step, change) = (minus(&accepted.x, x), minus(&accepted.gradient, gradient));
    let product = dot(&step, &change);
    // The two-loop recursion divides by the product of step and gradient change. It is sure to give
    // a descent direction only if all products are positive. The threshold is above 0 to exclude
    // products that are mere rounding.
    if product > 1e-14 * dot(&change, &change) {
        if memory.len() == MEMORY {
            memory.remove(0);
        }
        let mut answer = change.clone();
        precondition(&mut answer);
        memory.push(CurvaturePair {
            scale: product / dot(&change, &answer),
            step,
            change,
            product,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::progress::Silent;

    #[test]
    fn a_curved_valley_is_followed_to_its_end() {
        let mut x = vec![-1.2, 1.0];
        let value = minimise(
            &mut x,
            100,
            0.0,
            |_| (),
            |x, g| {
                let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
                g[0] = -2.0 * a - 400.0 * x[0] * b;
                g[1] = 200.0 * b;
                a * a + 100.0 * b * b
            },
            &Silent,
        );
        assert!(value < 1e-12 && (x[0] - 1.0).abs() < 1e-5, "{value} {x:?}");
    }

    #[test]
    fn a_barrier_is_never_crossed() {
        let mut x = vec![1e-3];
        let value = minimise(
            &mut x,
            100,
            0.0,
            |_| (),
            |x, g| {
                g[0] = 1.0 - 1e-6 / (x[0] * x[0]);
                if x[0] > 0.0 {
                    x[0] + 1e-6 / x[0]
                } else {
                    f64::INFINITY
                }
            },
            &Silent,
        );
        assert!((value - 2e-3).abs() < 1e-9 && x[0] > 0.0);
    }
}
