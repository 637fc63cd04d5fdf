//! Minimisation of a smooth function by limited-memory BFGS (Liu, Nocedal
//! 1989) with a weak Wolfe line search by bisection (Lewis, Overton 2013).
//!
//! The function may be infinite: such steps are shortened, so that what
//! starts finite stays finite. Nothing is promised about how near the
//! minimum the result is; it is never higher than the start. A cancel ends it
//! early, at what was reached.

use crate::work::progress::Progress;

/// Pairs of steps and gradient changes that are remembered: the literature's
/// 3 to 20, each two more passes over all unknowns.
const MEMORY: usize = 12;
/// Least share of the predicted decrease (Armijo); this and the next are the
/// values of Nocedal and Wright's "Numerical Optimization" for such methods.
const DECREASE: f64 = 1e-4;
/// How much of the slope may be left (Wolfe).
const CURVATURE: f64 = 0.9;
/// Trials of one line search: halved so often, a step is 3e-8 of itself.
const TRIALS: usize = 25;

/// Moves `x` downhill by at most `rounds` steps and returns the value there.
/// `function` gives the value and fills the gradient; `precondition` applies
/// an approximate inverse of its second derivative in place. Stops early when
/// a step lowers the value by less than the share `enough`, and on a cancel.
pub(crate) fn minimise(
    x: &mut [f64],
    rounds: usize,
    enough: f64,
    mut precondition: impl FnMut(&mut [f64]),
    mut function: impl FnMut(&[f64], &mut [f64]) -> f64,
    progress: &dyn Progress,
) -> f64 {
    // Infinite values make the search end as a barrier does.
    let mut function = |x: &[f64], gradient: &mut [f64]| {
        if progress.is_cancelled() {
            return f64::INFINITY;
        }
        function(x, gradient)
    };
    let mut gradient = vec![0.0; x.len()];
    let mut value = function(x, &mut gradient);
    let mut memory: Vec<CurvaturePair> = Vec::new();
    for _ in 0..rounds {
        let direction = direction(&memory, &gradient, &mut precondition);
        let Some(found) = search(x, value, &gradient, &direction, &mut function) else {
            break;
        };
        let before = value;
        remember(&mut memory, x, &gradient, &found, &mut precondition);
        x.copy_from_slice(&found.x);
        gradient = found.gradient;
        value = found.value;
        if before - value <= enough * before.abs() {
            break;
        }
    }
    value
}

struct CurvaturePair {
    step: Vec<f64>,
    change: Vec<f64>,
    product: f64,
    /// What the preconditioner is off by along this step.
    scale: f64,
}

struct LineSearchPoint {
    x: Vec<f64>,
    gradient: Vec<f64>,
    value: f64,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add_scaled(a: &mut [f64], by: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += by * b);
}

fn direction(
    memory: &[CurvaturePair],
    gradient: &[f64],
    precondition: &mut impl FnMut(&mut [f64]),
) -> Vec<f64> {
    let mut d: Vec<f64> = gradient.iter().map(|g| -g).collect();
    let mut shares = Vec::with_capacity(memory.len());
    for pair in memory.iter().rev() {
        let share = dot(&pair.step, &d) / pair.product;
        add_scaled(&mut d, -share, &pair.change);
        shares.push(share);
    }
    // Between the two loops: the springs stand for the first guess of the
    // second derivative's inverse.
    precondition(&mut d);
    let scale = memory.last().map_or(1.0, |last| last.scale);
    d.iter_mut().for_each(|d| *d *= scale);
    for (pair, share) in memory.iter().zip(shares.iter().rev()) {
        let back = dot(&pair.change, &d) / pair.product;
        add_scaled(&mut d, share - back, &pair.step);
    }
    d
}

fn search(
    x: &[f64],
    value: f64,
    gradient: &[f64],
    direction: &[f64],
    function: &mut impl FnMut(&[f64], &mut [f64]) -> f64,
) -> Option<LineSearchPoint> {
    // Uphill only where rounding has spoilt the memory, or at a minimum.
    let slope = dot(gradient, direction);
    if !value.is_finite() || slope.is_nan() || slope >= 0.0 {
        return None;
    }
    let (mut low, mut high, mut length) = (0.0, f64::INFINITY, 1.0);
    let mut best: Option<LineSearchPoint> = None;
    for _ in 0..TRIALS {
        let mut trial = LineSearchPoint {
            x: x.to_vec(),
            gradient: vec![0.0; x.len()],
            value: 0.0,
        };
        add_scaled(&mut trial.x, length, direction);
        trial.value = function(&trial.x, &mut trial.gradient);
        // Outside the barrier the value is infinite, or NaN: no descent either.
        let descends = trial.value <= value + DECREASE * length * slope;
        if !descends {
            high = length;
        } else if dot(&trial.gradient, direction) < CURVATURE * slope {
            // Lower, but still as steep: kept, in case nothing longer is found.
            low = length;
            best = Some(trial);
        } else {
            return Some(trial);
        }
        length = if high.is_finite() {
            0.5 * (low + high)
        } else {
            2.0 * low
        };
    }
    best
}

fn remember(
    memory: &mut Vec<CurvaturePair>,
    x: &[f64],
    gradient: &[f64],
    found: &LineSearchPoint,
    precondition: &mut impl FnMut(&mut [f64]),
) {
    let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
    let (step, change) = (minus(&found.x, x), minus(&found.gradient, gradient));
    let product = dot(&step, &change);
    // The loops divide by it, and go downhill for sure only where the slope has
    // risen along the step.
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
