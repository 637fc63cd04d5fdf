//! Polygons as JSON, and GeoJSON (Butler and others, RFC 7946, 2016).
//!
//! Plain JSON is one of
//!
//! ```json
//! [[0, 0], [4, 0], [0, 3]]
//! [[[0, 0], [4, 0], [0, 3]], [[1, 1], [2, 1], [1, 2]]]
//! [[[[0, 0], [4, 0], [0, 3]], [[1, 1], [2, 1], [1, 2]]], [[[5, 0], [6, 0], [5, 1]]]]
//! {"rings": [[[0, 0], [4, 0], [0, 3]]]}
//! {"polygons": [[[[0, 0], [4, 0], [0, 3]]]]}
//! ```
//!
//! a ring of points; a list of rings; a list of polygons, each a list of
//! rings; or the same under a name. A ring may repeat its first point at the
//! end. Of GeoJSON polygons are read wherever they lie in features and
//! collections; points and lines are left out, which is told. Coordinates
//! are taken as they are, x to the right and y up, longitude and latitude
//! included; more than two numbers of a point are not looked at.
//!
//! Within a polygon (or a list of rings) the even-odd rule says what is
//! inside, so that rings in rings are holes whichever way they run; an
//! outline drawn twice counts once. Polygons are united.
//!
//! Errors name the place as a path into the document.

use super::{ImportNote, Outlines};
use crate::geometry::{DVec2, FillRule, Regions, RegionsError, Repairs};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fmt;

/// Why JSON gives no polygons. Places are paths such as
/// `$.features[2].geometry`, `$` being the document.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PolygonsError {
    /// Not JSON.
    #[error("line {line}, column {column}: {message}; correct the file")]
    Json {
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What was found.
        message: String,
    },
    /// More text than polygons should have.
    #[error(
        "the file has {} MiB, more than the {} MiB of polygons that are read; simplify them",
        bytes >> 20,
        MAX_BYTES >> 20
    )]
    TooLarge {
        /// Its size.
        bytes: usize,
    },
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

/// Most bytes of text: some four million points.
const MAX_BYTES: usize = 64 << 20;

/// Largest coordinate: squares and their products stay finite.
const MAX_COORDINATE: f64 = 1e60;

/// Reads plain polygons or GeoJSON.
pub(super) fn read(text: &str) -> Result<Outlines, PolygonsError> {
    if text.len() > MAX_BYTES {
        return Err(PolygonsError::TooLarge { bytes: text.len() });
    }
    let value: Value = serde_json::from_str(text).map_err(|error| PolygonsError::Json {
        line: error.line(),
        column: error.column(),
        message: message_of(&error),
    })?;
    let mut found = Found::default();
    let root = At::Root;
    match &value {
        Value::Object(object) if object.contains_key("type") => found.geojson(object, &root)?,
        Value::Object(object) => found.named(object, &root)?,
        list => found.list(list, &root)?,
    }
    drop(value);
    found.united()
}

/// The parser's words without the place, which stands before them.
fn message_of(error: &serde_json::Error) -> String {
    let words = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    words.strip_suffix(&place).unwrap_or(&words).to_owned()
}

/// A place in the document.
enum At<'a> {
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

fn expected(at: &At, expected: &'static str, value: &Value) -> PolygonsError {
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

fn items<'v>(value: &'v Value, at: &At, what: &'static str) -> Result<&'v [Value], PolygonsError> {
    let list = value.as_array().ok_or_else(|| expected(at, what, value))?;
    Ok(list)
}

type Ring = Vec<DVec2>;

const POINT: &str = "a point, as in [1.5, 2]";
const RING: &str = "a ring, as in [[0, 0], [4, 0], [0, 3]]";
const RINGS: &str = "a list of rings";
const POLYGONS: &str = "a list of polygons, each a list of rings";

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

fn ring(value: &Value, at: &At) -> Result<Ring, PolygonsError> {
    let points = items(value, at, RING)?.iter().enumerate();
    points.map(|(i, p)| point(p, &At::Item(at, i))).collect()
}

fn rings(value: &Value, at: &At) -> Result<Vec<Ring>, PolygonsError> {
    let rings = items(value, at, RINGS)?.iter().enumerate();
    rings.map(|(i, r)| ring(r, &At::Item(at, i))).collect()
}

/// Lists in lists down to the first number.
fn depth(value: &Value) -> usize {
    match value {
        Value::Array(list) => 1 + list.first().map_or(0, depth),
        _ => 0,
    }
}

/// What has been found so far.
#[derive(Default)]
struct Found {
    /// Each a list of rings.
    polygons: Vec<Vec<Ring>>,
    /// What else there was, by its type.
    skipped: BTreeMap<&'static str, usize>,
}

impl Found {
    fn named(&mut self, object: &Map<String, Value>, at: &At) -> Result<(), PolygonsError> {
        if let Some(value) = object.get("rings") {
            self.polygons.push(rings(value, &At::Key(at, "rings"))?);
        }
        if let Some(value) = object.get("polygons") {
            self.polygons(value, &At::Key(at, "polygons"))?;
        }
        Ok(())
    }

    /// Lists without a name: how deep they are says what they are.
    fn list(&mut self, value: &Value, at: &At) -> Result<(), PolygonsError> {
        match depth(value) {
            0 | 1 => return Err(expected(at, RING, value)),
            2 => self.polygons.push(vec![ring(value, at)?]),
            3 => self.polygons.push(rings(value, at)?),
            _ => self.polygons(value, at)?,
        }
        Ok(())
    }

    fn polygons(&mut self, value: &Value, at: &At) -> Result<(), PolygonsError> {
        for (i, polygon) in items(value, at, POLYGONS)?.iter().enumerate() {
            self.polygons.push(rings(polygon, &At::Item(at, i))?);
        }
        Ok(())
    }

    /// Any object of GeoJSON. The parser has limited how deep they nest.
    fn geojson(&mut self, object: &Map<String, Value>, at: &At) -> Result<(), PolygonsError> {
        let kind = object.get("type").and_then(Value::as_str).unwrap_or("");
        match kind {
            "Polygon" => {
                let (value, at) = coordinates(object, at)?;
                self.polygons.push(rings(value, &at)?);
            }
            "MultiPolygon" => {
                let (value, at) = coordinates(object, at)?;
                self.polygons(value, &at)?;
            }
            "Feature" => match object.get("geometry") {
                None | Some(Value::Null) => self.skip("Feature without a geometry"),
                Some(value) => self.member(value, &At::Key(at, "geometry"))?,
            },
            "FeatureCollection" => self.members(object, "features", at)?,
            "GeometryCollection" => self.members(object, "geometries", at)?,
            "Point" => self.skip("Point"),
            "MultiPoint" => self.skip("MultiPoint"),
            "LineString" => self.skip("LineString"),
            "MultiLineString" => self.skip("MultiLineString"),
            other => {
                return Err(PolygonsError::Type {
                    at: at.to_string(),
                    found: other.chars().take(40).collect(),
                });
            }
        }
        Ok(())
    }

    fn members(
        &mut self,
        object: &Map<String, Value>,
        key: &'static str,
        at: &At,
    ) -> Result<(), PolygonsError> {
        let list = object.get(key).ok_or_else(|| PolygonsError::Missing {
            at: at.to_string(),
            key,
            expected: "a list, even if it is empty",
        })?;
        let at = At::Key(at, key);
        for (i, value) in items(list, &at, "a list")?.iter().enumerate() {
            self.member(value, &At::Item(&at, i))?;
        }
        Ok(())
    }

    fn member(&mut self, value: &Value, at: &At) -> Result<(), PolygonsError> {
        let object = value.as_object();
        let object = object.ok_or_else(|| expected(at, "an object of GeoJSON", value))?;
        self.geojson(object, at)
    }

    fn skip(&mut self, kind: &'static str) {
        *self.skipped.entry(kind).or_default() += 1;
    }

    /// Each polygon cleaned, then all united.
    fn united(self) -> Result<Outlines, PolygonsError> {
        if self.polygons.is_empty() {
            let kinds = self.skipped.iter().map(|(kind, n)| format!("{n} {kind}"));
            let found = kinds.collect::<Vec<_>>().join(", ");
            return Err(PolygonsError::NoPolygon { found });
        }
        let mut repairs = Repairs::default();
        let mut united: Vec<Ring> = Vec::new();
        for rings in &self.polygons {
            match Regions::from_rings_reporting(rings, FillRule::EvenOdd) {
                Ok((regions, found)) => {
                    repairs = repairs.and(found);
                    united.extend(regions.rings().map(|r| r.points().to_vec()));
                }
                Err(RegionsError::Empty) => repairs.flat += rings.len().max(1),
                Err(error) => return Err(error.into()),
            }
        }
        let regions = Regions::from_rings(&united, FillRule::NonZero)?;
        let mut notes = ImportNote::of_repairs(&repairs, FillRule::EvenOdd);
        notes.extend(self.skipped.iter().map(|(kind, &count)| {
            let kind = (*kind).to_owned();
            ImportNote::Skipped { kind, count }
        }));
        Ok(Outlines {
            extent: regions.bounds(),
            regions,
            notes,
        })
    }
}

fn coordinates<'v, 'a>(
    object: &'v Map<String, Value>,
    at: &'a At<'a>,
) -> Result<(&'v Value, At<'a>), PolygonsError> {
    let key = "coordinates";
    let missing = || PolygonsError::Missing {
        at: at.to_string(),
        key,
        expected: RINGS,
    };
    let value = object.get(key).ok_or_else(missing)?;
    Ok((value, At::Key(at, key)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "[[0,0],[4,0],[4,4],[0,4],[0,0]]";
    const HOLE: &str = "[[1,1],[3,1],[3,3],[1,3]]";

    fn area(text: &str) -> f64 {
        read(text).expect(text).regions.area()
    }

    fn error(text: &str) -> String {
        read(text).err().expect(text).to_string()
    }

    #[test]
    fn every_plain_form_is_read() {
        for (text, expected) in [
            (SQUARE.to_owned(), 16.0),
            (format!("[{SQUARE}, {HOLE}]"), 12.0),
            (format!("[[{SQUARE}, {HOLE}], [{HOLE}]]"), 16.0),
            (
                format!("{{\"name\": \"a\", \"rings\": [{SQUARE}, {HOLE}]}}"),
                12.0,
            ),
            (format!("{{\"polygons\": [[{SQUARE}], [{HOLE}]]}}"), 16.0),
        ] {
            assert!((area(&text) - expected).abs() < 1e-9, "{text}");
            assert_eq!(read(&text).expect("read").notes, [], "{text}");
        }
    }

    #[test]
    fn geojson_polygons_are_found_wherever_they_lie() {
        let polygon = format!("{{\"type\": \"Polygon\", \"coordinates\": [{SQUARE}, {HOLE}]}}");
        let multi =
            format!("{{\"type\": \"MultiPolygon\", \"coordinates\": [[{SQUARE}],[{HOLE}]]}}");
        let point = "{\"type\": \"Point\", \"coordinates\": [1, 2, 3]}";
        let both =
            format!("{{\"type\": \"GeometryCollection\", \"geometries\": [{polygon}, {point}]}}");
        let feature = |geometry: &str| {
            format!("{{\"type\": \"Feature\", \"properties\": {{}}, \"geometry\": {geometry}}}")
        };
        let all = [feature(&both), feature("null"), feature(point)].join(",");
        let collection = format!("{{\"type\": \"FeatureCollection\", \"features\": [{all}]}}");
        assert!((area(&polygon) - 12.0).abs() < 1e-9);
        assert!((area(&multi) - 16.0).abs() < 1e-9);
        assert!((area(&both) - 12.0).abs() < 1e-9);
        assert!((area(&collection) - 12.0).abs() < 1e-9);
        let notes = read(&collection).expect("read").notes;
        let words: Vec<_> = notes.iter().map(ToString::to_string).collect();
        assert_eq!(
            words,
            [
                "1 object of the kind Feature without a geometry was left out",
                "2 objects of the kind Point were left out",
            ]
        );
    }

    #[test]
    fn repairs_are_told() {
        let bow = "[[0,0],[2,2],[2,0],[0,2]]";
        let found = read(&format!("[{bow}, {SQUARE}, {SQUARE}, [[1,1],[2,2]]]")).expect("read");
        let words: Vec<_> = found.notes.iter().map(ToString::to_string).collect();
        assert_eq!(
            words[0],
            "1 crossing of edges was resolved by the even-odd rule"
        );
        assert!(
            words
                .iter()
                .any(|w| w == "1 outline drawn again was left out"),
            "{words:?}"
        );
        assert!(
            words.iter().any(|w| w.contains("encloses nothing")),
            "{words:?}"
        );
    }

    #[test]
    fn each_fault_is_named_with_its_path() {
        for (text, words) in [
            ("[]", "$ is an empty list; give a ring"),
            ("[1, 2]", "$ is a list; give a ring"),
            ("[[0,0],[1,0],[1]]", "$[2] is a list; give a point"),
            (
                "[[0,0],[1,\"a\"],[1,1]]",
                "$[1] is a text; give two numbers",
            ),
            (
                "[[0,0],[1,1e70],[1,1]]",
                "$[1] is a number; give two numbers",
            ),
            ("[[0,0],[1,1e999],[1,1]]", "line 1, column"),
            (
                "{\"rings\": 4}",
                "$.rings is a number; give a list of rings",
            ),
            ("{\"type\": \"Polygon\"}", "$ has no \"coordinates\""),
            ("{\"type\": 7}", "$ is of the type \"\""),
            (
                "{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\", \"geometry\": {\"type\": \"Polygon\", \"coordinates\": [[[0,0],[1,0],7]]}}]}",
                "$.features[0].geometry.coordinates[0][2] is a number; give a point",
            ),
            (
                "{\"type\": \"LineString\", \"coordinates\": []}",
                "there is no polygon in the file, only 1 LineString",
            ),
            ("[[0,0],[1,1],[2,2]]", "enclose no area"),
            (
                &"[".repeat(5000),
                "line 1, column 128: recursion limit exceeded",
            ),
        ] {
            assert!(error(text).contains(words), "{text:.40}: {}", error(text));
        }
    }
}
