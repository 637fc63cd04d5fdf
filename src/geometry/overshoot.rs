//! Two measures of the overshoot of a quantity during a motion. The first is how far the quantity
//! rises above the straight line from its first to its last value. The second is how much it rises
//! and falls in all, minus the difference of its first and last values.

/// Returns the largest relative excess of samples `[t, value]` over the straight line between the
/// first and the last value; 0 if none exceeds it. The first sample has t = 0, the last one t = 1.
pub(crate) fn max_overshoot(measured: &[[f64; 2]]) -> f64 {
    let (Some([_, first]), Some([_, last])) = (measured.first(), measured.last()) else {
        return 0.0;
    };
    let relative_excess = |[t, value]: &[f64; 2]| {
        let between = (1.0 - t) * first + t * last;
        // An excess over 0 has no relative size, so it does not count.
        if between > 0.0 {
            value / between - 1.0
        } else {
            0.0
        }
    };
    measured.iter().map(relative_excess).fold(0.0, f64::max)
}

/// Returns the rise and fall of a sequence in excess of the difference between its first and last
/// values, relative to the larger of these two: (Σ |Δ| − |last − first|) / max(|first|, |last|).
pub(crate) fn excess_variation(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return 0.0;
    };
    let variation: f64 = values.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    let scale = first.abs().max(last.abs());
    // A quantity whose first and last values are 0 has no scale to compare with.
    if scale > 0.0 {
        ((variation - (last - first).abs()) / scale).max(0.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_values_above_the_line_between_the_ends_are_excess() {
        assert_eq!(max_overshoot(&[[0.0, 6.0], [0.5, 7.0], [1.0, 8.0]]), 0.0);
        assert_eq!(max_overshoot(&[[0.0, 6.0], [0.5, 14.0], [1.0, 8.0]]), 1.0);
        assert_eq!(max_overshoot(&[]), 0.0);
    }

    #[test]
    fn a_monotone_sequence_has_no_excess() {
        assert_eq!(excess_variation([1.0, 2.0, 4.0].into_iter()), 0.0);
        assert_eq!(excess_variation([4.0, 4.0, 1.0].into_iter()), 0.0);
        assert_eq!(excess_variation(std::iter::empty()), 0.0);
    }

    #[test]
    fn a_dip_counts_down_and_up() {
        assert_eq!(excess_variation([4.0, 1.0, 4.0].into_iter()), 1.5);
    }
}
