//! Labels of automatically matched points and of parts. Points keep their letter while other points
//! appear or disappear.
//!
//! Pins are labelled with their number in the project, which messages refer to.

use crate::correspondence::PointPair;

/// Maximum distance, as a fraction of the designs' size, at which a point counts as the same as an
/// earlier one: a new pin shifts matched points slightly along the outline (heuristic).
pub const SAME_POINT_DISTANCE: f64 = 0.02;

/// Letter index of each of `points`; 0 is the letter a. If a point lies within `reach` of a point
/// in `before`, in the source or in the target, it takes over that point's letter. The others get
/// the first letters that are free.
#[must_use]
pub fn stable_letters(
    points: &[PointPair],
    before: &[(PointPair, usize)],
    reach: f64,
) -> Vec<usize> {
    // Points that agree in the source take precedence over those that agree in the target.
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
    // Letters of earlier points that are gone are not reused at once, to avoid confusion.
    let was_used = |letter: &usize| before.iter().any(|(_, other)| other == letter);
    let mut free = (0..).filter(|letter| !was_used(letter));
    let letters = letters.into_iter();
    letters
        .map(|letter| letter.or_else(|| free.next()).unwrap_or_default())
        .collect()
}

/// Label of the point with the letter index `number`: a to z, then a2, b2 …
#[must_use]
pub fn point_label(number: usize) -> String {
    letter(number, b'a')
}

/// Label of the piece (a pair of matched parts, or an unmatched part) with the index `number`: A to
/// Z, then A2, B2 …
#[must_use]
pub fn part_label(number: usize) -> String {
    letter(number, b'A')
}

/// Letter with index `number`, from 0, in the alphabet that starts at `first`; after the last, the
/// letters repeat with 2, 3 and so on.
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
        assert_eq!([0, 25, 26, 53].map(point_label), ["a", "z", "a2", "b3"]);
        assert_eq!(part_label(1), "B");
    }
}
