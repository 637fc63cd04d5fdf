//! Exports the map's saved blends to files, in the background.

use std::path::PathBuf;

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::capture::export_folder::ExportFolder;
use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::jobs::job::BackgroundJob;
use crate::app::map::map_view::MapView;
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::{CreateFileError, create_new_folder};
use crate::app::session::state::Session;
use crate::export::{Catalogue, CatalogueOrder, ExportError};

/// The running export of saved blends; `None` while there is none.
#[derive(Resource, Debug, Default)]
pub struct SavedBlendsExport(Option<BackgroundJob<PathBuf, SavedBlendsError>>);

/// Reason why the saved blends were not exported.
#[derive(Debug, thiserror::Error)]
pub enum SavedBlendsError {
    /// The folder for the files cannot be created.
    #[error(transparent)]
    Folder(#[from] CreateFileError),
    /// A file could not be written.
    #[error(transparent)]
    Export(#[from] ExportError),
}

impl SavedBlendsExport {
    /// Whether an export is running.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.0.is_some()
    }
}

/// Starts the export on request and reports its result.
pub fn export(
    mut intents: MessageReader<Intent>,
    mut export_job: ResMut<SavedBlendsExport>,
    map: Res<MapView>,
    session: Res<Session>,
    preferences: Res<Preferences>,
    folder: ExportFolder,
    mut notices: ResMut<Notices>,
) {
    for intent in intents.read() {
        let (Intent::ExportSavedBlends, Some(pictures), Some(project)) =
            (intent, map.pictures(), session.whole_project())
        else {
            continue;
        };
        let (space, map) = (pictures.space().clone(), pictures.map().clone());
        let saved_places = project.map.kept.clone();
        let style = session.style();
        let ground = (!preferences.capture_transparent).then_some(style.ground);
        let (folder, stem) = (folder.path(), format!("{}-kept", session.file_stem()));
        export_job.0 = Some(BackgroundJob::start("the saved blends", move |progress| {
            let to = create_new_folder(&folder, &stem)?;
            let catalogue = Catalogue::new(&space, &map, &saved_places, 0, CatalogueOrder::Saved);
            catalogue.write(&space, &style, ground, &to, progress)?;
            Ok(to.join("catalogue.png"))
        }));
    }
    match BackgroundJob::take_result(&mut export_job.bypass_change_detection().0) {
        None => {}
        Some(Ok(sheet)) => notices.file_written(sheet),
        Some(Err(error)) => notices.problem(NoticeTopic::Picture, error.to_string()),
    }
}
