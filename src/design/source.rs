//! Where a design comes from, as people write it down: a file, an element of
//! a drawing, or text in some font.
//!
//! | written | is |
//! |---|---|
//! | `leaf.svg` | the file |
//! | `leaf.svg#stalk` | the element of the drawing with that id |
//! | `glyph:FORM` | the word FORM in the bundled font |
//! | `glyph:FORM@fonts/serif.ttf` | the same in that font |
//!
//! A file that is really called `leaf.svg#stalk` is the file; one that is
//! called `glyph:FORM` is meant by `./glyph:FORM`. In the text of a glyph
//! `%40` is `@` and `%25` is `%`: any byte of UTF-8 may be written so.

use crate::io::sanitize::SanitizedLine;
use std::borrow::Cow;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// What a design is made from.
///
/// ```
/// use morphospace::design::{ImportOptions, Source};
/// let source = Source::of("glyph:D".as_ref());
/// let design = source.import(&ImportOptions::default())?;
/// assert_eq!(design.name, "D");
/// # Ok::<(), morphospace::design::ImportError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DesignSource {
    /// A file, or an element of a drawing.
    File {
        /// The file.
        path: PathBuf,
        /// The id of the element that is meant, if not all of the file.
        element: Option<String>,
    },
    /// Letters as outlines.
    Text {
        /// The letters.
        text: String,
        /// The font's file; the bundled font where there is none.
        font: Option<PathBuf>,
    },
}

/// What text begins with.
const GLYPH: &str = "glyph:";

/// Endings by which the part after the last `@` is known for a font. Web
/// fonts are among them, so that they are refused and not drawn.
const FONTS: [&str; 6] = ["ttf", "otf", "ttc", "otc", "woff", "woff2"];

impl DesignSource {
    /// What a path means. Files are looked up to tell a name with `#` in it
    /// from an element; nothing is read.
    #[must_use]
    pub fn of(path: &Path) -> Self {
        Self::parse(path, Path::is_file)
    }

    /// What a path means that is relative to a folder.
    #[must_use]
    pub fn in_folder(folder: &Path, path: &Path) -> Self {
        Self::parse(path, |file| folder.join(file).is_file()).at(|file| folder.join(file))
    }

    /// What a path means where `is_file` knows the files.
    #[must_use]
    pub fn parse(path: &Path, is_file: impl Fn(&Path) -> bool) -> Self {
        let Some(written) = path.to_str() else {
            return Self::file_of(path);
        };
        if let Some(glyphs) = written.strip_prefix(GLYPH) {
            return text_of(glyphs);
        }
        // The last one, as folders may have it in their names.
        match written.rsplit_once('#') {
            Some((file, id)) if !file.is_empty() && !id.is_empty() && !is_file(path) => {
                Self::File {
                    path: file.into(),
                    element: Some(id.to_owned()),
                }
            }
            _ => Self::file_of(path),
        }
    }

    fn file_of(path: &Path) -> Self {
        Self::File {
            path: path.to_owned(),
            element: None,
        }
    }

    /// The file that is read, if any: text in the bundled font needs none.
    #[must_use]
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::File { path, .. } => Some(path),
            Self::Text { font, .. } => font.as_deref(),
        }
    }

    /// The same with its file elsewhere: `to` is asked only where there is
    /// one.
    #[must_use]
    pub fn at(self, to: impl FnOnce(&Path) -> PathBuf) -> Self {
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

    /// What the design is called where nobody names it: the text, the
    /// element's id, or the file's name without its ending; in one line.
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
        SanitizedLine(name).to_string()
    }

    /// As it is written down: [`DesignSource::parse`] gives the same source again,
    /// unless a file of that very name is there.
    #[must_use]
    pub fn to_path(&self) -> PathBuf {
        match self {
            Self::File { path, element } => {
                let mut written = path.as_os_str().to_owned();
                for part in element.iter().flat_map(|id| ["#", id]) {
                    written.push(part);
                }
                written.into()
            }
            Self::Text { text, font } => {
                let escaped = text.replace('%', "%25").replace('@', "%40");
                let mut written = OsString::from(format!("{GLYPH}{escaped}"));
                if let Some(font) = font {
                    written.push("@");
                    written.push(font);
                }
                written.into()
            }
        }
    }
}

/// The text and the font after `glyph:`.
fn text_of(written: &str) -> DesignSource {
    let is_font = |path: &str| {
        let ending = Path::new(path).extension().and_then(|e| e.to_str());
        ending.is_some_and(|e| FONTS.iter().any(|font| e.eq_ignore_ascii_case(font)))
    };
    let (text, font) = match written.rsplit_once('@') {
        Some((text, font)) if is_font(font) => (text, Some(font.into())),
        _ => (written, None),
    };
    DesignSource::Text {
        text: unescaped(text),
        font,
    }
}

/// `%40` is `@`; what is no such code, or gives no text, stays as it is.
fn unescaped(text: &str) -> String {
    let mut parts = text.split('%');
    let mut bytes = parts.next().unwrap_or_default().as_bytes().to_vec();
    for part in parts {
        // Digits alone, for the parser would take a sign, too.
        let code = part
            .get(..2)
            .filter(|c| c.bytes().all(|b| b.is_ascii_hexdigit()));
        let byte = code.and_then(|code| u8::from_str_radix(code, 16).ok());
        bytes.push(byte.unwrap_or(b'%'));
        bytes.extend(&part.as_bytes()[if byte.is_some() { 2 } else { 0 }..]);
    }
    // Codes that give no text were not meant as codes.
    String::from_utf8(bytes).unwrap_or_else(|_| text.to_owned())
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
    fn what_is_written_is_understood_and_written_again() {
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
            ("glyph:D@a@b/y.OTF", text("D@a", Some("b/y.OTF"))),
            ("glyph:a@b.com", text("a@b.com", None)),
            ("glyph:%40@y.ttf", text("@", Some("y.ttf"))),
            ("glyph:%C3%89%", text("É%", None)),
            ("glyph:%ff%zz", text("%ff%zz", None)),
        ] {
            assert_eq!(parsed(written), source, "{written}");
            let again = source.to_path();
            assert_eq!(parsed(again.to_str().expect("text")), source, "{written}");
        }
    }

    #[test]
    fn the_file_moves_and_the_rest_stays() {
        let moved = |written: &str| parsed(written).at(|file| Path::new("up").join(file));
        assert_eq!(moved("a.svg#b"), file("up/a.svg", Some("b")));
        assert_eq!(moved("glyph:D@y.ttf"), text("D", Some("up/y.ttf")));
        assert_eq!(moved("glyph:D"), text("D", None));
    }

    #[test]
    fn a_design_is_named_by_what_tells_it_apart() {
        for (written, name) in [
            ("d/leaf.svg", "leaf"),
            ("d/leaf.svg#stalk", "stalk"),
            ("glyph:FORM@y.ttf", "FORM"),
        ] {
            assert_eq!(parsed(written).name(), name);
        }
    }
}
