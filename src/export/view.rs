//! Mapping between the plane of the designs (y up) and pixels (y down).

use crate::geometry::{Bounds, DAffine2, DVec2};

use super::size::PixelSize;

/// Part of the plane that an image, or a cell of a contact sheet, shows.
///
/// The rectangle passed to [`PlaneView::fit`] or [`PlaneView::fit_cell`] is entirely visible,
/// centred, and equally scaled in both directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneView {
    /// Size of the whole image.
    size: PixelSize,
    /// Point of the plane that is shown at `middle_px`.
    centre: DVec2,
    /// Centre of the image or cell, in pixels.
    middle_px: DVec2,
    px_per_unit: f64,
}

impl PlaneView {
    /// Fits `bounds` into an image of the given size.
    pub fn fit(bounds: Bounds, size: PixelSize) -> Self {
        Self::fit_cell(bounds, size, DVec2::ZERO, size.as_dvec2())
    }

    /// Fits `bounds` into a cell of an image. The cell has its upper left corner at `corner_px` and
    /// the size `cell_px`.
    pub fn fit_cell(bounds: Bounds, size: PixelSize, corner_px: DVec2, cell_px: DVec2) -> Self {
        let ratio = cell_px / bounds.size();
        let px_per_unit = [ratio.x, ratio.y]
            .into_iter()
            // The bounds of a horizontal or vertical line have no extent along one axis; those of a
            // point have no extent at all.
            .filter(|r| r.is_finite() && *r > 0.0)
            .reduce(f64::min);
        Self {
            size,
            centre: bounds.centre(),
            middle_px: corner_px + 0.5 * cell_px,
            px_per_unit: px_per_unit.unwrap_or(1.0),
        }
    }

    /// Returns the view for an image of another size. Everything that this view shows stays
    /// visible.
    #[must_use]
    pub fn scaled_to(&self, size: PixelSize) -> Self {
        let ratio = size.as_dvec2() / self.size.as_dvec2();
        let scale = ratio.min_element();
        let from_middle = self.middle_px - 0.5 * self.size.as_dvec2();
        Self {
            size,
            middle_px: 0.5 * size.as_dvec2() + scale * from_middle,
            px_per_unit: scale * self.px_per_unit,
            ..*self
        }
    }

    /// Returns the size of the whole image.
    pub fn size(&self) -> PixelSize {
        self.size
    }

    /// Returns the number of pixels per unit of the plane.
    pub fn px_per_unit(&self) -> f64 {
        self.px_per_unit
    }

    /// Maps a pixel position (y down) to the plane.
    pub fn to_plane(&self, px: DVec2) -> DVec2 {
        let d = (px - self.middle_px) / self.px_per_unit;
        self.centre + DVec2::new(d.x, -d.y)
    }

    /// Returns the affine map from the plane to pixels, y down.
    pub fn affine(&self) -> DAffine2 {
        let scale = DVec2::new(self.px_per_unit, -self.px_per_unit);
        DAffine2::from_scale_angle_translation(scale, 0.0, self.to_px(DVec2::ZERO))
    }

    /// Maps a point of the plane to pixels, y down.
    pub fn to_px(&self, p: DVec2) -> DVec2 {
        let from_centre = (p - self.centre) * self.px_per_unit;
        self.middle_px + DVec2::new(from_centre.x, -from_centre.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> PlaneView {
        let bounds = Bounds {
            min: DVec2::new(-1.0, 0.0),
            max: DVec2::new(3.0, 2.0),
        };
        PlaneView::fit(bounds, PixelSize::new(400, 400).expect("a legal size"))
    }

    #[test]
    fn the_view_centres_and_flips_y_once() {
        let view = view();
        assert_eq!(view.px_per_unit(), 100.0);
        assert_eq!(view.to_px(DVec2::new(-1.0, 0.0)), DVec2::new(0.0, 300.0));
        assert_eq!(view.to_px(DVec2::new(3.0, 2.0)), DVec2::new(400.0, 100.0));
    }

    #[test]
    fn a_view_of_a_point_still_shows_it_in_the_middle() {
        let bounds = Bounds {
            min: DVec2::splat(5.0),
            max: DVec2::splat(5.0),
        };
        let view = PlaneView::fit(bounds, PixelSize::new(10, 20).expect("a legal size"));
        assert_eq!(view.to_px(DVec2::splat(5.0)), DVec2::new(5.0, 10.0));
    }
}
