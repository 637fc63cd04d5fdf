//! What a document says of the map of its designs.

use crate::geometry::DVec2;
use crate::mesh::{NaturalNeighbours, SitesError};
use crate::space::{DesignDistances, MapLayout, MapPath};
use serde::{Deserialize, Serialize};

/// The map of all designs: how they are laid out, the path over it, and the places that
/// are kept. From version 2 on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct MapSettings {
    /// How the designs are laid out, where nobody has put them elsewhere.
    #[serde(skip_serializing_if = "is_default")]
    pub layout: MapLayout,
    /// Where somebody has put them, one for each design; none as the layout has it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sites: Vec<DVec2>,
    /// What the film goes along; where there is none, from design to design.
    #[serde(skip_serializing_if = "is_default")]
    pub path: MapPath,
    /// Blends that are worth keeping.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub kept: Vec<SavedPlace>,
}

/// A blend that is worth keeping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SavedPlace {
    /// Where it is on the map.
    pub at: DVec2,
    /// What it is called; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// What there is to say about it; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// How good it is: up to [`SavedPlace::MOST_STARS`], none where nobody has said.
    #[serde(default, skip_serializing_if = "is_default")]
    pub stars: u8,
}

/// How far a place may be from the middle of the map, whose designs are within one of it.
const FARTHEST: f64 = 100.0;

/// The most places of a path, and the most that are kept: a hand does not click as often.
pub const MOST_PLACES: usize = 500;

fn is_near(place: DVec2) -> bool {
    // None for what is no number.
    place.abs().max_element() <= FARTHEST && place.is_finite()
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl SavedPlace {
    /// Of the best ones.
    pub const MOST_STARS: u8 = 5;

    /// A place without a word about it.
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

/// What is wrong with a map.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// There are not as many sites as designs.
    #[error("the map has {has} sites and there are {designs} designs: give one for each, or none")]
    Sites {
        /// How many it has.
        has: usize,
        /// How many there are to be.
        designs: usize,
    },
    /// Two sites are one, or one is nowhere.
    #[error("the map: {0}")]
    Site(#[from] SitesError),
    /// A place of the path is nowhere.
    #[error("place {} of the path is not on the map, which reaches from -{FARTHEST} to {FARTHEST}", .0 + 1)]
    Path(usize),
    /// There are too many places.
    #[error("a map has up to {MOST_PLACES} kept places, and a path as many: take some out")]
    TooMany,
    /// A kept place is nowhere, or has too many stars.
    #[error(
        "kept place {} is not on the map, or has more than {} stars", .0 + 1, SavedPlace::MOST_STARS
    )]
    Kept(usize),
}

impl MapSettings {
    /// Where the designs are.
    #[must_use]
    pub fn sites(&self, likeness: &DesignDistances) -> Vec<DVec2> {
        match self.sites.len() == likeness.count() {
            true => self.sites.clone(),
            false => self.layout.sites(likeness),
        }
    }

    /// That it is a map of so many designs.
    pub(super) fn check(&self, designs: usize) -> Result<(), MapError> {
        if !self.sites.is_empty() {
            let has = self.sites.len();
            if has != designs {
                return Err(MapError::Sites { has, designs });
            }
            NaturalNeighbours::new(&self.sites)?;
            if let Some(far) = self.sites.iter().position(|site| !is_near(*site)) {
                return Err(SitesError::NotFinite(far).into());
            }
        }
        let places = &self.path.places;
        if let Some(nowhere) = places.iter().position(|place| !is_near(place.at)) {
            return Err(MapError::Path(nowhere));
        }
        if places.len().max(self.kept.len()) > MOST_PLACES {
            return Err(MapError::TooMany);
        }
        let is_sound = |kept: &SavedPlace| is_near(kept.at) && kept.stars <= SavedPlace::MOST_STARS;
        match self.kept.iter().position(|kept| !is_sound(kept)) {
            Some(bad) => Err(MapError::Kept(bad)),
            None => Ok(()),
        }
    }

    /// Whether a film is the same by both: it is where nobody goes over the map, and names
    /// and kept places are not in it.
    #[must_use]
    pub fn plays_as(&self, other: &Self) -> bool {
        let way = |map: &Self| -> Vec<_> {
            // One place is no path yet.
            let places = map.path.places.iter().filter(|_| !map.path.is_none());
            places.map(|place| (place.at, place.passed)).collect()
        };
        let (own, its) = (way(self), way(other));
        own == its && (own.is_empty() || (self.layout, &self.sites) == (other.layout, &other.sites))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::Project;

    fn refused(map: &str) -> String {
        let text = format!(
            "version = 2\n[[designs]]\npath = \"a.svg\"\n[[designs]]\npath = \"b.svg\"\n{map}"
        );
        match Project::parse(&text) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn a_map_that_is_none_is_named() {
        for (map, said) in [
            ("[map]\nsites = [[0.0, 0.0]]", "1 sites"),
            ("[map]\nsites = [[0.0, 0.0], [0.0, 0.0]]", "one place"),
            ("[map]\nsites = [[0.0, 0.0], [nan, 0.0]]", "finite"),
            ("[map]\nsites = [[0.0, 0.0], [1e300, 0.0]]", "finite"),
            ("[map]\nlayout = \"circle\"", "line 7"),
            ("[map.path]\nplaces = [{ at = [0.0, inf] }]", "place 1"),
            (
                "[map.path]\nplaces = [{ at = [0.0, 0.0], to = 1 }]",
                "line 7",
            ),
            ("[[map.kept]]\nat = [0.0, 0.0]\nstars = 6", "kept place 1"),
            ("[[map.kept]]\nat = [0.0, 0.0]\nstars = -1", "line"),
        ] {
            let error = refused(map);
            assert!(error.contains(said), "{map}: {error}");
        }
        let many = "{ at = [0.0, 0.0] },".repeat(MOST_PLACES + 1);
        let error = refused(&format!("[map.path]\nplaces = [{many}]"));
        assert!(error.contains("up to 500"), "{error}");
        assert_eq!(refused("[map.path]\nplaces = [{ at = [0.0, 0.0] }]"), "");
    }

    #[test]
    fn films_that_look_alike_are_known() {
        let path = |name: &str, places: usize| MapSettings {
            path: MapPath {
                name: name.to_owned(),
                places: vec![crate::space::Waypoint::stop(DVec2::ZERO); places],
            },
            ..MapSettings::default()
        };
        assert!(path("a", 2).plays_as(&path("b", 2)));
        assert!(path("", 1).plays_as(&MapSettings::default()));
        assert!(!path("", 2).plays_as(&path("", 3)));
        let line = |map: MapSettings| MapSettings {
            layout: MapLayout::Line,
            ..map
        };
        assert!(!path("", 2).plays_as(&line(path("", 2))));
        assert!(MapSettings::default().plays_as(&line(MapSettings::default())));
    }
}
