//! What is said of how painted parts come and go.

use serde::{Deserialize, Serialize};

/// How painted parts come and go, and lie over each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct PaintLayerOptions {
    /// What one drawing has alone fades in or out, besides growing or shrinking.
    pub fade: bool,
    /// The t, from 0 to 1, at which those change places that lie over each other
    /// otherwise in the target than in the source.
    pub reorder_at: f64,
}

/// A t at which nothing can change places.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("layers cannot change places at t = {0}; give a number from 0 to 1")]
pub struct PaintLayerOptionsError(f64);

impl Default for PaintLayerOptions {
    fn default() -> Self {
        Self {
            fade: false,
            reorder_at: 0.5,
        }
    }
}

impl PaintLayerOptions {
    /// Checks that places are changed within the film.
    ///
    /// # Errors
    /// [`PaintLayerOptionsError`] where they are not.
    pub fn check(&self) -> Result<(), PaintLayerOptionsError> {
        let is_within = (0.0..=1.0).contains(&self.reorder_at);
        is_within
            .then_some(())
            .ok_or(PaintLayerOptionsError(self.reorder_at))
    }
}
