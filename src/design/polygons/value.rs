//! Points, rings and lists of rings in JSON, where in it they stand, and why
//! they give no polygons.

use crate::design::json::JsonError;
use crate::design::note::OnlyThese;
use crate::geometry::{DVec2, RegionsError};
use serde_json::{Map, Value};
use std::fmt;

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
    #[error("there is no polygon in the file{0}; save filled outlines")]
    NoPolygon(OnlyThese),
    /// Nothing is enclosed.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// Largest coordinate: squares and their products stay finite.
const MAX_COORDINATE: f64 = 1e60;

/// A place in the document.
pub(super) enum At<'a> {
    Root,
    Key(&'a At<'a>, &'static str),
    Item(&'a At<'a>, usize),
}

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Root => f.write_str("$"),
            Self::Key(up, key) => write!(f, "{up}.{key}"),
            Self::Item(up, index) => write!(f, "{up}[{index}]"),
        }
    }
}

pub(super) fn expected(at: &At, expected: &'static str, value: &Value) -> PolygonsError {
    let found = match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(list) if list.is_empty() => "an empty list",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    };
    PolygonsError::Expected {
        at: at.to_string(),
        expected,
        found,
    }
}

pub(super) fn items<'v>(
    value: &'v Value,
    at: &At,
    what: &'static str,
) -> Result<&'v [Value], PolygonsError> {
    let list = value.as_array().ok_or_else(|| expected(at, what, value))?;
    Ok(list)
}

pub(super) type Ring = Vec<DVec2>;

const POINT: &str = "a point, as in [1.5, 2]";
pub(super) const RING: &str = "a ring, as in [[0, 0], [4, 0], [0, 3]]";
pub(super) const RINGS: &str = "a list of rings";
pub(super) const POLYGONS: &str = "a list of polygons, each a list of rings";

fn point(value: &Value, at: &At) -> Result<DVec2, PolygonsError> {
    let number = |value: &Value| {
        let number = value.as_f64().filter(|x| x.abs() <= MAX_COORDINATE);
        number.ok_or_else(|| expected(at, "two numbers of at most 1e60 for a point", value))
    };
    match items(value, at, POINT)? {
        [x, y, ..] => Ok(DVec2::new(number(x)?, number(y)?)),
        _ => Err(expected(at, POINT, value)),
    }
}

pub(super) fn ring(value: &Value, at: &At) -> Result<Ring, PolygonsError> {
    let points = items(value, at, RING)?.iter().enumerate();
    points.map(|(i, p)| point(p, &At::Item(at, i))).collect()
}

pub(super) fn rings(value: &Value, at: &At) -> Result<Vec<Ring>, PolygonsError> {
    let rings = items(value, at, RINGS)?.iter().enumerate();
    rings.map(|(i, r)| ring(r, &At::Item(at, i))).collect()
}

/// Lists in lists down to the first number.
pub(super) fn depth(value: &Value) -> usize {
    match value {
        Value::Array(list) => 1 + list.first().map_or(0, depth),
        _ => 0,
    }
}

/// A member that must be there, and where it stands.
pub(super) fn required<'v, 'a>(
    object: &'v Map<String, Value>,
    key: &'static str,
    expected: &'static str,
    at: &'a At<'a>,
) -> Result<(&'v Value, At<'a>), PolygonsError> {
    let missing = || PolygonsError::Missing {
        at: at.to_string(),
        key,
        expected,
    };
    let value = object.get(key).ok_or_else(missing)?;
    Ok((value, At::Key(at, key)))
}
