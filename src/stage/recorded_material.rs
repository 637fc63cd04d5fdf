//! Material of faces and wireframes that the graphics card plays: the vertex shader evaluates the
//! recording, so no vertices are written while t moves.
//!
//! If no recording is uploaded, or t is outside [0, 1], the shader uses the vertices of the mesh.
//! Fragments are drawn by the shader of
//! [`InkMaterial`](super::ink_material::InkMaterial).

use bevy::mesh::{MeshVertexAttribute, MeshVertexBufferLayoutRef};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, Buffer, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
    VertexFormat,
};
use bevy::shader::ShaderRef;
use bevy::sprite_render::{AlphaMode2d, Material2d, Material2dKey};

use crate::recording::{IntervalWeights, MOST_COEFFICIENTS};

use super::ink_material::{InkKind, embedded_shader_path};

/// Vertex attribute with the index of the vertex in the placement. The shader's built-in vertex
/// index cannot be used, because meshes share buffers.
pub(super) const VERTEX_INDEX: MeshVertexAttribute = MeshVertexAttribute::new(
    "Vertex_Of_Placement",
    0x6d6f_7270_6801,
    VertexFormat::Uint32,
);

/// Number of four-component vectors that hold one weight for each row of polynomial coefficients. A
/// recorded interval has at most [`MOST_COEFFICIENTS`] such rows.
const WEIGHT_VECTORS: usize = MOST_COEFFICIENTS.div_ceil(4);

/// Material with one opaque colour for faces or their edges, and with the recorded interval that
/// the vertex shader evaluates.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
#[bind_group_data(InkKind)]
pub(super) struct RecordedMaterial {
    #[uniform(0)]
    pub(super) colour: LinearRgba,
    #[uniform(3)]
    pub(super) sum: RecordedSum,
    /// Recorded interval, as rows with one entry per vertex: the positions at the beginning of the
    /// interval, those at its end, then the coefficients of the polynomial by which the vertex
    /// deviates from the straight line between these two positions.
    #[storage(4, read_only, buffer, visibility(vertex))]
    pub(super) reel: Buffer,
    pub(super) kind: InkKind,
}

/// Numbers from which the shader computes the vertex positions at t: the number of rows of a
/// recorded interval, and the weights with which it sums them. The members are the same as in
/// `played.wgsl`.
#[derive(ShaderType, Clone, Debug, Default, PartialEq)]
pub(super) struct RecordedSum {
    /// Weights at t of the rows of polynomial coefficients, four per vector.
    weights: [Vec4; WEIGHT_VECTORS],
    /// Distance of t from the beginning of the interval and from its end, as fractions of the
    /// interval's length. They sum to 1.
    shares: Vec2,
    /// Number of rows of polynomial coefficients.
    coefficients: u32,
    /// Number of entries in a row; 0 makes the shader use the positions of the mesh instead.
    vertices: u32,
}

impl RecordedSum {
    pub(super) fn new(weights: &IntervalWeights, vertices: usize, coefficients: usize) -> Self {
        let mut rows = [Vec4::ZERO; WEIGHT_VECTORS];
        for (k, weight) in weights.coefficients.into_iter().enumerate() {
            rows[k / 4][k % 4] = weight;
        }
        Self {
            weights: rows,
            shares: weights.shares.into(),
            coefficients: coefficients as u32,
            vertices: vertices as u32,
        }
    }
}

impl From<&RecordedMaterial> for InkKind {
    fn from(material: &RecordedMaterial) -> Self {
        material.kind
    }
}

impl Material2d for RecordedMaterial {
    fn vertex_shader() -> ShaderRef {
        ShaderRef::Path(embedded_shader_path("played.wgsl"))
    }

    fn fragment_shader() -> ShaderRef {
        ShaderRef::Path(embedded_shader_path("ink.wgsl"))
    }

    fn alpha_mode(&self) -> AlphaMode2d {
        AlphaMode2d::Blend
    }

    fn specialize(
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: Material2dKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let mut attributes = vec![
            Mesh::ATTRIBUTE_POSITION.at_shader_location(0),
            VERTEX_INDEX.at_shader_location(1),
        ];
        if key.bind_group_data == InkKind::Wire {
            attributes.push(Mesh::ATTRIBUTE_UV_0.at_shader_location(2));
            descriptor.vertex.shader_defs.push("WIRE".into());
            if let Some(fragment) = &mut descriptor.fragment {
                fragment.shader_defs.push("WIRE".into());
            }
        }
        descriptor.vertex.buffers = vec![layout.0.get_layout(&attributes)?];
        Ok(())
    }
}
