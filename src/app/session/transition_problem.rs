//! Why a transition cannot be built, as the window reports it.

use crate::correspondence::{PinError, RegionMatchError};
use crate::project::ProjectError;
use crate::transition::BuildError;

/// Reason why the requested transition of a segment cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum TransitionProblem {
    /// The settings do not fit the designs.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// No transition can be built from the designs with these settings.
    #[error(transparent)]
    Build(#[from] BuildError),
}

impl TransitionProblem {
    /// Whether the build was refused only because it would take too long or too much memory.
    #[must_use]
    pub fn exceeds_limits(&self) -> bool {
        matches!(self, Self::Build(error) if matches!(error.reason(), BuildError::TooMuch(_)))
    }

    /// Indices, in the project, of the pins that cause the problem.
    #[must_use]
    pub fn pins(&self) -> Vec<usize> {
        let Self::Build(error) = self else {
            return Vec::new();
        };
        match error.reason() {
            BuildError::Match(RegionMatchError::Pins(error)) => match error {
                PinError::NotFinite(a) => vec![*a],
                PinError::SamePoint(a, b) | PinError::Crossing(a, b) => vec![*a, *b],
            },
            BuildError::Match(RegionMatchError::PinAcross(a)) => vec![*a],
            // All other problems lie in the designs or the method.
            _ => Vec::new(),
        }
    }
}
