//! Weights all over a space.

/// The k-th of many weights over so many designs that are spread evenly over all, the same
/// each time: exponential shares of an additive recurrence by the powers of the root of
/// xᵈ⁺¹ = x + 1 (Roberts 2018).
///
/// ```
/// let weights = morphospace::space::weight_samples(7, 3);
/// assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
/// ```
#[must_use]
pub fn spread(k: usize, count: usize) -> Vec<f64> {
    let mut root = 1.5_f64;
    // Some thirty rounds are as many as there are digits.
    for _ in 0..60 {
        root = (1.0 + root).powf(1.0 / (count as f64 + 1.0));
    }
    let share = |j: usize| {
        let step = root.powi(-(j as i32 + 1));
        let place = (0.5 + step * (k as f64 + 1.0)).fract();
        -place.max(1e-12).ln()
    };
    let shares: Vec<f64> = (0..count).map(share).collect();
    let sum: f64 = shares.iter().sum();
    shares.into_iter().map(|share| share / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_spread_over_all() {
        let all: Vec<Vec<f64>> = (0..400).map(|k| spread(k, 3)).collect();
        for design in 0..3 {
            let mean = all.iter().map(|weights| weights[design]).sum::<f64>() / 400.0;
            assert!((mean - 1.0 / 3.0).abs() < 0.02, "{mean}");
            assert!(all.iter().any(|weights| weights[design] > 0.85));
        }
        let sums = all.iter().map(|weights| weights.iter().sum::<f64>());
        assert!(sums.into_iter().all(|sum| (sum - 1.0).abs() < 1e-12));
    }
}
