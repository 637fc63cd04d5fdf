//! Makes Bevy compile render pipelines in advance: spawns a triangle without area in each material
//! and vertex layout that render parts use.
//!
//! Guaranteed: no render part is missing from the first frame of a transition. Without warm-up, a
//! render part would be missing until its pipeline is compiled, and the stage would flicker
//! whenever a transition of a new kind replaces another. Not guaranteed: pictures, and distance
//! fields that are blended on the linear scale or shown with lines or signed colours; the stage
//! flickers when one of these is first shown.

use bevy::camera::visibility::NoFrustumCulling;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::sprite_render::Material2d;

use super::field_material::FieldMaterial;
use super::gradients::GradientUniform;
use super::ink_material::{InkKind, InkMaterial};
use super::paint::StagePaints;
use super::pipelines::PipelinesReady;
use super::recorded_material::{RecordedMaterial, RecordedSum, VERTEX_INDEX};
use super::recording_upload::RecordingGpu;
use super::ring_fill;
use super::warp_grid::GridMaterial;

/// A kind of shape ([`InkKind`]), which selects the shader variant, and the vertex layout of its
/// render mesh. The layout is a function that takes a mesh with positions only and adds the other
/// vertex attributes that render meshes of this kind have, such as colours.
type WarmUpVertexLayout = (InkKind, fn(Mesh) -> Mesh);

/// Mesh of a triangle without area, which shows nothing.
fn nothing() -> Mesh {
    let (positions, indices) = ring_fill::degenerate_triangle();
    Mesh::new(PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_indices(Indices::U32(indices))
}

/// Adds texture coordinates to the mesh.
fn with_coordinates(mesh: Mesh) -> Mesh {
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0_f32; 2]; 3])
}

/// Adds vertex colours to the mesh.
fn with_colours(mesh: Mesh) -> Mesh {
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[0.0_f32; 4]; 3])
}

/// Adds to the mesh the attribute in which lines store the offsets of their corners.
fn with_offsets(mesh: Mesh) -> Mesh {
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0_f32; 3]; 3])
}

/// Adds to the mesh the vertex indices with which the shader reads recordings.
fn with_numbers(mesh: Mesh) -> Mesh {
    mesh.with_inserted_attribute(VERTEX_INDEX, vec![0_u32; 3])
}

/// Spawns an invisible triangle for each pipeline. The triangles are not despawned: they cost
/// nothing to draw, and Bevy also compiles the pipelines for cameras that are added later.
pub(super) fn warm_up_pipelines(
    mut commands: Commands,
    mut paints: StagePaints,
    gpu: Option<Res<RecordingGpu>>,
    ready: Option<Res<PipelinesReady>>,
) {
    if ready.is_none() {
        // The program has no renderer.
        return;
    }
    let inks: [WarmUpVertexLayout; 5] = [
        (InkKind::Faces, |mesh| mesh),
        (InkKind::PaintLayers, |mesh| {
            with_colours(with_coordinates(mesh))
        }),
        (InkKind::Round, with_coordinates),
        (InkKind::Wire, with_coordinates),
        (InkKind::Line, with_offsets),
    ];
    for (kind, layout) in inks {
        let ink = paints.inks.add(InkMaterial {
            colour: LinearRgba::NONE,
            gradients: GradientUniform::default(),
            kind,
        });
        commands.spawn(drawn_mesh(paints.meshes.add(layout(nothing())), ink));
    }
    let played: [WarmUpVertexLayout; 2] = [
        (InkKind::Faces, with_numbers),
        (InkKind::Wire, |mesh| with_numbers(with_coordinates(mesh))),
    ];
    for (gpu, (kind, layout)) in gpu.iter().flat_map(|gpu| played.map(|kind| (gpu, kind))) {
        let material = paints.played.add(RecordedMaterial {
            colour: LinearRgba::NONE,
            sum: RecordedSum::default(),
            reel: gpu.placeholder().clone(),
            kind,
        });
        commands.spawn(drawn_mesh(paints.meshes.add(layout(nothing())), material));
    }
    let carried = paints.meshes.add(with_colours(with_coordinates(nothing())));
    let grid = paints.grids.add(GridMaterial::default());
    commands.spawn(drawn_mesh(carried.clone(), grid));
    let field = FieldMaterial::placeholder(&mut paints.images);
    commands.spawn(drawn_mesh(carried, paints.fields.add(field)));
}

/// Components of an entity that draws a mesh with a material and is never culled.
fn drawn_mesh<M: Material2d>(mesh: Handle<Mesh>, material: Handle<M>) -> impl Bundle {
    (Mesh2d(mesh), MeshMaterial2d(material), NoFrustumCulling)
}
