//! What was found for two designs, as text that a document keeps, and what it was
//! found for.

use super::arap_build::unsubdivided;
use super::drawing_pair::DrawingPair;
use super::options::TransitionOptions;
use crate::geometry::{DVec2, Regions};
use fnv::FnvHasher;
use serde::{Deserialize, Serialize};
use std::hash::Hasher;
use std::sync::Arc;

/// Outlines are the same where their coordinates are, to this share of the
/// designs' diameter: importing on another machine may round a last digit
/// otherwise.
const SAME: f64 = 1e-7;

/// The match and the film that were found for two designs, as text for a
/// document. Any text will do: what is not sound is not taken.
///
/// All are equal: a document says what is asked for, and what was found for it
/// makes it no other.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CachedMatch {
    /// What it was found for.
    #[serde(rename = "for")]
    pub(super) of: String,
    pub(super) film: SharedText,
}

/// Text that is cheap to clone: each step of a history has a document.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub(super) struct SharedText(pub(super) Arc<str>);

impl From<String> for SharedText {
    fn from(text: String) -> Self {
        Self(text.into())
    }
}

impl From<SharedText> for String {
    fn from(text: SharedText) -> Self {
        text.0.as_ref().to_owned()
    }
}

impl PartialEq for CachedMatch {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl CachedMatch {
    /// Whether there is none.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.film.0.is_empty()
    }

    /// Whether it was found for what has this key.
    pub(super) fn is_for(&self, key: &str) -> bool {
        !self.is_none() && self.of == key
    }
}

/// Counted up when a film of the same match and mesh moves otherwise than before: what
/// was kept is then found anew.
const FILMS: u32 = 3;

/// What a film is found for: its outlines and how they look, and the options that it hangs on.
pub(super) fn cache_key(options: &TransitionOptions, drawings: &DrawingPair) -> String {
    let outlines = &drawings.outlines;
    let mut hasher = FnvHasher::default();
    let asked = (
        &options.matching,
        options.quality,
        &options.triangulation,
        unsubdivided(&options.arap),
        FILMS,
    );
    // Options are numbers and words; what could not be written has one key.
    hasher.write(&serde_json::to_vec(&asked).unwrap_or_default());
    hasher.write(options.guard.to_string().as_bytes());
    let bounds = outlines.each_ref().map(Regions::bounds);
    let bounds = bounds[0].union(&bounds[1]);
    let step = SAME * bounds.diameter();
    for ring in outlines.iter().flat_map(Regions::rings) {
        hasher.write_usize(ring.points().len());
        for &point in ring.points() {
            // Drawings lie on grids: half a step would be on the edge of two.
            let from_corner = (point - bounds.min) / step + DVec2::splat(0.381_966);
            hasher.write_i64(from_corner.x.floor() as i64);
            hasher.write_i64(from_corner.y.floor() as i64);
        }
    }
    // Nothing of drawings in one colour, so that what was found before they had
    // others is taken.
    for look in drawings.looks.0.iter().flatten() {
        hasher.write_usize(look.coat);
        let paint = look
            .paint
            .map(|paint| (paint.colour.0, paint.opacity.to_bits()));
        hasher.write(format!("{paint:?} {} {}", look.is_lined, look.name).as_bytes());
    }
    format!("{:016x}", hasher.finish())
}
