//! How a command ends when it does not end well.

use std::io;

use crate::project::ProjectError;
use crate::space::SpaceError;
use crate::transition::BuildError;

/// Why a command did not do its work.
#[derive(Debug, thiserror::Error)]
pub(super) enum CliError {
    /// The command was used wrongly: exit code 2.
    #[error("{0}")]
    Usage(String),
    /// The work failed: exit code 1.
    #[error("{0}")]
    Failed(String),
    /// Data could not be written to stdout.
    #[error("cannot write to stdout: {0}")]
    Stdout(io::Error),
}

impl CliError {
    /// Work that failed, told by its error and what that came from.
    pub fn failed(error: impl std::error::Error) -> Self {
        Self::Failed(error.to_string())
    }

    /// Why there is no transition, and which flag goes on all the same.
    pub fn not_built(error: BuildError) -> Self {
        match error.reason() {
            BuildError::TooMuch(_) => Self::Failed(format!("{error}, or go on with --patient")),
            _ => Self::failed(error),
        }
    }

    /// Why there is no film of a project, likewise.
    pub fn no_film(error: ProjectError) -> Self {
        match error {
            ProjectError::Build(error) | ProjectError::Space(SpaceError::Build(error)) => {
                Self::not_built(error)
            }
            error => Self::failed(error),
        }
    }

    /// Wrong use, told by an error.
    pub fn usage(error: impl std::error::Error) -> Self {
        Self::Usage(error.to_string())
    }
}
