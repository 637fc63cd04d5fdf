//! The folder for exported images and films.

use std::path::PathBuf;

use bevy::ecs::system::SystemParam;
use bevy::prelude::Res;

use crate::app::output_files::CaptureFolder;
use crate::app::session::state::Session;

/// Resources that determine the folder for exported images and films.
#[derive(SystemParam)]
pub struct ExportFolder<'w> {
    chosen: Res<'w, CaptureFolder>,
    session: Res<'w, Session>,
}

impl ExportFolder<'_> {
    /// The folder; see [`CaptureFolder::path`].
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.chosen.path(self.session.folder())
    }
}
