//! The area of the window that shows the stage, and whether the view stays fitted to it.

use bevy::prelude::{Resource, UVec2, Vec2};

/// Size of the window when it opens, in logical pixels.
pub const INITIAL_SIZE: UVec2 = UVec2::new(1280, 720);

/// Area of the window that the panels leave free for the stage, in logical pixels.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct StageArea {
    /// Top left corner, relative to that of the window, y down.
    pub corner: Vec2,
    /// Width and height.
    pub size: Vec2,
}

impl Default for StageArea {
    fn default() -> Self {
        Self {
            corner: Vec2::ZERO,
            size: INITIAL_SIZE.as_vec2(),
        }
    }
}

/// Whether the view shows the whole transition and stays fitted to it when the stage's area
/// changes.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct AutoFit(pub bool);

impl Default for AutoFit {
    fn default() -> Self {
        Self(true)
    }
}
