//! Material of shapes in one colour (faces, bars, joints, wireframes and outlines), and of faces in
//! several paint layers.
//!
//! Guaranteed: edges are smooth at any zoom. Lines keep their width on the screen and grow with the
//! height of the picture, so that a capture in 4K looks like the window. Faces are visible from
//! both sides.

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
    /// Bars and discs: a fragment is inside if its texture coordinates have length below 1.
    Round,
    /// Edges of triangles that share no vertices.
    Wire,
    /// Segments that the vertex shader widens to lines.
    Line,
}

/// One opaque colour, or the colours of the vertices.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
#[bind_group_data(InkKind)]
pub(super) struct InkMaterial {
    #[uniform(0)]
    pub(super) colour: LinearRgba,
    /// Gradients of paint layers.
    #[uniform(1)]
    pub(super) gradients: GradientUniform,
    pub(super) kind: InkKind,
}

/// Selects the shader variant.
impl From<&InkMaterial> for InkKind {
    fn from(material: &InkMaterial) -> Self {
        material.kind
    }
}

impl Material2d for InkMaterial {
    fn fragment_shader() -> ShaderRef {
        ShaderRef::Path(embedded("ink.wgsl"))
    }

    fn alpha_mode(&self) -> AlphaMode2d {
        // The colour is opaque, but the smooth edges are not.
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
            // Only lines have a vertex shader of their own, in the same file.
            descriptor.vertex.shader = fragment.shader.clone();
            descriptor.vertex.shader_defs.push(definition.into());
        }
        Ok(())
    }
}

/// Asset path of a shader embedded in the binary, from the folder of this file.
pub(super) fn embedded(name: &'static str) -> bevy::asset::AssetPath<'static> {
    let path = embedded_path!("ink.wgsl").with_file_name(name);
    bevy::asset::AssetPath::from_path_buf(path).with_source("embedded")
}

/// Packs a rectangle for shaders: minimum x and y, maximum x and y, relative to an origin.
pub(super) fn relative_rectangle(window: Bounds, origin: glam::DVec2) -> Vec4 {
    let [low, high] = [window.min, window.max].map(|p| (p - origin).as_vec2());
    Vec4::new(low.x, low.y, high.x, high.y)
}

/// Converts an opaque sRGB colour to linear light.
pub(super) fn linear(colour: Rgb) -> LinearRgba {
    let [red, green, blue] = colour.to_linear();
    LinearRgba::rgb(red, green, blue)
}

/// Returns a readable colour on a background: near black on light ones, near white on dark ones.
pub(super) fn contrasting_colour(ground: Rgb) -> LinearRgba {
    // Close to 0.18, the luminance on which black and white have equal contrast (WCAG 2: √(1.05 ·
    // 0.05) − 0.05).
    if linear(ground).luminance() > 0.2 {
        linear(Rgb([28, 32, 38]))
    } else {
        linear(Rgb([236, 238, 240]))
    }
}
