//! What found points are called: letters, which stay with a point while others come and go.
//!
//! Pins have numbers, those of the project, which messages name.

use crate::correspondence::PointPair;

/// A point is the same as before where one of its ends lies no farther away than this share of the
/// designs: the match that a pin has changed moves points a little along their outline.
pub const SAME: f64 = 0.02;

/// The letters of `points`, 0 for a: those of the points before that are the same, within `reach`,
/// and for the others the first that are free.
#[must_use]
pub fn kept(points: &[PointPair], before: &[(PointPair, usize)], reach: f64) -> Vec<usize> {
    let distance = |a: &PointPair, b: &PointPair| {
        let [source, target] = [a.source.distance(b.source), a.target.distance(b.target)];
        source.min(target)
    };
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (k, point) in points.iter().enumerate() {
        for (other, letter) in before {
            let apart = distance(point, other);
            if apart <= reach {
                pairs.push((apart, k, *letter));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut letters = vec![None; points.len()];
    for (_, k, letter) in pairs {
        if letters[k].is_none() && !letters.contains(&Some(letter)) {
            letters[k] = Some(letter);
        }
    }
    let taken = letters.clone();
    let mut free = (0..).filter(|letter| !taken.contains(&Some(*letter)));
    let own = letters.into_iter();
    own.map(|letter| letter.or_else(|| free.next()).unwrap_or_default())
        .collect()
}

/// a to z, and then aa, ab …
#[must_use]
pub fn letter(number: usize) -> String {
    let sign = |k: usize| char::from(b'a' + (k % 26) as u8);
    match number / 26 {
        0 => sign(number).to_string(),
        round => [sign(round - 1), sign(number)].iter().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DVec2;

    fn point(x: f64) -> PointPair {
        PointPair {
            source: DVec2::new(x, 0.0),
            target: DVec2::new(x, 5.0),
        }
    }

    #[test]
    fn a_point_that_stays_keeps_its_letter() {
        let before = [(point(0.0), 0), (point(1.0), 1), (point(2.0), 2)];
        let now = [point(3.0), point(2.01), point(0.0)];
        assert_eq!(kept(&now, &before, 0.1), [1, 2, 0]);
        assert_eq!(kept(&now, &[], 0.1), [0, 1, 2]);
    }

    #[test]
    fn two_points_never_share_a_letter() {
        let before = [(point(0.0), 0)];
        assert_eq!(kept(&[point(0.01), point(0.0)], &before, 0.1), [1, 0]);
    }

    #[test]
    fn there_are_letters_beyond_z() {
        let all = [0, 25, 26, 27].map(letter);
        assert_eq!(all, ["a", "z", "aa", "ab"]);
    }
}
