//! Map settings of a project: layout, path and saved blends.

use crate::geometry::DVec2;
use crate::mesh::{NaturalNeighbours, SitesError};
use crate::space::{DesignDistances, MapLayout, MapPath};
use serde::{Deserialize, Serialize};

/// Map of all designs: their layout, the path over the map, and saved blends. Stored from format
/// version 2 on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct MapSettings {
    /// Automatic layout of the designs, used unless `sites` are given.
    #[serde(skip_serializing_if = "is_default")]
    pub layout: MapLayout,
    /// Manually chosen sites (positions of the designs on the map), one per design; empty for the
    /// automatic layout.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sites: Vec<DVec2>,
    /// Path that the film follows; if it is empty, the film goes from design to design.
    #[serde(skip_serializing_if = "is_default")]
    pub path: MapPath,
    /// Saved blends.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub kept: Vec<SavedBlend>,
}

/// A saved blend: a place on the map with a name, a note and a rating.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SavedBlend {
    /// Position on the map.
    pub at: DVec2,
    /// Name; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Note; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// Rating from 1 to [`SavedBlend::MOST_STARS`]; 0 if unrated.
    #[serde(default, skip_serializing_if = "is_default")]
    pub stars: u8,
}

/// Maximum absolute value of a coordinate on the map (resource limit: automatic layouts lie within
/// the unit circle).
const MAX_COORDINATE: f64 = 100.0;

/// Maximum number of places of a path, and maximum number of saved blends (resource limit: far more
/// than anyone sets by hand).
pub const MAX_PLACES: usize = 500;

/// Returns whether a place has finite coordinates within the allowed range.
fn is_on_map(place: DVec2) -> bool {
    place.abs().max_element() <= MAX_COORDINATE && place.is_finite()
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl SavedBlend {
    /// Highest rating.
    pub const MOST_STARS: u8 = 5;

    /// Creates a saved blend without name, note and rating.
    #[must_use]
    pub fn new(at: DVec2) -> Self {
        Self {
            at,
            name: String::new(),
            note: String::new(),
            stars: 0,
        }
    }
}

/// Error in the map settings of a project.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// The number of sites differs from the number of designs.
    #[error("the map has {has} sites for {designs} designs; give one for each design, or none")]
    Sites {
        /// Number of sites.
        has: usize,
        /// Number of designs.
        designs: usize,
    },
    /// Two sites coincide, or one is not finite.
    #[error("the map: {0}")]
    Site(#[from] SitesError),
    /// The place of the path with this index lies outside the map.
    #[error("place {} of the path lies outside the map; use coordinates from -{MAX_COORDINATE} to {MAX_COORDINATE}", .0 + 1)]
    PathPlace(usize),
    /// The path has more than [`MAX_PLACES`] places, or there are more than [`MAX_PLACES`] saved
    /// blends.
    #[error(
        "a map can have at most {MAX_PLACES} saved blends and {MAX_PLACES} places on its path; remove some"
    )]
    TooMany,
    /// The saved blend with this index lies outside the map, or has too many stars.
    #[error(
        "saved blend {} lies outside the map, or has more than {} stars", .0 + 1, SavedBlend::MOST_STARS
    )]
    SavedBlend(usize),
}

impl MapSettings {
    /// Returns the sites of the designs: the manually chosen ones, or those of the automatic
    /// layout.
    #[must_use]
    pub fn sites(&self, distances: &DesignDistances) -> Vec<DVec2> {
        match self.sites.len() == distances.count() {
            true => self.sites.clone(),
            false => self.layout.sites(distances),
        }
    }

    /// Checks that the settings are valid for the given number of designs.
    pub(super) fn check(&self, designs: usize) -> Result<(), MapError> {
        if !self.sites.is_empty() {
            let has = self.sites.len();
            if has != designs {
                return Err(MapError::Sites { has, designs });
            }
            NaturalNeighbours::new(&self.sites)?;
            if let Some(index) = self.sites.iter().position(|site| !is_on_map(*site)) {
                return Err(SitesError::NotFinite(index).into());
            }
        }
        let places = &self.path.places;
        if let Some(index) = places.iter().position(|place| !is_on_map(place.at)) {
            return Err(MapError::PathPlace(index));
        }
        if places.len().max(self.kept.len()) > MAX_PLACES {
            return Err(MapError::TooMany);
        }
        let is_valid =
            |saved: &SavedBlend| is_on_map(saved.at) && saved.stars <= SavedBlend::MOST_STARS;
        match self.kept.iter().position(|saved| !is_valid(saved)) {
            Some(index) => Err(MapError::SavedBlend(index)),
            None => Ok(()),
        }
    }

    /// Returns whether the film is the same with these settings as with `other`.
    ///
    /// Without a path, the film does not depend on the map at all. With a path, names and saved
    /// blends do not affect it.
    #[must_use]
    pub fn has_same_film(&self, other: &Self) -> bool {
        let path_places = |map: &Self| -> Vec<_> {
            // A single place does not form a path.
            let places = map.path.places.iter().filter(|_| !map.path.is_too_short());
            places.map(|place| (place.at, place.passed)).collect()
        };
        let (places, other_places) = (path_places(self), path_places(other));
        places == other_places
            && (places.is_empty() || (self.layout, &self.sites) == (other.layout, &other.sites))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::Project;

    /// Returns the error for a project with the given map, or an empty string.
    fn error_for(map: &str) -> String {
        let text = format!(
            "version = 2\n[[designs]]\npath = \"a.svg\"\n[[designs]]\npath = \"b.svg\"\n{map}"
        );
        match Project::parse(&text) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn errors_name_the_invalid_part_of_a_map() {
        for (map, expected) in [
            ("[map]\nsites = [[0.0, 0.0]]", "1 sites"),
            ("[map]\nsites = [[0.0, 0.0], [0.0, 0.0]]", "coincide"),
            ("[map]\nsites = [[0.0, 0.0], [nan, 0.0]]", "finite"),
            ("[map]\nsites = [[0.0, 0.0], [1e300, 0.0]]", "finite"),
            ("[map]\nlayout = \"circle\"", "line 7"),
            ("[map.path]\nplaces = [{ at = [0.0, inf] }]", "place 1"),
            (
                "[map.path]\nplaces = [{ at = [0.0, 0.0], to = 1 }]",
                "line 7",
            ),
            ("[[map.kept]]\nat = [0.0, 0.0]\nstars = 6", "saved blend 1"),
            ("[[map.kept]]\nat = [0.0, 0.0]\nstars = -1", "line"),
        ] {
            let error = error_for(map);
            assert!(error.contains(expected), "{map}: {error}");
        }
        let many = "{ at = [0.0, 0.0] },".repeat(MAX_PLACES + 1);
        let error = error_for(&format!("[map.path]\nplaces = [{many}]"));
        assert!(error.contains("at most 500"), "{error}");
        assert_eq!(error_for("[map.path]\nplaces = [{ at = [0.0, 0.0] }]"), "");
    }

    #[test]
    fn settings_with_equal_films_are_recognised() {
        let path = |name: &str, places: usize| MapSettings {
            path: MapPath {
                name: name.to_owned(),
                places: vec![crate::space::Waypoint::stop(DVec2::ZERO); places],
            },
            ..MapSettings::default()
        };
        assert!(path("a", 2).has_same_film(&path("b", 2)));
        assert!(path("", 1).has_same_film(&MapSettings::default()));
        assert!(!path("", 2).has_same_film(&path("", 3)));
        let line = |map: MapSettings| MapSettings {
            layout: MapLayout::Line,
            ..map
        };
        assert!(!path("", 2).has_same_film(&line(path("", 2))));
        assert!(MapSettings::default().has_same_film(&line(MapSettings::default())));
    }
}
