//! What parts are painted with: a material of one of five kinds each, and the
//! assets that hold them.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::field_material::FieldMaterial;
use super::ink_material::InkMaterial;
use super::picture_material::ColourMaterial;
use super::recorded_material::PlayedMaterial;
use super::warp_grid::GridMaterial;

/// The material of a part.
#[derive(Clone, Debug)]
pub(super) enum StagePaint {
    Ink(Handle<InkMaterial>),
    Played(Handle<PlayedMaterial>),
    Field(Handle<FieldMaterial>),
    Picture(Handle<ColourMaterial>),
    Grid(Handle<GridMaterial>),
}

/// All that is drawn with.
#[derive(SystemParam)]
pub(super) struct StagePaints<'w> {
    pub(super) meshes: ResMut<'w, Assets<Mesh>>,
    pub(super) images: ResMut<'w, Assets<Image>>,
    pub(super) inks: ResMut<'w, Assets<InkMaterial>>,
    pub(super) played: ResMut<'w, Assets<PlayedMaterial>>,
    pub(super) fields: ResMut<'w, Assets<FieldMaterial>>,
    pub(super) colours: ResMut<'w, Assets<ColourMaterial>>,
    pub(super) grids: ResMut<'w, Assets<GridMaterial>>,
}
