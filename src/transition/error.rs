//! Reasons why a transition could not be built.

use super::method::UnsupportedMethod;
use crate::compatible::{CompatibleError, FramePinsError, OutlineMeshError};
use crate::content::{ColourMixError, FieldBlendError};
use crate::correspondence::RegionMatchError;
use crate::design::Design;
use crate::field::{FieldError, GridError};
use crate::geometry::{RegionsError, Side};
use crate::io::sanitize::SanitizedLine;
use crate::warp::{ArapError, LatticeError, LinesError, PathsError, ScatteredError};
use crate::work::budget::WorkloadTooLarge;
use crate::work::progress::Cancelled;

/// Reasons why a transition could not be built.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// The method cannot interpolate designs of these kinds. Holds the reason.
    #[error("{0}")]
    Unavailable(String),
    /// The warp and the content cannot be combined.
    #[error(transparent)]
    NoSuchCell(#[from] UnsupportedMethod),
    /// An error together with the names of both designs.
    #[error("{}", SanitizedLine(format_args!("{source_name} to {target_name}: {error}")))]
    Between {
        /// Name of the source design.
        source_name: String,
        /// Name of the target design.
        target_name: String,
        /// The underlying error.
        error: Box<BuildError>,
    },
    /// Two meshes or two trusses do not share a triangulation.
    #[error(transparent)]
    Compatible(#[from] CompatibleError),
    /// The outlines could not be matched.
    #[error(transparent)]
    Match(#[from] RegionMatchError),
    /// The matched outlines could not be triangulated.
    #[error(transparent)]
    Triangulation(#[from] OutlineMeshError),
    /// The rigidity-preserving interpolation failed.
    #[error(transparent)]
    Arap(#[from] ArapError),
    /// A design has no outline.
    #[error(transparent)]
    Outline(#[from] RegionsError),
    /// The box around the designs could not be covered by a grid for distance fields.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// A distance field could not be computed.
    #[error("the {side}: {error}")]
    Field {
        /// The design whose field could not be computed.
        side: Side,
        /// The underlying error.
        error: FieldError,
    },
    /// An option of the blend of distance fields is out of range: the parameter ε of the
    /// logarithmic scale, or the threshold.
    #[error(transparent)]
    Blend(#[from] FieldBlendError),
    /// The interval of t in which the colours of pictures change is empty.
    #[error(transparent)]
    Colours(#[from] ColourMixError),
    /// The plane could not be triangulated in such a way that the pins are vertices of the mesh.
    #[error(transparent)]
    Frame(#[from] FramePinsError),
    /// The line warp could not be built.
    #[error(transparent)]
    Lines(#[from] LinesError),
    /// The scattered-point warp could not be built.
    #[error(transparent)]
    Scattered(#[from] ScatteredError),
    /// The lattice warp could not be built.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// The boundary paths could not be built.
    #[error(transparent)]
    Paths(#[from] PathsError),
    /// The bar width, as a fraction of the largest design's diameter, is outside 0 < width ≤ 1.
    #[error("the bar width {0} is not between 0 and 1; give a fraction of the design's size")]
    BarWidth(f64),
    /// The work would take very long or very much memory.
    #[error(transparent)]
    TooMuch(#[from] WorkloadTooLarge),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl BuildError {
    /// Returns the error preceded by the names of the designs.
    pub(super) fn with_names(self, source: &Design, target: &Design) -> Self {
        Self::Between {
            source_name: source.name.clone(),
            target_name: target.name.clone(),
            error: Box::new(self),
        }
    }

    /// Returns the underlying error, without the names of the designs.
    #[must_use]
    pub fn reason(&self) -> &Self {
        match self {
            Self::Between { error, .. } => error.reason(),
            error => error,
        }
    }
}
