//! Material of distance fields: both fields as textures, blended and cut at the threshold by the
//! fragment shader.
//!
//! Guaranteed: the shader evaluates the same blend as [`FieldPair`] (bilinear between samples, then
//! L) in single precision; the contour is anti-aliased at any zoom and under any warp; nothing is
//! drawn outside the mesh. Not guaranteed: the last digits. Contours agree with those of the CPU to
//! a fraction of a pixel.

use bevy::asset::RenderAssetUsages;
use bevy::image::ToExtents;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
    TextureDimension, TextureFormat,
};
use bevy::shader::{ShaderDefVal, ShaderRef};
use bevy::sprite_render::{AlphaMode2d, Material2d, Material2dKey};

use crate::content::{BlendSpace, FieldContent, FieldPair};
use crate::field::DistanceField;

use super::components::StageStyle;
use super::ink_material::{contrasting_colour, embedded, linear};

/// Colour of positive blended distances: orange. With violet it is distinguishable under all common
/// kinds of colour vision, on dark and light backgrounds.
const INSIDE: Srgba = Srgba::rgb(0.878, 0.51, 0.078);
/// Colour of negative blended distances: violet.
const OUTSIDE: Srgba = Srgba::rgb(0.502, 0.451, 0.675);

/// Number of lines of equal distance along the longer side of the grid (heuristic).
const ISO_LINES: f32 = 40.0;

/// Two distance fields, and how they are blended and drawn.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
#[bind_group_data(FieldKind)]
pub(super) struct FieldMaterial {
    #[uniform(0)]
    pub(super) look: FieldLook,
    // Filtering 32-bit floats is an optional feature of graphics cards, and 16 bits are not precise
    // enough; the shader interpolates itself.
    #[texture(1, sample_type = "float", filterable = false)]
    source: Handle<Image>,
    #[texture(2, sample_type = "float", filterable = false)]
    target: Handle<Image>,
    pub(super) kind: FieldKind,
    /// All fields of a sequence; each pair blends one with the next.
    nodes: Vec<Handle<Image>>,
}

/// Properties that select the shader variant of a field.
///
/// Not branches on uniforms, which change with t: some drivers compile a new shader for each change
/// (Mesa's lavapipe 22.3 also kept all of them, 26 MB per second of playback).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct FieldKind {
    is_log: bool,
    shows_fill: bool,
    shows_lines: bool,
    shows_signs: bool,
}

impl FieldKind {
    pub(super) fn new(fields: &FieldContent, style: &StageStyle) -> Self {
        let show = style.show;
        Self {
            is_log: matches!(fields.first_pair().blend().space, BlendSpace::Log),
            // Painted fields are filled by the paint layers below.
            shows_fill: show.fill && fields.painted().is_none(),
            shows_lines: show.iso_lines,
            shows_signs: show.signed_colours,
        }
    }

    /// Shader definitions of the variant.
    fn definitions(self) -> impl Iterator<Item = ShaderDefVal> {
        let all = [
            (self.is_log, "LOG_SPACE"),
            (self.shows_fill, "FILL"),
            (self.shows_lines, "LINES"),
            (self.shows_signs, "SIGNS"),
        ];
        let set = all.into_iter().filter(|(is_set, _)| *is_set);
        set.map(|(_, name)| name.into())
    }
}

impl From<&FieldMaterial> for FieldKind {
    fn from(material: &FieldMaterial) -> Self {
        material.kind
    }
}

/// Uniform of [`FieldMaterial`]; the same fields as in `field.wgsl`.
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
}

impl Material2d for FieldMaterial {
    fn fragment_shader() -> ShaderRef {
        ShaderRef::Path(embedded("field.wgsl"))
    }

    fn alpha_mode(&self) -> AlphaMode2d {
        AlphaMode2d::Blend
    }

    fn specialize(
        descriptor: &mut RenderPipelineDescriptor,
        _layout: &MeshVertexBufferLayoutRef,
        key: Material2dKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        if let Some(fragment) = &mut descriptor.fragment {
            fragment
                .shader_defs
                .extend(key.bind_group_data.definitions());
        }
        Ok(())
    }
}

impl FieldMaterial {
    /// Uploads the fields of a sequence of pairs.
    pub(super) fn new(pairs: &[FieldPair], images: &mut Assets<Image>) -> Self {
        let first = pairs.iter().take(1).map(FieldPair::source);
        let nodes = first.chain(pairs.iter().map(FieldPair::target));
        let nodes: Vec<_> = nodes.map(|field| images.add(texture_of(field))).collect();
        Self {
            look: FieldLook::default(), // set when it is drawn
            kind: FieldKind::default(),
            source: nodes[0].clone(),
            target: nodes[1].clone(),
            nodes,
        }
    }

    /// A placeholder of the most common variant (logarithmic scale, fill only), to compile its
    /// pipeline.
    pub(super) fn placeholder(images: &mut Assets<Image>) -> Self {
        let single_texel = texture(UVec2::ONE, &[1.0]);
        let node = images.add(single_texel);
        Self {
            look: FieldLook::default(),
            kind: FieldKind {
                is_log: true,
                shows_fill: true,
                ..default()
            },
            source: node.clone(),
            target: node,
            nodes: Vec::new(),
        }
    }

    /// Whether the material shows the pair with this index.
    pub(super) fn shows_pair(&self, pair: usize) -> bool {
        self.source == self.nodes[pair]
    }

    /// Shows the pair with this index.
    pub(super) fn show_pair(&mut self, pair: usize) {
        self.source.clone_from(&self.nodes[pair]);
        self.target.clone_from(&self.nodes[pair + 1]);
    }
}

impl FieldLook {
    /// Uniform of a pair at its own blend parameter `within`. Colours are those of the whole
    /// transition at `t`.
    pub(super) fn new(pair: &FieldPair, within: f64, t: f64, style: &StageStyle) -> Self {
        let blend = pair.blend();
        let grid = pair.grid();
        let style = &style.style;
        Self {
            fill: linear(style.fill_at(t)).to_vec4(),
            inside: LinearRgba::from(INSIDE).to_vec4(),
            outside: LinearRgba::from(OUTSIDE).to_vec4(),
            line: contrasting_colour(style.ground).to_vec4(),
            t: within as f32,
            epsilon: blend.epsilon as f32,
            level: blend.level() as f32,
            // In cells, like distances, whatever the units of the design.
            spacing: grid.width.max(grid.height) as f32 / ISO_LINES,
        }
    }
}

/// Texture of a field; row 0 is the lowest.
fn texture_of(field: &DistanceField) -> Image {
    let grid = field.grid();
    texture(UVec2::new(grid.width, grid.height), field.values())
}

/// A texture of 32-bit floats.
fn texture(size: UVec2, values: &[f32]) -> Image {
    Image::new(
        size.to_extents(),
        TextureDimension::D2,
        bytemuck::cast_slice(values).to_vec(),
        TextureFormat::R32Float,
        RenderAssetUsages::RENDER_WORLD,
    )
}
