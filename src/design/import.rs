//! Entry points of the import: turn the bytes of a file, or text in a font, into a design. They
//! recognise the format of the file and call its importer.

use super::error::{ImportError, ImportProblem};
use super::form::{Design, ImportedOutlines};
use super::format::Format;
use super::note::ImportNote;
use super::options::ImportOptions;
use super::sniff::sniff;
use super::source::DesignSource;
use super::text_encoding::{plain_bytes, xml_text};
use super::truss::Truss;
use super::{dxf, lettering, obj, polygons, silhouette, svg};
use crate::io::read;
use crate::io::read::{ReadError, check_size};
use crate::work::panic_boundary::catch_panic;
use std::path::Path;

/// Imports a design from the bytes of a file in any supported format.
///
/// `name` becomes the design's name and identifies the file in errors.
///
/// # Errors
/// [`ImportError`] names the file, the position in it and a remedy.
///
/// ```
/// use morphospace::design::{ImportOptions, import};
/// let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// let design = import("triangle", obj, &ImportOptions::default())?;
/// assert_eq!(design.outline(0.0).expect("area").area(), 0.5);
/// # Ok::<(), morphospace::design::ImportError>(())
/// ```
pub fn import(name: &str, bytes: &[u8], options: &ImportOptions) -> Result<Design, ImportError> {
    let file = name.to_owned();
    contained(|| read(file.clone(), bytes, None, options))
        .map_err(|problem| ImportError { file, problem })
}

/// Imports a design from a path: a file, an element of a drawing, or text in a font
/// (see [`DesignSource`]). The design is named after the file, without its extension.
///
/// # Errors
/// [`ImportError`] names the file, the position in it and a remedy.
pub fn import_file(path: &Path, options: &ImportOptions) -> Result<Design, ImportError> {
    DesignSource::from_path(path).import(options)
}

impl DesignSource {
    /// Reads the file of the source, if it has one, and imports the design.
    ///
    /// # Errors
    /// [`ImportError`] names the source, the position in it and a remedy.
    pub fn import(&self, options: &ImportOptions) -> Result<Design, ImportError> {
        let bytes = match self.file() {
            Some(path) => {
                read::read(path).map_err(|error| self.error(self.problem(path, error)))?
            }
            None => Vec::new(),
        };
        self.import_bytes(&bytes, options)
    }

    /// Imports the design from the bytes of [`DesignSource::file`]. The bytes are ignored if
    /// the source has no file.
    ///
    /// # Errors
    /// [`ImportError`] names the source, the position in it and a remedy.
    pub fn import_bytes(
        &self,
        bytes: &[u8],
        options: &ImportOptions,
    ) -> Result<Design, ImportError> {
        let name = self.name();
        let read = || match self {
            Self::File { element, .. } => read(name, bytes, element.as_deref(), options),
            Self::Text { text, font } => {
                options.check()?;
                if font.is_some() && bytes.is_empty() {
                    return Err(ImportProblem::Empty);
                }
                let font = font.is_some().then_some(bytes);
                Ok(lettering::read(text, font, options.tolerance)?.into_design(name))
            }
        };
        contained(read).map_err(|problem| self.error(problem))
    }

    /// Returns the problem that the file of the source could not be read.
    fn problem(&self, path: &Path, error: ReadError) -> ImportProblem {
        match self {
            Self::File { .. } => error.into(),
            Self::Text { .. } => ImportProblem::FontFile {
                path: path.to_owned(),
                error,
            },
        }
    }

    fn error(&self, problem: ImportProblem) -> ImportError {
        let file = self.to_path().display().to_string();
        ImportError { file, problem }
    }
}

/// Runs an importer and turns its panics into errors.
fn contained<T>(import: impl FnOnce() -> Result<T, ImportProblem>) -> Result<T, ImportProblem> {
    catch_panic(import).unwrap_or_else(|message| Err(ImportProblem::Decoder(message)))
}

/// Imports the bytes of a file. If `element` is given, the file must be an SVG drawing, and only
/// the element with this id is imported.
fn read(
    name: String,
    bytes: &[u8],
    element: Option<&str>,
    options: &ImportOptions,
) -> Result<Design, ImportProblem> {
    options.check()?;
    if bytes.is_empty() {
        return Err(ImportProblem::Empty);
    }
    // The file reader limits the size of a file, but a caller may pass bytes from elsewhere.
    check_size(bytes)?;
    let bytes = &*plain_bytes(bytes);
    let format = sniff(bytes)?;
    if let (Some(id), true) = (element, format != Format::Svg) {
        return Err(ImportProblem::NoElements { id: id.to_owned() });
    }
    Ok(match format {
        Format::Picture(format) => {
            Design::from_picture(name, silhouette::decode(bytes, format)?, options)?
        }
        Format::Svg => Design {
            // The box of a single element is that of its geometry.
            has_page: element.is_none(),
            ..read_drawing(bytes, element, options)?.into_design(name)
        },
        Format::Dxf => dxf::read(bytes, options)?.into_design(name),
        Format::Obj => {
            let (mesh, notes) = obj::read(text(bytes)?)?;
            Design {
                notes,
                ..Design::new(name, mesh)
            }
        }
        Format::Polygons => polygons::read(text(bytes)?)?.into_design(name),
        Format::Truss => {
            let truss = Truss::from_json(text(bytes)?)?;
            Design {
                notes: Vec::from_iter(truss.lacks_units().then_some(ImportNote::NoTrussUnits)),
                ..Design::new(name, truss)
            }
        }
    })
}

/// Imports an SVG drawing, in the encoding that it declares.
fn read_drawing(
    bytes: &[u8],
    element: Option<&str>,
    options: &ImportOptions,
) -> Result<ImportedOutlines, ImportProblem> {
    let decoded = xml_text(bytes).map_err(|line| ImportProblem::NotUtf8 { line })?;
    let mut outlines = svg::read(&decoded.text, element, options)?;
    outlines.notes.extend(decoded.note);
    Ok(outlines)
}

/// Returns the bytes as text without a byte order mark.
fn text(bytes: &[u8]) -> Result<&str, ImportProblem> {
    std::str::from_utf8(bytes)
        // The JSON parser rejects a leading byte order mark.
        .map(|text| text.trim_start_matches('\u{feff}'))
        .map_err(|e| ImportProblem::NotUtf8 {
            line: 1 + bytes[..e.valid_up_to()]
                .iter()
                .filter(|&&b| b == b'\n')
                .count(),
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{DVec2, Similarity};

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
            matches!(error.problem, ImportProblem::NotUtf8 { line: 3 }),
            "{error}"
        );
    }
}
