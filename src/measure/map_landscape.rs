//! Measures of the blends at the points of a grid over a map of designs, from which the map's
//! contour lines are drawn.

use super::blend_report::{BlendMeasures, BlendSampler};
use crate::geometry::DVec2;
use crate::settings::named;
use crate::space::{DesignSpace, WeightMap};
use crate::work::progress::{Cancelled, Progress, check_cancelled, checkpoint};
use rayon::prelude::*;

/// Measure of a blend that is drawn as contour lines on a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapMeasure {
    /// Distortion of angles, [`BlendReport::conformal_p95`](super::BlendReport::conformal_p95).
    #[default]
    Distortion,
    /// Filled area, [`BlendMeasures::area`].
    Area,
    /// Length of the outlines, [`BlendMeasures::perimeter`].
    Perimeter,
    /// Mean distance of the vertices from the nearest design, [`BlendMeasures::travel`].
    Travel,
}

named! { MapMeasure {
    Distortion: "distortion", "Distortion", "Distortion of angles relative to the nearest design";
    Area: "area", "Area", "Filled area of a blend";
    Perimeter: "perimeter", "Perimeter", "Total length of the outlines of a blend";
    Travel: "travel", "Travel", "Mean distance of the points from those of the nearest design";
} }

impl MapMeasure {
    /// Returns the value of this measure for a blend; `None` if the blend has no such value or the
    /// value is infinite.
    #[must_use]
    pub fn of(self, blend: &BlendMeasures) -> Option<f64> {
        let value = match self {
            Self::Distortion => blend.quality.conformal_p95?,
            Self::Area => blend.area,
            Self::Perimeter => blend.perimeter,
            Self::Travel => blend.travel?,
        };
        value.is_finite().then_some(value)
    }
}

/// Measures of the blends at the points of a square grid over a map, in rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct MapLandscape {
    /// Number of grid points along each side.
    side: usize,
    /// Half the side length of the square that the grid covers, in map units. The square is centred
    /// at the origin of the map.
    reach: f64,
    /// Measures of the blend at each grid point. `None` if the point lies more than 1.5 grid steps
    /// outside the convex hull of the sites, which are the positions of the designs on the map.
    blends: Vec<Option<BlendMeasures>>,
}

impl MapLandscape {
    /// Measures the blend at the centre of each of `side` × `side` equal cells of the square from
    /// (−`reach`, −`reach`) to (`reach`, `reach`) on the map. These centres are the grid points.
    ///
    /// # Errors
    /// [`Cancelled`] if the work was cancelled.
    pub fn measure(
        space: &DesignSpace,
        map: &WeightMap,
        side: usize,
        reach: f64,
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        checkpoint(progress, "measuring the map", 0.0)?;
        let step = 2.0 * reach / side.max(1) as f64;
        let row = |row: usize| {
            let mut sampler = BlendSampler::of(space);
            let mut weights = vec![0.0; space.designs().len()];
            let measured = (0..side).map(|column| {
                let [x, y] = [column, side - 1 - row].map(|k| (k as f64 + 0.5) * step - reach);
                let place = DVec2::new(x, y);
                // Points just outside the hull are measured too, for interpolation at its boundary.
                if check_cancelled(progress).is_err() || !map.contains(place, 1.5 * step) {
                    return None;
                }
                map.weights(place, &mut weights);
                Some(sampler.measure(&weights))
            });
            measured.collect::<Vec<_>>()
        };
        let rows: Vec<Vec<_>> = (0..side).into_par_iter().map(row).collect();
        check_cancelled(progress)?;
        Ok(Self {
            side,
            reach,
            blends: rows.concat(),
        })
    }

    /// Returns the number of grid points along each side.
    #[must_use]
    pub fn side(&self) -> usize {
        self.side
    }

    /// Returns a measure at a place on the map, interpolated bilinearly between the grid points;
    /// `None` where too few grid points around the place were measured, for example far outside the
    /// convex hull of the sites.
    #[must_use]
    pub fn value(&self, measure: MapMeasure, place: DVec2) -> Option<f64> {
        self.interpolated(place, |blend| measure.of(blend))
    }

    /// Returns the fraction, from 0 to 1, of the four grid points around a place whose blends have
    /// folded faces or crossing outlines. The grid points have bilinear weights. Returns 0 where
    /// too few grid points were measured.
    #[must_use]
    pub fn defect_fraction(&self, place: DVec2) -> f64 {
        let has_defect = |blend: &BlendMeasures| blend.quality.folds + blend.quality.crossings > 0;
        self.interpolated(place, |blend| Some(f64::from(u8::from(has_defect(blend)))))
            .unwrap_or(0.0)
    }

    /// Returns the smallest and the largest value of a measure over all grid points; `None` if no
    /// grid point has a value.
    #[must_use]
    pub fn range(&self, measure: MapMeasure) -> Option<[f64; 2]> {
        let values = self.blends.iter().flatten();
        let values = values.filter_map(|blend| measure.of(blend));
        values
            .map(|value| [value; 2])
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// Interpolates a value bilinearly between the four grid points around a place. Grid points
    /// without a value are skipped as long as the others have more than half of the weight;
    /// otherwise returns `None`.
    fn interpolated(
        &self,
        place: DVec2,
        value: impl Fn(&BlendMeasures) -> Option<f64>,
    ) -> Option<f64> {
        let last = self.side.checked_sub(1)? as f64;
        let at = DVec2::new(place.x + self.reach, self.reach - place.y) / (2.0 * self.reach);
        let at = (at * self.side as f64 - 0.5).clamp(DVec2::ZERO, DVec2::splat(last));
        let low = at.floor();
        let fraction = at - low;
        let (mut sum, mut total_weight) = (0.0, 0.0);
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let corner = (low + DVec2::new(dx, dy)).min(DVec2::splat(last));
            let weight = (1.0 - (fraction.x - dx).abs()) * (1.0 - (fraction.y - dy).abs());
            let index = corner.y as usize * self.side + corner.x as usize;
            if weight > 0.0
                && let Some(measured) = self.blends[index].as_ref().and_then(&value)
            {
                sum += weight * measured;
                total_weight += weight;
            }
        }
        (total_weight > 0.5).then(|| sum / total_weight)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;
    use crate::space::SpaceSpec;
    use crate::work::progress::Silent;
    use std::sync::Arc;

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn areas_grow_from_the_small_design_to_the_large_one() {
        let rectangle = |w: f64| {
            let ring = [[0.0, 0.0], [w, 0.0], [w, 1.0], [0.0, 1.0]];
            Arc::new(Design::from_rings("rectangle", [ring]).expect("a design"))
        };
        let designs = vec![rectangle(1.0), rectangle(2.0), rectangle(4.0)];
        let space = DesignSpace::build(&SpaceSpec::new(designs), &Silent).expect("a space");
        let sites = [DVec2::NEG_X, DVec2::Y, DVec2::X];
        let map = WeightMap::new(&sites).expect("a map");
        let landscape = MapLandscape::measure(&space, &map, 24, 1.2, &Silent).expect("a landscape");
        let area = |x: f64, y: f64| landscape.value(MapMeasure::Area, DVec2::new(x, y));
        let [small, middle, large] = [-0.9, 0.0, 0.9].map(|x| area(x, 0.05).expect("on the map"));
        assert!(small < middle && middle < large, "{small} {middle} {large}");
        assert_eq!(area(-1.1, 1.1), None);
        let [min, max] = landscape.range(MapMeasure::Area).expect("values");
        assert!(min >= 1.0 - 1e-9 && max <= 4.0 + 1e-9 && max > 3.5);
        assert_eq!(landscape.defect_fraction(DVec2::new(0.0, 0.3)), 0.0);
        let travel = landscape
            .value(MapMeasure::Travel, DVec2::new(0.0, 0.4))
            .expect("on the map");
        assert!(travel > 0.01 && travel < 0.5, "{travel}");
    }
}
