//! A small transition for the tests of this module: a triangle that turns and
//! grows.

use crate::geometry::DVec2;
use crate::transition::{Rgb, Style, Transition};

use super::{Camera, PixelSize, View, framing};

/// Sees the transition at the given size.
pub(super) fn camera(width: u32, height: u32, ground: Option<Rgb>) -> Camera {
    let transition = Transition {
        a: vec![DVec2::ZERO, DVec2::X, DVec2::Y],
        b: vec![DVec2::ONE, 3.0 * DVec2::Y, DVec2::ZERO],
    };
    let size = PixelSize::new(width, height).expect("a legal size");
    let view = View::fit(framing(&transition, &[0.0, 0.5, 1.0]), size);
    Camera {
        transition,
        style: Style::default(),
        view,
        ground,
    }
}
