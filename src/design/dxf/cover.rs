//! Cuts out of areas, lines and letters what later areas cover, so that the order of the paint
//! layers does not matter where they overlap.
//!
//! DXF programs draw entities one over the other. Paint layers hold all areas of one layer and
//! colour and are stacked by containment, with lines above areas and letters above lines. Both show
//! the same, once the covered parts are cut out. An area that surrounds a later one is not cut,
//! because the stack puts the inner one on top.

use super::hidden_lines::area_of;
use super::sheet::OutlinedArea;
use super::style::ResolvedStyle;
use crate::colour::Paint;
use crate::design::note::DxfNote;
use crate::design::svg::{WindingRings, boolean};
use crate::geometry::Bounds;
use i_overlay::core::overlay_rule::OverlayRule;

/// Maximum work for all shapes (resource limit: a few seconds): one unit for each area with which a
/// shape is compared, and [`CLIPPING_WORK`] for each point of a shape or area that is clipped.
/// Later shapes stay whole.
const MAX_WORK: usize = 200_000_000;

/// Work for a point of an outline that is clipped, compared with that for a comparison of two
/// bounding boxes (derived: 1 µs compared with 10 ns).
const CLIPPING_WORK: usize = 100;

/// Opaque areas that cover what is drawn before them.
pub(super) struct CoveringAreas<'a> {
    areas: Vec<(&'a OutlinedArea, Bounds, Paint)>,
    /// Work done so far.
    work: usize,
    /// Number of shapes that areas cover entirely.
    hidden: usize,
}

/// Shape that areas may cover.
pub(super) struct CoveredShape<'s> {
    pub rings: &'s WindingRings,
    /// Position in the order of drawing.
    pub order: usize,
    pub paint: Paint,
    /// Whether the shape is stacked below the shapes inside it.
    pub is_stacked: bool,
}

impl<'a> CoveringAreas<'a> {
    /// Collects the opaque areas of a drawing, except letters.
    pub fn of(areas: &'a [OutlinedArea], styles: &[ResolvedStyle]) -> Self {
        let covering = |area: &'a OutlinedArea| {
            let paint = styles[area.style].paint;
            let bounds = Bounds::of(area.rings.iter().flatten().copied())?;
            let is_covering = !area.is_text && paint.opacity >= 1.0;
            is_covering.then_some((area, bounds, paint))
        };
        Self {
            areas: areas.iter().filter_map(covering).collect(),
            work: 0,
            hidden: 0,
        }
    }

    /// Returns what later areas of other paints leave of a shape.
    pub fn rest_of(&mut self, shape: &CoveredShape) -> WindingRings {
        let whole = || shape.rings.clone();
        let Some(bounds) = Bounds::of(shape.rings.iter().flatten().copied()) else {
            return whole();
        };
        self.work += self.areas.len();
        if self.work > MAX_WORK {
            return whole();
        }
        let later = self.areas.iter().filter(|(area, place, paint)| {
            area.order > shape.order && *paint != shape.paint && place.meets(&bounds)
        });
        let own_points = point_count(shape.rings);
        let mut covers = WindingRings::new();
        for (area, ..) in later {
            self.work += CLIPPING_WORK * (own_points + point_count(&area.rings));
            if self.work > MAX_WORK {
                return whole();
            }
            let is_cover = !shape.is_stacked || {
                let outer = boolean(&area.rings, shape.rings, OverlayRule::Difference);
                area_of(&outer) > TOUCHING * area_of(&area.rings)
            };
            if is_cover {
                covers.extend(area.rings.iter().cloned());
            }
        }
        if covers.is_empty() {
            return whole();
        }
        let rest = boolean(shape.rings, &covers, OverlayRule::Difference);
        if area_of(&rest) <= TOUCHING * area_of(shape.rings) {
            self.hidden += 1;
            return Vec::new();
        }
        rest
    }

    /// Returns the notes on what was cut out.
    pub fn notes(&self) -> Vec<DxfNote> {
        let hidden = (self.hidden > 0).then_some(DxfNote::Covered(self.hidden));
        let limited = (self.work > MAX_WORK).then_some(DxfNote::OrderIgnored);
        hidden.into_iter().chain(limited).collect()
    }
}

fn point_count(rings: &WindingRings) -> usize {
    rings.iter().map(Vec::len).sum()
}

/// Fraction of an area that counts as nothing (tolerance: twice the relative error of flattened
/// circles).
pub(super) const TOUCHING: f64 = 1e-3;
