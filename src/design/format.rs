//! The table of importable file formats: display names and file extensions.
//!
//! File dialogs, the command line and messages use this table. To recognise a format by the content
//! of a file, use [`sniff`](super::sniff()).

use image::ImageFormat;
use std::path::Path;

/// File format that can be imported.
///
/// ```
/// use morphospace::design::Format;
/// let dxf = Format::ALL.into_iter().find(|format| format.matches_extension("plan.DXF".as_ref()));
/// assert_eq!(dxf, Some(Format::Dxf));
/// assert_eq!(Format::Dxf.name(), "DXF");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// PNG, JPEG, BMP or WebP.
    Picture(ImageFormat),
    /// SVG, plain or compressed with gzip.
    Svg,
    /// DXF, text or binary.
    Dxf,
    /// Wavefront OBJ.
    Obj,
    /// Polygons as JSON or GeoJSON.
    Polygons,
    /// A truss as JSON.
    Truss,
}

impl Format {
    /// All picture formats: PNG, JPEG, BMP and WebP.
    pub const PICTURES: &'static [Self] = Self::ALL.split_at(4).0;

    /// All formats, pictures first.
    pub const ALL: [Self; 9] = [
        Self::Picture(ImageFormat::Png),
        Self::Picture(ImageFormat::Jpeg),
        Self::Picture(ImageFormat::Bmp),
        Self::Picture(ImageFormat::WebP),
        Self::Svg,
        Self::Dxf,
        Self::Obj,
        Self::Polygons,
        Self::Truss,
    ];

    /// Returns the display name and the file extensions.
    const fn name_and_extensions(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::Picture(ImageFormat::Jpeg) => ("JPEG", &["jpg", "jpeg"]),
            Self::Picture(ImageFormat::Bmp) => ("BMP", &["bmp"]),
            Self::Picture(ImageFormat::WebP) => ("WebP", &["webp"]),
            Self::Picture(_) => ("PNG", &["png"]),
            Self::Svg => ("SVG", &["svg", "svgz"]),
            Self::Dxf => ("DXF", &["dxf"]),
            Self::Obj => ("OBJ", &["obj"]),
            Self::Polygons => ("polygons as JSON or GeoJSON", &["json", "geojson"]),
            Self::Truss => ("a truss as JSON", &["json"]),
        }
    }

    /// Returns the display name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.name_and_extensions().0
    }

    /// Returns the file extensions in lower case without a dot, the usual one first.
    /// Two formats may share an extension.
    #[must_use]
    pub const fn extensions(self) -> &'static [&'static str] {
        self.name_and_extensions().1
    }

    /// Returns whether a path has an extension of this format, ignoring case.
    #[must_use]
    pub fn matches_extension(self, path: &Path) -> bool {
        let of_path = path.extension().unwrap_or_default();
        (self.extensions().iter()).any(|extension| of_path.eq_ignore_ascii_case(extension))
    }

    /// Joins the display names of formats for a sentence: `PNG, JPEG, BMP or WebP`.
    #[must_use]
    pub fn or_list_of_names(formats: &[Self]) -> String {
        or_list(formats.iter().map(|format| format.name()))
    }
}

/// Joins words for a sentence: `a, b or c`.
pub(crate) fn or_list<W: AsRef<str>>(words: impl IntoIterator<Item = W>) -> String {
    let words: Vec<W> = words.into_iter().collect();
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    match words.as_slice() {
        [rest @ .., last] if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        few => few.concat(),
    }
}

/// Returns the file extensions of all formats, each once.
///
/// ```
/// let all = morphospace::design::extensions();
/// assert!(all.contains(&"dxf") && all.contains(&"geojson"));
/// ```
#[must_use]
pub fn extensions() -> Vec<&'static str> {
    let mut all: Vec<&str> = Vec::new();
    for extension in Format::ALL.iter().flat_map(|format| format.extensions()) {
        if !all.contains(extension) {
            all.push(extension);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn format_names_are_joined_for_a_sentence() {
        assert_eq!(
            Format::or_list_of_names(Format::PICTURES),
            "PNG, JPEG, BMP or WebP"
        );
        assert_eq!(Format::or_list_of_names(&[Format::Svg]), "SVG");
        assert_eq!(Format::or_list_of_names(&[]), "");
    }

    #[test]
    fn extensions_match_in_any_case_and_are_listed_once() {
        assert!(Format::Svg.matches_extension("a.b.SVG".as_ref()));
        assert!(!Format::Svg.matches_extension("svg".as_ref()));
        assert_eq!(
            extensions().join(" "),
            "png jpg jpeg bmp webp svg svgz dxf obj json geojson"
        );
    }
}
