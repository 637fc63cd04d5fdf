//! The import options: how pictures are traced and how precise outlines are.

use crate::settings::named;
use serde::{Deserialize, Serialize};

/// Settings for importing a design. All except `tolerance` and `strokes` apply to
/// pictures only.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ImportOptions {
    /// Threshold between figure and background, from 1 to 255. It applies to the opacity, the grey
    /// level or the colour distance of the pixels, as `reading` says. If `None`, the threshold is
    /// 128 for opacity and otherwise chosen by Otsu's method.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threshold: Option<u8>,
    /// Property of the pixels that separates the figure of a picture from its background.
    #[serde(skip_serializing_if = "is_auto")]
    pub reading: PictureReading,
    /// Whether figure and background of a picture are swapped.
    pub invert: bool,
    /// Islands and holes with fewer pixels than this are removed; 0 keeps all.
    pub specks_px: u32,
    /// Allowed deviation of the outline from the exact boundary, as a fraction of the longer side
    /// of the picture or page: 0 to 0.1. Limits the maximum deviation in drawings and text, and
    /// approximately the mean deviation in pictures.
    pub tolerance: f64,
    /// Whether the flat colours of a picture are imported as separate paint layers.
    #[serde(skip_serializing_if = "is_unset")]
    pub colours: bool,
    /// Whether the strokes of a drawing are part of its outline. Strokes are always
    /// visible when the drawing is shown in its own colours.
    #[serde(skip_serializing_if = "is_set")]
    pub strokes: bool,
}

/// Property of the pixels that separates the figure of a picture from its background.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PictureReading {
    /// The first of the other readings that separates figure and background.
    #[default]
    Auto,
    /// Opaque pixels are the figure.
    Opacity,
    /// Pixels that are darker, or lighter, than the border of the picture are the figure.
    Brightness,
    /// Pixels whose colour differs from the one along the border are the figure.
    Colour,
}

named! { PictureReading {
    Auto: "auto", "Auto", "Opacity if it separates figure and background, otherwise brightness or colour";
    Opacity: "opacity", "Opacity", "Opaque pixels are the figure";
    Brightness: "brightness", "Brightness", "Pixels darker or lighter than the border are the figure";
    Colour: "colour", "Colour", "Pixels of another colour than the border are the figure";
} }

fn is_auto(value: &PictureReading) -> bool {
    *value == PictureReading::Auto
}

fn is_unset(value: &bool) -> bool {
    !*value
}

fn is_set(value: &bool) -> bool {
    *value
}

/// Error for an import option that is out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImportOptionsError {
    /// The tolerance is not a number from 0 to 0.1.
    #[error("the outline tolerance is {0}; enter a fraction of the longer side from 0 to 0.1")]
    Tolerance(f64),
    /// The threshold is 0, and no grey level lies below it.
    #[error("the threshold is 0; enter a value from 1 to 255")]
    Threshold,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self {
            threshold: None,
            reading: PictureReading::Auto,
            invert: false,
            specks_px: 0,
            tolerance: Self::DEFAULT_TOLERANCE,
            colours: false,
            strokes: true,
        }
    }
}

impl ImportOptions {
    /// Default outline tolerance, as a fraction of the longer side: a tenth of a pixel in a picture
    /// 500 pixels wide (tolerance: half a pixel on a screen 2,500 pixels wide is invisible, and a
    /// circle in a drawing needs only about 130 points).
    pub const DEFAULT_TOLERANCE: f64 = 0.0002;

    /// Maximum outline tolerance, as a fraction of the longer side (tolerance: a larger value
    /// would reduce a shape to a handful of corners).
    const MAX_TOLERANCE: f64 = 0.1;

    pub(super) fn check(&self) -> Result<(), ImportOptionsError> {
        // The range test also rejects NaN.
        if !(0.0..=Self::MAX_TOLERANCE).contains(&self.tolerance) {
            return Err(ImportOptionsError::Tolerance(self.tolerance));
        }
        if self.threshold == Some(0) {
            return Err(ImportOptionsError::Threshold);
        }
        Ok(())
    }
}
