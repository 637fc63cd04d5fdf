//! What a document says of the map of its designs.

use crate::geometry::DVec2;
use crate::mesh::{NaturalNeighbours, SitesError};
use crate::space::{Likeness, MapLayout, MapPath};
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
    pub kept: Vec<KeptPlace>,
}

/// A blend that is worth keeping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct KeptPlace {
    /// Where it is on the map.
    pub at: DVec2,
    /// What it is called; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// What there is to say about it; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// How good it is: up to [`KeptPlace::MOST_STARS`], none where nobody has said.
    #[serde(default, skip_serializing_if = "is_default")]
    pub stars: u8,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl KeptPlace {
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
    #[error("place {} of the path over the map is not a finite point", .0 + 1)]
    Path(usize),
    /// A kept place is nowhere, or has too many stars.
    #[error(
        "kept place {} is not a finite point with 0 to {} stars", .0 + 1, KeptPlace::MOST_STARS
    )]
    Kept(usize),
}

impl MapSettings {
    /// Where the designs are.
    #[must_use]
    pub fn sites(&self, likeness: &Likeness) -> Vec<DVec2> {
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
        }
        let places = &self.path.places;
        if let Some(nowhere) = places.iter().position(|place| !place.at.is_finite()) {
            return Err(MapError::Path(nowhere));
        }
        let is_sound =
            |kept: &KeptPlace| kept.at.is_finite() && kept.stars <= KeptPlace::MOST_STARS;
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
