//! The error type for every step from reading designs to writing an image. Also the convenience
//! functions of the crate root, which build a transition straight from files.
//!
//! The functions only combine other public functions, which their documentation names.

use crate::design::ImportError;
use crate::export::ExportError;
use crate::geometry::RegionsError;
use crate::project::{LoadedProject, ProjectError};
use crate::transition::{BuildError, Transition};
use crate::work::progress::Silent;
use std::path::Path;

/// Any error between reading designs and writing an image or film.
///
/// Each message says in one sentence what is wrong and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A design could not be read.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// The points of an outline enclose no area.
    #[error(transparent)]
    Outline(#[from] RegionsError),
    /// A project could not be read.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// The designs do not allow a transition.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// An image or a film could not be written.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// The operating system reported an input or output error.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// Builds the transition between two files with default options.
///
/// The method is the one that suits the designs. Short for [`LoadedProject::open_pair`] followed by
/// [`LoadedProject::build`]. A path may also be any other form that
/// [`DesignSource`](crate::design::DesignSource) parses, such as `glyph:D`.
///
/// # Errors
/// [`Error`] names the file and the place of an error in it, or says why the designs are
/// incompatible.
pub fn open_pair(source: impl AsRef<Path>, target: impl AsRef<Path>) -> Result<Transition, Error> {
    build_first_segment(&LoadedProject::open_pair(source.as_ref(), target.as_ref())?)
}

/// Builds the transition of a `.morph` file, or its first segment if it has several.
///
/// Short for [`LoadedProject::open`] followed by [`LoadedProject::build`].
///
/// # Errors
/// [`Error`] names the file and the place of an error in it, or says why the designs are
/// incompatible.
pub fn open_project(path: impl AsRef<Path>) -> Result<Transition, Error> {
    build_first_segment(&LoadedProject::open(path.as_ref())?)
}

/// Builds the transition of the first segment of a project.
fn build_first_segment(loaded: &LoadedProject) -> Result<Transition, Error> {
    Ok(loaded.segments()[0].build(&Silent)?)
}
