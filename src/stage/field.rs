//! Field mode on the GPU: both distance fields as textures, blended and cut by
//! the fragment shader.
//!
//! Guarantees: the shader evaluates the core's blend (bilinear between
//! samples, L afterwards) in single precision; the contour is anti-aliased at
//! any zoom, whatever a warp does; outside its mesh nothing is drawn. Does not guarantee the core's
//! last digits: contours agree to a fraction of a pixel.

use bevy::asset::RenderAssetUsages;
use bevy::image::ToExtents;
use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, ShaderType, TextureDimension, TextureFormat};
use bevy::shader::ShaderRef;
use bevy::sprite_render::{AlphaMode2d, Material2d};

use crate::content::{BlendSpace, FieldPair};
use crate::field::DistanceField;

use super::components::StageStyle;
use super::ink::{contrasting, embedded, linear};

/// Hue of positive and of negative blended distance: orange and violet are told
/// apart by every common kind of colour vision, on dark and on light grounds.
const INSIDE: Srgba = Srgba::rgb(0.878, 0.51, 0.078);
const OUTSIDE: Srgba = Srgba::rgb(0.502, 0.451, 0.675);

/// Lines of equal distance over the longer side of the grid: a matter of looks.
const ISO_LINES: f32 = 40.0;

/// Two fields and how they are blended and drawn.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
pub(super) struct FieldMaterial {
    #[uniform(0)]
    pub(super) look: FieldLook,
    // To filter 32-bit floats is an optional feature of graphics cards, and
    // half the digits are too few: the shader filters by hand.
    #[texture(1, sample_type = "float", filterable = false)]
    source: Handle<Image>,
    #[texture(2, sample_type = "float", filterable = false)]
    target: Handle<Image>,
}

/// The uniform of [`FieldMaterial`]; the same fields as in `field.wgsl`.
#[derive(ShaderType, Clone, Debug, Default, PartialEq)]
pub(super) struct FieldLook {
    fill: Vec4,
    inside: Vec4,
    outside: Vec4,
    line: Vec4,
    t: f32,
    epsilon: f32,
    level: f32,
    spacing: f32,
    // WGSL has no layout for `bool` in a uniform.
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
    pub(super) fn new(pair: &FieldPair, images: &mut Assets<Image>) -> Self {
        Self {
            look: FieldLook::default(), // until it is drawn
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
            // Distances are in cells of the grid, whatever units the design
            // has.
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
    Image::new(
        UVec2::new(grid.width, grid.height).to_extents(),
        TextureDimension::D2,
        bytemuck::cast_slice(field.values()).to_vec(),
        TextureFormat::R32Float,
        RenderAssetUsages::RENDER_WORLD,
    )
}
