//! Writes a single drawing to a PNG, SVG or DXF file.

use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};

use crate::io::atomic_file;

use super::drawing::Drawing;
use super::dxf::to_dxf;
use super::error::ExportError;
use super::raster::rasterise;
use super::svg::to_svg;
use super::target::StillKind;

/// Writes one drawing atomically.
///
/// # Errors
/// [`ExportError`] if the drawing cannot be encoded in this format or the file cannot be written.
pub fn write_still(drawing: &Drawing, kind: StillKind, path: &Path) -> Result<(), ExportError> {
    write_atomically(path, &encode_still(drawing, kind, path)?)
}

/// Writes a file atomically and reports errors with its path.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), ExportError> {
    atomic_file::write(path, bytes).map_err(ExportError::write(path))
}

/// Encodes a drawing as the bytes of a file. `path` is only used in error messages.
pub(super) fn encode_still(
    drawing: &Drawing,
    kind: StillKind,
    path: &Path,
) -> Result<Vec<u8>, ExportError> {
    match kind {
        StillKind::Svg => Ok(to_svg(drawing).into_bytes()),
        StillKind::Dxf => {
            let text = to_dxf(drawing).ok_or(ExportError::NoOutlines)?;
            Ok(text.into_bytes())
        }
        StillKind::Png => {
            let mut bytes = Vec::new();
            let (compression, filter) = (CompressionType::Default, FilterType::Adaptive);
            let encoder = PngEncoder::new_with_quality(&mut bytes, compression, filter);
            let written = rasterise(drawing).write_with_encoder(encoder);
            written.map_err(ExportError::encode(path))?;
            Ok(bytes)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::PixelSize;

    #[test]
    fn the_error_names_a_missing_folder() {
        let path = Path::new("/no/such/folder/x.svg");
        let drawing = Drawing::new(PixelSize::new(1, 1).expect("a legal size"), None);
        let error = write_still(&drawing, StillKind::Svg, path).expect_err("no folder");
        assert!(error.to_string().contains("/no/such/folder/x.svg"));
    }
}
