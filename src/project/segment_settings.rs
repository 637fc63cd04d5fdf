//! Settings of one segment of a project: those that belong to two particular designs.

use crate::correspondence::MatchSettings;
use crate::transition::{CachedMatch, PartTime};
use serde::{Deserialize, Serialize};

/// Settings of the segment from one design to the next.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct SegmentRecord {
    /// Match settings, in the coordinates of the two designs.
    #[serde(rename = "match", skip_serializing_if = "is_default")]
    pub matching: MatchSettings,
    /// Time windows of the parts that have a separate timing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<PartTime>,
    /// Match and motion as they were solved when the project was saved, to be reused on opening it.
    #[serde(skip_serializing_if = "CachedMatch::is_none")]
    pub found: CachedMatch,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
