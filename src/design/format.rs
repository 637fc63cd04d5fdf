//! The formats that designs are read from: one table of what people call them
//! and how their files' names end.
//!
//! Dialogs, the command line and messages read it. Guarantees nothing about a
//! file's content: that is for [`sniff`](super::sniff()) to tell.

use image::ImageFormat;
use std::path::Path;

/// A format that can be read.
///
/// ```
/// use morphospace::design::Format;
/// let dxf = Format::ALL.into_iter().find(|format| format.ends("plan.DXF".as_ref()));
/// assert_eq!(dxf, Some(Format::Dxf));
/// assert_eq!(Format::Dxf.name(), "DXF");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// PNG, JPEG, BMP or WebP.
    Picture(ImageFormat),
    /// SVG as UTF-8 text.
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
    /// Pictures.
    pub const PICTURES: &'static [Self] = Self::ALL.split_at(4).0;

    /// All of them, pictures first.
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

    /// The name for people, and how its files' names end.
    const fn row(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::Picture(ImageFormat::Jpeg) => ("JPEG", &["jpg", "jpeg"]),
            Self::Picture(ImageFormat::Bmp) => ("BMP", &["bmp"]),
            Self::Picture(ImageFormat::WebP) => ("WebP", &["webp"]),
            Self::Picture(_) => ("PNG", &["png"]),
            Self::Svg => ("SVG", &["svg"]),
            Self::Dxf => ("DXF", &["dxf"]),
            Self::Obj => ("OBJ", &["obj"]),
            Self::Polygons => ("polygons as JSON or GeoJSON", &["json", "geojson"]),
            Self::Truss => ("a truss as JSON", &["json"]),
        }
    }

    /// What people call it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().0
    }

    /// How its files' names end, in lower case and without a dot, the usual
    /// way first. Two formats may share one.
    #[must_use]
    pub const fn extensions(self) -> &'static [&'static str] {
        self.row().1
    }

    /// Whether a file's name ends as those of this format do, in whatever case.
    #[must_use]
    pub fn ends(self, path: &Path) -> bool {
        let ending = path.extension().unwrap_or_default();
        (self.extensions().iter()).any(|extension| ending.eq_ignore_ascii_case(extension))
    }

    /// Names in a row for a sentence: `PNG, JPEG, BMP or WebP`.
    #[must_use]
    pub fn listed(formats: &[Self]) -> String {
        or_list(formats.iter().map(|format| format.name()))
    }
}

/// Words in a row for a sentence: `a, b or c`.
pub(crate) fn or_list<W: AsRef<str>>(words: impl IntoIterator<Item = W>) -> String {
    let words: Vec<W> = words.into_iter().collect();
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    match words.as_slice() {
        [rest @ .., last] if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        few => few.concat(),
    }
}

/// How the names of designs' files end, each ending once.
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
    fn formats_are_told_in_a_sentence() {
        assert_eq!(Format::listed(Format::PICTURES), "PNG, JPEG, BMP or WebP");
        assert_eq!(Format::listed(&[Format::Svg]), "SVG");
        assert_eq!(Format::listed(&[]), "");
    }

    #[test]
    fn endings_are_known_in_any_case_and_listed_once() {
        assert!(Format::Svg.ends("a.b.SVG".as_ref()));
        assert!(!Format::Svg.ends("svg".as_ref()));
        assert_eq!(
            extensions().join(" "),
            "png jpg jpeg bmp webp svg dxf obj json geojson"
        );
    }
}
