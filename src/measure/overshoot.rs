//! What a film does beyond what its ends need.

use super::distortion::{FaceStrain, edges};
use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;

/// The largest value by the larger one of the ends; `None` where nothing was
/// measured.
pub(super) fn of_peak(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let values: Vec<f64> = values.collect::<Option<_>>()?;
    let end = values.first()?.max(*values.last()?);
    Some(values.iter().fold(0.0, |most: f64, &value| most.max(value)) / end)
}

/// How far a count rises above the larger of its ends; `None` where nothing
/// was counted.
pub(super) fn of_count(counts: impl Iterator<Item = Option<usize>>) -> Option<usize> {
    let counts: Vec<usize> = counts.collect::<Option<_>>()?;
    let ends = *counts.first()?.max(counts.last()?);
    Some(counts.iter().max()?.saturating_sub(ends))
}

/// For each face, distortion in the film beyond the worse of its ends; the
/// largest over faces and samples, conformal, isometric, by area. Distortion
/// is relative to the source, which is 1, so that the worse end is the target.
pub(super) fn of_distortion(mesh: &CompatibleMesh, paths: &[Vec<DVec2>]) -> [f64; 3] {
    let mut worst = [0.0; 3];
    for face in mesh.faces().iter() {
        let inverse = edges(mesh.source(), face).inverse();
        let at = |places: &[DVec2]| {
            let strain = FaceStrain::of(edges(places, face) * inverse);
            [strain.conformal(), strain.isometric(), strain.area()]
        };
        let ends = at(mesh.target());
        for places in paths {
            let now = at(places);
            for k in 0..3 {
                worst[k] = f64::max(worst[k], now[k] - ends[k]);
            }
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_is_held_against_the_larger_end() {
        assert_eq!(of_peak([1.0, 6.0, 4.0].map(Some).into_iter()), Some(1.5));
        assert_eq!(of_peak([1.0, 2.0, 4.0].map(Some).into_iter()), Some(1.0));
        assert_eq!(of_peak([Some(1.0), None].into_iter()), None);
    }

    #[test]
    fn counts_are_held_against_the_larger_end() {
        let some = |counts: &[usize]| of_count(counts.iter().map(|&c| Some(c)));
        assert_eq!(some(&[1, 5, 3]), Some(2));
        assert_eq!(some(&[3, 1, 2]), Some(0));
        assert_eq!(of_count([Some(1), None].into_iter()), None);
        assert_eq!(of_count(std::iter::empty()), None);
    }
}
