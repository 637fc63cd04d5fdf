//! A measure all over a map.

use super::blend_report::{BlendMeasures, BlendSampler};
use crate::geometry::DVec2;
use crate::settings::choice::named;
use crate::space::{DesignSpace, WeightMap};
use crate::work::progress::{Cancelled, Progress, checkpoint, still_wanted};
use rayon::prelude::*;

/// What is shown all over a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapMeasure {
    /// [`BlendReport::conformal_p95`](super::BlendReport::conformal_p95).
    #[default]
    Distortion,
    /// [`BlendMeasures::area`].
    Area,
    /// [`BlendMeasures::perimeter`].
    Perimeter,
    /// [`BlendMeasures::travel`].
    Travel,
}

named! { MapMeasure {
    Distortion: "distortion", "Distortion", "How much angles are distorted, from the nearest design";
    Area: "area", "Area", "What a blend fills";
    Perimeter: "perimeter", "Perimeter", "How long its outlines are";
    Travel: "travel", "Travel", "How far its points are from those of the nearest design";
} }

impl MapMeasure {
    /// Its value of a blend; none where it has none.
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

/// Blends all over a map, measured: a square grid of places, row by row from above.
#[derive(Clone, Debug, PartialEq)]
pub struct MapLandscape {
    side: usize,
    reach: f64,
    /// None beside the hull of the sites.
    blends: Vec<Option<BlendMeasures>>,
}

impl MapLandscape {
    /// Measures so many places along each side of a map, from −`reach` to `reach`.
    ///
    /// # Errors
    /// [`Cancelled`] if nobody wants the result any more.
    pub fn of(
        (space, map): (&DesignSpace, &WeightMap),
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
                // A step beyond the rim as well, for what is between two places there.
                if still_wanted(progress).is_err() || !map.holds(place, 1.5 * step) {
                    return None;
                }
                map.weights(place, &mut weights);
                Some(sampler.at(&weights))
            });
            measured.collect::<Vec<_>>()
        };
        let rows: Vec<Vec<_>> = (0..side).into_par_iter().map(row).collect();
        still_wanted(progress)?;
        Ok(Self {
            side,
            reach,
            blends: rows.concat(),
        })
    }

    /// Places along each side.
    #[must_use]
    pub fn side(&self) -> usize {
        self.side
    }

    /// A measure at a place of the map, between the nearest four that were measured; none
    /// beside the hull of the sites.
    #[must_use]
    pub fn value(&self, measure: MapMeasure, place: DVec2) -> Option<f64> {
        self.between(place, |blend| measure.of(blend))
    }

    /// How much of what is near a place folds or crosses itself, from 0 to 1.
    #[must_use]
    pub fn trouble(&self, place: DVec2) -> f64 {
        let is_wrong = |blend: &BlendMeasures| blend.quality.folds + blend.quality.crossings > 0;
        self.between(place, |blend| Some(f64::from(u8::from(is_wrong(blend)))))
            .unwrap_or(0.0)
    }

    /// The least and the largest value of a measure; none where it has none.
    #[must_use]
    pub fn range(&self, measure: MapMeasure) -> Option<[f64; 2]> {
        let values = self.blends.iter().flatten();
        let values = values.filter_map(|blend| measure.of(blend));
        values
            .map(|value| [value; 2])
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    fn between(&self, place: DVec2, value: impl Fn(&BlendMeasures) -> Option<f64>) -> Option<f64> {
        let last = self.side.checked_sub(1)? as f64;
        let at = DVec2::new(place.x + self.reach, self.reach - place.y) / (2.0 * self.reach);
        let at = (at * self.side as f64 - 0.5).clamp(DVec2::ZERO, DVec2::splat(last));
        let low = at.floor();
        let share = at - low;
        let (mut sum, mut all) = (0.0, 0.0);
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let corner = (low + DVec2::new(dx, dy)).min(DVec2::splat(last));
            let weight = (1.0 - (share.x - dx).abs()) * (1.0 - (share.y - dy).abs());
            let index = corner.y as usize * self.side + corner.x as usize;
            if weight > 0.0
                && let Some(found) = self.blends[index].as_ref().and_then(&value)
            {
                sum += weight * found;
                all += weight;
            }
        }
        (all > 0.5).then(|| sum / all)
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
    fn areas_grow_from_the_small_design_to_the_large_one() {
        let rectangle = |w: f64| {
            let ring = [[0.0, 0.0], [w, 0.0], [w, 1.0], [0.0, 1.0]];
            Arc::new(Design::of_rings("rectangle", [ring]).expect("a design"))
        };
        let designs = vec![rectangle(1.0), rectangle(2.0), rectangle(4.0)];
        let space = DesignSpace::build(&SpaceSpec::new(designs), &Silent).expect("a space");
        let sites = [DVec2::NEG_X, DVec2::Y, DVec2::X];
        let map = WeightMap::new(&sites).expect("a map");
        let found = MapLandscape::of((&space, &map), 24, 1.2, &Silent).expect("a landscape");
        let area = |x: f64, y: f64| found.value(MapMeasure::Area, DVec2::new(x, y));
        let [small, middle, large] = [-0.9, 0.0, 0.9].map(|x| area(x, 0.05).expect("on the map"));
        assert!(small < middle && middle < large, "{small} {middle} {large}");
        assert_eq!(area(-1.1, 1.1), None);
        let [least, most] = found.range(MapMeasure::Area).expect("values");
        assert!(least >= 1.0 - 1e-9 && most <= 4.0 + 1e-9 && most > 3.5);
        assert_eq!(found.trouble(DVec2::new(0.0, 0.3)), 0.0);
        let far = found
            .value(MapMeasure::Travel, DVec2::new(0.0, 0.4))
            .expect("on the map");
        assert!(far > 0.01 && far < 0.5, "{far}");
    }
}
