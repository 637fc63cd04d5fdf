//! Why a file did not become a design, in one sentence for its owner.

use super::{
    DxfError, ImportOptionsError, ObjError, PolygonsImportError, SilhouetteError, SvgError,
    TextError, TrussInputError, UnknownFormat,
};
use crate::io::read::ReadError;
use crate::io::sanitize::SanitizedLine;

/// A file that could not be read as a design. Its message names the file,
/// the place and the way out.
#[derive(Debug, thiserror::Error)]
#[error("{}", SanitizedLine(format_args!("{file}: {problem}")))]
pub struct ImportError {
    /// The file, as it was given.
    pub file: String,
    /// What is wrong with it.
    pub problem: ImportProblem,
}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportProblem {
    /// The file is not there, is no file, or is too large.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// It holds nothing.
    #[error("the file is empty; save it again from where it was made")]
    Empty,
    /// Text that is not text.
    #[error("line {line} is not UTF-8 text; save the file with the encoding UTF-8")]
    NotUtf8 {
        /// The first such line, from 1.
        line: usize,
    },
    /// An element is asked for of what is no drawing.
    #[error("only an SVG drawing has elements to choose by an id; leave out #{id}")]
    NoElements {
        /// The id.
        id: String,
    },
    /// No reader knows it.
    #[error(transparent)]
    Unknown(#[from] UnknownFormat),
    /// An option is out of range.
    #[error(transparent)]
    Options(#[from] ImportOptionsError),
    /// A picture without a usable silhouette.
    #[error(transparent)]
    Picture(#[from] SilhouetteError),
    /// A drawing without a usable outline.
    #[error(transparent)]
    Svg(#[from] SvgError),
    /// A DXF drawing without a usable outline.
    #[error(transparent)]
    Dxf(#[from] DxfError),
    /// Text without an outline.
    #[error(transparent)]
    Text(#[from] TextError),
    /// JSON without usable polygons.
    #[error(transparent)]
    Polygons(#[from] PolygonsImportError),
    /// A mesh that is none.
    #[error(transparent)]
    Obj(#[from] ObjError),
    /// A truss that is none.
    #[error(transparent)]
    Truss(#[from] TrussInputError),
}
