//! Points, rings and lists of rings in JSON, and why they give no polygons.
//!
//! What is wrong is told at once, and where it is on the way out: each value
//! adds its step to the path of an error from within it.

use crate::design::json_error::JsonError;
use crate::design::note::OtherKinds;
use crate::geometry::{DVec2, RANGE_MESSAGE, RegionsError, is_in_range};
use serde_json::Value;

/// Why JSON gives no polygons.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonsImportError {
    /// Not JSON.
    #[error(transparent)]
    Json(#[from] JsonError),
    /// A value that cannot be used.
    #[error("${path} {fault}")]
    Value {
        /// The way to it from the document, such as `.features[2].geometry`.
        path: String,
        /// What is wrong with it.
        fault: PolygonsFault,
    },
    /// More objects than are read.
    #[error(
        "there are more than {MAX_OBJECTS} objects in the file; save its polygons as one multi-polygon"
    )]
    TooManyObjects,
    /// There is not one polygon.
    #[error("there is no polygon in the file{0}; save filled outlines")]
    NoPolygon(OtherKinds),
    /// Nothing is enclosed.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// What is wrong with a value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonsFault {
    /// Something else stands where something should.
    #[error("is {found}; give {expected}")]
    Expected {
        /// What should be there.
        expected: &'static str,
        /// What is there.
        found: &'static str,
    },
    /// A member that must be there is not.
    #[error("has no \"{key}\"; give {expected}")]
    Missing {
        /// The member.
        key: &'static str,
        /// What should be there.
        expected: &'static str,
    },
    /// A point with a coordinate beyond [`MAX_COORDINATE`].
    ///
    /// [`MAX_COORDINATE`]: crate::geometry::MAX_COORDINATE
    #[error("{RANGE_MESSAGE}")]
    Place,
    /// A type that GeoJSON does not have.
    #[error("is of the type \"{0}\", which GeoJSON does not have; correct the type")]
    Type(String),
}

impl From<PolygonsFault> for PolygonsImportError {
    fn from(fault: PolygonsFault) -> Self {
        let path = String::new();
        Self::Value { path, fault }
    }
}

impl PolygonsImportError {
    /// The same, seen from a step further out.
    pub(super) fn within(self, step: &str) -> Self {
        match self {
            Self::Value { path, fault } => Self::Value {
                path: format!("{step}{path}"),
                fault,
            },
            other => other,
        }
    }
}

/// Most objects in a file: each takes some 600 bytes while it is read, however
/// few it has there.
pub(super) const MAX_OBJECTS: usize = 1_000_000;

pub(super) type JsonRing = Vec<DVec2>;

type PolygonsResult<T> = std::result::Result<T, PolygonsImportError>;

const POINT: &str = "a point, as in [1.5, 2]";
pub(super) const RING: &str = "a ring, as in [[0, 0], [4, 0], [0, 3]]";
pub(super) const RINGS: &str = "a list of rings";

/// That something else should be here.
pub(super) fn type_mismatch(expected: &'static str, value: &Value) -> PolygonsImportError {
    let found = match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(list) if list.is_empty() => "an empty list",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    };
    PolygonsFault::Expected { expected, found }.into()
}

/// Reads each value of what should be a list.
pub(super) fn read_list<T>(
    value: &Value,
    what: &'static str,
    mut read: impl FnMut(&Value) -> PolygonsResult<T>,
) -> PolygonsResult<Vec<T>> {
    let list = value.as_array().ok_or_else(|| type_mismatch(what, value))?;
    let read = |(i, value)| read(value).map_err(|error| error.within(&format!("[{i}]")));
    list.iter().enumerate().map(read).collect()
}

/// Reads a member of an object, if it is there.
pub(super) fn read_member<T>(
    object: &Value,
    key: &'static str,
    read: impl FnOnce(&Value) -> PolygonsResult<T>,
) -> PolygonsResult<Option<T>> {
    let read = object.get(key).map(read).transpose();
    read.map_err(|error| error.within(&format!(".{key}")))
}

fn point(value: &Value) -> PolygonsResult<DVec2> {
    let number = |value: &Value| {
        let number = value.as_f64();
        number.ok_or_else(|| type_mismatch("two numbers for a point", value))
    };
    match value.as_array().map(Vec::as_slice) {
        Some([x, y, ..]) => {
            let point = DVec2::new(number(x)?, number(y)?);
            let found = is_in_range(point).then_some(point);
            found.ok_or_else(|| PolygonsFault::Place.into())
        }
        _ => Err(type_mismatch(POINT, value)),
    }
}

pub(super) fn ring(value: &Value) -> PolygonsResult<JsonRing> {
    read_list(value, RING, point)
}

pub(super) fn rings(value: &Value) -> PolygonsResult<Vec<JsonRing>> {
    read_list(value, RINGS, ring)
}

pub(super) fn polygons(value: &Value) -> PolygonsResult<Vec<Vec<JsonRing>>> {
    read_list(value, "a list of polygons, each a list of rings", rings)
}

/// Lists in lists down to the first number.
pub(super) fn depth(value: &Value) -> usize {
    match value {
        Value::Array(list) => 1 + list.first().map_or(0, depth),
        _ => 0,
    }
}
