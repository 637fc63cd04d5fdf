//! Distance fields of a transition: the content *field*.
//!
//! Two designs have one pair of fields for the whole shape and, if they are painted, one pair for
//! each paint layer. A path through blends of many designs is a sequence of pairs; each pair covers
//! the same share of the time.
//!
//! Guaranteed: at t = 0 and t = 1 each paint layer has the shape that it has in the source and in
//! the target. A layer that exists in only one design is blended with a field that is outside the
//! shape everywhere, so the layer shrinks until nothing is left.

use super::field::{FieldBlend, FieldBlendError, FieldPair};
use super::{InkedLayer, PaintLayerStack};
use crate::field::{DistanceField, Grid};
use crate::geometry::DVec2;
use crate::warp::Placement;
use rayon::prelude::*;
use std::sync::Arc;

/// Constant distance, in cells, of the field that replaces the field of a missing paint layer
/// (derived: it is negative, so every sample is outside the shape, at the distance of a sample next
/// to a boundary; a larger distance would make the layer of the other design shrink faster).
const MISSING_DISTANCE: f64 = -1.0;

/// Distance fields of a transition. Cloning is cheap because the fields are shared.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldContent {
    /// Pairs of fields for the whole shape, at least one, in order of time. Each covers the same
    /// share of [0, 1].
    pairs: Arc<[FieldPair]>,
    /// Fields for each paint layer; `None` for a content in a single colour.
    painted_fields: Option<PaintedFields>,
    /// Whether a warp carries the fields along. Otherwise the fields do not move.
    is_carried: bool,
}

/// Distance fields of painted designs, one pair for each paint layer.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintedFields {
    /// Paint layers. The lists of boundary loops and holes are empty, because the fields give the
    /// shapes.
    pub paint_layers: PaintLayerStack,
    /// For each layer, the fields of source and target; `None` if the design does not have the
    /// layer.
    fields: Vec<[Option<Arc<DistanceField>>; 2]>,
    /// For each layer, the pair that is blended, with missing fields replaced.
    pairs: Vec<FieldPair>,
}

impl FieldContent {
    /// Creates the content from a pair of fields for the whole shape and, if the designs are
    /// painted, the fields of their paint layers. If `is_carried`, a warp carries the fields along;
    /// otherwise they do not move.
    #[must_use]
    pub fn new(whole: FieldPair, painted: Option<PaintedFields>, is_carried: bool) -> Self {
        Self {
            pairs: [whole].into(),
            painted_fields: painted,
            is_carried,
        }
    }

    /// Creates a sequence of pairs in a single colour, which no warp carries. Each pair covers the
    /// same share of [0, 1]; it should start with the field that the previous pair ends with.
    /// Returns `None` if there are no pairs, or if their grids or parameters differ.
    #[must_use]
    pub fn sequence(pairs: Vec<FieldPair>) -> Option<Self> {
        let first = pairs.first()?;
        let fits = |pair: &FieldPair| (pair.grid(), pair.blend()) == (first.grid(), first.blend());
        pairs.iter().all(fits).then(|| Self {
            pairs: pairs.into(),
            painted_fields: None,
            is_carried: false,
        })
    }

    /// The first pair for the whole shape. It is the one shown at t = 0.
    #[must_use]
    pub fn first_pair(&self) -> &FieldPair {
        &self.pairs[0]
    }

    /// Pairs for the whole shape in order of time; two designs have a single pair.
    #[must_use]
    pub fn pairs(&self) -> &[FieldPair] {
        &self.pairs
    }

    /// Returns the index of the pair that is shown at `t`, and the t at which this pair is blended.
    /// Outside [0, 1] the first or the last pair extrapolates.
    #[must_use]
    pub fn pair_at(&self, t: f64) -> (usize, f64) {
        let count = self.pairs.len();
        if count == 1 {
            return (0, t);
        }
        let pair_time = t * count as f64;
        // The cast saturates and turns NaN into 0.
        let pair = (pair_time.floor().max(0.0) as usize).min(count - 1);
        (pair, pair_time - pair as f64)
    }

    /// Fields for each paint layer; `None` for a content in a single colour.
    #[must_use]
    pub fn painted_fields(&self) -> Option<&PaintedFields> {
        self.painted_fields.as_ref()
    }

    /// Returns mutable access to the fields of each paint layer; `None` for a content in a single
    /// colour.
    pub(crate) fn painted_fields_mut(&mut self) -> Option<&mut PaintedFields> {
        self.painted_fields.as_mut()
    }

    /// Returns the same fields with other blend parameters. Distances are not computed again.
    /// Returns `None` for a sequence of several pairs, whose fields are themselves blends.
    ///
    /// # Errors
    /// [`FieldBlendError`] if the parameters are invalid.
    pub fn with_blend(&self, blend: FieldBlend) -> Result<Option<Self>, FieldBlendError> {
        let [whole] = &*self.pairs else {
            return Ok(None);
        };
        let whole = whole.with_blend(blend)?;
        let reblend = |painted: &PaintedFields| {
            let (stack, fields) = (painted.paint_layers.clone(), painted.fields.clone());
            PaintedFields::from_layer_fields(stack, fields, whole.grid(), blend)
        };
        let painted = self.painted_fields.as_ref().map(reblend).transpose()?;
        Ok(Some(Self::new(whole, painted, self.is_carried)))
    }

    /// Returns the contour of the whole shape at `t`. `placement` must be the placement of the warp
    /// at the same `t`.
    #[must_use]
    pub fn contour(&self, placement: &Placement, t: f64) -> Vec<Vec<DVec2>> {
        let (pair, t) = self.pair_at(t);
        self.contour_of(&self.pairs[pair], placement, t)
    }

    /// Returns the contours at `t`, grouped by paint layer, the lowest layer first. A content in a
    /// single colour has one group.
    #[must_use]
    pub fn layers_at(&self, placement: &Placement, t: f64) -> Vec<InkedLayer> {
        let Some(PaintedFields {
            paint_layers: stack,
            pairs,
            ..
        }) = &self.painted_fields
        else {
            let rings = self.contour(placement, t);
            return vec![InkedLayer {
                t,
                rings,
                ..InkedLayer::default()
            }];
        };
        let order = stack.draw_order(t).into_par_iter();
        let layers = order.map(|k| {
            let inked = InkedLayer {
                layer: k,
                t,
                rings: self.contour_of(&pairs[k], placement, t),
                ..InkedLayer::default()
            };
            let layer = &stack.layers[k];
            let gradients = layer.shading.gradients_at(&placement.in_frame, |_| true);
            layer.ink(
                inked,
                gradients,
                layer.only_in.filter(|_| stack.fades_unmatched),
            )
        });
        layers.collect()
    }

    /// Contour of one pair at `t`. If the fields are carried along, the warp moves the contour.
    fn contour_of(&self, pair: &FieldPair, placement: &Placement, t: f64) -> Vec<Vec<DVec2>> {
        match self.is_carried {
            true => pair.contour_carried(placement, t),
            false => pair.contour(t),
        }
    }
}

impl PaintedFields {
    /// Creates the pairs of all layers from the fields of source and target, which must have the
    /// grid `grid`. `None` stands for a layer that the design does not have.
    ///
    /// # Errors
    /// Same as [`FieldPair::new`].
    pub fn new(
        stack: PaintLayerStack,
        fields: Vec<[Option<DistanceField>; 2]>,
        grid: &Grid,
        blend: FieldBlend,
    ) -> Result<Self, FieldBlendError> {
        let fields = fields
            .into_iter()
            .map(|ends| ends.map(|end| end.map(Arc::new)));
        Self::from_layer_fields(stack, fields.collect(), grid, blend)
    }

    /// Creates the pairs of all layers. A missing field is replaced by one that is outside the
    /// shape everywhere.
    fn from_layer_fields(
        stack: PaintLayerStack,
        fields: Vec<[Option<Arc<DistanceField>>; 2]>,
        grid: &Grid,
        blend: FieldBlend,
    ) -> Result<Self, FieldBlendError> {
        // A negative threshold would fill a field whose distance is only slightly negative. The
        // threshold is therefore added to the distance, so that the missing layer stays empty.
        let outside = MISSING_DISTANCE + blend.threshold.min(0.0);
        let missing = Arc::new(DistanceField::uniform(*grid, outside));
        let pair = |ends: &[Option<Arc<DistanceField>>; 2]| {
            let [source, target] = ends
                .each_ref()
                .map(|end| Arc::clone(end.as_ref().unwrap_or(&missing)));
            FieldPair::new(source, target, blend)
        };
        Ok(Self {
            pairs: fields.iter().map(pair).collect::<Result<_, _>>()?,
            paint_layers: stack,
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

    /// Numbers of columns and rows of the test grid.
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

    /// Content of two paint layers: a bar that moves from left to right, and above it a bar that
    /// only the source has.
    fn fields(blend: FieldBlend) -> FieldContent {
        let whole = FieldPair::new(field(2..10), field(12..20), blend).expect("a field");
        let grid = *whole.grid();
        let mut stack = PaintLayerStack::single_layer(0, 0);
        let mut above = stack.layers[0].clone();
        (above.z_indices, above.only_in) = ([1; 2], Some(Side::Source));
        stack.layers.push(above);
        let pairs = vec![
            [Some(field(2..10)), Some(field(12..20))],
            [Some(field(4..8)), None],
        ];
        let painted = PaintedFields::new(stack, pairs, &grid, blend).expect("a field");
        FieldContent::new(whole, Some(painted), false)
    }

    fn areas(fields: &FieldContent, t: f64) -> Vec<f64> {
        let bounds = fields.first_pair().grid().bounds();
        let layers = fields.layers_at(IdentityWarp::new(bounds).placer().placement(), t);
        let area = |layer: &InkedLayer| layer.rings.iter().map(|ring| signed_area(ring)).sum();
        layers.iter().map(area).collect()
    }

    #[test]
    fn a_layer_of_only_one_design_shrinks_away() {
        let fields = fields(FieldBlend::default());
        let [start, later, end] = [0.0, 0.5, 1.0].map(|t| areas(&fields, t));
        assert!((start[0] - end[0]).abs() < 1e-9 && start[1] > 25.0);
        assert!(later[1] > 0.1 && later[1] < start[1]);
        assert_eq!(end[1], 0.0);
    }

    #[test]
    fn a_sequence_shows_its_pairs_one_after_the_other() {
        let pair = |from, to| FieldPair::new(from, to, FieldBlend::default()).expect("a pair");
        let [first, second] = [
            pair(field(2..10), field(6..16)),
            pair(field(6..16), field(12..20)),
        ];
        let fields = FieldContent::sequence(vec![first.clone(), second.clone()]).expect("pairs");
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
        assert_eq!(FieldContent::sequence(Vec::new()), None);
    }

    #[test]
    fn a_missing_layer_stays_empty_at_any_threshold() {
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
