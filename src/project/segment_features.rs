//! What all designs of a sequence have in common: the features of its legs, strung together.

use crate::correspondence::MatchSettings;
use crate::geometry::DVec2;
use crate::warp::ManyFeatures;

/// How near the place where a feature of one leg arrives, and one of the next sets out from,
/// are to each other where they are the same, as a share of the design's diameter: what is
/// set by hand twice is some pixels off.
const SAME: f64 = 0.01;

/// The features that go through all designs, in the coordinates of each, and how many others
/// there are. Of each leg what is said of its two designs; the diameters of all designs.
pub(super) fn strung(legs: &[MatchSettings], diameters: &[f64]) -> (ManyFeatures, usize) {
    let points = legs.iter().map(|leg| {
        let pairs = leg.pins.iter().map(|pin| [[pin.source], [pin.target]]);
        pairs.collect()
    });
    let lines = legs.iter().map(|leg| {
        let pairs = leg.lines.iter().map(|line| [line.source, line.target]);
        pairs.collect()
    });
    let (points, lone_points) = through(points.collect(), diameters);
    let (lines, lone_lines) = through(lines.collect(), diameters);
    let points = points.into_iter();
    let features = ManyFeatures {
        points: points
            .map(|each| each.into_iter().flatten().collect())
            .collect(),
        lines,
    };
    (features, lone_points + lone_lines)
}

/// Of each leg the pairs of places of each feature; those that go on through all legs, and
/// how many do not.
fn through<const N: usize>(
    legs: Vec<Vec<[[DVec2; N]; 2]>>,
    diameters: &[f64],
) -> (Vec<Vec<[DVec2; N]>>, usize) {
    let mut legs = legs.into_iter();
    let first: Vec<[[DVec2; N]; 2]> = legs.next().unwrap_or_default();
    let mut strung: Vec<Vec<[DVec2; N]>> = first.into_iter().map(Vec::from).collect();
    let mut lone = 0;
    for (mut leg, diameter) in legs.zip(diameters.iter().skip(1)) {
        let off = |a: &[DVec2; N], b: &[DVec2; N]| {
            let each = a.iter().zip(b).map(|(p, q)| p.distance(*q));
            each.fold(0.0, f64::max)
        };
        let before = strung.len();
        strung.retain_mut(|places| {
            let Some(here) = places.last().copied() else {
                return false;
            };
            let nearest = (0..leg.len())
                .map(|k| (off(&here, &leg[k][0]), k))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match nearest {
                Some((off, k)) if off <= SAME * diameter => {
                    let [_, there] = leg.swap_remove(k);
                    places.push(there);
                    true
                }
                _ => false,
            }
        });
        lone += before - strung.len() + leg.len();
    }
    (strung, lone)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correspondence::{LinePair, PointPair};

    #[test]
    fn what_goes_on_is_strung_and_the_rest_counted() {
        let at = |x: f64| DVec2::new(x, 0.0);
        let pin = |a: f64, b: f64| PointPair {
            source: at(a),
            target: at(b),
        };
        let line = |a: f64, b: f64| LinePair {
            source: [at(a), at(a + 10.0)],
            target: [at(b), at(b + 10.0)],
        };
        let leg = |pins: Vec<PointPair>, lines: Vec<LinePair>| MatchSettings {
            pins,
            lines,
            ..MatchSettings::default()
        };
        let legs = [
            leg(vec![pin(1.0, 2.0), pin(50.0, 60.0)], vec![line(5.0, 6.0)]),
            // In another order, and one a little off.
            leg(vec![pin(60.4, 70.0), pin(90.0, 91.0)], vec![line(6.0, 7.0)]),
        ];
        let (features, lone) = strung(&legs, &[100.0; 3]);
        assert_eq!(features.points, [[at(50.0), at(60.0), at(70.0)]]);
        assert_eq!(features.lines.len(), 1);
        assert_eq!(features.lines[0][2], [at(7.0), at(17.0)]);
        assert_eq!(lone, 2);
    }
}
