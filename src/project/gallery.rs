//! The projects that come with the program, held in the binary.

use super::document::Project;
use super::error::ProjectError;
use super::loaded::{FILES, LoadedProject};
use include_dir::File;
use std::path::Path;

pub use super::loaded::bytes;

/// A bundled project.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct GalleryEntry {
    /// What it is opened by: `gallery:NAME`.
    pub name: String,
    /// What it is called.
    pub title: String,
    /// What it shows.
    pub description: String,
}

/// All bundled projects, by name.
///
/// # Errors
/// [`ProjectError`] if a bundled document is wrong; the tests read them all.
pub fn list() -> Result<Vec<GalleryEntry>, ProjectError> {
    let mut entries = names()
        .map(|name| {
            let project = document(name)?;
            Ok(GalleryEntry {
                name: name.to_owned(),
                title: project.title,
                description: project.description,
            })
        })
        .collect::<Result<Vec<_>, ProjectError>>()?;
    // By name and not by file, whose ending would put `a-b` before `a`.
    entries.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(entries)
}

/// Reads a bundled project and its designs.
///
/// # Errors
/// [`ProjectError::NotInGallery`] for another name.
pub fn load(name: &str) -> Result<LoadedProject, ProjectError> {
    LoadedProject::load(document(name)?, None)
}

/// A bundled document, without its designs.
///
/// # Errors
/// [`ProjectError::NotInGallery`] for another name.
pub fn document(name: &str) -> Result<Project, ProjectError> {
    let file = format!("{name}.morph");
    let path = Path::new(&file);
    let Some(text) = FILES.get_file(path).and_then(File::contents_utf8) else {
        let mut known: Vec<_> = names().collect();
        known.sort_unstable();
        return Err(ProjectError::NotInGallery {
            name: name.to_owned(),
            known: known.join(", "),
        });
    };
    Project::parse(text).map_err(|error| error.in_file(path))
}

/// The names of the bundled documents.
fn names() -> impl Iterator<Item = &'static str> {
    FILES
        .files()
        .filter_map(|file| file.path().to_str()?.strip_suffix(".morph"))
}
