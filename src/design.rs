//! Designs, the given forms, and how they are read from files.
//!
//! A [`Design`] is one of three forms: an outline with holes (from a picture
//! or a drawing), a triangle mesh, or a truss. Files are known by their
//! content, not by their name. Nothing outside the given bytes is opened.
//!
//! Guaranteed: whatever the bytes are, [`import`] returns a design that can
//! be drawn or an [`ImportError`] in words; it does not panic, and it refuses
//! files that would need absurd amounts of memory or time before it spends
//! them. Not guaranteed: that two designs go together; that is checked where
//! they meet.

mod dxf;
mod error;
mod flatten;
mod form;
mod format;
mod import;
mod json_error;
mod lettering;
mod note;
mod obj;
mod options;
mod paint_layer;
mod picture;
mod polygons;
mod silhouette;
mod sniff;
mod source;
mod svg;
mod truss;

pub use crate::io::read::{MAX_FILE_BYTES, ReadError};
pub use dxf::{DxfError, DxfPlace};
pub use error::{ImportError, ImportProblem};
pub use flatten::TooManyPoints;
pub use form::{Design, DesignForm};
pub(crate) use format::or_list;
pub use format::{Format, extensions};
pub use import::{import, import_file};
pub use json_error::JsonError;
pub use lettering::TextError;
pub use note::{ImportNote, OtherKinds};
pub use obj::{ObjError, ObjFault};
pub use options::{ImportOptions, ImportOptionsError};
pub use paint_layer::PaintLayer;
pub use picture::Picture;
pub use polygons::{PolygonsFault, PolygonsImportError};
pub use silhouette::SilhouetteError;
pub use sniff::{UnknownFormat, sniff};
pub use source::DesignSource;
pub use svg::SvgError;
pub use truss::{Truss, TrussInputError, TrussLoad, TrussMaterial, TrussParts, TrussSupport};
