//! Why JSON gives no polygons.

use crate::design::json::JsonError;
use crate::geometry::RegionsError;

/// Why JSON gives no polygons. Places are paths such as
/// `$.features[2].geometry`, `$` being the document.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonsError {
    /// Not JSON.
    #[error(transparent)]
    Json(#[from] JsonError),
    /// Something else stands where something should.
    #[error("{at} is {found}; give {expected}")]
    Expected {
        /// The place.
        at: String,
        /// What should be there.
        expected: &'static str,
        /// What is there.
        found: &'static str,
    },
    /// A member that must be there is not.
    #[error("{at} has no \"{key}\"; give {expected}")]
    Missing {
        /// The place.
        at: String,
        /// The member.
        key: &'static str,
        /// What should be there.
        expected: &'static str,
    },
    /// A type that GeoJSON does not have.
    #[error("{at} is of the type \"{found}\", which GeoJSON does not have; correct the type")]
    Type {
        /// The place.
        at: String,
        /// The type.
        found: String,
    },
    /// There is not one polygon.
    #[error("there is no polygon in the file{}; save filled outlines", if found.is_empty() { String::new() } else { format!(", only {found}") })]
    NoPolygon {
        /// What there is instead.
        found: String,
    },
    /// Nothing is enclosed.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}
