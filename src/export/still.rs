//! One drawing as a file: PNG or SVG.

use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::atomic;
use super::drawing::Drawing;
use super::error::ExportError;
use super::raster::rasterise;
use super::svg::to_svg;
use super::target::StillKind;

/// Writes one drawing, whole or not at all.
///
/// # Errors
/// [`ExportError`] where the file cannot be written.
pub fn write_still(drawing: &Drawing, kind: StillKind, path: &Path) -> Result<(), ExportError> {
    atomic::write(path, &encoded(drawing, kind, path)?)
}

/// A drawing as the bytes of a file; `path` is for the message alone.
pub(super) fn encoded(
    drawing: &Drawing,
    kind: StillKind,
    path: &Path,
) -> Result<Vec<u8>, ExportError> {
    match kind {
        StillKind::Svg => Ok(to_svg(drawing).into_bytes()),
        StillKind::Png => png(drawing, path),
    }
}

fn png(drawing: &Drawing, path: &Path) -> Result<Vec<u8>, ExportError> {
    let image = rasterise(drawing);
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive)
        .write_image(
            &image,
            image.width(),
            image.height(),
            ExtendedColorType::Rgba8,
        )
        .map_err(ExportError::encode(path))?;
    Ok(bytes)
}
