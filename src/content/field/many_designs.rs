//! Fields of many designs, and how they mix: F = Σ w_j L(f_j), drawn where F ≥ L(τ).
//!
//! Guaranteed: with all weight on one design its own contour, and of two designs with
//! the weights (1 − t, t) that of a [`super::FieldPair`] at t.

use super::{FieldBlend, FieldPairError};
use crate::field::{DistanceField, Grid, contour};
use crate::geometry::DVec2;
use rayon::prelude::*;
use std::sync::Arc;

/// Distance fields on one grid, at least one, and their blend. Cloning is cheap.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldSet {
    fields: Arc<[DistanceField]>,
    blend: FieldBlend,
}

impl FieldSet {
    /// None of no fields.
    ///
    /// # Errors
    /// Where the grids differ, or the blend is none.
    pub fn new(
        fields: Vec<DistanceField>,
        blend: FieldBlend,
    ) -> Result<Option<Self>, FieldPairError> {
        blend.check()?;
        let Some(first) = fields.first() else {
            return Ok(None);
        };
        // Distances are in cells: those of another grid would mean something else.
        if let Some(other) = fields.iter().find(|field| field.grid() != first.grid()) {
            return Err(FieldPairError::Grids {
                source_grid: *first.grid(),
                target_grid: *other.grid(),
            });
        }
        let fields = fields.into();
        Ok(Some(Self { fields, blend }))
    }

    /// The grid of all fields.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        self.fields[0].grid()
    }

    /// How they mix.
    #[must_use]
    pub fn blend(&self) -> FieldBlend {
        self.blend
    }

    /// The fields, one for each design.
    #[must_use]
    pub fn fields(&self) -> &[DistanceField] {
        &self.fields
    }

    /// The field whose L is the blend with these weights: what is between two such fields
    /// is what is between their weights. With all weight on one design it is its own.
    ///
    /// # Panics
    /// If there are not as many weights as fields.
    #[must_use]
    pub fn blended(&self, weights: &[f64]) -> DistanceField {
        assert_eq!(weights.len(), self.fields.len(), "a weight for each field");
        if let Some(alone) = weights.iter().position(|&weight| weight == 1.0)
            && weights.iter().filter(|&&weight| weight != 0.0).count() == 1
        {
            return self.fields[alone].clone();
        }
        let each = self.fields.iter().zip(weights);
        let read: Vec<_> = each.filter(|&(_, &weight)| weight != 0.0).collect();
        let count = self.fields[0].values().len();
        let at = |k: usize| {
            let level = read
                .iter()
                .map(|(field, weight)| **weight * self.blend.curve(f64::from(field.values()[k])));
            self.blend.distance(level.sum()) as f32
        };
        let values = (0..count).into_par_iter().map(at).collect();
        DistanceField::new(*self.grid(), values)
            .unwrap_or_else(|_| unreachable!("blends of finite numbers are finite"))
    }

    /// What is drawn with these weights, as closed polygons in the plane: outer ones
    /// counter-clockwise, holes clockwise, cut off at the grid's rectangle. What has no
    /// weight is not read.
    ///
    /// # Panics
    /// If there are not as many weights as fields.
    #[must_use]
    pub fn contour(&self, weights: &[f64]) -> Vec<Vec<DVec2>> {
        assert_eq!(weights.len(), self.fields.len(), "a weight for each field");
        let (grid, blend) = (self.grid(), &self.blend);
        let read: Vec<(&DistanceField, f64)> = self
            .fields
            .iter()
            .zip(weights.iter().copied())
            .filter(|&(_, weight)| weight != 0.0)
            .collect();
        let value = |x, y| -> f64 {
            let each = read.iter();
            each.map(|(field, weight)| weight * blend.curve(field.samples().bilinear(x, y)))
                .sum()
        };
        // L is monotone: what all fields have on one side of the threshold is there.
        let is_between = weights.iter().all(|&weight| weight >= 0.0);
        let known = |column: usize, row: usize| {
            let at = row * grid.width as usize + column;
            let mut sides = read
                .iter()
                .map(|(field, _)| f64::from(field.values()[at]) >= blend.threshold);
            let first = sides.next()?;
            (is_between && sides.all(|side| side == first)).then_some(first)
        };
        let mut rings =
            contour::trace_knowing(grid.width, grid.height, known, value, blend.level());
        for p in rings.iter_mut().flatten() {
            *p = grid.plane_from_lattice(*p);
        }
        rings
    }
}

#[cfg(test)]
mod tests {
    use super::super::FieldPair;
    use super::*;
    use crate::field::{Mask, Metric};
    use crate::work::progress::Silent;

    fn field(columns: std::ops::Range<usize>) -> DistanceField {
        let grid = Grid::new(24, 16, DVec2::ZERO, 1.0).expect("a grid");
        let bits = (0..24 * 16).map(|k| columns.contains(&(k % 24)) && (4..12).contains(&(k / 24)));
        let mask = Mask::new(24, 16, bits.collect()).expect("a mask");
        DistanceField::from_mask(&mask, grid, Metric::Euclidean, &Silent).expect("a field")
    }

    fn set(columns: &[std::ops::Range<usize>]) -> FieldSet {
        let fields = columns.iter().cloned().map(field).collect();
        let set = FieldSet::new(fields, FieldBlend::default());
        set.expect("one grid").expect("fields")
    }

    #[test]
    fn two_are_the_pair() {
        let pair = FieldPair::new(field(2..14), field(9..20), FieldBlend::default());
        let (pair, set) = (pair.expect("one grid"), set(&[2..14, 9..20]));
        for t in [0.0, 0.25, 0.5, 1.0, 1.25] {
            assert_eq!(set.contour(&[1.0 - t, t]), pair.contour(t), "{t}");
        }
    }

    #[test]
    fn between_two_blends_is_what_is_between_their_weights() {
        let abc = set(&[2..14, 9..20, 5..16]);
        let ends = [[0.5, 0.25, 0.25], [0.0, 1.0, 0.0]].map(|weights| abc.blended(&weights));
        assert_eq!(ends[1], field(9..20));
        let pair = FieldPair::new(ends[0].clone(), ends[1].clone(), FieldBlend::default());
        let [near, far] = [
            pair.expect("one grid").contour(0.5),
            abc.contour(&[0.25, 0.625, 0.125]),
        ];
        let [near, far] = [near.concat(), far.concat()];
        // Both are read between the same samples, the one before and the other after L.
        let gap = |p: &DVec2| far.iter().map(|q| p.distance(*q)).fold(9.0, f64::min);
        assert!(near.iter().map(gap).all(|gap| gap < 0.2) && near.len() > 10);
    }

    #[test]
    fn each_is_itself_and_their_order_means_nothing() {
        let abc = set(&[2..14, 9..20, 5..16]);
        let alone = FieldSet::new(vec![field(9..20)], FieldBlend::default());
        let alone = alone.expect("one grid").expect("a field");
        assert_eq!(abc.contour(&[0.0, 1.0, 0.0]), alone.contour(&[1.0]));
        let cab = set(&[5..16, 2..14, 9..20]);
        let [first, again] = [
            abc.contour(&[0.5, 0.25, 0.25]),
            cab.contour(&[0.25, 0.5, 0.25]),
        ];
        assert_eq!(first.len(), again.len());
        for (p, q) in first.iter().flatten().zip(again.iter().flatten()) {
            assert!(p.distance(*q) < 1e-9);
        }
    }

    #[test]
    fn fields_on_two_grids_are_refused() {
        let grid = Grid::new(4, 4, DVec2::ZERO, 1.0).expect("a grid");
        let other = DistanceField::even(grid, 1.0);
        let refused = FieldSet::new(vec![field(2..4), other], FieldBlend::default());
        assert!(matches!(refused, Err(FieldPairError::Grids { .. })));
        assert_eq!(FieldSet::new(vec![], FieldBlend::default()), Ok(None));
    }
}
