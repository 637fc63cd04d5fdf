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
//! collections, in the fill that a feature's properties may name; points and lines
//! are left out, which is told. Coordinates
//! are taken as they are, x to the right and y up, longitude and latitude
//! included; more than two numbers of a point are not looked at.
//!
//! Within a polygon (or a list of rings) the even-odd rule says what is
//! inside, so that rings in rings are holes whichever way they run; an
//! outline drawn twice counts once. Polygons are united.
//!
//! Errors name the place as a path into the document.

mod value;

pub use value::{PolygonsFault, PolygonsImportError};

use super::form::ImportedOutlines;
use super::json_error::JsonError;
use super::note::{ImportNote, OtherKinds};
use super::paint_layer::PaintLayer;
use crate::colour::{Paint, Rgb};
use crate::geometry::{FillRule, Regions, RegionsError, Repairs};
use serde_json::Value;
use std::collections::BTreeMap;
use value::{
    JsonRing, MAX_OBJECTS, RING, RINGS, depth, polygons, read_list, read_member, ring, rings,
    type_mismatch,
};

/// Reads plain polygons or GeoJSON.
pub(super) fn read(text: &str) -> Result<ImportedOutlines, PolygonsImportError> {
    if text.matches('{').count() > MAX_OBJECTS {
        return Err(PolygonsImportError::TooManyObjects);
    }
    let value: Value = serde_json::from_str(text).map_err(JsonError::from)?;
    let mut found = PolygonCollector::default();
    match &value {
        Value::Object(object) if object.contains_key("type") => found.geojson(&value)?,
        Value::Object(_) => found.named(&value)?,
        _ => found.list(&value)?,
    }
    // What was found is a copy, and uniting takes room of its own.
    drop(value);
    found.united()
}

/// What a feature is painted with: `fill` and `fill-opacity` of its properties, as
/// simplestyle has them (Mapbox, version 1.1), and the `layer` or `name` it has.
#[derive(Clone, Default, PartialEq)]
struct FeatureStyle {
    paint: Option<Paint>,
    name: String,
}

impl FeatureStyle {
    fn of(properties: &Value) -> Self {
        let text = |key: &str| properties[key].as_str();
        let fill = text("fill").and_then(colour);
        let opacity = properties["fill-opacity"].as_f64().unwrap_or(1.0);
        let name = text("layer").or_else(|| text("name"));
        // What is only to be outlined has no paint to be seen in.
        let fill = fill.filter(|_| opacity > 0.0);
        Self {
            paint: fill.map(|colour| Paint {
                colour,
                opacity: opacity.clamp(0.0, 1.0),
            }),
            name: name.unwrap_or_default().to_owned(),
        }
    }
}

/// Of three or six digits, with or without the sign of a number.
fn colour(text: &str) -> Option<Rgb> {
    let digits = text.trim_start_matches('#');
    let doubled = |digits: &str| digits.chars().flat_map(|digit| [digit; 2]).collect();
    let six = match digits.len() {
        3 => doubled(digits),
        _ => digits.to_owned(),
    };
    format!("#{six}").parse().ok()
}

/// What has been found so far.
#[derive(Default)]
struct PolygonCollector {
    /// Each a list of rings.
    polygons: Vec<Vec<JsonRing>>,
    /// For each polygon what it is painted with.
    inks: Vec<FeatureStyle>,
    /// What else there was, by its type.
    skipped: BTreeMap<String, usize>,
}

impl PolygonCollector {
    fn named(&mut self, object: &Value) -> Result<(), PolygonsImportError> {
        self.polygons.extend(read_member(object, "rings", rings)?);
        let all = read_member(object, "polygons", polygons)?;
        self.polygons.extend(all.into_iter().flatten());
        Ok(())
    }

    /// Lists without a name: how deep they are says what they are.
    fn list(&mut self, list: &Value) -> Result<(), PolygonsImportError> {
        match depth(list) {
            0 | 1 => return Err(type_mismatch(RING, list)),
            2 => self.polygons.push(vec![ring(list)?]),
            3 => self.polygons.push(rings(list)?),
            _ => self.polygons.extend(polygons(list)?),
        }
        Ok(())
    }

    /// Any object of GeoJSON. The parser has limited how deep they nest.
    fn geojson(&mut self, object: &Value) -> Result<(), PolygonsImportError> {
        if !object.is_object() {
            return Err(type_mismatch("an object of GeoJSON", object));
        }
        let coordinates = PolygonsFault::Missing {
            key: "coordinates",
            expected: RINGS,
        };
        let kind = object["type"].as_str().unwrap_or("");
        match kind {
            "Polygon" => {
                let rings = read_member(object, "coordinates", rings)?;
                self.polygons.push(rings.ok_or(coordinates)?);
            }
            "MultiPolygon" => {
                let all = read_member(object, "coordinates", polygons)?;
                self.polygons.extend(all.ok_or(coordinates)?);
            }
            "Feature" => {
                // What stood outside of features has no paint.
                self.inks
                    .resize(self.polygons.len(), FeatureStyle::default());
                let ink = FeatureStyle::of(&object["properties"]);
                self.feature(&object["geometry"])?;
                self.inks.resize(self.polygons.len(), ink);
            }
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

    fn feature(&mut self, geometry: &Value) -> Result<(), PolygonsImportError> {
        if geometry.is_null() {
            self.skip("Feature without a geometry");
            return Ok(());
        }
        let read = self.geojson(geometry);
        read.map_err(|error| error.within(".geometry"))
    }

    fn members(&mut self, object: &Value, key: &'static str) -> Result<(), PolygonsImportError> {
        let read = |list: &Value| read_list(list, "a list", |value| self.geojson(value));
        let expected = "a list, even if it is empty";
        let missing = PolygonsFault::Missing { key, expected };
        read_member(object, key, read)?.ok_or(missing)?;
        Ok(())
    }

    fn skip(&mut self, kind: &str) {
        *self.skipped.entry(kind.to_owned()).or_default() += 1;
    }

    /// Each polygon cleaned, then all united.
    fn united(self) -> Result<ImportedOutlines, PolygonsImportError> {
        if self.polygons.is_empty() {
            return Err(PolygonsImportError::NoPolygon(OtherKinds(self.skipped)));
        }
        let mut repairs = Repairs::default();
        let mut united: Vec<JsonRing> = Vec::new();
        let mut nothing = RegionsError::Empty;
        let mut inked: Vec<(FeatureStyle, Vec<JsonRing>)> = Vec::new();
        for (k, rings) in self.polygons.iter().enumerate() {
            // Each by itself, for under this rule two that overlap would leave a hole.
            match Regions::from_rings_reporting(rings, FillRule::EvenOdd) {
                Ok((regions, found)) => {
                    repairs = repairs.and(found);
                    let rings = regions.rings().map(|r| r.points().to_vec());
                    let rings: Vec<JsonRing> = rings.collect();
                    let ink = self.inks.get(k).cloned().unwrap_or_default();
                    match inked.last_mut().filter(|(last, _)| *last == ink) {
                        Some((_, own)) => own.extend(rings.clone()),
                        None => inked.push((ink, rings.clone())),
                    }
                    united.extend(rings);
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
        Ok(ImportedOutlines {
            coats: coats(inked),
            extent: regions.bounds(),
            regions,
            notes,
        })
    }
}

/// Features that follow each other in one paint, as a map draws them: the first
/// at the bottom. None where none has a colour of its own.
fn coats(inked: Vec<(FeatureStyle, Vec<JsonRing>)>) -> Vec<PaintLayer> {
    if inked.iter().all(|(ink, _)| ink.paint.is_none()) {
        return Vec::new();
    }
    let coat = |(ink, rings): (FeatureStyle, Vec<JsonRing>)| {
        let regions = Regions::from_rings(&rings, FillRule::NonZero).ok()?;
        Some(PaintLayer {
            regions,
            paint: ink.paint,
            gradient: None,
            line: None,
            name: ink.name,
            is_text: false,
        })
    };
    inked.into_iter().filter_map(coat).collect()
}

#[cfg(test)]
mod tests;
