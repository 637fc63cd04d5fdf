//! Materials of render parts, and access to the assets that store them.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::field_material::FieldMaterial;
use super::ink_material::InkMaterial;
use super::picture_material::PictureMaterial;
use super::recorded_material::RecordedMaterial;
use super::warp_grid::GridMaterial;

/// Handle of the material of a render part.
#[derive(Clone, Debug)]
pub(super) enum StagePaint {
    Ink(Handle<InkMaterial>),
    Recorded(Handle<RecordedMaterial>),
    Field(Handle<FieldMaterial>),
    Picture(Handle<PictureMaterial>),
    Grid(Handle<GridMaterial>),
}

/// Asset collections needed to create and update render parts.
#[derive(SystemParam)]
pub(super) struct StagePaints<'w> {
    pub(super) meshes: ResMut<'w, Assets<Mesh>>,
    pub(super) images: ResMut<'w, Assets<Image>>,
    pub(super) inks: ResMut<'w, Assets<InkMaterial>>,
    pub(super) played: ResMut<'w, Assets<RecordedMaterial>>,
    pub(super) fields: ResMut<'w, Assets<FieldMaterial>>,
    pub(super) colours: ResMut<'w, Assets<PictureMaterial>>,
    pub(super) grids: ResMut<'w, Assets<GridMaterial>>,
}
