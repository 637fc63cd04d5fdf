//! Material that draws shapes in one colour (faces, bars, joints, wireframes and outlines), and
//! faces in several paint layers.
//!
//! Guaranteed: edges are smooth at any zoom. The width of lines does not depend on the zoom; it is
//! proportional to the height of the image, so that a capture in 4K looks like the window. Faces
//! are visible from both sides.

use bevy::asset::embedded_path;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError,
};
use bevy::shader::ShaderRef;
use bevy::sprite_render::{AlphaMode2d, Material2d, Material2dKey};

use crate::colour::Rgb;
use crate::geometry::Bounds;

use super::gradients::GradientUniform;

/// Kind of shape that the vertices describe. Each kind is a shader variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum InkKind {
    /// Triangles in one colour.
    Faces,
    /// Triangles in paint layers: each vertex has its own colour or gradient.
    PaintLayers,
    /// Bars and discs. A fragment lies inside the shape if its texture coordinates, read as a
    /// vector, are shorter than 1.
    Round,
    /// Edges of triangles; the triangles share no vertices.
    Wire,
    /// Line segments that the vertex shader widens.
    Line,
}

/// Material with one opaque colour, or with a colour or gradient per vertex.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
#[bind_group_data(InkKind)]
pub(super) struct InkMaterial {
    #[uniform(0)]
    pub(super) colour: LinearRgba,
    /// Gradients of paint layers, to which vertex colours refer.
    #[uniform(1)]
    pub(super) gradients: GradientUniform,
    pub(super) kind: InkKind,
}

/// The kind of shape selects the shader variant.
impl From<&InkMaterial> for InkKind {
    fn from(material: &InkMaterial) -> Self {
        material.kind
    }
}

impl Material2d for InkMaterial {
    fn fragment_shader() -> ShaderRef {
        ShaderRef::Path(embedded_shader_path("ink.wgsl"))
    }

    fn alpha_mode(&self) -> AlphaMode2d {
        // The colour is opaque, but the anti-aliased edges are not.
        AlphaMode2d::Blend
    }

    fn specialize(
        descriptor: &mut RenderPipelineDescriptor,
        _layout: &MeshVertexBufferLayoutRef,
        key: Material2dKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let Some(fragment) = &mut descriptor.fragment else {
            return Ok(());
        };
        let definition = match key.bind_group_data {
            InkKind::Faces => return Ok(()),
            InkKind::PaintLayers => "COATS",
            InkKind::Round => "ROUND",
            InkKind::Wire => "WIRE",
            InkKind::Line => "LINE",
        };
        fragment.shader_defs.push(definition.into());
        if key.bind_group_data == InkKind::Line {
            // Lines have their own vertex shader, which is in the same file as the fragment shader.
            descriptor.vertex.shader = fragment.shader.clone();
            descriptor.vertex.shader_defs.push(definition.into());
        }
        Ok(())
    }
}

/// Returns the asset path of a shader file that is embedded in the program. The file is in the
/// folder of this source file.
pub(super) fn embedded_shader_path(name: &'static str) -> bevy::asset::AssetPath<'static> {
    let path = embedded_path!("ink.wgsl").with_file_name(name);
    bevy::asset::AssetPath::from_path_buf(path).with_source("embedded")
}

/// Packs a rectangle for shaders: minimum x and y, maximum x and y, relative to `origin`.
pub(super) fn relative_rectangle(window: Bounds, origin: glam::DVec2) -> Vec4 {
    let [low, high] = [window.min, window.max].map(|p| (p - origin).as_vec2());
    Vec4::new(low.x, low.y, high.x, high.y)
}

/// Converts an opaque sRGB colour to linear light.
pub(super) fn linear_rgba_from_rgb(colour: Rgb) -> LinearRgba {
    let [red, green, blue] = colour.to_linear();
    LinearRgba::rgb(red, green, blue)
}

/// Returns a colour that is readable on a background: near black on light backgrounds, near white
/// on dark ones.
pub(super) fn contrasting_colour(ground: Rgb) -> LinearRgba {
    // The threshold is close to 0.18, the luminance of a background on which black and white have
    // equal contrast (WCAG 2: √(1.05 · 0.05) − 0.05).
    if linear_rgba_from_rgb(ground).luminance() > 0.2 {
        linear_rgba_from_rgb(Rgb([28, 32, 38]))
    } else {
        linear_rgba_from_rgb(Rgb([236, 238, 240]))
    }
}
