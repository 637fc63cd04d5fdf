//! Chooses the fewest keyframes between which linear interpolation stays within a tolerance.
//!
//! Keyframes are a subset of the samples. From a given keyframe, lines of a certain range of slopes
//! pass all samples so far within the tolerance; each further sample narrows this range. A sample
//! that lies on one of these lines can be the next keyframe. The smallest set of keyframes is then
//! a shortest path from the first sample to the last (Imai and Iri 1988).

/// Returns the indices of the fewest rows, including the first and the last, such that linear
/// interpolation between them reproduces every number of all other rows within the tolerance. A row
/// holds the numbers sampled at one time; `places` holds the time of each row, ascending.
///
/// The running time is proportional to the product of the number of rows, the number of numbers per
/// row, and the number of rows that one line can follow.
pub(super) fn fewest_keys(places: &[f64], rows: &[Vec<f64>], tolerance: f64) -> Vec<usize> {
    let count = rows.len();
    // For each row, if it is a keyframe: the minimum number of keyframes after it, and the index of
    // the next one. The entries are computed from the last row backwards.
    let mut next_keys = vec![(0, 0); count];
    for from in (0..count.saturating_sub(1)).rev() {
        let mut best = (usize::MAX, from + 1);
        reach(places, rows, tolerance, from, |to| {
            let keys: usize = next_keys[to].0 + 1;
            // Of the rows that lead to equally few keyframes, the last is used, because it gives
            // the longest line.
            if keys <= best.0 {
                best = (keys, to);
            }
        });
        next_keys[from] = best;
    }
    let mut keys = vec![0];
    let mut at = 0;
    while at + 1 < count {
        at = next_keys[at].1;
        keys.push(at);
    }
    keys
}

/// Calls `visit` with the index of each row that can be the next keyframe after the row `from`: the
/// straight line between the two rows passes all rows in between within the tolerance.
fn reach(
    places: &[f64],
    rows: &[Vec<f64>],
    tolerance: f64,
    from: usize,
    mut visit: impl FnMut(usize),
) {
    let mut slopes = vec![[f64::NEG_INFINITY, f64::INFINITY]; rows[from].len()];
    for to in from + 1..rows.len() {
        let run = places[to] - places[from];
        let mut can_be_key = true;
        let numbers = slopes.iter_mut().zip(&rows[from]).zip(&rows[to]);
        let has_slopes = numbers.map(|((slope, a), b)| {
            let rise = b - a;
            can_be_key &= slope[0] * run <= rise && rise <= slope[1] * run;
            slope[0] = slope[0].max((rise - tolerance) / run);
            slope[1] = slope[1].min((rise + tolerance) / run);
            slope[0] <= slope[1]
        });
        // The empty ranges of slopes are counted, because `all` would stop at the first one and
        // would not update the remaining ranges.
        let is_open = has_slopes.filter(|is_open| !is_open).count() == 0;
        if can_be_key || to == from + 1 {
            visit(to);
        }
        if !is_open {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(count: usize, f: impl Fn(f64) -> Vec<f64>) -> (Vec<f64>, Vec<Vec<f64>>) {
        let places: Vec<f64> = (0..count).map(|k| k as f64).collect();
        let rows = places.iter().map(|&x| f(x)).collect();
        (places, rows)
    }

    #[test]
    fn straight_lines_need_two_keys_and_corners_one_more() {
        let (places, rows) = sampled(50, |x| vec![3.0 * x, 1.0 - x, 4.0]);
        assert_eq!(fewest_keys(&places, &rows, 1e-9), [0, 49]);
        let (places, rows) = sampled(50, |x| vec![(x - 20.0).abs(), x]);
        assert_eq!(fewest_keys(&places, &rows, 1e-9), [0, 20, 49]);
        assert_eq!(fewest_keys(&places[..1], &rows[..1], 1.0), [0]);
    }

    /// Returns the minimum number of keys, by exhaustive dynamic programming.
    fn brute(places: &[f64], rows: &[Vec<f64>], tolerance: f64) -> usize {
        let fits = |i: usize, j: usize| {
            (i + 1..j).all(|k| {
                let s = (places[k] - places[i]) / (places[j] - places[i]);
                let off = |c: usize| rows[i][c] * (1.0 - s) + rows[j][c] * s - rows[k][c];
                (0..rows[k].len()).all(|c| off(c).abs() <= tolerance)
            })
        };
        let mut best = vec![usize::MAX; rows.len()];
        best[0] = 1;
        for j in 1..rows.len() {
            let ways = (0..j).filter(|&i| fits(i, j)).map(|i| best[i] + 1);
            best[j] = ways.min().expect("the row before");
        }
        best[rows.len() - 1]
    }

    #[test]
    fn no_subset_has_fewer_keys() {
        for wave in [0.05, 0.2, 0.7, 1.9] {
            let f = |x: f64| vec![(wave * x).sin(), (0.3 * wave * x).cos() * 2.0];
            let (places, rows) = sampled(60, f);
            for tolerance in [0.01, 0.1, 0.5] {
                let keys = fewest_keys(&places, &rows, tolerance);
                let expected = brute(&places, &rows, tolerance);
                assert_eq!(keys.len(), expected, "wave {wave}, within {tolerance}");
            }
        }
    }
}
