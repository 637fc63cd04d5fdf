//! Designs (the shapes to blend) and their importers, one per file format.
//!
//! A [`Design`] holds an outline with holes (from a picture, a drawing or text), a triangle mesh,
//! or a truss. The format of a file is recognised by its content, not by its name. An importer
//! reads only the given bytes and, for text in a drawing, the installed fonts.
//!
//! Guaranteed: for any bytes, [`import`] returns either a drawable design or an [`ImportError`]
//! whose message advises the user. It never panics. A file that would need excessive memory or time
//! is refused before they are spent. Not checked: whether two designs can be blended. That is
//! checked when they are paired.

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
mod text_encoding;
mod truss;
mod unit;

pub use crate::io::read::{MAX_FILE_BYTES, ReadError};
pub use dxf::DxfError;
pub use error::{ImportError, ImportProblem};
pub use flatten::TooManyPoints;
pub use form::{Design, DesignForm};
pub(crate) use format::or_list;
pub use format::{Format, extensions};
pub use import::{import, import_file};
pub use json_error::JsonError;
pub use lettering::TextError;
pub use note::{DxfEntities, DxfNote, DxfPlace, ImportNote, LeftOut, OtherKinds};
pub use obj::{ObjError, ObjFault};
pub use options::{ImportOptions, ImportOptionsError, PictureReading};
pub use paint_layer::PaintLayer;
pub use picture::Picture;
pub use polygons::{PolygonsFault, PolygonsImportError};
pub use silhouette::{SilhouetteCandidate, SilhouetteError, silhouette_candidates};
pub use sniff::{UnknownFormat, sniff};
pub use source::DesignSource;
pub use svg::{InstalledFont, SvgError, installed_fonts};
pub(crate) use truss::GRAVITY;
pub use truss::{
    MaterialGrade, SectionShape, Truss, TrussForceUnit, TrussInputError, TrussLengthUnit,
    TrussLineLoad, TrussLoad, TrussLoadCase, TrussMaterial, TrussParts, TrussSection, TrussSpring,
    TrussStressUnit, TrussSupport, TrussUnits,
};
pub use unit::LengthUnit;
