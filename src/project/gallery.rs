//! The projects that come with the program, held in the binary.

use super::{LoadedProject, Project, ProjectError};
use crate::design::Source;
use include_dir::{Dir, include_dir};
use std::path::Path;

static FILES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/assets/gallery");

/// A bundled project.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Entry {
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
pub fn list() -> Result<Vec<Entry>, ProjectError> {
    let mut entries = names()
        .map(|name| {
            let project = document(name)?;
            Ok(Entry {
                name: name.to_owned(),
                title: project.title,
                description: project.description,
            })
        })
        .collect::<Result<Vec<_>, ProjectError>>()?;
    entries.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(entries)
}

/// Reads a bundled project and its designs.
///
/// # Errors
/// [`ProjectError::NotInGallery`] for another name.
pub fn load(name: &str) -> Result<LoadedProject, ProjectError> {
    load_document(document(name)?)
}

/// Reads the bundled designs that a document names: a bundled one with other
/// options, for example.
///
/// # Errors
/// [`ProjectError`] for a design that is not bundled or cannot be read.
pub fn load_document(project: Project) -> Result<LoadedProject, ProjectError> {
    LoadedProject::load_bundled(project, |path| {
        bytes(path).ok_or_else(|| ProjectError::Io(format!("{} is missing", path.display())))
    })
}

/// Writes a bundled project and its designs into a folder, to start from.
///
/// # Errors
/// [`ProjectError`] if the name is unknown or a file cannot be written.
pub fn copy_into(name: &str, folder: &Path) -> Result<std::path::PathBuf, ProjectError> {
    let project = document(name)?;
    let io = |error: std::io::Error| ProjectError::Io(error.to_string()).in_file(folder);
    std::fs::create_dir_all(folder).map_err(io)?;
    for entry in &project.designs {
        let source = Source::parse(&entry.path, |path| bytes(path).is_some());
        if let Some((file, content)) = source.file().and_then(|file| Some((file, bytes(file)?))) {
            std::fs::write(folder.join(file), content).map_err(io)?;
        }
    }
    let path = folder.join(format!("{name}.morph"));
    project.save_atomically(&path)?;
    Ok(path)
}

fn names() -> impl Iterator<Item = &'static str> {
    FILES
        .files()
        .filter_map(|file| file.path().to_str()?.strip_suffix(".morph"))
}

/// The content of a bundled design, by its path in a bundled document.
#[must_use]
pub fn bytes(path: &Path) -> Option<&'static [u8]> {
    FILES.get_file(path).map(include_dir::File::contents)
}

/// A bundled document, without its designs.
///
/// # Errors
/// [`ProjectError::NotInGallery`] for another name.
pub fn document(name: &str) -> Result<Project, ProjectError> {
    let file = format!("{name}.morph");
    let path = Path::new(&file);
    let text = FILES
        .get_file(path)
        .and_then(include_dir::File::contents_utf8);
    let Some(text) = text else {
        let mut known: Vec<_> = names().collect();
        known.sort_unstable();
        return Err(ProjectError::NotInGallery {
            name: name.to_owned(),
            known: known.join(", "),
        });
    };
    Project::parse(text).map_err(|error| error.in_file(path))
}
