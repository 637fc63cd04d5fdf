//! What a document says of two designs alone.

use crate::correspondence::MatchSettings;
use crate::transition::{CachedMatch, PartTime};
use serde::{Deserialize, Serialize};

/// What belongs to the way from one design to the next.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct SegmentRecord {
    /// How the outlines of the two are matched, in the coordinates of each.
    #[serde(rename = "match", skip_serializing_if = "is_default")]
    pub matching: MatchSettings,
    /// Parts that make their way in their own time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<PartTime>,
    /// The film that was found.
    #[serde(skip_serializing_if = "CachedMatch::is_none")]
    pub found: CachedMatch,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
