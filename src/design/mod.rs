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
mod format;
mod lettering;
mod note;
mod obj;
mod options;
mod outline;
mod picture;
mod polygons;
mod silhouette;
mod simplify;
mod sniff;
mod source;
mod svg;
mod truss;

pub use dxf::{DxfError, Place as DxfPlace};
pub use error::{ImportError, Problem};
pub use flatten::TooManyPoints;
pub use format::{Format, extensions};
pub use lettering::TextError;
pub use note::ImportNote;
pub use obj::ObjError;
pub use options::{ImportOptions, OptionsError};
pub use picture::Picture;
pub use polygons::PolygonsError;
pub use silhouette::PictureError;
pub use sniff::{UnknownFormat, sniff};
pub use source::Source;
pub use svg::SvgError;
pub use truss::{Load, Material, Support, Truss, TrussInputError, TrussParts};

use crate::geometry::{Bounds, Regions, RegionsError, Similarity};
use crate::mesh::TriangleMesh;
use std::path::Path;

/// One of the given forms.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// What people call it: the file's name without its ending.
    pub name: String,
    /// The form itself, y up.
    pub form: Form,
    /// The rectangle of the picture or the page, its lower left corner at the
    /// origin, or the box around a mesh, a truss or an element of a drawing.
    pub extent: Bounds,
    /// The picture that it came as, if it did.
    pub picture: Option<Picture>,
    /// What was repaired or left out while it was read.
    pub notes: Vec<ImportNote>,
}

/// What a design consists of.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// Filled regions with holes.
    Outline(Regions),
    /// Triangles that carry a correspondence.
    Mesh(TriangleMesh),
    /// Nodes joined by bars.
    Truss(Truss),
}

impl Design {
    /// The design laid down by a similarity; the extent becomes the box
    /// around its moved corners.
    #[must_use]
    pub fn transformed(&self, by: &Similarity) -> Self {
        let corners = self.extent.corners().map(|p| by.apply(p));
        Self {
            name: self.name.clone(),
            form: match &self.form {
                Form::Outline(regions) => Form::Outline(regions.transformed(by)),
                Form::Mesh(mesh) => Form::Mesh(mesh.transformed(by)),
                Form::Truss(truss) => Form::Truss(truss.transformed(by)),
            },
            extent: Bounds::of(corners).unwrap_or(self.extent),
            picture: self.picture.as_ref().map(|picture| picture.transformed(by)),
            notes: self.notes.clone(),
        }
    }

    /// The filled area of the form: an outline itself, a mesh without its
    /// inner edges, a truss with its bars drawn `bar_width` wide and round at
    /// the nodes. `bar_width` is in the design's units and matters to trusses
    /// only.
    ///
    /// # Errors
    /// [`RegionsError`] if no area is left, such as bars of no width.
    pub fn outline(&self, bar_width: f64) -> Result<Regions, RegionsError> {
        match &self.form {
            Form::Outline(regions) => Ok(regions.clone()),
            Form::Mesh(mesh) => outline::of_mesh(mesh),
            Form::Truss(truss) => outline::of_truss(truss, bar_width),
        }
    }
}

/// Largest file that is read, in bytes.
pub const MAX_FILE_BYTES: u64 = 256 << 20;

/// Reads a design from the bytes of a file, whatever its format. `name`
/// becomes the design's name and stands in errors.
///
/// # Errors
/// [`ImportError`] names the file, the place in it and the way out.
///
/// ```
/// use morphospace::design::{ImportOptions, import};
/// let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// let design = import("triangle", obj, &ImportOptions::default())?;
/// assert_eq!(design.outline(0.0).expect("area").area(), 0.5);
/// # Ok::<(), morphospace::design::ImportError>(())
/// ```
pub fn import(name: &str, bytes: &[u8], options: &ImportOptions) -> Result<Design, ImportError> {
    read(bytes, None, options)
        .map(|drawn| drawn.named(name.to_owned()))
        .map_err(|problem| ImportError::new(name, problem))
}

/// Reads a design from a file, or from whatever else a path may mean: see
/// [`Source`]. The design is named after the file, without its ending.
///
/// # Errors
/// [`ImportError`] names the file, the place in it and the way out.
pub fn import_file(path: &Path, options: &ImportOptions) -> Result<Design, ImportError> {
    Source::of(path).import(options)
}

/// The design of a source whose file's bytes are at hand.
fn import_parts(source: &Source, bytes: &[u8], options: &ImportOptions) -> Result<Design, Problem> {
    let drawn = match source {
        Source::File { element, .. } => read(bytes, element.as_deref(), options)?,
        Source::Text { text, font } => {
            options.check()?;
            let font = font.is_some().then_some(bytes);
            let (regions, extent) = lettering::read(text, font, options.tolerance)?;
            Drawn::plain(Form::Outline(regions), extent)
        }
    };
    Ok(drawn.named(source.name()))
}

/// Outlines as a reader gives them.
struct Outlines {
    regions: Regions,
    extent: Bounds,
    notes: Vec<ImportNote>,
}

/// A design without a name.
struct Drawn {
    form: Form,
    extent: Bounds,
    picture: Option<Picture>,
    notes: Vec<ImportNote>,
}

impl Drawn {
    fn plain(form: Form, extent: Bounds) -> Self {
        Self {
            form,
            extent,
            picture: None,
            notes: Vec::new(),
        }
    }

    fn named(self, name: String) -> Design {
        Design {
            name,
            form: self.form,
            extent: self.extent,
            picture: self.picture,
            notes: self.notes,
        }
    }
}

impl From<Outlines> for Drawn {
    fn from(outlines: Outlines) -> Self {
        Self {
            notes: outlines.notes,
            ..Self::plain(Form::Outline(outlines.regions), outlines.extent)
        }
    }
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    let metadata = std::fs::metadata(path).map_err(Problem::from_io)?;
    if metadata.is_dir() {
        return Err(Problem::Folder);
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(Problem::TooLarge {
            bytes: metadata.len(),
        });
    }
    std::fs::read(path).map_err(Problem::from_io)
}

/// Reads a file, or the element of it with an id.
fn read(bytes: &[u8], element: Option<&str>, options: &ImportOptions) -> Result<Drawn, Problem> {
    options.check()?;
    if bytes.is_empty() {
        return Err(Problem::Empty);
    }
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(Problem::TooLarge {
            bytes: bytes.len() as u64,
        });
    }
    let format = sniff(bytes)?;
    if let (Some(id), true) = (element, format != Format::Svg) {
        return Err(Problem::NoElements { id: id.to_owned() });
    }
    Ok(match format {
        Format::Picture(format) => {
            let picture = silhouette::decode(bytes, format)?;
            let form = Form::Outline(silhouette::read(&picture, options)?);
            let picture = Picture::new(picture);
            Drawn {
                picture: Some(picture.clone()),
                ..Drawn::plain(form, picture.bounds())
            }
        }
        Format::Svg => svg::read(text(bytes)?, element, options)?.into(),
        Format::Dxf => dxf::read(bytes, options.tolerance)?.into(),
        Format::Obj => {
            let mesh = obj::read(text(bytes)?)?;
            let extent = mesh.bounds();
            Drawn::plain(Form::Mesh(mesh), extent)
        }
        Format::Polygons => polygons::read(text(bytes)?)?.into(),
        Format::Truss => {
            let truss = Truss::from_json(text(bytes)?)?;
            let extent = truss.bounds();
            Drawn::plain(Form::Truss(truss), extent)
        }
    })
}

/// The bytes as text, without a byte order mark.
fn text(bytes: &[u8]) -> Result<&str, Problem> {
    std::str::from_utf8(bytes)
        .map(|text| text.trim_start_matches('\u{feff}'))
        .map_err(|e| Problem::NotUtf8 {
            line: 1 + bytes[..e.valid_up_to()]
                .iter()
                .filter(|&&b| b == b'\n')
                .count(),
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DVec2;

    #[test]
    fn a_turned_design_keeps_its_area_and_moves_its_extent() {
        let obj = b"v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n";
        let design = import("t", obj, &ImportOptions::default()).expect("valid");
        let by = Similarity {
            rotation: std::f64::consts::FRAC_PI_2,
            mirror: true,
            ..Similarity::IDENTITY
        };
        let moved = design.transformed(&by);
        let area = |d: &Design| d.outline(0.0).expect("area").area();
        assert!((area(&moved) - area(&design)).abs() < 1e-12);
        assert!((moved.extent.min - DVec2::new(-1.0, -2.0)).length() < 1e-12);
        assert!((moved.extent.max - DVec2::ZERO).length() < 1e-12);
    }

    #[test]
    fn text_that_is_not_utf8_is_named_by_its_line() {
        let bytes = b"v 0 0 0\nv 1 0 0\nv \xff 1 0\nf 1 2 3\n";
        let error = import("t.obj", bytes, &ImportOptions::default()).expect_err("bad text");
        assert!(
            matches!(error.problem, Problem::NotUtf8 { line: 3 }),
            "{error}"
        );
    }
}
