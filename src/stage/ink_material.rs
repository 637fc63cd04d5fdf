//! The material of everything that has one colour: faces, bars, joints, wires
//! and outlines; and of faces in coats of paint.
//!
//! Guarantees: edges are smooth at any zoom; lines keep their width on the
//! screen and grow with the height of the picture, so that a capture in 4K
//! looks like the window; no face is culled, whichever way it is turned.

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

use super::gradients::GradientTextures;

/// What kind of shape the vertices describe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum InkKind {
    /// The triangles themselves.
    Faces,
    /// The same, each vertex in a colour of its own.
    Coats,
    /// Bars and discs: inside is where the texture coordinates' length is below 1.
    Round,
    /// The edges of triangles that share no vertices.
    Wire,
    /// Segments that the vertex shader widens.
    Line,
}

/// One opaque colour, unless the vertices bring theirs.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
#[bind_group_data(InkKind)]
pub(super) struct InkMaterial {
    #[uniform(0)]
    pub(super) colour: LinearRgba,
    /// Those of coats.
    #[uniform(1)]
    pub(super) gradients: GradientTextures,
    pub(super) kind: InkKind,
}

/// What the pipeline of a material depends on.
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
        // The colour is opaque, the smooth edges are not.
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
            InkKind::Coats => "COATS",
            InkKind::Round => "ROUND",
            InkKind::Wire => "WIRE",
            InkKind::Line => "LINE",
        };
        fragment.shader_defs.push(definition.into());
        if key.bind_group_data == InkKind::Line {
            // Only lines are widened by a vertex shader of their own, in the
            // same file.
            descriptor.vertex.shader = fragment.shader.clone();
            descriptor.vertex.shader_defs.push(definition.into());
        }
        Ok(())
    }
}

/// The path of a shader that lies beside this file and in the binary.
pub(super) fn embedded(name: &'static str) -> bevy::asset::AssetPath<'static> {
    let beside = embedded_path!("ink.wgsl").with_file_name(name);
    bevy::asset::AssetPath::from_path_buf(beside).with_source("embedded")
}

/// A window as shaders are told it: least and most x and y, from an origin.
pub(super) fn relative(window: Bounds, origin: glam::DVec2) -> Vec4 {
    let [low, high] = [window.min, window.max].map(|p| (p - origin).as_vec2());
    Vec4::new(low.x, low.y, high.x, high.y)
}

/// An opaque sRGB colour in linear light.
pub(super) fn linear(colour: Rgb) -> LinearRgba {
    let [red, green, blue] = colour.to_linear();
    LinearRgba::rgb(red, green, blue)
}

/// What reads well on a ground: near black on light ones, near white on dark.
pub(super) fn contrasting(ground: Rgb) -> LinearRgba {
    // Near 0.18, where black and white stand out alike (WCAG 2: √(1.05 · 0.05)
    // − 0.05).
    if linear(ground).luminance() > 0.2 {
        linear(Rgb([28, 32, 38]))
    } else {
        linear(Rgb([236, 238, 240]))
    }
}
