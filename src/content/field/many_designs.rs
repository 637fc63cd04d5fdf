//! Blends of the distance fields fⱼ of any number of designs with weights wⱼ: F = Σ wⱼ L(fⱼ),
//! filled where F ≥ L(τ). L is the scale function and τ the threshold of [`FieldBlend`].
//!
//! Guaranteed: with all weight on one design the contour is that of this design; for two designs
//! with the weights (1 − t, t) it is that of a [`super::FieldPair`] at t.

use super::{FieldBlend, FieldBlendError};
use crate::field::{DistanceField, Grid, contour};
use crate::geometry::DVec2;
use rayon::prelude::*;
use std::sync::Arc;

/// One or more distance fields on the same grid, and the parameters of their blend. Cloning is
/// cheap.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldSet {
    fields: Arc<[DistanceField]>,
    blend: FieldBlend,
}

impl FieldSet {
    /// Combines fields on the same grid. Returns `None` if there are no fields.
    ///
    /// # Errors
    /// [`FieldBlendError`] if the grids differ or the parameters are invalid.
    pub fn new(
        fields: Vec<DistanceField>,
        blend: FieldBlend,
    ) -> Result<Option<Self>, FieldBlendError> {
        blend.check()?;
        let Some(first) = fields.first() else {
            return Ok(None);
        };
        // Distances are in cells, so fields on different grids have different units.
        if let Some(other) = fields.iter().find(|field| field.grid() != first.grid()) {
            return Err(FieldBlendError::Grids {
                source_grid: *first.grid(),
                target_grid: *other.grid(),
            });
        }
        let fields = fields.into();
        Ok(Some(Self { fields, blend }))
    }

    /// Grid of all fields.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        self.fields[0].grid()
    }

    /// Parameters of the blend.
    #[must_use]
    pub fn blend(&self) -> FieldBlend {
        self.blend
    }

    /// Distance fields, one for each design.
    #[must_use]
    pub fn fields(&self) -> &[DistanceField] {
        &self.fields
    }

    /// Returns the blend F = Σ wⱼ L(fⱼ) for the weights wⱼ as a distance field: each sample is the
    /// distance x with L(x) = F. Repeated blending is therefore exact at the samples: a blend of
    /// two results of this function equals a single blend of the original fields, with the two
    /// lists of weights blended in the same way. With all weight on one design the result is that
    /// design's field, unchanged.
    ///
    /// # Panics
    /// Panics if the number of weights differs from the number of fields.
    #[must_use]
    pub fn blended(&self, weights: &[f64]) -> DistanceField {
        assert_eq!(weights.len(), self.fields.len(), "a weight for each field");
        if let Some(only) = weights.iter().position(|&weight| weight == 1.0)
            && weights.iter().filter(|&&weight| weight != 0.0).count() == 1
        {
            return self.fields[only].clone();
        }
        let weighted: Vec<_> = self
            .fields
            .iter()
            .zip(weights)
            .filter(|&(_, &weight)| weight != 0.0)
            .collect();
        let count = self.fields[0].values().len();
        let value_at = |k: usize| {
            let terms = weighted
                .iter()
                .map(|(field, weight)| **weight * self.blend.curve(f64::from(field.values()[k])));
            self.blend.inverse_curve(terms.sum()) as f32
        };
        let values = (0..count).into_par_iter().map(value_at).collect();
        DistanceField::new(*self.grid(), values)
            .unwrap_or_else(|_| unreachable!("blends of finite numbers are finite"))
    }

    /// Returns the contour of the blend for these weights as closed polygons in the plane, clipped
    /// to the rectangle of the grid. Outer polygons run counter-clockwise, holes clockwise. Fields
    /// with weight 0 are not read.
    ///
    /// # Panics
    /// Panics if the number of weights differs from the number of fields.
    #[must_use]
    pub fn contour(&self, weights: &[f64]) -> Vec<Vec<DVec2>> {
        assert_eq!(weights.len(), self.fields.len(), "a weight for each field");
        let (grid, blend) = (self.grid(), &self.blend);
        let weighted: Vec<(&DistanceField, f64)> = self
            .fields
            .iter()
            .zip(weights.iter().copied())
            .filter(|&(_, weight)| weight != 0.0)
            .collect();
        let value = |x, y| -> f64 {
            let terms = weighted.iter();
            terms
                .map(|(field, weight)| weight * blend.curve(field.samples().bilinear(x, y)))
                .sum()
        };
        // L is monotone. With non-negative weights a sample therefore needs no evaluation if all
        // fields are on the same side of the threshold there.
        let is_between = weights.iter().all(|&weight| weight >= 0.0);
        let known_side = |column: usize, row: usize| {
            let index = row * grid.width as usize + column;
            let mut sides = weighted
                .iter()
                .map(|(field, _)| f64::from(field.values()[index]) >= blend.threshold);
            let first = sides.next()?;
            (is_between && sides.all(|side| side == first)).then_some(first)
        };
        let mut rings =
            contour::trace_with_known(grid.width, grid.height, known_side, value, blend.level());
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
    fn two_designs_give_the_contour_of_the_pair() {
        let pair = FieldPair::new(field(2..14), field(9..20), FieldBlend::default());
        let (pair, set) = (pair.expect("one grid"), set(&[2..14, 9..20]));
        for t in [0.0, 0.25, 0.5, 1.0, 1.25] {
            assert_eq!(set.contour(&[1.0 - t, t]), pair.contour(t), "{t}");
        }
    }

    #[test]
    fn blending_two_blends_blends_their_weights() {
        let abc = set(&[2..14, 9..20, 5..16]);
        let ends = [[0.5, 0.25, 0.25], [0.0, 1.0, 0.0]].map(|weights| abc.blended(&weights));
        assert_eq!(ends[1], field(9..20));
        let pair = FieldPair::new(ends[0].clone(), ends[1].clone(), FieldBlend::default());
        let [near, far] = [
            pair.expect("one grid").contour(0.5),
            abc.contour(&[0.25, 0.625, 0.125]),
        ];
        let [near, far] = [near.concat(), far.concat()];
        // `near` comes from two blended fields, which are interpolated between samples after the
        // first blend. `far` comes from the original fields, which are interpolated before any
        // blend. The two contours therefore differ slightly.
        let gap = |p: &DVec2| far.iter().map(|q| p.distance(*q)).fold(9.0, f64::min);
        assert!(near.iter().map(gap).all(|gap| gap < 0.2) && near.len() > 10);
    }

    #[test]
    fn full_weight_gives_the_design_and_order_does_not_matter() {
        let abc = set(&[2..14, 9..20, 5..16]);
        let single = FieldSet::new(vec![field(9..20)], FieldBlend::default());
        let single = single.expect("one grid").expect("a field");
        assert_eq!(abc.contour(&[0.0, 1.0, 0.0]), single.contour(&[1.0]));
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
        let other = DistanceField::uniform(grid, 1.0);
        let refused = FieldSet::new(vec![field(2..4), other], FieldBlend::default());
        assert!(matches!(refused, Err(FieldBlendError::Grids { .. })));
        assert_eq!(FieldSet::new(vec![], FieldBlend::default()), Ok(None));
    }
}
