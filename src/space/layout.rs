//! Where the designs are on a map.

use super::design_distance::DesignDistances;
use crate::geometry::DVec2;
use crate::numerics::symmetric_eigen;
use crate::settings::choice::named;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

/// How the designs are laid out on a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapLayout {
    /// The corners of a regular polygon, clockwise from above; of four a square's, from
    /// its upper left one.
    #[default]
    Polygon,
    /// In a row.
    Line,
    /// What is alike is near each other.
    Likeness,
}

named! { MapLayout {
    Polygon: "polygon", "Polygon", "At the corners of a regular polygon";
    Line: "line", "Line", "In a row, in their order";
    Likeness: "likeness", "Likeness", "What is alike is near each other";
} }

/// Two sites are no nearer to each other than this: the picture of a design and its name
/// must have room, and two designs that are the same are still two.
const APART: f64 = 0.42;

/// The same of many designs, by the root of their number: more have no room in the circle.
const CROWDED: f64 = 1.3;

impl MapLayout {
    /// A site for each design, within one unit of the origin.
    #[must_use]
    pub fn sites(self, likeness: &DesignDistances) -> Vec<DVec2> {
        match self {
            Self::Polygon => polygon(likeness.count()),
            Self::Line => line(likeness.count()),
            Self::Likeness => scaled(likeness),
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

/// Classical scaling (Torgerson 1952): the sites whose distances are nearest to the costs,
/// in as far as the plane has room for them.
fn scaled(likeness: &DesignDistances) -> Vec<DVec2> {
    let count = likeness.count();
    let squares: Vec<f64> = (0..count * count)
        .map(|at| likeness.between(at / count, at % count).powi(2))
        .collect();
    let row = |k: usize| squares[k * count..(k + 1) * count].iter().sum::<f64>() / count as f64;
    let rows: Vec<f64> = (0..count).map(row).collect();
    let whole = rows.iter().sum::<f64>() / count as f64;
    let centred: Vec<f64> = (0..count * count)
        .map(|at| -0.5 * (squares[at] - rows[at / count] - rows[at % count] + whole))
        .collect();
    let Some(axes) = symmetric_eigen(count, &centred) else {
        return polygon(count);
    };
    // The largest first; each axis so that its largest entry is positive, or the map
    // would turn over by rounding.
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
    let reach = filled(&mut sites);
    if reach <= f64::EPSILON || !reach.is_finite() {
        return polygon(count);
    }
    push_apart(&mut sites);
    filled(&mut sites);
    sites
}

/// Lays sites so that they fill the circle about the origin, and tells how large the one about
/// them was. Their mean is no middle: one that is unlike all others would push those into a
/// corner.
fn filled(sites: &mut [DVec2]) -> f64 {
    /// After so many the middle is off by less than a hundredth of the circle.
    const ROUNDS: usize = 100;
    let farthest = |from: DVec2| {
        let far = |a: &DVec2| a.distance_squared(from);
        let sites = sites.iter().copied();
        sites.max_by(|a, b| far(a).total_cmp(&far(b)))
    };
    // Always less of the way to what is farthest (Bădoiu and Clarkson 2003).
    let mut middle = DVec2::ZERO;
    for round in 1..=ROUNDS {
        let Some(far) = farthest(middle) else { break };
        middle += (far - middle) / (round + 1) as f64;
    }
    let reach = farthest(middle).map_or(0.0, |far| far.distance(middle));
    if reach > 0.0 && reach.is_finite() {
        sites
            .iter_mut()
            .for_each(|site| *site = (*site - middle) / reach);
    }
    reach
}

/// Moves sites that are too near to each other apart, a little in every round.
fn push_apart(sites: &mut [DVec2]) {
    /// Twelve sites in one place are apart after some twenty.
    const ROUNDS: usize = 200;
    let least = APART.min(CROWDED / (sites.len() as f64).sqrt());
    for _ in 0..ROUNDS {
        let mut moved = false;
        for a in 0..sites.len() {
            for b in a + 1..sites.len() {
                let way = sites[b] - sites[a];
                let near = way.length();
                if near >= least {
                    continue;
                }
                // Where both are in one place, each pair goes its own way.
                let turn = DVec2::from_angle(2.4 * (a * sites.len() + b) as f64);
                let push = way.normalize_or(turn) * (0.5 * (least - near) + 1e-3 * least);
                sites[a] -= push;
                sites[b] += push;
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_begin_above_and_four_are_a_square() {
        let three = polygon(3);
        assert!(three[0].distance(DVec2::Y) < 1e-12 && three[1].x > 0.0);
        let four = polygon(4);
        assert!(four[0].x < 0.0 && four[0].y > 0.0 && four[1].x > 0.0 && four[1].y > 0.0);
        assert_eq!(polygon(2), [DVec2::NEG_X, DVec2::X]);
    }

    #[test]
    fn what_is_alike_is_near() {
        let places = |x: f64| {
            // The fourth corner goes away from the others.
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0 + x)]
                .map(DVec2::from)
                .to_vec()
        };
        let likeness =
            DesignDistances::of_points(&[places(0.0), places(2.0), places(0.2), places(2.2)]);
        let sites = MapLayout::Likeness.sites(&likeness);
        let far = |a: usize, b: usize| sites[a].distance(sites[b]);
        assert!(far(0, 2) < far(0, 1) && far(1, 3) < far(1, 2));
        // The unlike one does not push the others into a corner.
        let unlike = [
            places(0.0),
            places(0.1),
            places(0.15),
            places(0.2),
            places(5.0),
        ];
        let sites = MapLayout::Likeness.sites(&DesignDistances::of_points(&unlike));
        let [least, most] =
            [f64::min, f64::max].map(|of| sites.iter().map(|site| site.x).fold(0.0, of));
        assert!((least + most).abs() < 0.05 && most > 0.9, "{sites:?}");
        // The same design twice is still two.
        let same = DesignDistances::of_points(&[places(0.0), places(0.0), places(1.0)]);
        let sites = MapLayout::Likeness.sites(&same);
        assert!(sites[0].distance(sites[1]) > 0.2);
    }
}
