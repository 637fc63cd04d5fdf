//! The places of the map that are kept, written as files beside the window.

use std::path::PathBuf;

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::jobs::job::BackgroundJob;
use crate::app::map::map_view::MapView;
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::output_files::{CaptureFolder, CreateFileError, create_new_folder};
use crate::app::session::state::Session;
use crate::export::{Catalogue, CatalogueOrder, ExportError};

/// What is being written.
#[derive(Resource, Debug, Default)]
pub struct SavedBlendsExport(Option<BackgroundJob<PathBuf, SavedBlendsError>>);

/// Why kept places were not written.
#[derive(Debug, thiserror::Error)]
pub enum SavedBlendsError {
    /// There is no folder for them.
    #[error(transparent)]
    Folder(#[from] CreateFileError),
    /// A file could not be written.
    #[error(transparent)]
    Export(#[from] ExportError),
}

impl SavedBlendsExport {
    /// Something is being written.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.0.is_some()
    }
}

/// Writes what is kept where that is asked for, and tells that it was written.
pub fn export(
    mut intents: MessageReader<Intent>,
    mut cataloguing: ResMut<SavedBlendsExport>,
    (map, session, preferences): (Res<MapView>, Res<Session>, Res<Preferences>),
    folder: Res<CaptureFolder>,
    mut notices: ResMut<Notices>,
) {
    for intent in intents.read() {
        let (Intent::ExportKept, Some(made), Some(whole)) = (intent, map.made(), session.whole())
        else {
            continue;
        };
        let (space, map) = (made.space().clone(), made.map().clone());
        let kept = whole.map.kept.clone();
        let style = session.style();
        let ground = (!preferences.capture_transparent).then_some(style.ground);
        let (folder, stem) = (folder.0.clone(), format!("{}-kept", session.file_stem()));
        cataloguing.0 = Some(BackgroundJob::start("the kept blends", move |progress| {
            let to = create_new_folder(&folder, &stem)?;
            let catalogue = Catalogue::new((&space, &map), &kept, 0, CatalogueOrder::Kept);
            catalogue.write(&space, (&style, ground), &to, progress)?;
            Ok(to.join("catalogue.png"))
        }));
    }
    match BackgroundJob::take(&mut cataloguing.bypass_change_detection().0) {
        None => {}
        Some(Ok(sheet)) => notices.wrote(sheet),
        Some(Err(error)) => notices.problem(NoticeTopic::Picture, error.to_string()),
    }
}
