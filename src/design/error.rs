//! The error of importing a design: which source failed and why, in one line.

use super::{
    DxfError, ImportOptionsError, ObjError, PolygonsImportError, SilhouetteError, SvgError,
    TextError, TrussInputError, UnknownFormat,
};
use crate::io::read::ReadError;
use crate::io::sanitize::SanitizedLine;
use std::path::PathBuf;

/// Error returned when a source cannot be imported as a design.
///
/// The message names the file, the position in it where known, and a remedy.
#[derive(Debug, thiserror::Error)]
#[error("{}", SanitizedLine(format_args!("{file}: {problem}")))]
pub struct ImportError {
    /// Name of the file, or notation of the source, as the caller gave it.
    pub file: String,
    /// The reason why the import failed.
    pub problem: ImportProblem,
}

/// Reason why an import failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportProblem {
    /// The file is missing, cannot be read, is not a regular file, or is too large.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The font of a text is missing, cannot be read, is not a regular file, or is too large.
    #[error("font {}: {error}; write %40 for an @ that belongs to the text", SanitizedLine(path.display()))]
    FontFile {
        /// Path of the font.
        path: PathBuf,
        /// Reason why it was not read.
        error: ReadError,
    },
    /// The file has no bytes.
    #[error("the file is empty; export it again")]
    Empty,
    /// The file has a text format, but its bytes are not valid UTF-8.
    #[error("line {line} is not valid UTF-8; save the file as UTF-8 text")]
    NotUtf8 {
        /// First invalid line, counted from 1.
        line: usize,
    },
    /// An element id was given for a file that is not an SVG drawing.
    #[error("elements can be selected by id only in SVG files; remove #{id}")]
    NoElements {
        /// The requested element id.
        id: String,
    },
    /// A library that decodes the file failed in an unexpected way; holds its message.
    #[error("the file cannot be decoded ({0}); open it in another program and save it again")]
    Decoder(String),
    /// No importer recognises the content.
    #[error(transparent)]
    UnknownFormat(#[from] UnknownFormat),
    /// An import option is out of range.
    #[error(transparent)]
    Options(#[from] ImportOptionsError),
    /// A picture has no usable silhouette.
    #[error(transparent)]
    Picture(#[from] SilhouetteError),
    /// An SVG drawing has no usable outline.
    #[error(transparent)]
    Svg(#[from] SvgError),
    /// A DXF drawing has no usable outline.
    #[error(transparent)]
    Dxf(#[from] DxfError),
    /// Text could not be converted to outlines.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A JSON file has no usable polygons.
    #[error(transparent)]
    Polygons(#[from] PolygonsImportError),
    /// An OBJ file is not a valid plane mesh.
    #[error(transparent)]
    Obj(#[from] ObjError),
    /// A truss file is not a valid truss.
    #[error(transparent)]
    Truss(#[from] TrussInputError),
}
