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

pub use value::PolygonsError;

use super::form::Outlines;
use super::json::JsonError;
use super::note::{ImportNote, OnlyThese};
use crate::geometry::{FillRule, Regions, RegionsError, Repairs};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use value::{At, POLYGONS, RING, RINGS, Ring, depth, expected, items, required, ring, rings};

/// Reads plain polygons or GeoJSON.
pub(super) fn read(text: &str) -> Result<Outlines, PolygonsError> {
    let value: Value = serde_json::from_str(text).map_err(JsonError::from)?;
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

/// What has been found so far.
#[derive(Default)]
struct Found {
    /// Each a list of rings.
    polygons: Vec<Vec<Ring>>,
    /// What else there was, by its type.
    skipped: BTreeMap<String, usize>,
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
                let (value, at) = required(object, "coordinates", RINGS, at)?;
                self.polygons.push(rings(value, &at)?);
            }
            "MultiPolygon" => {
                let (value, at) = required(object, "coordinates", RINGS, at)?;
                self.polygons(value, &at)?;
            }
            "Feature" => match object.get("geometry") {
                None | Some(Value::Null) => self.skip("Feature without a geometry"),
                Some(value) => self.member(value, &At::Key(at, "geometry"))?,
            },
            "FeatureCollection" => self.members(object, "features", at)?,
            "GeometryCollection" => self.members(object, "geometries", at)?,
            "Point" | "MultiPoint" | "LineString" | "MultiLineString" => self.skip(kind),
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
        let (list, at) = required(object, key, "a list, even if it is empty", at)?;
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
        notes.extend(ImportNote::of_skipped(self.skipped));
        Ok(Outlines {
            extent: regions.bounds(),
            regions,
            notes,
        })
    }
}

#[cfg(test)]
mod tests;
