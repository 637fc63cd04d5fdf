//! Parses and writes the notation for the source of a design: a file, an element of a drawing, or
//! text in a font.
//!
//! | notation | meaning |
//! |---|---|
//! | `leaf.svg` | the file |
//! | `leaf.svg#stalk` | the element of the drawing with that id |
//! | `glyph:FORM` | the word FORM in the bundled font |
//! | `glyph:FORM@fonts/serif.ttf` | the word FORM in that font |
//! | `glyph:me@home`, `glyph:me%40home.org` | text that contains an `@` |
//!
//! An existing file named `leaf.svg#stalk` takes precedence over the element. A file named
//! `glyph:FORM` is written `./glyph:FORM`. The text after `glyph:` is percent-decoded, so
//! `%40` stands for `@` and `%25` for `%`.
//!
//! Text after the first `@` is the path of a font if it contains a dot or a slash, even if no such
//! file exists. A mistyped path is therefore an error, not a text in another font. Otherwise the
//! `@` belongs to the text.

use crate::io::path_text::{percent_decoded, rsplit_path_once, split_path_once};
use crate::io::sanitize::SanitizedName;
use std::borrow::Cow;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Source of a design: a file or text.
///
/// ```
/// use morphospace::design::{DesignSource, ImportOptions};
/// let source = DesignSource::from_path("glyph:D".as_ref());
/// let design = source.import(&ImportOptions::default())?;
/// assert_eq!(design.name, "D");
/// # Ok::<(), morphospace::design::ImportError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DesignSource {
    /// A file or one element of a drawing.
    File {
        /// Path of the file.
        path: PathBuf,
        /// Id of the element; `None` for the whole file.
        element: Option<String>,
    },
    /// Text that is converted to outlines.
    Text {
        /// The text, decoded.
        text: String,
        /// Path of the font file; `None` for the bundled font.
        font: Option<PathBuf>,
    },
}

/// Prefix that marks a source as text.
const GLYPH: &str = "glyph:";

impl DesignSource {
    /// Parses the notation of a source, such as `leaf.svg#stalk` or `glyph:D`. To distinguish a
    /// file name with `#` from an element id, looks up whether a file exists; reads no file.
    #[must_use]
    pub fn from_path(path: &Path) -> Self {
        Self::parse(path, Path::is_file)
    }

    /// Parses the notation of a source whose file path is relative to `folder`; file paths in the
    /// result include the folder.
    #[must_use]
    pub fn in_folder(folder: &Path, path: &Path) -> Self {
        Self::parse(path, |file| folder.join(file).is_file()).map_file(|file| folder.join(file))
    }

    /// Parses the notation of a source, such as `leaf.svg#stalk` or `glyph:D`. `is_file` says
    /// whether a path is an existing file.
    #[must_use]
    pub fn parse(path: &Path, is_file: impl Fn(&Path) -> bool) -> Self {
        // Splits at the first `@`, because folder names may contain one; in the text it can be
        // escaped.
        let (start, font) = match split_path_once(path, b'@') {
            Some((start, font)) if names_font(&font.to_string_lossy()) => (start, Some(font)),
            _ => (path.to_owned(), None),
        };
        if let Some(text) = start.to_str().and_then(|start| start.strip_prefix(GLYPH)) {
            return Self::Text {
                text: percent_decode(text),
                font,
            };
        }
        // Splits at the last `#`, because folder names may contain one.
        if let Some((file, id)) = rsplit_path_once(path, b'#')
            && let Some(id) = id.to_str().filter(|id| !id.is_empty())
            && !file.as_os_str().is_empty()
            && !is_file(path)
        {
            return Self::File {
                path: file,
                element: Some(id.to_owned()),
            };
        }
        Self::from_file_path(path)
    }

    fn from_file_path(path: &Path) -> Self {
        Self::File {
            path: path.to_owned(),
            element: None,
        }
    }

    /// Returns the path of the drawing or font file, or `None` for text in the bundled font.
    #[must_use]
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::File { path, .. } => Some(path),
            Self::Text { font, .. } => font.as_deref(),
        }
    }

    /// Replaces the path of the file, if there is one, by the result of `to`.
    #[must_use]
    pub fn map_file(self, to: impl FnOnce(&Path) -> PathBuf) -> Self {
        match self {
            Self::File { path, element } => Self::File {
                path: to(&path),
                element,
            },
            Self::Text { text, font } => Self::Text {
                text,
                font: font.as_deref().map(to),
            },
        }
    }

    /// Returns the default name of the design: the text, the element's id, or the file
    /// name without its extension, on one line.
    #[must_use]
    pub fn name(&self) -> String {
        let name = match self {
            Self::Text { text, .. } => Cow::from(text),
            Self::File {
                element: Some(id), ..
            } => Cow::from(id),
            Self::File { path, .. } => {
                (path.file_stem().unwrap_or(path.as_os_str())).to_string_lossy()
            }
        };
        SanitizedName(&name).to_string()
    }

    /// Returns the notation of the source. [`DesignSource::parse`] restores the same source,
    /// unless a file with exactly that name exists.
    #[must_use]
    pub fn to_path(&self) -> PathBuf {
        match self {
            Self::File { path, element } => {
                // The start marks the path of a file whose name looks like a text.
                let is_like_text = path
                    .as_os_str()
                    .as_encoded_bytes()
                    .starts_with(GLYPH.as_bytes());
                let mut written = OsString::from(if is_like_text { "./" } else { "" });
                written.push(path);
                for part in element.iter().flat_map(|id| ["#", id]) {
                    written.push(part);
                }
                written.into()
            }
            Self::Text { text, font } => {
                let escaped = text.replace('%', "%25").replace('@', "%40");
                let mut written = OsString::from(format!("{GLYPH}{escaped}"));
                if let Some(font) = font {
                    // The start marks a name without a dot as the path of a font.
                    let is_marked = names_font(&font.to_string_lossy());
                    written.push(if is_marked { "@" } else { "@./" });
                    written.push(font);
                }
                written.into()
            }
        }
    }
}

/// Returns whether the text after an `@` is the path of a font.
fn names_font(after_at: &str) -> bool {
    after_at.contains(['.', '/', '\\'])
}

/// Decodes percent-encoding. Invalid codes stay as they are, and so does the whole text if
/// the decoded bytes are not UTF-8.
fn percent_decode(text: &str) -> String {
    // Bytes that are not UTF-8 show that the text was not meant as percent-encoded.
    String::from_utf8(percent_decoded(text)).unwrap_or_else(|_| text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(written: &str) -> DesignSource {
        DesignSource::parse(written.as_ref(), |path| path == Path::new("a#b.svg"))
    }

    fn text(text: &str, font: Option<&str>) -> DesignSource {
        DesignSource::Text {
            text: text.to_owned(),
            font: font.map(PathBuf::from),
        }
    }

    fn file(path: &str, element: Option<&str>) -> DesignSource {
        DesignSource::File {
            path: path.into(),
            element: element.map(str::to_owned),
        }
    }

    #[test]
    fn paths_that_look_like_texts_keep_their_meaning() {
        for source in [text("D", Some("serif")), file("glyph:x", None)] {
            let again = parsed(source.to_path().to_str().expect("text"));
            let file = again.file().expect("a file").strip_prefix(".");
            assert_eq!(file.ok(), source.file(), "{again:?}");
        }
    }

    #[test]
    fn notation_round_trips() {
        for (written, source) in [
            ("a.svg", file("a.svg", None)),
            ("a.svg#b", file("a.svg", Some("b"))),
            ("a#b.svg", file("a#b.svg", None)),
            ("a#b.svg#c", file("a#b.svg", Some("c"))),
            ("#b", file("#b", None)),
            ("a.svg#", file("a.svg#", None)),
            ("./glyph:D", file("./glyph:D", None)),
            ("glyph:D", text("D", None)),
            ("glyph:", text("", None)),
            ("glyph:A b", text("A b", None)),
            ("glyph:D@x/y.ttf", text("D", Some("x/y.ttf"))),
            ("glyph:D@a@b/y.OTF", text("D", Some("a@b/y.OTF"))),
            ("glyph:D@y.tff", text("D", Some("y.tff"))),
            ("glyph:D@fonts/y", text("D", Some("fonts/y"))),
            ("glyph:D@./y", text("D", Some("./y"))),
            ("glyph:a@b", text("a@b", None)),
            ("glyph:a%40b.com", text("a@b.com", None)),
            ("glyph:%40@y.ttf", text("@", Some("y.ttf"))),
            ("glyph:%C3%89%", text("É%", None)),
            ("glyph:%ff%zz", text("%ff%zz", None)),
        ] {
            assert_eq!(parsed(written), source, "{written}");
            let again = source.to_path();
            assert_eq!(parsed(again.to_str().expect("text")), source, "{written}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn file_names_need_not_be_text() {
        use std::os::unix::ffi::OsStrExt;
        let path = |bytes: &[u8]| PathBuf::from(std::ffi::OsStr::from_bytes(bytes));
        let cafe = |element: Option<&str>| DesignSource::File {
            path: path(b"caf\xe9.svg"),
            element: element.map(str::to_owned),
        };
        let font = DesignSource::Text {
            text: "D@".to_owned(),
            font: Some(path(b"caf\xe9.ttf")),
        };
        for source in [cafe(None), cafe(Some("stalk")), font] {
            let parsed = DesignSource::parse(&source.to_path(), |_| false);
            assert_eq!(parsed, source);
        }
        for bytes in [&b"caf\xe9.svg#"[..], b"a#\xe9.svg", b"#\xe9"] {
            let whole = DesignSource::from_file_path(&path(bytes));
            assert_eq!(DesignSource::parse(&path(bytes), |_| false), whole);
        }
        let file = path(b"caf\xe9#b.svg");
        let whole = DesignSource::from_file_path(&file);
        assert_eq!(DesignSource::parse(&file, |_| true), whole);
    }

    #[test]
    fn only_the_file_path_is_replaced() {
        let moved = |written: &str| parsed(written).map_file(|file| Path::new("up").join(file));
        assert_eq!(moved("a.svg#b"), file("up/a.svg", Some("b")));
        assert_eq!(moved("glyph:D@y.ttf"), text("D", Some("up/y.ttf")));
        assert_eq!(moved("glyph:D"), text("D", None));
    }

    #[test]
    fn a_design_is_named_after_its_most_specific_part() {
        for (written, name) in [
            ("d/leaf.svg", "leaf"),
            ("d/leaf.svg#stalk", "stalk"),
            ("glyph:FORM@y.ttf", "FORM"),
        ] {
            assert_eq!(parsed(written).name(), name);
        }
    }
}
