//! The cached match of two designs, stored as text in a document, and the key that identifies the
//! inputs of the match.

use crate::geometry::{DVec2, Regions};
use crate::transition::arap_build::without_subdivision;
use crate::transition::drawing_pair::DrawingPair;
use crate::transition::options::TransitionOptions;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Step to which the key rounds coordinates, as a fraction of the designs' diameter (tolerance:
/// importing on another machine may round the last digits differently).
const COORDINATE_TOLERANCE: f64 = 1e-7;

/// The match and the solved motion of two designs, as text for a document. Any text is allowed;
/// invalid text is ignored.
///
/// All values compare equal: a document is defined by its request, and the cached result does not
/// make it a different document.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CachedMatch {
    /// Key of the outlines and options for which the match was computed.
    #[serde(rename = "for")]
    pub(in crate::transition) of: String,
    /// The match and its motion, compressed and encoded as text; empty if nothing is cached.
    pub(in crate::transition) film: SharedText,
}

/// Shared text. It must be cheap to clone, because each step of the undo history holds a document.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub(in crate::transition) struct SharedText(pub(in crate::transition) Arc<str>);

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
    /// Returns whether nothing is cached.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.film.0.is_empty()
    }

    /// Returns whether a match is cached and was computed for the inputs with this key.
    pub(in crate::transition) fn is_for(&self, key: &str) -> bool {
        !self.is_none() && self.of == key
    }
}

/// Version of the solver; increased when the motion for the same match and mesh changes, so that
/// older cached results are computed again.
const SOLVER_VERSION: u32 = 3;

/// The hash function FNV-1a with 64 bits (Fowler, Noll, Vo; RFC 9923). Unlike the standard
/// library's hash functions, it is the same in all versions and on all platforms, so that keys in
/// documents stay valid.
struct FnvHasher(u64);

impl Default for FnvHasher {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl FnvHasher {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// Returns the key of a match: a hash of the outlines, their appearance, and all options that
/// influence the result.
pub(in crate::transition) fn cache_key(
    options: &TransitionOptions,
    drawings: &DrawingPair,
) -> String {
    let outlines = &drawings.outlines;
    let mut hasher = FnvHasher::default();
    let inputs = (
        &options.matching,
        options.quality,
        &options.triangulation,
        without_subdivision(&options.arap),
        SOLVER_VERSION,
    );
    // Serialisation of the options does not fail. If it did, all options would share one key.
    hasher.write(&serde_json::to_vec(&inputs).unwrap_or_default());
    hasher.write(options.guard.to_string().as_bytes());
    let bounds = outlines.each_ref().map(Regions::bounds);
    let bounds = bounds[0].union(&bounds[1]);
    let step = COORDINATE_TOLERANCE * bounds.diameter();
    for ring in outlines.iter().flat_map(Regions::rings) {
        hasher.write(&(ring.points().len() as u64).to_le_bytes());
        for &point in ring.points() {
            // Coordinates often lie on a grid. The offset keeps grid points away from the
            // boundaries between two steps.
            let from_corner = (point - bounds.min) / step + DVec2::splat(0.381_966);
            hasher.write(&(from_corner.x.floor() as i64).to_le_bytes());
            hasher.write(&(from_corner.y.floor() as i64).to_le_bytes());
        }
    }
    // Drawings in one colour add nothing to the key, so that results cached by versions without
    // colours stay valid.
    for look in drawings.appearances.0.iter().flatten() {
        hasher.write(&(look.paint_layer as u64).to_le_bytes());
        let paint = look
            .paint
            .map(|paint| (paint.colour.0, paint.opacity.to_bits()));
        hasher.write(format!("{paint:?} {} {}", look.is_lined, look.name).as_bytes());
    }
    format!("{:016x}", hasher.finish())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_of_keys_is_fnv_1a() {
        let hash = |text: &str| {
            let mut hasher = FnvHasher::default();
            hasher.write(text.as_bytes());
            hasher.finish()
        };
        // The test vectors of RFC 9923.
        assert_eq!(hash(""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(hash("a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(hash("foobar"), 0x8594_4171_f739_67e8);
    }
}
