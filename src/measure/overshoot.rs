//! Overshoot of a film between its two ends (t = 0 and t = 1): how far the largest value or count
//! exceeds the values at the ends, and how far the distortion of faces exceeds that in the target.

use super::distortion::{FaceStrain, edges};
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;

/// Returns the largest value divided by the larger of the first and the last value; `None` if any
/// value is missing.
pub(super) fn peak_over_ends(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let values: Vec<f64> = values.collect::<Option<_>>()?;
    let end = values.first()?.max(*values.last()?);
    Some(values.iter().fold(0.0, |max: f64, &value| max.max(value)) / end)
}

/// Returns by how much the largest count exceeds the larger of the first and the last count; `None`
/// if any count is missing.
pub(super) fn count_over_ends(counts: impl Iterator<Item = Option<usize>>) -> Option<usize> {
    let counts: Vec<usize> = counts.collect::<Option<_>>()?;
    let ends = *counts.first()?.max(counts.last()?);
    Some(counts.iter().max()?.saturating_sub(ends))
}

/// Returns the largest amounts by which the conformal, isometric and area distortion of any face at
/// any sample exceed those of the same face in the target. `paths` holds the vertex positions at
/// each sample.
///
/// Distortion is measured relative to the source, where it has its minimum, 1. So no face is less
/// distorted in the target than in the source.
pub(super) fn distortion_over_ends(mesh: &CompatibleMesh, paths: &[Vec<DVec2>]) -> [f64; 3] {
    let mut worst = [0.0; 3];
    for face in mesh.faces().iter() {
        let inverse = edges(mesh.source(), face).inverse();
        let distortion = |places: &[DVec2]| {
            let strain = FaceStrain::of(edges(places, face) * inverse);
            [strain.conformal(), strain.isometric(), strain.area()]
        };
        let at_end = distortion(mesh.target());
        for places in paths {
            let now = distortion(places);
            for k in 0..3 {
                worst[k] = f64::max(worst[k], now[k] - at_end[k]);
            }
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_is_compared_with_the_larger_end() {
        assert_eq!(
            peak_over_ends([1.0, 6.0, 4.0].map(Some).into_iter()),
            Some(1.5)
        );
        assert_eq!(
            peak_over_ends([1.0, 2.0, 4.0].map(Some).into_iter()),
            Some(1.0)
        );
        assert_eq!(peak_over_ends([Some(1.0), None].into_iter()), None);
    }

    #[test]
    fn counts_are_compared_with_the_larger_end() {
        let excess = |counts: &[usize]| count_over_ends(counts.iter().map(|&c| Some(c)));
        assert_eq!(excess(&[1, 5, 3]), Some(2));
        assert_eq!(excess(&[3, 1, 2]), Some(0));
        assert_eq!(count_over_ends([Some(1), None].into_iter()), None);
        assert_eq!(count_over_ends(std::iter::empty()), None);
    }
}
