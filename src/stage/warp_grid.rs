//! The grid that shows a warp: a square grid of the source, where the warp
//! carries it. Straight at t = 0, at t = 1 it shows the whole warp.
//!
//! Guarantees: lines keep their width on the screen. Does not guarantee lines
//! where the warp squeezes them nearer than a few pixels: they fade.

use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, ShaderType};
use bevy::shader::ShaderRef;
use bevy::sprite_render::{AlphaMode2d, Material2d};
use glam::DVec2;

use crate::content::Content;
use crate::transition::Frame;

use super::components::StageStyle;
use super::ink_material::{contrasting, embedded, relative};

/// Squares along the longer side of what is shown: a matter of looks.
const SQUARES: f64 = 20.0;

/// Lines over the vertices of a placement.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug, Default)]
pub(super) struct GridMaterial {
    #[uniform(0)]
    pub(super) look: GridLook,
}

/// The uniform of [`GridMaterial`]; the same fields as in `grid.wgsl`.
#[derive(ShaderType, Clone, Debug, Default, PartialEq)]
pub(super) struct GridLook {
    colour: LinearRgba,
    /// Around the lines, for pictures of any colour.
    halo: LinearRgba,
    /// Least and most x and y of what is shown, relative to the part's origin.
    window: Vec4,
    /// Side of a square, in units of the plane.
    spacing: f32,
}

impl Material2d for GridMaterial {
    fn fragment_shader() -> ShaderRef {
        ShaderRef::Path(embedded("grid.wgsl"))
    }

    fn alpha_mode(&self) -> AlphaMode2d {
        AlphaMode2d::Blend
    }
}

impl GridLook {
    pub(super) fn new(frame: &Frame, origin: DVec2, StageStyle { style, .. }: &StageStyle) -> Self {
        let bounds = frame.transition().bounds();
        let ink = contrasting(style.ground).with_alpha(0.7);
        let (colour, halo, window) = match frame.transition().content() {
            Content::Colours(pair) => {
                let window = pair.window(frame.t());
                // A picture may have any colour below the lines, so both are
                // needed.
                (LinearRgba::WHITE, LinearRgba::BLACK.with_alpha(0.4), window)
            }
            Content::Solid(_) | Content::Field(_) => {
                // Parts may reach beyond the frame on their way.
                let all = bounds.padded(bounds.diameter());
                (ink, LinearRgba::NONE, all)
            }
        };
        Self {
            colour,
            halo,
            window: relative(window, origin),
            spacing: (bounds.size().max_element() / SQUARES) as f32,
        }
    }
}
