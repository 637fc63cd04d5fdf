//! Options of painted parts: how they fade and when they change their stacking order.

use serde::{Deserialize, Serialize};

/// Options of painted parts: how they fade and when they change their stacking order.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[non_exhaustive]
pub struct PaintLayerOptions {
    /// Whether unmatched parts fade in or out, in addition to growing or shrinking.
    pub fade: bool,
    /// Blend parameter t, from 0 to 1, at which layers switch from the stacking order of the source
    /// to that of the target.
    pub reorder_at: f64,
}

/// Error: the requested t at which layers change their order is outside [0, 1]. Holds that t.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("layers cannot change their order at t = {0}; give a number from 0 to 1")]
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
    /// Checks that the t at which layers change their order is within [0, 1].
    ///
    /// # Errors
    /// [`PaintLayerOptionsError`] if it is not.
    pub fn check(&self) -> Result<(), PaintLayerOptionsError> {
        let is_within = (0.0..=1.0).contains(&self.reorder_at);
        is_within
            .then_some(())
            .ok_or(PaintLayerOptionsError(self.reorder_at))
    }
}
