//! What parts are painted with: a material of one of five kinds each, and the
//! assets that hold them.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::colours::ColourMaterial;
use super::field::FieldMaterial;
use super::grid::GridMaterial;
use super::ink::InkMaterial;
use super::played::PlayedMaterial;

/// The material of a part.
#[derive(Clone, Debug)]
pub(super) enum Paint {
    Ink(Handle<InkMaterial>),
    Played(Handle<PlayedMaterial>),
    Field(Handle<FieldMaterial>),
    Picture(Handle<ColourMaterial>),
    Grid(Handle<GridMaterial>),
}

/// All that is drawn with.
#[derive(SystemParam)]
pub(super) struct Paints<'w> {
    pub(super) meshes: ResMut<'w, Assets<Mesh>>,
    pub(super) images: ResMut<'w, Assets<Image>>,
    pub(super) inks: ResMut<'w, Assets<InkMaterial>>,
    pub(super) played: ResMut<'w, Assets<PlayedMaterial>>,
    pub(super) fields: ResMut<'w, Assets<FieldMaterial>>,
    pub(super) colours: ResMut<'w, Assets<ColourMaterial>>,
    pub(super) grids: ResMut<'w, Assets<GridMaterial>>,
}
