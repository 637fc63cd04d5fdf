//! Warps of the plane for many designs: one mapping from the frame of a blend to each design.
//!
//! The features of a blend lie between those of all designs, according to the weights. The mapping
//! from the blend to a design is that of a warp of two designs at t = 1, whose source is the design
//! and whose target is the blend. Every feature-based warp of two designs can therefore be used for
//! many. For two designs the result is that of the warp itself, because each of its two mappings
//! depends only on the features in the frame and in one design.
//!
//! Guaranteed: if a design has weight 1, each point of the frame shows the design point with the
//! same coordinates, bit for bit; the order of the designs does not matter, except for lines with
//! opposite directions. Evaluation cannot fail: if a warp cannot be built, each point of the frame
//! shows the design point with the same coordinates.

use super::{
    Lattice, LatticeOptions, LineInterpolation, LineOptions, LineWarp, Placement, PlaneGrid,
    PlaneWarp, ScatteredOptions, ScatteredWarp,
};
use crate::correspondence::{LinePair, PointPair};
use crate::geometry::{Bounds, DVec2};
use std::f64::consts::PI;
use std::sync::Arc;

/// Features that all designs have in common: points and lines, in the same order in each design.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManyFeatures {
    /// For each point, its position in each design.
    pub points: Vec<Vec<DVec2>>,
    /// For each line, its two ends in each design.
    pub lines: Vec<Vec<[DVec2; 2]>>,
}

/// Kind of warp that moves the plane with the features.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ManyWarp {
    /// Warp by lines, see [`LineWarp`].
    Lines(LineOptions),
    /// Warp by scattered points, see [`ScatteredWarp`].
    Scattered(ScatteredOptions),
    /// Warp by a lattice, see [`Lattice`].
    Lattice(LatticeOptions),
}

/// Positions of the vertices of a mesh in the frame of a blend and in each design; the counterpart
/// of [`Placement`] for many designs.
#[derive(Clone, Debug)]
pub struct ManyPlaces {
    faces: Arc<[[u32; 3]]>,
    in_frame: Vec<DVec2>,
    in_design: Vec<Vec<DVec2>>,
}

impl ManyPlaces {
    /// Returns the placement for one design, which serves as source and as target.
    ///
    /// # Panics
    /// If there is no such design.
    #[must_use]
    pub fn of(&self, design: usize) -> Placement {
        let own = &self.in_design[design];
        Placement {
            faces: Arc::clone(&self.faces),
            in_frame: self.in_frame.clone(),
            in_source: own.clone(),
            in_target: own.clone(),
        }
    }
}

impl ManyFeatures {
    /// Returns whether there are no features.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty() && self.lines.is_empty()
    }

    /// Returns the points and lines of one design.
    ///
    /// # Panics
    /// If there is no such design.
    #[must_use]
    pub fn of(&self, design: usize) -> (Vec<DVec2>, Vec<[DVec2; 2]>) {
        (
            self.points.iter().map(|each| each[design]).collect(),
            self.lines.iter().map(|each| each[design]).collect(),
        )
    }

    /// Returns the points and lines of a blend. `between` is the interpolation of lines.
    #[must_use]
    pub fn blended(
        &self,
        weights: &[f64],
        between: LineInterpolation,
    ) -> (Vec<DVec2>, Vec<[DVec2; 2]>) {
        if let Some(alone) = weights.iter().position(|&weight| weight == 1.0)
            && weights.iter().filter(|&&weight| weight != 0.0).count() == 1
        {
            return self.of(alone);
        }
        let mean = |each: &mut dyn Iterator<Item = DVec2>| -> DVec2 {
            each.zip(weights).map(|(p, &w)| w * p).sum()
        };
        let points = self.points.iter();
        let points = points.map(|each| mean(&mut each.iter().copied()));
        let line = |each: &Vec<[DVec2; 2]>| match between {
            LineInterpolation::Ends => {
                [0, 1].map(|end| mean(&mut each.iter().map(|line| line[end])))
            }
            LineInterpolation::MiddleAndAngle => {
                let middle = mean(&mut each.iter().map(|[a, b]| 0.5 * (*a + *b)));
                let half = 0.5 * turned(each, weights);
                [middle - half, middle + half]
            }
        };
        (points.collect(), self.lines.iter().map(line).collect())
    }
}

/// Returns the vector along a blended line. `lines` holds the same line in each design. The length
/// is the weighted mean of the lengths. The direction is the unweighted mean direction, rotated by
/// the weighted mean of the angles from it to the lines.
fn turned(lines: &[[DVec2; 2]], weights: &[f64]) -> DVec2 {
    let ways = || lines.iter().map(|[a, b]| *b - *a);
    let all: DVec2 = ways().map(DVec2::normalize_or_zero).sum();
    // If the directions cancel, the perpendicular of the first line, counter-clockwise, replaces
    // their mean.
    let middle = match ways().next() {
        Some(first) if all.length() < 1e-9 => first.perp().normalize_or_zero(),
        _ => all.normalize_or_zero(),
    };
    let (mut length, mut angle) = (0.0, 0.0);
    for (way, &weight) in ways().zip(weights) {
        length += weight * way.length();
        if way != DVec2::ZERO && middle != DVec2::ZERO {
            angle += weight * middle.angle_to(way).clamp(-PI, PI);
        }
    }
    DVec2::from_angle(angle).rotate(middle) * length
}

/// A warp of the plane for many designs, evaluated on a grid. Cloning copies the features and the
/// grid points.
#[derive(Clone, Debug)]
pub struct PlaneBlend {
    designs: usize,
    features: ManyFeatures,
    warp: ManyWarp,
    frame: Bounds,
    grid: PlaneGrid,
}

impl PlaneBlend {
    /// Creates the warp of `designs` designs, seen in the given frame.
    ///
    /// # Errors
    /// A message if the options or the features are invalid.
    ///
    /// # Panics
    /// If a feature does not have one position per design.
    pub fn new(
        designs: usize,
        features: ManyFeatures,
        warp: ManyWarp,
        (frame, grid): (Bounds, PlaneGrid),
    ) -> Result<Self, String> {
        let points = features.points.iter().map(Vec::len);
        let lines = features.lines.iter().map(Vec::len);
        assert!(
            points.chain(lines).all(|count| count == designs),
            "each feature is in each design"
        );
        let blend = Self {
            designs,
            features,
            warp,
            frame,
            grid,
        };
        // Invalid options or features make the warp of at least one design fail.
        for design in 0..designs {
            let own = blend.features.of(design);
            blend.looked(&own, &own, &mut [])?;
        }
        Ok(blend)
    }

    /// Returns the positions of the grid points in the frame of a blend and in each design. A
    /// design with weight 0 keeps the positions in the frame.
    ///
    /// # Panics
    /// If the number of weights differs from the number of designs.
    #[must_use]
    pub fn places(&self, weights: &[f64]) -> ManyPlaces {
        assert_eq!(weights.len(), self.designs, "a weight for each design");
        let between = match &self.warp {
            ManyWarp::Lines(options) => options.between,
            ManyWarp::Scattered(_) | ManyWarp::Lattice(_) => LineInterpolation::Ends,
        };
        let here = self.features.blended(weights, between);
        let mut in_design = vec![self.grid.places().to_vec(); self.designs];
        for (design, places) in in_design.iter_mut().enumerate() {
            let own = self.features.of(design);
            if weights[design] == 0.0 || own == here {
                continue;
            }
            if self.looked(&own, &here, places).is_err() {
                places.copy_from_slice(self.grid.places());
            }
        }
        ManyPlaces {
            faces: self.grid.faces(),
            in_frame: self.grid.places().to_vec(),
            in_design,
        }
    }

    /// Replaces the positions `places` in the frame of a blend by those in a design. The first
    /// argument holds the points and lines of the design, the second those of the blend.
    fn looked(
        &self,
        (points, lines): &(Vec<DVec2>, Vec<[DVec2; 2]>),
        (here, lines_here): &(Vec<DVec2>, Vec<[DVec2; 2]>),
        places: &mut [DVec2],
    ) -> Result<(), String> {
        let pairs = points.iter().zip(here);
        let points: Vec<PointPair> = pairs
            .map(|(&source, &target)| PointPair { source, target })
            .collect();
        let pairs = lines.iter().zip(lines_here);
        let lines: Vec<LinePair> = pairs
            .map(|(&source, &target)| LinePair { source, target })
            .collect();
        let frame = &self.frame;
        match &self.warp {
            ManyWarp::Lines(options) => {
                let warp = LineWarp::new(frame, &lines, &points, options);
                end_of(warp.map_err(|error| error.to_string())?, places);
            }
            ManyWarp::Scattered(options) => {
                let warp = ScatteredWarp::new(frame, &points, &lines, *options);
                end_of(warp.map_err(|error| error.to_string())?, places);
            }
            ManyWarp::Lattice(options) => {
                let warp = Lattice::new(frame, &points, &lines, *options);
                end_of(warp.map_err(|error| error.to_string())?, places);
            }
        }
        Ok(())
    }
}

/// Replaces each position in the frame by the source point that a warp shows there at t = 1.
fn end_of(mut warp: impl PlaneWarp, places: &mut [DVec2]) {
    let frame = places.to_vec();
    let mut in_target = frame.clone();
    warp.look_up(1.0, &frame, places, &mut in_target);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FRAME: Bounds = Bounds {
        min: DVec2::ZERO,
        max: DVec2::ONE,
    };

    fn kinds() -> [ManyWarp; 3] {
        [
            ManyWarp::Lines(LineOptions::default()),
            ManyWarp::Scattered(ScatteredOptions::default()),
            ManyWarp::Lattice(LatticeOptions::default()),
        ]
    }

    fn blend(features: &ManyFeatures, designs: usize, warp: ManyWarp) -> PlaneBlend {
        let grid = PlaneGrid::covering(&FRAME, 12);
        PlaneBlend::new(designs, features.clone(), warp, (FRAME, grid)).expect("a warp")
    }

    fn off(a: &[DVec2], b: &[DVec2]) -> f64 {
        let each = a.iter().zip(b).map(|(p, q)| p.distance(*q));
        each.fold(0.0, f64::max)
    }

    /// Random lines and points that do not come too close to each other, in the given number of
    /// designs.
    fn features(designs: usize) -> impl Strategy<Value = ManyFeatures> {
        let near = move |x: f64, y: f64| {
            let place = (-0.08..0.08, -0.08..0.08);
            let moved = place.prop_map(move |(u, v)| DVec2::new(x + u, y + v));
            prop::collection::vec(moved, designs)
        };
        let places = (
            near(0.2, 0.2),
            near(0.8, 0.25),
            near(0.3, 0.8),
            near(0.75, 0.75),
        );
        places.prop_map(|(a, b, c, d)| ManyFeatures {
            lines: vec![a.into_iter().zip(b).map(|(a, b)| [a, b]).collect()],
            points: vec![c, d],
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn two_designs_are_a_pair(features in features(2), t in 0.05..0.95) {
            let pairs = |k: usize| PointPair {
                source: features.points[k][0],
                target: features.points[k][1],
            };
            let points = [pairs(0), pairs(1)];
            let [source, target] = [features.lines[0][0], features.lines[0][1]];
            let lines = [LinePair { source, target }];
            for kind in kinds() {
                let made = blend(&features, 2, kind.clone());
                let frame = made.grid.places().to_vec();
                let (mut a, mut b) = (frame.clone(), frame.clone());
                match &kind {
                    ManyWarp::Lines(options) => LineWarp::new(&FRAME, &lines, &points, options)
                        .expect("a warp").look_up(t, &frame, &mut a, &mut b),
                    ManyWarp::Scattered(options) => ScatteredWarp::new(&FRAME, &points, &lines, *options)
                        .expect("a warp").look_up(t, &frame, &mut a, &mut b),
                    // Not compared, because rounding may change the number of layers of the
                    // lattice.
                    ManyWarp::Lattice(_) => continue,
                }
                let places = made.places(&[1.0 - t, t]);
                let worst = off(&places.in_design[0], &a).max(off(&places.in_design[1], &b));
                prop_assert!(worst < 1e-9, "{kind:?}: {worst}");
            }
        }

        #[test]
        fn each_design_is_its_corner_and_their_order_does_not_matter(
            features in features(4),
            shares in prop::collection::vec(0.05..1.0, 4),
        ) {
            let sum: f64 = shares.iter().sum();
            let weights: Vec<f64> = shares.iter().map(|share| share / sum).collect();
            let turned = |all: &[f64]| [all[2], all[0], all[3], all[1]];
            let mut other = features.clone();
            for each in &mut other.points {
                *each = vec![each[2], each[0], each[3], each[1]];
            }
            for each in &mut other.lines {
                *each = vec![each[2], each[0], each[3], each[1]];
            }
            for kind in kinds() {
                let made = blend(&features, 4, kind.clone());
                for design in 0..4 {
                    let mut corner = [0.0; 4];
                    corner[design] = 1.0;
                    let places = made.places(&corner);
                    prop_assert_eq!(&places.in_design[design], &places.in_frame);
                }
                let places = made.places(&weights);
                let others = blend(&other, 4, kind).places(&turned(&weights));
                let worst = off(&places.in_design[2], &others.in_design[0]);
                prop_assert!(worst < 1e-9, "{worst}");
                prop_assert!(places.in_design.concat().iter().all(|p| p.is_finite()));
            }
        }
    }

    #[test]
    fn lines_turn_and_keep_their_length() {
        let line = |angle: f64| {
            let half = DVec2::from_angle(angle);
            [-half, half]
        };
        let features = ManyFeatures {
            points: Vec::new(),
            lines: vec![vec![line(0.2), line(1.4), line(2.0)]],
        };
        let weights = [0.5, 0.2, 0.3];
        let (_, lines) = features.blended(&weights, LineInterpolation::MiddleAndAngle);
        let wanted = line(0.5 * 0.2 + 0.2 * 1.4 + 0.3 * 2.0);
        assert!(lines[0][0].distance(wanted[0]) < 1e-12);
        assert!(lines[0][1].distance(wanted[1]) < 1e-12);
    }
}
