//! The distance fields of two designs: of all that they cover, and one for each paint of
//! drawings in several; or those of many on the way through their blends, two at a time.
//!
//! Guarantees: at t = 0 and t = 1 each coat is that of its drawing. What one drawing has
//! alone is blended with a field that is outside everywhere, and so shrinks away.

use super::field::{FieldBlend, FieldPair, FieldPairError};
use super::{InkedLayer, PaintLayerStack};
use crate::field::{DistanceField, Grid};
use crate::geometry::DVec2;
use crate::warp::Placement;
use rayon::prelude::*;
use std::sync::Arc;

/// How deep outside the level a drawing is that has nothing in some paint, in cells: as
/// deep as a sample beside a boundary, so that what the other has of it stays for long.
const NOTHING: f64 = -1.0;

/// The content *distance field*. Cloning is cheap: fields are shared.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldContent {
    /// At least one; each for as long as the others.
    pairs: Arc<[FieldPair]>,
    painted: Option<PaintedFields>,
    is_carried: bool,
}

/// The fields of drawings in several paints.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintedFields {
    /// The coats; there are no walks and no holes.
    pub coating: PaintLayerStack,
    /// Of each coat those of source and target; none where the design has nothing in it.
    fields: Vec<[Option<Arc<DistanceField>>; 2]>,
    /// As they are blended.
    pairs: Vec<FieldPair>,
}

impl FieldContent {
    /// Of all that is covered, in one colour unless it is painted; carried by a warp, or
    /// at rest.
    #[must_use]
    pub fn new(whole: FieldPair, painted: Option<PaintedFields>, is_carried: bool) -> Self {
        Self {
            pairs: [whole].into(),
            painted,
            is_carried,
        }
    }

    /// Pairs at rest, one after the other for as long each, in one colour: what one ends
    /// with the next begins with. None of no pairs, or where their grids or blends differ.
    #[must_use]
    pub fn in_turn(pairs: Vec<FieldPair>) -> Option<Self> {
        let first = pairs.first()?;
        let fits = |pair: &FieldPair| (pair.grid(), pair.blend()) == (first.grid(), first.blend());
        pairs.iter().all(fits).then(|| Self {
            pairs: pairs.into(),
            painted: None,
            is_carried: false,
        })
    }

    /// The fields of all that is covered at t = 0.
    #[must_use]
    pub fn first(&self) -> &FieldPair {
        &self.pairs[0]
    }

    /// The pairs of fields of all that is covered, in turn: of two designs one.
    #[must_use]
    pub fn pairs(&self) -> &[FieldPair] {
        &self.pairs
    }

    /// The number of the pair that is seen at `t`, and where in it: before and behind all
    /// it extrapolates.
    #[must_use]
    pub fn place(&self, t: f64) -> (usize, f64) {
        let count = self.pairs.len();
        if count == 1 {
            return (0, t);
        }
        let share = t * count as f64;
        // `as` saturates, and takes what is no number for 0.
        let pair = (share.floor().max(0.0) as usize).min(count - 1);
        (pair, share - pair as f64)
    }

    /// Those of the paints; none where there is one colour.
    #[must_use]
    pub fn painted(&self) -> Option<&PaintedFields> {
        self.painted.as_ref()
    }

    pub(crate) fn painted_mut(&mut self) -> Option<&mut PaintedFields> {
        self.painted.as_mut()
    }

    /// The same fields mixed another way; measures nothing again. None of several in
    /// turn, which were mixed before.
    ///
    /// # Errors
    /// Where the blend is none.
    pub fn with_blend(&self, blend: FieldBlend) -> Result<Option<Self>, FieldPairError> {
        let [whole] = &*self.pairs else {
            return Ok(None);
        };
        let whole = whole.with_blend(blend)?;
        let again = |painted: &PaintedFields| {
            let (coating, fields) = (painted.coating.clone(), painted.fields.clone());
            PaintedFields::blended(coating, fields, whole.grid(), blend)
        };
        let painted = self.painted.as_ref().map(again).transpose()?;
        Ok(Some(Self::new(whole, painted, self.is_carried)))
    }

    /// The contour of all that is covered, when the placement is that of `t`.
    #[must_use]
    pub fn contour(&self, placement: &Placement, t: f64) -> Vec<Vec<DVec2>> {
        let (pair, t) = self.place(t);
        self.contour_of(&self.pairs[pair], placement, t)
    }

    /// The contours coat by coat as they lie at `t`, the lowest first, or that of the
    /// whole where it has one colour.
    #[must_use]
    pub fn coated_at(&self, placement: &Placement, t: f64) -> Vec<InkedLayer> {
        let Some(PaintedFields { coating, pairs, .. }) = &self.painted else {
            let rings = self.contour(placement, t);
            return vec![InkedLayer {
                t,
                rings,
                ..InkedLayer::default()
            }];
        };
        let order = coating.order(t).into_par_iter();
        let coats = order.map(|k| {
            let inked = InkedLayer {
                coat: k,
                t,
                rings: self.contour_of(&pairs[k], placement, t),
                ..InkedLayer::default()
            };
            let coat = &coating.coats[k];
            let gradients = coat.shading.at(&placement.in_frame, |_| true);
            coat.ink(inked, gradients, coat.alone.filter(|_| coating.fades))
        });
        coats.collect()
    }

    fn contour_of(&self, pair: &FieldPair, placement: &Placement, t: f64) -> Vec<Vec<DVec2>> {
        match self.is_carried {
            true => pair.contour_carried(placement, t),
            false => pair.contour(t),
        }
    }
}

impl PaintedFields {
    /// Of each coat its fields in source and target, on the grid that all have; none
    /// where the design has nothing in it.
    ///
    /// # Errors
    /// As [`FieldPair::new`].
    pub fn new(
        coating: PaintLayerStack,
        fields: Vec<[Option<DistanceField>; 2]>,
        grid: &Grid,
        blend: FieldBlend,
    ) -> Result<Self, FieldPairError> {
        let fields = fields
            .into_iter()
            .map(|ends| ends.map(|end| end.map(Arc::new)));
        Self::blended(coating, fields.collect(), grid, blend)
    }

    fn blended(
        coating: PaintLayerStack,
        fields: Vec<[Option<Arc<DistanceField>>; 2]>,
        grid: &Grid,
        blend: FieldBlend,
    ) -> Result<Self, FieldPairError> {
        // Outside whatever the threshold is.
        let outside = NOTHING + blend.threshold.min(0.0);
        let nothing = Arc::new(DistanceField::even(*grid, outside));
        let pair = |ends: &[Option<Arc<DistanceField>>; 2]| {
            let [source, target] = ends
                .each_ref()
                .map(|end| Arc::clone(end.as_ref().unwrap_or(&nothing)));
            FieldPair::new(source, target, blend)
        };
        Ok(Self {
            pairs: fields.iter().map(pair).collect::<Result<_, _>>()?,
            coating,
            fields,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Mask, Metric};
    use crate::geometry::{Side, signed_area};
    use crate::warp::{IdentityWarp, Warp};
    use crate::work::progress::Silent;

    const GRID: [u32; 2] = [24, 16];

    fn field(columns: std::ops::Range<usize>) -> DistanceField {
        let [width, height] = GRID;
        let grid = Grid::new(width, height, DVec2::ZERO, 1.0).expect("a field");
        let bits = (0..width as usize * height as usize).map(|k| {
            let (x, y) = (k % width as usize, k / width as usize);
            columns.contains(&x) && (4..12).contains(&y)
        });
        let mask = Mask::new(width, height, bits.collect()).expect("a field");
        DistanceField::from_mask(&mask, grid, Metric::Euclidean, &Silent).expect("a field")
    }

    /// A bar that goes from left to right, and one on it that dies.
    fn fields(blend: FieldBlend) -> FieldContent {
        let whole = FieldPair::new(field(2..10), field(12..20), blend).expect("a field");
        let grid = *whole.grid();
        let mut coating = PaintLayerStack::plain(0, 0);
        let mut above = coating.coats[0].clone();
        (above.heights, above.alone) = ([1; 2], Some(Side::Source));
        coating.coats.push(above);
        let pairs = vec![
            [Some(field(2..10)), Some(field(12..20))],
            [Some(field(4..8)), None],
        ];
        let painted = PaintedFields::new(coating, pairs, &grid, blend).expect("a field");
        FieldContent::new(whole, Some(painted), false)
    }

    fn areas(fields: &FieldContent, t: f64) -> Vec<f64> {
        let bounds = fields.first().grid().bounds();
        let coats = fields.coated_at(IdentityWarp::new(bounds).placer().placement(), t);
        let area = |coat: &InkedLayer| coat.rings.iter().map(|ring| signed_area(ring)).sum();
        coats.iter().map(area).collect()
    }

    #[test]
    fn what_one_design_has_alone_shrinks_away() {
        let fields = fields(FieldBlend::default());
        let [start, later, end] = [0.0, 0.5, 1.0].map(|t| areas(&fields, t));
        assert!((start[0] - end[0]).abs() < 1e-9 && start[1] > 25.0);
        assert!(later[1] > 0.1 && later[1] < start[1]);
        assert_eq!(end[1], 0.0);
    }

    #[test]
    fn pairs_in_turn_are_seen_one_after_the_other() {
        let pair = |from, to| FieldPair::new(from, to, FieldBlend::default()).expect("a pair");
        let [first, second] = [
            pair(field(2..10), field(6..16)),
            pair(field(6..16), field(12..20)),
        ];
        let fields = FieldContent::in_turn(vec![first.clone(), second.clone()]).expect("pairs");
        let still = IdentityWarp::new(first.grid().bounds()).placer();
        for (t, pair, within) in [
            (-0.25, &first, -0.5),
            (0.0, &first, 0.0),
            (0.25, &first, 0.5),
            (0.5, &second, 0.0),
            (0.75, &second, 0.5),
            (1.0, &second, 1.0),
        ] {
            assert_eq!(
                fields.contour(still.placement(), t),
                pair.contour(within),
                "{t}"
            );
        }
        assert_eq!(fields.with_blend(FieldBlend::default()), Ok(None));
        assert_eq!(FieldContent::in_turn(Vec::new()), None);
    }

    #[test]
    fn nothing_stays_nothing_at_any_threshold() {
        let blend = |threshold: f64| FieldBlend {
            threshold,
            ..FieldBlend::default()
        };
        let fields = fields(blend(0.0));
        for threshold in [-3.0, -1.0, 1.0] {
            let again = fields.with_blend(blend(threshold)).expect("a field");
            let again = again.expect("one pair");
            assert_eq!(areas(&again, 1.0)[1], 0.0, "{threshold}");
            assert_ne!(areas(&again, 0.0), areas(&fields, 0.0));
        }
    }
}
