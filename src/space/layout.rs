//! Automatic layouts of the designs on a map: a polygon, a line, or by similarity.

use super::design_distance::DesignDistances;
use crate::geometry::DVec2;
use crate::numerics::symmetric_eigen;
use crate::settings::named;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

/// Arrangement of the designs on a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapLayout {
    /// Designs at the corners of a regular polygon, clockwise from the top. Four designs form a
    /// square, starting at the upper left.
    #[default]
    Polygon,
    /// Designs in a row, in order.
    Line,
    /// Similar designs close to each other.
    Similarity,
}

named! { MapLayout {
    Polygon: "polygon", "Polygon", "Places the designs at the corners of a regular polygon";
    Line: "line", "Line", "Places the designs in a row, in order";
    Similarity: "likeness", "Similarity", "Places similar designs close to each other";
} }

/// Minimum distance between two sites (positions of designs), in radii of the map. It leaves room
/// for thumbnails and names, and separates identical designs (heuristic).
const MIN_SITE_DISTANCE: f64 = 0.42;

/// For many designs, the minimum distance between two sites is this number divided by the square
/// root of the number of designs, in radii of the map. At the distance [`MIN_SITE_DISTANCE`], they
/// would not all fit into the circle (heuristic).
const CROWDED_DISTANCE: f64 = 1.3;

impl MapLayout {
    /// Returns a site for each design, at most 1 away from the origin.
    #[must_use]
    pub fn sites(self, distances: &DesignDistances) -> Vec<DVec2> {
        match self {
            Self::Polygon => polygon(distances.count()),
            Self::Line => line(distances.count()),
            Self::Similarity => multidimensional_scaling(distances),
        }
    }
}

fn polygon(count: usize) -> Vec<DVec2> {
    if count < 3 {
        return line(count);
    }
    let first = if count == 4 {
        FRAC_PI_2 + FRAC_PI_4
    } else {
        FRAC_PI_2
    };
    let corner = |k: usize| DVec2::from_angle(first - TAU * k as f64 / count as f64);
    (0..count).map(corner).collect()
}

fn line(count: usize) -> Vec<DVec2> {
    let last = count.max(2) - 1;
    let place = |k: usize| DVec2::new(2.0 * k as f64 / last as f64 - 1.0, 0.0);
    (0..count).map(place).collect()
}

/// Returns sites whose distances approximate the dissimilarities of the designs: classical
/// multidimensional scaling (Torgerson 1952), with a minimum distance between sites.
fn multidimensional_scaling(distances: &DesignDistances) -> Vec<DVec2> {
    let count = distances.count();
    let squares: Vec<f64> = (0..count * count)
        .map(|index| distances.between(index / count, index % count).powi(2))
        .collect();
    let row = |k: usize| squares[k * count..(k + 1) * count].iter().sum::<f64>() / count as f64;
    let rows: Vec<f64> = (0..count).map(row).collect();
    let grand_mean = rows.iter().sum::<f64>() / count as f64;
    let centred: Vec<f64> = (0..count * count)
        .map(|index| {
            -0.5 * (squares[index] - rows[index / count] - rows[index % count] + grand_mean)
        })
        .collect();
    let Some(axes) = symmetric_eigen(count, &centred) else {
        return polygon(count);
    };
    // Axis 0 has the largest eigenvalue. Each axis is oriented so that its entry of largest
    // absolute value is positive; otherwise rounding could flip the map.
    let axis = |k: usize| -> Vec<f64> {
        let (value, vector) = &axes[axes.len() - 1 - k];
        let largest = vector
            .iter()
            .copied()
            .max_by(|a, b| a.abs().total_cmp(&b.abs()));
        let scale = value.max(0.0).sqrt() * largest.unwrap_or(1.0).signum();
        vector.iter().map(|entry| entry * scale).collect()
    };
    let along = axis(0);
    let across = if count > 1 { axis(1) } else { vec![0.0; count] };
    let mut sites: Vec<DVec2> = along.into_iter().zip(across).map(DVec2::from).collect();
    let reach = fit_to_unit_circle(&mut sites);
    if reach <= f64::EPSILON || !reach.is_finite() {
        return polygon(count);
    }
    push_apart(&mut sites);
    fit_to_unit_circle(&mut sites);
    sites
}

/// Moves and scales the sites so that their enclosing circle becomes the unit circle; returns the
/// radius that the circle had.
///
/// The sites are centred about the centre of the circle, not about their mean. With the mean, a
/// single outlier would push the other sites into a corner.
fn fit_to_unit_circle(sites: &mut [DVec2]) -> f64 {
    /// Number of times that the centre of the circle is moved (tolerance: the centre is then within
    /// a hundredth of the radius).
    const ROUNDS: usize = 100;
    let farthest = |from: DVec2| {
        let distance = |a: &DVec2| a.distance_squared(from);
        let sites = sites.iter().copied();
        sites.max_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    // The centre moves towards the farthest site by decreasing fractions (Bădoiu and Clarkson
    // 2003).
    let mut centre = DVec2::ZERO;
    for round in 1..=ROUNDS {
        let Some(far) = farthest(centre) else { break };
        centre += (far - centre) / (round + 1) as f64;
    }
    let radius = farthest(centre).map_or(0.0, |far| far.distance(centre));
    if radius > 0.0 && radius.is_finite() {
        sites
            .iter_mut()
            .for_each(|site| *site = (*site - centre) / radius);
    }
    radius
}

/// Pushes sites apart that are closer than the minimum distance, one pair after the other.
fn push_apart(sites: &mut [DVec2]) {
    /// Maximum number of passes over all pairs of sites (resource limit: twelve coincident sites
    /// need about twenty).
    const ROUNDS: usize = 200;
    let min_distance = MIN_SITE_DISTANCE.min(CROWDED_DISTANCE / (sites.len() as f64).sqrt());
    for _ in 0..ROUNDS {
        let mut has_moved = false;
        for a in 0..sites.len() {
            for b in a + 1..sites.len() {
                let offset = sites[b] - sites[a];
                let distance = offset.length();
                if distance >= min_distance {
                    continue;
                }
                // Coincident sites are pushed in a direction that differs for each pair.
                let direction = DVec2::from_angle(2.4 * (a * sites.len() + b) as f64);
                let push = offset.normalize_or(direction)
                    * (0.5 * (min_distance - distance) + 1e-3 * min_distance);
                sites[a] -= push;
                sites[b] += push;
                has_moved = true;
            }
        }
        if !has_moved {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_start_at_the_top_and_four_sites_form_a_square() {
        let three = polygon(3);
        assert!(three[0].distance(DVec2::Y) < 1e-12 && three[1].x > 0.0);
        let four = polygon(4);
        assert!(four[0].x < 0.0 && four[0].y > 0.0 && four[1].x > 0.0 && four[1].y > 0.0);
        assert_eq!(polygon(2), [DVec2::NEG_X, DVec2::X]);
    }

    #[test]
    fn similar_designs_are_close() {
        let places = |x: f64| {
            // The larger x is, the farther the fourth corner moves away.
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0 + x)]
                .map(DVec2::from)
                .to_vec()
        };
        let distances = DesignDistances::of_corresponding_points(&[
            places(0.0),
            places(2.0),
            places(0.2),
            places(2.2),
        ]);
        let sites = MapLayout::Similarity.sites(&distances);
        let distance = |a: usize, b: usize| sites[a].distance(sites[b]);
        assert!(distance(0, 2) < distance(0, 1) && distance(1, 3) < distance(1, 2));
        // An outlier does not push the others into a corner.
        let with_outlier = [
            places(0.0),
            places(0.1),
            places(0.15),
            places(0.2),
            places(5.0),
        ];
        let sites =
            MapLayout::Similarity.sites(&DesignDistances::of_corresponding_points(&with_outlier));
        let [min, max] =
            [f64::min, f64::max].map(|of| sites.iter().map(|site| site.x).fold(0.0, of));
        assert!((min + max).abs() < 0.05 && max > 0.9, "{sites:?}");
        // Identical designs get different sites.
        let same =
            DesignDistances::of_corresponding_points(&[places(0.0), places(0.0), places(1.0)]);
        let sites = MapLayout::Similarity.sites(&same);
        assert!(sites[0].distance(sites[1]) > 0.2);
    }
}
