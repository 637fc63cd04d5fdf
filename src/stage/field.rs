//! Field mode on the GPU: both distance fields as textures, blended and cut by
//! the fragment shader.
//!
//! Guarantees: the shader evaluates the core's blend (bilinear between
//! samples, L afterwards) in single precision; the contour is anti-aliased at
//! any zoom; outside the grid nothing is drawn. Does not guarantee the core's
//! last digits: contours agree to a fraction of a pixel.

use bevy::asset::RenderAssetUsages;
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, Extent3d, ShaderType, TextureDimension, TextureFormat,
};
use bevy::shader::ShaderRef;
use bevy::sprite_render::{AlphaMode2d, Material2d};
use glam::DVec2;

use crate::content::{BlendSpace, FieldPair};
use crate::field::{DistanceField, Grid};

use super::components::StageStyle;
use super::ink::{contrasting, embedded, linear};

/// Hue of positive and of negative blended distance: orange and violet are told
/// apart by every common kind of colour vision, on dark and on light grounds.
const INSIDE: Srgba = Srgba::rgb(0.878, 0.51, 0.078);
const OUTSIDE: Srgba = Srgba::rgb(0.502, 0.451, 0.675);

/// Lines of equal distance over the longer side of the grid.
const ISO_LINES: f32 = 40.0;

/// Two fields and how they are blended and drawn.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
pub(super) struct FieldMaterial {
    #[uniform(0)]
    pub(super) look: FieldLook,
    #[texture(1, sample_type = "float", filterable = false)]
    source: Handle<Image>,
    #[texture(2, sample_type = "float", filterable = false)]
    target: Handle<Image>,
}

/// The uniform of [`FieldMaterial`]; the same fields as in `field.wgsl`.
#[derive(ShaderType, Clone, Debug, PartialEq)]
pub(super) struct FieldLook {
    fill: Vec4,
    inside: Vec4,
    outside: Vec4,
    line: Vec4,
    t: f32,
    epsilon: f32,
    level: f32,
    spacing: f32,
    log_space: u32,
    fill_shown: u32,
    lines_shown: u32,
    signed_shown: u32,
}

impl Material2d for FieldMaterial {
    fn fragment_shader() -> ShaderRef {
        ShaderRef::Path(embedded("field.wgsl"))
    }

    fn alpha_mode(&self) -> AlphaMode2d {
        AlphaMode2d::Blend
    }
}

impl FieldMaterial {
    pub(super) fn new(pair: &FieldPair, look: FieldLook, images: &mut Assets<Image>) -> Self {
        Self {
            look,
            source: images.add(texture(pair.source())),
            target: images.add(texture(pair.target())),
        }
    }
}

impl FieldLook {
    pub(super) fn new(pair: &FieldPair, t: f64, style: &StageStyle) -> Self {
        let blend = pair.blend();
        let grid = pair.grid();
        let StageStyle { style, show } = style;
        Self {
            fill: linear(style.fill_at(t)).to_vec4(),
            inside: LinearRgba::from(INSIDE).to_vec4(),
            outside: LinearRgba::from(OUTSIDE).to_vec4(),
            line: contrasting(style.ground).to_vec4(),
            t: t as f32,
            epsilon: blend.epsilon as f32,
            level: blend.level() as f32,
            spacing: grid.width.max(grid.height) as f32 / ISO_LINES,
            log_space: u32::from(matches!(blend.space, BlendSpace::Log)),
            fill_shown: u32::from(show.fill),
            lines_shown: u32::from(show.iso_lines),
            signed_shown: u32::from(show.signed_colours),
        }
    }
}

/// A field as a texture of 32-bit floats, row 0 the lowest.
fn texture(field: &DistanceField) -> Image {
    let grid = field.grid();
    let size = Extent3d {
        width: grid.width,
        height: grid.height,
        depth_or_array_layers: 1,
    };
    let bytes = bytemuck::cast_slice(field.values()).to_vec();
    Image::new(
        size,
        TextureDimension::D2,
        bytes,
        TextureFormat::R32Float,
        RenderAssetUsages::RENDER_WORLD,
    )
}

/// The corners of the grid relative to an origin, lower left first and counted
/// along x, and where they are in samples.
pub(super) fn quad(grid: &Grid, origin: DVec2) -> ([[f32; 3]; 4], [[f32; 2]; 4]) {
    let samples = DVec2::new(f64::from(grid.width), f64::from(grid.height));
    let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE].map(|c| c * samples);
    let positions = corners.map(|c| {
        let p = (grid.origin - origin + c * grid.cell).as_vec2();
        [p.x, p.y, 0.0]
    });
    let in_samples = corners.map(|c| (c - 0.5).as_vec2().to_array());
    (positions, in_samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sample_centres_have_whole_coordinates() {
        let grid = Grid {
            width: 4,
            height: 2,
            origin: DVec2::new(10.0, 20.0),
            cell: 0.5,
        };
        let (positions, in_samples) = quad(&grid, grid.origin);
        assert_eq!(positions[3], [2.0, 1.0, 0.0]);
        assert_eq!(in_samples[0], [-0.5, -0.5]);
        assert_eq!(in_samples[3], [3.5, 1.5]);
    }
}
