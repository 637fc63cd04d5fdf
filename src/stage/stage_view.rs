//! The visible part of the plane on the stage: it can be fitted to bounds, panned, and zoomed at
//! the pointer. Also conversion between pixels and the plane.
//!
//! Guaranteed: zooming keeps the point under the pointer in place; conversion between pixels and
//! the plane is in `f64`, without drift. Pixels are logical pixels; Bevy applies the window's scale
//! factor.

use bevy::prelude::*;
use glam::DVec2;

use crate::geometry::Bounds;

/// Minimum scale in units per pixel, relative to the scale of the last fit (resource limit: at
/// smaller scales the rounding of single precision becomes visible).
const MIN_SCALE: f64 = 1e-4;
/// Maximum scale in units per pixel, relative to the scale of the last fit (heuristic).
const MAX_SCALE: f64 = 1e2;

/// Part of the plane that every [`StageCamera`](super::StageCamera) shows.
///
/// ```
/// use bevy::math::Vec2;
/// use morphospace::geometry::{Bounds, DVec2};
/// use morphospace::stage::StageView;
///
/// let mut view = StageView::default();
/// let bounds = Bounds { min: DVec2::ZERO, max: DVec2::new(4.0, 1.0) };
/// view.fit(bounds, Vec2::new(800.0, 600.0));
/// let pointer = Vec2::new(100.0, 300.0);
/// let under = view.world_from_px(pointer);
/// assert_eq!(under, DVec2::new(0.5, 0.5));
/// view.zoom_at(pointer, 2.0);
/// assert!((view.world_from_px(pointer) - under).length() < 1e-12);
/// ```
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[reflect(Resource, Clone, Debug, Default, PartialEq)]
pub struct StageView {
    /// Point of the plane that is shown in the middle of the viewport.
    pub centre: DVec2,
    /// Scale of the view: units of the plane per logical pixel, positive.
    pub units_per_px: f64,
    /// Size of the viewport in logical pixels. The plugin updates it if there is a
    /// [`StageCamera`](super::StageCamera).
    pub viewport_px: Vec2,
    /// Value of `units_per_px` after the last fit.
    fitted: f64,
    /// Point of the plane that lies at the origin of Bevy's world.
    anchor: DVec2,
}

impl Default for StageView {
    fn default() -> Self {
        Self {
            centre: DVec2::ZERO,
            units_per_px: 1.0,
            viewport_px: Vec2::new(1280.0, 720.0),
            fitted: 1.0,
            anchor: DVec2::ZERO,
        }
    }
}

impl StageView {
    /// Shows all of `bounds`, as large as a viewport of the given size (in logical pixels) allows,
    /// and moves the [anchor](Self::anchor) to the centre of `bounds`.
    pub fn fit(&mut self, bounds: Bounds, viewport_px: Vec2) {
        // A minimised window has size 0, by which the scale must not be divided.
        self.viewport_px = viewport_px.max(Vec2::ONE);
        self.fitted = units_per_px(bounds, self.viewport_px);
        self.units_per_px = self.fitted;
        self.centre = bounds.centre();
        self.anchor = self.centre;
    }

    /// Moves the view so that the shown plane follows a pointer that has moved by `delta_px`
    /// logical pixels, y down.
    pub fn pan_px(&mut self, delta_px: Vec2) {
        let delta = DVec2::new(-f64::from(delta_px.x), f64::from(delta_px.y));
        self.centre += delta * self.units_per_px;
    }

    /// Magnifies the shown plane by `factor` and keeps the point under the pointer in place. The
    /// scale is limited relative to that of the last fit. Factors that are not positive and finite
    /// are ignored.
    pub fn zoom_at(&mut self, pointer_px: Vec2, factor: f64) {
        if !factor.is_finite() || factor <= 0.0 {
            return;
        }
        let under = self.world_from_px(pointer_px);
        let limits = (self.fitted * MIN_SCALE, self.fitted * MAX_SCALE);
        self.units_per_px = (self.units_per_px / factor).clamp(limits.0, limits.1);
        // The point under the pointer moves back into place. This changes nothing if the scale was
        // already at its limit.
        self.centre += under - self.world_from_px(pointer_px);
    }

    /// Returns the point of the plane at a position in the viewport, given in logical pixels from
    /// its upper left corner, y down.
    pub fn world_from_px(&self, px: Vec2) -> DVec2 {
        let from_middle = (px - 0.5 * self.viewport_px).as_dvec2();
        self.centre + DVec2::new(from_middle.x, -from_middle.y) * self.units_per_px
    }

    /// Returns the position of a point of the plane in the viewport: the inverse of
    /// [`Self::world_from_px`].
    pub fn px_from_world(&self, p: DVec2) -> Vec2 {
        let from_middle = (p - self.centre) / self.units_per_px;
        0.5 * self.viewport_px + DVec2::new(from_middle.x, -from_middle.y).as_vec2()
    }

    /// Returns the visible rectangle of the plane.
    pub fn visible(&self) -> Bounds {
        let half = 0.5 * self.viewport_px.as_dvec2() * self.units_per_px;
        Bounds {
            min: self.centre - half,
            max: self.centre + half,
        }
    }

    /// Returns the point of the plane that lies at the origin of Bevy's world: zero before the
    /// first [`Self::fit`], then the centre of the fitted bounds. Bevy's coordinates are therefore
    /// small wherever a design lies, and single precision suffices.
    pub fn anchor(&self) -> DVec2 {
        self.anchor
    }
}

/// Returns the smallest scale, in units per pixel, at which an image of the given size shows all of
/// `bounds`; 1 for bounds without extent.
pub(super) fn units_per_px(bounds: Bounds, size_px: Vec2) -> f64 {
    let scale = (bounds.size() / size_px.as_dvec2()).max_element();
    if scale.is_finite() && scale > 0.0 {
        scale
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> StageView {
        let mut view = StageView::default();
        let bounds = Bounds {
            min: DVec2::new(1e6, -3.0),
            max: DVec2::new(1e6 + 8.0, 1.0),
        };
        view.fit(bounds, Vec2::new(400.0, 400.0));
        view
    }

    #[test]
    fn fitting_centres_the_bounds() {
        let view = view();
        assert_eq!(view.centre, DVec2::new(1e6 + 4.0, -1.0));
        assert_eq!(view.units_per_px, 0.02);
        assert_eq!(view.anchor(), view.centre);
        assert_eq!(view.visible().size(), DVec2::splat(8.0));
    }

    #[test]
    fn screen_and_world_convert_back_and_forth() {
        let view = view();
        for px in [Vec2::ZERO, Vec2::new(12.0, 390.0), Vec2::new(400.0, 1.0)] {
            assert!((view.px_from_world(view.world_from_px(px)) - px).length() < 1e-3);
        }
        assert!(view.world_from_px(Vec2::ZERO).y > view.centre.y, "y is up");
    }

    #[test]
    fn panning_moves_the_picture_with_the_pointer() {
        let mut view = view();
        let under = view.world_from_px(Vec2::new(10.0, 20.0));
        view.pan_px(Vec2::new(30.0, -5.0));
        let now = view.world_from_px(Vec2::new(40.0, 15.0));
        assert!((now - under).length() < 1e-9);
    }

    #[test]
    fn zooming_stops_and_refuses_nonsense() {
        let mut view = view();
        for factor in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
            view.zoom_at(Vec2::ZERO, factor);
            assert_eq!(view.units_per_px, 0.02);
        }
        view.zoom_at(Vec2::ZERO, 1e30);
        assert_eq!(view.units_per_px, 0.02 * MIN_SCALE);
        view.zoom_at(Vec2::ZERO, 1e-30);
        assert_eq!(view.units_per_px, 0.02 * MAX_SCALE);
    }

    #[test]
    fn a_point_can_be_fitted() {
        let mut view = StageView::default();
        let point = Bounds {
            min: DVec2::ONE,
            max: DVec2::ONE,
        };
        view.fit(point, Vec2::ZERO);
        assert_eq!((view.centre, view.units_per_px), (DVec2::ONE, 1.0));
    }
}
