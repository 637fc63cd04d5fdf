//! Errors of the subcommands, and the exit codes that they lead to.

use std::io;

use crate::project::ProjectError;
use crate::space::SpaceError;
use crate::transition::BuildError;

/// Error of a subcommand.
#[derive(Debug, thiserror::Error)]
pub(super) enum CliError {
    /// Wrong usage: exit code 2.
    #[error("{0}")]
    Usage(String),
    /// The work failed: exit code 1.
    #[error("{0}")]
    Failed(String),
    /// Stdout could not be written: exit code 1, or 0 for a closed pipe.
    #[error("cannot write to stdout: {0}")]
    Stdout(io::Error),
}

impl CliError {
    /// Creates a failure from another error.
    pub fn failed(error: impl std::error::Error) -> Self {
        Self::Failed(error.to_string())
    }

    /// Creates a failure from a build error; for jobs that are too large, suggests `--patient`.
    pub fn transition_not_built(error: BuildError) -> Self {
        match error.reason() {
            BuildError::TooMuch(_) => {
                Self::Failed(format!("{error}, or run it anyway with --patient"))
            }
            _ => Self::failed(error),
        }
    }

    /// Creates a failure from a project error. Like [`Self::transition_not_built`], suggests
    /// `--patient` for jobs that are too large.
    pub fn project_not_built(error: ProjectError) -> Self {
        match error {
            ProjectError::Build(error) | ProjectError::Space(SpaceError::Build(error)) => {
                Self::transition_not_built(error)
            }
            error => Self::failed(error),
        }
    }

    /// Creates a usage error from another error.
    pub fn usage(error: impl std::error::Error) -> Self {
        Self::Usage(error.to_string())
    }
}
