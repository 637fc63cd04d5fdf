//! Pins and lines common to all designs of a sequence, joined from those of its segments.

use crate::correspondence::MatchSettings;
use crate::geometry::DVec2;
use crate::warp::ManyFeatures;

/// Maximum distance between the target position of a feature in one segment and the source position
/// of the feature that continues it in the next, as a fraction of the design's diameter (tolerance:
/// positions set twice by hand differ by a few pixels).
const MAX_GAP: f64 = 0.01;

/// Returns the features (pins and lines) that exist in all designs, with their positions in each
/// design, and the number of features that exist in only some designs.
///
/// `segments` are the match settings of each segment; `diameters` are those of all designs.
pub(super) fn features_in_all_designs(
    segments: &[MatchSettings],
    diameters: &[f64],
) -> (ManyFeatures, usize) {
    let points = segments.iter().map(|segment| {
        let pairs = segment.pins.iter().map(|pin| [[pin.source], [pin.target]]);
        pairs.collect()
    });
    let lines = segments.iter().map(|segment| {
        let pairs = segment.lines.iter().map(|line| [line.source, line.target]);
        pairs.collect()
    });
    let (points, unmatched_points) = join(points.collect(), diameters);
    let (lines, unmatched_lines) = join(lines.collect(), diameters);
    let points = points.into_iter();
    let features = ManyFeatures {
        points: points
            .map(|each| each.into_iter().flatten().collect())
            .collect(),
        lines,
    };
    (features, unmatched_points + unmatched_lines)
}

/// Joins the features of consecutive segments.
///
/// `segments` holds, for each segment, the places of each feature in source and target. For each
/// feature that continues through all segments, returns its place in each design. Also returns the
/// number of features that do not continue.
fn join<const N: usize>(
    segments: Vec<Vec<[[DVec2; N]; 2]>>,
    diameters: &[f64],
) -> (Vec<Vec<[DVec2; N]>>, usize) {
    let mut segments = segments.into_iter();
    let first: Vec<[[DVec2; N]; 2]> = segments.next().unwrap_or_default();
    let mut joined: Vec<Vec<[DVec2; N]>> = first.into_iter().map(Vec::from).collect();
    let mut unmatched = 0;
    for (mut segment, diameter) in segments.zip(diameters.iter().skip(1)) {
        let gap = |a: &[DVec2; N], b: &[DVec2; N]| {
            let distances = a.iter().zip(b).map(|(p, q)| p.distance(*q));
            distances.fold(0.0, f64::max)
        };
        let before = joined.len();
        joined.retain_mut(|places| {
            let Some(end) = places.last().copied() else {
                return false;
            };
            let nearest = (0..segment.len())
                .map(|k| (gap(&end, &segment[k][0]), k))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match nearest {
                Some((gap, k)) if gap <= MAX_GAP * diameter => {
                    let [_, target] = segment.swap_remove(k);
                    places.push(target);
                    true
                }
                _ => false,
            }
        });
        unmatched += before - joined.len() + segment.len();
    }
    (joined, unmatched)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correspondence::{LinePair, PointPair};

    #[test]
    fn continuing_features_are_joined_and_others_counted() {
        let on_x_axis = |x: f64| DVec2::new(x, 0.0);
        let pin = |a: f64, b: f64| PointPair {
            source: on_x_axis(a),
            target: on_x_axis(b),
        };
        let line = |a: f64, b: f64| LinePair {
            source: [on_x_axis(a), on_x_axis(a + 10.0)],
            target: [on_x_axis(b), on_x_axis(b + 10.0)],
        };
        let segment = |pins: Vec<PointPair>, lines: Vec<LinePair>| MatchSettings {
            pins,
            lines,
            ..MatchSettings::default()
        };
        let segments = [
            segment(vec![pin(1.0, 2.0), pin(50.0, 60.0)], vec![line(5.0, 6.0)]),
            // The first pin continues the second pin of the previous segment: its source is 0.4
            // away from the target of that pin.
            segment(vec![pin(60.4, 70.0), pin(90.0, 91.0)], vec![line(6.0, 7.0)]),
        ];
        let (features, unmatched) = features_in_all_designs(&segments, &[100.0; 3]);
        assert_eq!(
            features.points,
            [[on_x_axis(50.0), on_x_axis(60.0), on_x_axis(70.0)]]
        );
        assert_eq!(features.lines.len(), 1);
        assert_eq!(features.lines[0][2], [on_x_axis(7.0), on_x_axis(17.0)]);
        assert_eq!(unmatched, 2);
    }
}
