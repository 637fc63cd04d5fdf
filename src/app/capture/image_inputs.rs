//! System parameter with the resources that images of the stage are drawn from.

use bevy::ecs::system::SystemParam;
use bevy::prelude::{Res, Single, With};
use bevy::window::{PrimaryWindow, Window};

use crate::app::input::preferences::Preferences;
use crate::app::map::map_view::MapView;
use crate::app::playback::player::Playback;
use crate::app::session::state::Session;
use crate::stage::StageView;

/// Resources that determine the content, the size and the background of an image of the stage.
#[derive(SystemParam)]
pub struct StageImageInputs<'w, 's> {
    /// The project and its film.
    pub session: Res<'w, Session>,
    /// The current t.
    pub playback: Res<'w, Playback>,
    /// Resolution and transparency of images.
    pub preferences: Res<'w, Preferences>,
    /// The map, which is saved in place of the stage while it is shown.
    pub map: Res<'w, MapView>,
    /// Visible section of the plane.
    pub view: Res<'w, StageView>,
    /// The main window, whose scale factor is the number of physical pixels per logical pixel.
    pub window: Single<'w, 's, &'static Window, With<PrimaryWindow>>,
}
