//! What a person may set about reading a file.

use serde::{Deserialize, Serialize};

/// How a design is read. All but the tolerance and the strokes matter to pictures
/// only.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ImportOptions {
    /// The tone, or the opacity where the picture has any, at which the
    /// boundary runs: 1 to 255. Where it is not given, opacity is parted at
    /// 128 and tones by Otsu's method.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threshold: Option<u8>,
    /// Takes the ground for the figure.
    pub invert: bool,
    /// Islands and holes of fewer pixels than this are left out; 0 keeps all.
    pub specks_px: u32,
    /// How far the outline may run from the exact boundary, as a fraction of
    /// the longer side of the picture or the page: 0 to 0.1.
    pub tolerance: f64,
    /// Whether each flat colour of a picture is a part of its own.
    #[serde(skip_serializing_if = "is_unset")]
    pub colours: bool,
    /// Whether the strokes of a drawing belong to the figure that it makes. Where
    /// it is shown in its own paint they are seen in any case.
    #[serde(skip_serializing_if = "is_set")]
    pub strokes: bool,
}

fn is_unset(value: &bool) -> bool {
    !*value
}

fn is_set(value: &bool) -> bool {
    *value
}

/// An option that is out of its range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImportOptionsError {
    /// The tolerance is not a number from 0 to 0.1.
    #[error("the outline tolerance is {0}; give a fraction of the longer side from 0 to 0.1")]
    Tolerance(f64),
    /// The threshold is 0, which nothing is below.
    #[error("the threshold is 0, which no tone is below; give one from 1 to 255")]
    Threshold,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self {
            threshold: None,
            invert: false,
            specks_px: 0,
            tolerance: Self::DEFAULT_TOLERANCE,
            colours: false,
            strokes: true,
        }
    }
}

impl ImportOptions {
    /// A tenth of a pixel in a picture of 500, half of one on a screen 2,500
    /// pixels wide: not seen, and a circle still needs only about 70 points.
    pub const DEFAULT_TOLERANCE: f64 = 0.0002;

    /// At a tenth of the longer side a form is left with a handful of corners.
    const MAX_TOLERANCE: f64 = 0.1;

    pub(super) fn check(&self) -> Result<(), ImportOptionsError> {
        // NaN is in no range, and is refused with the rest.
        if !(0.0..=Self::MAX_TOLERANCE).contains(&self.tolerance) {
            return Err(ImportOptionsError::Tolerance(self.tolerance));
        }
        if self.threshold == Some(0) {
            return Err(ImportOptionsError::Threshold);
        }
        Ok(())
    }
}
