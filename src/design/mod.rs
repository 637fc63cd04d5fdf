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

mod coat;
mod dxf;
mod error;
mod flatten;
mod form;
mod format;
mod import;
mod json;
mod lettering;
mod note;
mod obj;
mod options;
mod picture;
mod polygons;
mod silhouette;
mod sniff;
mod source;
mod svg;
mod truss;

pub use crate::reading::{MAX_FILE_BYTES, ReadError};
pub use coat::Coat;
pub use dxf::{DxfError, Place as DxfPlace};
pub use error::{ImportError, Problem};
pub use flatten::TooManyPoints;
pub use form::{Design, Form};
pub(crate) use format::any_of;
pub use format::{Format, extensions};
pub use import::{import, import_file};
pub use json::JsonError;
pub use lettering::TextError;
pub use note::{ImportNote, OnlyThese};
pub use obj::{ObjError, ObjFault};
pub use options::{ImportOptions, OptionsError};
pub use picture::Picture;
pub use polygons::{PolygonsError, PolygonsFault};
pub use silhouette::PictureError;
pub use sniff::{UnknownFormat, sniff};
pub use source::Source;
pub use svg::SvgError;
pub use truss::{Load, Material, Support, Truss, TrussInputError, TrussParts};
