//! Reads points, rings and polygons from JSON values, and defines the errors of the polygon
//! importer.
//!
//! An error is created with an empty path. The reader of each enclosing object or list then puts
//! the key or the index of the faulty value in front of that path (see
//! [`PolygonsImportError::within`]).

use crate::design::json_error::JsonError;
use crate::design::note::OtherKinds;
use crate::geometry::{DVec2, RANGE_MESSAGE, RegionsError, is_in_range};
use serde_json::Value;

/// Error of importing polygons from JSON.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonsImportError {
    /// The text is not valid JSON.
    #[error(transparent)]
    Json(#[from] JsonError),
    /// A value cannot be used.
    #[error("${path} {fault}")]
    Value {
        /// Path of the value in the document, such as `.features[2].geometry`.
        path: String,
        /// Reason why the value cannot be used.
        fault: PolygonsFault,
    },
    /// The file has too many JSON objects.
    #[error("the file has more than {MAX_OBJECTS} objects; save its polygons as one MultiPolygon")]
    TooManyObjects,
    /// The file has no polygons; holds the numbers of its other objects by type.
    #[error("the file has no polygons{0}; save filled outlines")]
    NoPolygon(OtherKinds),
    /// The polygons enclose no area.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// Fault of a JSON value. Its message continues a sentence that begins with the path of the value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonsFault {
    /// The value has the wrong type.
    #[error("is {found}; give {expected}")]
    Expected {
        /// Expected type.
        expected: &'static str,
        /// Type of the value in the file.
        found: &'static str,
    },
    /// A required member is missing.
    #[error("has no \"{key}\"; give {expected}")]
    Missing {
        /// Name of the member.
        key: &'static str,
        /// Expected type of the member.
        expected: &'static str,
    },
    /// The absolute value of a coordinate exceeds [`MAX_COORDINATE`].
    ///
    /// [`MAX_COORDINATE`]: crate::geometry::MAX_COORDINATE
    #[error("{RANGE_MESSAGE}")]
    CoordinateRange,
    /// The object has a type that GeoJSON does not define. Holds the type, shortened.
    #[error("has the type \"{0}\", which GeoJSON does not define; correct it")]
    Type(String),
}

impl From<PolygonsFault> for PolygonsImportError {
    fn from(fault: PolygonsFault) -> Self {
        let path = String::new();
        Self::Value { path, fault }
    }
}

impl PolygonsImportError {
    /// Prepends `step`, a key such as `.geometry` or an index such as `[2]`, to the path of the
    /// error.
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

/// Maximum number of JSON objects in a file (resource limit: each takes about 600 bytes of memory
/// during the import).
pub(super) const MAX_OBJECTS: usize = 1_000_000;

/// Ring of points; an edge connects the last point to the first.
pub(super) type JsonRing = Vec<DVec2>;

type PolygonsResult<T> = std::result::Result<T, PolygonsImportError>;

const POINT: &str = "a point, as in [1.5, 2]";
pub(super) const RING: &str = "a ring, as in [[0, 0], [4, 0], [0, 3]]";
pub(super) const RINGS: &str = "a list of rings";

/// Returns the error for a value of the wrong type.
pub(super) fn type_mismatch(expected: &'static str, value: &Value) -> PolygonsImportError {
    let found = match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(list) if list.is_empty() => "an empty list",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    };
    PolygonsFault::Expected { expected, found }.into()
}

/// Reads every element of a list with `read`. `what` names the expected list in errors.
pub(super) fn read_list<T>(
    value: &Value,
    what: &'static str,
    mut read: impl FnMut(&Value) -> PolygonsResult<T>,
) -> PolygonsResult<Vec<T>> {
    let list = value.as_array().ok_or_else(|| type_mismatch(what, value))?;
    let read = |(i, value)| read(value).map_err(|error| error.within(&format!("[{i}]")));
    list.iter().enumerate().map(read).collect()
}

/// Reads a member of an object with `read`; returns `None` if it is missing.
pub(super) fn read_member<T>(
    object: &Value,
    key: &'static str,
    read: impl FnOnce(&Value) -> PolygonsResult<T>,
) -> PolygonsResult<Option<T>> {
    let read = object.get(key).map(read).transpose();
    read.map_err(|error| error.within(&format!(".{key}")))
}

/// Reads a point; numbers after the first two are ignored.
fn point(value: &Value) -> PolygonsResult<DVec2> {
    let number = |value: &Value| {
        let number = value.as_f64();
        number.ok_or_else(|| type_mismatch("two numbers for a point", value))
    };
    match value.as_array().map(Vec::as_slice) {
        Some([x, y, ..]) => {
            let point = DVec2::new(number(x)?, number(y)?);
            let valid = is_in_range(point).then_some(point);
            valid.ok_or_else(|| PolygonsFault::CoordinateRange.into())
        }
        _ => Err(type_mismatch(POINT, value)),
    }
}

/// Reads a ring: a list of points.
pub(super) fn ring(value: &Value) -> PolygonsResult<JsonRing> {
    read_list(value, RING, point)
}

/// Reads a polygon: a list of rings.
pub(super) fn rings(value: &Value) -> PolygonsResult<Vec<JsonRing>> {
    read_list(value, RINGS, ring)
}

/// Reads a list of polygons.
pub(super) fn polygons(value: &Value) -> PolygonsResult<Vec<Vec<JsonRing>>> {
    read_list(value, "a list of polygons, each a list of rings", rings)
}

/// Returns the nesting depth of a list, judged by the first element at each depth; 0 if the value
/// is not a list.
pub(super) fn depth(value: &Value) -> usize {
    match value {
        Value::Array(list) => 1 + list.first().map_or(0, depth),
        _ => 0,
    }
}
