//! Material that draws blends of distance fields: both fields are textures, and the fragment shader
//! blends them and fills the region above the threshold.
//!
//! Guaranteed: the shader evaluates the same blend as [`FieldPair`] in single precision (bilinear
//! interpolation between samples, then the scale given by [`BlendSpace`]); the contour is
//! anti-aliased at any zoom and under any warp; nothing is drawn outside the mesh. Not guaranteed:
//! the last digits. Contours agree with those of the CPU to a fraction of a pixel.

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
use super::ink_material::{contrasting_colour, embedded_shader_path, linear_rgba_from_rgb};

/// Colour of positive blended distances: orange. It is distinguishable from [`OUTSIDE`] under all
/// common kinds of colour vision, on dark and light backgrounds.
const INSIDE: Srgba = Srgba::rgb(0.878, 0.51, 0.078);
/// Colour of negative blended distances: violet.
const OUTSIDE: Srgba = Srgba::rgb(0.502, 0.451, 0.675);

/// Divisor for the spacing of the lines of equal distance: the distances of neighbouring lines
/// differ by the length of the grid's longer side, in cells, divided by this number (heuristic).
const ISO_LINES: f32 = 40.0;

/// Material with two distance fields, and with the way in which they are blended and drawn.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
#[bind_group_data(FieldKind)]
pub(super) struct FieldMaterial {
    #[uniform(0)]
    pub(super) look: FieldUniform,
    // The shader interpolates the samples itself: not all graphics cards can filter 32-bit floats,
    // and 16 bits are not precise enough.
    #[texture(1, sample_type = "float", filterable = false)]
    source: Handle<Image>,
    #[texture(2, sample_type = "float", filterable = false)]
    target: Handle<Image>,
    pub(super) kind: FieldKind,
    /// Textures of all fields of a sequence; pair `k` blends texture `k` with texture `k + 1`.
    nodes: Vec<Handle<Image>>,
}

/// Properties of a field blend and its style that together select the shader variant.
///
/// The shader does not branch on uniforms instead, because some drivers compile a new shader
/// whenever a uniform changes, and t changes in each frame. Mesa's lavapipe 22.3 also stored all
/// these shaders in memory, 26 MB per second of playback.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct FieldKind {
    is_log: bool,
    shows_fill: bool,
    shows_lines: bool,
    shows_signs: bool,
}

impl FieldKind {
    pub(super) fn new(fields: &FieldContent, style: &StageStyle) -> Self {
        let show = style.visibility;
        Self {
            is_log: matches!(fields.first_pair().blend().space, BlendSpace::Log),
            // Fields with paints are filled by a separate render part with paint layers.
            shows_fill: show.fill && fields.painted_fields().is_none(),
            shows_lines: show.iso_lines,
            shows_signs: show.signed_colours,
        }
    }

    /// Returns the shader definitions that select the variant.
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

/// Uniform of [`FieldMaterial`], with the same members as in `field.wgsl`.
#[derive(ShaderType, Clone, Debug, Default, PartialEq)]
pub(super) struct FieldUniform {
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
        ShaderRef::Path(embedded_shader_path("field.wgsl"))
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
    /// Creates the textures of all fields of a sequence of pairs; shows the first pair.
    pub(super) fn new(pairs: &[FieldPair], images: &mut Assets<Image>) -> Self {
        let first = pairs.iter().take(1).map(FieldPair::source);
        let nodes = first.chain(pairs.iter().map(FieldPair::target));
        let nodes: Vec<_> = nodes.map(|field| images.add(texture_of(field))).collect();
        Self {
            look: FieldUniform::default(), // set when it is drawn
            kind: FieldKind::default(),
            source: nodes[0].clone(),
            target: nodes[1].clone(),
            nodes,
        }
    }

    /// Returns a material that shows nothing, in the most common shader variant (logarithmic scale,
    /// fill only), so that the pipeline of this variant is compiled.
    pub(super) fn placeholder(images: &mut Assets<Image>) -> Self {
        let single_texel = texture(UVec2::ONE, &[1.0]);
        let node = images.add(single_texel);
        Self {
            look: FieldUniform::default(),
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

    /// Whether the material shows the pair of fields with the index `pair`.
    pub(super) fn shows_pair(&self, pair: usize) -> bool {
        self.source == self.nodes[pair]
    }

    /// Shows the pair of fields with the index `pair`.
    pub(super) fn show_pair(&mut self, pair: usize) {
        self.source.clone_from(&self.nodes[pair]);
        self.target.clone_from(&self.nodes[pair + 1]);
    }
}

impl FieldUniform {
    /// Creates the shader parameters for one pair of fields of a transition.
    ///
    /// `t` is the blend parameter of the whole transition and determines the fill colour. `within`
    /// is the blend parameter between the two fields of the pair. Values outside [0, 1]
    /// extrapolate.
    pub(super) fn new(pair: &FieldPair, within: f64, t: f64, style: &StageStyle) -> Self {
        let blend = pair.blend();
        let grid = pair.grid();
        let style = &style.style;
        Self {
            fill: linear_rgba_from_rgb(style.fill_at(t)).to_vec4(),
            inside: LinearRgba::from(INSIDE).to_vec4(),
            outside: LinearRgba::from(OUTSIDE).to_vec4(),
            line: contrasting_colour(style.ground).to_vec4(),
            t: within as f32,
            epsilon: blend.epsilon as f32,
            level: blend.level() as f32,
            // The spacing of the lines is in cells, because the distances of a field are in cells.
            spacing: grid.width.max(grid.height) as f32 / ISO_LINES,
        }
    }
}

/// Texture of a distance field; row 0 is the lowest.
fn texture_of(field: &DistanceField) -> Image {
    let grid = field.grid();
    texture(UVec2::new(grid.width, grid.height), field.values())
}

/// Creates a texture of the given size with one 32-bit float per texel.
fn texture(size: UVec2, values: &[f32]) -> Image {
    Image::new(
        size.to_extents(),
        TextureDimension::D2,
        bytemuck::cast_slice(values).to_vec(),
        TextureFormat::R32Float,
        RenderAssetUsages::RENDER_WORLD,
    )
}
