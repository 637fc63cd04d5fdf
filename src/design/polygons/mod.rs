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

mod value;

pub use value::{PolygonsError, PolygonsFault};

use super::form::Outlines;
use super::json::JsonError;
use super::note::{ImportNote, OnlyThese};
use crate::geometry::{FillRule, Regions, RegionsError, Repairs};
use serde_json::Value;
use std::collections::BTreeMap;
use value::{MAX_OBJECTS, RING, RINGS, Ring, depth, each, expected, member, polygons, ring, rings};

/// Reads plain polygons or GeoJSON.
pub(super) fn read(text: &str) -> Result<Outlines, PolygonsError> {
    if text.matches('{').count() > MAX_OBJECTS {
        return Err(PolygonsError::TooManyObjects);
    }
    let value: Value = serde_json::from_str(text).map_err(JsonError::from)?;
    let mut found = Found::default();
    match &value {
        Value::Object(object) if object.contains_key("type") => found.geojson(&value)?,
        Value::Object(_) => found.named(&value)?,
        _ => found.list(&value)?,
    }
    // What was found is a copy, and uniting takes room of its own.
    drop(value);
    found.united()
}

/// What has been found so far.
#[derive(Default)]
struct Found {
    /// Each a list of rings.
    polygons: Vec<Vec<Ring>>,
    /// What else there was, by its type.
    skipped: BTreeMap<String, usize>,
}

impl Found {
    fn named(&mut self, object: &Value) -> Result<(), PolygonsError> {
        self.polygons.extend(member(object, "rings", rings)?);
        let all = member(object, "polygons", polygons)?;
        self.polygons.extend(all.into_iter().flatten());
        Ok(())
    }

    /// Lists without a name: how deep they are says what they are.
    fn list(&mut self, list: &Value) -> Result<(), PolygonsError> {
        match depth(list) {
            0 | 1 => return Err(expected(RING, list)),
            2 => self.polygons.push(vec![ring(list)?]),
            3 => self.polygons.push(rings(list)?),
            _ => self.polygons.extend(polygons(list)?),
        }
        Ok(())
    }

    /// Any object of GeoJSON. The parser has limited how deep they nest.
    fn geojson(&mut self, object: &Value) -> Result<(), PolygonsError> {
        if !object.is_object() {
            return Err(expected("an object of GeoJSON", object));
        }
        let coordinates = PolygonsFault::Missing {
            key: "coordinates",
            expected: RINGS,
        };
        let kind = object["type"].as_str().unwrap_or("");
        match kind {
            "Polygon" => {
                let rings = member(object, "coordinates", rings)?;
                self.polygons.push(rings.ok_or(coordinates)?);
            }
            "MultiPolygon" => {
                let all = member(object, "coordinates", polygons)?;
                self.polygons.extend(all.ok_or(coordinates)?);
            }
            "Feature" => match &object["geometry"] {
                Value::Null => self.skip("Feature without a geometry"),
                geometry => {
                    let read = self.geojson(geometry);
                    read.map_err(|error| error.within(".geometry"))?;
                }
            },
            "FeatureCollection" => self.members(object, "features")?,
            "GeometryCollection" => self.members(object, "geometries")?,
            "Point" | "MultiPoint" | "LineString" | "MultiLineString" => self.skip(kind),
            other => {
                let found = other.chars().take(40).collect();
                return Err(PolygonsFault::Type(found).into());
            }
        }
        Ok(())
    }

    fn members(&mut self, object: &Value, key: &'static str) -> Result<(), PolygonsError> {
        let read = |list: &Value| each(list, "a list", |value| self.geojson(value));
        let expected = "a list, even if it is empty";
        let missing = PolygonsFault::Missing { key, expected };
        member(object, key, read)?.ok_or(missing)?;
        Ok(())
    }

    fn skip(&mut self, kind: &str) {
        *self.skipped.entry(kind.to_owned()).or_default() += 1;
    }

    /// Each polygon cleaned, then all united.
    fn united(self) -> Result<Outlines, PolygonsError> {
        if self.polygons.is_empty() {
            return Err(PolygonsError::NoPolygon(OnlyThese(self.skipped)));
        }
        let mut repairs = Repairs::default();
        let mut united: Vec<Ring> = Vec::new();
        let mut nothing = RegionsError::Empty;
        for rings in &self.polygons {
            // Each by itself, for under this rule two that overlap would leave a hole.
            match Regions::from_rings_reporting(rings, FillRule::EvenOdd) {
                Ok((regions, found)) => {
                    repairs = repairs.and(found);
                    united.extend(regions.rings().map(|r| r.points().to_vec()));
                }
                // A polygon without a ring is one thing that encloses nothing.
                Err(error @ (RegionsError::Empty | RegionsError::Size(_))) => {
                    repairs.flat += rings.len().max(1);
                    nothing = error;
                }
                Err(error) => return Err(error.into()),
            }
        }
        if united.is_empty() {
            return Err(nothing.into());
        }
        let regions = Regions::from_rings(&united, FillRule::NonZero)?;
        let mut notes = ImportNote::of_repairs(&repairs, FillRule::EvenOdd);
        notes.extend(ImportNote::of_skipped(self.skipped));
        Ok(Outlines {
            coats: Vec::new(),
            extent: regions.bounds(),
            regions,
            notes,
        })
    }
}

#[cfg(test)]
mod tests;
