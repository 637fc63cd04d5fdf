//! What a quantity does on its way from one end to the other beyond what its ends need.

/// By how much what was measured at `t` exceeds what lies between the ends, as a
/// share of that, where it does so most; pairs `[t, W]`, t from 0 to 1.
pub(crate) fn max_overshoot(measured: &[[f64; 2]]) -> f64 {
    let (Some([_, first]), Some([_, last])) = (measured.first(), measured.last()) else {
        return 0.0;
    };
    let share = |[t, found]: &[f64; 2]| {
        let between = (1.0 - t) * first + t * last;
        if between > 0.0 {
            found / between - 1.0
        } else {
            0.0
        }
    };
    measured.iter().map(share).fold(0.0, f64::max)
}

/// How much a quantity runs up and down beyond what its ends need, as a
/// fraction of the larger end: (Σ |Δ| − |end − end|) / max(|end|).
pub(crate) fn excess_variation(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return 0.0;
    };
    let variation: f64 = values.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    let scale = first.abs().max(last.abs());
    // What is 0 at both ends has no scale to be held against.
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
    fn only_what_lies_above_the_line_between_the_ends_is_too_much() {
        assert_eq!(max_overshoot(&[[0.0, 6.0], [0.5, 7.0], [1.0, 8.0]]), 0.0);
        assert_eq!(max_overshoot(&[[0.0, 6.0], [0.5, 14.0], [1.0, 8.0]]), 1.0);
        assert_eq!(max_overshoot(&[]), 0.0);
    }

    #[test]
    fn a_monotone_run_has_no_excess() {
        assert_eq!(excess_variation([1.0, 2.0, 4.0].into_iter()), 0.0);
        assert_eq!(excess_variation([4.0, 4.0, 1.0].into_iter()), 0.0);
        assert_eq!(excess_variation(std::iter::empty()), 0.0);
    }

    #[test]
    fn a_dip_counts_down_and_up() {
        assert_eq!(excess_variation([4.0, 1.0, 4.0].into_iter()), 1.5);
    }
}
