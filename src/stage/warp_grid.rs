//! Material of the grid that shows a warp: a square grid in the source, deformed by the warp. At
//! t = 0 the grid is straight, at t = 1 it shows the whole warp.
//!
//! Guaranteed: lines keep their width on the screen. Lines fade where the warp moves them to within
//! a few pixels of each other.

use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, ShaderType};
use bevy::shader::ShaderRef;
use bevy::sprite_render::{AlphaMode2d, Material2d};
use glam::DVec2;

use crate::content::Content;
use crate::transition::Frame;

use super::components::StageStyle;
use super::ink_material::{contrasting_colour, embedded_shader_path, relative_rectangle};

/// Number of squares along the longer side of the designs (heuristic).
const SQUARES: f64 = 20.0;

/// Material that draws grid lines over the faces of a placement.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug, Default)]
pub(super) struct GridMaterial {
    #[uniform(0)]
    pub(super) look: GridUniform,
}

/// Uniform of [`GridMaterial`], with the same members as in `grid.wgsl`.
#[derive(ShaderType, Clone, Debug, Default, PartialEq)]
pub(super) struct GridUniform {
    colour: LinearRgba,
    /// Colour around the lines, which keeps them readable on pictures.
    halo: LinearRgba,
    /// Rectangle outside which no lines are drawn, relative to the origin of the render part:
    /// minimum x and y, maximum x and y.
    window: Vec4,
    /// Side length of a grid square, in units of the plane.
    spacing: f32,
}

impl Material2d for GridMaterial {
    fn fragment_shader() -> ShaderRef {
        ShaderRef::Path(embedded_shader_path("grid.wgsl"))
    }

    fn alpha_mode(&self) -> AlphaMode2d {
        AlphaMode2d::Blend
    }
}

impl GridUniform {
    pub(super) fn new(frame: &Frame, origin: DVec2, StageStyle { style, .. }: &StageStyle) -> Self {
        let bounds = frame.transition().bounds();
        let ink = contrasting_colour(style.ground).with_alpha(0.7);
        let (colour, halo, window) = match frame.transition().content() {
            Content::Colours(pair) => {
                let window = pair.window(frame.t());
                // The picture below the lines may have any colour, so light lines need a dark halo.
                (LinearRgba::WHITE, LinearRgba::BLACK.with_alpha(0.4), window)
            }
            Content::Solid(_) | Content::Field(_) => {
                // Parts may leave the bounds of the designs while they move, so the grid is
                // larger than these bounds.
                let all = bounds.padded(bounds.diameter());
                (ink, LinearRgba::NONE, all)
            }
        };
        Self {
            colour,
            halo,
            window: relative_rectangle(window, origin),
            spacing: (bounds.size().max_element() / SQUARES) as f32,
        }
    }
}
