//! Short ways from files to a transition, and one error for everything between
//! two designs and a picture: what the root of the crate offers beside types.
//!
//! Nothing is decided here: each function names what it is short for.

use crate::design::ImportError;
use crate::export::ExportError;
use crate::geometry::RegionsError;
use crate::project::{LoadedProject, ProjectError};
use crate::transition::{BuildError, Transition};
use crate::work::progress::Silent;
use std::path::Path;

/// Whatever can go wrong between two designs and a picture of them. Each says
/// in one sentence what is wrong and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A design could not be read.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// Points enclose nothing.
    #[error(transparent)]
    Outline(#[from] RegionsError),
    /// A project could not be read.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// Two designs make no transition.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A picture or a film could not be written.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// The system refused to read or write.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// The transition between two files, by the method that suits them and with
/// default options: [`LoadedProject::open_pair`], built. A path may also be
/// `glyph:D` or what else [`Source`](crate::design::Source) knows.
///
/// # Errors
/// [`Error`] names the file and the place, or what does not go together.
pub fn open_pair(source: impl AsRef<Path>, target: impl AsRef<Path>) -> Result<Transition, Error> {
    built(&LoadedProject::open_pair(source.as_ref(), target.as_ref())?)
}

/// The transition of a `.morph` file: [`LoadedProject::open`], built.
///
/// # Errors
/// [`Error`] names the file and the place, or what does not go together.
pub fn open_project(path: impl AsRef<Path>) -> Result<Transition, Error> {
    built(&LoadedProject::open(path.as_ref())?)
}

fn built(loaded: &LoadedProject) -> Result<Transition, Error> {
    // Of many designs the first way.
    Ok(loaded.legs()[0].build(&Silent)?)
}
