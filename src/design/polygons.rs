//! Importer of polygons in plain JSON and in GeoJSON (Butler et al., RFC 7946, 2016).
//!
//! Plain JSON has one of these structures:
//!
//! ```json
//! [[0, 0], [4, 0], [0, 3]]
//! [[[0, 0], [4, 0], [0, 3]], [[1, 1], [2, 1], [1, 2]]]
//! [[[[0, 0], [4, 0], [0, 3]], [[1, 1], [2, 1], [1, 2]]], [[[5, 0], [6, 0], [5, 1]]]]
//! {"rings": [[[0, 0], [4, 0], [0, 3]]]}
//! {"polygons": [[[[0, 0], [4, 0], [0, 3]]]]}
//! ```
//!
//! In this order, they are a ring of points; a list of rings; a list of polygons, each a list of
//! rings; and a list of rings and a list of polygons as named members of an object. A ring may
//! repeat its first point at the end.
//!
//! GeoJSON polygons are imported at any nesting depth of features and collections. The properties
//! of a feature give its fill colour and its name, by which it is matched. Points and lines are
//! ignored and reported as notes. Coordinates, even longitude and latitude, are used unchanged with
//! x to the right and y up, except at the antimeridian (see [`antimeridian`]); numbers after the
//! first two of a point are ignored.
//!
//! Within a polygon or list of rings the even-odd rule decides what is inside, so nested rings are
//! holes regardless of orientation, and duplicate outlines count once. Polygons are united. Errors
//! give the position as a path in the document, such as `$.features[2].geometry`.

mod antimeridian;
mod value;

pub use value::{PolygonsFault, PolygonsImportError};

use super::form::ImportedOutlines;
use super::json_error::JsonError;
use super::note::{ImportNote, OtherKinds};
use super::paint_layer::PaintLayer;
use crate::colour::{Paint, Rgb};
use crate::geometry::{FillRule, Regions, RegionsError, Repairs};
use antimeridian::join_at_antimeridian;
use serde_json::Value;
use std::collections::BTreeMap;
use value::{
    JsonRing, MAX_OBJECTS, RING, RINGS, depth, polygons, read_list, read_member, ring, rings,
    type_mismatch,
};

/// Imports plain polygons or GeoJSON.
///
/// # Errors
/// Returns a [`PolygonsImportError`] that names the value that cannot be used.
pub(super) fn read(text: &str) -> Result<ImportedOutlines, PolygonsImportError> {
    if text.matches('{').count() > MAX_OBJECTS {
        return Err(PolygonsImportError::TooManyObjects);
    }
    let value: Value = serde_json::from_str(text).map_err(JsonError::from)?;
    let mut collector = PolygonCollector::default();
    match &value {
        Value::Object(object) if object.contains_key("type") => {
            collector.geojson(&value)?;
            collector.notes = join_at_antimeridian(&mut collector.polygons);
        }
        Value::Object(_) => collector.read_named_members(&value)?,
        _ => collector.list(&value)?,
    }
    // Frees the parsed document before the union needs memory; the collector has copied the
    // polygons.
    drop(value);
    collector.into_outlines()
}

/// Properties that name a feature, the most specific first; upper and lower case count as equal.
const NAME_KEYS: [&str; 4] = ["layer", "name", "title", "id"];

/// Style of a feature: the paint from the properties `fill` and `fill-opacity` of the simplestyle
/// specification (Mapbox, version 1.1), the name from the first of [`NAME_KEYS`] among the
/// properties, otherwise from the member `id` of the feature.
#[derive(Clone, Default, PartialEq)]
struct FeatureStyle {
    paint: Option<Paint>,
    name: String,
}

impl FeatureStyle {
    /// Reads the style of a feature.
    fn of(feature: &Value) -> Self {
        let properties = &feature["properties"];
        let fill = properties["fill"].as_str().and_then(colour);
        let opacity = properties["fill-opacity"].as_f64().unwrap_or(1.0);
        let property = |key: &&str| {
            let mut all = properties.as_object()?.iter();
            all.find_map(|(own, value)| own.eq_ignore_ascii_case(key).then(|| name_of(value))?)
        };
        let name = NAME_KEYS.iter().find_map(property);
        let name = name.or_else(|| name_of(&feature["id"]));
        // A fully transparent fill marks a feature that has an outline only.
        let fill = fill.filter(|_| opacity > 0.0);
        Self {
            paint: fill.map(|colour| Paint {
                colour,
                opacity: opacity.clamp(0.0, 1.0),
            }),
            name: name.unwrap_or_default(),
        }
    }
}

/// Returns the name that a value gives: a string that is not blank, or a number.
fn name_of(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => (!text.trim().is_empty()).then(|| text.trim().to_owned()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    }
}

/// Parses a colour of three or six hexadecimal digits, with or without `#`.
fn colour(text: &str) -> Option<Rgb> {
    let digits = text.trim_start_matches('#');
    let doubled = |digits: &str| digits.chars().flat_map(|digit| [digit; 2]).collect();
    let six_digits = match digits.len() {
        3 => doubled(digits),
        _ => digits.to_owned(),
    };
    format!("#{six_digits}").parse().ok()
}

/// Polygons and their styles, collected while the document is traversed.
#[derive(Default)]
struct PolygonCollector {
    /// Polygons, each a list of rings.
    polygons: Vec<Vec<JsonRing>>,
    /// Style of each polygon. May be shorter than `polygons`; the remaining polygons have no style.
    inks: Vec<FeatureStyle>,
    /// For each type of object that was ignored: the number of its objects.
    skipped: BTreeMap<String, usize>,
    /// Changes made to polygons in longitudes and latitudes.
    notes: Vec<ImportNote>,
}

impl PolygonCollector {
    /// Reads plain JSON whose lists are the members `rings` and `polygons` of an object.
    fn read_named_members(&mut self, object: &Value) -> Result<(), PolygonsImportError> {
        self.polygons.extend(read_member(object, "rings", rings)?);
        let all = read_member(object, "polygons", polygons)?;
        self.polygons.extend(all.into_iter().flatten());
        Ok(())
    }

    /// Reads an unnamed list. The nesting depth of the list decides its structure.
    fn list(&mut self, list: &Value) -> Result<(), PolygonsImportError> {
        match depth(list) {
            0 | 1 => return Err(type_mismatch(RING, list)),
            2 => self.polygons.push(vec![ring(list)?]),
            3 => self.polygons.push(rings(list)?),
            _ => self.polygons.extend(polygons(list)?),
        }
        Ok(())
    }

    /// Reads any GeoJSON object recursively. The JSON parser limits the nesting depth.
    fn geojson(&mut self, object: &Value) -> Result<(), PolygonsImportError> {
        if !object.is_object() {
            return Err(type_mismatch("a GeoJSON object", object));
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
                // Polygons outside of features get no style.
                self.inks
                    .resize(self.polygons.len(), FeatureStyle::default());
                let style = FeatureStyle::of(object);
                self.feature(&object["geometry"])?;
                self.inks.resize(self.polygons.len(), style);
            }
            "FeatureCollection" => self.members(object, "features")?,
            "GeometryCollection" => self.members(object, "geometries")?,
            "Point" | "MultiPoint" | "LineString" | "MultiLineString" => self.skip(kind),
            other => {
                let shortened = other.chars().take(40).collect();
                return Err(PolygonsFault::Type(shortened).into());
            }
        }
        Ok(())
    }

    /// Reads the geometry of a feature.
    fn feature(&mut self, geometry: &Value) -> Result<(), PolygonsImportError> {
        if geometry.is_null() {
            self.skip("Feature without a geometry");
            return Ok(());
        }
        let read = self.geojson(geometry);
        read.map_err(|error| error.within(".geometry"))
    }

    /// Reads the GeoJSON objects in the member `key`, which must be a list.
    fn members(&mut self, object: &Value, key: &'static str) -> Result<(), PolygonsImportError> {
        let read = |list: &Value| read_list(list, "a list", |value| self.geojson(value));
        let expected = "a list, even if it is empty";
        let missing = PolygonsFault::Missing { key, expected };
        read_member(object, key, read)?.ok_or(missing)?;
        Ok(())
    }

    /// Counts one ignored object of the type `kind`.
    fn skip(&mut self, kind: &str) {
        *self.skipped.entry(kind.to_owned()).or_default() += 1;
    }

    /// Repairs each polygon, unites all polygons and groups them by style into paint layers.
    fn into_outlines(self) -> Result<ImportedOutlines, PolygonsImportError> {
        if self.polygons.is_empty() {
            return Err(PolygonsImportError::NoPolygon(OtherKinds(self.skipped)));
        }
        let mut repairs = Repairs::default();
        let mut united: Vec<JsonRing> = Vec::new();
        let mut empty_error = RegionsError::Empty;
        let mut styled: Vec<(FeatureStyle, Vec<JsonRing>)> = Vec::new();
        for (k, rings) in self.polygons.iter().enumerate() {
            // Each polygon is repaired separately: under the even-odd rule, polygons that overlap
            // would leave a hole.
            match Regions::from_rings_reporting(rings, FillRule::EvenOdd) {
                Ok((regions, own_repairs)) => {
                    repairs = repairs.merged_with(own_repairs);
                    let rings = regions.rings().map(|r| r.points().to_vec());
                    let rings: Vec<JsonRing> = rings.collect();
                    let style = self.inks.get(k).cloned().unwrap_or_default();
                    match styled.last_mut().filter(|(last, _)| *last == style) {
                        Some((_, own)) => own.extend(rings.clone()),
                        None => styled.push((style, rings.clone())),
                    }
                    united.extend(rings);
                }
                // A polygon without any ring counts as one empty outline.
                Err(error @ (RegionsError::Empty | RegionsError::Size(_))) => {
                    repairs.flat += rings.len().max(1);
                    empty_error = error;
                }
                Err(error) => return Err(error.into()),
            }
        }
        if united.is_empty() {
            return Err(empty_error.into());
        }
        let regions = Regions::from_rings(&united, FillRule::NonZero)?;
        let mut notes = self.notes;
        notes.extend(ImportNote::from_repairs(&repairs, FillRule::EvenOdd));
        notes.extend(ImportNote::from_skipped(self.skipped));
        Ok(ImportedOutlines {
            drawn_colour: None,
            paint_layers: layers_by_style(styled),
            extent: regions.bounds(),
            regions,
            notes,
        })
    }
}

/// Returns one paint layer for each entry of `styled`, a run of consecutive features with the same
/// style. The first run is at the bottom. Returns no layers if no feature has a colour or a name.
fn layers_by_style(styled: Vec<(FeatureStyle, Vec<JsonRing>)>) -> Vec<PaintLayer> {
    if styled
        .iter()
        .all(|(style, _)| *style == FeatureStyle::default())
    {
        return Vec::new();
    }
    let layer = |(style, rings): (FeatureStyle, Vec<JsonRing>)| {
        let regions = Regions::from_rings(&rings, FillRule::NonZero).ok()?;
        Some(PaintLayer {
            regions,
            paint: style.paint,
            gradient: None,
            line: None,
            name: style.name,
            is_text: false,
        })
    };
    styled.into_iter().filter_map(layer).collect()
}

#[cfg(test)]
mod tests;
