//! A map of blends: each design has a site in the plane, and each place of the plane has a weight
//! for each design.

use crate::geometry::{Bounds, DVec2};
use crate::mesh::{NaturalNeighbours, SitesError};

/// Positions of designs in the plane (sites), y up, and the weights of the designs at every place.
///
/// ```
/// use morphospace::{geometry::DVec2, space::WeightMap};
/// let map = WeightMap::new(&[DVec2::ZERO, DVec2::X, DVec2::Y])?;
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
    /// Creates the map of designs that lie at the given sites.
    ///
    /// # Errors
    /// [`SitesError`] if there is no site, a coordinate is not finite, or two sites coincide.
    pub fn new(sites: &[DVec2]) -> Result<Self, SitesError> {
        let neighbours = NaturalNeighbours::new(sites)?;
        let bounds = Bounds::of(sites.iter().copied()).ok_or(SitesError::None)?;
        Ok(Self { neighbours, bounds })
    }

    /// Returns the sites of the designs.
    #[must_use]
    pub fn sites(&self) -> &[DVec2] {
        self.neighbours.sites()
    }

    /// Returns the bounding box of the sites.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Writes the natural-neighbour weights of the designs at a place.
    ///
    /// Outside the convex hull of the sites, the weights are those of the nearest point of the
    /// hull.
    ///
    /// # Panics
    /// If the number of weights differs from that of the sites.
    pub fn weights(&self, place: DVec2, weights: &mut [f64]) {
        self.neighbours.weights(place, weights);
    }

    /// Returns whether a place lies inside the convex hull of the sites, or at most `reach` away
    /// from it.
    #[must_use]
    pub fn contains(&self, place: DVec2, reach: f64) -> bool {
        self.neighbours.contains(place, reach)
    }

    /// Returns a grid of places over the map, in rows from the top.
    ///
    /// The grid place nearest to each site is moved onto the site. Places that lie outside the
    /// convex hull of the sites by more than a third of the larger grid step are `None`.
    #[must_use]
    pub fn grid(&self, columns: usize, rows: usize) -> Vec<Option<DVec2>> {
        let size = self.bounds.size();
        let steps = DVec2::new(columns.max(2) as f64 - 1.0, rows.max(2) as f64 - 1.0);
        let step = size / steps;
        let place = |index: usize| {
            let (column, row) = (index % columns, index / columns);
            // If there is only one row or column, it lies in the middle.
            let fraction = |k: usize, of: usize| match of {
                1 => 0.5,
                _ => k as f64 / (of as f64 - 1.0),
            };
            let fraction = DVec2::new(fraction(column, columns), 1.0 - fraction(row, rows));
            self.bounds.min + fraction * size
        };
        // Places slightly outside the hull are included, so that cells at its boundary are not
        // empty.
        let reach = step.max_element() / 3.0;
        let mut places: Vec<Option<DVec2>> = (0..columns * rows)
            .map(place)
            .map(|place| self.contains(place, reach).then_some(place))
            .collect();
        for &site in self.sites() {
            let distance = |index: &usize| place(*index).distance_squared(site);
            let nearest = (0..places.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            if let Some(index) = nearest {
                places[index] = Some(site);
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
        assert_eq!([0, 2, 14, 12].map(|index| grid[index]), sites.map(Some));
        assert_eq!(grid[7], Some(DVec2::ZERO));
    }

    #[test]
    fn places_outside_a_triangle_are_empty_and_a_line_is_one_row() {
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
