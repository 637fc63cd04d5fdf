//! The gallery: example projects that are embedded in the binary.

use super::document::Project;
use super::error::ProjectError;
use super::loaded::{FILES, LoadedProject};
use include_dir::File;
use std::path::Path;

pub use super::loaded::bytes;

/// Name and description of a bundled project.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct GalleryEntry {
    /// Name by which the project can be opened, as `gallery:NAME`.
    pub name: String,
    /// Title of the project.
    pub title: String,
    /// One sentence about the project.
    pub description: String,
}

/// Returns all bundled projects, sorted by name.
///
/// # Errors
/// [`ProjectError`] if a bundled project is invalid; the tests read all of them.
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
    // The entries are sorted here, because the file names with their extension put `a-b` before
    // `a`.
    entries.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(entries)
}

/// Reads a bundled project and its designs.
///
/// # Errors
/// [`ProjectError::NotInGallery`] for an unknown name.
pub fn load(name: &str) -> Result<LoadedProject, ProjectError> {
    LoadedProject::load(document(name)?, None)
}

/// Reads a bundled project without its designs.
///
/// # Errors
/// [`ProjectError::NotInGallery`] for an unknown name.
pub fn document(name: &str) -> Result<Project, ProjectError> {
    let file = format!("{name}.morph");
    let path = Path::new(&file);
    let Some(text) = FILES.get_file(path).and_then(File::contents_utf8) else {
        let mut all_names: Vec<_> = names().collect();
        all_names.sort_unstable();
        return Err(ProjectError::NotInGallery {
            name: name.to_owned(),
            known: all_names.join(", "),
        });
    };
    Project::parse(text).map_err(|error| error.in_file(path))
}

/// Returns the names of the bundled projects, in no particular order.
fn names() -> impl Iterator<Item = &'static str> {
    FILES
        .files()
        .filter_map(|file| file.path().to_str()?.strip_suffix(".morph"))
}
