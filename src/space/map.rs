//! A map: each design has a site, and every place is a blend.

use crate::geometry::{Bounds, DVec2};
use crate::mesh::{NaturalNeighbours, SitesError};

/// Sites of designs in the plane, y up, and the blends at all places between them.
///
/// ```
/// use morphospace::{geometry::DVec2, space::Map};
/// let map = Map::new(&[DVec2::ZERO, DVec2::X, DVec2::Y])?;
/// let mut weights = [0.0; 3];
/// map.weights(DVec2::new(0.5, 0.0), &mut weights);
/// assert_eq!(weights, [0.5, 0.5, 0.0]);
/// # Ok::<(), morphospace::mesh::SitesError>(())
/// ```
#[derive(Clone, Debug)]
pub struct WeightMap {
    neighbours: NaturalNeighbours,
    bounds: Bounds,
}

impl WeightMap {
    /// # Errors
    /// [`SitesError`] if there is no site, or two are in one place.
    pub fn new(sites: &[DVec2]) -> Result<Self, SitesError> {
        let neighbours = NaturalNeighbours::new(sites)?;
        let bounds = Bounds::of(sites.iter().copied()).ok_or(SitesError::None)?;
        Ok(Self { neighbours, bounds })
    }

    /// Where the designs are.
    #[must_use]
    pub fn sites(&self) -> &[DVec2] {
        self.neighbours.sites()
    }

    /// The smallest box around the sites.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The weights of the designs at a place, by natural neighbours; beyond the hull of
    /// the sites those of the nearest place on it.
    ///
    /// # Panics
    /// If there are not as many weights as sites.
    pub fn weights(&self, place: DVec2, weights: &mut [f64]) {
        self.neighbours.shares(place, weights);
    }

    /// Whether a place lies between the sites, or nearer to what does than `reach`.
    #[must_use]
    pub fn holds(&self, place: DVec2, reach: f64) -> bool {
        self.neighbours.holds(place, reach)
    }

    /// The places of a grid of so many columns and rows over the map, row by row from
    /// above. That nearest to a site is the site itself; none where nothing is between the
    /// designs.
    #[must_use]
    pub fn grid(&self, columns: usize, rows: usize) -> Vec<Option<DVec2>> {
        let size = self.bounds.size();
        let steps = DVec2::new(columns.max(2) as f64 - 1.0, rows.max(2) as f64 - 1.0);
        let step = size / steps;
        let place = |at: usize| {
            let (column, row) = (at % columns, at / columns);
            // One row, or one column, goes through the middle.
            let share = |k: usize, of: usize| match of {
                1 => 0.5,
                _ => k as f64 / (of as f64 - 1.0),
            };
            let share = DVec2::new(share(column, columns), 1.0 - share(row, rows));
            self.bounds.min + share * size
        };
        // A third of a step: a cell half outside shows what is at the rim.
        let reach = step.max_element() / 3.0;
        let mut places: Vec<Option<DVec2>> = (0..columns * rows)
            .map(place)
            .map(|place| self.holds(place, reach).then_some(place))
            .collect();
        for &site in self.sites() {
            let far = |at: &usize| place(*at).distance_squared(site);
            let nearest = (0..places.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
            if let Some(at) = nearest {
                places[at] = Some(site);
            }
        }
        places
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corners_of_a_square_are_the_corners_of_its_grid() {
        let sites = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(DVec2::from);
        let map = WeightMap::new(&sites).expect("sites");
        let grid = map.grid(3, 5);
        assert_eq!(grid.len(), 15);
        assert_eq!([0, 2, 14, 12].map(|at| grid[at]), sites.map(Some));
        assert_eq!(grid[7], Some(DVec2::ZERO));
    }

    #[test]
    fn there_is_nothing_beside_a_triangle_and_a_line_is_one_row() {
        let map = WeightMap::new(&[DVec2::Y, DVec2::new(1.0, -1.0), DVec2::new(-1.0, -1.0)]);
        let grid = map.expect("sites").grid(9, 9);
        assert_eq!((grid[0], grid[8]), (None, None));
        assert_eq!(grid[4], Some(DVec2::Y));
        let line = WeightMap::new(&[DVec2::NEG_X, DVec2::ZERO, DVec2::X]).expect("sites");
        let grid = line.grid(5, 1);
        assert!(grid.iter().all(Option::is_some));
        assert_eq!(grid[2], Some(DVec2::ZERO));
    }
}
