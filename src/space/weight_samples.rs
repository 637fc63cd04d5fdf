//! Deterministic sample of weights, spread evenly over a design space.

/// Returns the k-th sample of the weights of `count` designs, evenly spread over all weights.
///
/// The samples are a low-discrepancy sequence: an additive recurrence whose steps are powers of
/// 1/x, where x solves xᵈ⁺¹ = x + 1 for d = `count` (Roberts 2018). They are mapped to the simplex
/// by normalised exponential variates.
///
/// ```
/// let weights = morphospace::space::weight_sample(7, 3);
/// assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
/// ```
#[must_use]
pub fn weight_sample(k: usize, count: usize) -> Vec<f64> {
    let mut root = 1.5_f64;
    // The iteration x ← (1 + x)^(1 / (count + 1)) reaches machine precision after about thirty
    // repetitions.
    for _ in 0..60 {
        root = (1.0 + root).powf(1.0 / (count as f64 + 1.0));
    }
    let exponential = |j: usize| {
        let step = root.powi(-(j as i32 + 1));
        let place = (0.5 + step * (k as f64 + 1.0)).fract();
        -place.max(1e-12).ln()
    };
    let variates: Vec<f64> = (0..count).map(exponential).collect();
    let sum: f64 = variates.iter().sum();
    variates.into_iter().map(|variate| variate / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_cover_the_whole_space_evenly() {
        let all: Vec<Vec<f64>> = (0..400).map(|k| weight_sample(k, 3)).collect();
        for design in 0..3 {
            let mean = all.iter().map(|weights| weights[design]).sum::<f64>() / 400.0;
            assert!((mean - 1.0 / 3.0).abs() < 0.02, "{mean}");
            assert!(all.iter().any(|weights| weights[design] > 0.85));
        }
        let sums = all.iter().map(|weights| weights.iter().sum::<f64>());
        assert!(sums.into_iter().all(|sum| (sum - 1.0).abs() < 1e-12));
    }
}
