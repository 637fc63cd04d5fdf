//! Natural-neighbour coordinates: the weights that scattered points (sites) have at a point, for
//! interpolation between the sites.
//!
//! Sibson, "A vector identity for the Dirichlet tessellation" (1980): insert the point as a further
//! site. The weight of an old site is the fraction of the new Voronoi cell that was taken from that
//! site's cell.
//!
//! Guaranteed: weights are at least 0, sum to one, and vary continuously with the point. At a site,
//! the weight of this site is 1. Outside the convex hull of the sites, the weights are those of the
//! nearest point of the hull. If all sites lie on a line, the weights interpolate linearly between
//! neighbours.

use crate::geometry::{DVec2, nearest_segment_parameter};
use spade::{DelaunayTriangulation, Point2, Triangulation as _};

/// Scattered sites in the plane, at least one, with their Delaunay triangulation.
#[derive(Clone, Debug)]
pub struct NaturalNeighbours {
    sites: Vec<DVec2>,
    /// `None` if all sites lie on one line, or if `spade` rejects one of their coordinates.
    triangulation: Option<DelaunayTriangulation<Point2<f64>>>,
    /// Index pairs of neighbouring sites along the convex hull; without a triangulation, along the
    /// line through the sites.
    hull: Vec<[usize; 2]>,
}

/// Reason why a list of sites is invalid. Sites count from 0 in fields and from 1 in messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SitesError {
    /// The list is empty.
    #[error("the list of sites is empty; give at least one site")]
    None,
    /// A coordinate of the site with this index is not finite.
    #[error("site {} has a coordinate that is not finite; correct it", .0 + 1)]
    NotFinite(usize),
    /// The two sites with these indices coincide.
    #[error("sites {} and {} coincide; move them apart", .0[0] + 1, .0[1] + 1)]
    Coincide([usize; 2]),
}

impl NaturalNeighbours {
    /// Triangulates the sites.
    ///
    /// # Errors
    /// [`SitesError`] names the sites that are not finite or coincide.
    ///
    /// ```
    /// use morphospace::{geometry::DVec2, mesh::NaturalNeighbours};
    /// let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(DVec2::from);
    /// let neighbours = NaturalNeighbours::new(&corners)?;
    /// let mut shares = [0.0; 4];
    /// neighbours.weights(DVec2::ONE, &mut shares);
    /// assert!(shares.iter().all(|share| (share - 0.25).abs() < 1e-12));
    /// # Ok::<(), morphospace::mesh::SitesError>(())
    /// ```
    pub fn new(sites: &[DVec2]) -> Result<Self, SitesError> {
        if sites.is_empty() {
            return Err(SitesError::None);
        }
        if let Some(site) = sites.iter().position(|site| !site.is_finite()) {
            return Err(SitesError::NotFinite(site));
        }
        for (k, site) in sites.iter().enumerate() {
            if let Some(other) = sites[..k].iter().position(|other| other == site) {
                return Err(SitesError::Coincide([other, k]));
            }
        }
        let mut triangulation = DelaunayTriangulation::new();
        for site in sites {
            // The library rejects extreme coordinates. Then the sites are treated as if they lay on
            // a line.
            if triangulation.insert(Point2::new(site.x, site.y)).is_err() {
                break;
            }
        }
        let is_flat =
            triangulation.num_vertices() < sites.len() || triangulation.all_vertices_on_line();
        let hull = match is_flat {
            true => along_line(sites),
            false => {
                let edges = triangulation.convex_hull();
                edges
                    .map(|edge| edge.vertices().map(|v| v.index()))
                    .collect()
            }
        };
        Ok(Self {
            sites: sites.to_vec(),
            triangulation: (!is_flat).then_some(triangulation),
            hull,
        })
    }

    /// Returns the sites: the points that were given to [`Self::new`], in the same order.
    #[must_use]
    pub fn sites(&self) -> &[DVec2] {
        &self.sites
    }

    /// Computes the weight of each site at the point `place` and writes it to `shares`.
    ///
    /// # Panics
    /// If `shares` does not have one entry for each site.
    pub fn weights(&self, place: DVec2, shares: &mut [f64]) {
        assert_eq!(shares.len(), self.sites.len(), "a share for each site");
        shares.fill(0.0);
        if let Some(triangulation) = &self.triangulation {
            let mut weights = Vec::new();
            let place = Point2::new(place.x, place.y);
            triangulation
                .natural_neighbor()
                .get_weights(place, &mut weights);
            let sum: f64 = weights.iter().map(|(_, share)| share).sum();
            if sum > 0.0 {
                for (site, share) in weights {
                    // Rounding can make a weight slightly negative.
                    shares[site.index()] = (share / sum).max(0.0);
                }
                return;
            }
        }
        let on_segment = |&[a, b]: &[usize; 2]| {
            let [p, q] = [a, b].map(|k| self.sites[k]);
            let share = nearest_segment_parameter(place, p, q);
            (p.lerp(q, share).distance_squared(place), [a, b], share)
        };
        let nearest = self
            .hull
            .iter()
            .map(on_segment)
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match nearest {
            Some((_, [a, b], share)) => {
                shares[a] = 1.0 - share;
                shares[b] = share;
            }
            None => shares[0] = 1.0,
        }
    }

    /// Returns whether a point lies inside the convex hull of the sites, or at most `reach` away
    /// from it.
    #[must_use]
    pub fn contains(&self, place: DVec2, reach: f64) -> bool {
        let mut weights = Vec::new();
        if let Some(triangulation) = &self.triangulation {
            let place = Point2::new(place.x, place.y);
            triangulation
                .natural_neighbor()
                .get_weights(place, &mut weights);
        }
        let is_near = |&[a, b]: &[usize; 2]| {
            let [p, q] = [a, b].map(|k| self.sites[k]);
            p.lerp(q, nearest_segment_parameter(place, p, q))
                .distance(place)
                <= reach
        };
        !weights.is_empty()
            || self.hull.iter().any(is_near)
            || self.sites.iter().any(|site| site.distance(place) <= reach)
    }
}

/// Returns index pairs of neighbouring sites along the line on which all sites lie.
fn along_line(sites: &[DVec2]) -> Vec<[usize; 2]> {
    let farthest = |from: DVec2| {
        let distance = |p: &&DVec2| p.distance_squared(from);
        sites
            .iter()
            .max_by(|a, b| distance(a).total_cmp(&distance(b)))
            .copied()
    };
    let Some(end) = farthest(sites[0]) else {
        return Vec::new();
    };
    let direction = end - farthest(end).unwrap_or(end);
    let mut order: Vec<usize> = (0..sites.len()).collect();
    order.sort_by(|&a, &b| sites[a].dot(direction).total_cmp(&sites[b].dot(direction)));
    order.windows(2).map(|two| [two[0], two[1]]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn shares(sites: &[DVec2], place: DVec2) -> Vec<f64> {
        let mut shares = vec![0.0; sites.len()];
        let neighbours = NaturalNeighbours::new(sites).expect("sites");
        neighbours.weights(place, &mut shares);
        shares
    }

    #[test]
    fn sites_on_a_line_are_interpolated_in_pairs() {
        let sites = [0.0, 4.0, 1.0].map(|x| DVec2::new(x, x));
        assert_eq!(shares(&sites, DVec2::splat(2.5)), [0.0, 0.5, 0.5]);
        assert_eq!(shares(&sites, DVec2::new(-9.0, 1.0)), [1.0, 0.0, 0.0]);
        assert_eq!(shares(&sites[..1], DVec2::ONE), [1.0]);
    }

    #[test]
    fn outside_the_hull_its_nearest_point_counts() {
        let sites = [(0.0, 0.0), (2.0, 0.0), (1.0, 2.0)].map(DVec2::from);
        let below = shares(&sites, DVec2::new(0.5, -3.0));
        assert_eq!(below, [0.75, 0.25, 0.0]);
        assert_eq!(shares(&sites, DVec2::new(9.0, -9.0)), [0.0, 1.0, 0.0]);
    }

    #[test]
    fn invalid_sites_are_named() {
        let new = |sites: &[DVec2]| NaturalNeighbours::new(sites).err();
        assert_eq!(new(&[]), Some(SitesError::None));
        assert_eq!(
            new(&[DVec2::ONE, DVec2::NAN]),
            Some(SitesError::NotFinite(1))
        );
        let twice = [DVec2::ONE, DVec2::ZERO, DVec2::ONE];
        assert_eq!(new(&twice), Some(SitesError::Coincide([0, 2])));
    }

    proptest! {
        #[test]
        fn weights_reproduce_the_point(
            sites in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 3..9),
            place in (-9.0..9.0_f64, -9.0..9.0_f64),
        ) {
            let sites: Vec<DVec2> = sites.into_iter().map(DVec2::from).collect();
            let (place, shares) = (DVec2::from(place), shares(&sites, place.into()));
            prop_assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            prop_assert!(shares.iter().all(|&share| share >= 0.0));
            let neighbours = NaturalNeighbours::new(&sites).expect("sites");
            if neighbours.contains(place, 0.0) {
                // Sibson's identity: the weighted mean of the sites is the point.
                let again: DVec2 = sites.iter().zip(&shares).map(|(&p, &w)| p * w).sum();
                prop_assert!(again.distance(place) < 1e-6, "{again} {place}");
            }
        }
    }
}
