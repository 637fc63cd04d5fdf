//! What has the graphics card ready before it is asked: a triangle of no area in each
//! material and each layout of vertices that parts have.
//!
//! Guarantees: the first frame of a transition shows it. Without this a part whose
//! pipeline was not there yet was left out until it had been compiled, so that the
//! stage blinked wherever one film took the place of another of a new kind. Does not
//! guarantee fields with lines or signs, and pictures: these blink once.

use bevy::camera::visibility::NoFrustumCulling;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::sprite_render::Material2d;

use super::field_material::FieldMaterial;
use super::gradients::GradientTextures;
use super::ink_material::{InkKind, InkMaterial};
use super::paint::StagePaints;
use super::pipelines::PipelinesReady;
use super::recorded_material::{PlayedMaterial, RecordedSum, VERTEX};
use super::recording_upload::CardRecording;
use super::ring_fill;
use super::warp_grid::GridMaterial;

/// A kind of shape, and what its vertices bring beside where they are.
type WarmUpVertexLayout = (InkKind, fn(Mesh) -> Mesh);

/// A triangle of no area.
fn nothing() -> Mesh {
    let (positions, indices) = ring_fill::nothing();
    Mesh::new(PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_indices(Indices::U32(indices))
}

fn with_coordinates(mesh: Mesh) -> Mesh {
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0_f32; 2]; 3])
}

fn with_colours(mesh: Mesh) -> Mesh {
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[0.0_f32; 4]; 3])
}

fn with_offsets(mesh: Mesh) -> Mesh {
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0_f32; 3]; 3])
}

fn with_numbers(mesh: Mesh) -> Mesh {
    mesh.with_inserted_attribute(VERTEX, vec![0_u32; 3])
}

/// Asks for every pipeline. They stay: what draws nothing costs nothing, and another
/// camera wants pipelines of its own.
pub(super) fn warm(
    mut commands: Commands,
    mut paints: StagePaints,
    (card, ready): (Option<Res<CardRecording>>, Option<Res<PipelinesReady>>),
) {
    if ready.is_none() {
        // Nothing is drawn.
        return;
    }
    let inks: [WarmUpVertexLayout; 5] = [
        (InkKind::Faces, |mesh| mesh),
        (InkKind::Coats, |mesh| with_colours(with_coordinates(mesh))),
        (InkKind::Round, with_coordinates),
        (InkKind::Wire, with_coordinates),
        (InkKind::Line, with_offsets),
    ];
    for (kind, layout) in inks {
        let ink = paints.inks.add(InkMaterial {
            colour: LinearRgba::NONE,
            gradients: GradientTextures::default(),
            kind,
        });
        commands.spawn(drawn(paints.meshes.add(layout(nothing())), ink));
    }
    let played: [WarmUpVertexLayout; 2] = [
        (InkKind::Faces, with_numbers),
        (InkKind::Wire, |mesh| with_numbers(with_coordinates(mesh))),
    ];
    for (card, (kind, layout)) in card.iter().flat_map(|card| played.map(|kind| (card, kind))) {
        let film = paints.played.add(PlayedMaterial {
            colour: LinearRgba::NONE,
            sum: RecordedSum::default(),
            reel: card.nothing().clone(),
            kind,
        });
        commands.spawn(drawn(paints.meshes.add(layout(nothing())), film));
    }
    let carried = paints.meshes.add(with_colours(with_coordinates(nothing())));
    let grid = paints.grids.add(GridMaterial::default());
    commands.spawn(drawn(carried.clone(), grid));
    let field = FieldMaterial::nothing(&mut paints.images);
    commands.spawn(drawn(carried, paints.fields.add(field)));
}

fn drawn<M: Material2d>(mesh: Handle<Mesh>, material: Handle<M>) -> impl Bundle {
    (Mesh2d(mesh), MeshMaterial2d(material), NoFrustumCulling)
}
