//! The material of faces and wires that can be played from the graphics card: the vertex
//! shader sums the film, and no vertex is written while t moves.
//!
//! As long as there is no film, and outside of it, the vertices are those of the mesh,
//! as of everything else: so a film that is there at last changes nothing but who sums.
//! What is drawn is drawn by the shader of [`InkMaterial`](super::ink::InkMaterial).

use bevy::mesh::{MeshVertexAttribute, MeshVertexBufferLayoutRef};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, Buffer, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
    VertexFormat,
};
use bevy::shader::ShaderRef;
use bevy::sprite_render::{AlphaMode2d, Material2d, Material2dKey};

use crate::recording::{IntervalWeights, MOST_COEFFICIENTS};

use super::ink_material::{InkKind, embedded};

/// Which vertex of the placement a vertex of the mesh is: meshes lie together in buffers,
/// so that the number that a shader is told says nothing.
pub(super) const VERTEX: MeshVertexAttribute = MeshVertexAttribute::new(
    "Vertex_Of_Placement",
    0x6d6f_7270_6801,
    VertexFormat::Uint32,
);

/// Rows of four that hold as many weights as there are at most.
const ROWS: usize = MOST_COEFFICIENTS.div_ceil(4);

/// One opaque colour, on faces or their edges.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
#[bind_group_data(InkKind)]
pub(super) struct PlayedMaterial {
    #[uniform(0)]
    pub(super) colour: LinearRgba,
    #[uniform(3)]
    pub(super) sum: RecordedSum,
    /// Row after row.
    #[storage(4, read_only, buffer, visibility(vertex))]
    pub(super) reel: Buffer,
    pub(super) kind: InkKind,
}

/// How the rows of a reel are summed; the same fields as in `played.wgsl`.
#[derive(ShaderType, Clone, Debug, Default, PartialEq)]
pub(super) struct RecordedSum {
    weights: [Vec4; ROWS],
    shares: Vec2,
    coefficients: u32,
    /// In a row; none where the mesh has them.
    vertices: u32,
}

impl RecordedSum {
    pub(super) fn new(weights: &IntervalWeights, vertices: usize, coefficients: usize) -> Self {
        let mut rows = [Vec4::ZERO; ROWS];
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

impl From<&PlayedMaterial> for InkKind {
    fn from(material: &PlayedMaterial) -> Self {
        material.kind
    }
}

impl Material2d for PlayedMaterial {
    fn vertex_shader() -> ShaderRef {
        ShaderRef::Path(embedded("played.wgsl"))
    }

    fn fragment_shader() -> ShaderRef {
        ShaderRef::Path(embedded("ink.wgsl"))
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
            VERTEX.at_shader_location(1),
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
