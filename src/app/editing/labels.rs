//! What found points and parts are called: letters, and those of points stay with them while
//! others come and go.
//!
//! Pins have numbers, those of the project, which messages name.

use crate::correspondence::PointPair;

/// A point is the same as before where one of its ends lies no farther away than this share of the
/// designs: the match that a pin has changed moves points a little along their outline.
pub const SAME: f64 = 0.02;

/// The letters of `points`, 0 for a: those of the points before that are the same, within `reach`,
/// and for the others the first that none had.
#[must_use]
pub fn stable_letters(
    points: &[PointPair],
    before: &[(PointPair, usize)],
    reach: f64,
) -> Vec<usize> {
    // What kept its source is the same before what kept its target.
    let mut pairs: Vec<(bool, f64, usize, usize)> = Vec::new();
    for (k, point) in points.iter().enumerate() {
        for (other, letter) in before {
            let source = point.source.distance(other.source);
            let target = point.target.distance(other.target);
            if source <= reach {
                pairs.push((false, source, k, *letter));
            } else if target <= reach {
                pairs.push((true, target, k, *letter));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut letters = vec![None; points.len()];
    for (_, _, k, letter) in pairs {
        if letters[k].is_none() && !letters.contains(&Some(letter)) {
            letters[k] = Some(letter);
        }
    }
    // None that was just read beside another point.
    let was_there = |letter: &usize| before.iter().any(|(_, other)| other == letter);
    let mut free = (0..).filter(|letter| !was_there(letter));
    let own = letters.into_iter();
    own.map(|letter| letter.or_else(|| free.next()).unwrap_or_default())
        .collect()
}

/// What a point is called: a to z, and then a2, b2 …
#[must_use]
pub fn of_point(number: usize) -> String {
    letter(number, b'a')
}

/// What a part is called: A to Z, and then A2, B2 …
#[must_use]
pub fn of_part(number: usize) -> String {
    letter(number, b'A')
}

fn letter(number: usize, first: u8) -> String {
    let letter = char::from(first + (number % 26) as u8);
    match number / 26 {
        0 => letter.to_string(),
        round => format!("{letter}{}", round + 1),
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
        assert_eq!(stable_letters(&now, &before, 0.1), [3, 2, 0]);
        assert_eq!(stable_letters(&now, &[], 0.1), [0, 1, 2]);
    }

    #[test]
    fn two_points_never_share_a_letter() {
        let before = [(point(0.0), 0)];
        assert_eq!(
            stable_letters(&[point(0.01), point(0.0)], &before, 0.1),
            [1, 0]
        );
    }

    #[test]
    fn there_are_letters_beyond_z() {
        assert_eq!([0, 25, 26, 53].map(of_point), ["a", "z", "a2", "b3"]);
        assert_eq!(of_part(1), "B");
    }
}
